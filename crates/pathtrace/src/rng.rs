//! Random numbers as a function of (pixel, sample, dimension, seed): PCG4D of Jarzynski and Olano, "Hash Functions for
//! GPU Rendering" (JCGT 9(3), 2020). 32-bit integers alone, so that a shader computes the same bits.

/// Four well mixed words from four words.
pub fn pcg4d(mut v: [u32; 4]) -> [u32; 4] {
    for word in &mut v {
        *word = word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    }
    mix(&mut v);
    for word in &mut v {
        *word ^= *word >> 16;
    }
    mix(&mut v);
    v
}

fn mix(v: &mut [u32; 4]) {
    v[0] = v[0].wrapping_add(v[1].wrapping_mul(v[3]));
    v[1] = v[1].wrapping_add(v[2].wrapping_mul(v[0]));
    v[2] = v[2].wrapping_add(v[0].wrapping_mul(v[1]));
    v[3] = v[3].wrapping_add(v[1].wrapping_mul(v[2]));
}

/// A float in [0, 1) from the high 24 bits: 32 bits would round up to 1.
pub fn unit_float(word: u32) -> f32 {
    (word >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// The random numbers of one sample of one pixel.
#[derive(Debug, Clone, Copy)]
pub struct Sampler {
    /// Row-major index of the pixel.
    pub pixel: u32,
    /// Index of the sample within the pixel.
    pub sample: u32,
    /// The picture's seed.
    pub seed: u32,
}

impl Sampler {
    /// Four independent floats in [0, 1). Each use of randomness along a path has a `dimension` of its own.
    pub fn unit4(&self, dimension: u32) -> [f32; 4] {
        pcg4d([self.pixel, self.sample, dimension, self.seed]).map(unit_float)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_stay_below_one() {
        assert!(unit_float(u32::MAX) < 1.0);
        assert_eq!(unit_float(0), 0.0);
    }

    /// Neighbouring pixels, samples and dimensions are uncorrelated: |r| < 4 / sqrt(N), the bound of a fair generator
    /// at four standard deviations.
    #[test]
    fn neighbouring_streams_do_not_correlate() {
        let n = 100_000u32;
        let stream = |p: u32, d: u32, seed: u32| (0..n).map(move |s| Sampler { pixel: p, sample: s, seed }.unit4(d)[0]);
        let base: Vec<f32> = stream(7, 1, 3).collect();
        for other in [stream(8, 1, 3), stream(7, 2, 3), stream(7, 1, 4)] {
            let covariance: f64 =
                base.iter().zip(other).map(|(a, b)| (f64::from(*a) - 0.5) * (f64::from(b) - 0.5)).sum::<f64>()
                    / f64::from(n);
            assert!((covariance * 12.0).abs() < 4.0 / f64::from(n).sqrt());
        }
    }
}
