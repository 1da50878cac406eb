//! What rays meet, in two steps: a hit is as little as a search for the nearest one can carry; where its surface lies and
//! what it is made of is fetched once, for the hit that is left. Of one ray, and of a ray in each lane.
//!
//! Twin: `shaders/pathtrace/intersect/nearest.wgsl`.

use super::{SurfacePoint, SurfacePoints};
use crate::vectors::of_lanes;
use scene::Vec3;
use simd::{Float, MOST_LANES, Word};

/// The nearest meeting of a ray with a primitive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction.
    pub t: f32,
    /// Which one, by the number that the structure has for it which has found it; of an instance
    /// that which [`super::instances::Instances`] have for its triangle.
    pub primitive: u32,
    /// The large mesh's instance that it belongs to, or [`NO_INSTANCE`].
    pub instance: u32,
    /// Weights of a triangle's sorted corners, of an instance's as its mesh has them, adding up to 1; of others 0.
    pub barycentrics: [f32; 3],
}

/// What a ray has met.
#[derive(Debug, Clone, Copy)]
pub struct Intersection {
    /// Where, with the outward normal.
    pub point: SurfacePoint,
    /// Index into the scene's materials.
    pub material: u32,
    /// Index into the list of lights, or [`NO_LIGHT`].
    pub light: u32,
}

/// What a shadow ray has met on its way, of which it is asked whether it blocks the light.
#[derive(Debug, Clone, Copy)]
pub struct Blocker {
    /// Distance in lengths of the ray's direction.
    pub t: f32,
    /// Place in the scene's order, area lights first.
    pub id: u32,
    /// Index into the scene's materials.
    pub material: u32,
    /// The light that the surface belongs to, as [`Intersection::light`] has it.
    pub light: u32,
}

/// What stands for the light of a surface that is not one.
pub const NO_LIGHT: u32 = u32::MAX;

/// What stands for the primitive of a ray that meets none.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// What stands for the instance of a hit that belongs to none.
pub const NO_INSTANCE: u32 = u32::MAX;

/// A [`Hit`] in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Hits<F: Float> {
    /// Distance in lengths of the ray's direction.
    pub t: F,
    /// As [`Hit::primitive`], or [`NO_PRIMITIVE`].
    pub primitive: F::U,
    /// The large mesh of each lane, as [`Hit::instance`].
    pub instance: F::U,
    /// As [`Hit::barycentrics`]; 0 where the structure finds a point by its distance.
    pub barycentrics: [F; 3],
}

impl<F: Float> Hits<F> {
    /// Whether anything was met; what else is said holds only there.
    #[inline(always)]
    pub fn met(&self) -> F::M {
        !self.primitive.eq(F::U::splat(NO_PRIMITIVE))
    }

    /// Whether an instance of a large mesh was met.
    #[inline(always)]
    pub fn on_instance(&self) -> F::M {
        !self.instance.eq(F::U::splat(NO_INSTANCE))
    }

    /// The hit of each lane.
    #[inline(always)]
    pub fn each(&self) -> [Hit; MOST_LANES] {
        let (mut t, mut primitive, mut instance) = ([0.0; MOST_LANES], [0; MOST_LANES], [0; MOST_LANES]);
        let mut weights = [[0.0; MOST_LANES]; 3];
        self.t.store(&mut t);
        self.primitive.store(&mut primitive);
        self.instance.store(&mut instance);
        for (to, from) in weights.iter_mut().zip(self.barycentrics) {
            from.store(to);
        }
        std::array::from_fn(|lane| Hit {
            t: t[lane],
            primitive: primitive[lane],
            instance: instance[lane],
            barycentrics: [weights[0][lane], weights[1][lane], weights[2][lane]],
        })
    }

    /// With these hits, in the lanes that have one.
    #[inline(always)]
    pub fn replaced(&self, by: &[Option<Hit>; MOST_LANES]) -> Self {
        let mut each = self.each();
        for (hit, by) in each.iter_mut().zip(by) {
            *hit = by.unwrap_or(*hit);
        }
        let weights = |i: usize| F::load(&each.map(|hit| hit.barycentrics[i]));
        Hits {
            t: F::load(&each.map(|hit| hit.t)),
            primitive: F::U::load(&each.map(|hit| hit.primitive)),
            instance: F::U::load(&each.map(|hit| hit.instance)),
            barycentrics: [weights(0), weights(1), weights(2)],
        }
    }
}

/// An [`Intersection`] in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Intersections<F: Float> {
    /// Whether anything was met; what else is said holds only there.
    pub met: F::M,
    /// Where, with the outward normal.
    pub point: SurfacePoints<F>,
    /// Index into the scene's materials.
    pub material: F::U,
    /// Index into the list of lights, or [`NO_LIGHT`].
    pub light: F::U,
    /// Which one, by its place in the order of the structure that has found it, for what its mesh says of it; of no meaning
    /// where no mesh of the scene says anything. Of an instance as [`Hit::primitive`] says it.
    pub triangle: F::U,
    /// The large mesh of each lane, as [`Hit::instance`].
    pub instance: F::U,
    /// Weights of the triangle's corners.
    pub barycentrics: [F; 3],
}

impl<F: Float> Intersections<F> {
    /// Whether an instance of a large mesh was met.
    #[inline(always)]
    pub fn on_instance(&self) -> F::M {
        self.met & !self.instance.eq(F::U::splat(NO_INSTANCE))
    }

    /// The hits that these are of where [`Intersections::on_instance`], without their distances.
    #[inline(always)]
    pub(super) fn hits_on_instances(&self) -> Hits<F> {
        Hits { t: F::splat(0.0), primitive: self.triangle, instance: self.instance, barycentrics: self.barycentrics }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Intersections {
            met: (mask & yes.met) | (!mask & no.met),
            point: SurfacePoints::select(mask, yes.point, no.point),
            material: F::U::select(mask, yes.material, no.material),
            light: F::U::select(mask, yes.light, no.light),
            triangle: F::U::select(mask, yes.triangle, no.triangle),
            instance: F::U::select(mask, yes.instance, no.instance),
            barycentrics: [0, 1, 2].map(|i| F::select(mask, yes.barycentrics[i], no.barycentrics[i])),
        }
    }
}

/// Intersections of single lanes, on their way into lanes.
pub(super) struct EachIntersection {
    position: [Vec3; MOST_LANES],
    error: [Vec3; MOST_LANES],
    normal: [Vec3; MOST_LANES],
    radius: [f32; MOST_LANES],
    material: [u32; MOST_LANES],
    light: [u32; MOST_LANES],
    triangle: [u32; MOST_LANES],
}

impl EachIntersection {
    /// Of lanes in which nothing is met yet.
    #[inline(always)]
    pub fn none() -> Self {
        let [position, error, normal] = [[Vec3::ZERO; MOST_LANES]; 3];
        let (radius, material, light) = ([0.0; MOST_LANES], [0; MOST_LANES], [NO_LIGHT; MOST_LANES]);
        EachIntersection { position, error, normal, radius, material, light, triangle: [0; MOST_LANES] }
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, met: &Intersection) {
        self.position[lane] = met.point.position;
        self.error[lane] = met.point.error;
        self.normal[lane] = met.point.normal;
        (self.radius[lane], self.material[lane], self.light[lane]) = (met.point.radius, met.material, met.light);
    }

    /// Says which triangle it is, see [`Intersections::triangle`].
    #[inline(always)]
    pub fn set_triangle(&mut self, lane: usize, triangle: u32) {
        self.triangle[lane] = triangle;
    }

    /// Those of these hits, where `met`.
    #[inline(always)]
    pub fn in_lanes<F: Float>(&self, hits: &Hits<F>, met: F::M) -> Intersections<F> {
        Intersections {
            met,
            point: SurfacePoints {
                position: of_lanes(&self.position),
                error: of_lanes(&self.error),
                normal: of_lanes(&self.normal),
                radius: F::load(&self.radius),
            },
            material: F::U::load(&self.material),
            light: F::U::load(&self.light),
            triangle: F::U::load(&self.triangle),
            instance: hits.instance,
            barycentrics: hits.barycentrics,
        }
    }
}
