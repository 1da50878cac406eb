//! Random words as a function of four words: PCG4D of Jarzynski and Olano, "Hash Functions for
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_stay_below_one() {
        assert!(unit_float(u32::MAX) < 1.0);
        assert_eq!(unit_float(0), 0.0);
    }
}
