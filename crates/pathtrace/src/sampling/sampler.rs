//! The random numbers of a sample: independent ones, or points of a Sobol sequence that keep apart from each other.
//!
//! Both are pure functions of (pixel, sample, dimension, seed), in 32-bit integers alone. Each use of randomness along
//! a path has a dimension, a block of four numbers; of a block the first two belong together: a direction, a point on
//! an area light, a place in a pixel.
//!
//! Twin: `shaders/pathtrace/sampling/sampler.wgsl`, bit for bit.

use crate::sampling::rng::{pcg4d, unit_float};
use crate::sampling::sobol;
use simd::Word;

/// Where the random numbers of a sample come from; see the module.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SamplerKind {
    /// Each number independent of all others. The spread inside a pixel tells the error.
    Independent,
    /// Owen-scrambled Sobol points: a pixel's samples keep apart from each other, so that errors fall faster. Measured,
    /// time to a relMSE of .003: half of the independent sampler's for the Cornell box, a sixth for the spheres under a
    /// delta sun. The spread inside a pixel overstates the error then: see [`crate::estimate_with_replicates`].
    #[default]
    Sobol,
}

impl SamplerKind {
    /// All, the plainest first.
    pub const ALL: [Self; 2] = [Self::Independent, Self::Sobol];

    /// The name on the command line and in the window.
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Sobol => "sobol",
        }
    }

    /// The sampler of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|s| s.name() == name)
    }
}

/// The random numbers of one sample of one pixel, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Sampler<U = u32> {
    /// Where they come from.
    pub kind: SamplerKind,
    /// Row-major index of the pixel.
    pub pixel: U,
    /// Index of the sample within the pixel.
    pub sample: U,
    /// The picture's seed.
    pub seed: u32,
}

impl Sampler {
    /// Independent numbers.
    pub fn independent(pixel: u32, sample: u32, seed: u32) -> Self {
        Sampler { kind: SamplerKind::Independent, pixel, sample, seed }
    }
}

/// What gives random numbers along the paths in the lanes, in blocks of four.
pub trait RandomNumbers<U: Word> {
    /// Four floats in [0, 1) for the block `dimension`; the same ones however often a path asks.
    fn unit4(&self, dimension: U) -> [U::F; 4];

    /// The pixel that they are for, and which of its samples: zeros where paths belong to no pixel.
    fn pixel_and_sample(&self) -> [U; 2] {
        [U::splat(0); 2]
    }
}

impl<U: Word> RandomNumbers<U> for Sampler<U> {
    #[inline(always)]
    fn unit4(&self, dimension: U) -> [U::F; 4] {
        self.unit4(dimension)
    }

    #[inline(always)]
    fn pixel_and_sample(&self) -> [U; 2] {
        [self.pixel, self.sample]
    }
}

impl<U: Word> Sampler<U> {
    /// Four floats in [0, 1) for the block `dimension`. Blocks are independent of each other; within one, Sobol's four
    /// numbers are coordinates of one point. What of the four is not used costs nothing.
    #[inline(always)]
    pub fn unit4(&self, dimension: U) -> [U::F; 4] {
        let [a, b, c, d] = self.words4(dimension);
        [unit_float(a), unit_float(b), unit_float(c), unit_float(d)]
    }

    /// The same numbers as 32-bit fractions.
    #[inline(always)]
    pub fn words4(&self, dimension: U) -> [U; 4] {
        let seed = U::splat(self.seed);
        let sobol = self.kind == SamplerKind::Sobol;
        // the constant keeps Sobol's words apart from those of an independent sample
        let second = if sobol { U::splat(0x5eed_0b0e) } else { self.sample };
        let mut words = pcg4d([self.pixel, second, dimension, seed]);
        if sobol {
            words = sobol::shuffled_scrambled(self.sample, words);
        }
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Neighbouring pixels, dimensions and seeds are uncorrelated: |r| < 4 / sqrt(N), the bound of a fair generator at
    /// four standard deviations.
    #[test]
    fn neighbouring_streams_do_not_correlate() {
        let n = 100_000u32;
        for kind in SamplerKind::ALL {
            for word in 0..4 {
                let stream = |pixel: u32, dimension: u32, seed: u32| {
                    (0..n).map(move |sample| Sampler { kind, pixel, sample, seed }.unit4(dimension)[word])
                };
                let base: Vec<f32> = stream(7, 1, 3).collect();
                for other in [stream(8, 1, 3), stream(7, 2, 3), stream(7, 1, 4)] {
                    let products = base.iter().zip(other).map(|(a, b)| (f64::from(*a) - 0.5) * (f64::from(b) - 0.5));
                    let correlation = 12.0 * products.sum::<f64>() / f64::from(n);
                    assert!(correlation.abs() < 4.0 / f64::from(n).sqrt(), "{kind:?} {word}: {correlation}");
                }
            }
        }
    }

    /// Of the first 2^m points each elementary interval of area 2^-m holds exactly one.
    #[test]
    fn sobol_points_fill_every_elementary_interval() {
        for (pixel, dimension, seed) in [(0, 0, 1), (7, 3, 9), (123_456, 1, 2)] {
            for m in 2..=10u32 {
                for split in 0..=m {
                    let (columns, rows) = (1usize << split, 1usize << (m - split));
                    let mut seen = vec![false; columns * rows];
                    for sample in 0..1 << m {
                        let sampler = Sampler { kind: SamplerKind::Sobol, pixel, sample, seed };
                        let [x, y, ..] = sampler.unit4(dimension);
                        let cell = (x * columns as f32) as usize * rows + (y * rows as f32) as usize;
                        assert!(!std::mem::replace(&mut seen[cell], true), "2^{m} points, {columns} x {rows}");
                    }
                }
            }
        }
    }

    /// Each coordinate alone is stratified as well, also far beyond 2^16 samples.
    #[test]
    fn every_coordinate_is_stratified_also_late_in_the_sequence() {
        for start in [0u32, 1 << 20, 3 << 28] {
            let mut seen = vec![[false; 4]; 1024];
            for sample in start..start + 1024 {
                let u = Sampler { kind: SamplerKind::Sobol, pixel: 5, sample, seed: 1 }.unit4(2);
                for (axis, value) in u.into_iter().enumerate() {
                    assert!(!std::mem::replace(&mut seen[(value * 1024.0) as usize][axis], true));
                }
            }
        }
    }
}
