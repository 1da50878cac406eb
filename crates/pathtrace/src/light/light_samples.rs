//! Samples of lights as lanes hold them. Twin: `shaders/pathtrace/light/light_sample.wgsl`.

use crate::intersect::SurfacePoints;
use simd::{Float, Mask, Vector};

/// Light that arrives at a point in each lane from one sampled direction, if nothing stands between.
#[derive(Debug, Clone, Copy)]
pub struct LightSamples<F: Float> {
    /// Where the light shines; what else is said holds only there.
    pub shines: F::M,
    /// Unit direction towards the light.
    pub wi: Vector<F>,
    /// Radiance divided by `pdf`; for a point or a delta sun its irradiance.
    pub radiance_over_pdf: Vector<F>,
    /// Density per solid angle; infinite for a point and a delta sun.
    pub pdf: F,
    /// Where the shadow ray ends: on an area light, or in the air at a point without a normal.
    pub point: SurfacePoints<F>,
    /// Where it does not end.
    pub endless: F::M,
    /// Which light, by its index.
    pub light: F::U,
}

impl<F: Float> LightSamples<F> {
    /// Of two samples of one light.
    #[inline(always)]
    pub(crate) fn select(mask: F::M, yes: Self, no: Self) -> Self {
        LightSamples {
            shines: (mask & yes.shines) | (!mask & no.shines),
            wi: Vector::select(mask, yes.wi, no.wi),
            radiance_over_pdf: Vector::select(mask, yes.radiance_over_pdf, no.radiance_over_pdf),
            pdf: F::select(mask, yes.pdf, no.pdf),
            point: SurfacePoints::select(mask, yes.point, no.point),
            endless: (mask & yes.endless) | (!mask & no.endless),
            light: yes.light,
        }
    }

    #[inline(always)]
    pub(super) fn nowhere(light: F::U) -> Self {
        let zero = Vector::zero();
        LightSamples {
            shines: F::M::splat(false),
            wi: zero,
            radiance_over_pdf: zero,
            pdf: F::splat(0.0),
            point: SurfacePoints::in_the_air(zero),
            endless: F::M::splat(false),
            light,
        }
    }
}
