//! Shading normals of triangles that came without.

use glam::Vec3;

/// A unit normal at each position: the mean of those of its triangles, weighed by their areas and by their angles there
/// (G. Thürmer and C. A. Wüthrich, "Computing vertex normals from polygonal facets", 1998), so that it hardly depends on
/// how a surface was cut up. Zero where there is no triangle with an area.
pub fn smooth_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let twice_the_area = ab.cross(-ca);
        let sides = [ab, bc, ca].map(Vec3::normalize_or_zero);
        let cosines = [-sides[0].dot(sides[2]), -sides[1].dot(sides[0]), -sides[2].dot(sides[1])];
        for (corner, cosine) in triangle.iter().zip(cosines) {
            normals[*corner as usize] += angle(cosine) * twice_the_area;
        }
    }
    normals.iter_mut().for_each(|normal| *normal = normal.normalize_or_zero());
    normals
}

/// The arc cosine to 7e-5 (M. Abramowitz and I. Stegun, "Handbook of Mathematical Functions", 4.4.45), which is the same
/// number on every machine.
fn angle(cosine: f32) -> f32 {
    let x = cosine.abs().min(1.0);
    let of_positive = (1.0 - x).sqrt() * (((-0.0187293 * x + 0.0742610) * x - 0.2121144) * x + 1.5707288);
    if cosine < 0.0 { std::f32::consts::PI - of_positive } else { of_positive }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_is_the_arc_cosine() {
        for i in -100..=100 {
            let cosine = i as f32 / 100.0;
            assert!((angle(cosine) - cosine.acos()).abs() < 7e-5, "{cosine}");
        }
    }

    /// A cube's corner meets one side in one triangle and another in two, which area alone would count twice.
    #[test]
    fn a_cubes_corner_has_the_normal_of_its_diagonal_however_sides_are_cut() {
        let positions: Vec<Vec3> =
            (0..8u8).map(|i| Vec3::from([i & 1, i >> 1 & 1, i >> 2 & 1].map(f32::from))).collect();
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        for (normal, position) in smooth_normals(&positions, &triangles).into_iter().zip(positions) {
            assert!(normal.dot((position - 0.5).normalize()) > 1.0 - 1e-6, "{normal} at {position}");
        }
    }

    #[test]
    fn what_has_no_area_has_no_say() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO, 2.0 * Vec3::X];
        let normals = smooth_normals(&positions, &[[0, 1, 2], [0, 3, 1], [0, 1, 4], [3, 3, 3]]);
        assert_eq!(normals, [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::ZERO, Vec3::ZERO]);
    }
}
