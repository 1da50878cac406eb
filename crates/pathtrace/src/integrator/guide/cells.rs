//! Cells of surfaces that learn one distribution each: where a point lies in the scene's box, and which way its normal
//! points. They know no shapes, so that walls, spheres and meshes are all alike.

use crate::vectors::in_all_lanes;
use scene::Vec3;
use simd::{Float, Vector, Word};

/// Cells along each axis of the scene's box.
const ALONG_AXIS: u32 = 8;
/// Normals are told apart by their largest component and its sign.
const FACINGS: u32 = 6;

/// How many cells there are.
pub const CELLS: u32 = ALONG_AXIS * ALONG_AXIS * ALONG_AXIS * FACINGS;

/// The scene's box in cells.
#[derive(Debug, Clone, Copy)]
pub struct Cells {
    lower: Vec3,
    per_unit: Vec3,
}

impl Cells {
    /// Of the box between two corners; an axis along which it has no extent is one cell.
    pub fn new((lower, upper): (Vec3, Vec3)) -> Self {
        let per_unit = (upper - lower).to_array().map(|e| if e > 0.0 { ALONG_AXIS as f32 / e } else { 0.0 });
        Cells { lower, per_unit: Vec3::from_array(per_unit) }
    }

    /// The cell of a surface's point, by its normal on the side that the path came from.
    #[inline(always)]
    pub fn of<F: Float>(&self, position: Vector<F>, normal: Vector<F>) -> F::U {
        let along = (position - in_all_lanes(self.lower)) * in_all_lanes(self.per_unit);
        let last = F::splat(ALONG_AXIS as f32 - 1.0);
        let (x, y, z) = (place(along.x, last), place(along.y, last), place(along.z, last));
        let side = F::U::splat(ALONG_AXIS);
        let voxel = z.wrapping_mul(side).wrapping_add(y).wrapping_mul(side).wrapping_add(x);
        voxel.wrapping_mul(F::U::splat(FACINGS)).wrapping_add(facing(normal))
    }
}

/// A coordinate in cells, as the number of one; what is no number belongs to the first.
#[inline(always)]
fn place<F: Float>(along: F, last: F) -> F::U {
    along.clamp(F::splat(0.0), last).floor().to_word()
}

/// 0 and 1 for normals along x, 2 and 3 along y, 4 and 5 along z; the odd ones point down the axis.
#[inline(always)]
fn facing<F: Float>(normal: Vector<F>) -> F::U {
    let size = normal.abs();
    let along_x = size.x.ge(size.y) & size.x.ge(size.z);
    let along_y = !along_x & size.y.ge(size.z);
    let number = |n: u32| F::U::splat(n);
    let axis = F::U::select(along_x, number(0), F::U::select(along_y, number(2), number(4)));
    let component = F::select(along_x, normal.x, F::select(along_y, normal.y, normal.z));
    axis.wrapping_add(F::U::select(component.lt(F::splat(0.0)), number(1), number(0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vectors::lane_vector;

    fn cell(cells: &Cells, position: Vec3, normal: Vec3) -> u32 {
        cells.of(lane_vector(position), lane_vector(normal))
    }

    #[test]
    fn points_and_sides_are_told_apart_and_none_is_outside() {
        let cells = Cells::new((Vec3::splat(-1.0), Vec3::new(1.0, 1.0, -1.0)));
        let middles = (0..ALONG_AXIS).map(|i| (i as f32 + 0.5) * 0.25 - 1.0);
        let mut all: Vec<u32> = Vec::new();
        for (x, y) in middles.clone().flat_map(|x| middles.clone().map(move |y| (x, y))) {
            for normal in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z] {
                all.push(cell(&cells, Vec3::new(x, y, -1.0), normal));
            }
        }
        assert!(all.iter().all(|&cell| cell < CELLS));
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        for odd in [Vec3::splat(2.0), Vec3::splat(-2.0), Vec3::splat(f32::NAN), Vec3::splat(f32::INFINITY)] {
            assert!(cell(&cells, odd, odd) < CELLS, "{odd}");
        }
    }
}
