//! The sun that a ray can hit. As a light it is a cone of directions, or one.
//!
//! Twin: `shaders/pathtrace/light/sun.wgsl`.

use crate::vectors::in_all_lanes;
use scene::{Sun, Vec3};
use simd::{Float, Vector};

/// The visible disc of a sun.
#[derive(Debug, Clone, Copy)]
pub struct SunDisc {
    pub(crate) towards: Vec3,
    /// Square of the chord that spans the angular radius: `4 sin^2 (radius / 2)`.
    pub(crate) chord_squared: f32,
    pub(crate) radiance: Vec3,
}

impl SunDisc {
    /// The disc of a sun that has one.
    pub fn new(sun: &Sun) -> Option<Self> {
        let one_minus_cos = sun.one_minus_cos();
        (one_minus_cos > 0.0).then(|| SunDisc {
            towards: sun.towards,
            chord_squared: 2.0 * one_minus_cos,
            radiance: sun.radiance(),
        })
    }

    /// The disc's radiance where rays of these directions meet it, else zero. Measured by the chord between unit
    /// vectors, which stays exact for a small sun where a cosine does not.
    #[inline(always)]
    pub fn radiance<F: Float>(&self, direction: Vector<F>) -> Vector<F> {
        let chord = direction - in_all_lanes(self.towards);
        let inside = chord.length_squared().lt(F::splat(self.chord_squared));
        Vector::select(inside, in_all_lanes(self.radiance), Vector::zero())
    }
}
