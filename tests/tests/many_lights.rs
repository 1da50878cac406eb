//! Scenes of so many lamps that a tree chooses among them: what is found by it is what chance finds, and
//! both machines choose alike.

mod pair;

use film::Film;
use gpu::Gpu;
use pair::paths;
use pathtrace::sampling::rng::{pcg4d, unit_float};
use pathtrace::{Estimator, PathSettings, SamplerKind, Tracer, WhittedSettings};
use scene::Scene;
use std::path::Path;

/// A floor and a ball below 300 lamps of every outline, turned every way, and under a sun.
fn lamps() -> Scene {
    let mut text = String::from(
        "[camera]\neye = [0, 4, 7]\ntarget = [0, 0.5, 0]\nfov_y = 45\n[sun]\ntowards = [0.3, 1, 0.2]\n\
         irradiance = [0.5, 0.5, 0.5]\nangular_radius = 3\n[material.lamp]\nemissive = { radiance = [3, 2, 1] }\n\
         [material.both]\nemissive = { radiance = [1, 2, 3], two_sided = true }\n[material.grey]\n\
         metallic_roughness = { base_colour = [0.7, 0.7, 0.7], metallic = 0, roughness = 0.5 }\n[[rectangle]]\n\
         corner = [-4, 0, -4]\nedge_u = [0, 0, 8]\nedge_v = [8, 0, 0]\nmaterial = 'grey'\n[[sphere]]\n\
         center = [0, 0.7, 0]\nradius = 0.7\nmaterial = 'grey'\n",
    );
    for item in 0..300 {
        let [[a, b, c, d], [e, f, ..]] = [[item, 0, 8, 1], [item, 1, 8, 1]].map(|key| pcg4d(key).map(unit_float));
        let at = format!("[{:.4}, {:.4}, {:.4}]", 8.0 * a - 4.0, 1.6 + b, 8.0 * c - 4.0);
        let turned = format!("[{:.4}, {:.4}, {:.4}]", 0.8 * d - 0.4, -1.0 + e, 0.8 * f - 0.4);
        text += &match item % 3 {
            0 => format!("[[sphere]]\ncenter = {at}\nradius = {:.4}\nmaterial = 'lamp'\n", 0.03 + 0.05 * d),
            1 => format!("[[disk]]\ncenter = {at}\nnormal = {turned}\nradius = 0.1\nmaterial = 'lamp'\n"),
            _ => {
                format!("[[rectangle]]\ncorner = {at}\nedge_u = [0.2, 0, 0]\nedge_v = [0, 0, 0.1]\nmaterial = 'both'\n")
            }
        };
    }
    scene::parse(&text, "lamps", Path::new("lamps.toml")).unwrap()
}

fn settings(estimator: Estimator) -> PathSettings {
    PathSettings { estimator, bounces: Some(1), ..PathSettings::independent() }
}

/// Mean radiance of a picture, green, and its standard error.
fn mean(scene: &Scene, settings: PathSettings, spp: u32) -> (f64, f64) {
    let mut film = Film::new(48, 32);
    Tracer::new(scene).render(&mut film, &scene.camera, &settings.into(), spp, &|| false);
    (film.mean()[1], film.standard_error()[1])
}

#[test]
fn a_tree_finds_the_light_that_chance_finds() {
    let scene = lamps();
    let (expected, error) = mean(&scene, settings(Estimator::COSINE), 256);
    for (estimator, spp) in [(Estimator::LIGHT, 64), (Estimator::MIS, 64)] {
        let (found, own_error) = mean(&scene, PathSettings { seed: 2, ..settings(estimator) }, spp);
        let tolerance = 4.0 * error.hypot(own_error);
        assert!(tolerance < 0.07 * expected, "{}: the error is {tolerance} of {expected}", estimator.name());
        assert!((found - expected).abs() < tolerance, "{}: {found} {expected} {tolerance}", estimator.name());
    }
}

#[test]
fn both_machines_choose_the_same_lamps() {
    let gpu = Gpu::headless().unwrap();
    let scene = lamps();
    for estimator in [Estimator::LIGHT, Estimator::MIS] {
        let chosen = PathSettings { sampler: SamplerKind::Sobol, ..settings(estimator) };
        let pair = paths(&gpu, &scene, (96, 64), 1, &chosen);
        let (apart, rays) = (pair.apart(1e-3), pair.rays());
        assert!(apart <= 5e-3 && (rays - 1.0).abs() < 2e-3, "{}: {apart} {rays}", estimator.name());
    }
    let trees = paths(&gpu, &scene, (96, 64), 1, &WhittedSettings::default());
    let (apart, rays) = (trees.apart(1e-3), trees.rays());
    assert!(apart <= 1e-2 && (rays - 1.0).abs() < 2e-3, "trees: {apart} {rays}");
}
