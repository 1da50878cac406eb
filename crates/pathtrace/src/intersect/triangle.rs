//! Watertight ray/triangle intersection: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1),
//! 2013).
//!
//! Twin: `shaders/pathtrace/intersect/triangle.wgsl`.

use super::Ray;
use scene::Vec3;
use scene::glam::DVec3;
use std::cmp::Ordering;

/// A ray turned so that its largest direction component is z, and the shear that takes it onto the z axis.
#[derive(Debug, Clone, Copy)]
pub struct ShearedRay {
    pub(super) origin: Vec3,
    direction: Vec3,
    /// The axis along which it goes farthest: 0, 1 or 2.
    pub(super) main_axis: usize,
    pub(super) shear: [f32; 2],
    /// Along the largest axis.
    pub(super) depth: f32,
}

impl ShearedRay {
    /// Prepares a ray for any number of triangles.
    pub fn new(ray: &Ray) -> Self {
        let d = ray.direction.to_array();
        let size = d.map(f32::abs);
        let kz = if size[0] > size[1] && size[0] > size[2] {
            0
        } else if size[1] > size[2] {
            1
        } else {
            2
        };
        let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
        let shear = [d[kx] / d[kz], d[ky] / d[kz]];
        ShearedRay { origin: ray.origin, direction: ray.direction, main_axis: kz, shear, depth: d[kz] }
    }

    /// The point in the ray's frame: the ray is the z axis, z is t times the ray's depth.
    #[inline(always)]
    fn apply(&self, point: Vec3) -> Vec3 {
        let p = point - self.origin;
        let (x, y, z) = match self.main_axis {
            0 => (p.y, p.z, p.x),
            1 => (p.z, p.x, p.y),
            _ => (p.x, p.y, p.z),
        };
        Vec3::new(x - self.shear[0] * z, y - self.shear[1] * z, z)
    }
}

/// A triangle whose corners are sorted by position, so that the neighbours of an edge evaluate one and the same
/// expression for it even where multiply-adds are fused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Corners in lexicographic order of their coordinates.
    pub corners: [Vec3; 3],
    /// Normal of the sorted corners, not unit. In f64, see [`Triangle::plane_distance`].
    pub(crate) normal: DVec3,
}

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleHit {
    /// Distance in lengths of the ray's direction.
    pub t: f32,
    /// Weights of the corners, adding up to 1.
    pub barycentrics: [f32; 3],
}

impl Triangle {
    /// Sorts the corners.
    pub fn new(corners: [Vec3; 3]) -> Self {
        Triangle::sorted(sorted(corners))
    }

    /// From corners that are in order already.
    #[inline(always)]
    pub(super) fn sorted(corners: [Vec3; 3]) -> Self {
        let (a, b, c) = (corners[0].as_dvec3(), corners[1].as_dvec3(), corners[2].as_dvec3());
        Triangle { corners, normal: (b - a).cross(c - a) }
    }

    /// Meets the triangle from either side, its edges included: a ray between two neighbours hits at least one of them.
    pub fn intersect(&self, ray: &ShearedRay, tmax: f32) -> Option<TriangleHit> {
        let [a, b, c] = self.corners.map(|corner| ray.apply(corner));
        let (u, v, w) = (edge(b, c), -edge(a, c), edge(a, b));
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let determinant = u + v + w;
        if determinant == 0.0 {
            return None;
        }
        let t = self.distance(ray, [a.z, b.z, c.z], tmax)?;
        Some(TriangleHit { t, barycentrics: [u, v, w].map(|area| area / determinant) })
    }

    /// Where a ray that passes between the edges meets the triangle, if with `0 < t < tmax`. `z` are the corners' in
    /// the ray's frame.
    #[inline(always)]
    pub(super) fn distance(&self, ray: &ShearedRay, [a, b, c]: [f32; 3], tmax: f32) -> Option<f32> {
        let t = self.plane_distance(ray);
        // NaN, from a triangle seen exactly edge-on, fails too
        if !(t > 0.0) {
            return None;
        }
        // areas of one sign make the hit a mean of the corners: nearly edge-on, where the plane says little, it still
        // is (divided, not multiplied by an inverse: rounding then keeps the order, and an area light does not shadow
        // itself)
        let [near, far] = [a.min(b).min(c) / ray.depth, a.max(b).max(c) / ray.depth];
        let t = t.clamp(near.min(far), near.max(far));
        (t > 0.0 && t < tmax).then_some(t)
    }

    /// Distance to the triangle's plane, in f64 so that its sign is right: from a point just above a wall 500 units
    /// wide f32 cannot tell above from below, and the wall would shadow itself.
    #[inline(always)]
    fn plane_distance(&self, ray: &ShearedRay) -> f32 {
        let to_plane = self.corners[0].as_dvec3() - ray.origin.as_dvec3();
        (self.normal.dot(to_plane) / self.normal.dot(ray.direction.as_dvec3())) as f32
    }
}

/// Which of two points comes first in lexicographic order.
pub(crate) fn in_order(a: &Vec3, b: &Vec3) -> Ordering {
    let (a, b) = (a.to_array(), b.to_array());
    a.iter().zip(&b).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
}

/// Corners in lexicographic order.
pub(crate) fn sorted(corners: [Vec3; 3]) -> [Vec3; 3] {
    // +0.0 and -0.0 are one place
    let mut corners = corners.map(|corner| corner + Vec3::ZERO);
    corners.sort_by(in_order);
    corners
}

/// Unit normal by winding, in f64 so that slivers have one too; `None` without area.
pub fn triangle_normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    (b - a).cross(c - a).try_normalize().map(|n| n.as_vec3())
}

/// Twice the signed area of (z axis, p, q). Rounding is monotone, so without fusing its sign is right or it is 0.
#[inline(always)]
fn edge(p: Vec3, q: Vec3) -> f32 {
    p.x * q.y - p.y * q.x
}
