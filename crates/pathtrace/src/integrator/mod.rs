//! Light transport: [`path`], the tutorial's Monte Carlo path tracer, and [`whitted`], the step before it; [`photon`], in
//! which light walks from its sources; [`metropolis`], chains of paths; and [`normals`], which shows no light at all.
//!
//! A new integrator is a file here with its settings and lanes, its twin in `shaders/pathtrace/integrator/`, and a
//! variant of [`Integrator`] with an arm in each of the matches below: all that the machines ask an integrator for.

mod branches;
pub mod broken;
pub(crate) mod chain_state;
mod connected;
pub(crate) mod directions;
pub(crate) mod first_vertex;
pub(crate) mod forks;
pub(crate) mod guide;
pub mod light_paths;
pub mod metropolis;
pub mod normals;
pub mod path;
pub(crate) mod path_plan;
pub(crate) mod path_state;
pub mod photon;
pub(crate) mod roulette;
pub mod settings;
pub(crate) mod splits;
mod waiting;
pub mod whitted;

use crate::drive::gpu::{PipelineKey, film_data::RenderParams};
use crate::drive::lanes::FilmJob;
use crate::sampling::sampler::SamplerKind;
use crate::stats::Stats;
use broken::Bugs;
use film::Film;
use metropolis::MetropolisSettings;
use normals::NormalsSettings;
use photon::{LightTracingSettings, PhotonSettings};
use scene::Scene;
use scene::stand_ins::FakeNumbers;
use settings::{PathSettings, SettingsError};
use whitted::WhittedSettings;

/// How light is followed, with its settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Integrator {
    /// Along random paths.
    Path(PathSettings),
    /// In trees of mirrors and glass.
    Whitted(WhittedSettings),
    /// From the lights to a map, and from the camera to that.
    Photon(PhotonSettings),
    /// From the lights to the camera.
    LightTracing(LightTracingSettings),
    /// Along paths that come from each other by mutations.
    Metropolis(MetropolisSettings),
    /// To the first surface.
    Normals(NormalsSettings),
}

impl Integrator {
    /// The name on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Integrator::Path(_) => "path",
            Integrator::Whitted(_) => "whitted",
            Integrator::Photon(_) => "photon",
            Integrator::LightTracing(_) => "light-tracing",
            Integrator::Metropolis(_) => "metropolis",
            Integrator::Normals(_) => "normals",
        }
    }

    /// Where its random numbers come from.
    pub fn sampler(&self) -> SamplerKind {
        match self {
            Integrator::Path(settings) => settings.sampler,
            Integrator::Whitted(settings) => settings.sampler,
            Integrator::Photon(settings) => settings.sampler,
            Integrator::LightTracing(settings) => settings.sampler,
            Integrator::Metropolis(settings) => settings.path.sampler,
            Integrator::Normals(settings) => settings.sampler,
        }
    }

    /// Selects one of 2^32 independent pictures.
    pub fn seed(&self) -> u32 {
        match self {
            Integrator::Path(settings) => settings.seed,
            Integrator::Whitted(settings) => settings.seed,
            Integrator::Photon(settings) => settings.seed,
            Integrator::LightTracing(settings) => settings.seed,
            Integrator::Metropolis(settings) => settings.path.seed,
            Integrator::Normals(settings) => settings.seed,
        }
    }

    /// The same for another of the independent pictures.
    pub fn with_seed(self, seed: u32) -> Self {
        match self {
            Integrator::Path(settings) => PathSettings { seed, ..settings }.into(),
            Integrator::Whitted(settings) => WhittedSettings { seed, ..settings }.into(),
            Integrator::Photon(settings) => PhotonSettings { seed, ..settings }.into(),
            Integrator::LightTracing(settings) => LightTracingSettings { seed, ..settings }.into(),
            Integrator::Metropolis(settings) => {
                MetropolisSettings { path: PathSettings { seed, ..settings.path }, ..settings }.into()
            }
            Integrator::Normals(settings) => NormalsSettings { seed, ..settings }.into(),
        }
    }

    /// Whether these settings mean something.
    ///
    /// # Errors
    /// What is wrong, as a line for the user.
    pub fn check(&self) -> Result<(), SettingsError> {
        match self {
            Integrator::Path(settings) => settings.check(),
            Integrator::Photon(settings) => settings.check(),
            Integrator::LightTracing(settings) => settings.check(),
            Integrator::Metropolis(settings) => settings.check(),
            Integrator::Whitted(_) | Integrator::Normals(_) => Ok(()),
        }
    }

    /// Fills a film on the processor.
    pub(crate) fn fill(&self, film: &mut Film, job: &FilmJob) -> Stats {
        match self {
            // none where the job was stopped while a guide was learned
            Integrator::Path(settings) if settings.is_broken() => {
                job.fill_one_by_one(film, &broken::walk::Plan::new(settings, settings.bugs_on(job.scene.suited_bugs)))
            }
            Integrator::Path(settings) => {
                path_plan::Plan::of(settings, job).map(|plan| job.fill(film, &plan)).unwrap_or_default()
            }
            Integrator::Whitted(settings) => job.fill(film, &whitted::Plan::new(settings, job.stand_ins)),
            Integrator::Photon(settings) => settings.fill(film, job),
            Integrator::LightTracing(settings) => settings.fill(film, job),
            Integrator::Metropolis(settings) => settings.fill(film, job),
            Integrator::Normals(settings) => job.fill(film, &normals::Plan::new(settings, &job.pass.frame)),
        }
    }

    /// Why no graphics device can follow it, as a line for the user; `None` if one can.
    pub fn needs_the_processor(&self) -> Option<&'static str> {
        self.pipeline_key(false).err()
    }

    /// Whether pixels have random numbers in common, so that the error of a picture's mean is more or less than its pixels' errors
    /// say.
    pub fn shares_between_pixels(&self) -> bool {
        matches!(self, Integrator::Photon(_) | Integrator::LightTracing(_) | Integrator::Metropolis(_))
    }

    /// Whether a pixel's samples, and pixels, are independent of each other, so that their spread tells the error.
    pub fn is_independent(&self) -> bool {
        self.sampler() == SamplerKind::Independent && !self.shares_between_pixels()
    }

    /// Its shader on the graphics device, and what of the settings is compiled into it; all of it if `everything`.
    ///
    /// # Errors
    /// If it has none: why, as a line for the user.
    pub(crate) fn pipeline_key(&self, everything: bool) -> Result<PipelineKey, &'static str> {
        match self {
            Integrator::Path(settings) => settings.pipeline_key(everything),
            Integrator::Whitted(settings) => Ok(settings.pipeline_key()),
            Integrator::Photon(settings) => settings.pipeline_key(),
            Integrator::LightTracing(_) => Err("light tracing runs on the processor alone"),
            Integrator::Metropolis(_) => Err("the chains of Metropolis run on the processor alone"),
            Integrator::Normals(settings) => Ok(settings.pipeline_key()),
        }
    }

    /// Whose photons each sample of all pixels gathers, if it does.
    pub(crate) fn gathers(&self) -> Option<&PhotonSettings> {
        match self {
            Integrator::Photon(settings) => Some(settings),
            _ => None,
        }
    }

    /// Why no pixel's samples can be traced without those of all others, as a line for the user; `None` if they can.
    pub fn binds_pixels(&self) -> Option<&'static str> {
        match self {
            Integrator::Photon(_) => Some("each sample of a photon map takes all photons of its pass"),
            Integrator::LightTracing(_) => Some("photons of light tracing choose their pixels themselves"),
            Integrator::Metropolis(_) => Some("the chains of Metropolis choose their pixels themselves"),
            Integrator::Path(_) | Integrator::Whitted(_) | Integrator::Normals(_) => None,
        }
    }

    /// Its settings, where it follows one random path a sample.
    pub(crate) fn paths(&self) -> Option<&PathSettings> {
        match self {
            Integrator::Path(settings) if !settings.is_broken() => Some(settings),
            _ => None,
        }
    }

    /// The same with the bug told that its settings hide in this scene.
    pub(crate) fn told_in(&self, scene: &Scene) -> Integrator {
        match self {
            Integrator::Path(settings) if settings.is_broken() => settings.told(Bugs::suited_to(scene)).into(),
            other => *other,
        }
    }

    /// What of the settings a shader reads while it runs.
    pub(crate) fn render_params(&self, params: RenderParams, stand_ins: &FakeNumbers) -> RenderParams {
        let params = RenderParams { seed: self.seed(), ..params };
        match self {
            Integrator::Path(settings) => settings.render_params(params),
            Integrator::Whitted(settings) => settings.render_params(params, stand_ins),
            Integrator::Photon(_)
            | Integrator::LightTracing(_)
            | Integrator::Metropolis(_)
            | Integrator::Normals(_) => params,
        }
    }
}

impl From<PathSettings> for Integrator {
    fn from(settings: PathSettings) -> Self {
        Integrator::Path(settings)
    }
}

impl From<PhotonSettings> for Integrator {
    fn from(settings: PhotonSettings) -> Self {
        Integrator::Photon(settings)
    }
}

impl From<LightTracingSettings> for Integrator {
    fn from(settings: LightTracingSettings) -> Self {
        Integrator::LightTracing(settings)
    }
}

impl From<MetropolisSettings> for Integrator {
    fn from(settings: MetropolisSettings) -> Self {
        Integrator::Metropolis(settings)
    }
}

impl From<NormalsSettings> for Integrator {
    fn from(settings: NormalsSettings) -> Self {
        Integrator::Normals(settings)
    }
}

impl From<WhittedSettings> for Integrator {
    fn from(settings: WhittedSettings) -> Self {
        Integrator::Whitted(settings)
    }
}
