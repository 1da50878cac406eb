//! Microfacets whose slopes have GGX' distribution (Trowbridge and Reitz 1975; Walter et al. 2007), with Smith's
//! height-correlated masking and shadowing (Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based
//! BRDFs", JCGT 3(2), 2014): what all lobes share whose facets are mirrors. Single scattering: what a facet reflects onto
//! another one is lost.
//!
//! Directions here are local, z along the normal on the side of `wo`. Everything is written around the squares of sines
//! as they come from x and y, not `1 - z^2`: alpha goes down to 1e-4, where the textbook's form of the distribution is
//! infinite in f32. Twin: `shaders/pathtrace/bsdf/microfacets.wgsl`.

use crate::sampling::warp::{cone, orthonormal_basis};
use simd::{Float, Vector};
use std::f32::consts::FRAC_1_PI;

/// The facets of a surface in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Microfacets<F: Float> {
    /// Width of the distribution of slopes, the square of the roughness.
    pub alpha: F,
}

impl<F: Float> Microfacets<F> {
    /// Of what a facet reflects from `wo` to `wi`, the share that no other facet takes: G2 / G1(wo).
    #[inline(always)]
    pub fn passes(&self, wo: Vector<F>, wi: Vector<F>) -> F {
        let (wo_slope, wi_slope) = (self.slope_length(wo), self.slope_length(wi));
        wi.z * (wo.z + wo_slope) / (wi.z * wo_slope + wo.z * wi_slope)
    }

    /// D G2 / (4 cos cos), in which the cosines cancel against those of G2.
    #[inline(always)]
    pub fn value(&self, wo: Vector<F>, wi: Vector<F>, facet: Vector<F>) -> F {
        let masked = wi.z * self.slope_length(wo) + wo.z * self.slope_length(wi);
        self.distribution(facet) * 0.5 / masked
    }

    /// G1 D / (4 cos): the density per solid angle of the direction that a visible facet reflects `wo` to.
    #[inline(always)]
    pub fn pdf(&self, wo: Vector<F>, facet: Vector<F>) -> F {
        self.distribution(facet) * 0.5 / (wo.z + self.slope_length(wo))
    }

    /// Density of facets' normals, per solid angle and area.
    #[inline(always)]
    fn distribution(&self, facet: Vector<F>) -> F {
        let (x, y) = (facet.x / self.alpha, facet.y / self.alpha);
        let stretched = x * x + y * y + facet.z * facet.z;
        F::splat(FRAC_1_PI) / (self.alpha * self.alpha * stretched * stretched)
    }

    /// `cos sqrt(1 + alpha^2 tan^2)`, around which Smith's terms are: G1 = 2 cos / (cos + this).
    #[inline(always)]
    fn slope_length(&self, w: Vector<F>) -> F {
        let (x, y) = (w.x * self.alpha, w.y * self.alpha);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// Draws a facet's normal as `wo` sees them: Dupuy and Benyoub, "Sampling Visible GGX Normals
    /// with Spherical Caps" (2023).
    #[inline(always)]
    pub fn visible_normal(&self, wo: Vector<F>, u: [F; 2]) -> Vector<F> {
        let seen = Vector::new(wo.x * self.alpha, wo.y * self.alpha, wo.z).normalize();
        let one_minus_cos = seen.z + 1.0;
        let cap = cone(one_minus_cos, u);
        // the sum of both z, which does not cancel
        let z = one_minus_cos * (F::splat(1.0) - u[0]);
        Vector::new((cap.x + seen.x) * self.alpha, (cap.y + seen.y) * self.alpha, z).normalize()
    }
}

/// Axes with z along a normal.
pub struct Frame<F> {
    x: Vector<F>,
    y: Vector<F>,
    z: Vector<F>,
}

impl<F: Float> Frame<F> {
    /// Around a unit normal.
    #[inline(always)]
    pub fn around(z: Vector<F>) -> Self {
        let (x, y) = orthonormal_basis(z);
        Frame { x, y, z }
    }

    /// A direction of the world in these axes.
    #[inline(always)]
    pub fn local(&self, w: Vector<F>) -> Vector<F> {
        Vector::new(self.x.dot(w), self.y.dot(w), self.z.dot(w))
    }

    /// A direction of these axes in the world.
    #[inline(always)]
    pub fn world(&self, w: Vector<F>) -> Vector<F> {
        self.x * w.x + self.y * w.y + self.z * w.z
    }
}
