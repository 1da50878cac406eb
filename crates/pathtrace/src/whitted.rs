//! Whitted-style ray tracing, "An improved illumination model for shaded display" (1980), as on the slides:
//! `L = ka La + kd Id N.L + ks S + kt T`.
//!
//! Diffuse surfaces are lit locally: ambient light times the surface's colour, and for each light Lambert's term behind a
//! shadow ray; there the ray stops. Mirrors and glass always send rays on. Glass splits a ray in two, with Fresnel's
//! shares as `ks` and `kt`: the reflected branch waits on a small stack while the refracted one is followed. Units are the
//! truth's: a surface under irradiance E has radiance `albedo E / pi`.
//!
//! What it cannot do, by design: light from diffuse surfaces on others, blurred reflections, caustics. The sky is seen but
//! does not light; ambient light stands for it.

use crate::bsdf::{Interface, reflect};
use crate::geometry::{Ray, SurfacePoint};
use crate::sampler::Sampler;
use crate::settings::SamplerKind;
use crate::world::{Outcome, World, emitted, facing};
use scene::{Bsdf, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Whether glass stops the light on its way to a diffuse surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum GlassShadows {
    /// Glass throws a black shadow.
    #[default]
    Opaque,
    /// Glass throws none: light passes it straight on and undimmed.
    Clear,
}

impl GlassShadows {
    /// All, the default first.
    pub const ALL: [Self; 2] = [Self::Opaque, Self::Clear];

    /// The name on the command line and in the window.
    pub fn name(self) -> &'static str {
        match self {
            Self::Opaque => "opaque",
            Self::Clear => "clear",
        }
    }

    /// The choice of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|g| g.name() == name)
    }
}

/// The settings of one Whitted picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WhittedSettings {
    /// Specular scatterings along a branch, at most [`WhittedSettings::MOST_DEPTH`]; 0 leaves mirrors and glass black.
    /// What deeper branches would bring is missing.
    pub depth: u32,
    /// Whether glass stops light.
    pub glass_shadows: GlassShadows,
    /// Shadow rays to each lamp and to a sun with a disc, at least 1; a point or a delta sun needs one.
    pub shadow_rays: u32,
    /// Radiance of the ambient light that diffuse surfaces send back, at least 0, grey; `None` is the scene's
    /// [`scene::fake::FakeNumbers::ambient`].
    pub ambient: Option<f32>,
    /// Where random numbers come from.
    pub sampler: SamplerKind,
    /// Selects one of 2^32 independent pictures.
    pub seed: u32,
}

impl WhittedSettings {
    /// Largest depth.
    pub const MOST_DEPTH: u32 = 64;
}

impl Default for WhittedSettings {
    fn default() -> Self {
        WhittedSettings {
            depth: 8,
            glass_shadows: GlassShadows::Opaque,
            shadow_rays: 1,
            ambient: None,
            sampler: SamplerKind::default(),
            seed: 1,
        }
    }
}

/// Branches of one sample before its other ones are cut, and the sample counted in [`crate::Stats::cut_paths`]: between
/// facing pieces of glass each level doubles the rays.
pub const MOST_BRANCHES: u32 = 65_536;

/// Lights up to which each is sampled; of more, this many are chosen by power.
const MOST_LIGHTS: usize = 16;

/// A ray on its way, or waiting.
#[derive(Clone, Copy)]
struct Branch {
    ray: Ray,
    /// What radiance met now is worth at the camera.
    weight: Vec3,
    /// Specular scatterings so far.
    depth: u32,
}

/// Reflected branches that wait, deepest last: at most one for each level. Kept from sample to sample.
pub struct Waiting {
    branches: [Option<Branch>; WhittedSettings::MOST_DEPTH as usize],
    count: usize,
}

impl Default for Waiting {
    fn default() -> Self {
        Waiting { branches: [None; WhittedSettings::MOST_DEPTH as usize], count: 0 }
    }
}

impl Waiting {
    fn push(&mut self, branch: Branch) {
        self.branches[self.count] = Some(branch);
        self.count += 1;
    }

    fn pop(&mut self) -> Option<Branch> {
        self.count = self.count.checked_sub(1)?;
        self.branches[self.count]
    }
}

/// A tree of rays and where it grows.
struct Tree<'a> {
    world: &'a World<'a>,
    settings: &'a WhittedSettings,
    sampler: &'a Sampler,
    /// Ambient radiance.
    ambient: f32,
    /// The next block of random numbers; the camera took block 0.
    dimension: u32,
    /// Branches followed so far.
    followed: u32,
    outcome: Outcome,
}

/// Follows a camera ray through all its branches. `scene_ambient`: radiance of the scene's ambient light.
pub fn trace(
    world: &World,
    ray: Ray,
    scene_ambient: f32,
    settings: &WhittedSettings,
    sampler: &Sampler,
    waiting: &mut Waiting,
) -> Outcome {
    let ambient = settings.ambient.unwrap_or(scene_ambient);
    let mut tree = Tree { world, settings, sampler, ambient, dimension: 1, followed: 0, outcome: Outcome::default() };
    waiting.count = 0;
    let mut next = Some(Branch { ray, weight: Vec3::ONE, depth: 0 });
    while let Some(branch) = next {
        if tree.followed >= MOST_BRANCHES {
            tree.outcome.cut = true;
            break;
        }
        next = tree.follow(branch, waiting).or_else(|| waiting.pop());
    }
    tree.outcome
}

impl Tree<'_> {
    /// Follows a ray to the next surface; the branch that goes on from there, if one does.
    fn follow(&mut self, branch: Branch, waiting: &mut Waiting) -> Option<Branch> {
        let Branch { ray, weight, depth } = branch;
        self.followed += 1;
        self.outcome.rays += 1;
        let Some(hit) = self.world.accel.closest(&ray) else {
            let sun = self.world.sun_disc.as_ref();
            self.outcome.radiance += weight * crate::light::environment(self.world.sky, sun, 1.0, ray.direction);
            return None;
        };
        let material = &self.world.materials[hit.material as usize];
        self.outcome.radiance += weight * emitted(material, hit.point.normal, ray.direction);
        let wo = -ray.direction;
        let normal = facing(hit.point.normal, wo);
        let deeper = depth < self.settings.depth.min(WhittedSettings::MOST_DEPTH);
        let leave = |wi: Vec3, weight: Vec3| Branch {
            ray: Ray::new(hit.point.leaving_towards(wi), wi),
            weight,
            depth: depth + 1,
        };
        match material.bsdf {
            Bsdf::Diffuse { albedo } => {
                let albedo = albedo.at(hit.point.position);
                let direct = if albedo == Vec3::ZERO { Vec3::ZERO } else { self.irradiance(&hit.point, normal) };
                self.outcome.radiance += weight * albedo * (direct * FRAC_1_PI + self.ambient);
                None
            }
            Bsdf::Mirror { reflectance } => {
                let weight = weight * reflectance;
                (deeper && weight != Vec3::ZERO).then(|| leave(reflect(wo, normal), weight))
            }
            Bsdf::Dielectric { ior } if deeper => {
                let interface = Interface { ior, entering: hit.point.normal.dot(wo) >= 0.0 };
                let reflected = interface.fresnel(normal.dot(wo));
                let mirrored = leave(reflect(wo, normal), weight * reflected);
                let refracted = interface.refract(wo, normal).filter(|_| reflected < 1.0);
                let Some(wi) = refracted else { return Some(mirrored) };
                if reflected > 0.0 {
                    waiting.push(mirrored);
                }
                Some(leave(wi.normalize(), weight * (1.0 - reflected)))
            }
            Bsdf::Dielectric { .. } => None,
        }
    }

    /// Light that arrives at a surface: every light by itself, or of very many a choice.
    fn irradiance(&mut self, at: &SurfacePoint, normal: Vec3) -> Vec3 {
        let lights = self.world.lights;
        let rays = self.settings.shadow_rays.max(1);
        let mut sum = Vec3::ZERO;
        for turn in 0..lights.len().min(MOST_LIGHTS) {
            let each = lights.len() <= MOST_LIGHTS;
            let rays = if each && lights.is_delta(turn) { 1 } else { rays };
            let mut of_light = Vec3::ZERO;
            for _ in 0..rays {
                let u = self.sampler.unit4(self.dimension);
                self.dimension += 1;
                let sample = if each {
                    lights.sample_one(turn, at.position, [u[0], u[1]])
                } else {
                    lights.sample(at.position, u[2], [u[0], u[1]])
                };
                let Some(sample) = sample else { continue };
                let cosine = normal.dot(sample.wi);
                if cosine <= 0.0 {
                    continue;
                }
                self.outcome.rays += 1;
                let shadow = match self.settings.glass_shadows {
                    GlassShadows::Opaque => self.world.in_shadow(at, &sample),
                    GlassShadows::Clear => self.world.in_shadow_of_opaque(at, &sample),
                };
                if !shadow {
                    of_light += sample.radiance_over_pdf * cosine;
                }
            }
            let share = if each { 1.0 } else { 1.0 / MOST_LIGHTS as f32 };
            sum += of_light * (share / rays as f32);
        }
        sum
    }
}
