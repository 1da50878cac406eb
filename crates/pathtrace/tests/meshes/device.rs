//! The device's meshes are the processor's.

use crate::{everything, integrators};
use film::{Film, Vec3};
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{FeaturePass, SamplerKind, Tracer};

/// Pixels farther apart than a hundredth, as a share of all.
fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    let far = |(a, b): &(&Vec3, &Vec3)| (**a - **b).abs().max_element() > 0.01 * b.max_element().max(1.0);
    a.iter().zip(b).filter(far).count() as f64 / a.len() as f64
}

/// One sample a pixel, so that a direction which is rounded otherwise is not hidden in a mean: few pixels see that.
#[test]
fn both_machines_see_the_same_meshes() {
    let scene = everything();
    for gpu in Gpu::each().expect("devices") {
        for (name, integrator) in integrators() {
            let [mut here, mut there] = [(); 2].map(|()| Film::new(96, 72));
            Tracer::new(&scene).render(&mut here, &scene.camera, &integrator, 1, &|| false);
            let mut tracer = GpuTracer::new(&gpu, &scene).expect("a tracer");
            tracer.render(&mut there, &scene.camera, &integrator, 1, &|| false).expect("a picture");
            assert_eq!((here.nonfinite, there.nonfinite), (0, 0));
            let [here, there] = [here, there].map(|film| film.radiances().collect::<Vec<_>>());
            let share = apart(&there, &here);
            println!("{name}: {share}");
            assert!(share < 0.01, "{name}: {share} of the pixels are apart, {}", gpu.describe());
        }
    }
}

#[test]
fn both_machines_show_the_same_features_of_meshes() {
    let scene = everything();
    let pass = FeaturePass::new(&scene.camera, (96, 72), 4, (SamplerKind::Sobol, 1));
    let here = Tracer::new(&scene).features(&pass, &|| false).expect("nobody stops it");
    for gpu in Gpu::each().expect("devices") {
        let mut tracer = GpuTracer::new(&gpu, &scene).expect("a tracer");
        let there = tracer.features(&pass, &|| false).expect("features").expect("nobody stops it");
        let shares = [apart(&there.albedo, &here.albedo), apart(&there.normal, &here.normal)];
        println!("{shares:?}");
        assert!(shares.iter().all(|share| *share < 0.005), "{shares:?}, {}", gpu.describe());
    }
}
