//! Paths, one in each lane: the tutorial's `shade`, turned from recursion into a state that moves from vertex to vertex
//! (Task 2 d).
//!
//! Each [`segment`](LaneIntegrator::segment) is one segment of every path: meet a surface, take
//! its emission, sample a light, draw a direction, play roulette. What only some lanes do is computed for all and
//! selected by a mask; what none does is skipped. The state is all there is: no recursion, no allocation. A bounce
//! limit of N lets N + 1 vertices scatter; what is found by chance is found one segment later, by the last one.
//!
//! With more than one branch ("When N>1: Distributed ray tracing") a diffuse vertex is kept on a small stack, and the
//! path comes back to it until it has left in N directions; each sees the lights anew and counts 1 / N.
//!
//! Twin: `shaders/pathtrace/integrator/path.wgsl`.

use crate::bsdf::{BsdfSamples, Interactions, ScaledColours};
use crate::drive::gpu::film_data::RenderParams;
use crate::drive::gpu::{PipelineKey, flag};
use crate::drive::lanes::{FilmJob, LaneIntegrator, LanePlan};
use crate::integrator::chain_state::ChainStates;
use crate::integrator::forks::{Forks, MOST_FORKS, child};
use crate::integrator::guide::Guide;
use crate::integrator::guide::guidance::Guidance;
use crate::integrator::guide::training::Notes;
use crate::integrator::path_state::{ALREADY_COUNTED, DiffuseVertices, MET_BY_CHANCE, PathStates, balance};
use crate::integrator::roulette::{SPARED_VERTICES, survivors};
use crate::integrator::settings::{Directions, LightSampling, PathSettings, Roulette};
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Intersections, NO_LIGHT, Rays, SurfacePoints};
use crate::prepared::{Outcomes, PreparedScene};
use crate::sampling::UNIFORM_HEMISPHERE_PDF;
use crate::sampling::sampler::RandomNumbers;
use crate::sampling::warp::{to_world, uniform_hemisphere};
use scene::Vec3;
use simd::{Column, Float, Mask, Vector, Word};
use std::sync::Arc;

/// Paths that one sample may branch into.
pub const MOST_BRANCHES: u32 = 65_536;

/// Settings as the walk reads them.
pub struct Plan<'n> {
    pub(super) directions: Directions,
    pub(super) light: LightSampling,
    /// Whether lights that are sampled are connected to by way of spheres as well.
    pub(super) connections: bool,
    roulette: Roulette,
    /// Vertices at which a path may scatter.
    pub(super) limit: u32,
    /// Whether that is the hard cap rather than the user's wish.
    capped: bool,
    branches: u32,
    /// Diffuse vertices of a path that may branch.
    branching_vertices: u32,
    /// `branches` to the power of the vertices that branched.
    paths_after: Column,
    /// Where light comes from, if that was learned.
    guide: Option<Arc<Guide>>,
    /// What is found is written here, for a guide to learn from.
    notes: Option<&'n Notes>,
}

impl<'n> Plan<'n> {
    /// Reads the settings, and learns what they ask for; `None` if the job is stopped meanwhile.
    pub fn of(settings: &PathSettings, job: &FilmJob) -> Option<Self> {
        Some(match settings.estimator.directions {
            Directions::Guided => Self::guided_by(settings, job.guides.of(settings, job)?),
            Directions::Uniform | Directions::Cosine => Self::new(settings),
        })
    }

    /// With a guide that was learned.
    pub fn guided_by(settings: &PathSettings, guide: Arc<Guide>) -> Self {
        Plan { guide: Some(guide), ..Self::new(settings) }
    }

    /// For paths that write down what they find.
    pub fn that_teaches(settings: &PathSettings, notes: &'n Notes) -> Self {
        Plan { notes: Some(notes), ..Self::new(settings) }
    }

    /// Reads the settings; without a guide, paths that ask for one are not guided.
    pub(super) fn new(settings: &PathSettings) -> Self {
        let branches = settings.branches.max(1);
        let forks = 0..=MOST_FORKS as i32;
        Plan {
            directions: settings.estimator.directions,
            light: settings.estimator.light,
            connections: settings.connections && settings.estimator.samples_lights(),
            roulette: settings.roulette,
            limit: settings.scattering_vertices(),
            capped: settings.bounces.is_none(),
            branches,
            branching_vertices: settings.branching_vertices().min(MOST_FORKS as u32),
            paths_after: Column::new(forks.map(|forks| (branches as f32).powi(forks))),
            guide: None,
            notes: None,
        }
    }
}

impl LanePlan for Plan<'_> {
    type LaneState<'a, F: Float>
        = PathLanes<'a, F>
    where
        Self: 'a;

    #[inline(always)]
    fn lane_state<'a, F: Float>(&'a self, scene: &'a PreparedScene) -> PathLanes<'a, F> {
        PathLanes::new(scene, self)
    }
}

/// How light is found.
pub(crate) const BY_CHANCE: u32 = 0;
pub(crate) const BY_SAMPLING: u32 = 1;
pub(crate) const BY_BOTH: u32 = 2;

impl PathSettings {
    pub(super) fn pipeline_key(&self, everything: bool) -> Result<PipelineKey, &'static str> {
        if self.estimator.directions == Directions::Guided {
            return Err("a guide of paths is learned and followed by the processor alone");
        }
        let light_sampling = match self.estimator.light {
            LightSampling::BsdfOnly => BY_CHANCE,
            LightSampling::NextEvent => BY_SAMPLING,
            LightSampling::Mis => BY_BOTH,
        };
        let constants = [
            ("UNIFORM_DIRECTIONS", flag(self.estimator.directions == Directions::Uniform)),
            ("LIGHT_SAMPLING", f64::from(light_sampling)),
            ("BRANCHING", flag(self.branches > 1 || everything)),
            ("CONNECTIONS", flag(self.connections && self.estimator.samples_lights())),
        ];
        Ok(PipelineKey::new("pathtrace/integrator/path.wgsl", self.sampler, &constants))
    }

    pub(super) fn render_params(&self, params: RenderParams) -> RenderParams {
        RenderParams {
            limit: self.scattering_vertices(),
            capped: u32::from(self.bounces.is_none()),
            branches: self.branches.max(1),
            branching_vertices: self.branching_vertices().min(MOST_FORKS as u32),
            by_throughput: u32::from(self.roulette.throughput),
            probability: self.roulette.probability.unwrap_or(1.0),
            ..params
        }
    }
}

/// Paths, where they walk and what they bring.
pub struct PathLanes<'a, F: Float> {
    pub(super) scene: &'a PreparedScene,
    pub(super) plan: &'a Plan<'a>,
    pub(super) path: PathStates<F>,
    /// Whether there is what connections go by, and light to connect to.
    pub(super) connecting: bool,
    pub(super) chain: ChainStates<F>,
    /// Where a path comes back to a vertex that waits for more branches, and to which.
    resumed: F::M,
    vertex: DiffuseVertices<F>,
    forks: Forks<F>,
    pub(super) scratch: Scratch<F>,
    outcome: Outcomes<F>,
    guidance: Guidance<'a, F>,
    /// Rays traced.
    pub(super) rays: u64,
}

impl<'a, F: Float, S: RandomNumbers<F::U>> LaneIntegrator<F, S> for PathLanes<'a, F> {
    /// Starts paths along camera rays where `here` says so.
    #[inline(always)]
    fn begin(&mut self, here: F::M, rays: &Rays<F>) {
        self.path = PathStates::select(here, PathStates::leaving_camera(rays), self.path);
        self.outcome.radiance = Vector::select(here, Vector::zero(), self.outcome.radiance);
        self.outcome.cut = self.outcome.cut & !here;
        if self.connecting {
            self.chain.begin(here);
        }
    }

    /// One segment of the paths in the lanes `taken`; where these, and all their branches, have come to their ends.
    #[inline(always)]
    fn segment(&mut self, taken: F::M, sampler: &S) -> F::M {
        let walking = taken & !self.resumed;
        self.rays += u64::from(walking.count());
        let hit = self.scene.closest(&self.path.rays, walking, &mut self.scratch);
        let missed = walking & !hit.met;
        let met = walking & hit.met;
        if self.scene.has_environment() && missed.any() {
            let weight = self.weight_of_endless(missed, F::splat(self.scene.sun_pdf));
            self.receive(missed, self.scene.environment(self.path.rays.direction, weight));
        }
        if let Some(environment) = self.scene.lights.environment()
            && missed.any()
        {
            let (radiance, pdf) = environment.look_up_lanes(self.path.rays.direction);
            self.receive(missed, radiance * self.weight_of_environment(missed, pdf));
        }
        let wo = -self.path.rays.direction;
        let shining = met & self.scene.shines(&hit);
        if self.scene.materials.has().area_lights && shining.any() {
            let weight = self.weight_of_meeting(shining, &hit);
            self.receive(shining, self.scene.emitted(&hit, wo) * weight);
        }
        let at_limit = met & self.path.vertices.eq(F::U::splat(self.plan.limit));
        self.cut(at_limit);
        let mut vertex = self.scene.interaction(&hit, wo);
        let mut scattering = met & !at_limit & !vertex.colour.is_zero();
        if self.plan.branching_vertices > 0 {
            self.fork(scattering & vertex.is_diffuse(), &vertex);
            let DiffuseVertices { point, normal, albedo } = &self.vertex;
            vertex = vertex.or_diffuse(self.resumed, point, *normal, *albedo);
            scattering = scattering | self.resumed;
        }
        let u = sampler.unit4(self.path.direction_dimension());
        if scattering.any() {
            self.scatter(scattering, &vertex, sampler, [u[0], u[1], u[3]]);
        }
        let has = self.scene.materials.has();
        let delta = if has.mirrors | has.glass { vertex.is_delta() } else { F::M::splat(false) };
        let before = self.path.throughput;
        let alive = self.goes_on(scattering, delta, u[2]);
        let ended = taken & !alive;
        if self.guidance.learns() {
            let carried = [before, self.path.throughput];
            self.guidance.note([scattering, ended], carried, self.outcome.radiance, sampler.pixel_and_sample());
        }
        if self.plan.branching_vertices > 0 {
            self.resumed = self.forks.next(ended, self.plan.branches, &mut self.vertex, &mut self.path);
            return ended & !self.resumed;
        }
        ended
    }

    #[inline(always)]
    fn outcomes(&self) -> &Outcomes<F> {
        &self.outcome
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}

impl<'a, F: Float> PathLanes<'a, F> {
    /// No path yet.
    #[inline(always)]
    pub fn new(scene: &'a PreparedScene, plan: &'a Plan<'a>) -> Self {
        let zero = Vector::zero();
        PathLanes {
            scene,
            plan,
            connecting: plan.connections && !scene.casters.is_empty() && !scene.lights.is_empty(),
            chain: ChainStates::none(),
            path: PathStates::leaving_camera(&Rays::new(zero, Vector::splat([0.0, 0.0, 1.0]))),
            resumed: F::M::splat(false),
            vertex: DiffuseVertices { point: SurfacePoints::in_the_air(zero), normal: zero, albedo: zero },
            forks: Forks::default(),
            scratch: Scratch::new(scene.aggregate.shape_list()),
            outcome: Outcomes { radiance: zero, cut: F::M::splat(false) },
            guidance: Guidance::new(plan.guide.as_deref(), plan.notes),
            rays: 0,
        }
    }

    /// Adds radiance that came along the path, where `here` says so.
    #[inline(always)]
    pub(super) fn receive(&mut self, here: F::M, radiance: Vector<F>) {
        let sum = self.outcome.radiance + self.path.throughput * radiance;
        self.outcome.radiance = Vector::select(here, sum, self.outcome.radiance);
    }

    /// Notes paths that end although no setting asked for it.
    #[inline(always)]
    fn cut(&mut self, here: F::M) {
        if self.plan.capped {
            self.outcome.cut = self.outcome.cut | here;
        }
    }

    /// Lets diffuse vertices wait for more branches, and goes on with the first.
    #[inline(always)]
    fn fork(&mut self, diffuse: F::M, at: &Interactions<F>) {
        let here = diffuse & self.path.forked.lt(F::U::splat(self.plan.branching_vertices));
        if !here.any() {
            return;
        }
        let mut path = self.path;
        path.forked = path.forked.wrapping_add(F::U::splat(1));
        path.throughput = path.throughput.divided_by(F::splat(self.plan.branches as f32));
        let vertex = DiffuseVertices { point: at.point, normal: at.normal, albedo: at.colour };
        self.forks.push(here, &vertex, &path, self.plan.branches - 1);
        path.branch = child::<F>(path.branch, self.plan.branches, F::U::splat(0));
        self.path = PathStates::select(here, path, self.path);
    }

    /// Samples a light, and takes the directions in which paths leave their vertices, from three random numbers. Paths that
    /// are not `here` have ended, and what becomes of them is of no account: nothing has to be kept.
    #[inline(always)]
    fn scatter(&mut self, here: F::M, at: &Interactions<F>, sampler: &impl RandomNumbers<F::U>, u: [F; 3]) {
        let delta = at.is_delta();
        let uniform = self.plan.directions == Directions::Uniform;
        let choosing = here & !delta;
        let u = self.guidance.bend(choosing & at.is_diffuse(), at, u);
        if self.plan.light != LightSampling::BsdfOnly && !self.scene.lights.is_empty() && choosing.any() {
            self.sample_lights(choosing, at, sampler.unit4(self.path.light_dimension()));
            if self.connecting {
                self.connect(choosing, at, sampler.unit4(self.path.connection_dimension()));
            }
        }
        let mut sample = self.scene.materials.sample(if uniform { here & delta } else { here }, at, u);
        let mut throughput = self.path.throughput * sample.weight;
        if uniform {
            let (drawn, weight) = self.sample_uniformly(at, [u[0], u[1]]);
            throughput = Vector::select(delta, throughput, weight.times(self.path.throughput));
            sample = BsdfSamples::select(delta, sample, drawn);
        }
        let mut guided = self.path.guided;
        if let Some(ratio) = self.guidance.ratio() {
            throughput = throughput.divided_by(ratio);
            sample.pdf = sample.pdf * ratio;
            guided = guided * ratio;
        }
        let direction_pdf = match self.plan.light {
            LightSampling::BsdfOnly => F::splat(MET_BY_CHANCE),
            LightSampling::NextEvent => F::select(delta, F::splat(MET_BY_CHANCE), F::splat(ALREADY_COUNTED)),
            LightSampling::Mis => sample.pdf,
        };
        if self.connecting {
            self.chain.leave(choosing, at.point.position, sample.pdf);
            self.chain.scatter(here & delta, at, sample.wi, self.scene.casters.materials());
        }
        let rays = Rays::new(at.point.leaving_towards(sample.wi), sample.wi);
        self.path = PathStates { rays, throughput, from: at.point.position, direction_pdf, guided, ..self.path };
    }

    /// Directions of the tutorial's naive tracer, whatever the surface (Task 2 b), and their weights.
    #[inline(always)]
    fn sample_uniformly(&self, at: &Interactions<F>, u: [F; 2]) -> (BsdfSamples<F>, ScaledColours<F>) {
        let local = uniform_hemisphere(u);
        let wi = to_world(local, at.normal);
        let mut weight = self.scene.materials.eval(at, wi);
        weight.factor = local.z * (weight.factor / F::splat(UNIFORM_HEMISPHERE_PDF));
        (BsdfSamples { wi, weight: weight.colour, pdf: F::splat(UNIFORM_HEMISPHERE_PDF) }, weight)
    }

    /// Counts the vertex and plays roulette; where paths go on.
    #[inline(always)]
    fn goes_on(&mut self, alive: F::M, delta: F::M, u_roulette: F) -> F::M {
        let path = &mut self.path;
        let spared = delta & path.vertices.lt(F::U::splat(SPARED_VERTICES));
        path.vertices = path.vertices.wrapping_add(F::U::splat(1));
        let mut alive = alive;
        if self.scene.sky == Vec3::ZERO {
            let all_counted = path.direction_pdf.eq(F::splat(ALREADY_COUNTED));
            let at_limit = alive & path.vertices.eq(F::U::splat(self.plan.limit)) & all_counted;
            if self.plan.capped {
                self.outcome.cut = self.outcome.cut | at_limit;
            }
            alive = alive & !at_limit;
        }
        let mut branches = F::splat(1.0);
        if self.plan.branching_vertices > 0 {
            branches = path.forked.look_up(&self.plan.paths_after);
        }
        // the guide's choices are no reason to end: only what the surfaces have taken is
        branches = branches * path.guided;
        let (survives, throughput) = survivors(path.throughput, branches, spared, self.plan.roulette, u_roulette);
        let before = std::mem::replace(&mut path.throughput, throughput);
        if self.plan.guide.is_some() {
            let carried = Vector::select(survives, path.throughput, Vector::zero());
            let made_up = self.guidance.made_up_for(alive, before - carried);
            self.outcome.radiance = self.outcome.radiance + made_up;
        }
        alive & survives
    }

    /// Takes the light of one sample of the lights, where it is not in shadow. Under MIS weighted against meeting the
    /// same light by chance.
    #[inline(always)]
    fn sample_lights(&mut self, here: F::M, at: &Interactions<F>, u: [F; 4]) {
        let sample = self.scene.lights.table().sample(at.point.position, u[2], [u[0], u[1]]);
        let cosine = at.normal.dot(sample.wi);
        let faced = here & sample.shines & cosine.gt(F::splat(0.0));
        self.rays += u64::from(faced.count());
        if !faced.any() {
            return;
        }
        let shadowed = self.scene.in_shadow(&at.point, &sample, faced, false, &mut self.scratch);
        let weighted = match self.plan.light {
            LightSampling::Mis => cosine * balance(sample.pdf, self.direction_pdf(at, sample.wi, cosine)),
            _ => cosine,
        };
        let bsdf = self.scene.materials.eval(at, sample.wi);
        self.receive(faced & !shadowed, bsdf.times(sample.radiance_over_pdf * weighted));
    }

    /// Density per solid angle with which chance takes a direction at this cosine to the normal of a surface that leaves a
    /// choice.
    #[inline(always)]
    pub(super) fn direction_pdf(&self, at: &Interactions<F>, wi: Vector<F>, cosine: F) -> F {
        match self.plan.directions {
            Directions::Cosine => self.scene.materials.pdf(at, wi, cosine),
            Directions::Guided => self.guidance.pdf(at, wi, self.scene.materials.pdf(at, wi, cosine)),
            Directions::Uniform => F::splat(UNIFORM_HEMISPHERE_PDF),
        }
    }

    /// How much the light of these hits counts, beside the same light sampled.
    #[inline(always)]
    fn weight_of_meeting(&self, shining: F::M, hit: &Intersections<F>) -> F {
        let mis = self.plan.light == LightSampling::Mis;
        let weight = self.path.weight_of_meeting(if mis { self.light_pdf(hit) } else { F::splat(0.0) });
        if self.connecting { weight * self.weight_of_chain_to_hit(shining, hit) } else { weight }
    }

    /// How much light from where rays hit nothing counts, beside the same light sampled with this density.
    #[inline(always)]
    fn weight_of_endless(&self, missed: F::M, pdf: F) -> F {
        let weight = self.path.weight_of_meeting(pdf);
        if self.connecting { weight * self.weight_of_chain_to_sky(missed, pdf) } else { weight }
    }

    /// The same of a sky that is a picture.
    #[inline(always)]
    fn weight_of_environment(&self, missed: F::M, pdf: F) -> F {
        if self.plan.light == LightSampling::Mis {
            return self.weight_of_endless(missed, pdf);
        }
        self.path.weight_of_meeting(pdf)
    }

    /// Density with which light sampling at the paths' last vertices draws the directions to these hits.
    #[inline(always)]
    fn light_pdf(&self, hit: &Intersections<F>) -> F {
        let pdf = self.scene.lights.table().pdf(hit.light, self.path.from, hit.point.position);
        F::select(hit.light.eq(F::U::splat(NO_LIGHT)), F::splat(0.0), pdf)
    }
}
