//! What is measured: techniques, each in one of the variants, with the names that tables, plots and the journal know
//! them by.

use crate::variant::{MakeTracer, Variant};
use pathtrace::{
    Bugs, ConesAt, Directions, Estimator, Integrator, LightPaths, LightTracingSettings, MetropolisSettings,
    PathSettings, PhotonSettings, Roulette, SamplerKind,
};
use raster::Fake;
use scene::Scene;
use technique::{
    DenoiseSettings, Denoiser, Device, DeviceChoice, FakeSettings, Technique, TracedSettings, TreeSettings,
};

/// Samples of what more samples make better for ever: as many as the ladder of its part has.
const LADDER: u32 = u32::MAX;

/// Samples of light tracing where it is blind: its noise is far below what it lacks.
const BLIND_SPP: u32 = 16;

/// Paths as they are traced where nobody asks for others.
const COMPLETE: PathSettings = PathSettings {
    estimator: Estimator::LIGHT,
    sampler: SamplerKind::Sobol,
    bounces: None,
    roulette: Roulette::THROUGHPUT,
    branches: 1,
    connections: true,
    cones: ConesAt::Usual,
    split_glass: true,
    paths: LightPaths::ALL,
    seed: 1,
    bugs: Bugs::NONE,
    find_bug: 0,
};

/// The tutorial's: nothing is aimed at, and no way taken twice.
const TAUGHT: PathSettings = PathSettings {
    sampler: SamplerKind::Independent,
    connections: false,
    cones: ConesAt::Nothing,
    split_glass: false,
    ..COMPLETE
};

/// What is traced by default, but in scenes with rough metal or balls of glass or mirror: here it is measured in those too.
pub const USUAL: Technique = paths(COMPLETE);

/// Path tracing without a limit of bounces.
pub const fn path(estimator: Estimator, sampler: SamplerKind) -> Technique {
    paths(PathSettings { estimator, sampler, ..COMPLETE })
}

/// The usual paths, but for light by way of spheres, which is left to chance and cones.
pub const fn unconnected() -> Technique {
    paths(PathSettings { connections: false, ..COMPLETE })
}

/// The usual paths through a filter, which brings an error of its own that no samples take away.
pub const fn denoised(denoiser: Denoiser) -> Technique {
    let traced = on_the_ladder(Integrator::Path(COMPLETE));
    Technique::Traced(TracedSettings { denoise: DenoiseSettings { denoiser, ..DenoiseSettings::OFF }, ..traced })
}

/// Paths of at most so many bounces, and no roulette: the tutorial's biased loop.
pub const fn bounded(bounces: u32) -> Technique {
    paths(PathSettings { bounces: Some(bounces), roulette: Roulette::OFF, ..TAUGHT })
}

/// Paths without limit that survive each vertex with a constant probability: the tutorial's roulette.
pub const fn survived(probability: f32) -> Technique {
    paths(PathSettings { roulette: Roulette::constant(probability), ..TAUGHT })
}

/// Photon mapping with so many photons a pass.
pub fn photon(photons: u32) -> Technique {
    Technique::Traced(on_the_ladder(PhotonSettings { photons, ..PhotonSettings::default() }.into()))
}

/// Light tracing with so many photons a sample. In mirrors and glass it shows nothing: where there are such it is a level.
pub fn light_tracing(photons: u32, scene: &Scene) -> Technique {
    let traced = on_the_ladder(LightTracingSettings { photons, ..LightTracingSettings::default() }.into());
    let spp = if traced.blind_spots(scene).is_empty() { LADDER } else { BLIND_SPP };
    Technique::Traced(TracedSettings { spp, ..traced })
}

/// Chains of the usual paths.
pub fn metropolis() -> Technique {
    Technique::Traced(on_the_ladder(MetropolisSettings { path: COMPLETE, ..MetropolisSettings::default() }.into()))
}

/// Whitted's trees of rays, at the few samples that edges and soft shadows need.
pub fn whitted() -> Technique {
    Technique::Traced(TracedSettings { device: DeviceChoice::Cpu, ..TreeSettings::default().into() })
}

/// The fake with the scene's own numbers.
pub fn fake(fake: Fake) -> Technique {
    Technique::Fake(FakeSettings { fake, ..FakeSettings::default() })
}

const fn paths(settings: PathSettings) -> Technique {
    Technique::Traced(on_the_ladder(Integrator::Path(settings)))
}

const fn on_the_ladder(integrator: Integrator) -> TracedSettings {
    TracedSettings { device: DeviceChoice::Cpu, ..TracedSettings::new(integrator, LADDER) }
}

/// A technique in one of the variants.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    /// What makes the picture. Its samples are those of the ladder.
    pub technique: Technique,
    /// By which kernel, where it is traced.
    pub variant: &'static Variant,
}

impl Line {
    /// The integrator with a seed; `None` of the fake.
    pub fn integrator(&self, seed: u32) -> Option<Integrator> {
        match self.technique {
            Technique::Traced(traced) => Some(traced.integrator.with_seed(seed)),
            Technique::Fake(_) => None,
        }
    }

    /// The device that it is measured on.
    pub fn device(&self) -> Device {
        match (self.technique, self.variant.tracer) {
            (Technique::Traced(_), MakeTracer::Cpu(_)) => Device::Cpu,
            (Technique::Fake(_), _) | (_, MakeTracer::Gpu(_)) => Device::Gpu,
        }
    }

    /// Where its random numbers come from, by name; empty for what needs none.
    pub fn sampler(&self) -> &'static str {
        self.integrator(1).map_or("", |integrator| integrator.sampler().name())
    }

    /// Whether it is measured for its speed alone.
    pub fn is_a_variant(&self) -> bool {
        !self.variant.name.is_empty()
    }

    /// Whether more samples make it better for ever: the others are levels.
    pub fn converges(&self) -> bool {
        matches!(self.technique, Technique::Traced(TracedSettings { spp: LADDER, .. }))
    }

    /// Whether it converges, but a sample of it takes several times as long as a path.
    pub fn is_dear(&self) -> bool {
        self.converges() && self.path_settings().is_none()
    }

    /// Whether its pictures go through a filter.
    pub fn is_denoised(&self) -> bool {
        self.technique.denoise().is_on()
    }

    /// Whether each of its pictures begins with learning a guide.
    pub fn learns(&self) -> bool {
        self.path_settings().is_some_and(|path| path.estimator.directions == Directions::Guided)
    }

    /// Whether it loses light by a limit of bounces.
    pub fn is_bounded(&self) -> bool {
        self.path_settings().is_some_and(|path| path.bounces.is_some())
    }

    /// Whether it stands in the plot of biased against unbiased and in no other.
    pub fn is_of_the_lesson(&self) -> bool {
        self.path_settings().is_some_and(|path| path.bounces.is_some() || path.roulette.probability.is_some())
    }

    /// The name in tables and journal, unique among all lines.
    pub fn name(&self) -> String {
        self.with_variant(match self.technique {
            Technique::Traced(TracedSettings { integrator: Integrator::Path(path), .. }) => {
                let PathSettings { estimator, sampler, bounces, roulette, .. } = path;
                let mut name = format!("path {} {}", estimator.name(), sampler.name());
                if self.technique == unconnected() {
                    name += NO_CONNECTIONS;
                }
                if self.is_denoised() {
                    name += &format!(" denoised {}", self.technique.denoise().denoiser.name());
                }
                if let Some(bounces) = bounces {
                    name += &format!(" bounces {bounces}");
                }
                if let Some(probability) = roulette.probability {
                    name += &format!(" roulette {probability}");
                }
                name
            }
            Technique::Traced(traced) => traced.integrator.name().into(),
            Technique::Fake(settings) => format!("raster {}", settings.fake.name()),
        })
    }

    /// The name in plots.
    pub fn title(&self) -> String {
        self.with_variant(title(&self.technique))
    }

    fn path_settings(&self) -> Option<PathSettings> {
        match self.technique {
            Technique::Traced(TracedSettings { integrator: Integrator::Path(path), .. }) => Some(path),
            _ => None,
        }
    }

    fn with_variant(&self, name: String) -> String {
        if self.is_a_variant() { format!("{name} ({})", self.variant.name) } else { name }
    }
}

/// After the names of paths that leave to chance what others connect.
const NO_CONNECTIONS: &str = " no connections";

/// A technique's name in plots.
pub fn title(technique: &Technique) -> String {
    let path = match technique {
        Technique::Traced(TracedSettings { integrator: Integrator::Path(path), .. }) => path,
        Technique::Traced(_) => return technique.name().in_full().into(),
        Technique::Fake(settings) => return format!("fake, {}", settings.fake.name()),
    };
    if technique.denoise().is_on() {
        return format!("{}, denoised {}", path.estimator.name(), technique.denoise().denoiser.name());
    }
    match (path.bounces, path.roulette.probability) {
        (None, None) if *technique == unconnected() => format!("{},{NO_CONNECTIONS}", path.estimator.name()),
        (None, None) => format!("{}, {}", path.estimator.name(), path.sampler.name()),
        (Some(0), _) => "0 bounces, direct light".into(),
        (Some(1), _) => "1 bounce".into(),
        (Some(n), _) => format!("{n} bounces"),
        (None, Some(probability)) => format!("roulette, p = {probability}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::builtin;

    #[test]
    fn the_usual_line_is_what_the_program_does_by_default() {
        assert_eq!(USUAL, paths(PathSettings::default()));
    }

    #[test]
    fn light_tracing_is_a_level_where_there_are_mirrors_or_glass() {
        let line = |scene: &str| {
            let technique = light_tracing(1, &builtin::named(scene).unwrap());
            Line { technique, variant: &Variant::ALL[0] }
        };
        assert!(line("cornell").converges() && !line("whitted").converges());
    }
}
