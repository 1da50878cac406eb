//! Connections through spheres on the GPU are the twins of the CPU's: the same roots of the same chains, so that pictures
//! agree pixel by pixel under every kind of light.

mod pair;

use film::{Film, Image};
use gpu::Gpu;
use pair::{Pair, paths};
use pathtrace::gpu::GpuTracer;
use pathtrace::{Estimator, PathSettings, Roulette, SamplerKind, Tracer};
use scene::{EnvironmentMap, Scene, Vec3, builtin};
use std::path::Path;
use std::sync::Arc;

const SIZE: (u32, u32) = (96, 64);

/// Two balls of glass and one that mirrors over a floor with a plate of rough metal, under `light`.
fn under(light: &str) -> Scene {
    let text = format!(
        r#"
[camera]
eye = [0, 2.5, 5]
target = [0, 0.6, 0]
fov_y = 50
[material.floor]
diffuse = {{ albedo = [0.7, 0.6, 0.5] }}
[material.glass]
dielectric = {{ ior = 1.5 }}
[material.mirror]
mirror = {{ reflectance = [0.9, 0.7, 0.5] }}
[material.satin]
rough_conductor = {{ reflectance = [0.8, 0.9, 0.7], roughness = 0.7 }}
[material.lamp]
emissive = {{ radiance = [8, 7, 6] }}
[material.both]
emissive = {{ radiance = [4, 5, 6], two_sided = true }}
[[rectangle]]
corner = [-4, 0, -4]
edge_u = [0, 0, 8]
edge_v = [8, 0, 0]
material = "floor"
[[disk]]
center = [0, 0.02, 1.8]
normal = [0, 1, 0]
radius = 0.7
material = "satin"
[[sphere]]
center = [-0.8, 1, 0.4]
radius = 0.6
material = "glass"
[[sphere]]
center = [1, 0.5, 0]
radius = 0.5
material = "mirror"
[[sphere]]
center = [1.7, 0.4, 1.2]
radius = 0.4
material = "glass"
{light}"#
    );
    scene::parse(&text, "balls", Path::new("balls.toml")).unwrap()
}

/// Large ones among them, so that chance finds them by the balls as well.
const LIGHTS: [(&str, &str); 8] = [
    ("a sun", "[sun]\ntowards = [1, 2, 0.5]\nirradiance = [3, 3, 3]\nangular_radius = 25\n"),
    ("a delta sun", "[sun]\ntowards = [1, 2, 0.5]\nirradiance = [3, 3, 3]\nangular_radius = 0\n"),
    ("a point", "[[point_light]]\nposition = [-0.5, 2.4, 0.6]\nintensity = [6, 6, 7]\n"),
    ("a ball", "[[sphere]]\ncenter = [-0.6, 3, 0.6]\nradius = 1\nmaterial = 'lamp'\n"),
    (
        "a rectangle",
        "[[rectangle]]\ncorner = [-2, 2.5, -1.5]\nedge_u = [4, 0, 0]\nedge_v = [0, 0, 4]\nmaterial = 'lamp'\n",
    ),
    ("a disk", "[[disk]]\ncenter = [-0.3, 2.5, 0.6]\nnormal = [0, -1, 0]\nradius = 1.5\nmaterial = 'both'\n"),
    (
        "triangles",
        "[[mesh]]\npositions = [[-2, 2.5, -1], [2, 2.5, -1], [0, 2.3, 3]]\ntriangles = [[0, 1, 2]]\nmaterial = 'both'\n",
    ),
    (
        "a sky and two lights",
        "[sky]\nradiance = [0.2, 0.3, 0.4]\n[[point_light]]\nposition = [-0.5, 2.4, 0.6]\nintensity = [2, 2, 2]\n[sun]\ntowards = [1, 2, 0.5]\nirradiance = [2, 2, 2]\nangular_radius = 0.5\n",
    ),
];

fn settings(estimator: Estimator, bounces: u32) -> PathSettings {
    PathSettings { estimator, bounces: Some(bounces), ..PathSettings::default() }
}

/// The same picture but for pixels where rounding sends a path elsewhere: at the rims of balls, and next to folds, where
/// two roots become one.
fn agree(what: &str, pair: &Pair) {
    let (apart, rays) = (pair.apart(2e-3), pair.rays());
    println!("{what}: {apart:.5} of the pixels apart, {rays:.5} times the rays");
    assert!(apart <= 3e-3 && (rays - 1.0).abs() < 2e-3, "{what}: {apart} {rays}");
}

/// What connections change in the mean, against what is there without them, on the GPU.
fn changed(gpu: &Gpu, scene: &Scene, on: &PathSettings, film: &Film) -> f64 {
    let mut without = Film::new(film.width(), film.height());
    let off = PathSettings { connections: false, ..*on };
    GpuTracer::new(gpu, scene).unwrap().render(&mut without, &scene.camera, &off.into(), 1, &|| false).unwrap();
    (film.mean()[1] / without.mean()[1] - 1.0).abs()
}

#[test]
fn pictures_agree_under_every_light() {
    let gpu = Gpu::headless().unwrap();
    for (name, light) in LIGHTS {
        let scene = under(light);
        for estimator in [Estimator::LIGHT, Estimator::MIS] {
            let settings = settings(estimator, 4);
            let pair = paths(&gpu, &scene, SIZE, 1, &settings);
            agree(&format!("{name}, {}", estimator.name()), &pair);
            if estimator == Estimator::LIGHT {
                let changed = changed(&gpu, &scene, &settings, &pair.gpu);
                assert!(changed > 1e-3, "{name}: connections change {changed}");
            }
        }
    }
}

/// Of every radius, through OpenGL as well.
#[test]
fn pictures_of_whitted_agree_under_every_sun() {
    let devices = Gpu::each().unwrap();
    let [best, last] = [&devices[0], &devices[devices.len() - 1]];
    let mut scene = builtin::named("whitted").unwrap();
    for (gpu, degrees) in [(best, 2.5), (best, 0.5), (last, 0.0)] {
        scene.sun.as_mut().unwrap().angular_radius = degrees;
        let pair = paths(gpu, &scene, SIZE, 2, &settings(Estimator::MIS, 8));
        agree(&format!("{degrees} degrees"), &pair);
    }
}

/// Limits of bounces from none on, which count a chain's own vertices; every other way to draw directions; and branches.
#[test]
fn pictures_agree_with_every_setting() {
    let gpu = Gpu::headless().unwrap();
    let scene = under(LIGHTS[7].1);
    let mut all: Vec<_> = (0..4).map(|bounces| settings(Estimator::MIS, bounces)).collect();
    all.extend(
        [Estimator::UNIFORM, Estimator::COSINE, Estimator::UNIFORM_LIGHT, Estimator::UNIFORM_MIS]
            .map(|e| settings(e, 3)),
    );
    all.push(PathSettings { branches: 2, ..settings(Estimator::LIGHT, 3) });
    all.push(PathSettings { bounces: None, roulette: Roulette::constant(0.7), ..PathSettings::default() });
    all.push(PathSettings { sampler: SamplerKind::Independent, seed: 9, ..settings(Estimator::MIS, 5) });
    for settings in all {
        agree(&format!("{settings:?}"), &paths(&gpu, &scene, SIZE, 1, &settings));
    }
}

/// Under a ball that nearly focuses a near light, where most of what is seen of the floor has three rays by it.
#[test]
fn pictures_agree_near_a_focus() {
    let gpu = Gpu::headless().unwrap();
    let text = "[camera]\neye = [1, 0.5, 0]\ntarget = [0.1, 0, 0]\nfov_y = 40\n\
                [material.floor]\ndiffuse = { albedo = [0.7, 0.6, 0.5] }\n[material.glass]\ndielectric = { ior = 1.5 }\n\
                [[rectangle]]\ncorner = [-4, 0, -4]\nedge_u = [0, 0, 8]\nedge_v = [8, 0, 0]\nmaterial = 'floor'\n\
                [[sphere]]\ncenter = [0, 1.6, 0]\nradius = 1\nmaterial = 'glass'\n\
                [[point_light]]\nposition = [0, 3.1, 0]\nintensity = [6, 6, 7]\n";
    let scene = scene::parse(text, "focus", Path::new("focus.toml")).unwrap();
    for estimator in [Estimator::LIGHT, Estimator::MIS] {
        agree(estimator.name(), &paths(&gpu, &scene, SIZE, 1, &settings(estimator, 2)));
    }
}

/// A sky that is a picture is connected to under MIS and left to chance otherwise.
#[test]
fn pictures_agree_under_a_sky_that_is_a_picture() {
    let gpu = Gpu::headless().unwrap();
    let mut scene = under(LIGHTS[2].1);
    let bright = |x: u32, y: u32| if x == 5 && y == 2 { 30.0 } else { 0.3 };
    let texels: Vec<Vec3> = (0..8 * 16).map(|k| Vec3::splat(bright(k % 16, k / 16))).collect();
    scene.environment = Some(Arc::new(EnvironmentMap::new(Image::new(16, 8, texels).unwrap(), 1.0, 0.2).unwrap()));
    for estimator in [Estimator::LIGHT, Estimator::MIS] {
        agree(estimator.name(), &paths(&gpu, &scene, SIZE, 1, &settings(estimator, 4)));
    }
}

/// What lies inside a ball of glass stands in the way of what goes through: chords are asked for as well.
#[test]
fn pictures_agree_where_balls_are_inside_of_glass() {
    let gpu = Gpu::headless().unwrap();
    let inside = "[[sphere]]\ncenter = [-0.8, 1, 0.4]\nradius = 0.2\nmaterial = 'floor'\n\
                  [[sphere]]\ncenter = [1.7, 0.4, 1.2]\nradius = 0.15\nmaterial = 'glass'\n";
    let scene = under(&format!("{}{inside}", LIGHTS[1].1));
    agree("balls inside of glass", &paths(&gpu, &scene, SIZE, 1, &settings(Estimator::MIS, 6)));
}

/// More spheres than are met one by one, some of them casters: through a tree.
#[test]
fn pictures_agree_where_many_spheres_cast() {
    let gpu = Gpu::headless().unwrap();
    let ball = |i: u32| {
        let [x, z] = [i % 9, i / 9].map(|k| 0.45 * k as f32 - 1.8);
        let material = ["glass", "floor", "mirror"][i as usize % 3];
        format!("[[sphere]]\ncenter = [{x}, 0.2, {z}]\nradius = 0.18\nmaterial = '{material}'\n")
    };
    let scene = under(&format!("{}{}", LIGHTS[2].1, (0..72).map(ball).collect::<String>()));
    let pair = paths(&gpu, &scene, SIZE, 1, &settings(Estimator::LIGHT, 4));
    agree("many", &pair);
}

/// Of different seeds, so that errors are independent: within four standard errors, which are 2 % at most.
#[test]
fn means_agree_within_four_standard_errors() {
    let gpu = Gpu::headless().unwrap();
    let scene = builtin::named("whitted").unwrap();
    let on_cpu = PathSettings { sampler: SamplerKind::Independent, ..settings(Estimator::MIS, 8) };
    let on_gpu = PathSettings { seed: 77, ..on_cpu };
    let [mut gpu_film, mut cpu_film] = [(); 2].map(|()| Film::new(48, 27));
    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    tracer.render(&mut gpu_film, &scene.camera, &on_gpu.into(), 256, &|| false).unwrap();
    Tracer::new(&scene).render(&mut cpu_film, &scene.camera, &on_cpu.into(), 256, &|| false);
    for c in 0..3 {
        let error = gpu_film.standard_error()[c].hypot(cpu_film.standard_error()[c]);
        let (a, b) = (gpu_film.mean()[c], cpu_film.mean()[c]);
        println!("channel {c}: {:.2} standard errors apart, which are {:.4}", (a - b).abs() / error, error / b);
        assert!((a - b).abs() <= 4.0 * error && error < 0.02 * b, "{c}: {a} {b} +- {error}");
    }
}
