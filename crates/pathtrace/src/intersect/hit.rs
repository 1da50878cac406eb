//! What rays meet, in two steps: a hit is as little as a search for the nearest one can carry; where its surface lies and
//! what it is made of is fetched once, for the hit that is left. Of one ray, and of a ray in each lane.
//!
//! Twin: `shaders/pathtrace/intersect/nearest.wgsl`.

use super::{SurfacePoint, SurfacePoints};
use simd::{Float, Word};

/// The nearest meeting of a ray with a primitive. One of an instance will have the instance's number beside the
/// primitive's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction.
    pub t: f32,
    /// Which one, by the number that the structure has for it which has found it.
    pub primitive: u32,
    /// Weights of a triangle's sorted corners, adding up to 1; of others 0.
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

/// A [`Hit`] in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Hits<F: Float> {
    /// Distance in lengths of the ray's direction.
    pub t: F,
    /// As [`Hit::primitive`], or [`NO_PRIMITIVE`].
    pub primitive: F::U,
    /// As [`Hit::barycentrics`]; 0 where the structure finds a point by its distance.
    pub barycentrics: [F; 3],
}

impl<F: Float> Hits<F> {
    /// Whether anything was met; what else is said holds only there.
    #[inline(always)]
    pub fn met(&self) -> F::M {
        !self.primitive.eq(F::U::splat(NO_PRIMITIVE))
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
}
