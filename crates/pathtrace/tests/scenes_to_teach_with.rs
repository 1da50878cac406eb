//! What the built-in scenes are there to show, in numbers.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use pathtrace::{Estimator, Integrator, LightPaths, PathSettings, PhotonSettings, Tracer};
use scene::{Scene, Vec3, builtin};

fn named(name: &str) -> Scene {
    builtin::named(name).expect("a built-in scene")
}

fn render(scene: &Scene, size: (u32, u32), spp: u32, integrator: impl Into<Integrator>) -> Film {
    let mut film = Film::new(size.0, size.1);
    Tracer::new(scene).render(&mut film, &scene.camera, &integrator.into(), spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    film
}

/// Each is noise in another corner of the picture, and none is wrong. Lamps as they are seen do not count: all show them alike. By chance the smallest lamp is met once in 30,000 directions from
/// the wall behind it, which this many paths do some hundred times; four standard errors of seeds that are fixed.
#[test]
fn by_chance_by_light_sampling_and_by_both_veachs_plates_have_the_same_light() {
    let (scene, paths) = (named("veach"), LightPaths::parse("from-0").expect("light paths"));
    let [both, light, chance] = [(Estimator::MIS, 2048, 1), (Estimator::LIGHT, 8192, 2), (Estimator::COSINE, 8192, 3)]
        .map(|(estimator, spp, seed)| {
            let settings = PathSettings { estimator, seed, paths, ..PathSettings::independent() };
            let film = render(&scene, (64, 36), spp, settings);
            (film.mean()[1], film.standard_error()[1])
        });
    for (name, one) in [("light", light), ("chance", chance)] {
        let error = one.1.hypot(both.1);
        assert!(error < 0.02 * both.0, "{name}: {error} of {} would tell nothing", both.0);
        assert!((one.0 - both.0).abs() < 4.0 * error, "{name}: {} is not {} +- {error}", one.0, both.0);
    }
}

/// The gap is seen between 34 and 46 hundredths of the picture's width.
#[test]
fn no_lamp_shines_through_the_door_that_stands_ajar_and_all_else_is_lit_by_way_of_it() {
    let (scene, size) = (named("door-ajar"), (100, 56));
    let light = |class: &str| {
        let paths = LightPaths::parse(class).expect("light paths");
        render(&scene, size, 64, PathSettings { paths, estimator: Estimator::MIS, ..PathSettings::default() })
    };
    let (direct, indirect) = (light("direct"), light("indirect"));
    let sum = |film: &Film, seen: bool| -> f32 {
        let pixels = (0..size.0 * size.1).map(|i| (i % size.0, i / size.0));
        pixels.filter(|(x, _)| (34..46).contains(x) == seen).map(|(x, y)| film.at(x, y).element_sum()).sum()
    };
    assert_eq!(sum(&direct, false), 0.0, "a lamp is seen from the room");
    assert!(sum(&direct, true) > 100.0, "nothing is lit behind the gap");
    let mean = sum(&indirect, false) / (3 * size.0 * size.1) as f32;
    assert!(mean > 0.03, "the room is dark: {mean}");
}

/// A hollow cylinder's mirror gathers parallel light, to first order, half a radius before the wall: the nephroid's cusp. The sun's
/// disc, the metal's roughness and the photons' discs blur it by about a tenth.
#[test]
fn the_ring_gathers_the_sun_at_the_nephroids_cusp() {
    const SIDE: u32 = 50;
    let mut scene = named("caustic");
    let towards = scene.sun.expect("a sun").towards;
    let cusp = -0.5 * Vec3::new(towards.x, 0.0, towards.z).normalize();
    // from above, so that the picture is what lies in the ring
    (scene.camera.eye, scene.camera.target, scene.camera.up) = (Vec3::new(0.0, 8.0, 0.0), Vec3::ZERO, Vec3::NEG_Z);
    scene.camera.fov_y = 2.0 * (1.0f32 / 8.0).atan().to_degrees();
    let photons = PhotonSettings { radius: Some(0.05), ..PhotonSettings::default() };
    let film = render(&scene, (SIDE, SIDE), 16, photons);
    let on_the_table = |i: u32| {
        let across = |pixel: u32| 2.0 * (pixel as f32 + 0.5) / SIDE as f32 - 1.0;
        Vec3::new(across(i % SIDE), 0.0, across(i / SIDE))
    };
    let inside = (0..SIDE * SIDE).filter(|i| on_the_table(*i).length() < 0.9);
    let brightness = |i: u32| film.at(i % SIDE, i / SIDE).element_sum();
    let brightest = inside.max_by(|a, b| brightness(*a).total_cmp(&brightness(*b))).expect("pixels");
    let off = on_the_table(brightest).distance(cusp);
    assert!(off < 0.1, "the brightest place is {}, the cusp {cusp}", on_the_table(brightest));
}
