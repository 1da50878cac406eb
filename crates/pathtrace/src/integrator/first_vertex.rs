//! The tutorial's integral with its numbers in it: what one sample of a pixel has found at the first surface that it
//! met, taken from the walk itself.
//!
//! L_o = L_e + 1/N sum of f_r L_i cos(theta) / p(omega): of a path that samples lights too it is a sum of two, L_dir of the
//! direction to a light and L_indir of the one in which the path went on. Light that this one meets by chance is a term of
//! its own, for it has a weight of its own: Veach, "Robust Monte Carlo Methods for Light Transport Simulation" (1997), 9.2.

use crate::bsdf::Interactions;
use crate::drive::lanes::LaneIntegrator;
use crate::integrator::directions::DirectionsAt;
use crate::integrator::light_paths::{Scattering, counts};
use crate::integrator::path::PathLanes;
use crate::integrator::path_plan::Plan;
use crate::integrator::path_state::{MET_BY_CHANCE, PathStates, balance};
use crate::integrator::settings::LightSampling;
use crate::intersect::Rays;
use crate::intersect::shape_list::Scratch;
use crate::light::LightSamples;
use crate::prepared::PreparedScene;
use crate::sampling::sampler::Sampler;
use crate::vectors::{glam_vector, lane_vector};
use scene::Vec3;
use simd::Vector;

/// What a camera ray meets first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Met {
    /// No surface: the sky, or the sun's disc.
    Sky,
    /// A surface that shines.
    Light,
    /// A surface that scatters by Lambert's law.
    Diffuse,
    /// Rough metal, whose directions lie about that of a mirror.
    RoughMetal,
    /// glTF's metallic-roughness: a matt body under a coat, or metal.
    MetallicRoughness,
    /// A perfect mirror, which leaves no directions to choose from.
    Mirror,
    /// Glass, whose surface reflects or refracts.
    Glass,
}

/// One sample of a pixel, taken apart at the first surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstVertex {
    /// What was met first.
    pub met: Met,
    /// L_e: what shines there by itself, where that counts.
    pub emitted: Vec3,
    /// The whole sample, as the film has it.
    pub value: Vec3,
    /// What is added to L_e, or why that is not one direction: a line for the user.
    pub terms: Result<Terms, &'static str>,
    /// What is missing from both because it does not count.
    pub left_out: LeftOut,
}

/// Light at the first surface that a picture of a part of the light does not count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LeftOut {
    /// What shines there by itself.
    pub emitted: bool,
    /// What comes to it straight from a light.
    pub direct: bool,
}

/// The directions that a sample takes at its first vertex.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Terms {
    /// L_dir: towards a light that was sampled, where the walk samples lights.
    pub light: Option<Term>,
    /// L_dir once more: light that the walk met where it went on, though lights are sampled.
    pub by_chance: Option<Term>,
    /// What else came from where the walk went on: L_indir where lights are sampled, all there is where they are not.
    pub onward: Option<Term>,
}

/// f_r L_i cos(theta) / p(omega) of one direction, times its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// The BSDF: albedo / pi where Lambert's law holds.
    pub f_r: Vec3,
    /// Cosine between the direction and the normal.
    pub cosine: f32,
    /// Density per solid angle with which the direction was drawn; infinite towards a light without extent, whose
    /// `radiance` is its irradiance then.
    pub pdf: f32,
    /// L_i: what comes from there. Black behind what stands in the way, and where roulette has ended the walk.
    pub radiance: Vec3,
    /// The weight of multiple importance sampling.
    pub weight: f32,
    /// 1 over the probability with which roulette let the walk go on in this direction.
    pub survival: f32,
    /// What of the sample it makes.
    pub product: Vec3,
}

/// A walk at its first surface.
struct Start<'a> {
    scene: &'a PreparedScene,
    plan: &'a Plan<'a>,
    at: Interactions<f32>,
    met: Met,
    emitted: Vec3,
    left_out: LeftOut,
}

/// Follows one sample along a camera ray.
pub(crate) fn follow(scene: &PreparedScene, plan: &Plan, rays: &Rays<f32>, sampler: &Sampler) -> FirstVertex {
    let start = Start::new(scene, plan, rays);
    let mut lanes = PathLanes::<f32>::new(scene, plan);
    LaneIntegrator::<f32, Sampler>::begin(&mut lanes, true, rays);
    let mut left = None;
    loop {
        let complete = lanes.segment(true, sampler);
        left.get_or_insert((lanes.path, glam_vector(lanes.outcome.radiance), complete));
        if complete {
            break;
        }
    }
    let value = glam_vector(LaneIntegrator::<f32, Sampler>::outcomes(&lanes).radiance);
    let terms = start.in_one_direction(&lanes).map(|()| {
        let Some((path, home, ended)) = left.filter(|_| start.at.scatters()) else { return Terms::default() };
        let light = start.light(&lanes, rays, sampler, home);
        let [by_chance, onward] = match start.leaving(&lanes, &path) {
            Some(leaving) if !ended => start.onward(leaving, &path, sampler, [home, value]),
            leaving => [None, leaving],
        };
        Terms { light, by_chance, onward }
    });
    FirstVertex { met: start.met, emitted: start.emitted, value, terms, left_out: start.left_out }
}

impl<'a> Start<'a> {
    fn new(scene: &'a PreparedScene, plan: &'a Plan<'a>, rays: &Rays<f32>) -> Self {
        let hit = scene.closest(rays, true, &mut Scratch::new(scene.aggregate.shape_list()));
        let wo = -rays.direction;
        let at = if hit.met { scene.interaction(&hit, wo) } else { Interactions::none() };
        let (met, shining) = match hit.met {
            false => (Met::Sky, sky(scene, rays)),
            true if scene.shines(&hit) => (Met::Light, glam_vector(scene.emitted(&hit, wo))),
            true => (kind(&at), Vec3::ZERO),
        };
        let [seen, straight] = counting(plan, &at);
        let emitted = if seen { shining } else { Vec3::ZERO };
        let left_out = LeftOut { emitted: emitted != shining, direct: !straight && !at.is_delta() && at.scatters() };
        Start { scene, plan, at, met, emitted, left_out }
    }

    /// Whether the sample is what the terms are of.
    fn in_one_direction(&self, lanes: &PathLanes<f32>) -> Result<(), &'static str> {
        match self.met {
            Met::Sky | Met::Light => Ok(()),
            Met::Mirror => Err("a mirror leaves no choice of direction: the sample is what it reflects"),
            Met::Glass => {
                Err("glass leaves no choice but to reflect or to refract: the sample is what comes from there")
            }
            _ if lanes.is_guided() => {
                Err("these paths are guided: what the guide expects is added where roulette is played")
            }
            _ if lanes.connecting => {
                Err("light also comes connected through spheres: switch Connections off for the integral's numbers")
            }
            Met::Diffuse if self.plan.branching_vertices > 0 => {
                Err("paths branch here into several directions: set N to 1 for the integral's numbers")
            }
            Met::Diffuse | Met::RoughMetal | Met::MetallicRoughness => Ok(()),
        }
    }

    /// Towards the light that the walk sampled; `home` is what it had brought home then.
    fn light(&self, lanes: &PathLanes<f32>, rays: &Rays<f32>, sampler: &Sampler, home: Vec3) -> Option<Term> {
        if !self.samples_lights() || self.left_out.direct {
            return None;
        }
        let u = sampler.unit4(PathStates::leaving_camera(rays).light_dimension());
        let sample = self.scene.lights.table().sample(self.at.point.position, u[2], [u[0], u[1]]);
        let cosine = self.scene.materials.cosine(&self.at, sample.wi);
        let product = home - self.emitted;
        let reaches = sample.shines && cosine > 0.0 && product != Vec3::ZERO;
        let weight = match self.plan.light {
            LightSampling::Mis if cosine > 0.0 => {
                let directions = lanes.directions(true, &self.at);
                balance(sample.pdf, lanes.direction_pdf(&self.at, &directions, sample.wi, cosine))
            }
            _ => 1.0,
        };
        let radiance = if reaches { arriving(&sample) } else { Vec3::ZERO };
        Some(Term { f_r: self.f_r(sample.wi), cosine, pdf: sample.pdf, radiance, weight, survival: 1.0, product })
    }

    fn samples_lights(&self) -> bool {
        self.plan.light != LightSampling::BsdfOnly && !self.scene.lights.is_empty()
    }

    /// The direction in which the walk has left as `path`, from which nothing has come yet.
    fn leaving(&self, lanes: &PathLanes<f32>, path: &PathStates<f32>) -> Option<Term> {
        let wi = path.rays.direction;
        let cosine = self.scene.materials.cosine(&self.at, wi);
        if cosine <= 0.0 {
            return None;
        }
        let directions: DirectionsAt<f32> = lanes.directions(true, &self.at);
        let (f_r, pdf) = (self.f_r(wi), directions.pdf(&self.at, wi, cosine));
        let survival = glam_vector(path.throughput).max_element() / (f_r * (cosine / pdf)).max_element();
        Some(Term { f_r, cosine, pdf, radiance: Vec3::ZERO, weight: 1.0, survival, product: Vec3::ZERO })
    }

    /// What has come from there, of a sample that had brought `home` so much before and has this `value` now: light that was
    /// met by chance where lights are sampled too, and all else.
    fn onward(
        &self,
        leaving: Term,
        path: &PathStates<f32>,
        sampler: &Sampler,
        [home, value]: [Vec3; 2],
    ) -> [Option<Term>; 2] {
        let carried = glam_vector(path.throughput);
        let all = leaving.bringing(value - home, carried, 1.0);
        if !self.samples_lights() {
            return [None, Some(all)];
        }
        let met = self.after_meeting(path, Vec3::ZERO, sampler);
        if met == Vec3::ZERO {
            return [None, Some(all)];
        }
        let unweighted = PathStates { direction_pdf: MET_BY_CHANCE, ..*path };
        let weight = met.max_element() / self.after_meeting(&unweighted, Vec3::ZERO, sampler).max_element();
        // nothing, to the bit, where the light is all that was there
        let rest = value - self.after_meeting(path, home, sampler);
        let rest = (rest != Vec3::ZERO).then(|| leaving.bringing(rest, carried, 1.0));
        [Some(leaving.bringing(met, carried, weight)), rest]
    }

    /// What a sample has brought home when a path's next segment has met its light: that of a walk which scatters no more.
    fn after_meeting(&self, path: &PathStates<f32>, home: Vec3, sampler: &Sampler) -> Vec3 {
        let mut lanes = PathLanes::<f32>::new(self.scene, self.plan);
        lanes.path = PathStates { vertices: self.plan.limit, ..*path };
        lanes.outcome.radiance = lane_vector(home);
        lanes.segment(true, sampler);
        glam_vector(lanes.outcome.radiance)
    }

    fn f_r(&self, wi: Vector<f32>) -> Vec3 {
        let value = self.scene.materials.eval(&self.at, wi);
        glam_vector(value.colour) * value.factor
    }
}

impl Term {
    /// The same direction, from which so much of the sample has come along a path that `carried` it.
    fn bringing(self, product: Vec3, carried: Vec3, weight: f32) -> Self {
        let radiance = Vec3::select(carried.cmpgt(Vec3::ZERO), product / (carried * weight), Vec3::ZERO);
        Term { radiance, weight, product, ..self }
    }
}

/// Whether light counts that is seen itself, and light that comes straight to this surface.
fn counting(plan: &Plan, at: &Interactions<f32>) -> [bool; 2] {
    let Some(counted) = &plan.counted else { return [true; 2] };
    let seen: u32 = counted.begin();
    [seen, counted.after(seen, Scattering::at(at))].map(counts)
}

/// Radiance from a light that was sampled; irradiance of one without extent.
fn arriving(sample: &LightSamples<f32>) -> Vec3 {
    let over_pdf = glam_vector(sample.radiance_over_pdf);
    if sample.pdf.is_finite() { over_pdf * sample.pdf } else { over_pdf }
}

fn kind(at: &Interactions<f32>) -> Met {
    if at.kinds.diffuse() {
        Met::Diffuse
    } else if at.kinds.mirror() {
        Met::Mirror
    } else if at.kinds.glass() {
        Met::Glass
    } else if at.kinds.metallic_roughness() {
        Met::MetallicRoughness
    } else {
        Met::RoughMetal
    }
}

/// What rays find that meet nothing.
fn sky(scene: &PreparedScene, rays: &Rays<f32>) -> Vec3 {
    let plain = scene.environment(rays.direction, 1.0);
    let picture = scene.lights.environment().map_or(Vec3::ZERO, |map| glam_vector(map.look_up_lanes(rays.direction).0));
    glam_vector(plain) + picture
}
