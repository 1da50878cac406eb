//! Whether two pictures differ by more than their own noise.

use crate::CompareError;
use crate::metrics::same_size;
use film::{Image, Vec3};

/// How many standard errors a difference may have and still be noise: of pictures of the same, 95 % of the pixels differ
/// by less.
pub const SIGNIFICANT: f32 = 2.0;

/// Share of the radiance that rounding may add on the way of a picture to its f32s.
const ROUNDING: f32 = 1e-5;

/// Pixels on each side of one whose differences tell its variance with its own. A pixel alone tells it with one degree
/// of freedom, by which a third of all that is noise would be taken for a difference.
const REACH: usize = 2;

/// The variance of each pixel of a picture of `samples.1` samples, from the same picture when it had `samples.0`: what
/// has been added since is a second picture of the same. Unlike the spread of the samples inside a pixel, which
/// overstates it up to fourteen times, this holds for low-discrepancy samplers too. `None` where nothing was added.
///
/// # Errors
/// [`CompareError::Sizes`] if they do not have the same pixels.
pub fn variance_by_parts(
    earlier: &Image,
    image: &Image,
    samples: (u32, u32),
) -> Result<Option<Vec<Vec3>>, CompareError> {
    same_size(earlier.size(), image.size())?;
    let (before, now) = samples;
    if before == 0 || now <= before {
        return Ok(None);
    }
    // with a variance v of one sample, v / now of the whole and v / before of the part: the difference has
    // v (1 / before - 1 / now)
    let share = before as f32 / (now - before) as f32;
    let squares = image.radiances().iter().zip(earlier.radiances()).map(|(a, b)| (a - b) * (a - b) * share);
    Ok(Some(smoothed(&squares.collect::<Vec<_>>(), image.width() as usize)))
}

/// Means over the squares of pixels that reach [`REACH`] to all sides, as far as there are any.
fn smoothed(values: &[Vec3], width: usize) -> Vec<Vec3> {
    let height = values.len() / width.max(1);
    let along_rows = means(values, (width, 1), (height, width));
    means(&along_rows, (height, width), (width, 1))
}

/// Means along lines of `count` values that lie `step` apart; there are `lines` of them that begin `next` apart.
fn means(values: &[Vec3], (count, step): (usize, usize), (lines, next): (usize, usize)) -> Vec<Vec3> {
    let mut means = vec![Vec3::ZERO; values.len()];
    for line in 0..lines {
        for i in 0..count {
            let (first, last) = (i.saturating_sub(REACH), (i + REACH).min(count - 1));
            let sum: Vec3 = (first..=last).map(|i| values[line * next + i * step]).sum();
            means[line * next + i * step] = sum / (last - first + 1) as f32;
        }
    }
    means
}

/// Which pixels differ by no more than [`SIGNIFICANT`] standard errors; `variances` are those of both pictures, `None` of
/// one without noise. The channels' differences are averaged without their signs, so that a change of hue is one.
///
/// # Errors
/// [`CompareError::Sizes`] if they do not have the same pixels.
pub fn within_noise(
    image: &Image,
    reference: &Image,
    variances: [Option<&[Vec3]>; 2],
) -> Result<Vec<bool>, CompareError> {
    same_size(image.size(), reference.size())?;
    let variance = |pixel: usize| variances.iter().flatten().map(|of| of[pixel]).sum::<Vec3>();
    let pairs = image.radiances().iter().zip(reference.radiances()).enumerate();
    let within = pairs.map(|(pixel, (a, r))| {
        let errors = variance(pixel).map(f32::sqrt).element_sum();
        (a - r).abs().element_sum() <= SIGNIFICANT * errors + ROUNDING * r.abs().element_sum()
    });
    Ok(within.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (64, 64);

    /// Numbers in [0, 1) that look random (Steele et al. 2014, SplitMix64).
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
        }
    }

    /// A picture of `samples` noisy samples a pixel, and the same when it had half of them. The noise grows from the
    /// left to the right, as it does from light to shadow.
    fn halves(seed: u64, samples: u32, radiance: Vec3) -> [Image; 2] {
        let mut random = Random(seed);
        let (mut half, mut whole) = (Vec::new(), Vec::new());
        for pixel in 0..SIZE.0 * SIZE.1 {
            let spread = 0.1 + (pixel % SIZE.0) as f32 / SIZE.0 as f32;
            let mut mean = |n: u32| (0..n).map(|_| spread * (random.next() - 0.5)).sum::<f32>() / n as f32;
            let [first, second] = [mean(samples / 2), mean(samples / 2)];
            half.push(radiance + first);
            whole.push(radiance + 0.5 * (first + second));
        }
        [half, whole].map(|radiances| Image::new(SIZE.0, SIZE.1, radiances).unwrap())
    }

    /// The share of pixels that are told to be noise, of two pictures of these radiances.
    fn share_within(radiances: [Vec3; 2]) -> f32 {
        let [[half_a, a], [half_b, b]] = [halves(1, 16, radiances[0]), halves(2, 16, radiances[1])];
        let variance = |half: &Image, whole: &Image| variance_by_parts(half, whole, (8, 16)).unwrap().unwrap();
        let variances = [variance(&half_a, &a), variance(&half_b, &b)];
        let within = within_noise(&a, &b, [Some(&variances[0]), Some(&variances[1])]).unwrap();
        within.iter().filter(|within| **within).count() as f32 / within.len() as f32
    }

    /// A normal variable is within two standard deviations with 95.4 %. 4096 pixels tell that to 1 % at three standard
    /// deviations, and that the variances are estimates takes another 1 %.
    #[test]
    fn of_two_pictures_of_the_same_95_of_100_pixels_are_noise() {
        let share = share_within([Vec3::splat(0.5); 2]);
        assert!((share - 0.95).abs() < 0.02, "{share}");
    }

    /// The widest noise has a standard error of .11 between the two.
    #[test]
    fn a_true_difference_is_not_noise_and_neither_is_a_change_of_hue() {
        let grey = Vec3::splat(0.5);
        assert!(share_within([grey, grey + 0.5]) < 0.01);
        assert!(share_within([grey, grey + Vec3::new(0.5, -0.5, 0.0)]) < 0.1, "its mean over the channels is 0");
    }

    #[test]
    fn any_part_tells_the_same_variance() {
        let ([_, few], [_, more]) = (halves(3, 4, Vec3::ONE), halves(4, 12, Vec3::ONE));
        let joined = few.radiances().iter().zip(more.radiances()).map(|(a, b)| (*a + *b * 3.0) / 4.0);
        let all = Image::new(SIZE.0, SIZE.1, joined.collect::<Vec<_>>()).unwrap();
        let mean = |part: &Image, samples| {
            let variance = variance_by_parts(part, &all, (samples, 16)).unwrap().unwrap();
            variance.iter().map(|v| v.x).sum::<f32>() / variance.len() as f32
        };
        // both are the variance of 16 samples
        let ratio = mean(&few, 4) / mean(&more, 12);
        assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    }

    #[test]
    fn what_has_no_noise_differs_wherever_it_differs_at_all() {
        let [exact, other] = [[0.5, 0.5], [0.5, 0.5001]].map(|v| Image::new(2, 1, v.map(Vec3::splat)).unwrap());
        assert_eq!(within_noise(&exact, &other, [None, None]), Ok(vec![true, false]));
        assert_eq!(variance_by_parts(&exact, &other, (8, 8)), Ok(None));
    }

    #[test]
    fn pixels_at_the_edge_take_what_neighbours_there_are() {
        let mut values = vec![Vec3::ZERO; 12];
        values[0] = Vec3::splat(9.0);
        let smoothed = smoothed(&values, 4);
        assert_eq!([smoothed[0].x, smoothed[2].x, smoothed[3].x, smoothed[8].x], [1.0, 0.75, 0.0, 1.0]);
    }
}
