//! The sun: a cone of directions, or one.

use super::{LightSample, ShadowEnd};
use crate::sampling;
use scene::{Sun, Vec3};

pub fn sample(sun: Sun, u: [f32; 2]) -> LightSample {
    let one_minus_cos = sun.one_minus_cos();
    let end = ShadowEnd::Infinity;
    if one_minus_cos == 0.0 {
        return LightSample { wi: sun.towards, radiance_over_pdf: sun.irradiance, pdf: f32::INFINITY, end };
    }
    let wi = sampling::to_world(sampling::cone(one_minus_cos, u), sun.towards);
    let pdf = sampling::cone_pdf(one_minus_cos);
    LightSample { wi, radiance_over_pdf: sun.radiance() / pdf, pdf, end }
}

/// Density in the disc; infinite for a delta sun.
pub fn pdf(sun: Sun) -> f32 {
    sampling::cone_pdf(sun.one_minus_cos())
}

/// Radiance that a ray finds where it hits nothing: the sky, and `sun_weight` times the sun's disc unless it is a delta
/// light. Measured by the chord between unit vectors, which stays exact for a small sun where a cosine does not.
pub fn environment(sky: Vec3, sun: Option<&SunDisc>, sun_weight: f32, direction: Vec3) -> Vec3 {
    let Some(disc) = sun else { return sky };
    let inside = (direction - disc.towards).length_squared() < disc.chord_squared;
    sky + if inside { disc.radiance * sun_weight } else { Vec3::ZERO }
}

/// The visible disc of a sun.
#[derive(Debug, Clone, Copy)]
pub struct SunDisc {
    towards: Vec3,
    /// Square of the chord that spans the angular radius: `4 sin^2 (radius / 2)`.
    chord_squared: f32,
    radiance: Vec3,
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
}
