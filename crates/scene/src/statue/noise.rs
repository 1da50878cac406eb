//! Value noise from hashes of whole numbers: the same bits on every machine, for it adds, multiplies and rounds down only.

use glam::Vec3;

/// Mixes the bits of a lattice point: C. Wellons, lowbias32 of "Prospecting for hash functions", 2018.
fn hash([x, y, z]: [i32; 3]) -> u32 {
    let [x, y, z] = [x as u32, y as u32, z as u32];
    let mut bits = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ z.wrapping_mul(0xc2b2_ae3d);
    bits = (bits ^ (bits >> 16)).wrapping_mul(0x7feb_352d);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x846c_a68b);
    bits ^ (bits >> 16)
}

/// From -1 to 1 at a lattice point.
fn value(at: [i32; 3]) -> f32 {
    // 24 bits are what an f32 holds exactly
    (hash(at) >> 8) as f32 * (2.0 / 16_777_215.0) - 1.0
}

/// Smooth noise from -1 to 1 that changes over a length of 1.
pub fn noise(at: Vec3) -> f32 {
    let corner = at.floor();
    let ([i, j, k], inside) = (corner.to_array().map(|v| v as i32), at - corner);
    let [x, y, z] = (inside * inside * (3.0 - 2.0 * inside)).to_array();
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let along_x = |dy, dz| mix(value([i, j + dy, k + dz]), value([i + 1, j + dy, k + dz]), x);
    mix(mix(along_x(0, 0), along_x(1, 0), y), mix(along_x(0, 1), along_x(1, 1), y), z)
}

/// The sum of eight noises, each of half the length and half the height of the one before; the first changes over a
/// length of 1 and is at most 1 high.
pub fn octaves(at: Vec3) -> f32 {
    (0..8u8).fold((0.0, at, 1.0), |(sum, at, height), _| (sum + height * noise(at), at * 2.0 + 17.5, height * 0.5)).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_bounded_centred_and_has_no_jumps() {
        let places = (0..20_000).map(|i| Vec3::new(i as f32 * 0.01, i as f32 * 0.0037, 5.0 - i as f32 * 0.002));
        let values: Vec<f32> = places.map(noise).collect();
        assert!(values.iter().all(|v| v.abs() <= 1.0));
        // 200 cells of spread 1/3: four standard errors of the mean
        assert!(values.iter().sum::<f32>().abs() / 20_000.0 < 4.0 * 0.58 / 200f32.sqrt());
        assert!(values.windows(2).all(|v| (v[0] - v[1]).abs() < 0.06));
    }
}
