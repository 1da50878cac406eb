//! FLIP's filters, all separable, the picture continued past its edges by its edge pixels. Andersson et al. 2020,
//! sections 4.1.1 (contrast sensitivity) and 4.2 (edges and points); the sum of two Gaussians of the blue-yellow
//! channel is filtered as two separable terms.

use rayon::prelude::*;
use std::f32::consts::PI;

/// Width of the feature detectors in degrees of visual angle.
const FEATURE_WIDTH: f32 = 0.082;

/// One term of a contrast sensitivity function turned to space: `a sqrt(pi / b) exp(-pi^2 d^2 / b)`, d in degrees.
#[derive(Clone, Copy)]
struct Term {
    a: f32,
    b: f32,
}

const ACHROMATIC: Term = Term { a: 1.0, b: 0.0047 };
const RED_GREEN: Term = Term { a: 1.0, b: 0.0053 };
const BLUE_YELLOW: [Term; 2] = [Term { a: 34.1, b: 0.04 }, Term { a: 13.5, b: 0.025 }];

/// Kernels for the three channels of YCxCz.
pub struct Sensitivity {
    /// For Y, sums to 1.
    pub achromatic: Vec<f32>,
    /// For Cx, sums to 1.
    pub red_green: Vec<f32>,
    /// For Cz, two terms whose outer squares sum to 1 together.
    pub blue_yellow: [Vec<f32>; 2],
}

impl Sensitivity {
    /// For a number of pixels in a degree of visual angle.
    pub fn new(pixels_per_degree: f32) -> Self {
        // three standard deviations of the widest term
        let radius = (3.0 * (BLUE_YELLOW[0].b / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        // the square root of a term's weight, since each term is applied along rows and along columns
        let kernel = |term: Term| -> Vec<f32> {
            let weight = (term.a * (PI / term.b).sqrt()).sqrt();
            let at = |x: i32| x as f32 / pixels_per_degree;
            (-radius..=radius).map(|x| weight * (-PI * PI * at(x).powi(2) / term.b).exp()).collect()
        };
        let sum = |kernel: &[f32]| kernel.iter().sum::<f32>();
        let mut sensitivity = Sensitivity {
            achromatic: kernel(ACHROMATIC),
            red_green: kernel(RED_GREEN),
            blue_yellow: BLUE_YELLOW.map(kernel),
        };
        for kernel in [&mut sensitivity.achromatic, &mut sensitivity.red_green] {
            let sum = sum(kernel);
            kernel.iter_mut().for_each(|w| *w /= sum);
        }
        let [first, second] = &mut sensitivity.blue_yellow;
        let norm = sum(first).hypot(sum(second));
        first.iter_mut().chain(second).for_each(|w| *w /= norm);
        sensitivity
    }
}

/// A Gaussian and its first two derivatives, for edges and points.
pub struct Features {
    /// Sums to 1.
    pub gaussian: Vec<f32>,
    /// First derivative; its positive weights sum to 1, its negative ones to -1.
    pub edge: Vec<f32>,
    /// Second derivative; as [`Features::edge`].
    pub point: Vec<f32>,
}

impl Features {
    /// For a number of pixels in a degree of visual angle.
    pub fn new(pixels_per_degree: f32) -> Self {
        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i32;
        let gauss = |x: f32| (-x * x / (2.0 * deviation * deviation)).exp();
        let weights = |of: &dyn Fn(f32) -> f32| (-radius..=radius).map(|x| of(x as f32)).collect::<Vec<_>>();
        Features {
            gaussian: balanced(weights(&gauss)),
            edge: balanced(weights(&|x| -x * gauss(x))),
            point: balanced(weights(&|x| (x * x / (deviation * deviation) - 1.0) * gauss(x))),
        }
    }
}

/// Scales the positive weights to a sum of 1 and the negative ones to -1.
fn balanced(mut weights: Vec<f32>) -> Vec<f32> {
    let positive: f32 = weights.iter().filter(|w| **w > 0.0).sum();
    let negative: f32 = weights.iter().filter(|w| **w < 0.0).sum();
    for w in &mut weights {
        if *w > 0.0 {
            *w /= positive;
        } else if *w < 0.0 {
            *w /= -negative;
        }
    }
    weights
}

/// Filters each row of a picture of `width` columns.
pub fn along_rows(picture: &[f32], width: usize, kernel: &[f32]) -> Vec<f32> {
    let radius = kernel.len() / 2;
    let mut filtered = vec![0.0; picture.len()];
    filtered.par_chunks_mut(width).zip(picture.par_chunks(width)).for_each(|(out, row)| {
        let (first, last) = (row[0], row[width - 1]);
        let before = std::iter::repeat_n(first, radius);
        let padded: Vec<f32> = before.chain(row.iter().copied()).chain(std::iter::repeat_n(last, radius)).collect();
        for (offset, &weight) in kernel.iter().enumerate() {
            add_weighted(out, &padded[offset..offset + width], weight);
        }
    });
    filtered
}

/// Filters each column of a picture of `width` columns.
pub fn along_columns(picture: &[f32], width: usize, kernel: &[f32]) -> Vec<f32> {
    let (radius, height) = (kernel.len() / 2, picture.len() / width);
    let mut filtered = vec![0.0; picture.len()];
    filtered.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (offset, &weight) in kernel.iter().enumerate() {
            let row = (y + offset).saturating_sub(radius).min(height - 1);
            add_weighted(out, &picture[row * width..(row + 1) * width], weight);
        }
    });
    filtered
}

fn add_weighted(out: &mut [f32], from: &[f32], weight: f32) {
    for (out, from) in out.iter_mut().zip(from) {
        *out += weight * from;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PPD: f32 = 67.020_64;

    #[test]
    fn kernels_keep_a_constant_and_features_ignore_it() {
        let sum = |k: &[f32]| k.iter().sum::<f32>();
        let s = Sensitivity::new(PPD);
        assert_eq!(s.achromatic.len(), 21);
        assert!((sum(&s.achromatic) - 1.0).abs() < 1e-5 && (sum(&s.red_green) - 1.0).abs() < 1e-5);
        assert!((sum(&s.blue_yellow[0]).powi(2) + sum(&s.blue_yellow[1]).powi(2) - 1.0).abs() < 1e-5);
        let f = Features::new(PPD);
        assert_eq!(f.edge.len(), 19);
        assert!((sum(&f.gaussian) - 1.0).abs() < 1e-5 && sum(&f.edge).abs() < 1e-5 && sum(&f.point).abs() < 1e-5);
    }

    #[test]
    fn rows_and_columns_shift_alike_and_repeat_the_edge() {
        let (before, after) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
        let picture = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        assert_eq!(along_rows(&picture, 3, &before), [1.0, 1.0, 2.0, 4.0, 4.0, 5.0, 7.0, 7.0, 8.0]);
        assert_eq!(along_rows(&picture, 3, &after), [2.0, 3.0, 3.0, 5.0, 6.0, 6.0, 8.0, 9.0, 9.0]);
        assert_eq!(along_columns(&picture, 3, &before), [1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(along_columns(&picture, 3, &after), [4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 7.0, 8.0, 9.0]);
    }
}
