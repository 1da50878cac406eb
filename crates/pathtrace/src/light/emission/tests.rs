//! The power of photons is that of their lights, whatever they are aimed at.

use super::*;
use crate::sampling::rng::{pcg4d, unit_float};
use std::path::Path;

/// With a caster near, one farther away, and a big one around all lights, which nothing can be aimed at from within.
const CASTERS: &str = "[material.glass]\ndielectric = { ior = 1.5 }\n\
     [[sphere]]\ncenter = [0, 0, 3]\nradius = 1\nmaterial = 'glass'\n\
     [[disk]]\ncenter = [4, 1, 0]\nnormal = [0, 1, 0]\nradius = 0.5\nmaterial = 'glass'\n\
     [[sphere]]\ncenter = [0, 0, 0]\nradius = 9\nmaterial = 'glass'\n";

/// What a camera sees: two spheres beside each other, one around both that holds all lights, and one that is nearly a point.
const SEEN: [Bounds; 4] = [
    Bounds { center: Vec3::new(-5.0, 2.0, 1.0), radius: 1.0 },
    Bounds { center: Vec3::new(-5.0, 3.5, 1.0), radius: 1.0 },
    Bounds { center: Vec3::new(-3.0, 2.0, 1.0), radius: 8.0 },
    Bounds { center: Vec3::new(3.0, -5.0, 2.0), radius: 1e-3 },
];

fn emitters(lights: &str, casters: &str) -> Emitters {
    let camera = "[camera]\neye = [0, 0, 20]\ntarget = [0, 0, 0]\nfov_y = 40\n";
    let materials = "[material.lamp]\nemissive = { radiance = [2, 1, 0.5] }\n\
         [material.both]\nemissive = { radiance = [2, 1, 0.5], two_sided = true }\n\
         [material.grey]\ndiffuse = { albedo = [0.5, 0.5, 0.5] }\n";
    let bounds = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 10\nmaterial = 'grey'\n";
    let text = format!("{camera}{materials}{bounds}{casters}{lights}");
    let scene = scene::parse(&text, "test", Path::new("test.toml")).expect("a scene");
    Emitters::new(&scene, &Lights::new(&scene))
}

/// Mean and standard error of the photons' power, red.
fn power(emitters: &Emitters, aim: &Aim, count: u32) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for i in 0..count {
        let [light, aimed, side, s] = pcg4d([i, 1, 2, 3]).map(unit_float);
        let [t, u, v, _] = pcg4d([i, 4, 5, 6]).map(unit_float);
        let choice = EmissionChoice { light, aim: aimed, side, place: [s, t], way: [u, v] };
        let power = emitters.emit(aim, &choice).map_or(0.0, |emitted| f64::from(emitted.power.x));
        (sum, squares) = (sum + power, squares + power * power);
    }
    let (mean, n) = (sum / f64::from(count), f64::from(count));
    // all alike they have no spread but what is rounded
    (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt())
}

#[test]
fn photons_carry_the_power_of_their_light_whatever_they_are_aimed_at() {
    let pi = std::f64::consts::PI;
    // half the diagonal of the bounds of a sphere of radius 10
    let disc = pi * 300.0;
    let cases = [
        (
            "[[rectangle]]\ncorner = [0, 0, 0]\nedge_u = [2, 0, 0]\nedge_v = [0, 1, 0]\nmaterial = 'lamp'\n",
            2.0 * pi * 2.0,
        ),
        (
            "[[rectangle]]\ncorner = [0, 0, 0]\nedge_u = [2, 0, 0]\nedge_v = [1, 1, 0]\nmaterial = 'both'\n",
            4.0 * pi * 2.0,
        ),
        ("[[disk]]\ncenter = [0, 1, 0]\nnormal = [0, -1, 0]\nradius = 0.5\nmaterial = 'lamp'\n", 0.25 * pi * pi * 2.0),
        ("[[sphere]]\ncenter = [0, 0, -1]\nradius = 0.5\nmaterial = 'lamp'\n", pi * pi * 2.0),
        ("[[box]]\ncorner = [0, 0, -2]\nsize = [1, 2, 0.5]\nmaterial = 'lamp'\n", 7.0 * pi * 2.0),
        ("[[point_light]]\nposition = [1, 1, 0]\nintensity = [2, 1, 0.5]\n", 4.0 * pi * 2.0),
        ("[sun]\ntowards = [1, 2, 3]\nangular_radius = 0\nirradiance = [2, 1, 0.5]\n", 2.0 * disc),
        ("[sky]\nradiance = [2, 1, 0.5]\n", 2.0 * 4.0 * pi * disc),
    ];
    for (light, expected) in cases {
        for (casters, seen) in [("", &[][..]), (CASTERS, &[]), ("", &SEEN), (CASTERS, &SEEN)] {
            let emitters = emitters(light, casters);
            let (mean, error) = power(&emitters, &emitters.aim(seen), 100_000);
            let what = format!("{light}{casters}{seen:?}: {mean} +- {error}, expected {expected}");
            assert!(error < 0.007 * expected && (mean - expected).abs() <= 4.0 * error + 1e-4 * expected, "{what}");
        }
    }
}

/// A cone's solid angle by its height times the radiance is the irradiance but for the cosine: 1 - sin^2 / 2 of it.
#[test]
fn a_wide_suns_power_is_its_irradiance_on_the_disc_that_faces_each_direction() {
    let sun = "[sun]\ntowards = [0, 0, 1]\nangular_radius = 20\nirradiance = [2, 1, 0.5]\n";
    let pi = std::f64::consts::PI;
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let expected = 2.0 / (pi * sin * sin) * 2.0 * pi * (1.0 - cos) * pi * 300.0;
    for casters in ["", CASTERS] {
        let emitters = emitters(sun, casters);
        let (mean, error) = power(&emitters, &emitters.aim(&SEEN), 100_000);
        assert!((mean - expected).abs() <= 4.0 * error + 1e-4 * expected, "{mean} +- {error}, expected {expected}");
    }
}

/// A lamp that faces away from a sphere sends none of its photons that way in vain.
#[test]
fn nothing_is_aimed_at_what_lies_behind_a_lamp() {
    let lamp = "[[disk]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 0.1\nmaterial = 'lamp'\n";
    let emitters = emitters(lamp, "");
    let aim = emitters.aim(&[Bounds { center: Vec3::new(0.0, 0.0, -5.0), radius: 1.0 }]);
    let leaves = |i: &u32| {
        let [light, aimed, u, v] = pcg4d([*i, 1, 2, 3]).map(unit_float);
        let choice = EmissionChoice { light, aim: aimed, side: 0.0, place: [0.5; 2], way: [u, v] };
        emitters.emit(&aim, &choice).is_some()
    };
    assert!((0..1000).all(|i| leaves(&i)));
}

#[test]
fn half_of_the_photons_fly_at_what_focuses_light() {
    let caster = "[material.glass]\ndielectric = { ior = 1.5 }\n[[sphere]]\ncenter = [0, 0, 3]\nradius = 1\nmaterial = 'glass'\n";
    let sun = emitters("[sun]\ntowards = [1, 2, 3]\nangular_radius = 0\nirradiance = [2, 1, 0.5]\n", caster);
    let aimed = (0..10_000).filter(|i| {
        let [light, aim, u, v] = pcg4d([*i, 1, 2, 3]).map(unit_float);
        let choice = EmissionChoice { light, aim, side: 0.0, place: [0.5; 2], way: [u, v] };
        let ray = sun.emit(&sun.aim(&[]), &choice).expect("a sun shines").ray;
        let to_center = Vec3::new(0.0, 0.0, 3.0) - ray.origin;
        (to_center - ray.direction * to_center.dot(ray.direction)).length() < 1.0
    });
    // and of the other half one in three hundred
    assert!((4900..5200).contains(&aimed.count()));
}
