//! The ruler against NVIDIA's FLIP evaluator and numpy, on pictures that both sides compute: see `tests/data/flip.py`.

use compare::flip::{PIXELS_PER_DEGREE, flip, hdr_flip};
use compare::{ErrorMetric, errors};
use film::{DisplayTransform, Image, Vec3};
use serde_json::Value;

const WIDTH: i32 = 128;
const HEIGHT: i32 = 96;

type Rgb = [f64; 3];

/// A lit ball over a checkerboard, its shadow soft (the truth) or hard (the fake); linear RGB.
fn ball_on_board(x: i32, y: i32, soft: bool) -> Rgb {
    let (bx, by) = ((f64::from(x) - 52.0) / 28.0, (f64::from(y) - 38.0) / 28.0);
    let d2 = bx * bx + by * by;
    if d2 < 1.0 {
        let bz = (1.0 - d2).sqrt();
        let lit = (-0.48 * bx - 0.6 * by + 0.64 * bz).max(0.0);
        let gloss = (0..6).fold((-0.265 * bx - 0.331 * by + 0.906 * bz).max(0.0), |gloss, _| gloss * gloss);
        let shade = 0.05 + 0.95 * lit;
        return [0.9, 0.3, 0.2].map(|albedo| albedo * shade + 9.0 * gloss);
    }
    let (ex, ey) = ((f64::from(x) - 78.0) / 34.0, (f64::from(y) - 70.0) / 14.0);
    let e = ex * ex + ey * ey;
    let covered = if soft { (1.5 - e).clamp(0.0, 1.0) } else { f64::from(u8::from(e < 1.0)) };
    let light = 1.0 - 0.85 * covered;
    let floor = if (x / 16 + y / 12) % 2 == 0 { [0.8, 0.78, 0.7] } else { [0.06, 0.1, 0.25] };
    floor.map(|c| c * light)
}

/// A number in [0, 1) for an integer: O'Neill's PCG output function.
fn hashed(i: u32) -> f64 {
    let s = i.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let s = ((s >> ((s >> 28) + 4)) ^ s).wrapping_mul(277_803_737);
    f64::from((s >> 22) ^ s) / 4_294_967_296.0
}

fn truth_at(x: i32, y: i32) -> Rgb {
    ball_on_board(x.clamp(0, WIDTH - 1), y.clamp(0, HEIGHT - 1), true)
}

fn picture(of: impl Fn(i32, i32) -> Rgb) -> Image {
    let pixels = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    let radiances: Vec<_> = pixels.map(|(x, y)| Vec3::from_array(of(x, y).map(|v| v as f32))).collect();
    Image::new(WIDTH as u32, HEIGHT as u32, radiances).unwrap()
}

fn codes(of: impl Fn(i32, i32) -> Rgb) -> Image {
    picture(|x, y| of(x, y).map(|v| (v.clamp(0.0, 1.0).sqrt() * 255.0 + 0.5).floor() / 255.0))
}

fn noisy(x: i32, y: i32) -> Rgb {
    let first = ((y * WIDTH + x) * 3) as u32;
    let truth = truth_at(x, y);
    std::array::from_fn(|c| truth[c] * (0.5 + hashed(first + c as u32)))
}

fn blurred(x: i32, y: i32) -> Rgb {
    let mut total = [0.0; 3];
    for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
        let pixel = truth_at(x + dx, y + dy);
        total.iter_mut().zip(pixel).for_each(|(total, value)| *total += value);
    }
    total.map(|t| t / 9.0)
}

fn tinted(x: i32, y: i32) -> Rgb {
    let [r, g, b] = truth_at(x, y);
    [r * 0.8, g, b * 1.25]
}

/// Linear RGB of the pixel at a column and a row.
type Formula = fn(i32, i32) -> Rgb;

const PAIRS: [(&str, Formula); 5] = [
    ("noise", noisy),
    ("shift", |x, y| truth_at(x - 1, y)),
    ("blur", blurred),
    ("colour", tinted),
    ("fake", |x, y| ball_on_board(x, y, false)),
];

fn expected(pair: &str, number: &str) -> f64 {
    let data: Value = serde_json::from_str(include_str!("../data/flip.json")).unwrap();
    data["pairs"][pair][number].as_f64().unwrap()
}

fn mean(values: &[f32]) -> f64 {
    values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64
}

fn largest(values: &[f32]) -> f64 {
    f64::from(values.iter().fold(0f32, |most, v| most.max(*v)))
}

fn assert_near(pair: &str, number: &str, measured: f64, tolerance: f64) {
    let expected = expected(pair, number);
    println!("{pair:6} {number:13} {measured:.7} expected {expected:.7}, apart {:.1e}", (measured - expected).abs());
    assert!((measured - expected).abs() <= tolerance, "{pair} {number}: {measured} instead of {expected}");
}

#[test]
fn ldr_flip_equals_the_authors_evaluator() {
    let truth = codes(truth_at);
    for (pair, of) in PAIRS {
        let values = flip(&codes(of), &truth, PIXELS_PER_DEGREE).unwrap();
        assert_near(pair, "ldr_mean", mean(&values), 1e-5);
        assert_near(pair, "ldr_max", largest(&values), 1e-4);
    }
}

#[test]
fn hdr_flip_equals_the_authors_evaluator() {
    let truth = picture(truth_at);
    for (pair, of) in PAIRS {
        let found = hdr_flip(&picture(of), &truth, PIXELS_PER_DEGREE).unwrap();
        assert_near(pair, "hdr_mean", mean(&found.values), 1e-5);
        assert_near(pair, "hdr_max", largest(&found.values), 1e-4);
        assert_near(pair, "hdr_exposures", found.exposures.len() as f64, 0.0);
        assert_near(pair, "hdr_first", f64::from(found.exposures[0]), 1e-5);
        assert_near(pair, "hdr_last", f64::from(found.exposures[found.exposures.len() - 1]), 1e-5);
    }
}

#[test]
fn the_other_metrics_equal_numpys_and_the_means_of_their_maps() {
    let truth = picture(truth_at);
    let display = DisplayTransform::default();
    for (pair, of) in PAIRS {
        let film = picture(of);
        let e = errors(&film, &truth).unwrap();
        let map = |map: ErrorMetric| mean(&map.of(&film, &truth, &display).unwrap());
        for (number, measured, of_map) in [
            ("rmse", e.rmse, None),
            ("rel_mse", e.rel_mse, Some(ErrorMetric::SquaredRelative)),
            ("mae", e.mae, Some(ErrorMetric::Absolute)),
            ("bias", e.bias, Some(ErrorMetric::Signed)),
        ] {
            assert_near(pair, number, measured, 1e-12);
            if let Some(of_map) = of_map {
                assert_near(pair, number, map(of_map), 1e-7);
            }
        }
    }
}
