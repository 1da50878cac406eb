//! Rough metal: microfacets of metal. Single scattering: what a facet reflects onto another one
//! is lost. Twin: `shaders/pathtrace/bsdf/rough_conductor.wgsl`.

use super::microfacets::{Frame, Microfacets};
use super::{BsdfSamples, Interactions, ScaledColours};
use crate::vectors::{glam_vector, in_all_lanes, lane_vector};
use scene::{Conductor, Vec3};
use simd::{Float, Mask, Vector};

/// A rough metal in each lane.
#[derive(Debug, Clone, Copy)]
pub struct RoughConductors<F: Float> {
    /// The facets of its surface.
    pub facets: Microfacets<F>,
    /// What facets reflect where no equations say it.
    pub reflectance: Vector<F>,
    /// Where Fresnel's equations say what facets reflect ...
    pub has_index: F::M,
    /// ... index of refraction ...
    pub eta: Vector<F>,
    /// ... and extinction coefficient.
    pub k: Vector<F>,
}

/// Draws directions by the facets that `wo` sees.
#[inline(always)]
pub fn sample<F: Float>(at: &Interactions<F>, metal: &RoughConductors<F>, u: [F; 2]) -> BsdfSamples<F> {
    let frame = Frame::around(at.normal);
    let local = metal.sample(frame.local(at.wo), u);
    BsdfSamples { wi: frame.world(local.wi), ..local }
}

/// The BSDF for light from the unit direction `wi` above the surface.
#[inline(always)]
pub fn eval<F: Float>(at: &Interactions<F>, metal: &RoughConductors<F>, wi: Vector<F>) -> ScaledColours<F> {
    let frame = Frame::around(at.normal);
    metal.eval(frame.local(at.wo), frame.local(wi))
}

/// Density per solid angle of [`sample`] at `wi`.
#[inline(always)]
pub fn pdf<F: Float>(at: &Interactions<F>, metal: &RoughConductors<F>, wi: Vector<F>) -> F {
    let frame = Frame::around(at.normal);
    metal.pdf(frame.local(at.wo), frame.local(wi))
}

impl<F: Float> RoughConductors<F> {
    /// What a facet reflects of light at this cosine to its normal. Fresnel's equations for a conductor, of unpolarised
    /// light (Born and Wolf, section 14.2; without complex numbers as in Lagarde, "Memo on Fresnel equations", 2013).
    #[inline(always)]
    pub fn fresnel(&self, cosine: F) -> Vector<F> {
        if !self.has_index.any() {
            return self.reflectance;
        }
        let share = Vector::new(
            fresnel(cosine, self.eta.x, self.k.x),
            fresnel(cosine, self.eta.y, self.k.y),
            fresnel(cosine, self.eta.z, self.k.z),
        );
        Vector::select(self.has_index, share, self.reflectance)
    }

    /// Draws a direction; the weight is 0 where it lies below the surface.
    #[inline(always)]
    pub fn sample(&self, wo: Vector<F>, u: [F; 2]) -> BsdfSamples<F> {
        let facet = self.facets.visible_normal(wo, u);
        let cosine = wo.dot(facet);
        let wi = facet * (cosine * 2.0) - wo;
        let zero = F::splat(0.0);
        let weight = self.fresnel(cosine) * F::select(wi.z.gt(zero), self.facets.passes(wo, wi), zero);
        BsdfSamples { wi, weight, pdf: self.facets.pdf(wo, facet) }
    }

    /// F D G2 / (4 cos cos).
    #[inline(always)]
    pub fn eval(&self, wo: Vector<F>, wi: Vector<F>) -> ScaledColours<F> {
        let facet = (wo + wi).normalize();
        ScaledColours { colour: self.fresnel(wo.dot(facet)), factor: self.facets.value(wo, wi, facet) }
    }

    /// Density of [`RoughConductors::sample`] per solid angle of `wi`.
    #[inline(always)]
    pub fn pdf(&self, wo: Vector<F>, wi: Vector<F>) -> F {
        self.facets.pdf(wo, (wo + wi).normalize())
    }
}

/// Of one channel.
#[inline(always)]
fn fresnel<F: Float>(cosine: F, eta: F, k: F) -> F {
    let cos2 = cosine * cosine;
    let sin2 = F::splat(1.0) - cos2;
    let (eta2, k2) = (eta * eta, k * k);
    let real = eta2 - k2 - sin2;
    let modulus = (real * real + eta2 * k2 * 4.0).sqrt();
    // half of modulus + real, which cancels where that is negative
    let cancels = real.lt(F::splat(0.0));
    let a2 = F::select(cancels, eta2 * k2 * 2.0 / (modulus - real), (modulus + real) * 0.5);
    let (sum, product) = (modulus + cos2, a2.sqrt() * cosine * 2.0);
    let perpendicular = (sum - product) / (sum + product);
    let (sum, product) = (cos2 * modulus + sin2 * sin2, product * sin2);
    let parallel = perpendicular * (sum - product) / (sum + product);
    (perpendicular + parallel) * 0.5
}

/// [`RoughConductors`] of one lane: z along the normal, `wo` above the surface.
#[derive(Debug, Clone, Copy)]
pub struct RoughConductor {
    /// Width of the distribution of slopes.
    pub alpha: f32,
    /// What facets reflect.
    pub conductor: Conductor,
}

impl RoughConductor {
    fn lane(&self) -> RoughConductors<f32> {
        let (reflectance, has_index, [eta, k]) = match self.conductor {
            Conductor::Constant(reflectance) => (reflectance, false, [Vec3::ONE, Vec3::ZERO]),
            Conductor::Fresnel { eta, k } => (Vec3::ONE, true, [eta, k]),
        };
        let [reflectance, eta, k] = [reflectance, eta, k].map(in_all_lanes);
        RoughConductors { facets: Microfacets { alpha: self.alpha }, reflectance, has_index, eta, k }
    }

    /// What a facet reflects of light at this cosine to its normal.
    pub fn fresnel(&self, cosine: f32) -> Vec3 {
        glam_vector(self.lane().fresnel(cosine))
    }

    /// A direction, BSDF times cosine over density (0 if it lies below the surface), and the density per solid angle.
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> (Vec3, Vec3, f32) {
        let sample = self.lane().sample(lane_vector(wo), u);
        (glam_vector(sample.wi), glam_vector(sample.weight), sample.pdf)
    }

    /// The BSDF for light from `wi` above the surface.
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let value = self.lane().eval(lane_vector(wo), lane_vector(wi));
        glam_vector(value.colour) * value.factor
    }

    /// Density of [`RoughConductor::sample`] per solid angle of `wi`.
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.lane().pdf(lane_vector(wo), lane_vector(wi))
    }
}
