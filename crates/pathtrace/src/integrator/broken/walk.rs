//! The tutorial's path tracer, plain: one direction at each vertex, one sample of the lights, no way by spheres and no
//! cones. Its bugs are what [`super::wrong`] makes of each factor; without one it tends to what [`crate::integrator::path`]
//! tends to. One ray at a time: it is there to be read and to be wrong, and is compiled once, not for each kind of lanes.
//!
//! Twin: `shaders/pathtrace/integrator/broken/walk.wgsl`.

use super::Bugs;
use super::wrong::Wrong;
use crate::bsdf::Interactions;
use crate::drive::gpu::{PipelineKey, flag};
use crate::drive::lanes::{LaneIntegrator, LanePlan};
use crate::integrator::directions::{DirectionsAt, Drawn};
use crate::integrator::light_paths::{CountedPaths, Scattering, counts};
use crate::integrator::path_state::{ALREADY_COUNTED, MET_BY_CHANCE, PathStates, balance};
use crate::integrator::roulette::{SPARED_VERTICES, survivors};
use crate::integrator::settings::{Directions, LightSampling, PathSettings, Roulette};
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Intersections, NO_LIGHT, Rays};
use crate::prepared::{Outcomes, PreparedScene};
use crate::sampling::UNIFORM_HEMISPHERE_PDF;
use crate::sampling::sampler::Sampler;
use simd::{Float, Mask, Vector, Word};

/// Settings as the walk reads them.
pub struct Plan {
    wrong: Wrong,
    uniform: bool,
    light: LightSampling,
    roulette: Roulette,
    /// Vertices at which a path may scatter.
    limit: u32,
    /// Whether that is the hard cap rather than the user's wish.
    capped: bool,
    /// Which light counts; `None` where all does.
    counted: Option<CountedPaths>,
}

impl Plan {
    /// With these bugs, whatever the settings say of them.
    pub fn new(settings: &PathSettings, bugs: Bugs) -> Self {
        Plan {
            wrong: Wrong(bugs),
            uniform: settings.estimator.directions == Directions::Uniform,
            light: settings.estimator.light,
            roulette: settings.roulette,
            limit: settings.scattering_vertices(),
            capped: settings.bounces.is_none(),
            counted: CountedPaths::of(&settings.paths),
        }
    }
}

impl LanePlan for Plan {
    type LaneState<'a, F: Float> = WalkLanes<'a, F>;

    #[inline(always)]
    fn lane_state<'a, F: Float>(&'a self, scene: &'a PreparedScene) -> WalkLanes<'a, F> {
        let zero = Vector::zero();
        WalkLanes {
            scene,
            plan: self,
            path: PathStates::leaving_camera(&Rays::new(zero, Vector::splat([0.0, 0.0, 1.0]))),
            scratch: Scratch::new(scene.aggregate.shape_list()),
            outcome: Outcomes { radiance: zero, cut: F::M::splat(false) },
            rays: 0,
        }
    }
}

/// A path in each lane.
pub struct WalkLanes<'a, F: Float> {
    scene: &'a PreparedScene,
    plan: &'a Plan,
    path: PathStates<F>,
    scratch: Scratch<F>,
    outcome: Outcomes<F>,
    rays: u64,
}

impl<F: Float> LaneIntegrator<F> for WalkLanes<'_, F> {
    #[inline(always)]
    fn begin(&mut self, here: F::M, rays: &Rays<F>) {
        let mut leaving = PathStates::leaving_camera(rays);
        if let Some(counted) = &self.plan.counted {
            leaving.light_path = counted.begin();
        }
        self.path = PathStates::select(here, leaving, self.path);
        self.outcome.radiance = Vector::select(here, Vector::zero(), self.outcome.radiance);
        self.outcome.cut = self.outcome.cut & !here;
    }

    #[inline(always)]
    fn segment(&mut self, taken: F::M, sampler: &Sampler<F::U>) -> F::M {
        let sampler = self.plan.wrong.numbers(sampler);
        self.rays += u64::from(taken.count());
        let hit = self.scene.closest(&self.path.rays, taken, &mut self.scratch);
        let (missed, met) = (taken & !hit.met, taken & hit.met);
        self.meet_the_sky(missed);
        let wo = -self.path.rays.direction;
        let shining = met & self.scene.shines(&hit);
        if self.scene.materials.has().area_lights && shining.any() {
            let weight = self.path.weight_of_meeting(self.light_pdf(&hit));
            self.receive(shining, self.scene.emitted(&hit, wo) * weight);
        }
        let at_limit = met & self.path.vertices.eq(F::U::splat(self.plan.limit));
        self.cut(at_limit);
        let vertex = self.plan.wrong.seen(self.scene.interaction(&hit, wo));
        let mut scattering = met & !at_limit & vertex.scatters();
        if let Some(counted) = &self.plan.counted {
            self.path.light_path = counted.after(self.path.light_path, Scattering::at(&vertex));
            scattering = scattering & !self.path.light_path.eq(F::U::splat(0));
        }
        let mut alive = scattering;
        if scattering.any() {
            let choosing = scattering & !vertex.is_delta();
            if self.plan.light != LightSampling::BsdfOnly && !self.scene.lights.is_empty() && choosing.any() {
                self.sample_lights(choosing, &vertex, sampler.unit4(self.path.light_dimension()));
            }
            let u = sampler.unit4(self.path.direction_dimension());
            let deserved = self.draw_direction(scattering, &vertex, [u[0], u[1], u[3]]);
            alive = self.goes_on(scattering, vertex.is_delta(), deserved, u[2]);
        }
        let complete = taken & !alive;
        let brought = self.plan.wrong.sample(self.outcome.radiance);
        self.outcome.radiance = Vector::select(complete, brought, self.outcome.radiance);
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

impl<'a, F: Float> WalkLanes<'a, F> {
    /// Adds radiance that came along the path, where `here` says so and it counts.
    #[inline(always)]
    fn receive(&mut self, here: F::M, radiance: Vector<F>) {
        let here = self.counting(here);
        let sum = self.outcome.radiance + self.path.throughput * radiance;
        self.outcome.radiance = Vector::select(here, sum, self.outcome.radiance);
    }

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

    /// Sky and sun, where paths `missed` everything.
    #[inline(always)]
    fn meet_the_sky(&mut self, missed: F::M) {
        if self.scene.has_environment() && missed.any() {
            let weight = self.path.weight_of_meeting(F::splat(self.scene.sun_pdf));
            self.receive(missed, self.scene.environment(self.path.rays.direction, weight));
        }
        if let Some(environment) = self.scene.lights.environment()
            && missed.any()
        {
            let (radiance, pdf) = environment.look_up_lanes(self.path.rays.direction);
            self.receive(missed, radiance * self.path.weight_of_meeting(pdf));
        }
    }

    /// How vertices draw directions.
    #[inline(always)]
    fn directions(&self) -> DirectionsAt<'a, F> {
        DirectionsAt { materials: &self.scene.materials, uniform: self.plan.uniform, cones: None }
    }

    /// Takes the light of one sample of the lights, where it is not in shadow. Under MIS weighted against meeting the
    /// same light by chance.
    #[inline(always)]
    fn sample_lights(&mut self, here: F::M, at: &Interactions<F>, u: [F; 4]) {
        let (wrong, x, table) = (self.plan.wrong, at.point.position, self.scene.lights.table());
        let sample = wrong.light(table, x, table.sample(x, u[2], [u[0], u[1]]), u[3]);
        let cosine = self.scene.materials.cosine(at, sample.wi);
        let faced = self.counting(here) & sample.shines & cosine.gt(F::splat(0.0));
        self.rays += u64::from(faced.count());
        if !faced.any() {
            return;
        }
        let shadowed = wrong.in_shadow(self.scene, &at.point, &sample, faced, &mut self.scratch);
        let weight = match self.plan.light {
            LightSampling::Mis if !wrong.counts_emission_twice() => {
                balance(sample.pdf, self.directions().pdf(at, sample.wi, cosine))
            }
            _ => F::splat(1.0),
        };
        let bsdf = self.scene.materials.eval(at, sample.wi);
        let factor = wrong.cosine(cosine) * wrong.of_brdf(at) * weight;
        self.receive(faced & !shadowed, bsdf.times(sample.radiance_over_pdf * factor));
    }

    /// Takes the directions in which paths leave their vertices; says what roulette goes by.
    #[inline(always)]
    fn draw_direction(&mut self, here: F::M, at: &Interactions<F>, u: [F; 3]) -> Vector<F> {
        let (delta, wrong) = (at.is_delta(), self.plan.wrong);
        let Drawn { sample, throughput, deserved } = self.directions().sample(here, at, self.path.throughput, u);
        let cosine = self.scene.materials.cosine(at, sample.wi);
        let uniform = F::splat(UNIFORM_HEMISPHERE_PDF);
        let others = if self.plan.uniform { self.scene.materials.pdf(at, sample.wi, cosine) } else { uniform };
        let factor = F::select(delta, F::splat(1.0), wrong.of_direction(cosine, sample.pdf, others));
        let direction_pdf = match self.plan.light {
            _ if wrong.counts_emission_twice() => F::splat(MET_BY_CHANCE),
            LightSampling::BsdfOnly => F::splat(MET_BY_CHANCE),
            LightSampling::NextEvent => F::select(delta, F::splat(MET_BY_CHANCE), F::splat(ALREADY_COUNTED)),
            LightSampling::Mis => sample.pdf,
        };
        let rays = Rays::new(wrong.leaving_towards(&at.point, sample.wi), sample.wi);
        let throughput = throughput * factor;
        self.path = PathStates { rays, throughput, from: at.point.position, direction_pdf, ..self.path };
        deserved * factor
    }

    /// Counts the vertex and plays roulette; where paths go on.
    #[inline(always)]
    fn goes_on(&mut self, alive: F::M, delta: F::M, deserved: Vector<F>, u_roulette: F) -> F::M {
        let path = &mut self.path;
        let spared = delta & path.vertices.lt(F::U::splat(SPARED_VERTICES));
        path.vertices = path.vertices.wrapping_add(F::U::splat(1));
        let (survives, throughput) =
            survivors(path.throughput, deserved, F::splat(1.0), spared, self.plan.roulette, u_roulette);
        path.throughput = self.plan.wrong.survivors(path.throughput, throughput);
        alive & survives
    }

    /// Density with which light sampling at the paths' last vertices draws the directions to these hits.
    #[inline(always)]
    fn light_pdf(&self, hit: &Intersections<F>) -> F {
        if self.plan.light != LightSampling::Mis {
            return F::splat(0.0);
        }
        let pdf = self.scene.lights.table().pdf(hit.light, self.path.from, hit.point.position);
        F::select(hit.light.eq(F::U::splat(NO_LIGHT)), F::splat(0.0), pdf)
    }
}

impl PathSettings {
    /// The shader of paths with bugs; what is hidden is on where it was told before.
    pub(in crate::integrator) fn broken_key(&self, light_sampling: u32) -> PipelineKey {
        let constants = [
            ("UNIFORM_DIRECTIONS", flag(self.estimator.directions == Directions::Uniform)),
            ("LIGHT_SAMPLING", f64::from(light_sampling)),
            ("LIGHT_PATHS", flag(!self.paths.is_all())),
            ("BUGS", f64::from(self.bugs.bits())),
        ];
        PipelineKey::new("pathtrace/integrator/broken/walk.wgsl", self.sampler, &constants)
    }
}
