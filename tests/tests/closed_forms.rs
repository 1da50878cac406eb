//! Lights of a scene together, whose radiance is known in closed form, and what the settings do to rays. The hard cases
//! of one light each are in the crate `check`.

use film::Film;
use pathtrace::{Estimator, GlassShadows, PathSettings, Roulette, SamplerKind, Tracer, WhittedSettings};
use scene::Scene;
use std::path::Path;

fn scene(text: &str) -> Scene {
    scene::parse(text, "test", Path::new("test.toml")).expect("a scene")
}

fn render(scene: &Scene, size: u32, spp: u32, settings: &PathSettings) -> Film {
    let mut film = Film::new(size, size);
    Tracer::new(scene).render(&mut film, &scene.camera, &(*settings).into(), spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    film
}

fn with(estimator: Estimator, bounces: Option<u32>, roulette: Roulette) -> PathSettings {
    PathSettings { estimator, bounces, roulette, seed: 3, ..PathSettings::independent() }
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

/// Inside a sphere that shines on both sides every point receives pi L, and a white one sends back L: here half of it,
/// beside an area light that is much weaker and must not be forgotten.
#[test]
fn the_inside_of_a_shining_sphere_lights_and_weak_area_lights_keep_their_share() {
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

/// A weak area light under a sun whose power, over a wide scene, is a billion times its own.
#[test]
fn an_area_light_is_not_lost_beside_a_strong_sun() {
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
    for radius in [2.5, 30.0] {
        for estimator in [Estimator::MIS, Estimator::UNIFORM_MIS] {
            let film = render(&wall(radius), 32, 256, &with(estimator, None, Roulette::THROUGHPUT));
            assert_mean(&film, 1.0, 0.005, &format!("{estimator:?}, radius {radius}"));
        }
    }
    let film = render(&wall(30.0), 32, 512, &with(Estimator::COSINE, None, Roulette::THROUGHPUT));
    assert_mean(&film, 1.0, 0.005, "by chance");
    let blind = render(&wall(0.0), 8, 16, &with(Estimator::COSINE, None, Roulette::THROUGHPUT));
    assert_eq!(blind.mean(), [0.0; 3]);
}

/// Where all surfaces are diffuse, Whitted's picture without ambient light is the truth's direct light; glass in the
/// way of an area light throws the shadow that was asked for.
#[test]
fn whitted_without_ambient_light_is_direct_light() {
    let scene = scene::builtin::named("cornell").expect("built in");
    let tracer = Tracer::new(&scene);
    let mut whitted = Film::new(48, 48);
    let settings = WhittedSettings { ambient: Some(0.0), shadow_rays: 4, ..WhittedSettings::default() };
    tracer.render(&mut whitted, &scene.camera, &settings.into(), 64, &|| false);
    let direct = render(&scene, 48, 256, &with(Estimator::MIS, Some(0), Roulette::OFF));
    for c in 0..3 {
        let error = whitted.standard_error()[c].hypot(direct.standard_error()[c]);
        let off = (whitted.mean()[c] - direct.mean()[c]).abs();
        assert!(off <= 4.0 * error && error < 0.02 * direct.mean()[c], "channel {c}: off by {off}, error {error}");
    }
}

#[test]
fn glass_throws_the_shadow_that_was_asked_for() {
    let lit = |ball: &str| {
        scene(&format!(
            r#"
[camera]
eye = [0, 0, 0.5]
target = [0, 0, 0]
up = [0, 1, 0]
fov_y = 0.01
[[point_light]]
position = [0, 0, 4]
intensity = [16, 16, 16]
[material.floor]
diffuse = {{ albedo = [0.5, 0.5, 0.5] }}
[material.glass]
dielectric = {{ ior = 1.5 }}
[[rectangle]]
corner = [-1, -1, 0]
edge_u = [2, 0, 0]
edge_v = [0, 2, 0]
material = "floor"
{ball}"#
        ))
    };
    let glass = "[[sphere]]\ncenter = [0, 0, 2]\nradius = 1\nmaterial = \"glass\"\n";
    let seen = |scene: &Scene, glass_shadows| {
        let mut film = Film::new(2, 2);
        let settings = WhittedSettings { glass_shadows, ambient: Some(0.0), ..WhittedSettings::default() };
        Tracer::new(scene).render(&mut film, &scene.camera, &settings.into(), 1, &|| false);
        film.mean()[0]
    };
    let direct = 0.5 / std::f64::consts::PI;
    assert!((seen(&lit(""), GlassShadows::Opaque) - direct).abs() < 1e-6);
    assert_eq!(seen(&lit(glass), GlassShadows::Opaque), 0.0);
    assert!((seen(&lit(glass), GlassShadows::Clear) - direct).abs() < 1e-6);
}

/// "#rays = N ^ #bounces, explode!": by chance in a closed room each sample traces 1 + N + N^2 + ... rays.
#[test]
fn branches_multiply_the_rays_and_change_no_mean() {
    let scene = scene::builtin::named("cornell").expect("built in");
    let [eye, target] = [100.0, 555.0].map(|z| scene::Vec3::new(278.0, 278.0, z));
    let room = scene::Camera { eye, target, ..scene.camera };
    let tracer = Tracer::new(&scene);
    for (branches, rays) in [(1u32, 4.0), (2, 15.0), (4, 85.0)] {
        let estimator = Estimator::COSINE;
        let settings = PathSettings { branches, ..with(estimator, Some(2), Roulette::OFF) };
        let mut film = Film::new(16, 16);
        let stats = tracer.render(&mut film, &room, &settings.into(), 16, &|| false);
        // some paths leave through the open side or end at the black area light: all but a few of the rays are there
        let per_sample = stats.rays as f64 / stats.samples as f64;
        assert!(per_sample <= rays && per_sample > 0.6 * rays, "{branches}: {per_sample} of {rays}");
    }
    let mean = |settings: &PathSettings, spp| {
        let film = render(&scene, 32, spp, settings);
        (film.mean()[0], film.standard_error()[0])
    };
    let settings = with(Estimator::MIS, Some(2), Roulette::OFF);
    let (one, error) = mean(&settings, 512);
    for sampler in SamplerKind::ALL {
        let (four, of_four) = mean(&PathSettings { branches: 4, sampler, ..settings }, 64);
        assert!((one - four).abs() <= 4.0 * error.hypot(of_four), "{sampler:?}: {one} {four} +- {error}");
    }
}

/// A caustic's rare bright paths make the standard error unreliable, and the film says so.
#[test]
fn a_film_knows_when_its_standard_error_means_little() {
    let film = |name: &str| {
        let scene = scene::builtin::named(name).expect("built in");
        render(&scene, 64, 16, &PathSettings::independent())
    };
    let (calm, caustic) = (film("cornell"), film("whitted"));
    assert!(calm.standard_error_is_reliable(), "{}", calm.tail_weight());
    assert!(!caustic.standard_error_is_reliable(), "{}", caustic.tail_weight());
}

/// A point of an area light's own wall is neither in front of it nor behind it: rounding must not decide what it sees.
#[test]
fn a_scattering_shell_that_shines_inwards_has_radiance_one() {
    for (center, radius) in [([0.3, 0.7, -0.2], 3.0), ([0.0, 0.0, 0.0], 1.0), ([10.0, 5.0, 7.0], 20.0)] {
        let [x, y, z]: [f64; 3] = center;
        let shell = scene(&format!(
            r#"
[camera]
eye = [{x}, {y}, {z}]
target = [{}, {y}, {z}]
fov_y = 60
[material.shell]
diffuse = {{ albedo = [0.5, 0.5, 0.5] }}
emissive = {{ radiance = [0.5, 0.5, 0.5], two_sided = true }}
[[sphere]]
center = [{x}, {y}, {z}]
radius = {radius}
material = "shell"
"#,
            x + 0.5 * radius
        ));
        for estimator in Estimator::EVERY {
            let film = render(&shell, 16, 512, &with(estimator, None, Roulette::THROUGHPUT));
            assert_mean(&film, 1.0, 0.003, &format!("{} in a shell of radius {radius}", estimator.name()));
        }
        let mut film = Film::new(16, 16);
        let settings =
            WhittedSettings { ambient: Some(0.0), sampler: SamplerKind::Independent, ..WhittedSettings::default() };
        Tracer::new(&shell).render(&mut film, &shell.camera, &settings.into(), 256, &|| false);
        assert_mean(&film, 0.75, 0.003, &format!("whitted in a shell of radius {radius}"));
    }
}

/// Roulette by throughput looks at what all branches of a path carry together: else it would undo the branching. And a
/// probability of survival that no 24 bits can say is not rounded in favour of the survivors.
#[test]
fn roulette_leaves_branches_alone_and_rare_survivors_unbiased() {
    let cornell = scene::builtin::named("cornell").expect("built in");
    let rays = |branches, roulette| {
        let settings = PathSettings { branches, ..with(Estimator::LIGHT, Some(2), roulette) };
        let stats =
            Tracer::new(&cornell).render(&mut Film::new(32, 32), &cornell.camera, &settings.into(), 4, &|| false);
        stats.rays as f64 / stats.samples as f64
    };
    assert!(rays(4, Roulette::THROUGHPUT) > 0.4 * rays(4, Roulette::OFF));
    let dark = scene(
        r#"
[camera]
eye = [0, 0, 3]
target = [0, 0, 0]
fov_y = 20
[sky]
radiance = [1, 1, 1]
[material.soot]
diffuse = { albedo = [0.0005, 0.0005, 0.0005] }
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "soot"
"#,
    );
    for (branches, spp) in [(1, 65_536), (1024, 64)] {
        let settings = PathSettings { branches, ..with(Estimator::COSINE, Some(0), Roulette::THROUGHPUT) };
        assert_mean(&render(&dark, 8, spp, &settings), 0.0005, 0.05, &format!("{branches} branches"));
    }
}

/// A mirror leaves a path no choice, and what it shows may be as bright as it is dark: no sample is given up there. Where
/// mirrors face each other paths still end.
#[test]
fn roulette_spares_what_mirrors_show() {
    let lamp = scene(
        r#"
[camera]
eye = [0, 0.1, 3]
target = [0, 0, 0]
fov_y = 1
[material.dark]
mirror = { reflectance = [1e-6, 1e-6, 1e-6] }
[material.lamp]
emissive = { radiance = [1e6, 1e6, 1e6] }
[[rectangle]]
corner = [-1, -1, 0]
edge_u = [2, 0, 0]
edge_v = [0, 2, 0]
material = "dark"
[[rectangle]]
corner = [-5, -5, 6]
edge_u = [0, 10, 0]
edge_v = [10, 0, 0]
material = "lamp"
"#,
    );
    for estimator in Estimator::ALL {
        let film = render(&lamp, 8, 4, &with(estimator, None, Roulette::THROUGHPUT));
        let off = film.pixels().iter().map(|pixel| (pixel.mean()[0] - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{}: {off}", estimator.name());
    }
    let hall = scene::builtin::named("hard/mirror-box").expect("built in");
    let mut film = Film::new(8, 8);
    let settings = with(Estimator::COSINE, None, Roulette::THROUGHPUT);
    let stats = Tracer::new(&hall).render(&mut film, &hall.camera, &settings.into(), 16, &|| false);
    assert!(stats.rays < 80 * stats.samples, "{stats:?}");
}

/// Directions and lines of sight are vectors of any length but 0, however small: down to where squares underflow.
#[test]
fn tiny_directions_are_directions() {
    let render_with = |sun: &str, eye: &str, target: &str| {
        let scene = scene(&format!(
            "[camera]\neye = {eye}\ntarget = {target}\nfov_y = 40\n[sun]\ntowards = {sun}\nangular_radius = 1\n\
             irradiance = [3, 3, 3]\n[material.grey]\ndiffuse = {{ albedo = [0.5, 0.5, 0.5] }}\n\
             [[sphere]]\ncenter = [0, 0, -4]\nradius = 1\nmaterial = \"grey\"\n"
        ));
        render(&scene, 8, 4, &with(Estimator::LIGHT, Some(0), Roulette::OFF)).mean()
    };
    let plain = render_with("[0.5, 1, 0.25]", "[0, 0, 0]", "[0, 0, -1]");
    assert!(plain[0] > 0.01);
    for (sun, target) in [("[5e-23, 1e-22, 2.5e-23]", "[0, 0, -1e-23]"), ("[5e11, 1e12, 2.5e11]", "[0, 0, -1e-40]")] {
        let tiny = render_with(sun, "[0, 0, 0]", target);
        assert!(tiny.iter().zip(plain).all(|(a, b)| (a - b).abs() < 1e-6 * b), "{sun}: {tiny:?}, not {plain:?}");
    }
}
