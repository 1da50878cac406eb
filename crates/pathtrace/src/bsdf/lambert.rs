//! Lambert's law: BRDF = albedo / pi. Twin: `shaders/pathtrace/bsdf/lambert.wgsl`.

use super::{BsdfSamples, Interactions, ScaledColours};
use crate::sampling::warp::{cosine_hemisphere, to_world};
use simd::Float;
use std::f32::consts::FRAC_1_PI;

/// Draws directions by the cosine, of which the weight is the albedo.
#[inline(always)]
pub fn sample<F: Float>(at: &Interactions<F>, u: [F; 2]) -> BsdfSamples<F> {
    let local = cosine_hemisphere(u);
    BsdfSamples { wi: to_world(local, at.normal), weight: at.colour, pdf: local.z * FRAC_1_PI }
}

/// The same in all directions.
#[inline(always)]
pub fn eval<F: Float>(at: &Interactions<F>) -> ScaledColours<F> {
    ScaledColours { colour: at.colour, factor: F::splat(FRAC_1_PI) }
}

/// Density of directions at this cosine to the normal.
#[inline(always)]
pub fn pdf<F: Float>(cosine: F) -> F {
    cosine * FRAC_1_PI
}
