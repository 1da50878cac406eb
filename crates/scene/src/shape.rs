//! Shapes and what a material sits on. Flat shapes become triangles for whoever wants triangles; spheres, and disks for
//! rays, stay analytic.

use crate::mesh::{Instance, Mesh, bounds_of};
use glam::Vec3;
use std::borrow::Cow;
use std::sync::Arc;

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
    /// A flat disk.
    Disk {
        /// Centre.
        center: Vec3,
        /// Unit normal.
        normal: Vec3,
        /// Radius, > 0.
        radius: f32,
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
    /// Triangles in the world's space; shared, so that a copy of a shape costs nothing however many there are.
    Mesh(Arc<Mesh>),
    /// Triangles that are put into the world by a map.
    Instance(Instance),
}

impl Geometry {
    /// A [`Geometry::Mesh`] of its own.
    pub fn mesh(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        Geometry::Mesh(Arc::new(Mesh::new(positions, triangles)))
    }

    /// The triangles of a mesh, wherever it stands.
    pub fn mesh_of(&self) -> Option<&Arc<Mesh>> {
        match self {
            Geometry::Mesh(mesh) | Geometry::Instance(Instance { mesh, .. }) => Some(mesh),
            Geometry::Sphere { .. } | Geometry::Rectangle { .. } | Geometry::Disk { .. } | Geometry::Box { .. } => None,
        }
    }

    /// Smallest axis-parallel box: (lower corner, upper corner).
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match self {
            Geometry::Sphere { center, radius } => (center - radius, center + radius),
            Geometry::Disk { center, normal, radius } => {
                let reach = *radius * (Vec3::ONE - normal * normal).max(Vec3::ZERO).map(f32::sqrt);
                (center - reach, center + reach)
            }
            Geometry::Rectangle { .. } | Geometry::Box { .. } => bounds_of(&self.flat_triangles().0),
            Geometry::Mesh(mesh) => mesh.bounds(),
            Geometry::Instance(instance) => instance.bounds(),
        }
    }

    /// Middle of the bounds.
    pub fn center(&self) -> Vec3 {
        let (lo, hi) = self.bounds();
        0.5 * (lo + hi)
    }

    /// Corners and triangles of a flat shape, wound so that `(b - a) x (c - a)` is its normal; nothing for a sphere,
    /// and for a disk the fan of [`DISK_SEGMENTS`] triangles that stands for it where there are only triangles.
    pub fn flat_triangles(&self) -> (Cow<'_, [Vec3]>, Cow<'_, [[u32; 3]]>) {
        let (positions, triangles) = match self {
            Geometry::Sphere { .. } => (Vec::new(), Vec::new()),
            Geometry::Rectangle { corner, edge_u, edge_v } => {
                let p = [*corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v];
                (p.to_vec(), vec![[0, 1, 2], [0, 2, 3]])
            }
            Geometry::Disk { center, normal, radius } => disk_triangles(*center, *normal, *radius),
            Geometry::Box { corner, size, turn_y } => box_triangles(*corner, *size, *turn_y),
            Geometry::Mesh(mesh) => return (mesh.positions().into(), mesh.triangles().into()),
            Geometry::Instance(instance) => (instance.positions(), instance.triangles()),
        };
        (positions.into(), triangles.into())
    }
}

/// Triangles of the fan that stands for a disk.
pub const DISK_SEGMENTS: u32 = 64;

fn disk_triangles(center: Vec3, normal: Vec3, radius: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (u, v) = normal.any_orthonormal_pair();
    let rim = (0..DISK_SEGMENTS).map(|i| {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / DISK_SEGMENTS as f32).sin_cos();
        center + radius * (u * cos + v * sin)
    });
    let triangles = (0..DISK_SEGMENTS).map(|i| [0, 1 + i, 1 + (i + 1) % DISK_SEGMENTS]);
    (std::iter::once(center).chain(rim).collect(), triangles.collect())
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

    #[test]
    fn a_disk_is_flat_round_and_wound_like_its_normal() {
        let normal = Vec3::new(1.0, -2.0, 2.0) / 3.0;
        let disk = Geometry::Disk { center: Vec3::new(1.0, 2.0, 3.0), normal, radius: 2.0 };
        let (p, triangles) = disk.flat_triangles();
        let area: f32 = triangles.map_corners(&p).iter().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).dot(normal)).sum();
        assert!((area / (4.0 * std::f32::consts::PI) - 1.0).abs() < 2e-3, "{area}");
        let (lo, hi) = disk.bounds();
        assert!(p.iter().all(|p| (p + 1e-5).cmpge(lo).all() && (p - 1e-5).cmple(hi).all()));
        assert!((hi.x - 1.0 - 2.0 * (8f32 / 9.0).sqrt()).abs() < 1e-6);
    }

    #[test]
    fn meshes_are_equal_by_what_they_hold_and_copies_hold_the_same() {
        let mesh = |x: f32| Geometry::mesh(vec![Vec3::X * x, Vec3::Y, Vec3::Z], vec![[0, 1, 2]]);
        let one = mesh(1.0);
        assert!(one == one.clone() && one == mesh(1.0) && one != mesh(1.0f32.next_up()));
        let (Geometry::Mesh(a), Geometry::Mesh(b)) = (&one, &one.clone()) else { panic!("meshes") };
        assert!(Arc::ptr_eq(a, b));
        assert_eq!(one.bounds(), (Vec3::ZERO, Vec3::ONE));
    }

    trait Corners {
        fn map_corners(&self, p: &[Vec3]) -> Vec<[Vec3; 3]>;
    }
    impl Corners for [[u32; 3]] {
        fn map_corners(&self, p: &[Vec3]) -> Vec<[Vec3; 3]> {
            self.iter().map(|t| t.map(|i| p[i as usize])).collect()
        }
    }
}
