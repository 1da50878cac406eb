//! What a tree chooses is what it says, and nothing that shines on a point is left out.

use super::*;
use crate::light::Lights;
use crate::sampling::rng::{pcg4d, unit_float};
use crate::sampling::{self};
use std::path::Path;

fn units(item: u32, block: u32) -> [f32; 4] {
    pcg4d([item, block, 3, 1]).map(unit_float)
}

/// Lamps of every outline over a field, some alike and some in one place, and one that is a hundred times as strong.
fn lamps() -> Lights {
    let mut text =
        String::from("[camera]\neye = [0, 5, 9]\ntarget = [0, 0, 0]\nfov_y = 50\n[sun]\ntowards = [0, 1, 0]\n");
    text += "irradiance = [1, 1, 1]\nangular_radius = 1\n[material.lamp]\nemissive = { radiance = [1, 2, 4] }\n";
    text += "[material.both]\nemissive = { radiance = [3, 2, 1], two_sided = true }\n";
    for item in 0..300 {
        let [a, b, c, d] = units(item, 0);
        let at = format!("[{:.4}, {:.4}, {:.4}]", 20.0 * a - 10.0, 0.2 + 2.0 * b, 20.0 * c - 10.0);
        let axis = sampling::cone(2.0, [d, a]);
        let way = |v: Vec3| format!("[{:.4}, {:.4}, {:.4}]", v.x, v.y, v.z);
        let (u, v) = sampling::orthonormal_basis(axis);
        let material = if item % 3 == 0 { "both" } else { "lamp" };
        text += &match item % 4 {
            0 => format!("[[sphere]]\ncenter = {at}\nradius = {:.4}\nmaterial = 'lamp'\n", 0.02 + 0.1 * d),
            1 => format!("[[disk]]\ncenter = {at}\nnormal = {}\nradius = 0.05\nmaterial = '{material}'\n", way(axis)),
            2 => format!(
                "[[rectangle]]\ncorner = {at}\nedge_u = {}\nedge_v = {}\nmaterial = '{material}'\n",
                way(u * 0.1),
                way(v * 0.2)
            ),
            _ => format!(
                "[[point_light]]\nposition = {at}\nintensity = [0.01, 0.01, {:.4}]\n",
                if item == 7 { 1.0 } else { 0.01 }
            ),
        };
    }
    text += &"[[point_light]]\nposition = [1, 1, 1]\nintensity = [0.02, 0.01, 0.01]\n".repeat(3);
    Lights::new(&scene::parse(&text, "lamps", Path::new("lamps.toml")).expect("a scene"))
}

fn place(item: u32) -> Vec3 {
    let [a, b, c, d] = units(item, 1);
    Vec3::new(a - 0.5, b * 0.2, c - 0.5) * 10f32.powf(2.0 * d)
}

#[test]
fn probabilities_are_those_of_the_choice_and_add_up_to_one() {
    let lights = lamps();
    let (tree, share) = lights.table().tree().expect("a tree");
    assert!(tree.len() == 303 && share < 1.0, "the sun has no place");
    for item in 0..200 {
        let x = place(item);
        let sum: f64 = (0..tree.len() as u32).map(|light| f64::from(tree.probability(light, x))).sum();
        // from a node that shines by its bound may all lights below it be turned away
        assert!((0.5..1.0 + 1e-5).contains(&sum), "{x}: {sum}");
        for sample in 0..50 {
            let (light, probability) = tree.choose(x, units(sample, item)[3]);
            assert!(probability == 0.0 || probability == tree.probability(light, x), "{x}: {light} {probability}");
        }
    }
}

/// Chi-square of 100 000 choices; 4 standard deviations are passed by chance once in 30 000 tests.
#[test]
fn lights_are_chosen_as_often_as_their_probabilities_say() {
    let lights = lamps();
    let (tree, _) = lights.table().tree().expect("a tree");
    for item in 0..8 {
        const SAMPLES: u32 = 100_000;
        let x = place(item);
        let mut counts = vec![0.0; tree.len()];
        for sample in 0..SAMPLES {
            let (light, probability) = tree.choose(x, units(sample, 2)[0]);
            counts[light as usize] += f64::from(u8::from(probability > 0.0));
        }
        let expected = |light| f64::from(tree.probability(light, x)) * f64::from(SAMPLES);
        let (mut chi2, mut bins) = (0.0, 0.0);
        for (light, count) in (0..).zip(&counts).filter(|(light, _)| expected(*light) > 10.0) {
            chi2 += (count - expected(light)).powi(2) / expected(light);
            bins += 1.0;
        }
        let deviation = (chi2 - bins) / (2.0f64 * bins).sqrt();
        assert!(deviation < 4.0 && bins > 5.0, "{x}: {deviation} standard deviations over {bins} lights");
    }
}

#[test]
fn whatever_shines_on_a_point_may_be_chosen() {
    let lights = lamps();
    let (tree, _) = lights.table().tree().expect("a tree");
    let mut shining = 0;
    for item in 0..300 {
        let x = place(item);
        for light in 0..tree.len() as u32 {
            let sample = lights.table().sample_one::<f32>(light, crate::vectors::lane_vector(x), [0.3, 0.6]);
            if sample.shines {
                shining += 1;
                assert!(tree.probability(light, x) > 0.0, "{x}: {light}");
            }
        }
    }
    assert!(shining > 10_000, "{shining}");
}

#[test]
fn few_lights_have_no_tree() {
    let text = "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nfov_y = 50\n".to_owned()
        + &"[[point_light]]\nposition = [1, 1, 1]\nintensity = [1, 1, 1]\n".repeat(MANY - 1);
    let scene = scene::parse(&text, "few", Path::new("few.toml")).expect("a scene");
    assert!(Lights::new(&scene).table().tree().is_none());
}

/// The expected square of one sample of the light on a floor below a thousand lamps is a fifth of what it is by power, or
/// less: what is left of the error.
#[test]
fn a_tree_needs_a_fifth_of_the_samples_below_a_thousand_lamps() {
    let bounds: Vec<LightBounds> = (0..1000)
        .map(|item| {
            let [a, b, c, d] = units(item, 4);
            let at = Vec3::new(40.0 * a - 20.0, 0.3 + 2.7 * b, 40.0 * c - 20.0);
            let half = Vec3::new(0.05, 0.0, 0.05);
            LightBounds { lo: at - half, hi: at + half, axis: Vec3::NEG_Y, spread: 0.0, intensity: 1.0 + 9.0 * d * d }
        })
        .collect();
    let tree = LightTree::new(&bounds);
    let power: f32 = bounds.iter().map(|lamp| lamp.intensity).sum();
    let (mut by_tree, mut by_power) = (0.0, 0.0);
    for item in 0..200 {
        let [a, _, b, _] = units(item, 5);
        let x = Vec3::new(36.0 * a - 18.0, 0.0, 36.0 * b - 18.0);
        let (mut sum, mut squares) = (0.0, [0.0; 2]);
        for (light, lamp) in (0..).zip(&bounds) {
            let away = 0.5 * (lamp.lo + lamp.hi) - x;
            let lit = f64::from(lamp.intensity * (away.y / away.length()).powi(2) / away.length_squared());
            let half_by_power = 0.5 * (1e-3 + lamp.intensity / power);
            sum += lit;
            squares[0] += lit * lit / f64::from(tree.probability(light, x));
            squares[1] += lit * lit / f64::from(half_by_power);
        }
        by_tree += squares[0] / (sum * sum) - 1.0;
        by_power += squares[1] / (sum * sum) - 1.0;
    }
    assert!(by_tree < 0.2 * by_power, "{by_tree} {by_power}");
}
