//! glTF's metallic-roughness model (glTF 2.0, appendix B): `mix(dielectric, metal, metallic)`. Its metal is facets that
//! reflect the base colour at normal incidence; its dielectric is a body of that colour by Lambert's law under a clear
//! coat of such facets. Both reflect by Schlick's approximation, and as that is linear in the reflectance at normal
//! incidence, one lobe of facets stands for both. Single scattering: rough metal loses what its facets reflect onto each
//! other, up to two thirds at roughness 1.
//!
//! One thing is not the specification's. There the body gets `1 - F(wo.h)` of the light, also where the coat has reflected
//! nearly all of it already: at grazing angles smooth white paint would send back up to 1.9 times what falls on it. Here
//! it gets no more than the coat leaves of what comes and goes, as glTF's KHR_materials_sheen layers its lobes:
//! `1 - max(F(wo.h), E(wo), E(wi))`, with `coat_albedo` for E. Without that term it is the specification's model.
//!
//! Directions are local, z along the normal on the side of `wo`. Twin: `shaders/pathtrace/bsdf/metallic_roughness.wgsl`.

use super::microfacets::{Frame, Microfacets};
use super::{BsdfSamples, Interactions, ScaledColours};
use crate::sampling::warp::cosine_hemisphere;
use crate::vectors::{glam_vector, in_all_lanes, lane_vector};
use scene::Vec3;
use simd::{Float, Vector};
use std::f32::consts::FRAC_1_PI;

/// Facets of less roughness are taken for these.
pub const SMOOTHEST: f32 = 0.01;

/// Least probability with which directions are drawn by the facets. No sample weighs more than its inverse.
pub const LEAST_SPECULAR: f32 = 0.125;

/// Roughness up to which Whitted's method sees a mirror in a coat.
pub const POLISHED: f32 = 0.1;

/// Such a surface in each lane.
#[derive(Debug, Clone, Copy)]
pub struct MetallicRoughnesses<F: Float> {
    /// Albedo of the body and reflectance of the metal.
    pub base_colour: Vector<F>,
    /// Share of metal, in [0, 1].
    pub metallic: F,
    /// The facets' roughness, the root of their alpha, from [`SMOOTHEST`].
    pub roughness: F,
    /// What the coat reflects at normal incidence.
    pub coat: F,
}

/// Draws directions by the facets that `wo` sees or by the cosine, from two random numbers for the direction and
/// one for that choice.
#[inline(always)]
pub fn sample<F: Float>(at: &Interactions<F>, surface: &MetallicRoughnesses<F>, u: [F; 3]) -> BsdfSamples<F> {
    let frame = Frame::around(at.normal);
    let local = surface.sample(frame.local(at.wo), u);
    BsdfSamples { wi: frame.world(local.wi), ..local }
}

/// The BSDF for light from the unit direction `wi` above the surface.
#[inline(always)]
pub fn eval<F: Float>(at: &Interactions<F>, surface: &MetallicRoughnesses<F>, wi: Vector<F>) -> ScaledColours<F> {
    let frame = Frame::around(at.normal);
    surface.eval(frame.local(at.wo), frame.local(wi))
}

/// Density per solid angle of [`sample`] at `wi`.
#[inline(always)]
pub fn pdf<F: Float>(at: &Interactions<F>, surface: &MetallicRoughnesses<F>, wi: Vector<F>) -> F {
    let frame = Frame::around(at.normal);
    surface.pdf(frame.local(at.wo), frame.local(wi))
}

impl<F: Float> MetallicRoughnesses<F> {
    /// What metal and coat reflect at normal incidence, both together.
    #[inline(always)]
    fn straight(&self) -> Vector<F> {
        let coat = self.coat * (F::splat(1.0) - self.metallic);
        self.base_colour * self.metallic + Vector::along_all(coat)
    }

    /// The body's albedo, were there no coat.
    #[inline(always)]
    pub(super) fn body(&self) -> Vector<F> {
        self.base_colour * (F::splat(1.0) - self.metallic)
    }

    #[inline(always)]
    pub(super) fn facets(&self) -> Microfacets<F> {
        Microfacets { alpha: self.roughness * self.roughness }
    }

    /// What facets reflect, of metal and coat together.
    #[inline(always)]
    pub(super) fn fresnel(&self, cosine: F) -> Vector<F> {
        let rest = grazing(cosine);
        self.straight() * (F::splat(1.0) - rest) + Vector::along_all(rest)
    }

    /// Share of the light that reaches the body and comes back out, by the cosine to the facet and the smaller one of both
    /// directions to the normal.
    #[inline(always)]
    pub(super) fn passes_coat(&self, of_facet: F, lower: F) -> F {
        let one = F::splat(1.0);
        let reflected = self.coat + (one - self.coat) * grazing(of_facet);
        one - reflected.max(coat_albedo(self.coat, self.roughness, lower))
    }

    /// Probability of drawing by the facets: their share of what is reflected, as it is estimated for `wo` at this cosine.
    /// The body's is no more than the estimate anywhere, so that the choice of it weighs no sample up.
    #[inline(always)]
    pub(super) fn specular_probability(&self, cosine: F) -> F {
        let specular = coat_albedo(self.straight().max_element(), self.roughness, cosine);
        let coat = coat_albedo(self.coat, self.roughness, cosine);
        let diffuse = self.body().max_element() * (F::splat(1.0) - coat);
        let (both, one) = (specular + diffuse, F::splat(1.0));
        F::select(both.gt(F::splat(0.0)), specular / both, one).max(F::splat(LEAST_SPECULAR))
    }

    /// Draws a direction; the weight is 0 where it lies below the surface, and at most `1 / LEAST_SPECULAR`.
    #[inline(always)]
    pub fn sample(&self, wo: Vector<F>, u: [F; 3]) -> BsdfSamples<F> {
        let (facets, zero) = (self.facets(), F::splat(0.0));
        let specular = self.specular_probability(wo.z);
        let by_facet = u[2].lt(specular);
        let visible = facets.visible_normal(wo, [u[0], u[1]]);
        let reflected = visible * (wo.dot(visible) * 2.0) - wo;
        let wi = Vector::select(by_facet, reflected, cosine_hemisphere([u[0], u[1]]));
        let facet = Vector::select(by_facet, visible, (wo + wi).normalize());
        let (cosine, above) = (wo.dot(facet), wi.z.gt(zero));
        let diffuse_pdf = F::select(above, wi.z, zero) * FRAC_1_PI;
        let facet_pdf = facets.pdf(wo, facet);
        let pdf = specular * facet_pdf + (F::splat(1.0) - specular) * diffuse_pdf;
        // BSDF times cosine
        let from_facets = self.fresnel(cosine) * (facets.passes(wo, wi) * facet_pdf);
        let from_body = self.body() * (self.passes_coat(cosine, wo.z.min(wi.z)) * diffuse_pdf);
        let weight = (from_facets + from_body) * (F::splat(1.0) / pdf);
        BsdfSamples { wi, weight: Vector::select(above, weight, Vector::zero()), pdf }
    }

    /// What facets and body scatter, both together.
    #[inline(always)]
    pub fn eval(&self, wo: Vector<F>, wi: Vector<F>) -> ScaledColours<F> {
        let facet = (wo + wi).normalize();
        let cosine = wo.dot(facet);
        let from_facets = self.fresnel(cosine) * self.facets().value(wo, wi, facet);
        let from_body = self.body() * (self.passes_coat(cosine, wo.z.min(wi.z)) * FRAC_1_PI);
        ScaledColours { colour: from_facets + from_body, factor: F::splat(1.0) }
    }

    /// Density of [`MetallicRoughnesses::sample`] per solid angle of `wi` above the surface.
    #[inline(always)]
    pub fn pdf(&self, wo: Vector<F>, wi: Vector<F>) -> F {
        let specular = self.specular_probability(wo.z);
        let facet = (wo + wi).normalize();
        specular * self.facets().pdf(wo, facet) + (F::splat(1.0) - specular) * (wi.z * FRAC_1_PI)
    }

    /// What a tree of rays, each of which has one direction, makes of it: the share that is mirrored at this cosine, and
    /// the albedo of the rest. Metal is mirrored however rough it is, the coat where it is polished; else it is left out.
    #[inline(always)]
    pub fn stand_ins(&self, cosine: F) -> [Vector<F>; 2] {
        let polished = self.roughness.le(F::splat(POLISHED));
        let (zero, rest) = (F::splat(0.0), grazing(cosine));
        let of_coat = F::select(polished, self.coat + (F::splat(1.0) - self.coat) * rest, zero);
        let of_metal = self.base_colour * (F::splat(1.0) - rest) + Vector::along_all(rest);
        let mirrored = of_metal * self.metallic + Vector::along_all(of_coat * (F::splat(1.0) - self.metallic));
        [mirrored, self.body() * (F::splat(1.0) - of_coat)]
    }
}

/// How far Schlick's approximation has gone from the reflectance at normal incidence to 1.
#[inline(always)]
fn grazing<F: Float>(cosine: F) -> F {
    let rest = (F::splat(1.0) - cosine).max(F::splat(0.0));
    let squared = rest * rest;
    squared * squared * rest
}

/// About what all facets together reflect of light at this cosine to the normal. Schlick's approximation, of which
/// `1 / (1 + 12 roughness^3)` is left at grazing angles: facets as rough hide each other there, and reflect where they are
/// not grazed. Fitted to quadrature: over all roughnesses body and coat together reflect no more than what comes, but
/// for half a hundredth.
#[inline(always)]
fn coat_albedo<F: Float>(straight: F, roughness: F, cosine: F) -> F {
    let one = F::splat(1.0);
    let at_grazing = one / (one + roughness * roughness * roughness * 12.0);
    straight + (one - straight) * at_grazing * grazing(cosine)
}

/// [`MetallicRoughnesses`] of one lane: z along the normal, `wo` above the surface.
#[derive(Debug, Clone, Copy)]
pub struct MetallicRoughness {
    /// Albedo of the body and reflectance of the metal.
    pub base_colour: Vec3,
    /// Share of metal, in [0, 1].
    pub metallic: f32,
    /// The facets' roughness, the root of their alpha.
    pub roughness: f32,
    /// Index of refraction of the coat.
    pub ior: f32,
}

/// What a coat of this index of refraction reflects at normal incidence.
pub fn coat_of(ior: f32) -> f32 {
    let ratio = (ior - 1.0) / (ior + 1.0);
    ratio * ratio
}

impl MetallicRoughness {
    fn lane(&self) -> MetallicRoughnesses<f32> {
        MetallicRoughnesses {
            base_colour: in_all_lanes(self.base_colour),
            metallic: self.metallic,
            roughness: self.roughness.max(SMOOTHEST),
            coat: coat_of(self.ior),
        }
    }

    /// A direction, BSDF times cosine over density (0 if it lies below the surface), and the density per solid angle.
    pub fn sample(&self, wo: Vec3, u: [f32; 3]) -> (Vec3, Vec3, f32) {
        let sample = self.lane().sample(lane_vector(wo), u);
        (glam_vector(sample.wi), glam_vector(sample.weight), sample.pdf)
    }

    /// The BSDF for light from `wi` above the surface.
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let value = self.lane().eval(lane_vector(wo), lane_vector(wi));
        glam_vector(value.colour) * value.factor
    }

    /// Density of [`MetallicRoughness::sample`] per solid angle of `wi`.
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.lane().pdf(lane_vector(wo), lane_vector(wi))
    }
}
