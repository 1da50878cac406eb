//! The device's meshes are the processor's.

use crate::{everything, integrators, poster};
use film::{Film, Vec3};
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{FeaturePass, SamplerKind, Tracer};
use scene::glam::{Mat2, Vec2};
use scene::image_texture::{Sampling, Wrap};
use scene::{Bsdf, ImageTexture, Scene, Texture};
use std::sync::Arc;

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

/// A picture that is turned, made smaller and moved, so that all four sides of it are seen.
fn turned_picture(wrap: [Wrap; 2], bilinear: bool) -> Scene {
    let mut scene = poster("", 1);
    let texels =
        (0..15).map(|i| [i as f32 / 15.0, (i * 4 % 15) as f32 / 15.0, (i * 7 % 15) as f32 / 15.0, 1.0]).collect();
    let (turn_and_scale, offset) = (Mat2::from_scale_angle(Vec2::new(3.1, -2.3), 0.4), Vec2::new(-0.8, 0.3));
    let sampling = Sampling { wrap, bilinear, turn_and_scale, offset };
    let image = Arc::new(ImageTexture::new(5, 3, texels, sampling).expect("as many texels as it says"));
    scene.materials[0].bsdf = Bsdf::Diffuse { albedo: Texture::Image { image, factor: Vec3::ONE } };
    scene
}

#[test]
fn both_machines_read_pictures_alike() {
    let wraps = [[Wrap::Repeat, Wrap::Mirror], [Wrap::Mirror, Wrap::Clamp], [Wrap::Clamp, Wrap::Repeat]];
    for gpu in Gpu::each().expect("devices") {
        let mut tracer = GpuTracer::new(&gpu, &turned_picture(wraps[0], false)).expect("a tracer");
        for (wrap, bilinear) in wraps.into_iter().flat_map(|wrap| [(wrap, false), (wrap, true)]) {
            let scene = turned_picture(wrap, bilinear);
            let pass = FeaturePass::new(&scene.camera, (64, 64), 1, (SamplerKind::Sobol, 1));
            let here = Tracer::new(&scene).features(&pass, &|| false).expect("nobody stops it");
            tracer.set_scene(&scene).expect("room for it");
            let there = tracer.features(&pass, &|| false).expect("features").expect("nobody stops it");
            let share = apart(&there.albedo, &here.albedo);
            // of nearest texels those at edges may be either
            assert!(share <= if bilinear { 0.0 } else { 0.002 }, "{wrap:?} {bilinear}: {share}, {}", gpu.describe());
            let colours = here.albedo.iter().map(|albedo| (albedo.x * 15.0).round() as u32);
            assert!(colours.collect::<std::collections::BTreeSet<_>>().len() >= 10, "{wrap:?}: not much is seen");
        }
    }
}
