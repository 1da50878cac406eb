//! How bright the pixels of a picture are, counted by stops.

use film::{Vec3, colour};

/// Bins to a stop: each doubles the light of as many before it.
const BINS_PER_STOP: f32 = 4.0;
/// Stops below and above a luminance of 1 that have bins.
const STOPS: (f32, f32) = (-14.0, 14.0);
const BINS: usize = ((STOPS.1 - STOPS.0) * BINS_PER_STOP) as usize;

/// Pixels counted by their luminance.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    counts: [u32; BINS],
    /// Pixels that are darker than all bins, black ones among them.
    pub darker: u32,
    /// Pixels that are brighter than all bins, or not finite.
    pub brighter: u32,
}

impl Histogram {
    /// Counts these pixels by their luminance.
    pub fn of<'a>(radiances: impl Iterator<Item = &'a Vec3>) -> Self {
        let mut histogram = Histogram { counts: [0; BINS], darker: 0, brighter: 0 };
        for radiance in radiances {
            let bin = (colour::luminance(*radiance).log2() - STOPS.0) * BINS_PER_STOP;
            if !radiance.is_finite() {
                histogram.brighter += 1;
            } else if bin >= 0.0 {
                *histogram.counts.get_mut(bin as usize).unwrap_or(&mut histogram.brighter) += 1;
            } else {
                // the logarithm of what is negative is not a number
                histogram.darker += 1;
            }
        }
        histogram
    }

    /// The edges of each bin that has pixels, in stops from a luminance of 1, and how many it has.
    pub fn bins(&self) -> impl Iterator<Item = ([f32; 2], u32)> {
        let edges = |bin: usize| [bin, bin + 1].map(|edge| STOPS.0 + edge as f32 / BINS_PER_STOP);
        self.counts.iter().enumerate().filter(|(_, count)| **count > 0).map(move |(bin, count)| (edges(bin), *count))
    }

    /// The stop that half of the pixels do not exceed, to a bin; `None` if half of them are darker than all bins.
    pub fn median(&self) -> Option<f32> {
        let all: u64 = self.counts.iter().map(|count| u64::from(*count)).sum();
        let half = (all + u64::from(self.darker) + u64::from(self.brighter)).div_ceil(2);
        let mut below = u64::from(self.darker);
        if below >= half {
            return None;
        }
        let reaches = |(_, count): &([f32; 2], u32)| {
            below += u64::from(*count);
            below >= half
        };
        self.bins().find(reaches).map(|([low, high], _)| 0.5 * (low + high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(greys: &[f32]) -> Histogram {
        Histogram::of(greys.iter().map(|grey| Vec3::splat(*grey)).collect::<Vec<_>>().iter())
    }

    #[test]
    fn each_pixel_is_in_the_bin_of_its_stop() {
        let bins: Vec<_> = of(&[1.01, 1.1, 0.26, 2.1, 1.01]).bins().collect();
        assert_eq!(bins, [([-2.0, -1.75], 1), ([0.0, 0.25], 3), ([1.0, 1.25], 1)]);
        let twice: Vec<_> = of(&[2.02, 2.2, 0.52, 4.2, 2.02]).bins().collect();
        assert_eq!(
            twice.iter().map(|([low, _], _)| low - 1.0).collect::<Vec<_>>(),
            [-2.0, 0.0, 1.0],
            "a stop brighter"
        );
    }

    #[test]
    fn black_negative_huge_and_broken_pixels_are_counted_apart() {
        let histogram = of(&[0.0, -1.0, 1e-6, 1e6, f32::INFINITY, f32::NAN]);
        assert_eq!((histogram.darker, histogram.brighter, histogram.bins().count()), (3, 3, 0));
    }

    #[test]
    fn half_of_the_pixels_lie_below_the_median() {
        assert_eq!(of(&[0.26, 1.1, 4.1]).median(), Some(0.125));
        assert_eq!(of(&[0.26, 1.1, 4.1, 4.2, 4.1]).median(), Some(2.125));
        assert_eq!(of(&[0.0, 0.0, 1.0]).median(), None, "black");
    }
}
