//! Whether colours that mean different things look different, also to those who do not see red or green.

use super::palette::Palette;
use crate::model::Theme;
use egui::Color32;

type Matrix = [[f64; 3]; 3];

/// What an eye without cones of one kind takes a linear colour for: Machado, Oliveira and Fernandes, "A Physiologically-based Model for
/// Simulation of Color Vision Deficiency" (2009), severity 1.
const EYES: [(&str, Matrix); 3] = [
    ("all cones", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    (
        "deuteranopia",
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    ),
    ("protanopia", [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
];

/// Linear sRGB to CIE XYZ over the white point D65.
const TO_XYZ: Matrix = [
    [0.412456 / 0.95047, 0.357576 / 0.95047, 0.180438 / 0.95047],
    [0.212673, 0.715152, 0.072175],
    [0.019334 / 1.08883, 0.119192 / 1.08883, 0.950304 / 1.08883],
];

fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
}

/// A colour in CIE L*a*b* as an eye sees it.
fn seen(eye: &Matrix, colour: Color32) -> [f64; 3] {
    let linear = [colour.r(), colour.g(), colour.b()].map(|byte| {
        let v = f64::from(byte) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    });
    let [x, y, z] = times(&TO_XYZ, times(eye, linear).map(|v| v.clamp(0.0, 1.0)))
        .map(|t| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// CIEDE2000: Sharma, Wu and Dalal, "The CIEDE2000 Color-Difference Formula" (2005).
fn difference([l1, a1, b1]: [f64; 3], [l2, a2, b2]: [f64; 3]) -> f64 {
    let of_seventh = |c: f64| (c.powi(7) / (c.powi(7) + 25f64.powi(7))).sqrt();
    let stretch = 1.5 - 0.5 * of_seventh(0.5 * (a1.hypot(b1) + a2.hypot(b2)));
    let polar = |a: f64, b: f64| ((a * stretch).hypot(b), b.atan2(a * stretch).to_degrees().rem_euclid(360.0));
    let ((c1, h1), (c2, h2)) = (polar(a1, b1), polar(a2, b2));
    let turn = (h2 - h1 + 180.0).rem_euclid(360.0) - 180.0;
    let hue = h1 + 0.5 * turn;
    let cosine = |degrees: f64| degrees.to_radians().cos();
    let (l, c) = (0.5 * (l1 + l2) - 50.0, 0.5 * (c1 + c2));
    let t = 1.0 - 0.17 * cosine(hue - 30.0) + 0.24 * cosine(2.0 * hue) + 0.32 * cosine(3.0 * hue + 6.0)
        - 0.2 * cosine(4.0 * hue - 63.0);
    let lightness = (l2 - l1) / (1.0 + 0.015 * l * l / (20.0 + l * l).sqrt());
    let chroma = (c2 - c1) / (1.0 + 0.045 * c);
    let tint = 2.0 * (c1 * c2).sqrt() * (0.5 * turn).to_radians().sin() / (1.0 + 0.015 * c * t);
    let blue = (60.0 * (-((hue.rem_euclid(360.0) - 275.0) / 25.0).powi(2)).exp()).to_radians().sin();
    (lightness * lightness + chroma * chroma + tint * tint - 2.0 * of_seventh(c) * blue * chroma * tint).sqrt()
}

#[test]
fn differences_are_those_of_the_published_table() {
    // rows 1, 7, 16 and 25 of Sharma, Wu and Dalal's test data
    for (a, b, expected) in [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
    ] {
        let found = difference(a, b);
        assert!((found - expected).abs() < 1e-4, "{a:?} and {b:?}: {found}");
    }
}

#[test]
fn colours_of_panes_and_curves_are_apart_to_every_eye() {
    for theme in Theme::ALL {
        let palette = Palette::of(theme);
        let curves: Vec<Color32> = palette.panes.into_iter().chain(palette.pinned).collect();
        for (name, eye) in &EYES {
            let apart = |a: usize, b: usize| difference(seen(eye, curves[a]), seen(eye, curves[b]));
            assert!(apart(0, 1) >= 20.0, "{theme:?}, {name}: A and B are {} apart", apart(0, 1));
            for (a, b) in (0..curves.len()).flat_map(|b| (0..b).map(move |a| (a, b))) {
                assert!(apart(a, b) >= 10.0, "{theme:?}, {name}: curves {a} and {b} are {} apart", apart(a, b));
            }
        }
    }
}
