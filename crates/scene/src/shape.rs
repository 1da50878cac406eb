//! Shapes and what a material sits on. Flat shapes become triangles for whoever wants triangles; spheres stay analytic.

use glam::Vec3;

/// A piece of geometry with a material.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// What it is and where.
    pub geometry: Geometry,
    /// Index into [`crate::Scene::materials`].
    pub material: usize,
}

/// Geometry in world space.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// An analytic sphere; its normal points outwards.
    Sphere {
        /// Centre.
        center: Vec3,
        /// Radius, > 0.
        radius: f32,
    },
    /// A parallelogram; its normal is `edge_u x edge_v`.
    Rectangle {
        /// One corner.
        corner: Vec3,
        /// From that corner to the next.
        edge_u: Vec3,
        /// From that corner to the other next.
        edge_v: Vec3,
    },
    /// A box turned about the vertical; its normals point outwards.
    Box {
        /// The corner of the unturned box with the smallest coordinates; the box turns about it.
        corner: Vec3,
        /// Extent along x, y, z before turning, each > 0.
        size: Vec3,
        /// Turn in degrees: (x, z) becomes (x cos - z sin, x sin + z cos).
        turn_y: f32,
    },
    /// Triangles with shared corners; normals follow the winding (counter-clockwise seen from outside).
    Mesh {
        /// Corners.
        positions: Vec<Vec3>,
        /// Three indices into `positions` for each triangle.
        triangles: Vec<[u32; 3]>,
    },
}

impl Geometry {
    /// Smallest axis-parallel box: (lower corner, upper corner).
    pub fn bounds(&self) -> (Vec3, Vec3) {
        if let Geometry::Sphere { center, radius } = self {
            return (*center - Vec3::splat(*radius), *center + Vec3::splat(*radius));
        }
        let (positions, _) = self.flat_triangles();
        positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)))
    }

    /// Middle of the bounds.
    pub fn center(&self) -> Vec3 {
        let (lo, hi) = self.bounds();
        0.5 * (lo + hi)
    }

    /// Corners and triangles of a flat shape, wound so that `(b - a) x (c - a)` is its normal; nothing for a sphere.
    pub fn flat_triangles(&self) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        match self {
            Geometry::Sphere { .. } => (Vec::new(), Vec::new()),
            Geometry::Rectangle { corner, edge_u, edge_v } => {
                let p = [*corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v];
                (p.to_vec(), vec![[0, 1, 2], [0, 2, 3]])
            }
            Geometry::Box { corner, size, turn_y } => box_triangles(*corner, *size, *turn_y),
            Geometry::Mesh { positions, triangles } => (positions.clone(), triangles.clone()),
        }
    }
}

fn box_triangles(corner: Vec3, size: Vec3, turn_y: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (sin, cos) = turn_y.to_radians().sin_cos();
    let positions = (0..8u8).map(|i| {
        let unit = Vec3::new(f32::from(i & 1), f32::from(i >> 1 & 1), f32::from(i >> 2 & 1));
        let p = size * unit;
        corner + Vec3::new(p.x * cos - p.z * sin, p.y, p.x * sin + p.z * cos)
    });
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (positions.collect(), faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_of_a_turned_box_points_outwards() {
        let shape = Geometry::Box { corner: Vec3::new(1.0, 2.0, 3.0), size: Vec3::new(2.0, 3.0, 4.0), turn_y: 30.0 };
        let (p, triangles) = shape.flat_triangles();
        let middle = p.iter().sum::<Vec3>() / 8.0;
        assert_eq!(triangles.len(), 12);
        let mut area = 0.0;
        for [a, b, c] in triangles.map_corners(&p) {
            let normal = (b - a).cross(c - a);
            area += 0.5 * normal.length();
            assert!(normal.dot(a - middle) > 0.0);
        }
        assert!((area - 52.0).abs() < 1e-4);
    }

    trait Corners {
        fn map_corners(&self, p: &[Vec3]) -> Vec<[Vec3; 3]>;
    }
    impl Corners for Vec<[u32; 3]> {
        fn map_corners(&self, p: &[Vec3]) -> Vec<[Vec3; 3]> {
            self.iter().map(|t| t.map(|i| p[i as usize])).collect()
        }
    }
}
