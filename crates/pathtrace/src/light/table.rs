//! The lights of a scene by columns, sampled in each lane.
//!
//! Twin: `shaders/pathtrace/light/light.wgsl`.

mod lamps;

use super::ball;
use super::flat::{Flats, Outline};
use super::spot::{self, Cones};
use super::textured::TexturedLights;
use super::tree::BELOW_ONE;
use super::{Environment, Light, LightSamples, LightTree};
use crate::intersect::sphere::SphereLanes;
use crate::intersect::{NO_LIGHT, SurfacePoints};
use crate::sampling::discrete::Discrete;
use crate::sampling::warp;
use crate::vectors::VectorColumn;
use scene::Vec3;
use simd::{Column, Float, Mask, Vector, Word, WordColumn};
use std::sync::Arc;

/// All lights.
#[derive(Debug, Clone, Default)]
pub struct Table {
    /// Corner or centre of an area light, place of a point, direction towards the sun.
    position: VectorColumn,
    /// Of a spot: cosine of its edge, and the edge's slope.
    edge_u: VectorColumn,
    edge_v: VectorColumn,
    /// Of a spot: its axis.
    normal: VectorColumn,
    /// Radiance; of a point its intensity, of a delta sun its irradiance.
    radiance: VectorColumn,
    /// Area, radius of a ball, `1 - cos` of the sun's angular radius.
    size: Column,
    probability: Column,
    choice: Discrete,
    /// Of many lights, all of those that have a place, which stand first ...
    tree: Option<LightTree>,
    /// ... and with which probability one of them is chosen.
    tree_share: f32,
    /// See [`kind`].
    kind: WordColumn,
    has: Has,
    environment: Option<Arc<Environment>>,
    textured: Option<Arc<TexturedLights>>,
}

/// Which kinds of lights there are.
#[derive(Debug, Clone, Copy, Default)]
struct Has {
    flats: bool,
    balls: bool,
    points: bool,
    spots: bool,
    sun: bool,
}

/// Bits that say what a light is.
mod kind {
    pub const FLAT: u32 = 1;
    pub const BALL: u32 = 2;
    pub const POINT: u32 = 4;
    pub const SUN: u32 = 8;
    pub const TWO_SIDED: u32 = 16;
    pub const RECTANGLE: u32 = 32;
    pub const TRIANGLE: u32 = 64;
    pub const DISK: u32 = 128;
    pub const ENVIRONMENT: u32 = 256;
    pub const SPOT: u32 = 512;
}

impl Table {
    pub(super) fn new(
        lights: &[Light],
        probabilities: &[f32],
        choice: Discrete,
        (tree, environment): (Option<LightTree>, Option<Arc<Environment>>),
        textured: Option<Arc<TexturedLights>>,
    ) -> Self {
        let vectors = |of: fn(&Light) -> Vec3| VectorColumn::new(lights.iter().map(of));
        let [edge_u, edge_v, normal] =
            [0, 1, 2].map(|index| VectorColumn::new(lights.iter().map(|light| frame_of(light)[index])));
        Table {
            position: vectors(|light| match light {
                Light::Flat(flat, _) => flat.corner,
                Light::Sphere(sphere, _) => sphere.center,
                Light::Point(point) => point.position,
                Light::Sun(sun) => sun.towards,
                Light::Environment(_) => Vec3::ZERO,
            }),
            edge_u,
            edge_v,
            normal,
            radiance: vectors(|light| match light {
                Light::Flat(_, emission) | Light::Sphere(_, emission) => emission.radiance,
                Light::Point(point) => point.intensity,
                Light::Sun(sun) if sun.one_minus_cos() == 0.0 => sun.irradiance,
                Light::Sun(sun) => sun.radiance(),
                Light::Environment(_) => Vec3::ZERO,
            }),
            size: Column::new(lights.iter().map(|light| match light {
                Light::Flat(flat, _) => flat.area,
                Light::Sphere(sphere, _) => sphere.radius,
                Light::Point(_) | Light::Environment(_) => 0.0,
                Light::Sun(sun) => sun.one_minus_cos(),
            })),
            probability: Column::new(probabilities.iter().copied()),
            tree_share: tree.as_ref().map_or(0.0, |tree| choice.running_sums()[tree.len() - 1]),
            choice,
            tree,
            kind: WordColumn::new(lights.iter().map(kind_of)),
            has: Has {
                flats: lights.iter().any(|light| matches!(light, Light::Flat(..))),
                balls: lights.iter().any(|light| matches!(light, Light::Sphere(..))),
                points: lights.iter().any(|light| matches!(light, Light::Point(_))),
                spots: lights.iter().any(|light| matches!(light, Light::Point(point) if point.spot.is_some())),
                sun: lights.iter().any(|light| matches!(light, Light::Sun(_))),
            },
            environment,
            textured,
        }
    }

    /// The light that `u` in [0, 1) chooses; there must be one.
    #[inline(always)]
    pub fn choose<F: Float>(&self, u: F) -> F::U {
        self.choice.choose(u)
    }

    /// The running sums of the probabilities, the last one 1.
    pub(crate) fn running_sums(&self) -> &[f32] {
        self.choice.running_sums()
    }

    /// Samples the light that reaches the points `x`: one number in [0, 1) to choose a light, two to choose a point on
    /// it.
    #[inline(always)]
    pub fn sample<F: Float>(&self, x: Vector<F>, u_light: F, u: [F; 2]) -> LightSamples<F> {
        self.dimmed(self.sample_whole(x, u_light, u))
    }

    /// As [`Table::sample`], but as if spots shone everywhere: of light that leaves its place in another direction, which
    /// is dimmed by the share of that one.
    #[inline(always)]
    pub fn sample_whole<F: Float>(&self, x: Vector<F>, u_light: F, u: [F; 2]) -> LightSamples<F> {
        if let Some(tree) = &self.tree {
            return self.sample_in_tree(tree, x, u_light, u);
        }
        let light = self.choose(u_light);
        let mut sample = self.sample_one_whole(light, x, u);
        if self.choice.len() > 1 {
            let probability = light.look_up(&self.probability);
            sample.radiance_over_pdf = sample.radiance_over_pdf * (F::splat(1.0) / probability);
            sample.pdf = sample.pdf * probability;
        }
        sample
    }

    /// Of many lights: one by the tree, or one of the few that have no place.
    #[inline(always)]
    fn sample_in_tree<F: Float>(&self, tree: &LightTree, x: Vector<F>, u_light: F, u: [F; 2]) -> LightSamples<F> {
        let (zero, share) = (F::splat(0.0), F::splat(self.tree_share));
        let (mut light, probability) = tree.choose_lanes(x, (u_light / share).min(F::splat(BELOW_ONE)));
        let mut probability = probability * share;
        if self.tree_share < 1.0 {
            let placed = u_light.lt(share);
            light = F::U::select(placed, light, self.choose(u_light));
            probability = F::select(placed, probability, light.look_up(&self.probability));
        }
        let sample = self.sample_one_whole(light, x, u);
        LightSamples {
            shines: sample.shines & probability.gt(zero),
            radiance_over_pdf: sample.radiance_over_pdf * (F::splat(1.0) / probability),
            pdf: sample.pdf * probability,
            ..sample
        }
    }

    /// A density times the probability with which a light that has a place is chosen for points.
    #[inline(always)]
    fn times_probability<F: Float>(&self, density: F, light: F::U, x: Vector<F>) -> F {
        let Some(tree) = &self.tree else { return density * light.look_up(&self.probability) };
        let (probability, zero) = (tree.probability_lanes(light, x) * F::splat(self.tree_share), F::splat(0.0));
        // behind a flat light, where the tree leaves it out, its density is infinite
        F::select(probability.gt(zero), density * probability, zero)
    }

    /// The tree that chooses among many lights, and with which probability it does.
    pub(crate) fn tree(&self) -> Option<(&LightTree, f32)> {
        self.tree.as_ref().map(|tree| (tree, self.tree_share))
    }

    /// As [`Table::sample`], but of one light of the caller's choice, whose probability is not in the densities.
    #[inline(always)]
    pub fn sample_one<F: Float>(&self, light: F::U, x: Vector<F>, u: [F; 2]) -> LightSamples<F> {
        self.dimmed(self.sample_one_whole(light, x, u))
    }

    /// Samples as far as their lights shine there.
    #[inline(always)]
    fn dimmed<F: Float>(&self, sample: LightSamples<F>) -> LightSamples<F> {
        if !self.has.spots {
            return sample;
        }
        let share = self.spot_share(sample.light, -sample.wi);
        let radiance_over_pdf = sample.radiance_over_pdf * share;
        LightSamples { shines: sample.shines & share.gt(F::splat(0.0)), radiance_over_pdf, ..sample }
    }

    /// Share of their intensity that lights have in a unit direction away from them: less than 1 of spots alone.
    #[inline(always)]
    pub fn spot_share<F: Float>(&self, light: F::U, direction: Vector<F>) -> F {
        let one = F::splat(1.0);
        if !self.has.spots {
            return one;
        }
        let edge = self.edge_u.look_up(light);
        let cones = Cones { towards: self.normal.look_up(light), outer: edge.x, slope: edge.y };
        F::select(is(light.look_up_word(&self.kind), kind::SPOT), cones.share(direction), one)
    }

    #[inline(always)]
    fn sample_one_whole<F: Float>(&self, light: F::U, x: Vector<F>, u: [F; 2]) -> LightSamples<F> {
        let position = self.position.look_up(light);
        let radiance = self.radiance.look_up(light);
        let size = light.look_up(&self.size);
        let kind = light.look_up_word(&self.kind);
        let (never, infinite) = (F::M::splat(false), F::splat(f32::INFINITY));
        let mut sample = LightSamples::nowhere(light);
        if self.has.flats {
            let of = self.flats(light, kind).sample(x, u);
            let mut radiance = radiance;
            if let Some(textured) = &self.textured {
                radiance = radiance * textured.at(light, of.place);
            }
            let flat = LightSamples {
                shines: of.shines,
                wi: of.wi,
                radiance_over_pdf: radiance * of.inverse_pdf,
                pdf: F::splat(1.0) / of.inverse_pdf,
                point: of.point,
                endless: never,
                light,
            };
            sample = LightSamples::select(is(kind, kind::FLAT), flat, sample);
        }
        if self.has.balls {
            let of = ball::sample(x, &SphereLanes { center: position, radius: size }, is(kind, kind::TWO_SIDED), u);
            let ball = LightSamples {
                shines: of.shines,
                wi: of.wi,
                radiance_over_pdf: radiance * (F::splat(1.0) / of.pdf),
                pdf: of.pdf,
                point: of.point,
                endless: never,
                light,
            };
            sample = LightSamples::select(is(kind, kind::BALL), ball, sample);
        }
        if self.has.points {
            // intensity over squared distance: the irradiance on a surface that faces the point
            let to_light = position - x;
            let distance_squared = to_light.length_squared();
            let point = LightSamples {
                shines: distance_squared.gt(F::splat(0.0)),
                wi: to_light * (F::splat(1.0) / distance_squared.sqrt()),
                radiance_over_pdf: radiance * (F::splat(1.0) / distance_squared),
                pdf: infinite,
                point: SurfacePoints::in_the_air(position),
                endless: never,
                light,
            };
            sample = LightSamples::select(is(kind, kind::POINT), point, sample);
        }
        if self.has.sun {
            let delta = size.eq(F::splat(0.0));
            let in_cone = warp::to_world(warp::cone(size, u), position);
            let pdf = warp::cone_pdf(size);
            let sun = LightSamples {
                shines: !never,
                wi: Vector::select(delta, position, in_cone),
                radiance_over_pdf: Vector::select(delta, radiance, radiance * (F::splat(1.0) / pdf)),
                pdf: F::select(delta, infinite, pdf),
                point: SurfacePoints::in_the_air(Vector::zero()),
                endless: !never,
                light,
            };
            sample = LightSamples::select(is(kind, kind::SUN), sun, sample);
        }
        if let Some(environment) = &self.environment {
            let of = environment.sample_lanes(u);
            let environment = LightSamples {
                shines: !never,
                wi: of.wi,
                radiance_over_pdf: of.radiance * (F::splat(1.0) / of.pdf),
                pdf: of.pdf,
                point: SurfacePoints::in_the_air(Vector::zero()),
                endless: !never,
                light,
            };
            sample = LightSamples::select(is(kind, kind::ENVIRONMENT), environment, sample);
        }
        sample
    }

    /// Density per solid angle with which [`Table::sample`] at `x` draws the direction that met an area light at the
    /// point `on` it.
    #[inline(always)]
    pub fn pdf<F: Float>(&self, light: F::U, x: Vector<F>, on: Vector<F>) -> F {
        let kind = light.look_up_word(&self.kind);
        let mut density = F::splat(0.0);
        if self.has.flats {
            density = F::select(is(kind, kind::FLAT), self.flats(light, kind).pdf(x, on), density);
        }
        if self.has.balls {
            let ball = SphereLanes { center: self.position.look_up(light), radius: light.look_up(&self.size) };
            density = F::select(is(kind, kind::BALL), ball::pdf(x, &ball), density);
        }
        self.times_probability(density, light, x)
    }

    /// As [`Table::pdf`], but 0 where no sample at `x` is that point of the light, whose normal is given: on its back, or
    /// on the far side of a ball.
    #[inline(always)]
    pub fn pdf_where_sampled<F: Float>(&self, light: F::U, x: Vector<F>, on: &SurfacePoints<F>) -> F {
        let kind = light.look_up_word(&self.kind);
        let (cosine, zero) = (on.normal.dot(x - on.position), F::splat(0.0));
        let two_sided = is(kind, kind::TWO_SIDED);
        let mut sampled = cosine.gt(zero) | (two_sided & cosine.lt(zero));
        if self.has.balls {
            let ball = SphereLanes { center: self.position.look_up(light), radius: light.look_up(&self.size) };
            let seen = ball::sees(x, &ball, two_sided, cosine.gt(zero));
            let is_ball = is(kind, kind::BALL);
            sampled = (is_ball & seen) | (!is_ball & sampled);
        }
        let sampled = sampled & !light.eq(F::U::splat(NO_LIGHT));
        F::select(sampled, self.pdf(light, x, on.position), zero)
    }

    #[inline(always)]
    fn flats<F: Float>(&self, light: F::U, kind: F::U) -> Flats<F> {
        Flats {
            corner: self.position.look_up(light),
            edge_u: self.edge_u.look_up(light),
            edge_v: self.edge_v.look_up(light),
            normal: self.normal.look_up(light),
            area: light.look_up(&self.size),
            two_sided: is(kind, kind::TWO_SIDED),
            is_rectangle: is(kind, kind::RECTANGLE),
            is_triangle: is(kind, kind::TRIANGLE),
            is_disk: is(kind, kind::DISK),
        }
    }
}

/// Where a light is what a bit of [`kind`] says.
#[inline(always)]
fn is<U: Word>(kind: U, bit: u32) -> U::M {
    !(kind & U::splat(bit)).eq(U::splat(0))
}

/// Edges and normal of a flat light; of a point light its cone.
fn frame_of(light: &Light) -> [Vec3; 3] {
    match light {
        Light::Flat(flat, _) => [flat.edge_u, flat.edge_v, flat.normal],
        Light::Point(point) => {
            let (towards, [outer, slope]) = spot::cone_of(point);
            [Vec3::new(outer, slope, 0.0), Vec3::ZERO, towards]
        }
        Light::Sphere(..) | Light::Sun(_) | Light::Environment(_) => [Vec3::ZERO; 3],
    }
}

fn kind_of(light: &Light) -> u32 {
    let sides = |two_sided: bool| if two_sided { kind::TWO_SIDED } else { 0 };
    match light {
        Light::Sphere(_, emission) => kind::BALL | sides(emission.two_sided),
        Light::Point(point) if point.spot.is_some() => kind::POINT | kind::SPOT,
        Light::Point(_) => kind::POINT,
        Light::Sun(_) => kind::SUN,
        Light::Environment(_) => kind::ENVIRONMENT,
        Light::Flat(flat, emission) => {
            let outline = match flat.outline {
                Outline::Parallelogram => 0,
                Outline::Rectangle => kind::RECTANGLE,
                Outline::Triangle => kind::TRIANGLE,
                Outline::Disk => kind::DISK,
            };
            kind::FLAT | outline | sides(emission.two_sided)
        }
    }
}
