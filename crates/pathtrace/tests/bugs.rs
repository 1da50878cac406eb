//! Bugs on purpose: each does what its closed form says, or what its row says where there is none; without one the plain
//! walk is the path tracer; both machines have the same bugs.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{
    Bug, Bugs, ConesAt, Directions, Estimator, Integrator, LightPaths, PathSettings, Roulette, SamplerKind, Tracer,
};
use scene::{Scene, Vec3, builtin};
use std::f64::consts::PI;
use std::path::Path;

const EVERYTHING: &str = include_str!("../../../tests/tests/scenes/everything-more.toml");
const METALS: &str = include_str!("../../../tests/tests/scenes/metals.toml");

/// The middle of a matt ball, albedo 1/2, under a sky of 1: nothing but the sky shines on it.
const BALL: &str = "
camera = { eye = [0, 0, 5], target = [0, 0, 0], fov_y = 2 }
sky.radiance = [1, 1, 1]
material.matt.diffuse.albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, 0, 0]
radius = 1
material = 'matt'
";

/// A floor, seen where a small lamp shines straight down on it from a height of 3.
const LAMP: &str = "
camera = { eye = [4, 2, 0], target = [0, 0, 0], fov_y = 0.5 }
material.matt.diffuse.albedo = [0.5, 0.5, 0.5]
material.lamp.emissive.radiance = [10, 10, 10]
[[rectangle]]
corner = [-5, 0, -5]
edge_u = [0, 0, 10]
edge_v = [10, 0, 0]
material = 'matt'
[[rectangle]]
corner = [-0.05, 3, -0.05]
edge_u = [0.1, 0, 0]
edge_v = [0, 0, 0.1]
material = 'lamp'
";

/// The same floor seen on its back, and lit there by the sun.
const BACK: &str = "
camera = { eye = [4, 2, 0], target = [0, 0, 0], fov_y = 0.5 }
sun = { towards = [0, 1, 0], angular_radius = 0, irradiance = [1, 1, 1] }
material.matt.diffuse.albedo = [0.5, 0.5, 0.5]
[[rectangle]]
corner = [-5, 0, -5]
edge_u = [10, 0, 0]
edge_v = [0, 0, 10]
material = 'matt'
";

/// In a box without a hole, smaller than the step by which rays leave its walls.
const TIGHT: &str = "
camera = { eye = [0.004, 0.004, 0.004], target = [0.004, 0.004, 0], fov_y = 20 }
sky.radiance = [1, 1, 1]
material.matt.diffuse.albedo = [0.5, 0.5, 0.5]
[[box]]
corner = [0, 0, 0]
size = [0.008, 0.008, 0.008]
material = 'matt'
";

fn parsed(text: &str) -> Scene {
    scene::parse(text, "a scene", Path::new("scene.toml")).expect("a scene")
}

fn cornell() -> Scene {
    builtin::named("cornell").expect("built in")
}

fn only(bug: Bug) -> Bugs {
    Bugs::NONE.with(bug)
}

fn film(scene: &Scene, settings: PathSettings, size: [u32; 2], spp: u32) -> Film {
    let mut film = Film::new(size[0], size[1]);
    Tracer::new(scene).render(&mut film, &scene.camera, &settings.into(), spp, &|| false);
    assert_eq!(film.nonfinite, 0, "{}", settings.bugs);
    film
}

/// Whether a picture has this mean, as far as its noise says.
fn is_expected(scene: &str, settings: PathSettings, expected: f64) {
    let film = film(&parsed(scene), settings, [16, 16], 1024);
    let (mean, error) = (film.mean()[1], film.standard_error()[1]);
    let told = format!("{} by {}: {mean} +- {error}, not {expected}", settings.bugs, settings.estimator.name());
    assert!(error < 0.01 * mean, "{told}: too noisy");
    assert!((mean - expected).abs() < 4.0 * error + 2e-5, "{told}");
    println!("{told}");
}

#[test]
fn under_a_sky_of_one_brightness_each_bug_is_off_by_its_closed_form() {
    const ALBEDO: f64 = 0.5;
    let with =
        |bug, estimator, roulette| PathSettings { estimator, roulette, bugs: only(bug), ..PathSettings::independent() };
    for (bug, estimator, factor) in [
        (Bug::NoCosine, Estimator::UNIFORM, 2.0),
        (Bug::NoPdf, Estimator::COSINE, 2.0 / (3.0 * PI)),
        (Bug::NoPdf, Estimator::UNIFORM, 1.0 / (2.0 * PI)),
        (Bug::WrongPdf, Estimator::COSINE, 4.0 / 3.0),
        (Bug::WrongPdf, Estimator::UNIFORM, 1.0),
    ] {
        is_expected(BALL, with(bug, estimator, Roulette::OFF), ALBEDO * factor);
    }
    is_expected(BALL, with(Bug::Encoded, Estimator::COSINE, Roulette::OFF), ALBEDO.sqrt());
    is_expected(BALL, with(Bug::RouletteLost, Estimator::COSINE, Roulette::constant(0.6)), ALBEDO * 0.6);
}

/// Light of the first bounce that was sampled, with a bug over that without, in the whole picture.
fn direct_light(scene: &Scene, bug: Bug, spp: u32) -> f64 {
    let paths = LightPaths::parse("bounce-0").expect("a part of the light");
    let truth = PathSettings { paths, roulette: Roulette::OFF, ..PathSettings::independent() };
    let mean = |bugs| film(scene, PathSettings { bugs, ..truth }, [32, 32], spp).mean()[1];
    mean(only(bug)) / mean(Bugs::NONE)
}

#[test]
fn direct_light_is_too_bright_by_what_closed_forms_say() {
    for (scene, bug, factor, within, spp) in [
        (cornell(), Bug::WidthTwice, 130.0 / 105.0, 1e-4, 256),
        (cornell(), Bug::NoInversePi, PI, 1e-4, 256),
        // a path in a hundred meets the lamp: 40,000 of these
        (cornell(), Bug::EmissionTwice, 2.0, 0.03, 4096),
        (cornell(), Bug::ThickLamp, 0.5, 0.02, 256),
        (parsed(LAMP), Bug::AreaMeasure, 9.0, 0.05, 256),
    ] {
        let measured = direct_light(&scene, bug, spp);
        println!("{}: {measured}, expected {factor}", bug.name());
        assert!((measured - factor).abs() < within, "{}: {measured}, not {factor}", bug.name());
    }
}

#[test]
fn a_wall_seen_from_behind_is_lit_from_there_and_a_tight_box_leaks() {
    let mean = |scene: &str, bugs| {
        film(&parsed(scene), PathSettings { bugs, ..PathSettings::default() }, [8, 8], 16).mean()[1]
    };
    let lit = [Bugs::NONE, only(Bug::BackFace)].map(|bugs| mean(BACK, bugs));
    assert!((lit[0] - 0.5 / PI).abs() < 1e-4 && lit[1] == 0.0, "{lit:?}");
    let leaked = [Bugs::NONE, only(Bug::Epsilon)].map(|bugs| mean(TIGHT, bugs));
    assert!(leaked[0] == 0.0 && leaked[1] > 0.1, "{leaked:?}");
}

#[test]
fn no_sample_is_brighter_than_white_where_they_are_cut_off() {
    let film = film(&cornell(), PathSettings { bugs: only(Bug::Clamped), ..PathSettings::default() }, [32, 32], 8);
    let brightest = film.pixels().iter().map(|pixel| pixel.largest).fold(0.0, f32::max);
    assert_eq!(brightest, 1.0);
}

#[test]
fn a_seed_that_holds_the_time_has_the_noise_of_fewer_samples_about_the_right_mean() {
    let scene = cornell();
    let of = |bugs, seed| {
        film(&scene, PathSettings { bugs, seed, bounces: Some(1), ..PathSettings::independent() }, [24, 24], 64)
    };
    let noise = |bugs| {
        let [a, b] = [1, 2].map(|seed| of(bugs, seed));
        // of the middle pixel: at the lamp's edge the place in the pixel counts more than light
        let mut apart: Vec<f32> = a.radiances().zip(b.radiances()).map(|(a, b)| (a - b).length_squared()).collect();
        apart.sort_by(f32::total_cmp);
        apart[apart.len() / 2]
    };
    let ratio = noise(only(Bug::FloatSeed)) / noise(Bugs::NONE);
    assert!(ratio > 10.0, "{ratio}");
    let means = [only(Bug::FloatSeed), Bugs::NONE].map(|bugs| of(bugs, 3).mean()[1]);
    assert!((means[0] / means[1] - 1.0).abs() < 0.1, "{means:?}");
}

/// Pixels farther apart than a thousandth, as a share of all.
fn apart(a: &Film, b: &Film) -> f64 {
    let far = |(a, b): (Vec3, Vec3)| (a - b).abs().max_element() > 1e-3 * b.max_element().max(1.0);
    a.radiances().zip(b.radiances()).filter(|pair| far(*pair)).count() as f64 / a.pixels().len() as f64
}

#[test]
fn without_a_bug_that_acts_the_plain_walk_is_the_path_tracer() {
    for scene in [cornell(), parsed(METALS), parsed(EVERYTHING)] {
        for estimator in Estimator::EVERY.into_iter().filter(|e| e.directions != Directions::Guided) {
            let truth = PathSettings {
                estimator,
                bounces: Some(4),
                roulette: Roulette::OFF,
                connections: false,
                cones: ConesAt::Nothing,
                split_glass: false,
                ..PathSettings::default()
            };
            // roulette that is off has no 1/p to forget
            let walk = PathSettings { bugs: only(Bug::RouletteLost), ..truth };
            let [truth, walk] = [truth, walk].map(|settings| film(&scene, settings, [48, 36], 4));
            let share = apart(&walk, &truth);
            assert!(share < 0.01, "{} by {}: {share}", scene.name, estimator.name());
        }
    }
}

/// One sample a pixel, so that nothing hides in a mean.
#[test]
fn both_machines_have_the_same_bugs() {
    let one = |bug: Bug| (cornell(), PathSettings { bugs: only(bug), ..PathSettings::default() });
    let everything = |bug: Bug| (parsed(EVERYTHING), PathSettings { bugs: only(bug), ..PathSettings::default() });
    let mut subjects: Vec<_> = Bug::ALL.into_iter().map(one).collect();
    subjects.extend([Bug::BackFace, Bug::Epsilon, Bug::WrongPdf].map(everything));
    let mis = PathSettings { estimator: Estimator::MIS, bugs: only(Bug::NoCosine), ..PathSettings::default() };
    subjects.push((parsed(EVERYTHING), mis));
    for gpu in Gpu::each().expect("devices") {
        for (scene, settings) in &subjects {
            let settings = PathSettings { sampler: SamplerKind::Independent, ..*settings };
            let integrator: Integrator = settings.into();
            let here = film(scene, settings, [64, 48], 1);
            let mut there = Film::new(64, 48);
            let mut tracer = GpuTracer::new(&gpu, scene).expect("a tracer");
            tracer.render(&mut there, &scene.camera, &integrator, 1, &|| false).expect("a picture");
            assert_eq!(there.nonfinite, 0, "{}", settings.bugs);
            let share = apart(&there, &here);
            println!("{} in {}: {share}", settings.bugs, scene.name);
            assert!(share < 0.02, "{} in {}: {share} apart, {}", settings.bugs, scene.name, gpu.describe());
        }
    }
}

#[test]
fn a_hidden_bug_is_the_one_that_its_number_names_on_both_machines() {
    let scene = cornell();
    let hiding = PathSettings { find_bug: 7, bounces: Some(1), ..PathSettings::default() };
    let bug = hiding.hidden_bug(Bugs::suited_to(&scene)).expect("a bug");
    let told = PathSettings { find_bug: 0, bugs: only(bug), ..hiding };
    let [hidden, told_film] = [hiding, told].map(|settings| film(&scene, settings, [24, 18], 2));
    assert!(hidden == told_film && hidden != film(&scene, PathSettings { find_bug: 0, ..hiding }, [24, 18], 2));
    for gpu in Gpu::each().expect("devices") {
        let mut tracer = GpuTracer::new(&gpu, &scene).expect("a tracer");
        let [hidden, told] = [hiding, told].map(|settings| {
            let mut film = Film::new(24, 18);
            tracer.render(&mut film, &scene.camera, &settings.into(), 2, &|| false).expect("a picture");
            film
        });
        assert!(hidden == told, "{}", gpu.describe());
    }
}

#[test]
fn bugs_are_refused_beside_what_the_plain_walk_does_not_know() {
    let broken = PathSettings { bugs: only(Bug::NoPdf), ..PathSettings::default() };
    assert_eq!(broken.check(), Ok(()));
    let guided = PathSettings { estimator: Estimator::GUIDED, ..broken };
    let branching = PathSettings { branches: 2, bounces: Some(1), ..broken };
    for (refused, what) in [(guided, "guide"), (branching, "more than one direction")] {
        let line = refused.check().expect_err("refused").to_string();
        assert!(line.contains(what), "{line}");
    }
    assert!(PathSettings { find_bug: 1, bugs: Bugs::NONE, ..guided }.check().is_err());
}
