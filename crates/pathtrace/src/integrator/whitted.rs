//! Whitted-style ray tracing, "An improved illumination model for shaded display" (1980), as on the slides:
//! `L = ka La + kd Id N.L + ks S + kt T`.
//!
//! Diffuse surfaces are lit locally: ambient light times the surface's colour, and for each light Lambert's term behind
//! a shadow ray; there the ray stops. Mirrors and glass always send rays on. Glass splits a ray in two, with Fresnel's
//! shares as `ks` and `kt`: the reflected branch waits on a small stack while the refracted one is followed. Units are
//! the truth's: a surface under irradiance E has radiance `albedo E / pi`.
//!
//! What it cannot do, by design: light from diffuse surfaces on others, blurred reflections, caustics. The sky is seen
//! but does not light; ambient light stands for it. A sky from a picture is one of the lights, and lights as they do.
//!
//! Twin: `shaders/pathtrace/integrator/whitted.wgsl`.

use crate::bsdf::Interactions;
use crate::drive::gpu::film_data::RenderParams;
use crate::drive::gpu::{PipelineKey, flag};
use crate::drive::lanes::{LaneIntegrator, LanePlan};
use crate::integrator::branches::{Branches, Waiting};
use crate::integrator::light_paths::{self, CountedPaths, LightPaths, Scattering, counts};
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Rays, SurfacePoints};
use crate::prepared::{Outcomes, PreparedScene};
use crate::sampling::sampler::Sampler;
use crate::sampling::sampler::SamplerKind;
use scene::stand_ins::FakeNumbers;
use simd::{Float, Mask, Vector, Word};
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
    /// Shadow rays to each area light and to a sun with a disc, at least 1; a point or a delta sun needs one.
    pub shadow_rays: u32,
    /// Radiance of the ambient light that diffuse surfaces send back, at least 0, grey; `None` is the scene's
    /// [`scene::stand_ins::FakeNumbers::ambient`].
    pub ambient: Option<f32>,
    /// Which light counts. Ambient light stands for what comes from other diffuse surfaces, and counts where light would
    /// that one of these sends.
    pub paths: LightPaths,
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
            paths: LightPaths::ALL,
            sampler: SamplerKind::default(),
            seed: 1,
        }
    }
}

impl WhittedSettings {
    /// Radiance of the ambient light, in a scene with these stand-ins.
    fn ambient_radiance(&self, stand_ins: &FakeNumbers) -> f32 {
        self.ambient.unwrap_or(stand_ins.ambient)
    }

    pub(super) fn pipeline_key(&self) -> PipelineKey {
        let constants = [
            ("CLEAR_GLASS", flag(self.glass_shadows == GlassShadows::Clear)),
            ("LIGHT_PATHS", flag(!self.paths.is_all())),
        ];
        PipelineKey::new("pathtrace/integrator/whitted.wgsl", self.sampler, &constants)
    }

    pub(super) fn render_params(&self, params: RenderParams, stand_ins: &FakeNumbers) -> RenderParams {
        RenderParams {
            limit: self.depth.min(Self::MOST_DEPTH),
            shadow_rays: self.shadow_rays.max(1),
            ambient: self.ambient_radiance(stand_ins),
            light_paths: light_paths::rows(&self.paths),
            ..params
        }
    }
}

/// Settings as the walk reads them.
pub struct Plan {
    settings: WhittedSettings,
    /// Ambient radiance.
    ambient: f32,
    /// Which light counts; `None` where all does.
    counted: Option<CountedPaths>,
}

impl Plan {
    /// Reads the settings, and what stands in for them in the scene.
    pub fn new(settings: &WhittedSettings, stand_ins: &FakeNumbers) -> Self {
        let counted = CountedPaths::of(&settings.paths);
        Plan { settings: *settings, ambient: settings.ambient_radiance(stand_ins), counted }
    }
}

impl LanePlan for Plan {
    type LaneState<'a, F: Float> = WhittedLanes<'a, F>;

    #[inline(always)]
    fn lane_state<'a, F: Float>(&'a self, scene: &'a PreparedScene) -> WhittedLanes<'a, F> {
        WhittedLanes::new(scene, self)
    }
}

/// Branches of one sample before its other ones are cut, and the sample counted in [`crate::Stats::cut_paths`]: between
/// facing pieces of glass each level doubles the rays.
pub const MOST_BRANCHES: u32 = 65_536;

/// Lights up to which each is sampled; of more, this many are chosen by power.
pub(crate) const MOST_LIGHTS: usize = 16;

/// A tree of rays in each lane, and where they grow.
pub struct WhittedLanes<'a, F: Float> {
    scene: &'a PreparedScene,
    plan: &'a Plan,
    branch: Branches<F>,
    waiting: Waiting<F>,
    /// The next block of random numbers; the camera took block 0.
    dimension: F::U,
    /// Branches followed so far.
    followed: F::U,
    scratch: Scratch<F>,
    outcome: Outcomes<F>,
    /// Rays traced.
    rays: u64,
}

impl<'a, F: Float> LaneIntegrator<F> for WhittedLanes<'a, F> {
    /// Starts trees with camera rays where `here` says so.
    #[inline(always)]
    fn begin(&mut self, here: F::M, rays: &Rays<F>) {
        let mut leaving = Branches::leaving_camera(rays);
        if let Some(counted) = &self.plan.counted {
            leaving.light_path = counted.begin();
        }
        self.branch = Branches::select(here, leaving, self.branch);
        self.outcome.radiance = Vector::select(here, Vector::zero(), self.outcome.radiance);
        self.outcome.cut = self.outcome.cut & !here;
        let (none, one) = (F::U::splat(0), F::U::splat(1));
        self.dimension = F::U::select(here, one, self.dimension);
        self.followed = F::U::select(here, none, self.followed);
        self.waiting.count = F::U::select(here, none, self.waiting.count);
    }

    /// Follows a branch of each tree to the next surface; where trees are complete.
    #[inline(always)]
    fn segment(&mut self, taken: F::M, sampler: &Sampler<F::U>) -> F::M {
        self.rays += u64::from(taken.count());
        self.followed = self.followed.wrapping_add(F::U::splat(1));
        let hit = self.scene.closest(&self.branch.rays, taken, &mut self.scratch);
        let (missed, met) = (taken & !hit.met, taken & hit.met);
        let direction = self.branch.rays.direction;
        if self.scene.has_environment() && missed.any() {
            self.receive(missed, self.scene.environment(direction, F::splat(1.0)));
        }
        if let Some(environment) = self.scene.lights.environment()
            && missed.any()
        {
            self.receive(missed, environment.look_up_lanes(direction).0);
        }
        let shining = met & self.scene.shines(&hit);
        if self.scene.materials.has().area_lights && shining.any() {
            self.receive(shining, self.scene.emitted(&hit, -direction));
        }
        let at = self.scene.interaction(&hit, -direction);
        let alive = self.scatter(met, &at, sampler);
        let ended = taken & !alive;
        let alive = alive | self.waiting.pop(ended, &mut self.branch);
        let too_many = alive & !self.followed.lt(F::U::splat(MOST_BRANCHES));
        self.outcome.cut = self.outcome.cut | too_many;
        (taken & !alive) | too_many
    }

    #[inline(always)]
    fn outcomes(&self) -> &Outcomes<F> {
        &self.outcome
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}

impl<'a, F: Float> WhittedLanes<'a, F> {
    /// No tree yet.
    #[inline(always)]
    pub fn new(scene: &'a PreparedScene, plan: &'a Plan) -> Self {
        let none = F::U::splat(0);
        WhittedLanes {
            scene,
            plan,
            branch: Branches::leaving_camera(&Rays::new(Vector::zero(), Vector::splat([0.0, 0.0, 1.0]))),
            waiting: Waiting { branches: Vec::new(), count: none },
            dimension: none,
            followed: none,
            scratch: Scratch::new(scene.aggregate.shape_list()),
            outcome: Outcomes { radiance: Vector::zero(), cut: F::M::splat(false) },
            rays: 0,
        }
    }

    /// Adds radiance that came along the branch, where `here` says so and it counts.
    #[inline(always)]
    fn receive(&mut self, here: F::M, radiance: Vector<F>) {
        self.add(self.counting(here), radiance);
    }

    /// Where light counts that is found now.
    #[inline(always)]
    fn counting(&self, here: F::M) -> F::M {
        if self.plan.counted.is_some() { here & counts(self.branch.light_path) } else { here }
    }

    #[inline(always)]
    fn add(&mut self, here: F::M, radiance: Vector<F>) {
        let sum = self.outcome.radiance + self.branch.weight * radiance;
        self.outcome.radiance = Vector::select(here, sum, self.outcome.radiance);
    }

    /// Lights diffuse surfaces, and sends branches on from others; where they go on.
    #[inline(always)]
    fn scatter(&mut self, met: F::M, at: &Interactions<F>, sampler: &Sampler<F::U>) -> F::M {
        if let Some(counted) = &self.plan.counted {
            self.branch.light_path = counted.after(self.branch.light_path, Scattering::at(at));
        }
        let albedo = self.scene.materials.lit_albedo(at);
        let lit = met & !albedo.is_zero();
        if lit.any() {
            self.light(lit, at, albedo, sampler);
        }
        let most_depth = self.plan.settings.depth.min(WhittedSettings::MOST_DEPTH);
        let deeper = met & !at.is_diffuse() & self.branch.depth.lt(F::U::splat(most_depth));
        if !deeper.any() {
            return deeper;
        }
        let specular = self.scene.materials.speculars(deeper, at);
        let came = self.branch;
        let reflected = came.leave(&at.point, specular.reflected, specular.reflectance.times(came.weight));
        let refracted = came.leave(&at.point, specular.refracted, came.weight * specular.transmittance);
        self.waiting.push(specular.reflects & specular.refracts, &reflected);
        let goes_on = specular.reflects | specular.refracts;
        let leaves = Branches::select(specular.refracts, refracted, reflected);
        self.branch = Branches::select(goes_on, leaves, self.branch);
        goes_on
    }

    /// Adds the light that diffuse surfaces send along the branches: direct, and the ambient that stands for the rest.
    #[inline(always)]
    fn light(&mut self, lit: F::M, at: &Interactions<F>, albedo: Vector<F>, sampler: &Sampler<F::U>) {
        let direct = self.irradiance(lit, &at.point, at.normal, sampler);
        let mut ambient = Vector::along_all(F::splat(self.plan.ambient));
        if let Some(counted) = &self.plan.counted {
            let arrives = counts(counted.after_diffuse(self.branch.light_path));
            ambient = Vector::select(arrives, ambient, Vector::zero());
        }
        self.add(lit, albedo * (direct * F::splat(FRAC_1_PI) + ambient));
    }

    /// Light that arrives at surfaces: every light by itself, or of very many a choice.
    #[inline(always)]
    fn irradiance(
        &mut self,
        here: F::M,
        at: &SurfacePoints<F>,
        normal: Vector<F>,
        sampler: &Sampler<F::U>,
    ) -> Vector<F> {
        let lights = &self.scene.lights;
        let rays = self.plan.settings.shadow_rays.max(1);
        // the others draw their random numbers all the same: those of other branches do not depend on what counts
        let counting = self.counting(here);
        let opaque = self.plan.settings.glass_shadows == GlassShadows::Clear;
        let mut sum = Vector::zero();
        for turn in 0..lights.len().min(MOST_LIGHTS) {
            let each = lights.len() <= MOST_LIGHTS;
            let delta = each && lights.is_delta(turn);
            let rays = if delta { 1 } else { rays };
            let mut of_light = Vector::zero();
            for _ in 0..rays {
                // of a delta light there is nothing to choose
                let u = if delta { [F::splat(0.0); 4] } else { sampler.unit4(self.dimension) };
                let next = self.dimension.wrapping_add(F::U::splat(1));
                self.dimension = F::U::select(here, next, self.dimension);
                let sample = if each {
                    lights.table().sample_one(F::U::splat(turn as u32), at.position, [u[0], u[1]])
                } else {
                    lights.table().sample(at.position, u[2], [u[0], u[1]])
                };
                let cosine = normal.dot(sample.wi);
                let faced = counting & sample.shines & cosine.gt(F::splat(0.0));
                self.rays += u64::from(faced.count());
                if faced.any() {
                    let shadow = self.scene.in_shadow(at, &sample, faced, opaque, &mut self.scratch);
                    let cosine = self.scene.materials.shadowed(normal, at.normal, sample.wi, cosine);
                    let arrives = of_light + sample.radiance_over_pdf * cosine;
                    of_light = Vector::select(faced & !shadow, arrives, of_light);
                }
            }
            let share = if each { 1.0 } else { 1.0 / MOST_LIGHTS as f32 };
            sum = sum + of_light * F::splat(share / rays as f32);
        }
        sum
    }
}
