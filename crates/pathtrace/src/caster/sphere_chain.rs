//! Light from a point or a direction to another point by one sphere, off its outside or through it. By symmetry the
//! whole ray lies in the plane of both ends and the centre, so that it has one unknown, the angle of incidence, and one
//! convex equation, of which [`SphereChains::root`] finds every root. For reflection that is Alhazen's problem, for
//! refraction the one of Agrawal, Taguchi and Ramalingam, "Analytical Forward Projection for Axial Non-Central Dioptric
//! and Catadioptric Cameras" (ECCV 2010), where it is an equation of the tenth degree.
//!
//! Lengths are in radii. Every angle of a ray at the sphere has a sine that is a [`Ratio`] times that of the incidence:
//! at the one end 1 / distance, at the other 1 / distance as well (0 for a sun), inside the glass 1 / index.
//!
//! Twin: `shaders/pathtrace/caster/sphere_chain.wgsl`.

use crate::sampling::warp::{angle_of_sine, sin_cos_2pi};
use simd::{Float, Mask};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Roots of one chain between two ends at most.
pub const MOST_ROOTS: u32 = 3;

/// Newton's steps on one branch at most. Against bisection, on millions of targets with folds among them, no root needed
/// more.
pub(crate) const MOST_STEPS: u32 = 8;

/// A step shorter than this is the last: what it leaves is about its cube.
pub(crate) const LAST_STEP: f32 = 2e-3;

/// Sine of the incidence below which the ratio of two vanishing sines is taken for its limit on the axis.
pub(crate) const NEAR_AXIS: f32 = 1e-3;

/// What the sine of an angle is to that of the incidence, at most 1.
#[derive(Debug, Clone, Copy)]
pub struct Ratio<F> {
    sine: F,
    /// `1 - sine^2`, known better than that.
    rest: F,
}

impl<F: Float> Ratio<F> {
    /// The sine's ratio, and `1 - sine^2`.
    #[inline(always)]
    pub fn new(sine: F, rest: F) -> Self {
        Ratio { sine, rest }
    }

    /// 1 / `length`, which is at least 1: the angle to the axis at an end so far from the centre, or inside glass of that
    /// index.
    #[inline(always)]
    pub fn inverse(length: F) -> Self {
        let sine = F::splat(1.0) / length;
        Ratio { sine, rest: (length - 1.0) * (length + 1.0) * sine * sine }
    }

    /// Of rays that are parallel.
    #[inline(always)]
    pub fn zero() -> Self {
        Ratio { sine: F::splat(0.0), rest: F::splat(1.0) }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Ratio { sine: F::select(mask, yes.sine, no.sine), rest: F::select(mask, yes.rest, no.rest) }
    }

    /// Cosine of the angle, from that of the incidence.
    #[inline(always)]
    pub fn cosine(&self, cos: F) -> F {
        (self.rest + self.sine * self.sine * cos * cos).sqrt()
    }

    /// Sine of the angle, from that of the incidence.
    #[inline(always)]
    pub fn times(&self, sin: F) -> F {
        self.sine * sin
    }

    /// The angle, and its first two derivatives by the incidence.
    #[inline(always)]
    fn angle(&self, sin: F, cos: F) -> [F; 3] {
        let own_cos = self.cosine(cos);
        let slope = self.sine / own_cos;
        let bend = -(slope * self.rest / (own_cos * own_cos));
        [angle_of_sine(self.sine * sin, own_cos), cos * slope, sin * bend]
    }

    /// The first derivative of the angle alone.
    #[inline(always)]
    fn slope(&self, cos: F) -> F {
        self.sine * cos / self.cosine(cos)
    }
}

/// An angle of incidence.
#[derive(Debug, Clone, Copy)]
pub struct Incidence<F> {
    /// Sine of the angle, in [0, 1].
    pub sin: F,
    /// Cosine of the angle, in [0, 1].
    pub cos: F,
}

/// One of the roots.
#[derive(Debug, Clone, Copy)]
pub struct Root<F: Float> {
    /// Where there is one; what else is said holds only there.
    pub found: F::M,
    /// The angle of incidence.
    pub incidence: Incidence<F>,
    /// Where the ray meets the sphere on the other side of the axis than its far end.
    pub crosses: F::M,
}

/// A chain by one sphere between two ends, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct SphereChains<F: Float> {
    /// At the end that the chain is looked for from.
    near: Ratio<F>,
    /// At the other end, that of the light.
    far: Ratio<F>,
    /// Inside the sphere; 0 for a mirror.
    inside: Ratio<F>,
    /// Through the sphere; else off its outside.
    through: F::M,
    /// How many times the angle inside counts: 2 or 0.
    refractions: F,
    /// Derivative of the turn at incidence 0.
    first_slope: F,
    /// The turn at grazing incidence.
    last_turn: F,
}

impl<F: Float> SphereChains<F> {
    /// Chains between ends with these ratios, in a sphere with this one.
    #[inline(always)]
    pub fn new(through: F::M, near: Ratio<F>, far: Ratio<F>, inside: Ratio<F>) -> Self {
        let zero = F::splat(0.0);
        let refractions = F::select(through, F::splat(2.0), zero);
        let mut chains = SphereChains { near, far, inside, through, refractions, first_slope: zero, last_turn: zero };
        chains.first_slope = chains.slope(F::splat(1.0));
        chains.last_turn = chains.turn(F::splat(FRAC_PI_2), Incidence { sin: F::splat(1.0), cos: zero })[0];
        chains
    }

    /// How far a ray of incidence `i` has turned about the centre, between its ends: off the sphere from the direction in
    /// which the near end lies, through it from the opposite one. Convex in `i`, and 0 at 0. With two derivatives.
    #[inline(always)]
    fn turn(&self, i: F, Incidence { sin, cos }: Incidence<F>) -> [F; 3] {
        // no closures: what is not inlined for sure has none of the lanes' instructions
        let (near, far, inside) = (self.near.angle(sin, cos), self.far.angle(sin, cos), self.inside.angle(sin, cos));
        let [value, slope, bend] = [near[0] + far[0], near[1] + far[1], near[2] + far[2]];
        let twice = self.refractions;
        [i + i - (value + twice * inside[0]), F::splat(2.0) - (slope + twice * inside[1]), -(bend + twice * inside[2])]
    }

    /// The first derivative of the turn alone.
    #[inline(always)]
    fn slope(&self, cos: F) -> F {
        F::splat(2.0) - self.near.slope(cos) - self.far.slope(cos) - self.refractions * self.inside.slope(cos)
    }

    /// The root number `index` below [`MOST_ROOTS`] for an angle in [0, pi] between the far end and the direction that
    /// turns are counted from. The first crosses the axis where light goes through; near a caustic there are two more on
    /// the far end's own side.
    #[inline(always)]
    pub fn root(&self, index: u32, angle: F, wanted: F::M) -> Root<F> {
        let (first, rising) = (index == 0, index < 2);
        let target = if first { angle } else { -angle };
        let folds = self.through & self.first_slope.lt(F::splat(0.0));
        let may = if rising { target.le(self.last_turn) } else { F::M::splat(true) };
        let may = if first { may } else { may & folds };
        let (i, found) = self.solve(target, rising, wanted & may);
        let (sin, cos) = sin_cos_2pi(i * (1.0 / TAU));
        Root { found, incidence: Incidence { sin, cos }, crosses: self.through & F::M::splat(first) }
    }

    /// The incidence on the rising or falling branch at which the turn is `target`, and where there is one. Each step
    /// solves the parabola through value, slope and bend, so that a double root costs no more than a single one. Where
    /// the parabola misses the target it goes to the fold, and if it still misses at the end there is none.
    #[inline(always)]
    fn solve(&self, target: F, rising: bool, wanted: F::M) -> (F, F::M) {
        let (zero, sign) = (F::splat(0.0), F::splat(if rising { 1.0 } else { -1.0 }));
        let mut i = if rising { self.right_of(target) } else { zero };
        let mut meets = F::M::splat(false);
        let mut going = wanted;
        for _ in 0..MOST_STEPS {
            if !going.any() {
                break;
            }
            let (sin, cos) = sin_cos_2pi(i * (1.0 / TAU));
            let [value, slope, bend] = self.turn(i, Incidence { sin, cos });
            let (rest, along) = (value - target, sign * slope);
            let square = slope * slope - bend * rest * 2.0;
            let now = square.ge(zero);
            let root = square.max(zero).sqrt();
            let uphill = -(rest + rest) / (along + root).max(F::splat(f32::MIN_POSITIVE));
            let to_root = sign * F::select(along.ge(zero), uphill, (root - along) / bend);
            let step = F::select(now, to_root, -slope / bend);
            i = F::select(going, (i + step).clamp(zero, F::splat(FRAC_PI_2)), i);
            let last = step.abs().lt(F::splat(LAST_STEP)) & (now | !meets);
            meets = (going & now) | (!going & meets);
            going = going & !last;
        }
        (i, wanted & meets & (i.gt(zero) | target.eq(zero)))
    }

    /// An incidence right of the root on the rising branch, by the tangents of the convex turn at both ends.
    #[inline(always)]
    fn right_of(&self, target: F) -> F {
        let zero = F::splat(0.0);
        // the slope at grazing incidence is 2
        let by_last = F::splat(FRAC_PI_2) - (self.last_turn - target).max(zero) * 0.5;
        F::select(self.first_slope.gt(zero), by_last.min(target / self.first_slope), by_last)
    }

    /// Density per solid angle of the ray at the near end, for each that the far end has as the centre sees it, at an end
    /// that faces the centre and the ray alike. `sin_angle` is the sine of the angle that [`SphereChains::root`] took.
    #[inline(always)]
    pub fn density(&self, Incidence { sin, cos }: Incidence<F>, sin_angle: F) -> F {
        let slope = self.slope(cos).abs();
        // both sines vanish together on the axis
        let sines = F::select(sin.gt(F::splat(NEAR_AXIS)), sin_angle / sin, slope);
        let near = self.near.cosine(cos) / (self.near.sine * self.near.sine * cos.max(F::splat(f32::MIN_POSITIVE)));
        sines * slope * near * self.far.cosine(cos)
    }
}

#[cfg(test)]
mod tests;
