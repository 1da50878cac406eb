//! Photons of one pass where they have landed, sorted by the cells of a hashed grid: Teschner et al., "Optimized Spatial
//! Hashing for Collision Detection of Deformable Objects" (2003).
//!
//! Twins: `shaders/pathtrace/integrator/photon/map.wgsl`, sort.wgsl, where threads sort together, and eye.wgsl, which gathers.

use crate::drive::lanes::Stop;
use rayon::prelude::*;
use scene::Vec3;
use std::f32::consts::FRAC_1_PI;
use std::ops::RangeInclusive;

/// Light that has arrived at a diffuse surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Photon {
    /// Where it was left, in world space.
    pub position: Vec3,
    /// Unit normal on the side that the photon came from.
    pub normal: Vec3,
    /// What it carries of its light's power, RGB.
    pub power: Vec3,
}

/// Cosine between two normals below which their surfaces are not one: photons of the next wall of a corner, or of the
/// other side of a thin one, are left out.
pub(crate) const ONE_SURFACE: f32 = 0.5;

/// The photons of a pass, with the radius in which they are gathered.
pub struct PhotonMap {
    /// Bucket after bucket, and in each in the order in which they were given.
    photons: Vec<Photon>,
    /// Where each bucket begins, and where the last one ends.
    starts: Vec<u32>,
    grid: Grid,
    radius: f32,
}

/// Cells as wide as a disc of photons, so that at most two of them along each axis hold what is within the radius.
#[derive(Debug, Clone, Copy)]
struct Grid {
    origin: Vec3,
    cells_per_unit: f32,
    /// Buckets less one, a power of two less one.
    mask: u32,
}

impl Grid {
    /// Growing with the coordinate, whatever is rounded: what lies between two points lies between their cells.
    fn cell(&self, at: Vec3) -> [i32; 3] {
        ((at - self.origin) * self.cells_per_unit).floor().to_array().map(|index| index as i32)
    }

    fn bucket(&self, [x, y, z]: [i32; 3]) -> u32 {
        let of = |index: i32, prime: u32| (index as u32).wrapping_mul(prime);
        let hash = of(x, 73_856_093) ^ of(y, 19_349_663) ^ of(z, 83_492_791);
        (hash ^ (hash >> 15)) & self.mask
    }

    fn buckets_of(&self, photons: &[Photon]) -> Vec<u32> {
        photons.iter().map(|photon| self.bucket(self.cell(photon.position))).collect()
    }

    /// The buckets of all cells between two, each once: cells may share one.
    fn buckets(&self, from: [i32; 3], to: [i32; 3]) -> ([u32; MOST_CELLS], usize) {
        let along = |axis: usize| -> RangeInclusive<i32> { from[axis]..=to[axis].min(from[axis].saturating_add(2)) };
        let (mut buckets, mut count) = ([0; MOST_CELLS], 0);
        for z in along(2) {
            for y in along(1) {
                for x in along(0) {
                    let bucket = self.bucket([x, y, z]);
                    if !buckets[..count].contains(&bucket) {
                        buckets[count] = bucket;
                        count += 1;
                    }
                }
            }
        }
        (buckets, count)
    }
}

/// Two along each axis; where coordinates are rounded to the size of cells, three.
pub(crate) const MOST_CELLS: usize = 27;

impl PhotonMap {
    /// Sorts photons, for which the order in which they come is kept: sums do not depend on who has traced them. Chunks of
    /// them go as soon as they are sorted, so that they are in memory twice at most. `None` where it was stopped.
    pub fn new(chunks: Vec<Vec<Photon>>, radius: f32, stop: &Stop) -> Option<Self> {
        let count: usize = chunks.iter().map(Vec::len).sum();
        let origin = chunks.iter().flatten().fold(Vec3::INFINITY, |least, photon| least.min(photon.position));
        let mask = (count.next_power_of_two() as u32).saturating_sub(1);
        let grid = Grid { origin, cells_per_unit: 0.5 / radius, mask };
        let buckets: Vec<Vec<u32>> = chunks.par_iter().map(|chunk| grid.buckets_of(chunk)).collect();
        let mut starts = vec![0; mask as usize + 2];
        for bucket in buckets.iter().flatten() {
            starts[*bucket as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut photons = vec![Photon::default(); count];
        for (chunk, buckets) in chunks.into_iter().zip(buckets) {
            if stop() {
                return None;
            }
            for (photon, bucket) in chunk.into_iter().zip(buckets) {
                let place = &mut starts[bucket as usize];
                photons[*place as usize] = photon;
                *place += 1;
            }
        }
        // each bucket's place has moved on to where the next one begins
        starts.rotate_right(1);
        starts[0] = 0;
        Some(PhotonMap { photons, starts, grid, radius })
    }

    /// Irradiance on the side of a surface: the power of the photons within the radius over the disc's area, a constant
    /// kernel. Too little at edges and too much in corners, and blurred everywhere: that is the bias of photon mapping.
    pub fn irradiance(&self, at: Vec3, normal: Vec3) -> Vec3 {
        let within = self.radius * self.radius;
        let reach = Vec3::splat(self.radius);
        let (buckets, count) = self.grid.buckets(self.grid.cell(at - reach), self.grid.cell(at + reach));
        let mut power = Vec3::ZERO;
        for bucket in &buckets[..count] {
            let [first, end] = [0, 1].map(|i| self.starts[*bucket as usize + i] as usize);
            for photon in &self.photons[first..end] {
                if (photon.position - at).length_squared() < within && photon.normal.dot(normal) > ONE_SURFACE {
                    power += photon.power;
                }
            }
        }
        power * (FRAC_1_PI / within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::rng::{pcg4d, unit_float};

    fn scattered(count: u32, around: Vec3) -> Vec<Photon> {
        let one = |i: u32| {
            let [x, y, z, side] = pcg4d([i, 3, 1, 4]).map(unit_float);
            let normal = if side < 0.3 { Vec3::Y } else { Vec3::NEG_Y };
            Photon { position: around + Vec3::new(x, 0.1 * y, z), normal, power: Vec3::new(1.0, x, z) }
        };
        (0..count).map(one).collect()
    }

    fn one_by_one(photons: &[Photon], radius: f32, at: Vec3, normal: Vec3) -> Vec3 {
        let near =
            |photon: &&Photon| (photon.position - at).length() < radius && photon.normal.dot(normal) > ONE_SURFACE;
        photons.iter().filter(near).map(|photon| photon.power).sum::<Vec3>() * (FRAC_1_PI / (radius * radius))
    }

    #[test]
    fn what_is_gathered_is_all_that_lies_within_the_radius_and_faces_the_same_way() {
        for around in [Vec3::ZERO, Vec3::new(-1e5, 2e4, 3e5)] {
            let photons = scattered(5000, around);
            for radius in [1e-3, 0.03, 0.2, 3.0] {
                let chunks = photons.chunks(1234).map(<[Photon]>::to_vec).collect();
                let map = PhotonMap::new(chunks, radius, &|| false).expect("nobody stops it");
                for photon in photons.iter().step_by(97) {
                    let at = photon.position + Vec3::splat(0.3 * radius);
                    let expected = one_by_one(&photons, radius, at, Vec3::Y);
                    let gathered = map.irradiance(at, Vec3::Y);
                    assert!(
                        (gathered - expected).abs().max_element() <= 1e-5 * expected.max_element(),
                        "{around} {radius}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_map_without_photons_is_dark() {
        let map = PhotonMap::new(Vec::new(), 0.1, &|| false).expect("nobody stops it");
        assert_eq!(map.irradiance(Vec3::ONE, Vec3::Y), Vec3::ZERO);
    }
}
