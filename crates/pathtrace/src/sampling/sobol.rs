//! Owen-scrambled Sobol points by hashing: Burley, "Practical Hash-based Owen Scrambling" (JCGT 9(4), 2020), with the
//! hash of Vegdahl, "Building a Better LK Hash" (2021). Points of four dimensions; more dimensions are padded with
//! points whose order is shuffled anew, which works for any number of samples and dimensions.
//!
//! Twin: `shaders/pathtrace/sampling/sobol.wgsl`, bit for bit.

use simd::{BitMatrix, Word};

/// Initial direction numbers of Joe and Kuo for dimensions 2 to 4: degree, coefficients and m of the primitive
/// polynomial.
const POLYNOMIALS: [(usize, u32, [u32; 3]); 3] = [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])];

/// Direction numbers of a dimension: what bit `i` of the index adds to the point, most significant bit first.
const fn directions((degree, coefficients, initial): (usize, u32, [u32; 3])) -> [u32; 32] {
    let mut v = [0u32; 32];
    let mut i = 0;
    while i < 32 {
        if i < degree {
            v[i] = initial[i] << (31 - i);
        } else {
            v[i] = v[i - degree] ^ (v[i - degree] >> degree);
            let mut k = 1;
            while k < degree {
                if (coefficients >> (degree - 1 - k)) & 1 == 1 {
                    v[i] ^= v[i - k];
                }
                k += 1;
            }
        }
        i += 1;
    }
    v
}

/// The matrix that takes an index to a point, bit-reversed.
const fn reversed_matrix(polynomial: (usize, u32, [u32; 3])) -> BitMatrix {
    let mut columns = directions(polynomial);
    let mut i = 0;
    while i < 32 {
        columns[i] = columns[i].reverse_bits();
        i += 1;
    }
    BitMatrix::new(&columns)
}

static MATRICES: [BitMatrix; 3] =
    [reversed_matrix(POLYNOMIALS[0]), reversed_matrix(POLYNOMIALS[1]), reversed_matrix(POLYNOMIALS[2])];

/// A nested uniform permutation of bit-reversed numbers: each bit is flipped or not by a hash of the lower ones.
#[inline(always)]
fn permute_reversed<U: Word>(x: U, seed: U) -> U {
    let x = x ^ x.wrapping_mul(U::splat(0x3d20_adea));
    let x = x.wrapping_add(seed);
    let x = x.wrapping_mul(seed.shr::<16>() | U::splat(1));
    let x = x ^ x.wrapping_mul(U::splat(0x0552_6c56));
    x ^ x.wrapping_mul(U::splat(0x53a2_2864))
}

/// Coordinate `dimension` (1 to 3) of the point `index`, bit-reversed.
#[inline(always)]
pub(crate) fn reversed_point<U: Word>(index: U, dimension: usize) -> U {
    index.multiplied_by(&MATRICES[dimension - 1])
}

/// Four coordinates of point `sample` of the sequence whose order and digits are scrambled by `seeds`, as 32-bit
/// fractions.
#[inline(always)]
pub fn shuffled_scrambled<U: Word>(sample: U, seeds: [U; 4]) -> [U; 4] {
    let index = permute_reversed(sample.reverse_bits(), seeds[0]).reverse_bits();
    [
        // the first dimension is the index itself, bit-reversed
        permute_reversed(index, !seeds[0]).reverse_bits(),
        permute_reversed(reversed_point(index, 1), seeds[1]).reverse_bits(),
        permute_reversed(reversed_point(index, 2), seeds[2]).reverse_bits(),
        permute_reversed(reversed_point(index, 3), seeds[3]).reverse_bits(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first points, unscrambled and in the order of the Gray code, as SciPy and Joe and Kuo's own program list
    /// them.
    #[test]
    fn points_are_sobols() {
        let expected = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.25, 0.25, 0.25],
            [0.75, 0.75, 0.75],
            [0.375, 0.625, 0.875],
            [0.875, 0.125, 0.375],
            [0.125, 0.875, 0.625],
            [0.625, 0.375, 0.125],
        ];
        for (i, point) in (0u32..).zip(expected) {
            let gray_code = i ^ (i >> 1);
            for dimension in 1..4 {
                let got = f64::from(reversed_point(gray_code, dimension).reverse_bits()) / 4_294_967_296.0;
                assert_eq!(got, point[dimension - 1], "point {i}, dimension {dimension}");
            }
        }
    }
}
