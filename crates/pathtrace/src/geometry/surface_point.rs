//! A point on a surface with a bound on its rounding error, and the step off the surface that the bound asks for (pbrt,
//! section 6.8): large enough that a new ray cannot meet the surface it leaves, and no larger.

use super::gamma;
use scene::Vec3;

/// A point on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// World space.
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
    #[inline]
    pub fn leaving_towards(&self, direction: Vec3) -> Vec3 {
        let along = self.normal.abs().dot(self.error);
        let outwards = if direction.dot(self.normal) < 0.0 { -self.normal } else { self.normal };
        let moved = (self.position + outwards * along).to_array();
        let outwards = outwards.to_array();
        Vec3::from_array(std::array::from_fn(|axis| {
            if outwards[axis] > 0.0 {
                moved[axis].next_up()
            } else if outwards[axis] < 0.0 {
                moved[axis].next_down()
            } else {
                moved[axis]
            }
        }))
    }
}
