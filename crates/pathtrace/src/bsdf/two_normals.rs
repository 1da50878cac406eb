//! Metallic-roughness where there are shading normals: its body is shaded by the normal that meshes and normal maps say,
//! its facets by the one that keeps what they mirror above the triangle, as in Cycles (Blender, the layers of its Principled
//! BSDF). What the coat leaves to the body is the coat's matter and goes by the facets' normal. Light counts for each by its own
//! cosine and [`terminator`]. Mostly the normals are one.
//!
//! Twin: `shaders/pathtrace/bsdf/two_normals.wgsl`.

use super::interaction::facing;
use super::metallic_roughness::MetallicRoughnesses;
use super::microfacets::Frame;
use super::shading::{mirroring_normal, terminator};
use super::{BsdfSamples, Interactions, ScaledColours};
use crate::sampling::warp::{cosine_hemisphere, to_world};
use simd::{Float, Vector};
use std::f32::consts::FRAC_1_PI;

/// Such a surface in each lane, as it is met.
pub struct TwoNormals<F: Float> {
    surface: MetallicRoughnesses<F>,
    /// Normal of the facets.
    mirroring: Vector<F>,
    /// z along it.
    facets: Frame<F>,
    /// In `facets`.
    wo: Vector<F>,
    /// The same in the world.
    wo_in_world: Vector<F>,
    /// Normal of the body.
    body: Vector<F>,
    /// Normal of the triangle, on the side of `wo`.
    triangle: Vector<F>,
}

/// A number of each part.
struct Parts<T> {
    facets: T,
    body: T,
}

impl<F: Float> TwoNormals<F> {
    #[inline(always)]
    pub fn new(at: &Interactions<F>, surface: MetallicRoughnesses<F>) -> Self {
        let mirroring = mirroring_normal(at);
        let facets = Frame::around(mirroring);
        let (wo, triangle) = (facets.local(at.wo), facing(at.point.normal, at.wo));
        TwoNormals { surface, mirroring, facets, wo, wo_in_world: at.wo, body: at.normal, triangle }
    }

    /// Draws directions by the facets that `wo` sees or by the body's cosine, from two random numbers for the direction and
    /// one for that choice.
    #[inline(always)]
    pub fn sample(&self, u: [F; 3]) -> BsdfSamples<F> {
        let wi = self.draw(self.body, u);
        let (pdf, cosines) = (self.pdf(wi), self.cosines(wi));
        self.weighted(wi, pdf, self.sum(wi, cosines))
    }

    /// The same for a photon that came from `wo`. The body sends it out by the triangle's cosine.
    #[inline(always)]
    pub fn sample_adjoint(&self, u: [F; 3]) -> BsdfSamples<F> {
        let wi = self.draw(self.triangle, u);
        let cosine = self.triangle.dot(wi);
        let sent = self.eval_adjoint(wi).colour * cosine;
        self.weighted(
            wi,
            self.density(self.triangle, wi),
            Vector::select(cosine.gt(F::splat(0.0)), sent, Vector::zero()),
        )
    }

    #[inline(always)]
    fn weighted(&self, wi: Vector<F>, pdf: F, scattered: Vector<F>) -> BsdfSamples<F> {
        let weight = Vector::select(scattered.is_zero(), Vector::zero(), scattered.divided_by(pdf));
        BsdfSamples { wi, weight, pdf }
    }

    /// The BSDF for light from the unit direction `wi` over its larger cosine to both normals.
    #[inline(always)]
    pub fn eval(&self, wi: Vector<F>) -> ScaledColours<F> {
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        let larger = self.body.dot(wi).max(self.mirroring.dot(wi));
        let scattered = self.sum(wi, self.cosines(wi));
        let colour = Vector::select(larger.gt(zero), scattered.divided_by(larger), Vector::zero());
        ScaledColours { colour, factor: one }
    }

    /// What goes on to `wi` of a photon's power that came from `wo`, over the triangle's cosine.
    #[inline(always)]
    pub fn eval_adjoint(&self, wi: Vector<F>) -> ScaledColours<F> {
        let (zero, cosine) = (F::splat(0.0), self.triangle.dot(self.wo_in_world));
        let sent = self.sum(wi, self.cosines(self.wo_in_world)).divided_by(cosine);
        let seen = cosine.gt(zero) & self.triangle.dot(wi).gt(zero);
        ScaledColours { colour: Vector::select(seen, sent, Vector::zero()), factor: F::splat(1.0) }
    }

    /// Density per solid angle of [`TwoNormals::sample`] at `wi`.
    #[inline(always)]
    pub fn pdf(&self, wi: Vector<F>) -> F {
        self.density(self.body, wi)
    }

    #[inline(always)]
    fn draw(&self, body: Vector<F>, u: [F; 3]) -> Vector<F> {
        let visible = self.surface.facets().visible_normal(self.wo, [u[0], u[1]]);
        let reflected = self.facets.world(visible * (self.wo.dot(visible) * 2.0) - self.wo);
        let by_facet = u[2].lt(self.surface.specular_probability(self.wo.z));
        Vector::select(by_facet, reflected, to_world(cosine_hemisphere([u[0], u[1]]), body))
    }

    #[inline(always)]
    fn density(&self, body: Vector<F>, wi: Vector<F>) -> F {
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        let specular = self.surface.specular_probability(self.wo.z);
        let facet = (self.wo + self.facets.local(wi)).normalize();
        // none is seen from below
        let of_facets = F::select(facet.z.gt(zero), self.surface.facets().pdf(self.wo, facet), zero);
        specular * of_facets + (one - specular) * (body.dot(wi).max(zero) * FRAC_1_PI)
    }

    /// By how much light from `w` counts.
    #[inline(always)]
    fn cosines(&self, w: Vector<F>) -> Parts<F> {
        let of = |normal: Vector<F>| normal.dot(w) * terminator(normal, self.triangle, w);
        Parts { facets: of(self.mirroring), body: of(self.body) }
    }

    /// What facets and body scatter between `wo` and `wi` of light with these cosines.
    #[inline(always)]
    fn sum(&self, wi: Vector<F>, cosines: Parts<F>) -> Vector<F> {
        let zero = F::splat(0.0);
        let wi = self.facets.local(wi);
        let facet = (self.wo + wi).normalize();
        let cosine = self.wo.dot(facet);
        let from_facets =
            self.surface.fresnel(cosine) * (self.surface.facets().value(self.wo, wi, facet) * cosines.facets);
        let lower = self.wo.z.min(wi.z.max(zero));
        let from_body = self.surface.body() * (self.surface.passes_coat(cosine, lower) * FRAC_1_PI * cosines.body);
        let facets_lit = cosines.facets.gt(zero) & wi.z.gt(zero);
        Vector::select(facets_lit, from_facets, Vector::zero())
            + Vector::select(cosines.body.gt(zero), from_body, Vector::zero())
    }
}
