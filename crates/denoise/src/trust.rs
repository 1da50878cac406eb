//! How far to trust the samples: a denoised picture D and noisy ones N put together pixel by pixel, D + w (N - D), with the
//! positive-part James-Stein estimator's w (James and Stein, "Estimation with Quadratic Loss", 1961). Around a pixel, in 7 x 7 pixels
//! of three values, N - D is noise if D is right, and its square about as large as the variance of N; what is larger is D's bias, and
//! N is worth more: w = 1 - variance / square (of p values theirs is 1 - (p - 2) / p times that), which is also where the estimated
//! squared error of the mixture is least.
//!
//! D must not know N's noise. One part of the samples gives D, the other N, both ways, and the mean of both by the samples
//! of N is the picture. The difference of both parts tells the variance, whatever the sampler: a pixel's own samples say too
//! much of Sobol points, and nothing where they have not met a light yet. As samples become many w tends to 1, and the
//! picture to the truth.
//!
//! Squares count as in the relMSE, over D^2 + .01: else a lamp would decide for the wall beside it.

use film::{Image, Vec3};
use rayon::prelude::*;

use crate::{DenoiseError, check_memory};

/// To each side of a pixel.
const REACH: usize = 3;

/// Samples of a pixel below which nobody knows their variance, and nothing is trusted.
pub const LEAST_SAMPLES: u32 = 4;

/// Bytes for each pixel: a mixture and its weight, two weights, and at most four lists of sums over squares at a time.
const MEMORY: usize = size_of::<Vec3>() + 7 * size_of::<f32>();

/// Added to what squares are taken relative to.
const RELATIVE_FLOOR: f32 = 0.01;

/// Samples of a picture in two parts, best halves, and what a denoiser makes of each.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// Means of one and of the other part of the samples.
    pub noisy: [&'a Image; 2],
    /// Each of them denoised by itself.
    pub denoised: [&'a Image; 2],
    /// Samples of a pixel in each part.
    pub samples: [u32; 2],
}

/// What comes of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trusted {
    /// The mixture, in linear radiance.
    pub image: Image,
    /// How far each pixel's samples are trusted: 0 is the denoiser's picture, 1 the samples' own.
    pub weight: Vec<f32>,
}

/// What is denoised of one part, against the other part's samples.
struct Way<'a> {
    denoised: &'a [Vec3],
    noisy: &'a [Vec3],
    /// Of all samples, those in `noisy`.
    share: f32,
}

/// The James-Stein combination of both parts, going back to the samples by the `share` in [0, 1] of what it would.
///
/// # Errors
/// [`DenoiseError::Size`] if they are of several sizes, [`DenoiseError::Memory`] if there is not so much.
pub fn trust(parts: Parts, share: f32) -> Result<Trusted, DenoiseError> {
    let [first, second] = parts.noisy;
    let size = first.size();
    if [second, parts.denoised[0], parts.denoised[1]].iter().any(|image| image.size() != size) {
        return Err(DenoiseError::Size);
    }
    let all: u32 = parts.samples.iter().sum();
    let ways = [0, 1].map(|part| Way {
        denoised: parts.denoised[part].radiances(),
        noisy: parts.noisy[1 - part].radiances(),
        share: parts.samples[1 - part] as f32 / all.max(1) as f32,
    });
    let pixels = first.radiances().len();
    check_memory(MEMORY * pixels)?;
    let weights = ways.each_ref().map(|way| {
        if all < LEAST_SAMPLES {
            return vec![0.0; pixels];
        }
        let relative = |difference: Vec3, pixel: usize| relative(difference, way.denoised[pixel]);
        let off = around(pixels, size.0 as usize, |pixel| relative(way.noisy[pixel] - way.denoised[pixel], pixel));
        // of the difference of both parts a part has the other's share: few samples have more of it
        let noise = around(pixels, size.0 as usize, |pixel| {
            relative(first.radiances()[pixel] - second.radiances()[pixel], pixel) * (1.0 - way.share)
        });
        off.iter().zip(&noise).map(|(off, noise)| share * weight(*off, *noise)).collect()
    });
    let pixel = |pixel: usize| {
        let of = |way: &Way, weight: f32| way.share * way.denoised[pixel].lerp(way.noisy[pixel], weight);
        of(&ways[0], weights[0][pixel]) + of(&ways[1], weights[1][pixel])
    };
    let radiances: Vec<Vec3> = (0..pixels).map(pixel).collect();
    let image = Image::new(size.0, size.1, radiances).ok_or(DenoiseError::Size)?;
    let weight = weights[0].iter().zip(&weights[1]).map(|(a, b)| ways[0].share * a + ways[1].share * b).collect();
    Ok(Trusted { image, weight })
}

/// The square of a difference as the relMSE counts it; 0 where it is no number, which is no reason to trust.
fn relative(difference: Vec3, denoised: Vec3) -> f32 {
    let sum = (difference * difference / (denoised * denoised + RELATIVE_FLOOR)).element_sum();
    if sum.is_finite() { sum } else { 0.0 }
}

/// w of means of squares: of N - D, and of N's noise. Where both are 0 it does not matter.
fn weight(off: f32, noise: f32) -> f32 {
    if off > 0.0 { (1.0 - noise / off).max(0.0) } else { 0.0 }
}

/// Sums over the square around each pixel, as far as it is in the picture.
fn around(pixels: usize, width: usize, of: impl Fn(usize) -> f32 + Send + Sync) -> Vec<f32> {
    let height = pixels / width.max(1);
    let near = |at: usize, side: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(side);
    let values: Vec<f32> = (0..pixels).into_par_iter().map(of).collect();
    let in_row = |pixel: usize| values[pixel / width * width..][near(pixel % width, width)].iter().sum();
    let in_row: Vec<f32> = (0..pixels).into_par_iter().map(in_row).collect();
    let in_square = |pixel: usize| near(pixel / width, height).map(|row| in_row[row * width + pixel % width]).sum();
    (0..pixels).into_par_iter().map(in_square).collect()
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

    /// `deviation` is a half's.
    fn of(denoised: &Image, deviation: f32, samples: u32) -> Trusted {
        let [a, b] = [noisy(deviation, 1), noisy(deviation, 2)];
        let samples = [samples / 2, samples - samples / 2];
        trust(Parts { noisy: [&a, &b], denoised: [denoised; 2], samples }, 1.0).unwrap()
    }

    fn mean(values: &[f32]) -> f32 {
        values.iter().sum::<f32>() / values.len() as f32
    }

    /// Then |N - D|^2 is as large as the noise, give or take a tenth: w is 0 for half of the patches.
    #[test]
    fn a_denoiser_that_is_right_is_trusted() {
        let weight = mean(&of(&flat(1.0), 0.1, 16).weight);
        assert!((0.0..0.1).contains(&weight), "{weight}");
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
        let parts = Parts { noisy: [&a, &b], denoised: [&a, &b], samples: [4, 4] };
        let trusted = trust(parts, 1.0).unwrap();
        assert!((mean(&trusted.weight) - 0.5).abs() < 0.02, "{}", mean(&trusted.weight));
    }

    /// Where the samples alone are trusted the picture is the mean of all of them, however they are parted.
    #[test]
    fn parts_count_by_their_samples() {
        let [a, b, wrong] = [1.0, 2.0, 50.0].map(flat);
        let parts = Parts { noisy: [&a, &b], denoised: [&wrong; 2], samples: [2, 6] };
        let trusted = trust(parts, 1.0).unwrap();
        assert!(trusted.image.radiances().iter().all(|pixel| (*pixel - Vec3::splat(1.75)).abs().max_element() < 0.02));
        let half = trust(parts, 0.5).unwrap();
        assert!(half.image.radiances().iter().all(|pixel| (*pixel - Vec3::splat(25.875)).abs().max_element() < 0.02));
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
        let parts = Parts { noisy: [&one, &other], denoised: [&one, &one], samples: [4, 4] };
        assert_eq!(trust(parts, 1.0), Err(DenoiseError::Size));
    }
}
