//! How paths walk, read from the settings once.

use crate::drive::gpu::film_data::RenderParams;
use crate::drive::gpu::{PipelineKey, flag};
use crate::drive::lanes::{FilmJob, LanePlan};
use crate::integrator::forks::MOST_FORKS;
use crate::integrator::guide::Guide;
use crate::integrator::guide::training::Notes;
use crate::integrator::light_paths::{self, CountedPaths};
use crate::integrator::path::PathLanes;
use crate::integrator::settings::{ConesAt, Directions, LightSampling, PathSettings, Roulette};
use crate::prepared::PreparedScene;
use simd::{Column, Float};
use std::sync::Arc;

/// Paths that one sample may branch into.
pub const MOST_BRANCHES: u32 = 65_536;

/// Settings as the walk reads them.
pub struct Plan<'n> {
    pub(super) directions: Directions,
    pub(super) light: LightSampling,
    /// Whether lights that are sampled are connected to by way of spheres as well.
    pub(super) connections: bool,
    pub(super) roulette: Roulette,
    /// Vertices at which a path may scatter.
    pub(super) limit: u32,
    /// Whether that is the hard cap rather than the user's wish.
    pub(super) capped: bool,
    pub(super) branches: u32,
    pub(super) cones: ConesAt,
    /// Whether glass that the camera sees sends paths on both ways.
    pub(super) splits: bool,
    /// Diffuse vertices of a path that may branch.
    pub(super) branching_vertices: u32,
    /// `branches` to the power of the vertices that branched.
    pub(super) paths_after: Column,
    /// Which light counts; `None` where all does.
    pub(super) counted: Option<CountedPaths>,
    /// Where light comes from, if that was learned.
    pub(super) guide: Option<Arc<Guide>>,
    /// What is found is written here, for a guide to learn from.
    pub(super) notes: Option<&'n Notes>,
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
            cones: settings.cones(),
            splits: settings.splits(),
            branching_vertices: settings.branching_vertices().min(MOST_FORKS as u32),
            paths_after: Column::new(forks.map(|forks| (branches as f32).powi(forks))),
            counted: CountedPaths::of(&settings.paths),
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
        if self.estimator.directions == Directions::Guided && !self.is_broken() {
            return Err("a guide of paths is learned and followed by the processor alone");
        }
        let light_sampling = match self.estimator.light {
            LightSampling::BsdfOnly => BY_CHANCE,
            LightSampling::NextEvent => BY_SAMPLING,
            LightSampling::Mis => BY_BOTH,
        };
        if self.is_broken() {
            return Ok(self.broken_key(light_sampling));
        }
        let constants = [
            ("UNIFORM_DIRECTIONS", flag(self.estimator.directions == Directions::Uniform)),
            ("LIGHT_SAMPLING", f64::from(light_sampling)),
            ("BRANCHING", flag(self.branches > 1 || everything)),
            ("CONNECTIONS", flag(self.connections && self.estimator.samples_lights())),
            ("SPLITTING", flag(self.splits())),
            ("CONES", f64::from(self.cones() as u8)),
            ("LIGHT_PATHS", flag(!self.paths.is_all())),
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
            light_paths: light_paths::rows(&self.paths),
            ..params
        }
    }
}
