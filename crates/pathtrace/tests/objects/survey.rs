//! Where a ray meets each shape of a scene, shape by shape and in f64, from their definitions.

use scene::glam::{DVec2, DVec3};
use scene::{Alpha, Geometry, Scene, Vec3};

/// A scene's shapes as definitions have them.
pub struct Survey<'a> {
    scene: &'a Scene,
    /// Of each flat shape the triangles, with the places of their corners in textures.
    faces: Vec<Vec<([DVec3; 3], [DVec2; 3])>>,
}

impl<'a> Survey<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let faces = scene.shapes.iter().map(|shape| faces_of(&shape.geometry)).collect();
        Survey { scene, faces }
    }

    /// The distance to each shape along a ray of unit direction; infinite where it is not met.
    pub fn distances(&self, origin: DVec3, direction: DVec3) -> Vec<f64> {
        let distance = |index: usize| {
            let geometry = &self.scene.shapes[index].geometry;
            match *geometry {
                Geometry::Sphere { center, radius } => to_sphere(center.as_dvec3(), radius.into(), origin, direction),
                Geometry::Disk { center, normal, radius } => {
                    let (center, normal) = (center.as_dvec3(), normal.as_dvec3());
                    let t = (center - origin).dot(normal) / direction.dot(normal);
                    let is_met = t > 0.0 && (origin + direction * t).distance(center) <= f64::from(radius);
                    if is_met { t } else { f64::INFINITY }
                }
                _ if !may_meet(geometry.bounds(), origin, direction) => f64::INFINITY,
                _ => self.to_faces(index, origin, direction),
            }
        };
        (0..self.scene.shapes.len()).map(distance).collect()
    }

    fn to_faces(&self, index: usize, origin: DVec3, direction: DVec3) -> f64 {
        let alpha = &self.scene.material_of(&self.scene.shapes[index]).surface.alpha;
        let met = self.faces[index].iter().filter_map(|(corners, uvs)| {
            let (t, [u, v, w]) = to_triangle(*corners, origin, direction)?;
            is_there(alpha, uvs[0] * u + uvs[1] * v + uvs[2] * w).then_some(t)
        });
        met.fold(f64::INFINITY, f64::min)
    }
}

fn faces_of(geometry: &Geometry) -> Vec<([DVec3; 3], [DVec2; 3])> {
    if matches!(geometry, Geometry::Disk { .. }) {
        return Vec::new();
    }
    let (positions, triangles) = geometry.flat_triangles();
    let uvs = geometry.mesh_of().map_or(&[][..], |mesh| mesh.uvs());
    let corner = |index: u32| positions[index as usize].as_dvec3();
    let uv = |index: u32| uvs.get(index as usize).map_or(DVec2::ZERO, |uv| uv.as_dvec2());
    triangles.iter().map(|triangle| (triangle.map(corner), triangle.map(uv))).collect()
}

fn is_there(alpha: &Alpha, uv: DVec2) -> bool {
    match alpha {
        Alpha::Opaque => true,
        Alpha::Mask { cutoff, factor, image } => {
            factor * image.as_ref().map_or(1.0, |image| image.at(uv.as_vec2()).w) >= *cutoff
        }
    }
}

fn to_sphere(center: DVec3, radius: f64, origin: DVec3, direction: DVec3) -> f64 {
    let from_center = origin - center;
    let half_b = from_center.dot(direction);
    let discriminant = half_b * half_b - from_center.length_squared() + radius * radius;
    let roots = [-1.0, 1.0].map(|sign| -half_b + sign * discriminant.sqrt());
    roots.into_iter().find(|t| *t > 0.0).unwrap_or(f64::INFINITY)
}

/// Distance and barycentrics, after Moeller and Trumbore (1997).
fn to_triangle([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<(f64, [f64; 3])> {
    let (to_b, to_c) = (b - a, c - a);
    let across = direction.cross(to_c);
    let determinant = to_b.dot(across);
    let from_a = origin - a;
    let v = from_a.dot(across) / determinant;
    let turned = from_a.cross(to_b);
    let w = direction.dot(turned) / determinant;
    let t = to_c.dot(turned) / determinant;
    (v >= 0.0 && w >= 0.0 && v + w <= 1.0 && t > 0.0).then_some((t, [1.0 - v - w, v, w]))
}

/// Whether a ray comes near a box.
fn may_meet((low, high): (Vec3, Vec3), origin: DVec3, direction: DVec3) -> bool {
    let room = DVec3::splat(1e-3 * f64::from((high - low).max_element()));
    let [near, far] = [low.as_dvec3() - room, high.as_dvec3() + room].map(|corner| (corner - origin) / direction);
    near.min(far).max_element() <= near.max(far).min_element()
}
