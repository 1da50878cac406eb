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

use crate::bsdf::Interactions;
use crate::drive::lanes::LaneIntegrator;
use crate::integrator::chain_state::ChainStates;
use crate::integrator::directions::{DirectionsAt, Drawn};
use crate::integrator::forks::{Forks, child};
use crate::integrator::guide::guidance::Guidance;
use crate::integrator::light_paths::{Scattering, counts};
use crate::integrator::path_plan::Plan;
use crate::integrator::path_state::{ALREADY_COUNTED, DiffuseVertices, MET_BY_CHANCE, PathStates, balance};
use crate::integrator::roulette::{SPARED_VERTICES, survivors};
use crate::integrator::settings::{Directions, LightSampling};
use crate::integrator::splits::{ALWAYS_REFRACTED, Splits};
use crate::integrator::waiting::WaitingVertices;
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Intersections, NO_LIGHT, Rays, SurfacePoints};
use crate::prepared::{Outcomes, PreparedScene};
use crate::sampling::sampler::RandomNumbers;
use scene::Vec3;
use simd::{Float, Mask, Vector, Word};

/// Paths, where they walk and what they bring.
pub struct PathLanes<'a, F: Float> {
    pub(super) scene: &'a PreparedScene,
    pub(super) plan: &'a Plan<'a>,
    pub(super) path: PathStates<F>,
    /// Whether there is what connections go by, and light to connect to.
    pub(super) connecting: bool,
    pub(super) chain: ChainStates<F>,
    pub(super) waiting: WaitingVertices<F>,
    /// Where a path comes back to a vertex that waits for more branches, and to which.
    resumed: F::M,
    vertex: DiffuseVertices<F>,
    forks: Forks<F>,
    /// Where a path has met nothing but mirrors and glass.
    pub(super) from_camera: F::M,
    pub(super) splits: Splits<F>,
    pub(super) scratch: Scratch<F>,
    pub(super) outcome: Outcomes<F>,
    guidance: Guidance<'a, F>,
    /// Rays traced.
    pub(super) rays: u64,
}

impl<'a, F: Float, S: RandomNumbers<F::U>> LaneIntegrator<F, S> for PathLanes<'a, F> {
    /// Starts paths along camera rays where `here` says so.
    #[inline(always)]
    fn begin(&mut self, here: F::M, rays: &Rays<F>) {
        let mut leaving = PathStates::leaving_camera(rays);
        if let Some(counted) = &self.plan.counted {
            leaving.light_path = counted.begin();
        }
        self.path = PathStates::select(here, leaving, self.path);
        self.from_camera = self.from_camera | here;
        self.outcome.radiance = Vector::select(here, Vector::zero(), self.outcome.radiance);
        self.outcome.cut = self.outcome.cut & !here;
        if self.connecting {
            self.chain.begin(here);
        }
    }

    /// One segment of the paths in the lanes `taken`; where these, and all their branches, have come to their ends.
    #[inline(always)]
    fn segment(&mut self, taken: F::M, sampler: &S) -> F::M {
        let walking = self.walking(taken);
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
        let mut scattering = met & !at_limit & vertex.scatters();
        if self.plan.branching_vertices > 0 {
            self.fork(scattering & vertex.is_diffuse(), &vertex);
            let DiffuseVertices { point, normal, albedo } = &self.vertex;
            vertex = vertex.or_diffuse(self.resumed, point, *normal, *albedo);
            scattering = scattering | self.resumed;
        }
        if let Some(counted) = &self.plan.counted {
            self.path.light_path = counted.after(self.path.light_path, Scattering::at(&vertex));
            scattering = scattering & !self.path.light_path.eq(F::U::splat(0));
        }
        let u = sampler.unit4(self.path.direction_dimension());
        let mut deserved = self.path.throughput;
        if scattering.any() {
            deserved = self.scatter(scattering, &vertex, sampler, [u[0], u[1], u[3]]);
        }
        let has = self.scene.materials.has();
        let delta = if has.mirrors | has.glass { vertex.is_delta() } else { F::M::splat(false) };
        let before = self.path.throughput;
        let alive = self.goes_on(scattering, delta, deserved, u[2]);
        let ended = taken & !alive;
        let carried = [before, self.path.throughput];
        let mut complete = ended & !self.next_part(ended);
        if self.connecting {
            complete = self.connect_waiting(complete, sampler);
        }
        if self.guidance.learns() {
            self.guidance.note([scattering, ended], carried, self.brought_home(), sampler.pixel_and_sample());
        }
        complete
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
            waiting: WaitingVertices::none(),
            path: PathStates::leaving_camera(&Rays::new(zero, Vector::splat([0.0, 0.0, 1.0]))),
            resumed: F::M::splat(false),
            vertex: DiffuseVertices { point: SurfacePoints::in_the_air(zero), normal: zero, albedo: zero },
            forks: Forks::default(),
            from_camera: F::M::splat(false),
            splits: Splits::default(),
            scratch: Scratch::new(scene.aggregate.shape_list()),
            outcome: Outcomes { radiance: zero, cut: F::M::splat(false) },
            guidance: Guidance::new(plan.guide.as_deref(), plan.notes),
            rays: 0,
        }
    }

    /// Whether what paths find is guided, or guides.
    #[inline(always)]
    pub(super) fn is_guided(&self) -> bool {
        self.plan.guide.is_some() || self.plan.notes.is_some()
    }

    /// The lanes whose paths are on their way.
    #[inline(always)]
    fn walking(&self, taken: F::M) -> F::M {
        let walking = taken & !self.resumed;
        if self.connecting { walking & !self.waiting.lingering() } else { walking }
    }

    /// Goes on with other parts of paths that have `ended`, and says where there is one.
    #[inline(always)]
    fn next_part(&mut self, ended: F::M) -> F::M {
        if self.splits_glass() {
            return self.next_split(ended);
        }
        if self.plan.branching_vertices > 0 {
            self.resumed = self.forks.next(ended, self.plan.branches, &mut self.vertex, &mut self.path);
            return self.resumed;
        }
        F::M::splat(false)
    }

    /// What samples have brought home so far.
    #[inline(always)]
    fn brought_home(&self) -> Vector<F> {
        let radiance = self.outcome.radiance;
        if self.connecting { radiance + self.waiting.found } else { radiance }
    }

    /// Adds radiance that came along the path, where `here` says so and it counts.
    #[inline(always)]
    pub(super) fn receive(&mut self, here: F::M, radiance: Vector<F>) {
        let here = self.counting(here);
        let sum = self.outcome.radiance + self.path.throughput * radiance;
        self.outcome.radiance = Vector::select(here, sum, self.outcome.radiance);
    }

    /// Where light counts that is found now.
    #[inline(always)]
    fn counting(&self, here: F::M) -> F::M {
        if self.plan.counted.is_some() { here & counts(self.path.light_path) } else { here }
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

    /// Samples a light, and takes the directions in which paths leave their vertices, from three random numbers; says what
    /// roulette goes by. Paths that are not `here` have ended, and what becomes of them is of no account: nothing has to be
    /// kept.
    #[inline(always)]
    fn scatter(
        &mut self,
        here: F::M,
        at: &Interactions<F>,
        sampler: &impl RandomNumbers<F::U>,
        u: [F; 3],
    ) -> Vector<F> {
        let delta = at.is_delta();
        let choosing = here & !delta;
        let directions = self.directions(choosing, at);
        let u = self.guidance.bend(choosing & at.is_diffuse(), at, u);
        if self.plan.light != LightSampling::BsdfOnly && !self.scene.lights.is_empty() && choosing.any() {
            self.sample_lights(choosing, at, &directions, sampler.unit4(self.path.light_dimension()));
            if self.connecting {
                self.waiting.arrive(choosing, at, &self.path);
            }
        }
        let splitting = self.splitting(here, at);
        let u = [u[0], u[1], F::select(splitting, F::splat(ALWAYS_REFRACTED), u[2])];
        let mut drawn = directions.sample(here, at, self.path.throughput, u);
        let mut guided = self.path.guided;
        if let Some(ratio) = self.guidance.ratio() {
            drawn = drawn.times_as_dense(ratio);
            guided = guided * ratio;
        }
        let Drawn { sample, throughput, deserved } = drawn;
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
        if self.splits_glass() {
            self.from_camera = self.from_camera & !choosing;
            self.split(splitting, at);
        }
        deserved
    }

    /// How directions are drawn at these vertices, of which those that leave a choice are `choosing`.
    #[inline(always)]
    pub(super) fn directions(&self, choosing: F::M, at: &Interactions<F>) -> DirectionsAt<'a, F> {
        let cones = &self.scene.cones[self.plan.cones as usize];
        let some = !cones.is_empty() && choosing.any();
        DirectionsAt {
            materials: &self.scene.materials,
            uniform: self.plan.directions == Directions::Uniform,
            cones: some.then(|| cones.seen_from(at)),
        }
    }

    /// Counts the vertex and plays roulette; where paths go on.
    #[inline(always)]
    fn goes_on(&mut self, alive: F::M, delta: F::M, deserved: Vector<F>, u_roulette: F) -> F::M {
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
        let (survives, throughput) =
            survivors(path.throughput, deserved, branches, spared, self.plan.roulette, u_roulette);
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
    fn sample_lights(&mut self, here: F::M, at: &Interactions<F>, directions: &DirectionsAt<F>, u: [F; 4]) {
        let sample = self.scene.lights.table().sample(at.point.position, u[2], [u[0], u[1]]);
        let cosine = self.scene.materials.cosine(at, sample.wi);
        let faced = self.counting(here) & sample.shines & cosine.gt(F::splat(0.0));
        self.rays += u64::from(faced.count());
        if !faced.any() {
            return;
        }
        let shadowed = self.scene.in_shadow(&at.point, &sample, faced, false, &mut self.scratch);
        let weighted = match self.plan.light {
            LightSampling::Mis => cosine * balance(sample.pdf, self.direction_pdf(at, directions, sample.wi, cosine)),
            _ => cosine,
        };
        let bsdf = self.scene.materials.eval(at, sample.wi);
        self.receive(faced & !shadowed, bsdf.times(sample.radiance_over_pdf * weighted));
    }

    /// Density per solid angle with which chance takes a direction `wi` whose cosine to the normal is above 0, at vertices
    /// that leave a choice.
    #[inline(always)]
    pub(super) fn direction_pdf(
        &self,
        at: &Interactions<F>,
        directions: &DirectionsAt<F>,
        wi: Vector<F>,
        cosine: F,
    ) -> F {
        self.guidance.pdf(at, wi, directions.pdf(at, wi, cosine))
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
