//! Light that walks from its sources: photon mapping and light tracing against closed forms, and against paths from the
//! camera where there are none.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

mod lamps;
mod pictures;

use film::Film;
use pathtrace::{ConesAt, DirectLight, Integrator, Lanes, PathSettings, PhotonSettings, SamplerKind};
use pathtrace::{Estimator, Tracer};
use pictures::{
    assert_mean, everything, light_tracing, mean_and_error, mean_of_seeds, photon_maps, render, scene, traced,
};
use scene::{Scene, Vec3, builtin};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicU32, Ordering};

/// Means of 4 x 4 parts of a picture, with their standard errors from the spread of pictures of several seeds.
fn blocks(scene: &Scene, spp: u32, integrator: &Integrator) -> Vec<(f64, f64)> {
    const SIDE: u32 = 8;
    let tracer = Tracer::new(scene);
    let of_seed = |seed: u32| {
        let film = traced(&tracer, scene, 4 * SIDE, spp, &integrator.with_seed(seed)).0;
        let mean = |block: u32| {
            let (left, top) = (block % 4 * SIDE, block / 4 * SIDE);
            let pixels = (0..SIDE * SIDE).map(|i| film.at(left + i % SIDE, top + i / SIDE));
            pixels.map(|radiance| f64::from(radiance.element_sum())).sum::<f64>() / f64::from(3 * SIDE * SIDE)
        };
        (0..16).map(mean).collect::<Vec<f64>>()
    };
    let all: Vec<Vec<f64>> = (1..=8).map(of_seed).collect();
    let of_block = |block: usize| mean_and_error(&all.iter().map(|means| means[block]).collect::<Vec<_>>());
    (0..16).map(of_block).collect()
}

fn assert_alike(ours: &[(f64, f64)], theirs: &[(f64, f64)], (bias, power): (f64, f64), what: &str) {
    for (block, ((a, error), (b, other))) in ours.iter().zip(theirs).enumerate() {
        let error = error.hypot(*other);
        let most = 5.0 * error + bias * b;
        assert!(error <= power * b, "{what}, block {block}: a standard error of {error} proves nothing about {b}");
        assert!((a - b).abs() <= most, "{what}, block {block}: {a}, expected {b} +- {error}");
    }
}

/// The lamp itself and all that is lit: nothing there is specular, so that a pinhole can connect every path.
#[test]
fn both_find_in_a_cornell_box_what_paths_find() {
    let cornell = builtin::named("cornell").expect("a built-in scene");
    let paths = blocks(&cornell, 64, &PathSettings::default().into());
    assert_alike(&blocks(&cornell, 16, &light_tracing(1 << 13)), &paths, (0.0, 0.04), "light tracing");
    for photons in photon_maps(1 << 14, 10.0) {
        // a disc of 10 of the box's 555 that hangs over an edge
        assert_alike(&blocks(&cornell, 8, &photons), &paths, (0.04, 0.04), &format!("{photons:?}"));
    }
}

/// Mirrors, glass, rough metal, and lights of all kinds.
#[test]
fn photons_find_among_everything_what_paths_find() {
    let everything = everything();
    let paths = PathSettings { estimator: Estimator::MIS, ..PathSettings::default() };
    let paths = blocks(&everything, 1024, &paths.into());
    for photons in photon_maps(1 << 13, 0.03) {
        assert_alike(&blocks(&everything, 64, &photons), &paths, (0.05, 0.08), &format!("{photons:?}"));
    }
}

/// In the middle of a wall, farther from its edges than any photon that is gathered.
#[test]
fn closed_boxes_and_furnaces_are_one() {
    for name in ["hard/closed-box", "hard/white-furnace"] {
        let mut furnace = builtin::named(name).expect("a built-in scene");
        furnace.camera.target = Vec3::new(0.5, 0.5, 0.0);
        furnace.camera.fov_y = 20.0;
        for integrator in photon_maps(1 << 13, 0.1).into_iter().chain([light_tracing(1 << 13)]) {
            let what = format!("{name}, {integrator:?}");
            assert_mean(mean_of_seeds(&furnace, 8, 16, &integrator), 1.0, (0.0, 0.01), &what);
        }
    }
}

/// A white ball within a glass one under a white sky: refraction changes radiance and power by the square of the index,
/// and what comes back to the camera must know nothing of it.
#[test]
fn what_stands_in_glass_is_lit_as_much_as_what_stands_outside() {
    let snow_globe = scene(
        r#"
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
fov_y = 8
[sky]
radiance = [1, 1, 1]
[material.glass]
dielectric = { ior = 1.5 }
[material.white]
diffuse = { albedo = [1, 1, 1] }
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "glass"
[[sphere]]
center = [0, 0, 0]
radius = 0.5
material = "white"
"#,
    );
    for integrator in photon_maps(1 << 15, 0.03) {
        // a disc of radius .03 leaves a ball of .5 by a thousandth
        assert_mean(mean_of_seeds(&snow_globe, 8, 16, &integrator), 1.0, (0.004, 0.01), &format!("{integrator:?}"));
    }
}

/// A floor under a sun straight above, and something between; the camera looks at the floor below that from the side.
fn under_a_sun(what: &str, fov: f32) -> Scene {
    scene(&format!(
        r#"
[camera]
eye = [4, 2, 0]
target = [0, 0, 0]
fov_y = {fov:?}
[sun]
towards = [0, 1, 0]
angular_radius = 0
irradiance = [3.1415927, 3.1415927, 3.1415927]
[material.floor]
diffuse = {{ albedo = [0.5, 0.5, 0.5] }}
[material.glass]
dielectric = {{ ior = 1.4285715 }}
[material.mirror]
mirror = {{ reflectance = [0.8, 0.8, 0.8] }}
[[rectangle]]
corner = [-2, 0, -2]
edge_u = [0, 0, 4]
edge_v = [4, 0, 0]
material = "floor"
{what}
"#
    ))
}

/// The middle of the caustic of a glass ball, by paraxial optics: (1 - F0)^2 over the square of 1 - 2 (n - 1) D / n. What is
/// reflected twice within comes there too, (F0)^2 of it.
#[test]
fn the_middle_of_a_balls_caustic_under_a_point_sun_is_exact() {
    let ball = under_a_sun("[[sphere]]\ncenter = [0, 3.3, 0]\nradius = 1\nmaterial = 'glass'\n", 0.5);
    let (n, distance) = (1.0f64 / 0.7, 3.3);
    let reflected = ((n - 1.0) / (n + 1.0)).powi(2);
    let expected = 0.5 * (1.0 - reflected).powi(2) / (1.0 - 2.0 * (n - 1.0) * distance / n).powi(2);
    assert_mean(mean_of_seeds(&ball, 4, 64, &light_tracing(1 << 14)), expected, (0.004, 0.02), "light tracing");
    for integrator in photon_maps(1 << 14, 0.05) {
        assert_mean(mean_of_seeds(&ball, 4, 16, &integrator), expected, (0.01, 0.02), &format!("{integrator:?}"));
    }
}

/// What a ball of glass sends into its shadow, over a part of the floor within it: by connections, by light that walks there, and
/// from a sun with a disc by directions into the ball's cone and by chance too.
#[test]
fn a_caustic_has_the_same_power_by_every_way_to_find_it() {
    let mut ball = under_a_sun("[[sphere]]\ncenter = [0, 3.3, 0]\nradius = 1\nmaterial = 'glass'\n", 20.0);
    let connected = PathSettings { estimator: Estimator::MIS, cones: ConesAt::Nothing, ..PathSettings::default() };
    let cones = PathSettings { connections: false, cones: ConesAt::Everything, ..connected };
    let chance = PathSettings { estimator: Estimator::COSINE, ..cones };
    let [_, gathered] = photon_maps(1 << 13, 0.05);
    let walks = [("light tracing", light_tracing(1 << 13), 32), ("photons", gathered, 32)];
    let of_a_disc = [("cones", cones.into(), 1024), ("chance", chance.into(), 4096)];
    for (degrees, more) in [(0.0, &of_a_disc[..0]), (2.5, &of_a_disc)] {
        ball.sun.as_mut().expect("a sun").angular_radius = degrees;
        let (expected, error) = mean_of_seeds(&ball, 16, 256, &connected.into());
        for (way, integrator, spp) in walks.iter().chain(more) {
            let (found, own_error) = mean_of_seeds(&ball, 16, *spp, integrator);
            let what = format!("{degrees} degrees by {way}");
            println!("{what}: {found:.5} +- {own_error:.5}, by connections {expected:.5} +- {error:.5}");
            // a point sun is connected to without reflections within the ball, and a map is blurred at the picture's edge
            assert_mean((found, own_error.hypot(error)), expected, (0.005, 0.01), &what);
        }
    }
}

/// A slab sends on (1 - F0) / (1 + F0) of what falls on it, with all reflections within; as a box, and as a mesh.
#[test]
fn glass_boxes_and_meshes_send_on_what_slabs_do() {
    let plate = under_a_sun("[[box]]\ncorner = [-0.5, 0.8, -0.5]\nsize = [1, 0.4, 1]\nmaterial = 'glass'\n", 1.0);
    let mut mesh = plate.clone();
    let as_mesh = |shape: &scene::Shape| {
        let (positions, triangles) = shape.geometry.flat_triangles();
        let geometry = scene::Geometry::mesh(positions.into_owned(), triangles.into_owned());
        scene::Shape { geometry, ..shape.clone() }
    };
    mesh.shapes = plate.shapes.iter().map(as_mesh).collect();
    let n = 1.0f64 / 0.7;
    let reflected = ((n - 1.0) / (n + 1.0)).powi(2);
    let expected = 0.5 * (1.0 - reflected) / (1.0 + reflected);
    for plate in [plate, mesh] {
        for integrator in photon_maps(1 << 13, 0.1).into_iter().chain([light_tracing(1 << 14)]) {
            // what leaves the floor and comes back to it from the glass is a few thousandths of it
            assert_mean(mean_of_seeds(&plate, 4, 16, &integrator), expected, (0.012, 0.01), &format!("{integrator:?}"));
        }
    }
}

/// A mirror beside the sun sends a second one down.
#[test]
fn a_mirror_sends_light_on_to_a_floor() {
    let mut mirrored = under_a_sun(
        "[[rectangle]]\ncorner = [0.5, 0, -2]\nedge_u = [0, 0, 4]\nedge_v = [0, 4, 0]\nmaterial = 'mirror'\n",
        1.0,
    );
    mirrored.camera.eye = Vec3::new(-4.0, 2.0, 0.0);
    if let Some(sun) = &mut mirrored.sun {
        sun.towards = Vec3::new(-1.0, 1.0, 0.0).normalize();
    }
    let expected = 0.5 * 0.5f64.sqrt() * 1.8;
    for integrator in photon_maps(1 << 14, 0.1).into_iter().chain([light_tracing(1 << 14)]) {
        // what the floor sends to the mirror comes back to the floor nowhere: it goes up
        assert_mean(mean_of_seeds(&mirrored, 4, 16, &integrator), expected, (0.0, 0.03), &format!("{integrator:?}"));
    }
}

/// The disc of a constant kernel hangs over the edge of a floor: what is missing is what of its area has no floor.
#[test]
fn at_an_edge_as_much_is_missing_as_the_disc_hangs_over() {
    let mut floor = under_a_sun("", 0.1);
    floor.camera.target = Vec3::new(1.9, 0.0, 0.0);
    let [_, gathered] = photon_maps(1 << 15, 1.0);
    for radius in [0.15f64, 0.3, 0.6] {
        let Integrator::Photon(settings) = gathered else { panic!("photons") };
        let radius_of_first = PhotonSettings { radius: Some(radius as f32), alpha: 0.99, ..settings };
        let q = (0.1 / radius).min(1.0);
        let expected = 0.5 * (1.0 - (q.acos() - q * (1.0 - q * q).sqrt()) / PI);
        // the radius shrinks by a thousandth in four passes
        let found = mean_of_seeds(&floor, 4, 4, &radius_of_first.into());
        assert_mean(found, expected, (0.002, 0.02), &format!("radius {radius}"));
    }
}

#[test]
fn far_from_the_origin_photons_find_the_same() {
    let near = builtin::named("hard/closed-box").expect("a built-in scene");
    let text = include_str!("../../../../assets/scenes/hard/closed-box.toml");
    let moved = |text: &str| {
        text.replace("corner = [0, 0, 0]", "corner = [9000, 0, 0]")
            .replace("corner = [1, 0, 0]", "corner = [9001, 0, 0]")
            .replace("corner = [0, 1, 0]", "corner = [9000, 1, 0]")
            .replace("corner = [0, 0, 1]", "corner = [9000, 0, 1]")
            .replace("[0.5, 0.5, 0.9]", "[9000.5, 0.5, 0.9]")
            .replace("[0.5, 0.6, 0]", "[9000.5, 0.5, 0]")
    };
    let mut far = scene(&moved(text));
    assert!((far.camera.target.x - near.camera.target.x) == 9000.0);
    far.camera.fov_y = 20.0;
    for integrator in photon_maps(1 << 13, 0.1).into_iter().chain([light_tracing(1 << 13)]) {
        assert_mean(mean_of_seeds(&far, 8, 16, &integrator), 1.0, (0.0, 0.01), &format!("{integrator:?}"));
    }
}

#[test]
fn without_light_or_without_shapes_there_is_nothing_to_find() {
    let dark = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nfov_y = 40\n[material.grey]\ndiffuse = { albedo = [0.5, 0.5, 0.5] }\n";
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'grey'\n";
    let point = "[[point_light]]\nposition = [0, 3, 0]\nintensity = [1, 1, 1]\n";
    let sky = "[sky]\nradiance = [1, 1, 1]\n";
    let points = PhotonSettings { points: true, ..PhotonSettings::default() };
    for integrator in photon_maps(1 << 10, 0.1).into_iter().chain([light_tracing(1 << 10), points.into()]) {
        for nothing in [format!("{dark}{ball}"), format!("{dark}{point}"), dark.to_owned()] {
            assert_eq!(render(&scene(&nothing), 4, 2, integrator).mean(), [0.0; 3], "{nothing}");
        }
        let sees_sky = !matches!(integrator, Integrator::Photon(PhotonSettings { points: true, .. }));
        let empty = render(&scene(&format!("{dark}{sky}")), 4, 2, integrator).mean();
        assert_eq!(empty, [f64::from(u8::from(sees_sky)); 3], "a sky and nothing else");
    }
}

/// What mirrors and glass show is black to light tracing, however much light there is.
#[test]
fn light_tracing_sees_no_mirror() {
    let mut mirror = under_a_sun("", 1.0);
    for material in &mut mirror.materials {
        material.bsdf = scene::Bsdf::Mirror { reflectance: Vec3::ONE };
    }
    assert_eq!(render(&mirror, 4, 4, light_tracing(1 << 10)).mean(), [0.0; 3]);
}

fn each_kind() -> [Integrator; 4] {
    let settings = PhotonSettings { photons: 5000, ..PhotonSettings::default() };
    let points = PhotonSettings { points: true, ..settings };
    let independent = PhotonSettings { sampler: SamplerKind::Independent, direct: DirectLight::Photons, ..settings };
    [settings.into(), independent.into(), points.into(), light_tracing(5000)]
}

#[test]
fn pictures_depend_on_neither_lanes_nor_threads_nor_how_passes_are_split() {
    for scene in [everything(), builtin::named("cornell").expect("built in")] {
        for integrator in each_kind() {
            let tracer = Tracer::new(&scene).with_lanes(Lanes::best());
            let on = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                pool.install(|| traced(&tracer, &scene, 19, 3, &integrator))
            };
            let whole = on(1);
            assert!(whole == on(2) && whole == on(5), "{integrator:?}");
            for lanes in Lanes::available() {
                let other = traced(&Tracer::new(&scene).with_lanes(lanes), &scene, 19, 3, &integrator);
                assert!(whole == other, "{integrator:?}: {} differs", lanes.name());
            }
            let mut film = Film::new(19, 19);
            for samples in [1, 2] {
                tracer.render(&mut film, &scene.camera, &integrator, samples, &|| false);
            }
            assert!(film == whole.0, "{integrator:?} in two calls");
        }
    }
}

/// Wherever it is stopped, among photons or among pixels, and by whoever says so once and no more, pixels hold whole samples, and the
/// next call completes the same picture.
#[test]
fn a_stopped_picture_is_completed() {
    let scene = everything();
    let tracer = Tracer::new(&scene);
    for integrator in each_kind() {
        let whole = traced(&tracer, &scene, 19, 3, &integrator).0;
        for asked_often in [0, 5, 100, 1000, 2000, 4000] {
            for said_again in [true, false] {
                let (asked, mut film) = (AtomicU32::new(0), Film::new(19, 19));
                let stop = || {
                    let before = asked.fetch_add(1, Ordering::Relaxed);
                    if said_again { before >= asked_often } else { before == asked_often }
                };
                let stats = tracer.render(&mut film, &scene.camera, &integrator, 3, &stop);
                let taken: u64 = film.pixels().iter().map(|pixel| u64::from(pixel.samples)).sum();
                assert_eq!(taken, stats.samples, "{integrator:?}");
                let fewest = film.samples_per_pixel();
                tracer.render(&mut film, &scene.camera, &integrator, 3 - fewest, &|| false);
                assert!(film == whole, "{integrator:?} stopped after {asked_often}, {said_again}");
            }
        }
    }
}
