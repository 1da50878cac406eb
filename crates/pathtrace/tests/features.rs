//! Albedo, normal and depth of what pixels show, against what the scenes say.

#![expect(clippy::expect_used, reason = "a test stops at the first thing that is not as it must be")]

use film::{Features, Vec3};
use pathtrace::{FeatureFilm, FeaturePass, Lanes, SamplerKind, Tracer};
use scene::{Scene, builtin};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

/// A mirror before the camera, and a wall behind it, which is all that the mirror shows.
const MIRROR_AND_WALL: &str = "
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
fov_y = 1

[sky]
radiance = [0.25, 0.5, 7]

[material.mirror]
mirror = { reflectance = [0.5, 0.5, 1] }

[material.wall]
diffuse = { albedo = [0.2, 0.4, 0.6] }

[[rectangle]]
corner = [-1, -1, 0]
edge_u = [2, 0, 0]
edge_v = [0, 2, 0]
material = \"mirror\"

[[rectangle]]
corner = [-5, -5, 10]
edge_u = [10, 0, 0]
edge_v = [0, 10, 0]
material = \"wall\"
";

fn parse(text: &str) -> Scene {
    scene::parse(text, "test", Path::new("test.toml")).expect("a scene")
}

fn traced(scene: &Scene, size: (u32, u32), samples: u32, lanes: Lanes) -> Features {
    let pass = FeaturePass::new(&scene.camera, size, samples, (SamplerKind::Sobol, 1));
    Tracer::new(scene).with_lanes(lanes).features(&pass, &|| false).expect("nobody stops it")
}

fn features(scene: &Scene, samples: u32) -> Features {
    traced(scene, (5, 3), samples, Lanes::best())
}

#[test]
fn a_mirror_shows_the_surface_behind_the_camera_in_its_own_tint() {
    let seen = features(&parse(MIRROR_AND_WALL), 4);
    for (albedo, normal) in seen.albedo.iter().zip(&*seen.normal) {
        assert!(albedo.abs_diff_eq(Vec3::new(0.1, 0.2, 0.6), 1e-6), "{albedo}");
        // of the wall, on the side that the mirror sees
        assert!(normal.abs_diff_eq(Vec3::NEG_Z, 1e-6), "{normal}");
    }
    // to the mirror: half a degree away at most, which adds less than a ten thousandth
    assert!(seen.depth.iter().all(|depth| (5.0..5.001).contains(depth)), "{:?}", seen.depth);
}

#[test]
fn where_nothing_is_met_the_sky_is_shown_as_far_as_a_surface_could_be() {
    let without_shapes = MIRROR_AND_WALL.replace("corner = [-1, -1, 0]", "corner = [-1, -1, 20]");
    let seen = features(&parse(&without_shapes), 2);
    assert!(seen.albedo.iter().all(|albedo| albedo.abs_diff_eq(Vec3::new(0.25, 0.5, 1.0), 1e-6)), "{:?}", seen.albedo);
    assert!(seen.normal.iter().all(|normal| *normal == Vec3::ZERO));
    assert!(seen.depth.iter().all(|depth| *depth == f32::INFINITY));
}

/// A faint light on a mirror comes on top of what the mirror shows: .5 + .5 x (.5 + .5 x ...) = 1.
#[test]
fn mirrors_that_shine_and_never_end_come_to_one() {
    let seen = features(&builtin::named("hard/mirror-box").expect("a built-in scene"), 2);
    assert!(seen.albedo.iter().all(|albedo| albedo.abs_diff_eq(Vec3::ONE, 1e-5)), "{:?}", seen.albedo);
}

#[test]
fn what_pixels_show_depends_neither_on_lanes_nor_on_threads() {
    let scene = builtin::named("whitted").expect("a built-in scene");
    // no multiple of any number of lanes
    let size = (67, 37);
    let expected = traced(&scene, size, 3, Lanes::best());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    for lanes in Lanes::available() {
        assert!(pool.install(|| traced(&scene, size, 3, lanes)) == expected, "{}", lanes.name());
    }
    assert!(expected.albedo.iter().all(|albedo| albedo.min_element() >= 0.0 && albedo.max_element() <= 1.0));
    assert!(expected.normal.iter().all(|normal| normal.length() < 1.0 + 1e-5));
}

#[test]
fn what_is_stopped_has_no_features() {
    let scene = parse(MIRROR_AND_WALL);
    let pass = FeaturePass::new(&scene.camera, (5, 3), 1, (SamplerKind::Sobol, 1));
    assert_eq!(Tracer::new(&scene).features(&pass, &|| true), None);
}

/// A pass that is stopped leaves pixels without samples, and the next one brings them.
#[test]
fn samples_that_come_in_passes_are_those_of_one_pass() {
    let scene = builtin::named("whitted").expect("a built-in scene");
    let (tracer, size) = (Tracer::new(&scene), (67, 37));
    let mut film = FeatureFilm::new(size);
    let mut add = |samples, stop: &(dyn Fn() -> bool + Sync)| {
        let pass = FeaturePass::new(&scene.camera, size, samples, (SamplerKind::Sobol, 1));
        let stats = tracer.add_features(&mut film, &pass, &stop);
        (stats.samples, film.samples_per_pixel(), film.features())
    };
    let pixels = 67 * 37;
    assert_eq!(add(1, &|| true), (0, 0, None));
    assert!(matches!(add(1, &|| false), (taken, 1, Some(_)) if taken == pixels));
    let asked = AtomicU32::new(0);
    let (taken, least, _) = add(3, &|| asked.fetch_add(1, Ordering::Relaxed) > 0);
    assert!(least == 1 && 0 < taken && taken < 2 * pixels, "{taken} of {pixels}, and {least}");
    let (rest, least, features) = add(3, &|| false);
    assert_eq!((taken + rest, least), (2 * pixels, 3));
    assert!(features == Some(traced(&scene, size, 3, Lanes::best())));
}
