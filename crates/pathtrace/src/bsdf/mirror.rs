//! A perfect mirror. Twin: `shaders/pathtrace/bsdf/mirror.wgsl`.

use super::{BsdfSamples, Interactions};
use simd::{Float, Vector};

/// The one direction that there is; the weight is the reflectance.
#[inline(always)]
pub fn sample<F: Float>(at: &Interactions<F>) -> BsdfSamples<F> {
    BsdfSamples { wi: reflected(at.wo, at.normal), ..BsdfSamples::delta(at) }
}

/// The mirror direction of `wo` (pointing away from the surface) about the unit normal `n`.
#[inline(always)]
pub fn reflected<F: Float>(wo: Vector<F>, n: Vector<F>) -> Vector<F> {
    n * (n.dot(wo) * 2.0) - wo
}
