//! An area light does not shadow itself, however far away it is and through whatever structure rays go, on both
//! machines. A shadow ray's end is rounded with its direction: by more than the step off an area light near the origin.

use film::Film;
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{PathSettings, Roulette, Tracer};
use scene::{Scene, Vec3};
use std::path::Path;

/// A patch of floor in direction `from` of an area light at the origin, 20 units away, and the camera that sees it.
fn lit_by(area_light: &str, from: Vec3) -> Scene {
    let to_area_light = -from.normalize();
    let (u, v) = to_area_light.any_orthonormal_pair();
    let at = from.normalize() * 20.0;
    let list = |v: Vec3| format!("[{}, {}, {}]", v.x, v.y, v.z);
    let text = format!(
        r#"
[camera]
eye = {}
target = {}
up = {}
fov_y = 20
[material.floor]
diffuse = {{ albedo = [0.5, 0.5, 0.5] }}
[material.lamp]
emissive = {{ radiance = [1000, 1000, 1000], two_sided = true }}
{area_light}
material = "lamp"
[[rectangle]]
corner = {}
edge_u = {}
edge_v = {}
material = "floor"
"#,
        list(at + 0.5 * to_area_light),
        list(at),
        list(u),
        list(at - u - v),
        list(2.0 * u),
        list(2.0 * v),
    );
    scene::parse(&text, "far away", Path::new("test.toml")).expect("a scene")
}

/// The picture's mean by each structure and machine.
fn means(scene: &Scene) -> Vec<(String, f64)> {
    let settings = PathSettings { bounces: Some(0), roulette: Roulette::OFF, ..PathSettings::default() };
    let mut means = Vec::new();
    for (name, tracer) in [("few", Tracer::new(scene)), ("tree", Tracer::new(scene).with_single_rays())] {
        let mut film = Film::new(64, 64);
        tracer.render(&mut film, &scene.camera, &settings.into(), 16, &|| false);
        means.push((format!("CPU, {name}"), film.mean()[0]));
    }
    let gpu = Gpu::headless().expect("a device");
    for (name, tracer) in [("few", GpuTracer::new(&gpu, scene)), ("tree", GpuTracer::through_a_tree(&gpu, scene))] {
        let mut film = Film::new(64, 64);
        tracer.unwrap().render(&mut film, &scene.camera, &settings.into(), 16, &|| false).unwrap();
        means.push((format!("GPU, {name}"), film.mean()[0]));
    }
    means
}

#[test]
fn balls_far_away_do_not_shadow_themselves() {
    for from in [Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, -2.0, 0.7)] {
        // Le rho (r / d)^2 over a spot of the floor so small that distance and cosine are those of its middle
        let scene = lit_by("[[sphere]]\ncenter = [0, 0, 0]\nradius = 0.1", from);
        for (name, mean) in means(&scene) {
            assert!((mean / 0.0125 - 1.0).abs() < 1e-3, "{name} from {from}: {mean}");
        }
    }
}

/// Seen at cosines from .01 to 1.
#[test]
fn rectangles_far_away_do_not_shadow_themselves() {
    let normal = Vec3::new(1.0, 2.0, 3.0).normalize();
    let (u, v) = normal.any_orthonormal_pair();
    let list = |v: Vec3| format!("[{}, {}, {}]", v.x, v.y, v.z);
    let area_light =
        format!("[[rectangle]]\ncorner = {}\nedge_u = {}\nedge_v = {}", list(-0.5 * (u + v)), list(u), list(v));
    for cosine in [0.01f32, 0.03, 0.1, 0.3, 1.0] {
        let from = normal * cosine + (0.8 * u - 0.6 * v) * (1.0 - cosine * cosine).sqrt();
        let scene = lit_by(&area_light, from);
        // Le rho area cos / (pi d^2) is good to (size / d)^2
        let d = f64::from(20.0f32);
        let expected = 500.0 * from.normalize().as_dvec3().dot(normal.as_dvec3().normalize()) / (d * d);
        let expected = expected / std::f64::consts::PI;
        for (name, mean) in means(&scene) {
            assert!((mean / expected - 1.0).abs() < 5e-3, "{name} at cosine {cosine}: {mean}, not {expected}");
        }
    }
}

/// A card 2e-4 of the way before an area light keeps all its light: a shadow ray ends no sooner than rounding asks for.
#[test]
fn a_card_right_before_an_area_light_far_away_shadows_it() {
    let area_light = "[[rectangle]]\ncorner = [-1, -1, 0.004]\nedge_u = [2, 0, 0]\nedge_v = [0, 2, 0]\nmaterial = \"floor\"\n\
                [[rectangle]]\ncorner = [-0.5, -0.5, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]";
    for (name, mean) in means(&lit_by(area_light, Vec3::Z)) {
        assert!(mean == 0.0, "{name}: {mean}");
    }
    // and there is light without it
    let alone = area_light.split_once("[[rectangle]]\ncorner = [-0.5").expect("two shapes").1;
    let alone = format!("[[rectangle]]\ncorner = [-0.5{alone}");
    assert!(means(&lit_by(&alone, Vec3::Z)).iter().all(|(_, mean)| *mean > 0.1));
}
