//! Connections through and off spheres find the light that chance finds, and that of lights without extent, which chance
//! cannot find.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::{Film, Image};
use pathtrace::{Estimator, PathSettings, Roulette, Tracer};
use scene::{Bsdf, EnvironmentMap, Geometry, Scene, Shape, Vec3, builtin};
use std::path::Path;
use std::sync::Arc;

const SIZE: (u32, u32) = (32, 24);
/// Edge of the blocks of pixels that are compared.
const BLOCK: usize = 8;
/// Independent pictures of each kind. Of means of so many, one in 1,000 times 1,000 comparisons is beyond
/// [`MOST_DEVIATIONS`] standard errors of their difference by luck (Student's distribution, 62 degrees of freedom,
/// Sidak's correction). Seeds are fixed.
const PICTURES: u32 = 32;
const MOST_DEVIATIONS: f64 = 5.4;

/// A floor with a ball of glass and one that mirrors above it.
const BALLS: &str = r#"
camera = { eye = [0.3, 1.6, 6], target = [0.2, 0.6, 0], fov_y = 40 }
material.floor.diffuse.albedo = [0.7, 0.5, 0.3]
material.glass.dielectric.ior = 1.5
material.chrome.mirror.reflectance = [0.9, 0.8, 0.7]
material.lamp.emissive.radiance = [20, 20, 16]
material.both.emissive = { radiance = [9, 12, 12], two_sided = true }
material.gold.rough_conductor = { metal = "gold", roughness = 0.5 }
"#;
const FLOOR: &str = r#"
[[rectangle]]
corner = [-8, 0, -8]
edge_u = [0, 0, 16]
edge_v = [16, 0, 0]
material = "floor"
"#;
const TWO: &str = "[[sphere]]\ncenter = [-0.9, 1.2, 0]\nradius = 0.8\nmaterial = \"glass\"\n\
                   [[sphere]]\ncenter = [1.2, 0.9, -0.4]\nradius = 0.7\nmaterial = \"chrome\"\n";

fn parsed(text: &str) -> Scene {
    scene::parse(text, "balls", Path::new("balls.toml")).expect("a scene")
}

fn with(more: &str) -> Scene {
    parsed(&format!("{BALLS}{FLOOR}{more}"))
}

fn connected(estimator: Estimator) -> PathSettings {
    PathSettings { estimator, ..PathSettings::independent() }
}

/// Mean and variance of the mean of each block's channels over independent pictures.
struct Blocks(Vec<[f64; 2]>);

impl Blocks {
    fn of(scene: &Scene, settings: PathSettings, first_seed: u32, spp: u32) -> Self {
        let tracer = Tracer::new(scene);
        let mut sums = Vec::new();
        for seed in first_seed..first_seed + PICTURES {
            let mut film = Film::new(SIZE.0, SIZE.1);
            let settings = PathSettings { seed, ..settings };
            tracer.render(&mut film, &scene.camera, &settings.into(), spp, &|| false);
            assert_eq!(film.nonfinite, 0, "{settings:?}");
            let blocks = block_means(&film);
            sums.resize(blocks.len(), [0.0; 2]);
            sums.iter_mut().zip(blocks).for_each(|(sum, x)| *sum = [sum[0] + x, sum[1] + x * x]);
        }
        let n = f64::from(PICTURES);
        Blocks(
            sums.into_iter().map(|[sum, squares]| [sum / n, (squares / n - (sum / n).powi(2)) / (n - 1.0)]).collect(),
        )
    }

    fn mean(&self) -> f64 {
        self.0.iter().map(|block| block[0]).sum::<f64>() / self.0.len() as f64
    }
}

fn block_means(film: &Film) -> Vec<f64> {
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let columns = width / BLOCK;
    let mut means = vec![0.0; columns * (height / BLOCK) * 3];
    for (index, pixel) in film.pixels().iter().enumerate() {
        let block = index / width / BLOCK * columns + index % width / BLOCK;
        for (channel, value) in pixel.mean().into_iter().enumerate() {
            means[3 * block + channel] += value / (BLOCK * BLOCK) as f64;
        }
    }
    means
}

/// With connections the picture is the one that chance makes, block by block, by both estimators that sample lights.
#[track_caller]
fn assert_as_by_chance(what: &str, scene: &Scene, settings: PathSettings, spp: u32) {
    let chance = Blocks::of(scene, PathSettings { connections: false, ..settings }, 1, 4 * spp);
    for (estimator, seed) in [(Estimator::LIGHT, 1001), (Estimator::MIS, 2001)] {
        let on = Blocks::of(scene, PathSettings { estimator, ..settings }, seed, spp);
        let errors = on.0.iter().zip(&chance.0).map(|([a, a2], [b, b2])| (a - b) / (a2 + b2).sqrt().max(1e-9));
        let worst = errors.clone().map(f64::abs).fold(0.0, f64::max);
        let apart = on.mean() / chance.mean() - 1.0;
        let noise = |blocks: &Blocks| blocks.0.iter().map(|b| b[1]).sum::<f64>();
        println!(
            "{what}, {}: {worst:.2} standard errors, means {apart:+.5}, variance of one sample {:.2} of chance's",
            estimator.name(),
            noise(&on) / noise(&chance) / 4.0
        );
        assert!(worst < MOST_DEVIATIONS, "{what}, {}: {worst}, means differ by {apart}", estimator.name());
    }
}

#[test]
fn every_light_arrives_as_by_chance() {
    let lights = [
        ("sun", "[sun]\ntowards = [2, 3, 1.5]\nangular_radius = 9\nirradiance = [3, 3, 3]\n"),
        ("ball", "[[sphere]]\ncenter = [-2.5, 3.4, 1.5]\nradius = 0.5\nmaterial = \"lamp\"\n"),
        (
            "rectangle",
            "[[rectangle]]\ncorner = [-1, 4, -1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 2]\nmaterial = \"lamp\"\n",
        ),
        ("disk", "[[disk]]\ncenter = [-2, 3.5, 1]\nnormal = [0.5, -1, -0.3]\nradius = 0.8\nmaterial = \"both\"\n"),
        (
            "mesh",
            "[[mesh]]\npositions = [[-1, 3, -1], [1.5, 3.2, -0.5], [0, 4, 1], [0.5, 2.8, 1.5]]\n\
             triangles = [[0, 1, 2], [1, 3, 2]]\nmaterial = \"both\"\n",
        ),
    ];
    for (name, light) in lights {
        assert_as_by_chance(name, &with(&format!("{light}{TWO}")), connected(Estimator::MIS), 32);
    }
}

/// A sphere in a sphere, one that stands on the floor, one cut by another, an opaque one inside of glass, light from inside
/// and below, rough metal beneath, a vertex in the focus: where a chain may be on its way through something else.
#[test]
fn what_stands_in_the_way_is_as_by_chance() {
    let sun = "[sun]\ntowards = [1, 4, 1]\nangular_radius = 9\nirradiance = [3, 3, 3]\n";
    let ball = |center: [f32; 3], radius: f32, material: &str| {
        format!("[[sphere]]\ncenter = {center:?}\nradius = {radius}\nmaterial = \"{material}\"\n")
    };
    let glass = |center, radius| ball(center, radius, "glass");
    let cases = [
        ("nested", format!("{}{}", glass([0.0, 1.2, 0.0], 1.0), glass([0.1, 1.3, 0.0], 0.5))),
        ("touching", format!("{}{}", glass([-1.0, 0.8, 0.0], 0.8), ball([1.0, 0.7, 0.3], 0.7, "chrome"))),
        ("cutting", format!("{}{}", glass([-0.4, 1.2, 0.0], 0.8), ball([0.5, 1.3, 0.0], 0.8, "chrome"))),
        ("filled", format!("{}{}", glass([0.0, 1.2, 0.0], 0.9), ball([0.2, 1.1, 0.1], 0.4, "floor"))),
        ("behind each other", format!("{}{}", glass([0.0, 1.0, 0.0], 0.6), ball([0.5, 2.6, 0.4], 0.7, "chrome"))),
        ("light inside", format!("{}{}", glass([0.0, 1.2, 0.0], 0.9), ball([0.2, 1.1, 0.1], 0.3, "both"))),
        ("glowing caster", format!("{TWO}{}", ball([-2.2, 0.8, 1.0], 0.5, "glow"))),
        ("light around", format!("{TWO}{}", ball([0.0, 0.0, 0.0], 30.0, "dome"))),
    ];
    let glow = "material.glow = { mirror = { reflectance = [0.8, 0.8, 0.8] }, emissive = { radiance = [2, 1, 1] } }\n\
                material.dome.emissive = { radiance = [1, 1.5, 2], two_sided = true }\n";
    for (name, balls) in cases {
        let sun = if name == "light around" { "" } else { sun };
        let scene = parsed(&format!("{BALLS}{glow}{FLOOR}{sun}{balls}"));
        assert_as_by_chance(name, &scene, connected(Estimator::MIS), 24);
    }
    let metal = format!("{BALLS}{}{sun}{TWO}", FLOOR.replace("\"floor\"", "\"gold\""));
    assert_as_by_chance("rough metal", &parsed(&metal), connected(Estimator::MIS), 24);
    assert_as_by_chance("uniform", &with(&format!("{sun}{TWO}")), connected(Estimator::UNIFORM_MIS), 24);
}

/// A sphere's specular vertices count against the limit, whoever finds the light behind them; and roulette, branches and
/// other places change nothing.
#[test]
fn limits_of_bounces_hold_for_connections_too() {
    let sun = "[sun]\ntowards = [1, 3, 1]\nangular_radius = 9\nirradiance = [3, 3, 3]\n";
    let scene = with(&format!("{sun}{TWO}"));
    let base = connected(Estimator::MIS);
    for bounces in 0..=3 {
        let settings = PathSettings { bounces: Some(bounces), ..base };
        assert_as_by_chance(&format!("{bounces} bounces"), &scene, settings, 24);
    }
    let roulette = Roulette::constant(0.7);
    assert_as_by_chance("roulette", &scene, PathSettings { roulette, ..base }, 24);
    assert_as_by_chance("branches", &scene, PathSettings { branches: 2, bounces: Some(3), ..base }, 12);
    let sky = "sky = { radiance = [0.4, 0.6, 1.2] }\n";
    assert_as_by_chance("under a sky", &parsed(&format!("{sky}{BALLS}{FLOOR}{sun}{TWO}")), base, 24);
}

/// A sky that is a picture, all of it bright and a part of it more so.
#[test]
fn a_picture_of_the_sky_arrives_as_by_chance() {
    let mut scene = with(TWO);
    let texel = |k: u32| Vec3::splat(if k == 6 { 12.0 } else { 0.5 });
    let image = Image::new(8, 4, (0..32).map(texel).collect::<Vec<_>>()).expect("a picture");
    let map = EnvironmentMap::new(image, 1.0, 0.0).expect("a sky");
    scene.sky = map.mean();
    scene.environment = Some(Arc::new(map));
    assert_as_by_chance("sky", &scene, connected(Estimator::MIS), 24);
}

/// The scene moved this far along all axes.
fn moved(scene: &Scene, by: f32) -> Scene {
    let mut far = scene.clone();
    let by = Vec3::splat(by);
    (far.camera.eye, far.camera.target) = (far.camera.eye + by, far.camera.target + by);
    let shapes = scene.shapes.iter().cloned().map(|mut shape| {
        match &mut shape.geometry {
            Geometry::Sphere { center, .. } | Geometry::Disk { center, .. } => *center += by,
            Geometry::Rectangle { corner, .. } => *corner += by,
            Geometry::Box { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => panic!("not in this scene"),
        }
        shape
    });
    far.shapes = shapes.collect();
    far
}

#[test]
fn connections_hold_far_from_the_origin() {
    let sun = "[sun]\ntowards = [1, 3, 1]\nangular_radius = 9\nirradiance = [3, 3, 3]\n";
    let far = moved(&with(&format!("{sun}{TWO}")), 1000.0);
    assert_as_by_chance("far away", &far, connected(Estimator::MIS), 24);
}

/// Green radiance of a floor in one of its points.
fn floor_at(scene: &Scene, at: Vec3, settings: PathSettings, spp: u32) -> f64 {
    let mut camera = scene.camera;
    (camera.eye, camera.target) = (at + Vec3::new(-0.3, 0.4, 1.2), at);
    camera.fov_y = 1e-3;
    let mut film = Film::new(1, 1);
    Tracer::new(scene).render(&mut film, &camera, &settings.into(), spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    film.pixels()[0].mean()[1]
}

/// The middle of the caustic of whitted's glass alone, where refraction by a sphere at distance D spreads light by
/// `(1 - 2 (n - 1) D / n)^2` and keeps `(1 - F)^2`, F at normal incidence: .7647 of the albedo under a sun without a disc.
/// Under wider ones the mean over the disc, as traced rays have it. What chance sees there of the floor in the glass is
/// none of it.
#[test]
fn the_middle_of_a_caustic_is_as_bright_as_its_formula_says() {
    let mut scene = builtin::named("whitted").expect("built in");
    scene.sky = Vec3::ZERO;
    let mirrors = |shape: &Shape| matches!(scene.material_of(shape).bsdf, Bsdf::Mirror { .. });
    scene.shapes = scene.shapes.iter().filter(|shape| !mirrors(shape)).cloned().collect();
    let (at, albedo) = (Vec3::new(2.2, 0.0, -3.8), 0.8);
    // Sobol points choose the glass as often as they should
    let on = PathSettings { bounces: Some(2), estimator: Estimator::MIS, ..PathSettings::default() };
    let lights = PathSettings { connections: false, estimator: Estimator::LIGHT, ..on };
    scene.sun.as_mut().expect("a sun").angular_radius = 0.0;
    let reflected = floor_at(&scene, at, lights, 400_000);
    for (degrees, expected, tolerance) in [(0.0, 0.7647, 3e-4), (0.5, 0.7638, 5e-4), (2.5, 0.742, 2e-3)] {
        scene.sun.as_mut().expect("a sun").angular_radius = degrees;
        let caustic = (floor_at(&scene, at, on, 1 << 17) - reflected) / albedo;
        println!("{degrees} degrees: {caustic:.5} of the albedo, beside {:.5}", reflected / albedo);
        assert!((caustic - expected).abs() < tolerance, "{degrees}: {caustic}");
    }
}

/// A point light shines like a tiny ball of its power, by every chain.
#[test]
fn a_point_light_is_a_tiny_ball() {
    let (radius, radiance) = (0.02f32, 20.0f32);
    let intensity = radiance * std::f32::consts::PI * radius * radius;
    let place = "[-2.5, 3.4, 1.5]";
    let ball = format!("[[sphere]]\ncenter = {place}\nradius = {radius}\nmaterial = \"lamp\"\n{TWO}");
    let point = format!(
        "[[point_light]]\nposition = {place}\nintensity = [{intensity}, {intensity}, {}]\n{TWO}",
        0.8 * intensity
    );
    // of the floor's own light: a ball is seen in the mirror as well
    let settings = PathSettings { bounces: Some(2), ..connected(Estimator::MIS) };
    let [ball, point] = [ball, point].map(|light| Blocks::of(&with(&light), settings, 1, 128));
    let below = |blocks: &Blocks| blocks.0[blocks.0.len() / 3 * 2..].to_vec();
    for (a, b) in below(&ball).into_iter().zip(below(&point)) {
        let error = (a[1] + b[1]).sqrt();
        assert!((a[0] - b[0]).abs() < MOST_DEVIATIONS * error + 0.005 * b[0], "{a:?} {b:?}");
    }
}

/// Bit for bit: what has no casters, or looks for no light, pays nothing.
#[test]
fn films_without_casters_or_sampled_lights_are_the_same() {
    let film = |scene: &Scene, estimator, connections| {
        let mut film = Film::new(SIZE.0, SIZE.1);
        let settings = PathSettings { estimator, connections, ..PathSettings::default() };
        Tracer::new(scene).render(&mut film, &scene.camera, &settings.into(), 2, &|| false);
        film
    };
    let differs = |scene: &Scene, estimator| film(scene, estimator, true) != film(scene, estimator, false);
    let named = |name| builtin::named(name).expect("built in");
    assert!(!differs(&named("cornell"), Estimator::MIS));
    assert!(!differs(&named("whitted"), Estimator::COSINE));
    assert!(differs(&named("whitted"), Estimator::MIS) && differs(&named("whitted"), Estimator::LIGHT));
}
