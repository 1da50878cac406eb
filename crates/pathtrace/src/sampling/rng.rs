//! Random words as a function of four words: PCG4D of Jarzynski and Olano, "Hash Functions for
//! GPU Rendering" (JCGT 9(3), 2020). 32-bit integers alone, so that a shader computes the same bits.
//!
//! Twin: `shaders/pathtrace/sampling/rng.wgsl`, bit for bit.

use simd::Word;

/// Four well mixed words from four words.
#[inline(always)]
pub fn pcg4d<U: Word>([x, y, z, w]: [U; 4]) -> [U; 4] {
    let [x, y, z, w] = mix([step(x), step(y), step(z), step(w)]);
    mix([folded(x), folded(y), folded(z), folded(w)])
}

/// One step of a linear congruential generator.
#[inline(always)]
fn step<U: Word>(word: U) -> U {
    word.wrapping_mul(U::splat(1_664_525)).wrapping_add(U::splat(1_013_904_223))
}

/// The upper half acts on the lower.
#[inline(always)]
fn folded<U: Word>(word: U) -> U {
    word ^ word.shr::<16>()
}

#[inline(always)]
fn mix<U: Word>(mut v: [U; 4]) -> [U; 4] {
    v[0] = v[0].wrapping_add(v[1].wrapping_mul(v[3]));
    v[1] = v[1].wrapping_add(v[2].wrapping_mul(v[0]));
    v[2] = v[2].wrapping_add(v[0].wrapping_mul(v[1]));
    v[3] = v[3].wrapping_add(v[1].wrapping_mul(v[2]));
    v
}

/// A float in [0, 1) from the high 24 bits: 32 bits would round up to 1.
#[inline(always)]
pub fn unit_float<U: Word>(word: U) -> U::F {
    word.shr::<8>().to_float() * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_stay_below_one() {
        assert!(unit_float(u32::MAX) < 1.0);
        assert_eq!(unit_float(0), 0.0);
    }
}
