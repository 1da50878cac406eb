//! What is measured: ways to make a picture of a scene, each with the name that tables, plots and the journal know it
//! by.

use gpu::Gpu;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::{Estimator, Integrator, Lanes, PathSettings, Roulette, SamplerKind, Tracer, WhittedSettings};
use raster::Fake;
use scene::Scene;

/// How a scene is made ready for rays. Another kernel, or one that is not specialised by the scene's needs, is one line
/// more in [`Variant::ALL`].
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    /// In names, after the way; empty for the usual one.
    pub name: &'static str,
    /// Makes the tracer.
    pub tracer: MakeTracer,
    /// Lanes that it needs of the machine.
    pub needs: Option<Lanes>,
}

/// What traces, and where.
#[derive(Debug, Clone, Copy)]
pub enum MakeTracer {
    /// On the processor.
    Cpu(fn(&Scene) -> Tracer),
    /// On the graphics device, if there is one.
    Gpu(fn(&Gpu, &Scene) -> Result<GpuTracer, GpuTraceError>),
}

impl Variant {
    /// The first traces every way; each further one traces [`Way::USUAL`] alone, for a comparison of speed.
    pub const ALL: &'static [Variant] = &[
        on_cpu("", Tracer::new),
        in_lanes("avx512", Lanes::Avx512, |scene| Tracer::new(scene).with_lanes(Lanes::Avx512)),
        in_lanes("avx2", Lanes::Avx2, |scene| Tracer::new(scene).with_lanes(Lanes::Avx2)),
        in_lanes("array", Lanes::Array, |scene| Tracer::new(scene).with_lanes(Lanes::Array)),
        in_lanes("scalar", Lanes::Scalar, |scene| Tracer::new(scene).with_lanes(Lanes::Scalar)),
        on_cpu("single rays", |scene| Tracer::new(scene).with_single_rays()),
        on_cpu("for any scene", |scene| Tracer::new(scene).for_any_scene()),
        on_gpu("gpu", GpuTracer::new),
        on_gpu("gpu through a tree", GpuTracer::through_a_tree),
        on_gpu("gpu for any scene", GpuTracer::with_everything),
    ];

    /// Whether this machine can.
    pub fn is_available(&self) -> bool {
        self.needs.is_none_or(Lanes::is_available)
    }
}

const fn on_cpu(name: &'static str, tracer: fn(&Scene) -> Tracer) -> Variant {
    Variant { name, tracer: MakeTracer::Cpu(tracer), needs: None }
}

const fn on_gpu(name: &'static str, tracer: fn(&Gpu, &Scene) -> Result<GpuTracer, GpuTraceError>) -> Variant {
    Variant { name, tracer: MakeTracer::Gpu(tracer), needs: None }
}

const fn in_lanes(name: &'static str, lanes: Lanes, tracer: fn(&Scene) -> Tracer) -> Variant {
    Variant { name, tracer: MakeTracer::Cpu(tracer), needs: Some(lanes) }
}

/// Samples per pixel at which variants are measured: their errors are those of the usual one, bit for bit.
pub const VARIANT_SPP: u32 = 16;

/// A way to make a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Way {
    /// Path tracing.
    Path {
        /// How directions are drawn and light is found.
        estimator: Estimator,
        /// Where random numbers come from.
        sampler: SamplerKind,
        /// Scattering vertices after the first; `None` is no limit.
        bounces: Option<u32>,
        /// When paths end early.
        roulette: Roulette,
    },
    /// Whitted's trees of rays.
    Whitted,
    /// The fake.
    Raster(Fake),
}

/// Samples per pixel of a Whitted picture: only edges and soft shadows need them.
pub const WHITTED_SPP: u32 = 16;

impl Way {
    /// What is traced by default.
    pub const USUAL: Way = Way::path(Estimator::LIGHT, SamplerKind::Sobol);

    /// Unbiased path tracing.
    pub const fn path(estimator: Estimator, sampler: SamplerKind) -> Way {
        Way::Path { estimator, sampler, bounces: None, roulette: Roulette::THROUGHPUT }
    }

    /// Paths of at most so many bounces, and no roulette: the tutorial's biased loop.
    pub const fn bounded(bounces: u32) -> Way {
        let (estimator, sampler) = (Estimator::LIGHT, SamplerKind::Independent);
        Way::Path { estimator, sampler, bounces: Some(bounces), roulette: Roulette::OFF }
    }

    /// Paths without limit that survive each vertex with a constant probability: the tutorial's roulette.
    pub const fn survived(probability: f32) -> Way {
        let (estimator, sampler) = (Estimator::LIGHT, SamplerKind::Independent);
        Way::Path { estimator, sampler, bounces: None, roulette: Roulette::constant(probability) }
    }

    /// The name in tables and journal, unique among all ways.
    pub fn name(&self) -> String {
        match self {
            Way::Path { estimator, sampler, bounces, roulette } => {
                let mut name = format!("path {} {}", estimator.name(), sampler.name());
                if let Some(bounces) = bounces {
                    name += &format!(" bounces {bounces}");
                }
                if let Some(probability) = roulette.probability {
                    name += &format!(" roulette {probability}");
                }
                name
            }
            Way::Whitted => "whitted".into(),
            Way::Raster(fake) => format!("raster {}", fake.name()),
        }
    }

    /// The name in plots.
    pub fn title(&self) -> String {
        match self {
            Way::Path { estimator, bounces: None, roulette: Roulette { probability: None, .. }, sampler } => {
                format!("{}, {}", estimator.name(), sampler.name())
            }
            Way::Path { bounces: Some(0), .. } => "0 bounces, direct light".into(),
            Way::Path { bounces: Some(1), .. } => "1 bounce".into(),
            Way::Path { bounces: Some(n), .. } => format!("{n} bounces"),
            Way::Path { roulette, .. } => format!("roulette, p = {}", roulette.probability.unwrap_or(1.0)),
            Way::Whitted => "Whitted".into(),
            Way::Raster(fake) => format!("fake, {}", fake.name()),
        }
    }

    /// Where it runs: "cpu" or "gpu".
    pub fn device(&self) -> &'static str {
        if matches!(self, Way::Raster(_)) { "gpu" } else { "cpu" }
    }

    /// Where its random numbers come from, by name; empty for what needs none.
    pub fn sampler(&self) -> &'static str {
        match self {
            Way::Path { sampler, .. } => sampler.name(),
            Way::Whitted => SamplerKind::default().name(),
            Way::Raster(_) => "",
        }
    }

    /// Whether more samples make it better for ever: the others are levels.
    pub fn converges(&self) -> bool {
        matches!(self, Way::Path { .. })
    }

    /// Whether it loses light by a limit of bounces.
    pub fn is_bounded(&self) -> bool {
        matches!(self, Way::Path { bounces: Some(_), .. })
    }

    /// Whether it stands in the plot of biased against unbiased and in no other.
    pub fn is_of_the_lesson(&self) -> bool {
        matches!(self, Way::Path { bounces, roulette, .. } if bounces.is_some() || roulette.probability.is_some())
    }

    /// Settings of path tracing with a seed; `None` of other ways.
    pub fn path_settings(&self, seed: u32) -> Option<PathSettings> {
        match *self {
            Way::Path { estimator, sampler, bounces, roulette } => {
                Some(PathSettings { estimator, bounces, roulette, sampler, seed, branches: 1 })
            }
            Way::Whitted | Way::Raster(_) => None,
        }
    }

    /// Its integrator with a seed: Whitted's method where it is not of paths.
    pub fn integrator(&self, seed: u32) -> Integrator {
        self.path_settings(seed).map_or_else(|| Way::whitted_settings(seed).into(), Integrator::from)
    }

    /// Settings of Whitted's method with a seed.
    pub fn whitted_settings(seed: u32) -> WhittedSettings {
        WhittedSettings { seed, ..WhittedSettings::default() }
    }
}

/// A way in one of the variants.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    /// What is traced.
    pub way: Way,
    /// By which kernel.
    pub variant: &'static Variant,
}

impl Line {
    /// Where it runs: "cpu" or "gpu".
    pub fn device(&self) -> &'static str {
        if matches!(self.variant.tracer, MakeTracer::Gpu(_)) { "gpu" } else { self.way.device() }
    }

    /// Whether it is measured for its speed alone.
    pub fn is_a_variant(&self) -> bool {
        !self.variant.name.is_empty()
    }

    /// The name in tables and journal.
    pub fn name(&self) -> String {
        with_variant(self.way.name(), self.variant)
    }

    /// The name in plots.
    pub fn title(&self) -> String {
        with_variant(self.way.title(), self.variant)
    }
}

fn with_variant(name: String, variant: &Variant) -> String {
    if variant.name.is_empty() { name } else { format!("{name} ({})", variant.name) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use film::Film;
    use scene::builtin;

    #[test]
    fn variants_differ_in_speed_alone() {
        for name in ["cornell", "whitted"] {
            let scene = builtin::named(name).unwrap();
            let picture = |variant: &Variant| {
                let mut film = Film::new(48, 27);
                let settings = Way::USUAL.integrator(1);
                let MakeTracer::Cpu(tracer) = variant.tracer else { return None };
                tracer(&scene).render(&mut film, &scene.camera, &settings, 4, &|| false);
                Some(film)
            };
            let usual = picture(&Variant::ALL[0]).unwrap();
            for variant in Variant::ALL.iter().filter(|variant| variant.is_available()) {
                let Some(other) = picture(variant) else { continue };
                let apart = usual.pixels().iter().zip(other.pixels()).filter(|(a, b)| {
                    a.mean().iter().zip(b.mean()).any(|(a, b)| (a - b).abs() > 1e-3 * (1.0 + a.abs()))
                });
                // a shape that is met by other arithmetic may turn a path's choice at an edge
                assert!(apart.count() <= 3, "{name}, {}", variant.name);
                let lanes_alone = variant.needs.is_some();
                assert!(!lanes_alone || usual == other, "{name}, {}: not the same bits", variant.name);
            }
        }
    }
}
