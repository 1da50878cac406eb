//! How a scene is made ready for rays: by which lanes and structure, on which device. Variants give the same picture and
//! differ in speed.

use gpu::Gpu;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::{Lanes, Tracer};
use scene::Scene;

/// How a scene is made ready for rays. Another kernel, or one that is not specialised by the scene's needs, is one line
/// more in [`Variant::ALL`].
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    /// In names, after the technique; empty for the usual one.
    pub name: &'static str,
    /// Makes a scene ready in the way that is measured.
    pub tracer: MakeTracer,
    /// Lanes that it needs of the machine.
    pub needs: Option<Lanes>,
}

/// What traces, and where.
#[derive(Debug, Clone, Copy)]
pub enum MakeTracer {
    /// Makes what traces on the processor.
    Cpu(fn(&Scene) -> Tracer),
    /// On the graphics device, if there is one.
    Gpu(fn(&Gpu, &Scene) -> Result<GpuTracer, GpuTraceError>),
}

impl Variant {
    /// The first traces every technique; each further one traces [`crate::line::USUAL`] alone, for a comparison of speed.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::line::{Line, USUAL};
    use film::Film;
    use scene::builtin;

    #[test]
    fn variants_differ_in_speed_alone() {
        for name in ["cornell", "whitted"] {
            let scene = builtin::named(name).unwrap();
            let picture = |variant: &'static Variant| {
                let mut film = Film::new(48, 27);
                let line = Line { technique: USUAL, variant };
                let integrator = line.integrator(1).unwrap();
                let MakeTracer::Cpu(tracer) = variant.tracer else { return None };
                tracer(&scene).render(&mut film, &scene.camera, &integrator, 4, &|| false);
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
