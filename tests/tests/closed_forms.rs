//! Scenes whose radiance is known in closed form, for every estimator that can resolve them.

use pathtrace::{Estimator, PathSettings, Roulette, Tracer};
use scene::{Film, Scene};
use std::path::Path;

fn scene(text: &str) -> Scene {
    scene::parse(text, "test", Path::new("test.toml")).expect("a scene")
}

fn render(scene: &Scene, size: u32, spp: u32, settings: &PathSettings) -> Film {
    let mut film = Film::new(size, size);
    Tracer::new(scene).render(&mut film, &scene.camera, settings, spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    film
}

fn with(estimator: Estimator, bounces: Option<u32>, roulette: Roulette) -> PathSettings {
    PathSettings { estimator, bounces, roulette, seed: 3, ..PathSettings::default() }
}

/// The mean is within four standard errors of `expected`, and these are small enough to notice `power` of it.
fn assert_mean(film: &Film, expected: f64, power: f64, what: &str) {
    for (mean, error) in film.mean().into_iter().zip(film.standard_error()) {
        assert!(error <= power * expected, "{what}: a standard error of {error} proves nothing");
        assert!(
            (mean - expected).abs() <= 4.0 * error.max(1e-7 * expected),
            "{what}: {mean} +- {error}, expected {expected}"
        );
    }
}

/// The unit cube, open at the top (+z) or closed, its walls diffuse and perhaps emissive, seen from inside.
fn cube(albedo: f32, emission: f32, open: bool, sky: f32) -> Scene {
    // corner, edge_u, edge_v, their product pointing inwards; the lid last
    let faces = [
        ("0, 0, 0", "1, 0, 0", "0, 1, 0"),
        ("0, 0, 0", "0, 1, 0", "0, 0, 1"),
        ("1, 0, 0", "0, 0, 1", "0, 1, 0"),
        ("0, 0, 0", "0, 0, 1", "1, 0, 0"),
        ("0, 1, 0", "1, 0, 0", "0, 0, 1"),
        ("0, 0, 1", "0, 1, 0", "1, 0, 0"),
    ];
    let walls = faces.iter().take(if open { 5 } else { 6 }).map(|(corner, u, v)| {
        format!("[[rectangle]]\ncorner = [{corner}]\nedge_u = [{u}]\nedge_v = [{v}]\nmaterial = \"wall\"\n")
    });
    scene(&format!(
        r#"
[camera]
eye = [0.5, 0.5, 0.9]
target = [0.5, 0.6, 0]
fov_y = 80
[sky]
radiance = [{sky}, {sky}, {sky}]
[material.wall]
diffuse = {{ albedo = [{albedo}, {albedo}, {albedo}] }}
emissive = {{ radiance = [{emission}, {emission}, {emission}], two_sided = true }}
{}"#,
        walls.collect::<String>()
    ))
}

#[test]
fn white_furnace_every_cosine_sample_is_one() {
    let furnace = cube(1.0, 0.0, true, 1.0);
    let film = render(&furnace, 16, 16, &with(Estimator::COSINE, None, Roulette::THROUGHPUT));
    for pixel in film.radiances() {
        assert!((pixel - scene::Vec3::ONE).abs().max_element() < 1e-5, "{pixel}");
    }
}

/// Directions uniform: the weights 2 cos multiply along a path, so the furnace is one only on average.
#[test]
fn white_furnace_is_one_on_average_for_uniform_directions() {
    let furnace = cube(0.5, 0.5, false, 0.0);
    let film = render(&furnace, 32, 2048, &with(Estimator::UNIFORM, None, Roulette::THROUGHPUT));
    assert_mean(&film, 1.0, 0.002, "uniform");
}

#[test]
fn closed_emissive_box_has_radiance_emission_over_one_minus_albedo() {
    for (albedo, emission) in [(0.5, 0.5), (0.8, 0.2)] {
        let closed = cube(albedo, emission, false, 0.0);
        for estimator in Estimator::ALL {
            for roulette in [Roulette::THROUGHPUT, Roulette::constant(0.9)] {
                // uniform directions at albedo .8 need more samples than a test may take
                if estimator == Estimator::UNIFORM && albedo > 0.5 {
                    continue;
                }
                let film = render(&closed, 24, 1024, &with(estimator, None, roulette));
                assert_mean(&film, 1.0, 0.01, &format!("{albedo} {estimator:?} {roulette:?}"));
            }
        }
    }
}

/// N scatterings leave out what longer paths bring: Le (1 - rho^(N + 1)) / (1 - rho). Without roulette a cosine sample
/// has no variance at all.
#[test]
fn a_limit_of_bounces_loses_exactly_the_longer_paths() {
    let table = [
        (0.5f32, 0.5f32, [(1u32, 0.75f64), (4, 0.96875), (8, 0.998047), (16, 0.999992)]),
        (0.8, 0.2, [(1, 0.36), (4, 0.67232), (8, 0.865782), (16, 0.977482)]),
    ];
    for (albedo, emission, rows) in table {
        let closed = cube(albedo, emission, false, 0.0);
        for (scatterings, expected) in rows {
            let settings = with(Estimator::COSINE, Some(scatterings - 1), Roulette::OFF);
            let mean = render(&closed, 8, 4, &settings).mean()[0];
            assert!((mean - expected).abs() < 1e-5, "{albedo} {scatterings}: {mean} against {expected}");
        }
    }
}

#[test]
fn glass_in_a_furnace_is_invisible_and_so_is_index_one() {
    for ior in [1.5, 1.0, 0.8] {
        let ball = scene(&format!(
            r#"
[camera]
eye = [0, 0, 3]
target = [0, 0, 0]
fov_y = 45
[sky]
radiance = [1, 1, 1]
[material.glass]
dielectric = {{ ior = {ior} }}
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "glass"
"#
        ));
        let film = render(&ball, 32, 16, &with(Estimator::LIGHT, None, Roulette::OFF));
        for pixel in film.radiances() {
            assert!((pixel - scene::Vec3::ONE).abs().max_element() < 1e-5, "{ior}: {pixel}");
        }
    }
}

/// Lambert's polygon formula for a rectangle above a plane, looked up from far above through the light's dark back.
#[test]
fn rectangle_light_follows_lamberts_formula_for_every_estimator() {
    for (x, y, expected) in [(0.0, 0.0, 1.045356176), (1.0, 0.0, 0.7052169), (2.0, 1.0, 0.1654538478)] {
        let lit = scene(&format!(
            r#"
[camera]
eye = [{x}, {y}, 0.5]
target = [{x}, {y}, 0]
up = [0, 1, 0]
fov_y = 0.01
[material.floor]
diffuse = {{ albedo = [0.5, 0.5, 0.5] }}
[material.lamp]
emissive = {{ radiance = [10, 10, 10] }}
[[rectangle]]
corner = [-20, -20, 0]
edge_u = [40, 0, 0]
edge_v = [0, 40, 0]
material = "floor"
[[rectangle]]
corner = [-1, -0.5, 1.5]
edge_u = [0, 1, 0]
edge_v = [2, 0, 0]
material = "lamp"
"#
        ));
        for (estimator, spp) in [(Estimator::LIGHT, 256), (Estimator::COSINE, 2048), (Estimator::UNIFORM, 2048)] {
            let film = render(&lit, 32, spp, &with(estimator, Some(0), Roulette::OFF));
            assert_mean(&film, expected, 0.01, &format!("({x}, {y}) {estimator:?}"));
        }
    }
}

/// The same rectangle as a mesh of two triangles: the triangles' areas and choice are right.
#[test]
fn a_mesh_lamp_follows_lamberts_formula_too() {
    let lit = scene(
        r#"
[camera]
eye = [1, 0, 0.5]
target = [1, 0, 0]
up = [0, 1, 0]
fov_y = 0.01
[material.floor]
diffuse = { albedo = [0.5, 0.5, 0.5] }
[material.lamp]
emissive = { radiance = [10, 10, 10] }
[[rectangle]]
corner = [-20, -20, 0]
edge_u = [40, 0, 0]
edge_v = [0, 40, 0]
material = "floor"
[[mesh]]
positions = [[-1, -0.5, 1.5], [1, -0.5, 1.5], [1, 0.5, 1.5], [-1, 0.5, 1.5]]
triangles = [[0, 3, 2], [0, 2, 1]]
material = "lamp"
"#,
    );
    let film = render(&lit, 32, 256, &with(Estimator::LIGHT, Some(0), Roulette::OFF));
    assert_mean(&film, 0.7052169, 0.005, "mesh");
}

/// Inside a sphere that shines on both sides every point receives pi L, and a white one sends back L: here half of it,
/// beside a lamp that is much weaker and must not be forgotten.
#[test]
fn the_inside_of_a_shining_sphere_lights_and_weak_lamps_keep_their_share() {
    let inside = |weak: f32| {
        scene(&format!(
            r#"
[camera]
eye = [0, 0, 1]
target = [0, 0, 0]
up = [0, 1, 0]
fov_y = 0.01
[material.floor]
diffuse = {{ albedo = [0.5, 0.5, 0.5] }}
[material.dome]
emissive = {{ radiance = [1, 1, 1], two_sided = true }}
[material.weak]
emissive = {{ radiance = [{weak}, {weak}, {weak}] }}
[[sphere]]
center = [0, 0, 0]
radius = 1000
material = "dome"
[[sphere]]
center = [0, 0, 2]
radius = 0.01
material = "weak"
[[rectangle]]
corner = [-0.5, -0.5, 0]
edge_u = [1, 0, 0]
edge_v = [0, 1, 0]
material = "floor"
"#
        ))
    };
    // the small sphere adds rho Le (r / d)^2, and hides as much of the dome
    for weak in [0.0, 40_000.0] {
        let expected = 0.5 + 0.5 * (f64::from(weak) - 1.0) * (0.01f64 / 2.0).powi(2);
        let film = render(&inside(weak), 32, 1024, &with(Estimator::LIGHT, Some(0), Roulette::OFF));
        assert_mean(&film, expected, 0.005, &format!("weak {weak}"));
    }
}

/// A weak lamp under a sun whose power, over a wide scene, is a billion times its own.
#[test]
fn a_lamp_is_not_lost_beside_a_strong_sun() {
    let lit = scene(
        r#"
[camera]
eye = [0, 0, 1]
target = [0, 0, 0]
up = [0, 1, 0]
fov_y = 0.01
[sun]
towards = [0, 0, 1]
angular_radius = 0
irradiance = [3.1415927, 3.1415927, 3.1415927]
[material.floor]
diffuse = { albedo = [0.5, 0.5, 0.5] }
[material.lamp]
emissive = { radiance = [10000, 10000, 10000] }
[[rectangle]]
corner = [-20000, -20000, 0]
edge_u = [40000, 0, 0]
edge_v = [0, 40000, 0]
material = "floor"
[[sphere]]
center = [1, 0, 1]
radius = 0.01
material = "lamp"
"#,
    );
    // 1/2 of the sun, and rho Le (r / d)^2 cos beta at d^2 = 2, beta = 45 degrees
    let expected = 0.5 + 0.5 * 10_000.0 * 0.0001 / 2.0 * 0.5f64.sqrt();
    let film = render(&lit, 32, 512, &with(Estimator::LIGHT, Some(0), Roulette::OFF));
    assert_mean(&film, expected, 0.005, "lamp and sun");
}

/// The sun's irradiance does not depend on its radius, a white wall facing it has radiance 1, and a delta sun is found
/// by light sampling alone.
#[test]
fn a_wall_that_faces_the_sun_has_radiance_one_at_any_radius() {
    let wall = |radius: f32| {
        scene(&format!(
            r#"
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
fov_y = 10
[sun]
towards = [0, 0, 1]
angular_radius = {radius}
irradiance = [3.1415927, 3.1415927, 3.1415927]
[material.wall]
diffuse = {{ albedo = [1, 1, 1] }}
[[rectangle]]
corner = [-9, -9, 0]
edge_u = [18, 0, 0]
edge_v = [0, 18, 0]
material = "wall"
"#
        ))
    };
    for radius in [0.0, 0.1, 2.5, 30.0] {
        let film = render(&wall(radius), 16, 256, &with(Estimator::LIGHT, None, Roulette::THROUGHPUT));
        assert_mean(&film, 1.0, 0.001, &format!("radius {radius}"));
    }
    let film = render(&wall(30.0), 32, 512, &with(Estimator::COSINE, None, Roulette::THROUGHPUT));
    assert_mean(&film, 1.0, 0.005, "by chance");
    let blind = render(&wall(0.0), 8, 16, &with(Estimator::COSINE, None, Roulette::THROUGHPUT));
    assert_eq!(blind.mean(), [0.0; 3]);
}

/// rho Le (r / d)^2 cos beta, also 0.0001 above the lamp.
#[test]
fn sphere_light_follows_its_closed_form_even_almost_touching() {
    // the camera fits between floor and lamp
    for (radius, distance, eye, expected) in [(0.5, 2.0, -1.0, 0.5), (1.0, 1.0001, -0.00005, 7.99840024)] {
        let lit = scene(&format!(
            r#"
[camera]
eye = [0, 0, {eye}]
target = [0, 0, 0]
up = [0, 1, 0]
fov_y = 0.001
[material.floor]
diffuse = {{ albedo = [0.5, 0.5, 0.5] }}
[material.lamp]
emissive = {{ radiance = [16, 16, 16] }}
[[sphere]]
center = [0, 0, -{distance}]
radius = {radius}
material = "lamp"
[[rectangle]]
corner = [-20, -20, 0]
edge_u = [0, 40, 0]
edge_v = [40, 0, 0]
material = "floor"
"#
        ));
        let film = render(&lit, 16, 4096, &with(Estimator::LIGHT, Some(0), Roulette::OFF));
        assert_mean(&film, expected, 0.001, &format!("distance {distance}"));
    }
}
