//! The same picture by the GPU and by the CPU.

use film::Film;
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{Integrator, Stats, Tracer};
use scene::{Scene, Vec3};

pub struct Pair {
    pub gpu: Film,
    pub cpu: Film,
    pub stats: [Stats; 2],
}

impl Pair {
    /// Pixels farther apart than `tolerance`, as a share of all; relative above 1.
    pub fn apart(&self, tolerance: f32) -> f64 {
        assert_eq!((self.gpu.nonfinite, self.cpu.nonfinite), (0, 0));
        let far = |(a, b): &(Vec3, Vec3)| (a - b).abs().max_element() > tolerance * b.max_element().max(1.0);
        let pixels = f64::from(self.gpu.width() * self.gpu.height());
        self.gpu.radiances().zip(self.cpu.radiances()).filter(far).count() as f64 / pixels
    }

    /// Rays on the GPU over rays on the CPU.
    pub fn rays(&self) -> f64 {
        let [gpu, cpu] = self.stats;
        assert_eq!((gpu.samples, gpu.cut_paths), (cpu.samples, cpu.cut_paths));
        assert_eq!((gpu.photons, gpu.cut_photons), (cpu.photons, cpu.cut_photons));
        gpu.rays as f64 / cpu.rays as f64
    }
}

/// A picture by these paths, rendered on both machines.
pub fn paths(gpu: &Gpu, scene: &Scene, size: (u32, u32), spp: u32, settings: &(impl Into<Integrator> + Copy)) -> Pair {
    let [mut on_gpu, mut on_cpu] = [(); 2].map(|()| Film::new(size.0, size.1));
    let mut tracer = GpuTracer::new(gpu, scene).unwrap();
    let gpu = tracer.render(&mut on_gpu, &scene.camera, &(*settings).into(), spp, &|| false).unwrap();
    let cpu = Tracer::new(scene).render(&mut on_cpu, &scene.camera, &(*settings).into(), spp, &|| false);
    Pair { gpu: on_gpu, cpu: on_cpu, stats: [gpu, cpu] }
}
