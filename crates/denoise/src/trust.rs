//! How far to trust the samples: a denoised picture D and noisy ones N put together pixel by pixel, D + w (N - D), with the
//! positive-part James-Stein estimator's w. Around a pixel, in 7 x 7 pixels of three values, N - D is noise if D is right,
//! and its square about as large as the variance of N says; what is larger is D's bias, and N is worth more.
//!
//! D must not know N's noise. One part of the samples gives D, the other N, both ways, and the mean of both by the samples
//! of N is the picture. As samples become many w tends to 1, and the picture to the truth.

use film::{Image, Vec3};
use rayon::prelude::*;

use crate::DenoiseError;

/// To each side of a pixel.
const REACH: usize = 3;

/// Samples of a pixel below which nobody knows their variance, and nothing is trusted.
pub const LEAST_SAMPLES: u32 = 4;

/// Variance below this share of a value's square is taken for this much: nothing is divided by 0.
const LEAST_VARIANCE: f32 = 1e-12;

/// Samples of a picture in two parts, best halves, and what a denoiser makes of each.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// Means of one and of the other part of the samples.
    pub noisy: [&'a Image; 2],
    /// Each of them denoised by itself.
    pub denoised: [&'a Image; 2],
    /// Variance of the mean of all samples; that of half of them is twice as much.
    pub variance: &'a [Vec3],
    /// Samples of a pixel in each part.
    pub samples: [u32; 2],
}

/// What comes of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trusted {
    /// The picture.
    pub image: Image,
    /// How far each pixel's samples are trusted: 0 is the denoiser's picture, 1 the samples' own.
    pub weight: Vec<f32>,
}

/// The James-Stein combination of both parts, going back to the samples by the `share` in [0, 1] of what it would.
///
/// # Errors
/// [`DenoiseError::Size`] if they are of several sizes.
pub fn trust(parts: Parts, share: f32) -> Result<Trusted, DenoiseError> {
    let [first, second] = parts.noisy;
    let size = first.size();
    let same = [second, parts.denoised[0], parts.denoised[1]].iter().all(|image| image.size() == size);
    if !same || parts.variance.len() != first.radiances().len() {
        return Err(DenoiseError::Size);
    }
    let all: u32 = parts.samples.iter().sum();
    // what is denoised of one part against the other part's samples
    let way = |part: usize| {
        let of_noisy = parts.samples[1 - part] as f32 / all.max(1) as f32;
        (parts.denoised[part].radiances(), parts.noisy[1 - part].radiances(), of_noisy)
    };
    let ways = [way(0), way(1)];
    let weights = ways.map(|(denoised, noisy, of_noisy)| {
        if all < LEAST_SAMPLES || of_noisy == 0.0 {
            return vec![0.0; noisy.len()];
        }
        let off =
            |pixel: usize| whitened(noisy[pixel] - denoised[pixel], noisy[pixel], parts.variance[pixel] / of_noisy);
        let mut weights = weights(&squares(noisy.len(), off), size.0 as usize);
        weights.iter_mut().for_each(|weight| *weight *= share);
        weights
    });
    let pixel = |pixel: usize| {
        let of = |way: usize| {
            let (denoised, noisy, of_noisy) = ways[way];
            of_noisy * (denoised[pixel] + weights[way][pixel] * (noisy[pixel] - denoised[pixel]))
        };
        of(0) + of(1)
    };
    let radiances: Vec<Vec3> = (0..first.radiances().len()).map(pixel).collect();
    let image = Image::new(size.0, size.1, radiances).ok_or(DenoiseError::Size)?;
    let weight = weights[0].iter().zip(&weights[1]).map(|(a, b)| ways[0].2 * a + ways[1].2 * b).collect();
    Ok(Trusted { image, weight })
}

fn squares(count: usize, off: impl Fn(usize) -> f32 + Send + Sync) -> Vec<f32> {
    (0..count).into_par_iter().map(off).collect()
}

/// The square of a difference in units of the values' own standard deviations.
fn whitened(difference: Vec3, value: Vec3, variance: Vec3) -> f32 {
    let least = LEAST_VARIANCE * (Vec3::ONE + value * value);
    let square = (difference * difference / variance.max(least)).element_sum();
    // a pixel that is no number is no reason to trust
    if square.is_finite() { square } else { 0.0 }
}

/// w = max(0, 1 - (p - 2) / |N - D|^2) of whitened values, whose variance is 1; p of them are in the pixel's patch.
fn weights(squares: &[f32], width: usize) -> Vec<f32> {
    let height = squares.len() / width.max(1);
    let around = |at: usize, side: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(side);
    let in_row: Vec<f32> = (0..squares.len())
        .into_par_iter()
        .map(|pixel| squares[pixel / width * width..][around(pixel % width, width)].iter().sum())
        .collect();
    let weight = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        let rows = around(y, height);
        let values = 3 * rows.len() * around(x, width).len();
        let square: f32 = rows.map(|row| in_row[row * width + x]).sum();
        (1.0 - (values as f32 - 2.0) / square).max(0.0)
    };
    (0..squares.len()).into_par_iter().map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (40, 30);

    fn flat(value: f32) -> Image {
        Image::new(SIZE.0, SIZE.1, vec![Vec3::splat(value); (SIZE.0 * SIZE.1) as usize]).unwrap()
    }

    /// A picture of 1 with noise of a standard deviation, uniform in each value.
    fn noisy(deviation: f32, seed: u32) -> Image {
        let mut state = seed;
        let mut uniform = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0 - 0.5
        };
        flat(1.0).map(|one| one + 12.0_f32.sqrt() * deviation * Vec3::from_array([uniform(), uniform(), uniform()]))
    }

    /// `deviation` is a half's, and what the variance says.
    fn of(denoised: &Image, deviation: f32, samples: u32) -> Trusted {
        let [a, b] = [noisy(deviation, 1), noisy(deviation, 2)];
        let variance = vec![Vec3::splat(deviation * deviation / 2.0); a.radiances().len()];
        let samples = [samples / 2, samples - samples / 2];
        trust(Parts { noisy: [&a, &b], denoised: [denoised; 2], variance: &variance, samples }, 1.0).unwrap()
    }

    fn mean(values: &[f32]) -> f32 {
        values.iter().sum::<f32>() / values.len() as f32
    }

    /// Then |N - D|^2 is p on average: w is 0 for half of the patches, and 2 / p or less for most others.
    #[test]
    fn a_denoiser_that_is_right_is_trusted() {
        let weight = mean(&of(&flat(1.0), 0.1, 16).weight);
        assert!((0.0..0.08).contains(&weight), "{weight}");
    }

    /// Off by as much as the deviation, |N - D|^2 is 2 p; off by ten, 101 p.
    #[test]
    fn a_denoiser_that_is_wrong_is_trusted_the_less_the_fewer_the_noise() {
        for (deviation, expected) in [(0.1, 1.0 - 1.0 / 2.0), (0.01, 1.0 - 1.0 / 101.0)] {
            let trusted = of(&flat(1.1), deviation, 16);
            let weight = mean(&trusted.weight);
            assert!((weight - expected).abs() < 0.02, "{deviation}: {weight} {expected}");
        }
        let exact = of(&flat(1.1), 0.0, 16);
        assert!(exact.image.radiances().iter().all(|pixel| (*pixel - Vec3::ONE).abs().max_element() < 1e-6));
    }

    /// What is left as it is differs from the other half by the noise of both, and would from its own by none.
    #[test]
    fn each_half_is_judged_by_the_other() {
        let [a, b] = [noisy(0.1, 1), noisy(0.1, 2)];
        let variance = vec![Vec3::splat(0.005); a.radiances().len()];
        let parts = Parts { noisy: [&a, &b], denoised: [&a, &b], variance: &variance, samples: [4, 4] };
        let trusted = trust(parts, 1.0).unwrap();
        assert!((mean(&trusted.weight) - 0.5).abs() < 0.02, "{}", mean(&trusted.weight));
    }

    /// Where the samples alone are trusted the picture is the mean of all of them, however they are parted.
    #[test]
    fn parts_count_by_their_samples() {
        let [a, b, wrong] = [1.0, 2.0, 50.0].map(flat);
        let variance = vec![Vec3::splat(1e-6); a.radiances().len()];
        let parts = Parts { noisy: [&a, &b], denoised: [&wrong; 2], variance: &variance, samples: [2, 6] };
        let trusted = trust(parts, 1.0).unwrap();
        assert!(trusted.image.radiances().iter().all(|pixel| (*pixel - Vec3::splat(1.75)).abs().max_element() < 1e-4));
        let half = trust(parts, 0.5).unwrap();
        assert!(half.image.radiances().iter().all(|pixel| (*pixel - Vec3::splat(25.875)).abs().max_element() < 1e-3));
    }

    #[test]
    fn below_four_samples_nothing_is_trusted() {
        let trusted = of(&flat(5.0), 0.1, 3);
        assert_eq!((trusted.image, mean(&trusted.weight)), (flat(5.0), 0.0));
        assert!(mean(&of(&flat(5.0), 0.1, 4).weight) > 0.99);
    }

    #[test]
    fn layers_of_several_sizes_are_refused() {
        let (one, other) = (flat(1.0), Image::new(1, 1, vec![Vec3::ONE]).unwrap());
        let variance = vec![Vec3::ONE; one.radiances().len()];
        let parts = Parts { noisy: [&one, &other], denoised: [&one, &one], variance: &variance, samples: [4, 4] };
        assert_eq!(trust(parts, 1.0), Err(DenoiseError::Size));
    }
}
