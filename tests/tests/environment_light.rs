//! A sky from a picture lights a scene as its radiance says, however it is found, on both machines: in the mean as a sky
//! of one colour where it has one, and by closed form where all of it is black but one texel.

mod twin;

use film::{Film, Image};
use pathtrace::gpu::GpuTracer;
use pathtrace::intersect::Ray;
use pathtrace::light::Lights;
use pathtrace::{Estimator, PathSettings, SamplerKind, Tracer, WhittedSettings};
use scene::{EnvironmentMap, Scene, Vec3};
use std::path::Path;
use std::sync::Arc;
use twin::{devices, direction, farthest, input, numbers, run, units};

const ESTIMATORS: [Estimator; 6] = [
    Estimator::UNIFORM,
    Estimator::COSINE,
    Estimator::LIGHT,
    Estimator::MIS,
    Estimator::UNIFORM_LIGHT,
    Estimator::UNIFORM_MIS,
];

/// What reflects, what mirrors and another light.
const OBJECTS: &str = r#"
camera = { eye = [0, 1.5, 6], target = [0, 0.8, 0], fov_y = 45 }
sky = { radiance = [0.4, 0.6, 1.2] }
material.floor.diffuse.albedo = [0.6, 0.5, 0.4]
material.chrome.mirror.reflectance = [0.9, 0.9, 0.9]
material.lamp.emissive.radiance = [3, 2, 1]
rectangle = [
    { corner = [-3, 0, -3], edge_u = [0, 0, 6], edge_v = [6, 0, 0], material = "floor" },
    { corner = [-2, 2, -1], edge_u = [1, 0, 0], edge_v = [0, 0, 1], material = "lamp" },
]
sphere = [
    { center = [-1, 0.7, 0], radius = 0.7, material = "floor" },
    { center = [1, 0.7, 0], radius = 0.7, material = "chrome" },
]
"#;

/// A floor that is all there is, seen from above.
const FLOOR: &str = r#"
camera = { eye = [0, 2, 0], target = [0, 0, 0], up = [0, 0, -1], fov_y = 45 }
material.floor.diffuse.albedo = [0.5, 0.5, 0.5]
rectangle = [{ corner = [-50, 0, -50], edge_u = [0, 0, 100], edge_v = [100, 0, 0], material = "floor" }]
"#;

fn parsed(text: &str) -> Scene {
    scene::parse(text, "test", Path::new("test.toml")).unwrap()
}

fn under(mut scene: Scene, width: u32, texels: Vec<Vec3>, rotation: f32) -> Scene {
    let image = Image::new(width, texels.len() as u32 / width, texels).unwrap();
    let map = EnvironmentMap::new(image, 1.0, rotation).unwrap();
    scene.sky = map.mean();
    scene.environment = Some(Arc::new(map));
    scene
}

/// Independent samples, whose standard error the film knows.
fn settings(estimator: Estimator, seed: u32) -> PathSettings {
    PathSettings { estimator, seed, sampler: SamplerKind::Independent, bounces: Some(4), ..PathSettings::default() }
}

/// The same on both machines.
fn films(scene: &Scene, settings: &PathSettings, samples: u32) -> [Film; 2] {
    let [mut by_cpu, mut by_gpu] = [Film::new(32, 18), Film::new(32, 18)];
    Tracer::new(scene).render(&mut by_cpu, &scene.camera, &(*settings).into(), samples, &|| false);
    let mut device = GpuTracer::new(&gpu::Gpu::headless().unwrap(), scene).unwrap();
    device.render(&mut by_gpu, &scene.camera, &(*settings).into(), samples, &|| false).unwrap();
    assert_eq!((by_cpu.nonfinite, by_gpu.nonfinite), (0, 0));
    [by_cpu, by_gpu]
}

/// 4.5 standard errors: 36 comparisons of three channels go wrong by chance once in a thousand runs, were there chance.
#[test]
fn a_picture_of_one_texel_is_in_the_mean_the_sky_of_its_colour() {
    let plain = parsed(OBJECTS);
    let one_texel = under(plain.clone(), 1, vec![plain.sky], 0.0);
    for estimator in ESTIMATORS {
        let of_plain = films(&plain, &settings(estimator, 1), 256);
        let of_texel = films(&one_texel, &settings(estimator, 2), 256);
        for (film, with) in of_texel.iter().flat_map(|film| of_plain.iter().map(move |with| (film, with))) {
            for c in 0..3 {
                let error = film.standard_error()[c].hypot(with.standard_error()[c]);
                let off = film.mean()[c] - with.mean()[c];
                assert!(off.abs() < 4.5 * error, "{}: channel {c} is off by {off}, {error}", estimator.name());
            }
        }
    }
}

/// Rows 1 to 2 of 8, one of 16 columns: `albedo / pi L dphi (sin^2 b - sin^2 a) / 2`. A texel below the floor is drawn as
/// often, and lights nothing.
#[test]
fn a_bright_texel_lights_a_floor_as_the_closed_form_says() {
    let mut texels = vec![Vec3::ZERO; 16 * 8];
    (texels[16 + 3], texels[16 * 6 + 3]) = (Vec3::new(100.0, 50.0, 10.0), Vec3::splat(100.0));
    let scene = under(parsed(FLOOR), 16, texels, 77.0);
    let [a, b] = [1.0, 2.0].map(|row| (std::f64::consts::PI / 8.0 * row).sin().powi(2));
    let unit = 0.5 / std::f64::consts::PI * (std::f64::consts::TAU / 16.0) * 0.5 * (b - a);
    let compare = |name: &str, film: &Film| {
        for (c, radiance) in [100.0, 50.0, 10.0].into_iter().enumerate() {
            let (expected, found, error) = (unit * radiance, film.mean()[c], film.standard_error()[c]);
            assert!(error < 0.015 * expected, "{name}: {error} of {expected} is too rough");
            assert!(
                (found - expected).abs() < 4.5 * error + 1e-5 * expected,
                "{name}: {found} for {expected}, {error}"
            );
        }
    };
    for estimator in [Estimator::LIGHT, Estimator::MIS, Estimator::COSINE] {
        for film in films(&scene, &settings(estimator, 3), 1024) {
            compare(estimator.name(), &film);
        }
    }
    // a light like any other for Whitted's trees
    let trees = WhittedSettings { ambient: Some(0.0), sampler: SamplerKind::Independent, ..WhittedSettings::default() };
    let mut film = Film::new(32, 18);
    Tracer::new(&scene).render(&mut film, &scene.camera, &trees.into(), 1024, &|| false);
    compare("whitted", &film);
}

/// A sky of 37 x 19 texels, some of them black, and a light beside it.
fn patched() -> Scene {
    let texel = |i: u32| match units(i, 1) {
        [dark, ..] if dark < 0.2 => Vec3::ZERO,
        [_, r, g, b] => Vec3::new(r, g, b),
    };
    under(parsed(OBJECTS), 37, (0..37 * 19).map(texel).collect(), 100.0)
}

/// The directions' error is that of sine and cosine, and near the poles that of a root; densities are quotients of
/// differences, of which those of rounded sums are the same numbers.
#[test]
fn samples_of_a_picture_agree() {
    let scene = patched();
    let lights = Lights::new(&scene);
    let environment = lights.environment().unwrap();
    for tracer in devices(&scene) {
        let given = input(|item| {
            let [u, v, ..] = units(item, 3);
            numbers(Vec3::new(u, v, 0.0), [0.0; 5])
        });
        let file = "pathtrace/light/environment.wgsl";
        let sample = |body: &str| run(&tracer, file, body, &[], &given);
        let directions =
            sample("let s = environment_sample(vec2f(f(at), f(at + 1u))); return bits(s.wi.x, s.wi.y, s.wi.z, 0.0);");
        let off = farthest(&directions, |item| {
            let [u, v, ..] = units(item, 3);
            let wi = environment.sample([u, v]).wi;
            [wi.x, wi.y, wi.z, 0.0]
        });
        assert!(off < 5e-5, "directions off by {off}");
        let radiances = sample(
            "let s = environment_sample(vec2f(f(at), f(at + 1u))); let r = s.radiance_over_pdf;
             return bits(r.x, r.y, r.z, select(0.0, s.pdf, s.endless));",
        );
        for (given, found) in given.iter().zip(radiances) {
            let [u, v, ..] = given.map(f32::from_bits);
            let on_cpu = environment.sample([u, v]);
            let [r, g, b, pdf] = found.map(f32::from_bits);
            assert!((pdf / on_cpu.pdf - 1.0).abs() < 1e-5, "({u}, {v}): {pdf} and {}", on_cpu.pdf);
            let expected = Vec3::new(on_cpu.radiance.x, on_cpu.radiance.y, on_cpu.radiance.z) / on_cpu.pdf;
            let off = (Vec3::new(r, g, b) - expected).abs().max_element();
            assert!(off <= 1e-5 * expected.max_element(), "({u}, {v}): radiance off by {off}");
        }
    }
}

/// But for directions within rounding of a texel's edge.
#[test]
fn radiances_and_densities_of_directions_agree() {
    let scene = patched();
    let lights = Lights::new(&scene);
    let environment = lights.environment().unwrap();
    for tracer in devices(&scene) {
        let given = input(|item| numbers(direction(item, 5), [0.0; 5]));
        let body = "let e = environment_look_up(vec(at)); return vec4u(bits(e.x, e.y, e.z, e.w));";
        let on_gpu = run(&tracer, "pathtrace/light/environment.wgsl", body, &[], &given);
        let mut other = 0;
        for (given, found) in given.iter().zip(on_gpu) {
            let [x, y, z, ..] = given.map(f32::from_bits);
            let (radiance, pdf) = environment.look_up(Ray::new(Vec3::ZERO, Vec3::new(x, y, z)).lane().direction);
            let found = found.map(f32::from_bits);
            let off = [radiance.x, radiance.y, radiance.z].iter().zip(found).any(|(a, b)| *a != b);
            other += u32::from(off || (found[3] - pdf).abs() > 1e-5 * pdf);
        }
        assert!(other <= 4, "{other} directions differ");
    }
}
