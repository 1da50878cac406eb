//! A point on a surface with a bound on its rounding error: [`SurfacePoints`] of one lane.
//!
//! Twin: `shaders/pathtrace/intersect/surface_point.wgsl`.

use super::gamma;
use super::lanes::SurfacePoints;
use crate::vectors::{glam_vector, lane_vector};
use scene::Vec3;

/// A point on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// PreparedScene space.
    pub position: Vec3,
    /// The true point lies within this distance along each axis.
    pub error: Vec3,
    /// Unit geometric normal.
    pub normal: Vec3,
}

impl SurfacePoint {
    /// The point of a triangle with these barycentrics. Far more exact than `origin + t * direction`.
    pub fn on_triangle(corners: [Vec3; 3], barycentrics: [f32; 3], normal: Vec3) -> Self {
        let [a, b, c] = [0, 1, 2].map(|i| corners[i] * barycentrics[i]);
        SurfacePoint { position: a + b + c, error: gamma(7) * (a.abs() + b.abs() + c.abs()), normal }
    }

    /// The point of a sphere in a direction from its centre, of any length but 0.
    pub fn on_sphere(center: Vec3, radius: f32, from_center: Vec3) -> Self {
        let normal = from_center.normalize();
        let out = normal * radius;
        SurfacePoint { position: center + out, error: gamma(5) * (center.abs() + out.abs()), normal }
    }

    /// The point of the plane through `center` that is nearest to `near`.
    pub fn on_disk(center: Vec3, near: Vec3, normal: Vec3) -> Self {
        let from_center = near - center;
        let out = from_center - normal * normal.dot(from_center);
        // what is left of the normal in `out` is a rounding error of its length, along all axes
        let error = gamma(8) * (center.abs() + Vec3::splat(out.length()));
        SurfacePoint { position: center + out, error, normal }
    }

    /// The start of a ray that leaves on the side of `direction`.
    pub fn leaving_towards(&self, direction: Vec3) -> Vec3 {
        glam_vector(SurfacePoints::from(*self).leaving_towards(lane_vector(direction)))
    }
}
