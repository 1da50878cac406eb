//! What is measured: techniques, each in one of the variants, with the names that tables, plots and the journal know
//! them by.

use crate::variant::{MakeTracer, Variant};
use pathtrace::{ConesAt, Estimator, Integrator, PathSettings, Roulette, SamplerKind};
use raster::Fake;
use technique::{Device, DeviceChoice, FakeSettings, Technique, TracedSettings, TreeSettings};

/// What is traced by default, but in scenes with rough metal or balls of glass or mirror: here it is measured in those too.
pub const USUAL: Technique = path(Estimator::LIGHT, SamplerKind::Sobol);

/// Path tracing without a limit of bounces.
pub const fn path(estimator: Estimator, sampler: SamplerKind) -> Technique {
    let roulette = Roulette::THROUGHPUT;
    let (connections, cones, split_glass) = (true, ConesAt::Usual, true);
    paths(PathSettings {
        estimator,
        sampler,
        bounces: None,
        roulette,
        branches: 1,
        connections,
        cones,
        split_glass,
        seed: 1,
    })
}

/// Paths of at most so many bounces, and no roulette: the tutorial's biased loop.
pub const fn bounded(bounces: u32) -> Technique {
    let (estimator, sampler) = (Estimator::LIGHT, SamplerKind::Independent);
    let (bounces, roulette) = (Some(bounces), Roulette::OFF);
    let (connections, cones, split_glass) = (false, ConesAt::Nothing, false);
    paths(PathSettings { estimator, sampler, bounces, roulette, branches: 1, connections, cones, split_glass, seed: 1 })
}

/// Paths without limit that survive each vertex with a constant probability: the tutorial's roulette.
pub const fn survived(probability: f32) -> Technique {
    let (estimator, sampler) = (Estimator::LIGHT, SamplerKind::Independent);
    let roulette = Roulette::constant(probability);
    let (connections, cones, split_glass) = (false, ConesAt::Nothing, false);
    paths(PathSettings {
        estimator,
        sampler,
        bounces: None,
        roulette,
        branches: 1,
        connections,
        cones,
        split_glass,
        seed: 1,
    })
}

/// Whitted's trees of rays, at the few samples that edges and soft shadows need.
pub fn whitted() -> Technique {
    Technique::Traced(TracedSettings { device: DeviceChoice::Cpu, ..TreeSettings::default().into() })
}

/// The fake with the scene's own numbers.
pub fn fake(fake: Fake) -> Technique {
    Technique::Fake(FakeSettings { fake, ..FakeSettings::default() })
}

/// At as many samples as the ladder of its part has.
const fn paths(settings: PathSettings) -> Technique {
    let integrator = Integrator::Path(settings);
    Technique::Traced(TracedSettings {
        integrator,
        device: DeviceChoice::Cpu,
        adapter: 0,
        spp: u32::MAX,
        sun_radius: None,
    })
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
        self.path_settings().is_some()
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

/// A technique's name in plots.
pub fn title(technique: &Technique) -> String {
    let path = match technique {
        Technique::Traced(TracedSettings { integrator: Integrator::Path(path), .. }) => path,
        Technique::Traced(_) => return technique.name().title().into(),
        Technique::Fake(settings) => return format!("fake, {}", settings.fake.name()),
    };
    match (path.bounces, path.roulette.probability) {
        (None, None) => format!("{}, {}", path.estimator.name(), path.sampler.name()),
        (Some(0), _) => "0 bounces, direct light".into(),
        (Some(1), _) => "1 bounce".into(),
        (Some(n), _) => format!("{n} bounces"),
        (None, Some(probability)) => format!("roulette, p = {probability}"),
    }
}
