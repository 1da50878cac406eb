//! The tutorial's integral with its numbers in it: what one sample of a pixel has found at the first surface that it
//! met, taken from the walk itself.
//!
//! L_o = L_e + 1/N sum of f_r L_i cos(theta) / p(omega): of a path that samples lights too it is a sum of two, L_dir of the
//! direction to a light and L_indir of the one in which the path went on.

use crate::bsdf::Interactions;
use crate::drive::lanes::LaneIntegrator;
use crate::integrator::directions::DirectionsAt;
use crate::integrator::path::PathLanes;
use crate::integrator::path_plan::Plan;
use crate::integrator::path_state::{PathStates, balance};
use crate::integrator::settings::LightSampling;
use crate::intersect::Rays;
use crate::intersect::shape_list::Scratch;
use crate::light::LightSamples;
use crate::prepared::PreparedScene;
use crate::sampling::sampler::Sampler;
use crate::vectors::glam_vector;
use scene::Vec3;

/// What a camera ray meets first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Met {
    /// No surface: the sky, or the sun's disc.
    Sky,
    /// A surface that shines.
    Light,
    /// A surface that scatters by Lambert's law.
    Diffuse,
    /// Rough metal.
    RoughMetal,
    /// A mirror.
    Mirror,
    /// Glass, whose surface reflects or refracts.
    Glass,
}

/// One sample of a pixel, taken apart at the first surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstVertex {
    /// What was met first.
    pub met: Met,
    /// L_e: what shines there by itself.
    pub emitted: Vec3,
    /// The whole sample, as the film has it.
    pub value: Vec3,
    /// What is added to L_e, or why that is not one direction: a line for the user.
    pub terms: Result<Terms, &'static str>,
}

/// The directions that a sample takes at its first vertex.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Terms {
    /// L_dir: towards a light that was sampled, where the walk samples lights.
    pub light: Option<Term>,
    /// The direction in which the walk went on: L_indir beside a light that was sampled, all there is without.
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
    /// The weight of multiple importance sampling towards a light, 1 over the probability of roulette onward.
    pub weight: f32,
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
        let Some((path, home, ended)) = left.filter(|_| !start.at.colour.is_zero()) else { return Terms::default() };
        Terms {
            light: start.light(&lanes, rays, sampler, home),
            onward: start.onward(&lanes, &path, value - home, ended),
        }
    });
    FirstVertex { met: start.met, emitted: start.emitted, value, terms }
}

impl<'a> Start<'a> {
    fn new(scene: &'a PreparedScene, plan: &'a Plan<'a>, rays: &Rays<f32>) -> Self {
        let hit = scene.closest(rays, true, &mut Scratch::new(scene.aggregate.shape_list()));
        let wo = -rays.direction;
        let at = if hit.met { scene.interaction(&hit, wo) } else { Interactions::none() };
        let (met, emitted) = match hit.met {
            false => (Met::Sky, sky(scene, rays)),
            true if scene.shines(&hit) => (Met::Light, glam_vector(scene.emitted(&hit, wo))),
            true => (kind(&at), Vec3::ZERO),
        };
        Start { scene, plan, at, met, emitted }
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
            Met::Diffuse | Met::RoughMetal => Ok(()),
        }
    }

    /// Towards the light that the walk sampled; `home` is what it had brought home then.
    fn light(&self, lanes: &PathLanes<f32>, rays: &Rays<f32>, sampler: &Sampler, home: Vec3) -> Option<Term> {
        if self.plan.light == LightSampling::BsdfOnly || self.scene.lights.is_empty() {
            return None;
        }
        let u = sampler.unit4(PathStates::leaving_camera(rays).light_dimension());
        let sample = self.scene.lights.table().sample(self.at.point.position, u[2], [u[0], u[1]]);
        let cosine = self.at.normal.dot(sample.wi);
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
        Some(Term { f_r: self.f_r(sample.wi), cosine, pdf: sample.pdf, radiance, weight, product })
    }

    /// The direction in which the walk has left as `path`, and what it brought home from there.
    fn onward(&self, lanes: &PathLanes<f32>, path: &PathStates<f32>, product: Vec3, ended: bool) -> Option<Term> {
        let wi = path.rays.direction;
        let cosine = self.at.normal.dot(wi);
        if cosine <= 0.0 {
            return None;
        }
        let directions: DirectionsAt<f32> = lanes.directions(true, &self.at);
        let (f_r, pdf) = (self.f_r(wi), directions.pdf(&self.at, wi, cosine));
        // with what it was worth at the camera, roulette included
        let carried = glam_vector(path.throughput);
        let weight = carried.max_element() / (f_r * (cosine / pdf)).max_element();
        let carries = carried.cmpgt(Vec3::ZERO);
        let radiance = if ended { Vec3::ZERO } else { Vec3::select(carries, product / carried, Vec3::ZERO) };
        Some(Term { f_r, cosine, pdf, radiance, weight, product })
    }

    fn f_r(&self, wi: simd::Vector<f32>) -> Vec3 {
        let value = self.scene.materials.eval(&self.at, wi);
        glam_vector(value.colour) * value.factor
    }
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
