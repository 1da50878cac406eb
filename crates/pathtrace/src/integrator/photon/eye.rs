//! Paths from the camera to where photons have left something, one in each lane.
//!
//! For a photon map they go through mirrors, metal and glass to the first diffuse surface, and gather there; metal that is
//! rough weighs its lights as `mis` does. For light tracing they end at the first surface, whose light the photons
//! have brought to the pixel.
//!
//! Twin: `shaders/pathtrace/integrator/photon/eye.wgsl`, for photon maps.

use super::map::PhotonMap;
use crate::bsdf::Interactions;
use crate::drive::lanes::{LaneIntegrator, LanePlan};
use crate::integrator::PathSettings;
use crate::integrator::path_state::{ALREADY_COUNTED, MET_BY_CHANCE, PathStates, balance};
use crate::integrator::roulette::{SPARED_VERTICES, survivors};
use crate::integrator::settings::Roulette;
use crate::intersect::aggregate::lanes_of;
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Intersections, NO_LIGHT, Rays};
use crate::prepared::{Outcomes, PreparedScene};
use crate::sampling::sampler::Sampler;
use crate::vectors::{each_lane, of_lanes};
use scene::Vec3;
use simd::{Float, MOST_LANES, Mask, Vector, Word};
use std::f32::consts::FRAC_1_PI;

/// What photons have left for the camera's paths.
pub enum Plan<'a> {
    /// A map of those at diffuse surfaces; whether it has those that came from a light directly.
    Map(&'a PhotonMap, bool),
    /// Radiance of each pixel.
    Splats(&'a [Vec3]),
    /// The same, and nothing else is shown.
    Marks(&'a [Vec3]),
}

impl LanePlan for Plan<'_> {
    type LaneState<'a, F: Float>
        = EyeLanes<'a, F>
    where
        Self: 'a;

    #[inline(always)]
    fn lane_state<'a, F: Float>(&'a self, scene: &'a PreparedScene) -> EyeLanes<'a, F> {
        let zero = Vector::zero();
        EyeLanes {
            scene,
            plan: self,
            path: PathStates::leaving_camera(&Rays::new(zero, Vector::splat([0.0, 0.0, 1.0]))),
            to_the_sky: F::M::splat(false),
            scratch: Scratch::new(scene.aggregate.shape_list()),
            outcome: Outcomes { radiance: zero, cut: F::M::splat(false) },
            rays: 0,
        }
    }
}

/// Paths from the camera.
pub struct EyeLanes<'a, F: Float> {
    scene: &'a PreparedScene,
    plan: &'a Plan<'a>,
    path: PathStates<F>,
    /// Paths that have gathered, and look for a sky of one colour, which no light sampling knows.
    to_the_sky: F::M,
    scratch: Scratch<F>,
    outcome: Outcomes<F>,
    rays: u64,
}

impl<F: Float> LaneIntegrator<F> for EyeLanes<'_, F> {
    #[inline(always)]
    fn begin(&mut self, here: F::M, rays: &Rays<F>) {
        self.path = PathStates::select(here, PathStates::leaving_camera(rays), self.path);
        self.outcome.radiance = Vector::select(here, Vector::zero(), self.outcome.radiance);
        self.outcome.cut = self.outcome.cut & !here;
        self.to_the_sky = self.to_the_sky & !here;
    }

    #[inline(always)]
    fn segment(&mut self, taken: F::M, sampler: &Sampler<F::U>) -> F::M {
        if let Plan::Marks(marks) = self.plan {
            self.outcome.radiance = of_pixels(taken, sampler, marks);
            return taken;
        }
        self.rays += u64::from(taken.count());
        let hit = self.scene.closest(&self.path.rays, taken, &mut self.scratch);
        self.meet_lights(taken, &hit);
        if let Plan::Splats(splats) = self.plan {
            self.receive(taken, of_pixels(taken, sampler, splats));
            return taken;
        }
        let at_limit = self.path.vertices.eq(F::U::splat(PathSettings::HARD_CAP));
        let vertex = self.scene.interaction(&hit, -self.path.rays.direction);
        let scattering = taken & hit.met & !self.to_the_sky & vertex.scatters();
        self.outcome.cut = self.outcome.cut | (scattering & at_limit);
        let scattering = scattering & !at_limit;
        if !scattering.any() {
            return taken;
        }
        self.gather(scattering & vertex.is_diffuse(), &vertex);
        taken & !self.scatter(scattering, &vertex, sampler)
    }

    #[inline(always)]
    fn outcomes(&self) -> &Outcomes<F> {
        &self.outcome
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}

impl<F: Float> EyeLanes<'_, F> {
    #[inline(always)]
    fn receive(&mut self, here: F::M, radiance: Vector<F>) {
        let sum = self.outcome.radiance + self.path.throughput * radiance;
        self.outcome.radiance = Vector::select(here, sum, self.outcome.radiance);
    }

    /// Takes the light that paths meet.
    #[inline(always)]
    fn meet_lights(&mut self, taken: F::M, hit: &Intersections<F>) {
        let direction = self.path.rays.direction;
        let (missed, shining) = (taken & !hit.met, taken & hit.met & self.scene.shines(hit));
        if self.scene.has_environment() && missed.any() {
            let weight = self.path.weight_of_meeting(F::splat(self.scene.sun_pdf));
            self.receive(missed, self.scene.environment(direction, weight));
        }
        if let Some(environment) = self.scene.lights.environment()
            && missed.any()
        {
            let (radiance, pdf) = environment.look_up_lanes(direction);
            self.receive(missed, radiance * self.path.weight_of_meeting(pdf));
        }
        if shining.any() {
            let pdf = self.scene.lights.table().pdf(hit.light, self.path.from, hit.point.position);
            let pdf = F::select(hit.light.eq(F::U::splat(NO_LIGHT)), F::splat(0.0), pdf);
            self.receive(shining, self.scene.emitted(hit, -direction) * self.path.weight_of_meeting(pdf));
        }
    }

    /// Takes the photons around diffuse surfaces.
    #[inline(always)]
    fn gather(&mut self, here: F::M, at: &Interactions<F>) {
        let Plan::Map(map, _) = self.plan else { return };
        if !here.any() {
            return;
        }
        let (positions, normals) = (each_lane(at.point.position), each_lane(at.normal));
        let mut irradiance = [Vec3::ZERO; MOST_LANES];
        for lane in lanes_of(here) {
            irradiance[lane] = map.irradiance(positions[lane], normals[lane]);
        }
        self.receive(here, at.colour * of_lanes::<F>(&irradiance) * F::splat(FRAC_1_PI));
    }

    /// Samples lights, and sends paths on; where they go on.
    #[inline(always)]
    fn scatter(&mut self, here: F::M, at: &Interactions<F>, sampler: &Sampler<F::U>) -> F::M {
        let has_all = matches!(self.plan, Plan::Map(_, true));
        let (diffuse, delta) = (at.is_diffuse(), at.is_delta());
        let lit = here & !delta & if has_all { !diffuse } else { here };
        if !self.scene.lights.is_empty() && lit.any() {
            self.sample_lights(lit, at, sampler.unit4(self.path.light_dimension()));
        }
        self.to_the_sky = here & diffuse;
        let looks_for_the_sky = !has_all && self.scene.sky != Vec3::ZERO;
        let walking = if looks_for_the_sky { here } else { here & !diffuse };
        if !walking.any() {
            return walking;
        }
        let u = sampler.unit4(self.path.direction_dimension());
        let sample = self.scene.materials.sample(walking, at, [u[0], u[1], u[3]]);
        let rays = Rays::new(at.point.leaving_towards(sample.wi), sample.wi);
        let spared = delta & self.path.vertices.lt(F::U::splat(SPARED_VERTICES));
        let throughput = self.path.throughput * sample.weight;
        let (survives, throughput) =
            survivors(throughput, throughput, F::splat(1.0), spared, Roulette::THROUGHPUT, u[2]);
        let weighted = F::select(delta, F::splat(MET_BY_CHANCE), sample.pdf);
        let direction_pdf = F::select(diffuse, F::splat(ALREADY_COUNTED), weighted);
        let vertices = self.path.vertices.wrapping_add(F::U::splat(1));
        self.path = PathStates { rays, throughput, vertices, from: at.point.position, direction_pdf, ..self.path };
        walking & survives
    }

    /// Takes the light of one sample of the lights: all of it at diffuse surfaces, weighted at rough metal, which
    /// also meets it.
    #[inline(always)]
    fn sample_lights(&mut self, here: F::M, at: &Interactions<F>, u: [F; 4]) {
        let sample = self.scene.lights.table().sample(at.point.position, u[2], [u[0], u[1]]);
        let cosine = self.scene.materials.cosine(at, sample.wi);
        let faced = here & sample.shines & cosine.gt(F::splat(0.0));
        self.rays += u64::from(faced.count());
        if !faced.any() {
            return;
        }
        let shadowed = self.scene.in_shadow(&at.point, &sample, faced, false, &mut self.scratch);
        let against_chance = balance(sample.pdf, self.scene.materials.pdf(at, sample.wi, cosine));
        let weight = F::select(at.is_diffuse(), F::splat(1.0), against_chance);
        let bsdf = self.scene.materials.eval(at, sample.wi);
        self.receive(faced & !shadowed, bsdf.times(sample.radiance_over_pdf * (cosine * weight)));
    }
}

/// What photons have left at the lanes' pixels.
#[inline(always)]
fn of_pixels<F: Float>(taken: F::M, sampler: &Sampler<F::U>, left: &[Vec3]) -> Vector<F> {
    let (mut pixels, mut found) = ([0; MOST_LANES], [Vec3::ZERO; MOST_LANES]);
    sampler.pixel.store(&mut pixels);
    for lane in lanes_of(taken) {
        found[lane] = left[pixels[lane] as usize];
    }
    of_lanes(&found)
}
