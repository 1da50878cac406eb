//! What each bug does, at the place in the walk where the factor belongs that it gets wrong. Densities that weights of
//! multiple importance sampling need stay right, so that a bug's error is its own.
//!
//! Twin: `shaders/pathtrace/integrator/broken/wrong.wgsl`.

use super::{Bug, Bugs};
use crate::bsdf::Interactions;
use crate::bsdf::interaction::facing;
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Rays, SHADOW_END, SurfacePoints};
use crate::light::{LightSamples, LightTable};
use crate::prepared::PreparedScene;
use crate::sampling::sampler::Sampler;
use simd::{Float, Vector, Word};
use std::f32::consts::PI;

/// The step by which rays leave surfaces whatever the size of the scene.
pub(crate) const EPSILON: f32 = 0.01;

/// Half of the thickness of the box that points on lamps are drawn in.
pub(crate) const HALF_THICKNESS: f32 = 1.0;

/// Where samples are cut off.
pub(crate) const WHITE: f32 = 1.0;

/// Cosines are at least this where something is divided by them.
pub(crate) const LEAST_COSINE: f32 = 1e-6;

/// Bits of a sample's number that an f32 of 2^28 milliseconds has lost.
pub(crate) const LOST_BITS: u32 = 5;

/// The bugs that are on.
#[derive(Debug, Clone, Copy)]
pub struct Wrong(pub Bugs);

impl Wrong {
    #[inline(always)]
    fn has(self, bug: Bug) -> bool {
        self.0.has(bug)
    }

    /// The cosine of light that was sampled.
    #[inline(always)]
    pub fn cosine<F: Float>(self, right: F) -> F {
        if self.has(Bug::NoCosine) { F::splat(1.0) } else { right }
    }

    /// What is made of BSDF x cosine / density of a direction, whose density is `pdf` and would be `others` by the other
    /// sampler.
    #[inline(always)]
    pub fn of_direction<F: Float>(self, cosine: F, pdf: F, others: F) -> F {
        let mut factor = F::splat(1.0);
        if self.has(Bug::NoCosine) {
            factor = factor / cosine.max(F::splat(LEAST_COSINE));
        }
        if self.has(Bug::NoPdf) {
            factor = factor * pdf;
        } else if self.has(Bug::WrongPdf) {
            factor = factor * (pdf / others.max(F::splat(LEAST_COSINE)));
        }
        factor
    }

    /// What Lambert's BRDF is multiplied by where a light is sampled.
    #[inline(always)]
    pub fn of_brdf<F: Float>(self, at: &Interactions<F>) -> F {
        let (right, wrong) = (F::splat(1.0), F::splat(PI));
        if self.has(Bug::NoInversePi) { F::select(at.is_diffuse(), wrong, right) } else { right }
    }

    /// The throughput of those that survive roulette.
    #[inline(always)]
    pub fn survivors<F: Float>(self, before: Vector<F>, right: Vector<F>) -> Vector<F> {
        if self.has(Bug::RouletteLost) { before } else { right }
    }

    /// Whether light that is met counts although it was sampled.
    #[inline(always)]
    pub fn counts_emission_twice(self) -> bool {
        self.has(Bug::EmissionTwice)
    }

    /// Light that was sampled at `x`; `u` is a random number to spare.
    #[inline(always)]
    pub fn light<F: Float>(self, table: &LightTable, x: Vector<F>, right: LightSamples<F>, u: F) -> LightSamples<F> {
        let mut sample = right;
        if !self.0.has_any(&[Bug::AreaMeasure, Bug::WidthTwice, Bug::ThickLamp]) {
            return sample;
        }
        let flat = sample.shines & table.is_flat(sample.light);
        if self.has(Bug::ThickLamp) {
            let moved = in_a_box(x, sample, u);
            sample = LightSamples::select(flat, moved, sample);
        }
        let mut factor = F::splat(1.0);
        if self.has(Bug::AreaMeasure) {
            factor = F::splat(1.0) / by_area(x, &sample);
        }
        if self.has(Bug::WidthTwice) {
            factor = factor * table.width_over_height(sample.light);
        }
        sample.radiance_over_pdf = sample.radiance_over_pdf * F::select(flat, factor, F::splat(1.0));
        sample
    }

    /// Surfaces as they are met.
    #[inline(always)]
    pub fn seen<F: Float>(self, right: Interactions<F>) -> Interactions<F> {
        if !self.has(Bug::BackFace) {
            return right;
        }
        let outwards = facing(right.normal, right.point.normal);
        Interactions { normal: Vector::select(right.is_diffuse(), outwards, right.normal), ..right }
    }

    /// Where rays begin that leave surfaces in these unit directions.
    #[inline(always)]
    pub fn leaving_towards<F: Float>(self, from: &SurfacePoints<F>, direction: Vector<F>) -> Vector<F> {
        if self.has(Bug::Epsilon) {
            return from.position + from.normal * F::splat(EPSILON).copysign(direction.dot(from.normal));
        }
        from.leaving_towards(direction)
    }

    /// Where something stands between the `wanted` points and what shines on them.
    #[inline(always)]
    pub fn in_shadow<F: Float>(
        self,
        scene: &PreparedScene,
        at: &SurfacePoints<F>,
        sample: &LightSamples<F>,
        wanted: F::M,
        scratch: &mut Scratch<F>,
    ) -> F::M {
        if !self.0.has_any(&[Bug::ThickLamp, Bug::BackFace, Bug::Epsilon]) {
            return scene.in_shadow(at, sample, wanted, false, scratch);
        }
        // between places where none should be anything may stand, the lamp itself too
        let origin = self.leaving_towards(at, sample.wi);
        let to = sample.point.leaving_towards(-sample.wi);
        let between = Rays { origin, direction: to - origin, tmax: F::splat(SHADOW_END) };
        let rays = Rays::select(sample.endless, Rays::new(origin, sample.wi), between);
        wanted & scene.closest(&rays, wanted, scratch).met
    }

    /// The random numbers of samples.
    #[inline(always)]
    pub fn numbers<U: Word>(self, right: &Sampler<U>) -> Sampler<U> {
        if !self.has(Bug::FloatSeed) {
            return *right;
        }
        Sampler { sample: right.sample.shr::<LOST_BITS>().shl::<LOST_BITS>(), ..*right }
    }

    /// What samples bring to their pixels.
    #[inline(always)]
    pub fn sample<F: Float>(self, right: Vector<F>) -> Vector<F> {
        let mut brought = right;
        if self.has(Bug::Clamped) {
            let white = F::splat(WHITE);
            brought = Vector::new(brought.x.min(white), brought.y.min(white), brought.z.min(white));
        }
        if self.has(Bug::Encoded) {
            brought = Vector::new(brought.x.sqrt(), brought.y.sqrt(), brought.z.sqrt());
        }
        brought
    }
}

/// cos / distance^2 of points on flat lamps: the density of a point over that of its direction from `x`.
#[inline(always)]
fn by_area<F: Float>(x: Vector<F>, sample: &LightSamples<F>) -> F {
    let cosine = sample.point.normal.dot(sample.wi).abs().max(F::splat(LEAST_COSINE));
    cosine / (sample.point.position - x).length_squared()
}

/// The same samples, moved along the lamps' normals.
#[inline(always)]
fn in_a_box<F: Float>(x: Vector<F>, on_face: LightSamples<F>, u: F) -> LightSamples<F> {
    let away = on_face.point.normal * ((u * 2.0 - 1.0) * HALF_THICKNESS);
    let point = SurfacePoints { position: on_face.point.position + away, ..on_face.point };
    let moved = LightSamples { point, wi: (point.position - x).normalize(), ..on_face };
    let factor = by_area(x, &moved) / by_area(x, &on_face);
    LightSamples { radiance_over_pdf: on_face.radiance_over_pdf * factor, ..moved }
}
