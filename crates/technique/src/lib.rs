//! Ways to make a picture of a scene.
//!
//! A [`Technique`] is the fake or what is traced, each with its settings; a [`Shot`] is what it looks at. Together with
//! the [`Device`] that worked they are a [`Provenance`], which a picture keeps in its file and which makes it again.
//! Window, command line, bench, check and reference name techniques by these types alone.
//!
//! What is traced is made by a [`Renderer`]: a scene on a [`Backend`], the processor or a graphics device, that adds
//! samples to an [`Accumulation`] and goes on with the processor where a device fails. A [`ProgressiveRenderer`] is one
//! for somebody who looks on and changes their mind. All who trace beside each other share [`Threads`].

mod accumulation;
mod backend;
mod blind_spot;
mod changes;
mod coarse;
mod command;
mod denoiser;
mod device;
pub mod effects;
mod fake;
mod features;
mod filters;
mod halves;
mod history;
mod label;
mod pane;
mod patience;
pub mod presets;
mod progressive;
mod provenance;
mod renderer;
mod runs;
mod sample_ranges;
pub mod settings;
mod setup;
mod shot;
mod speeds;
mod sums;
mod threads;
mod traced;
mod trees;
mod watch;

pub use accumulation::Accumulation;
pub use backend::{Backend, GpuBackend};
pub use blind_spot::{BlindSpot, NoiseSource, Specular};
pub use command::{made_by_command, quoted};
pub use denoiser::{DenoiseSettings, Denoised, Denoiser, NOISY, TRUST};
pub use device::{Adapter, Adapters, Device, DeviceChoice, INSTEAD};
pub use fake::FakeSettings;
pub use features::features_of;
pub use filters::{DeviceFilters, Filters};
pub use halves::{HALVES, Halves};
pub use history::{LAG, Lag, Reused};
pub use pane::PaneSettings;
pub use presets::Preset;
pub use progressive::{NoMemory, ProgressiveRenderer, Request};
pub use provenance::{
    DENOISE, EARLIER_VIEWS, FILTER, Made, NONFINITE, OWN_FOV, Provenance, Recorded, SAMPLES, WEIGHTS, bugs_of,
    denoised_by, is_of_its_pixels, light_of, made_from, sample_ranges, scene_hash, tell_samples,
};
pub use renderer::{Rendered, Renderer};
pub use runs::Runs;
pub use sample_ranges::SampleRanges;
pub use setup::PaneSetup;
pub use shot::{SceneChanges, Shot};
pub use sums::{film_of_sums, layers_of_sums};
pub use threads::{Rank, Threads};
pub use traced::{
    ChainSettings, LightPaneSettings, NormalsPaneSettings, PhotonPaneSettings, TracedSettings, TreeSettings,
    TruthSettings, bounces_name, roulette_name,
};

pub use trees::{TreeProgress, Trees};
pub use watch::{Frame, Pacing, Watch};

use film::Feature;
use pathtrace::{Integrator, LightPaths};

/// A way to turn a scene into a film, by the name on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TechniqueName {
    /// The fake: rasterised on the GPU.
    Raster,
    /// Whitted's trees of rays.
    Whitted,
    /// Path tracing, which without limits tends to the truth.
    Path,
    /// Photons from the lights, gathered where the camera looks.
    Photon,
    /// Photons from the lights, sent on to the camera.
    LightTracing,
    /// Chains of paths, each from the last by a mutation.
    Metropolis,
    /// The normals of what is seen.
    Normals,
}

impl TechniqueName {
    /// Those that show light, in the order of the lecture.
    pub const OF_LIGHT: [TechniqueName; 6] = [
        TechniqueName::Raster,
        TechniqueName::Whitted,
        TechniqueName::Path,
        TechniqueName::Photon,
        TechniqueName::LightTracing,
        TechniqueName::Metropolis,
    ];
    /// Every technique: those that show light, then the normals.
    pub const ALL: [TechniqueName; 7] = [
        TechniqueName::Raster,
        TechniqueName::Whitted,
        TechniqueName::Path,
        TechniqueName::Photon,
        TechniqueName::LightTracing,
        TechniqueName::Metropolis,
        TechniqueName::Normals,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            TechniqueName::Raster => "raster",
            TechniqueName::Whitted => "whitted",
            TechniqueName::Path => "path",
            TechniqueName::Photon => "photon",
            TechniqueName::LightTracing => "light-tracing",
            TechniqueName::Metropolis => "metropolis",
            TechniqueName::Normals => "normals",
        }
    }

    /// The technique of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|t| t.name() == name)
    }

    /// What a lecture calls it, in a word or two.
    pub fn title(self) -> &'static str {
        match self {
            TechniqueName::Raster => "Fake",
            TechniqueName::Whitted => "Whitted",
            TechniqueName::Path => "Path",
            TechniqueName::Photon => "Photons",
            TechniqueName::LightTracing => "Light tracing",
            TechniqueName::Metropolis => "Metropolis",
            TechniqueName::Normals => "Normals",
        }
    }

    /// What a label calls it. None of them is the truth: that is what the reference stands for.
    pub fn in_full(self) -> &'static str {
        match self {
            TechniqueName::Path => "Path tracing",
            TechniqueName::Photon => "Photon mapping",
            other => other.title(),
        }
    }

    /// Whether its pictures depend on numbers that stand in for physics.
    pub fn reads_stand_ins(self) -> bool {
        match self {
            TechniqueName::Raster | TechniqueName::Whitted => true,
            TechniqueName::Path
            | TechniqueName::Photon
            | TechniqueName::LightTracing
            | TechniqueName::Metropolis
            | TechniqueName::Normals => false,
        }
    }

    /// What runs it if nobody says otherwise.
    pub fn usual_device(self) -> Device {
        match self {
            TechniqueName::Raster => Device::Gpu,
            TechniqueName::Whitted
            | TechniqueName::Path
            | TechniqueName::Photon
            | TechniqueName::LightTracing
            | TechniqueName::Metropolis
            | TechniqueName::Normals => Device::Cpu,
        }
    }
}

/// A technique with its settings: all that a picture depends on beside what is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Technique {
    /// The rasterised fake with its settings.
    Fake(FakeSettings),
    /// Traced by an integrator.
    Traced(TracedSettings),
}

impl Technique {
    /// Its name, without its settings.
    pub fn name(&self) -> TechniqueName {
        match self {
            Technique::Fake(_) => TechniqueName::Raster,
            Technique::Traced(traced) => match traced.integrator {
                Integrator::Whitted(_) => TechniqueName::Whitted,
                Integrator::Path(_) => TechniqueName::Path,
                Integrator::Photon(_) => TechniqueName::Photon,
                Integrator::LightTracing(_) => TechniqueName::LightTracing,
                Integrator::Metropolis(_) => TechniqueName::Metropolis,
                Integrator::Normals(_) => TechniqueName::Normals,
            },
        }
    }

    /// What its picture goes through before it is shown.
    pub fn denoise(&self) -> DenoiseSettings {
        match self {
            // how far samples are trusted is not put together with what earlier views showed
            Technique::Traced(traced) if traced.denoise.shows_the_weight() && self.traces_light() => {
                DenoiseSettings { history: 0, ..traced.denoise }
            }
            Technique::Traced(traced) if self.traces_light() => traced.denoise,
            Technique::Traced(_) | Technique::Fake(_) => DenoiseSettings::OFF,
        }
    }

    /// Of how many pictures of one seed after the other it is the mean.
    pub fn runs(&self) -> u32 {
        match self {
            Technique::Traced(traced) if self.traces_light() => traced.runs,
            Technique::Traced(_) | Technique::Fake(_) => 1,
        }
    }

    /// The same, as the mean of so many.
    pub fn with_runs(mut self, runs: u32) -> Self {
        if let Technique::Traced(traced) = &mut self {
            traced.runs = runs;
        }
        self
    }

    /// What of surfaces it shows in place of their light.
    pub fn feature(&self) -> Option<Feature> {
        match self {
            Technique::Fake(fake) => fake.show.feature(),
            Technique::Traced(traced) => traced.feature,
        }
    }

    /// Whether it shows the scene's light, so that its error means something; a shadow map does not, nor do points.
    pub fn shows_the_scene(&self) -> bool {
        match self {
            Technique::Fake(fake) => fake.shows_the_scene(),
            Technique::Traced(traced) => self.traces_light() && !traced.denoise.shows_the_weight(),
        }
    }

    /// Which of the scene's light counts.
    pub fn light(&self) -> LightPaths {
        match self {
            Technique::Traced(TracedSettings { integrator, feature: None, .. }) => match integrator {
                Integrator::Path(path) => path.paths,
                Integrator::Whitted(tree) => tree.paths,
                Integrator::Metropolis(metropolis) => metropolis.path.paths,
                Integrator::Photon(_) | Integrator::LightTracing(_) | Integrator::Normals(_) => LightPaths::ALL,
            },
            Technique::Traced(_) | Technique::Fake(_) => LightPaths::ALL,
        }
    }

    /// The same, where this light counts, if it can choose.
    pub fn with_light(mut self, light: LightPaths) -> Option<Self> {
        let Technique::Traced(TracedSettings { integrator, feature: None, .. }) = &mut self else { return None };
        match integrator {
            Integrator::Path(path) => path.paths = light,
            Integrator::Whitted(tree) => tree.paths = light,
            Integrator::Metropolis(metropolis) => metropolis.path.paths = light,
            Integrator::Photon(_) | Integrator::LightTracing(_) | Integrator::Normals(_) => return None,
        }
        Some(self)
    }

    /// Whether its errors against the scene's reference mean something: a reference has all light.
    pub fn has_a_reference(&self) -> bool {
        self.shows_the_scene() && self.light().is_all()
    }

    /// Whether rays gather the scene's light, whatever is shown of that.
    pub fn traces_light(&self) -> bool {
        match self {
            Technique::Fake(_) | Technique::Traced(TracedSettings { feature: Some(_), .. }) => false,
            Technique::Traced(traced) => match traced.integrator {
                Integrator::Photon(photon) => !photon.points,
                Integrator::Path(_)
                | Integrator::Whitted(_)
                | Integrator::LightTracing(_)
                | Integrator::Metropolis(_) => true,
                Integrator::Normals(_) => false,
            },
        }
    }
}
