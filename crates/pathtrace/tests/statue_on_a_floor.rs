//! A large mesh of glass stands on an opaque floor above the only lamp: no light comes through.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{Estimator, Integrator, PathSettings, Tracer, WhittedSettings};
use scene::{Needs, Scene, Vec3};
use std::path::Path;

const SCENE: &str = "
[camera]
eye = [3, 2, 4]
target = [0, 0.8, 0]
fov_y = 35

[material.floor]
diffuse = { albedo = [0.8, 0.8, 0.8] }

[material.glass]
dielectric = { ior = 1.5 }

[material.lamp]
emissive = { radiance = [50, 50, 50], two_sided = true }

[[rectangle]]
corner = [-5, 0, -5]
edge_u = [0, 0, 10]
edge_v = [10, 0, 0]
material = 'floor'

[[rectangle]]
corner = [-2, -1, -2]
edge_u = [0, 0, 4]
edge_v = [4, 0, 0]
material = 'lamp'

[[statue]]
level = 5
rotate = [0, 40, 0]
material = 'glass'
";

fn scene(lamp: &str) -> Scene {
    let text = SCENE.replace("corner = [-2, -1, -2]", lamp);
    scene::parse(&text, "statue", Path::new("statue.toml")).expect("a scene")
}

fn integrators() -> [Integrator; 2] {
    let path = PathSettings { estimator: Estimator::MIS, seed: 5, ..PathSettings::default() };
    let whitted = WhittedSettings { ambient: Some(0.0), depth: 20, ..WhittedSettings::default() };
    [path.into(), whitted.into()]
}

fn brightest(film: &Film) -> f32 {
    film.radiances().map(Vec3::max_element).fold(0.0, f32::max)
}

#[test]
fn no_light_comes_through_a_floor_that_a_statue_of_glass_stands_on() {
    let below = scene("corner = [-2, -1, -2]");
    assert!(matches!(below.needs(), Needs { large_meshes: true, dielectric: true, .. }));
    let above = scene("corner = [-2, 5, -2]");
    for integrator in integrators() {
        let dark = rendered(&below, &integrator);
        assert_eq!(brightest(&dark), 0.0, "{integrator:?}");
        assert!(brightest(&rendered(&above, &integrator)) > 0.1, "a lamp above is seen: {integrator:?}");
    }
}

fn rendered(scene: &Scene, integrator: &Integrator) -> Film {
    let mut film = Film::new(48, 48);
    let _ = Tracer::new(scene).render(&mut film, &scene.camera, integrator, 32, &|| false);
    film
}

#[test]
fn nor_does_it_on_a_device() {
    let below = scene("corner = [-2, -1, -2]");
    for gpu in Gpu::each().expect("a device") {
        let mut tracer = GpuTracer::new(&gpu, &below).expect("it fits");
        for integrator in integrators() {
            let mut film = Film::new(32, 32);
            tracer.render(&mut film, &below.camera, &integrator, 8, &|| false).expect("a picture");
            assert_eq!(brightest(&film), 0.0, "{integrator:?} on {}", gpu.describe());
        }
    }
}
