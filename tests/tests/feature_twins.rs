//! What pixels show, without light, is on every device of this computer what it is on the processor: the same samples'
//! albedo, normal and depth, but where rounding decides at an edge which surface is met.

use film::{Features, Image, Vec3};
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{FeatureFilm, FeaturePass, SamplerKind, Stats, Tracer};
use scene::{EnvironmentMap, Scene, builtin};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

const EVERYTHING: &str = include_str!("scenes/everything-more.toml");
const METALS: &str = include_str!("scenes/metals.toml");

/// A blue mirror in which a bright sky and a lamp are, and a wall that turns its back.
const BLUE_MIRROR: &str = r#"
camera = { eye = [0, 0, 5], target = [0, 0, 0], fov_y = 60 }
sky = { radiance = [0.25, 3, 7] }
material.mirror.mirror.reflectance = [0.3, 0.5, 0.9]
material.wall.diffuse.albedo = [0.2, 0.4, 0.6]
material.lamp.emissive.radiance = [0.5, 2, 9]
rectangle = [
    { corner = [-2, -2, 0], edge_u = [2, 0, 0], edge_v = [0, 4, 0], material = "mirror" },
    { corner = [1, -2, 0], edge_u = [0, 4, 0], edge_v = [2, 0, 0], material = "wall" },
    { corner = [-4, -1, 9], edge_u = [0, 2, 0], edge_v = [9, 0, 0], material = "lamp" },
]
"#;

const SOBOL: (SamplerKind, u32) = (SamplerKind::Sobol, 1);

fn devices() -> Vec<Gpu> {
    Gpu::each().unwrap()
}

fn parsed(text: &str) -> Scene {
    scene::parse(text, "test", Path::new("test.toml")).unwrap()
}

/// Under a sky of eight columns and four rows, each of its own colour, most of them darker than 1 and some brighter.
fn under_a_picture(mut scene: Scene) -> Scene {
    let texels: Vec<_> =
        (0..32).map(|i| Vec3::new(i as f32 / 24.0, 1.0 - i as f32 / 32.0, (i % 5) as f32 / 5.0)).collect();
    let map = EnvironmentMap::new(Image::new(8, 4, texels).unwrap(), 1.0, 0.3).unwrap();
    scene.sky = map.mean();
    scene.environment = Some(Arc::new(map));
    scene
}

/// A name for each, and the share of its pixels that may differ.
fn scenes() -> Vec<(&'static str, Scene, f64)> {
    let built_in = |name| builtin::named(name).unwrap();
    vec![
        ("whitted", built_in("whitted"), 2e-3),
        ("cornell", built_in("cornell"), 1e-3),
        ("a mesh, and all else", parsed(EVERYTHING), 2e-3),
        ("rough metals under a picture", under_a_picture(parsed(METALS)), 2e-3),
        ("a blue mirror and a back", parsed(BLUE_MIRROR), 1e-3),
        ("mirrors that never end", built_in("hard/mirror-box"), 1e-3),
        ("glass in glass", built_in("hard/nested-glass"), 2e-3),
    ]
}

fn on_the_processor(scene: &Scene, pass: &FeaturePass, size: (u32, u32)) -> (Features, Stats) {
    let mut film = FeatureFilm::new(size);
    let stats = Tracer::new(scene).add_features(&mut film, pass, &|| false);
    (film.features().unwrap(), stats)
}

fn on_a_device(tracer: &mut GpuTracer, pass: &FeaturePass, size: (u32, u32)) -> (Features, Stats) {
    let mut film = FeatureFilm::new(size);
    let stats = tracer.add_features(&mut film, pass, &|| false).unwrap();
    (film.features().unwrap(), stats)
}

/// Share of pixels of which anything is farther apart than rounding takes it: where one of few samples meets another
/// surface, the mean is off by far more.
fn apart(a: &Features, b: &Features) -> f64 {
    let far = |a: Vec3, b: Vec3| !a.abs_diff_eq(b, 1e-3);
    let is_apart = |i: &usize| {
        let (near, away) = (a.depth[*i], b.depth[*i]);
        // nowhere is as far as nowhere
        let depth = near != away && ((near - away).abs() / away).is_nan() | ((near - away).abs() > 1e-3 * away);
        depth || far(a.albedo[*i], b.albedo[*i]) || far(a.normal[*i], b.normal[*i])
    };
    (0..a.depth.len()).filter(is_apart).count() as f64 / a.depth.len() as f64
}

#[test]
fn pixels_show_the_same_on_every_device() {
    let size = (160, 100);
    for gpu in devices() {
        for (name, scene, allowed) in scenes() {
            let pass = FeaturePass::new(&scene.camera, size, 2, SOBOL);
            let (expected, stats) = on_the_processor(&scene, &pass, size);
            let (seen, on_device) = on_a_device(&mut GpuTracer::new(&gpu, &scene).unwrap(), &pass, size);
            let (apart, rays) = (apart(&seen, &expected), on_device.rays as f64 / stats.rays as f64);
            println!("{name}, {}: {apart} of the pixels apart, {rays} times the rays", gpu.describe());
            assert!(apart <= allowed && (rays - 1.0).abs() < 1e-3, "{name}, {}: {apart} {rays}", gpu.describe());
            assert_eq!(on_device.samples, stats.samples);
        }
    }
}

#[test]
fn samplers_and_seeds_are_those_of_the_processor() {
    let (gpu, scene, size) = (Gpu::headless().unwrap(), builtin::named("whitted").unwrap(), (96, 64));
    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    for sampler in [(SamplerKind::Independent, 9), (SamplerKind::Sobol, 9)] {
        let pass = FeaturePass::new(&scene.camera, size, 1, sampler);
        let (expected, _) = on_the_processor(&scene, &pass, size);
        let apart = apart(&on_a_device(&mut tracer, &pass, size).0, &expected);
        assert!(apart <= 2e-3, "{sampler:?}: {apart}");
    }
}

/// Through a tree as among few shapes, and with code for all that the scene lacks.
#[test]
fn what_is_compiled_in_changes_nothing() {
    let (gpu, scene, size) = (Gpu::headless().unwrap(), builtin::named("whitted").unwrap(), (96, 64));
    let pass = FeaturePass::new(&scene.camera, size, 1, SOBOL);
    let (expected, _) = on_the_processor(&scene, &pass, size);
    for tracer in [GpuTracer::through_a_tree(&gpu, &scene), GpuTracer::with_everything(&gpu, &scene)] {
        let apart = apart(&on_a_device(&mut tracer.unwrap(), &pass, size).0, &expected);
        assert!(apart <= 2e-3, "{apart}");
    }
}

/// However it is cut into passes and dispatches, and stopped.
#[test]
fn samples_that_come_in_passes_are_those_of_one_pass() {
    let (scene, size) = (builtin::named("whitted").unwrap(), (67, 37));
    let pass = |samples| FeaturePass::new(&scene.camera, size, samples, SOBOL);
    let pixels = 67 * 37;
    for gpu in devices() {
        let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
        let (expected, stats) = on_a_device(&mut tracer, &pass(3), size);
        assert_eq!(stats.samples, 3 * pixels);
        // as little as a dispatch can do
        tracer.set_budget(1e-9);
        let mut film = FeatureFilm::new(size);
        assert_eq!(tracer.add_features(&mut film, &pass(1), &|| true).unwrap(), Stats::default());
        assert_eq!(film.features(), None);
        assert_eq!(tracer.add_features(&mut film, &pass(1), &|| false).unwrap().samples, pixels);
        let asked = Cell::new(0);
        let stop = || asked.replace(asked.get() + 1) > 3;
        let taken = tracer.add_features(&mut film, &pass(3), &stop).unwrap().samples;
        assert!(film.samples_per_pixel() == 1 && 0 < taken && taken < 2 * pixels, "{taken} of {pixels}");
        let by_the_processor = &mut film.clone();
        let rest = tracer.add_features(&mut film, &pass(3), &|| false).unwrap().samples;
        assert_eq!((taken + rest, film.samples_per_pixel(), film.samples()), (2 * pixels, 3, 3 * pixels));
        assert!(film.features() == Some(expected.clone()), "{}", gpu.describe());
        // or elsewhere
        assert_eq!(Tracer::new(&scene).add_features(by_the_processor, &pass(3), &|| false).samples, rest);
        assert_eq!(by_the_processor.samples(), 3 * pixels);
        let apart = apart(&by_the_processor.features().unwrap(), &expected);
        assert!(apart <= 2e-3, "{apart}");
    }
}

/// More than are on a device at a time.
#[test]
fn pixels_behind_the_first_million_show_what_they_should() {
    let (gpu, scene, size) = (Gpu::headless().unwrap(), builtin::named("hard/slab").unwrap(), (1200, 900));
    let pass = FeaturePass::new(&scene.camera, size, 1, SOBOL);
    let (expected, stats) = on_the_processor(&scene, &pass, size);
    let (seen, on_device) = on_a_device(&mut GpuTracer::new(&gpu, &scene).unwrap(), &pass, size);
    let apart = apart(&seen, &expected);
    assert!(apart <= 1e-3 && on_device.samples == stats.samples, "{apart} {on_device:?}");
}

/// A scene that is changed shows its changes, whether that needs other code or not.
#[test]
fn another_scene_shows_other_surfaces() {
    let (gpu, size) = (Gpu::headless().unwrap(), (48, 32));
    let scene = builtin::named("cornell").unwrap();
    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    let mut nearer = scene.clone();
    nearer.camera.eye *= 0.9;
    nearer.shapes = scene.shapes[1..].into();
    for scene in [&scene, &nearer, &builtin::named("whitted").unwrap()] {
        tracer.set_scene(scene).unwrap();
        let pass = FeaturePass::new(&scene.camera, size, 1, SOBOL);
        let apart = apart(&on_a_device(&mut tracer, &pass, size).0, &on_the_processor(scene, &pass, size).0);
        assert!(apart <= 2e-3, "{apart}");
    }
}

#[test]
fn a_lost_device_is_an_error_and_leaves_what_there_was() {
    let (gpu, scene, size) = (Gpu::headless().unwrap(), builtin::named("cornell").unwrap(), (32, 32));
    let pass = |samples| FeaturePass::new(&scene.camera, size, samples, SOBOL);
    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    let mut film = FeatureFilm::new(size);
    tracer.add_features(&mut film, &pass(1), &|| false).unwrap();
    let before = film.features();
    gpu.device.destroy();
    assert!(tracer.add_features(&mut film, &pass(2), &|| false).is_err());
    assert!(film.features() == before && film.samples_per_pixel() == 1);
    assert!(tracer.features(&pass(1), &|| false).is_err());
}
