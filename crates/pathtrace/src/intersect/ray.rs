//! Rays: one, and one in each lane.
//!
//! Twin: `shaders/pathtrace/intersect/ray.wgsl`.

use crate::vectors::each_lane;
use scene::Vec3;
use simd::{Float, MOST_LANES, Vector};

/// A ray; points on it are `origin + t * direction` for `0 < t < tmax`.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// Where it starts, world space.
    pub origin: Vec3,
    /// Where it goes; unit length but for shadow rays, which end at [`SHADOW_END`]. Never has a -0.0.
    pub direction: Vec3,
    /// Hits must lie before this.
    pub tmax: f32,
}

impl Ray {
    /// A ray without end along the unit vector `direction`.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Ray { origin, direction: without_negative_zero(direction), tmax: f32::INFINITY }
    }

    /// As one lane's ray.
    pub fn lane(&self) -> Rays<f32> {
        let [origin, direction] = [self.origin, self.direction].map(crate::vectors::lane_vector);
        Rays { origin, direction, tmax: self.tmax }
    }

    /// A shadow ray: everything strictly between two points.
    pub fn between(from: Vec3, to: Vec3) -> Self {
        Ray { origin: from, direction: without_negative_zero(to - from), tmax: SHADOW_END }
    }
}

/// Where a shadow ray between two points ends, in lengths of its direction: 8 roundings before 1. Its end at 1 is rounded
/// with the direction, and what lies as near to it is not known to lie before it.
pub const SHADOW_END: f32 = 1.0 - 4.768_371_6e-7;

/// A distance along a shadow ray, in lengths of its direction, that is certainly behind its end.
pub(crate) const BEHIND_THE_END: f32 = 2.0;

/// Wide box tests choose near and far planes by the sign of the direction, where -0.0 is a trap.
fn without_negative_zero(v: Vec3) -> Vec3 {
    v + Vec3::ZERO
}

/// A ray in each lane; points on it are `origin + direction * t` for `0 < t < tmax`.
#[derive(Debug, Clone, Copy)]
pub struct Rays<F> {
    /// Where it starts, world space.
    pub origin: Vector<F>,
    /// Where it goes; unit length but for shadow rays, which end at `t` = 1.
    pub direction: Vector<F>,
    /// Hits must lie before this.
    pub tmax: F,
}

impl<F: Float> Rays<F> {
    /// Rays without end along unit vectors.
    #[inline(always)]
    pub fn new(origin: Vector<F>, direction: Vector<F>) -> Self {
        Rays { origin, direction, tmax: F::splat(f32::INFINITY) }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Rays {
            origin: Vector::select(mask, yes.origin, no.origin),
            direction: Vector::select(mask, yes.direction, no.direction),
            tmax: F::select(mask, yes.tmax, no.tmax),
        }
    }

    /// The ray of each lane.
    #[inline(always)]
    pub fn each(&self) -> [Ray; MOST_LANES] {
        let [origin, direction] = [each_lane(self.origin), each_lane(self.direction)];
        let mut tmax = [0.0; MOST_LANES];
        self.tmax.store(&mut tmax);
        std::array::from_fn(|lane| Ray { tmax: tmax[lane], ..Ray::new(origin[lane], direction[lane]) })
    }
}
