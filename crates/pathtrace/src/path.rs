//! One path: the tutorial's `shade`, turned from recursion into a state that moves from vertex to vertex (Task 2 d).
//!
//! Each iteration is one segment: meet a surface, take its emission, sample a light, draw a direction, play roulette. The
//! state is all there is: no recursion, no allocation. A bounce limit of N lets N + 1 vertices scatter; what is found by
//! chance is found one segment later, by the last one.
//!
//! With more than one branch ("When N>1: Distributed ray tracing") a diffuse vertex is kept on a small stack, and the path
//! comes back to it until it has left in N directions; each sees the lights anew and counts 1 / N.

use crate::bsdf::{Interface, reflect};
use crate::geometry::{Hit, NO_LIGHT, Ray, SurfacePoint};
use crate::light::environment;
use crate::sampler::Sampler;
use crate::sampling::{UNIFORM_HEMISPHERE_PDF, cosine_hemisphere, to_world, uniform_hemisphere};
use crate::settings::{Directions, LightSearch, PathSettings, Roulette};
use crate::world::{Outcome, World, emitted, facing};
use scene::{Bsdf, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Paths that one sample may branch into.
pub const MOST_BRANCHES: u32 = 65_536;

/// Vertices that can wait for more branches at a time: two to this power is [`MOST_BRANCHES`].
const MOST_FORKS: usize = 16;

/// A path on its way.
#[derive(Clone, Copy)]
struct PathState {
    ray: Ray,
    /// Product of BSDF, cosine and inverse density so far: what radiance met now is worth at the camera.
    throughput: Vec3,
    /// Vertices at which the path has scattered.
    vertices: u32,
    /// Diffuse ones among them, as far as they branched.
    forked: u32,
    /// Tells the branches of a sample apart: the path's number in their tree, 0 if nothing branches.
    branch: u32,
    /// The last vertex.
    from: Vec3,
    /// Density per solid angle of the direction taken there, as far as the light met now needs it: [`MET_BY_CHANCE`] if
    /// it all counts, [`ALREADY_COUNTED`] if it does not, else weighted against light sampling.
    direction_pdf: f32,
}

/// No light was sampled at the last vertex, or none could be: the camera, a mirror, glass.
const MET_BY_CHANCE: f32 = f32::INFINITY;
/// Light was sampled at the last vertex: meeting it now would count it twice.
const ALREADY_COUNTED: f32 = 0.0;

/// A point of a diffuse surface.
#[derive(Clone, Copy)]
struct DiffuseVertex {
    point: SurfacePoint,
    /// On the side that the path came from.
    normal: Vec3,
    albedo: Vec3,
}

/// A vertex that more branches will leave.
#[derive(Clone, Copy)]
struct Fork {
    vertex: DiffuseVertex,
    /// As it arrived.
    path: PathState,
    /// Branches to come.
    left: u32,
}

/// Vertices that wait for their other branches, deepest last. Kept from sample to sample.
pub struct Forks {
    waiting: [Option<Fork>; MOST_FORKS],
    count: usize,
}

impl Default for Forks {
    fn default() -> Self {
        Forks { waiting: [None; MOST_FORKS], count: 0 }
    }
}

impl Forks {
    fn push(&mut self, fork: Fork) {
        self.waiting[self.count] = Some(fork);
        self.count += 1;
    }

    /// The deepest vertex that waits, and the path as its next branch begins.
    fn next(&mut self, branches: u32) -> Option<(DiffuseVertex, PathState)> {
        let Fork { vertex, mut path, left } = self.waiting[self.count.checked_sub(1)?]?;
        path.branch = child(path.branch, branches, branches - left);
        if left > 1 {
            self.waiting[self.count - 1].as_mut()?.left -= 1;
        } else {
            self.count -= 1;
        }
        Some((vertex, path))
    }
}

/// Number of a path's branch `index` in a tree where each has `branches`.
fn child(parent: u32, branches: u32, index: u32) -> u32 {
    parent.wrapping_mul(branches).wrapping_add(index + 1)
}

/// Settings as the walk reads them.
pub struct Plan {
    directions: Directions,
    light: LightSearch,
    roulette: Roulette,
    /// Vertices at which a path may scatter.
    limit: u32,
    /// Whether that is the hard cap rather than the user's wish.
    capped: bool,
    branches: u32,
    /// Diffuse vertices of a path that may branch.
    branching_vertices: u32,
}

impl Plan {
    /// Reads the settings.
    pub fn new(settings: &PathSettings) -> Self {
        Plan {
            directions: settings.estimator.directions,
            light: settings.estimator.light,
            roulette: settings.roulette,
            limit: settings.scattering_vertices(),
            capped: settings.bounces.is_none(),
            branches: settings.branches.max(1),
            branching_vertices: settings.branching_vertices().min(MOST_FORKS as u32),
        }
    }
}

/// Blocks of random numbers: the camera takes block 0, each vertex two; branches keep apart by the bits above these.
fn direction_dimension(path: &PathState) -> u32 {
    1 + 2 * path.vertices + (path.branch << 11)
}

fn light_dimension(path: &PathState) -> u32 {
    direction_dimension(path) + 1
}

/// Follows a camera ray, and all its branches, to their ends.
#[inline]
pub fn trace(world: &World, ray: Ray, plan: &Plan, sampler: &Sampler, forks: &mut Forks) -> Outcome {
    let path = PathState {
        ray,
        throughput: Vec3::ONE,
        vertices: 0,
        forked: 0,
        branch: 0,
        from: ray.origin,
        direction_pdf: MET_BY_CHANCE,
    };
    let mut walk = Walk { world, plan, sampler, path, outcome: Outcome::default() };
    forks.count = 0;
    loop {
        let mut alive = walk.segment(forks);
        while !alive {
            let Some((vertex, path)) = forks.next(plan.branches) else { return walk.outcome };
            walk.path = path;
            alive = walk.leave_diffuse(&vertex);
        }
    }
}

/// A path, where it walks and what it brings.
struct Walk<'a> {
    world: &'a World<'a>,
    plan: &'a Plan,
    sampler: &'a Sampler,
    path: PathState,
    outcome: Outcome,
}

impl Walk<'_> {
    /// One segment; false where the path ends.
    #[inline]
    fn segment(&mut self, forks: &mut Forks) -> bool {
        self.outcome.rays += 1;
        let path = &mut self.path;
        let Some(hit) = self.world.accel.closest(&path.ray) else {
            let weight = path.weight_of_meeting(|| self.world.sun_pdf);
            let disc = self.world.sun_disc.as_ref();
            self.outcome.radiance += path.throughput * environment(self.world.sky, disc, weight, path.ray.direction);
            return false;
        };
        let material = &self.world.materials[hit.material as usize];
        if material.emission.is_some() {
            let weight = path.weight_of_meeting(|| self.world.light_pdf(path, &hit));
            self.outcome.radiance += path.throughput * emitted(material, hit.point.normal, path.ray.direction) * weight;
        }
        if path.vertices == self.plan.limit {
            self.outcome.cut |= self.plan.capped;
            return false;
        }
        let wo = -path.ray.direction;
        match material.bsdf {
            Bsdf::Diffuse { albedo } => {
                let albedo = albedo.at(hit.point.position);
                if albedo == Vec3::ZERO {
                    return false;
                }
                let normal = facing(hit.point.normal, wo);
                let vertex = DiffuseVertex { point: hit.point, normal, albedo };
                if path.forked < self.plan.branching_vertices {
                    path.forked += 1;
                    path.throughput /= self.plan.branches as f32;
                    forks.push(Fork { vertex, path: *path, left: self.plan.branches - 1 });
                    path.branch = child(path.branch, self.plan.branches, 0);
                }
                self.leave_diffuse(&vertex)
            }
            Bsdf::Mirror { reflectance } => {
                path.throughput *= reflectance;
                path.leave(&hit.point, reflect(wo, facing(hit.point.normal, wo)));
                let [.., u_roulette, _] = self.sampler.unit4(direction_dimension(path));
                self.goes_on(u_roulette)
            }
            Bsdf::Dielectric { ior } => {
                let [.., u_roulette, u_fresnel] = self.sampler.unit4(direction_dimension(path));
                scatter_dielectric(path, &hit.point, wo, ior, u_fresnel);
                self.goes_on(u_roulette)
            }
        }
    }

    /// Samples a light and draws the direction in which the path leaves a diffuse vertex; false where it ends.
    #[inline]
    fn leave_diffuse(&mut self, vertex: &DiffuseVertex) -> bool {
        if self.plan.light != LightSearch::Chance && !self.world.lights.is_empty() {
            let u = self.sampler.unit4(light_dimension(&self.path));
            let direct = self.sample_lights(&vertex.point, vertex.normal, u);
            self.outcome.radiance += self.path.throughput * vertex.albedo * FRAC_1_PI * direct;
        }
        let [u0, u1, u_roulette, _] = self.sampler.unit4(direction_dimension(&self.path));
        let path = &mut self.path;
        path.throughput *= vertex.albedo;
        // Lambert: `f cos / pdf` is the albedo for cosine-weighted directions and `2 albedo cos` for uniform ones
        let (local, pdf) = match self.plan.directions {
            Directions::Uniform => {
                let local = uniform_hemisphere([u0, u1]);
                path.throughput *= FRAC_1_PI * local.z / UNIFORM_HEMISPHERE_PDF;
                (local, UNIFORM_HEMISPHERE_PDF)
            }
            Directions::Cosine => {
                let local = cosine_hemisphere([u0, u1]);
                (local, local.z * FRAC_1_PI)
            }
        };
        path.direction_pdf = match self.plan.light {
            LightSearch::Chance => MET_BY_CHANCE,
            LightSearch::Sampling => ALREADY_COUNTED,
            LightSearch::Mis => pdf,
        };
        path.from = vertex.point.position;
        let wi = to_world(local, vertex.normal);
        path.ray = Ray::new(vertex.point.leaving_towards(wi), wi);
        self.goes_on(u_roulette)
    }

    /// Counts the vertex and plays roulette.
    #[inline]
    fn goes_on(&mut self, u_roulette: f32) -> bool {
        let path = &mut self.path;
        path.vertices += 1;
        let all_counted = path.direction_pdf == ALREADY_COUNTED && self.world.sky == Vec3::ZERO;
        if path.vertices == self.plan.limit && all_counted {
            self.outcome.cut |= self.plan.capped;
            return false;
        }
        let shared = if path.forked == 0 { 1.0 } else { (self.plan.branches as f32).powi(path.forked as i32) };
        survives(&mut path.throughput, shared, self.plan.roulette, u_roulette)
    }

    /// Incoming radiance times cosine over density, from one sample of the lights; zero in shadow. Under MIS weighted
    /// against meeting the same light by chance.
    #[inline]
    fn sample_lights(&mut self, at: &SurfacePoint, normal: Vec3, u: [f32; 4]) -> Vec3 {
        let Some(sample) = self.world.lights.sample(at.position, u[2], [u[0], u[1]]) else { return Vec3::ZERO };
        let cosine = normal.dot(sample.wi);
        if cosine <= 0.0 {
            return Vec3::ZERO;
        }
        self.outcome.rays += 1;
        if self.world.in_shadow(at, &sample) {
            return Vec3::ZERO;
        }
        let weight = match (self.plan.light, self.plan.directions) {
            (LightSearch::Mis, Directions::Cosine) => balance(sample.pdf, cosine * FRAC_1_PI),
            (LightSearch::Mis, Directions::Uniform) => balance(sample.pdf, UNIFORM_HEMISPHERE_PDF),
            _ => 1.0,
        };
        sample.radiance_over_pdf * (cosine * weight)
    }
}

impl World<'_> {
    /// Density with which light sampling at the path's last vertex draws the direction to this hit.
    fn light_pdf(&self, path: &PathState, hit: &Hit) -> f32 {
        if hit.light == NO_LIGHT { 0.0 } else { self.lights.pdf(hit.light, path.from, &hit.point) }
    }
}

impl PathState {
    /// Goes on in the unit direction `wi`, of which a specular surface left no choice.
    fn leave(&mut self, from: &SurfacePoint, wi: Vec3) {
        self.direction_pdf = MET_BY_CHANCE;
        self.ray = Ray::new(from.leaving_towards(wi), wi);
    }

    /// How much light that was met counts beside the same light sampled at the last vertex with density `light_pdf`.
    #[inline]
    fn weight_of_meeting(&self, light_pdf: impl FnOnce() -> f32) -> f32 {
        if self.direction_pdf == MET_BY_CHANCE {
            1.0
        } else if self.direction_pdf == ALREADY_COUNTED {
            0.0
        } else {
            balance(self.direction_pdf, light_pdf())
        }
    }
}

/// The balance heuristic: the weight of a sample of density `own`, which may be infinite, against one of density `other`.
fn balance(own: f32, other: f32) -> f32 {
    1.0 / (1.0 + other / own)
}

/// Reflects with the probability that Fresnel gives, else refracts; the weights cancel. No scaling of radiance by the
/// square of the index: a camera outside sees the same either way.
fn scatter_dielectric(path: &mut PathState, at: &SurfacePoint, wo: Vec3, ior: f32, u: f32) {
    let normal = facing(at.normal, wo);
    let interface = Interface { ior, entering: at.normal.dot(wo) >= 0.0 };
    let reflected = u < interface.fresnel(normal.dot(wo));
    let refracted = if reflected { None } else { interface.refract(wo, normal) };
    path.leave(at, refracted.unwrap_or_else(|| reflect(wo, normal)).normalize());
}

/// Survival for each unit of throughput. Measured on both of the tutorial's scenes: relMSE times seconds is 1.26e-3 at 1,
/// 1.02e-3 at 1.5, 0.86e-3 at 2, 0.92e-3 at 4 and 2.2e-3 at 16 for the Cornell box, and flat from 1 to 2 for the spheres.
const ROULETTE_SLOPE: f32 = 2.0;

/// Random numbers are multiples of 2^-24: a probability is one as well, or the survivors would be too many by up to that.
const STEPS: f32 = 16_777_216.0;

/// Russian roulette; the survivor carries the light of those that did not. `branches` paths share what one would carry.
fn survives(throughput: &mut Vec3, branches: f32, roulette: Roulette, u: f32) -> bool {
    let mut probability = roulette.probability.unwrap_or(1.0);
    if roulette.throughput {
        probability *= (ROULETTE_SLOPE * branches * throughput.max_element()).min(1.0);
    }
    probability = (probability * STEPS).ceil() / STEPS;
    *throughput /= probability;
    // nothing is left to carry: the product has underflowed, or the surface was black
    u < probability && *throughput != Vec3::ZERO
}
