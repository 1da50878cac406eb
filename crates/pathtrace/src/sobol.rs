//! Owen-scrambled Sobol points by hashing: Burley, "Practical Hash-based Owen Scrambling" (JCGT 9(4), 2020), with the hash of
//! Vegdahl, "Building a Better LK Hash" (2021). Points of four dimensions; more dimensions are padded with points whose
//! order is shuffled anew, which works for any number of samples and dimensions.

/// Initial direction numbers of Joe and Kuo for dimensions 2 to 4: degree, coefficients and m of the primitive polynomial.
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

/// What each byte of the index adds to the bit-reversed point.
type ByteTables = [[u32; 256]; 4];

const fn byte_tables(polynomial: (usize, u32, [u32; 3])) -> ByteTables {
    let v = directions(polynomial);
    let mut tables = [[0u32; 256]; 4];
    let mut byte = 0;
    while byte < 4 {
        let mut value = 0;
        while value < 256 {
            let mut bit = 0;
            while bit < 8 {
                if (value >> bit) & 1 == 1 {
                    tables[byte][value] ^= v[8 * byte + bit].reverse_bits();
                }
                bit += 1;
            }
            value += 1;
        }
        byte += 1;
    }
    tables
}

static TABLES: [ByteTables; 3] =
    [byte_tables(POLYNOMIALS[0]), byte_tables(POLYNOMIALS[1]), byte_tables(POLYNOMIALS[2])];

/// A nested uniform permutation of bit-reversed numbers: each bit is flipped or not by a hash of the lower ones.
#[inline]
fn permute_reversed(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Coordinate `dimension` (1 to 3) of the point `index`, bit-reversed.
#[inline]
fn reversed_point(index: u32, dimension: usize) -> u32 {
    let tables = &TABLES[dimension - 1];
    let [a, b, c, d] = index.to_le_bytes();
    tables[0][a as usize] ^ tables[1][b as usize] ^ tables[2][c as usize] ^ tables[3][d as usize]
}

/// Four coordinates of point `sample` of the sequence whose order and digits are scrambled by `seeds`, as 32-bit
/// fractions.
#[inline(never)]
pub fn shuffled_scrambled(sample: u32, seeds: [u32; 4]) -> [u32; 4] {
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

    /// The first points, unscrambled and in the order of the Gray code, as SciPy and Joe and Kuo's own program list them.
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
