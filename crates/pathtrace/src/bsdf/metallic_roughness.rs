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
use super::two_normals::{Shares, TwoNormals};
use super::{BsdfSamples, Interactions, ScaledColours};
use crate::sampling::warp::{cosine_hemisphere, to_world};
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
pub fn sample<F: Float>(
    at: &Interactions<F>,
    surface: &MetallicRoughnesses<F>,
    normals: &TwoNormals<F>,
    u: [F; 3],
) -> BsdfSamples<F> {
    let frame = Frame::around(normals.facets);
    let wo = frame.local(at.wo);
    let mut by_cosine = cosine_hemisphere([u[0], u[1]]);
    if let Some(around) = normals.drawn_around() {
        by_cosine = frame.local(to_world(by_cosine, around));
    }
    let (local, facet) = surface.draw(wo, by_cosine, u);
    let wi = frame.world(local);
    let sample = surface.weighted(wo, local, facet, &normals.shares(wi, local.z));
    BsdfSamples { wi, ..sample }
}

/// The BSDF for light from the unit direction `wi` above the surface.
#[inline(always)]
pub fn eval<F: Float>(
    at: &Interactions<F>,
    surface: &MetallicRoughnesses<F>,
    normals: &TwoNormals<F>,
    wi: Vector<F>,
) -> ScaledColours<F> {
    let frame = Frame::around(normals.facets);
    let local = frame.local(wi);
    surface.value(frame.local(at.wo), local, &normals.shares_of_value(wi, local.z))
}

/// Density per solid angle of [`sample`] at `wi`.
#[inline(always)]
pub fn pdf<F: Float>(
    at: &Interactions<F>,
    surface: &MetallicRoughnesses<F>,
    normals: &TwoNormals<F>,
    wi: Vector<F>,
) -> F {
    let frame = Frame::around(normals.facets);
    let local = frame.local(wi);
    let cosine = match normals.drawn_around() {
        Some(around) => around.dot(wi),
        None => local.z,
    };
    let wo = frame.local(at.wo);
    surface.density(wo, (wo + local).normalize(), cosine)
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
    fn body(&self) -> Vector<F> {
        self.base_colour * (F::splat(1.0) - self.metallic)
    }

    #[inline(always)]
    fn facets(&self) -> Microfacets<F> {
        Microfacets { alpha: self.roughness * self.roughness }
    }

    /// What facets reflect, of metal and coat together.
    #[inline(always)]
    fn fresnel(&self, cosine: F) -> Vector<F> {
        let rest = grazing(cosine);
        self.straight() * (F::splat(1.0) - rest) + Vector::along_all(rest)
    }

    /// Share of the light that reaches the body and comes back out, by the cosine to the facet and the smaller one of both
    /// directions to the normal.
    #[inline(always)]
    fn passes_coat(&self, of_facet: F, lower: F) -> F {
        let one = F::splat(1.0);
        let reflected = self.coat + (one - self.coat) * grazing(of_facet);
        one - reflected.max(coat_albedo(self.coat, self.roughness, lower))
    }

    /// Probability of drawing by the facets: their share of what is reflected, as it is estimated for `wo` at this cosine.
    /// The body's is no more than the estimate anywhere, so that the choice of it weighs no sample up.
    #[inline(always)]
    fn specular_probability(&self, cosine: F) -> F {
        let specular = coat_albedo(self.straight().max_element(), self.roughness, cosine);
        let coat = coat_albedo(self.coat, self.roughness, cosine);
        let diffuse = self.body().max_element() * (F::splat(1.0) - coat);
        let (both, one) = (specular + diffuse, F::splat(1.0));
        F::select(both.gt(F::splat(0.0)), specular / both, one).max(F::splat(LEAST_SPECULAR))
    }

    /// A direction by the facets or one `by_cosine`, and the facet that reflects to there.
    #[inline(always)]
    fn draw(&self, wo: Vector<F>, by_cosine: Vector<F>, u: [F; 3]) -> (Vector<F>, Vector<F>) {
        let by_facet = u[2].lt(self.specular_probability(wo.z));
        let visible = self.facets().visible_normal(wo, [u[0], u[1]]);
        let reflected = visible * (wo.dot(visible) * 2.0) - wo;
        let wi = Vector::select(by_facet, reflected, by_cosine);
        (wi, Vector::select(by_facet, visible, (wo + wi).normalize()))
    }

    /// The direction `wi`; the weight is 0 where it lies below the surface, and with one normal at most
    /// `1 / LEAST_SPECULAR`.
    #[inline(always)]
    fn weighted(&self, wo: Vector<F>, wi: Vector<F>, facet: Vector<F>, shares: &Shares<F>) -> BsdfSamples<F> {
        let (cosine, zero) = (wo.dot(facet), F::splat(0.0));
        let (facet_pdf, diffuse_pdf) = (self.facet_density(wo, facet), cosine_density(shares.cosine));
        let specular = self.specular_probability(wo.z);
        let pdf = specular * facet_pdf + (F::splat(1.0) - specular) * diffuse_pdf;
        // BSDF times cosine
        let from_facets = self.fresnel(cosine) * (self.facets().passes(wo, wi) * facet_pdf * shares.facets);
        let from_facets = Vector::select(shares.facets.gt(zero), from_facets, Vector::zero());
        let from_body = self.body() * (self.passes_coat(cosine, lower(wo, wi)) * diffuse_pdf * shares.body);
        let weight = (from_facets + from_body) * (F::splat(1.0) / pdf);
        let any = shares.facets.gt(zero) | shares.body.gt(zero);
        BsdfSamples { wi, weight: Vector::select(any, weight, Vector::zero()), pdf }
    }

    /// What facets and body scatter, both together.
    #[inline(always)]
    fn value(&self, wo: Vector<F>, wi: Vector<F>, shares: &Shares<F>) -> ScaledColours<F> {
        let facet = (wo + wi).normalize();
        let (cosine, zero) = (wo.dot(facet), F::splat(0.0));
        let from_facets = self.fresnel(cosine) * (self.facets().value(wo, wi, facet) * shares.facets);
        let from_facets = Vector::select(shares.facets.gt(zero), from_facets, Vector::zero());
        let from_body = self.body() * (self.passes_coat(cosine, lower(wo, wi)) * FRAC_1_PI * shares.body);
        ScaledColours { colour: from_facets + from_body, factor: F::splat(1.0) }
    }

    /// Density per solid angle of the direction that this facet reflects to, which has this cosine to what the body's
    /// are drawn around.
    #[inline(always)]
    fn density(&self, wo: Vector<F>, facet: Vector<F>, cosine: F) -> F {
        let specular = self.specular_probability(wo.z);
        specular * self.facet_density(wo, facet) + (F::splat(1.0) - specular) * cosine_density(cosine)
    }

    /// The same of what facets reflect. From below none is seen.
    #[inline(always)]
    fn facet_density(&self, wo: Vector<F>, facet: Vector<F>) -> F {
        let zero = F::splat(0.0);
        F::select(facet.z.gt(zero), self.facets().pdf(wo, facet), zero)
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

/// Density per solid angle of directions by their cosine.
#[inline(always)]
fn cosine_density<F: Float>(cosine: F) -> F {
    let zero = F::splat(0.0);
    F::select(cosine.gt(zero), cosine, zero) * FRAC_1_PI
}

/// The smaller cosine of both directions to the facets' normal.
#[inline(always)]
fn lower<F: Float>(wo: Vector<F>, wi: Vector<F>) -> F {
    wo.z.min(wi.z.max(F::splat(0.0)))
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
        let (lane, wo) = (self.lane(), lane_vector(wo));
        let (wi, facet) = lane.draw(wo, cosine_hemisphere([u[0], u[1]]), u);
        let sample = lane.weighted(wo, wi, facet, &Shares::of_one_normal(wi.z));
        (glam_vector(sample.wi), glam_vector(sample.weight), sample.pdf)
    }

    /// The BSDF for light from `wi` above the surface.
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let value = self.lane().value(lane_vector(wo), lane_vector(wi), &Shares::of_one_normal(wi.z));
        glam_vector(value.colour) * value.factor
    }

    /// Density of [`MetallicRoughness::sample`] per solid angle of `wi`.
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (wo, wi) = (lane_vector(wo), lane_vector(wi));
        self.lane().density(wo, (wo + wi).normalize(), wi.z)
    }
}
