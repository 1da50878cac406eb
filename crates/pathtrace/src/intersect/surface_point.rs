//! A point on a surface with a bound on its rounding error, in each lane and for one.
//!
//! Twin: `shaders/pathtrace/intersect/surface_point.wgsl`.

use super::gamma;
use crate::vectors::{glam_vector, lane_vector};
use scene::Vec3;
use simd::{Float, Mask, Vector};

/// A point of a surface in each lane, with a bound on its rounding error; and the step off the surface that the bound
/// asks for (pbrt, section 6.8): large enough that a new ray cannot meet the surface that it leaves, and no larger.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoints<F> {
    /// World space.
    pub position: Vector<F>,
    /// The surface lies within this distance along each axis.
    pub error: Vector<F>,
    /// Unit geometric normal.
    pub normal: Vector<F>,
    /// Of a sphere; 0 if the surface is flat.
    pub radius: F,
}

impl<F: Float> SurfacePoints<F> {
    /// A point in the air: nothing to step off.
    #[inline(always)]
    pub fn in_the_air(position: Vector<F>) -> Self {
        let zero = Vector::zero();
        SurfacePoints { position, error: zero, normal: zero, radius: F::splat(0.0) }
    }

    /// The point of a flat surface that is `along_u` and `along_v` from its corner.
    #[inline(always)]
    pub fn on_plane(corner: Vector<F>, along_u: Vector<F>, along_v: Vector<F>, normal: Vector<F>) -> Self {
        let error = (corner.abs() + along_u.abs() + along_v.abs()) * F::splat(gamma(5));
        SurfacePoints { position: corner + along_u + along_v, error, normal, radius: F::splat(0.0) }
    }

    /// The point of a triangle with these barycentrics. Far more exact than `origin + t * direction`.
    #[inline(always)]
    pub fn on_triangle(corners: [Vector<F>; 3], barycentrics: [F; 3], normal: Vector<F>) -> Self {
        let [a, b, c] = [0, 1, 2].map(|i| corners[i] * barycentrics[i]);
        let error = (a.abs() + b.abs() + c.abs()) * F::splat(gamma(7));
        SurfacePoints { position: a + b + c, error, normal, radius: F::splat(0.0) }
    }

    /// The point of a sphere in a direction from its centre, of any length but 0.
    #[inline(always)]
    pub fn on_sphere(center: Vector<F>, radius: F, from_center: Vector<F>) -> Self {
        let normal = from_center.normalize();
        let out = normal * radius;
        let error = (center.abs() + out.abs()) * F::splat(gamma(5));
        SurfacePoints { position: center + out, error, normal, radius }
    }

    /// The point of the plane through `center` that is nearest to `near`.
    #[inline(always)]
    pub fn on_disk(center: Vector<F>, near: Vector<F>, normal: Vector<F>) -> Self {
        let from_center = near - center;
        let out = from_center - normal * normal.dot(from_center);
        // what is left of the normal in `out` is a rounding error of its length, along all axes
        let error = (center.abs() + Vector::along_all(out.length_squared().sqrt())) * F::splat(gamma(8));
        SurfacePoints { position: center + out, error, normal, radius: F::splat(0.0) }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        SurfacePoints {
            position: Vector::select(mask, yes.position, no.position),
            error: Vector::select(mask, yes.error, no.error),
            normal: Vector::select(mask, yes.normal, no.normal),
            radius: F::select(mask, yes.radius, no.radius),
        }
    }

    /// The start of a ray that leaves on the side of the unit vector `direction`: a step along the normal, but into a
    /// sphere along the ray, where that stays within a quarter of the chord. Steps along the normal would draw the ray of
    /// a whispering gallery inwards with each reflection.
    #[inline(always)]
    pub fn leaving_towards(&self, direction: Vector<F>) -> Vector<F> {
        // the step itself is rounded too
        let error = self.error + self.position.abs() * F::splat(gamma(2));
        let along = self.normal.abs().dot(error);
        let cosine = direction.dot(self.normal);
        let step = along.copysign(cosine);
        let towards_center = self.radius * cosine;
        let inwards = towards_center.lt(F::splat(0.0));
        if !inwards.any() {
            return self.position + self.normal * step;
        }
        let on_its_line = inwards & (towards_center * cosine).ge(along + along);
        let way = Vector::select(on_its_line, direction, self.normal);
        self.position + way * F::select(on_its_line, along / cosine.abs(), step)
    }
}

/// [`SurfacePoints`] of one lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// World space.
    pub position: Vec3,
    /// The true point lies within this distance along each axis.
    pub error: Vec3,
    /// Unit geometric normal.
    pub normal: Vec3,
    /// Of a sphere; 0 if the surface is flat.
    pub radius: f32,
}

impl SurfacePoint {
    /// The start of a ray that leaves on the side of the unit vector `direction`.
    pub fn leaving_towards(&self, direction: Vec3) -> Vec3 {
        glam_vector(SurfacePoints::from(*self).leaving_towards(lane_vector(direction)))
    }
}

impl From<SurfacePoint> for SurfacePoints<f32> {
    fn from(point: SurfacePoint) -> Self {
        let [position, error, normal] = [point.position, point.error, point.normal].map(lane_vector);
        SurfacePoints { position, error, normal, radius: point.radius }
    }
}

impl From<SurfacePoints<f32>> for SurfacePoint {
    fn from(point: SurfacePoints<f32>) -> Self {
        let [position, error, normal] = [point.position, point.error, point.normal].map(glam_vector);
        SurfacePoint { position, error, normal, radius: point.radius }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Light that goes round in a glass ball leaves each point of it inwards. A step along the normal would put its ray
    /// onto another chord, farther in each time.
    #[test]
    fn a_ray_into_a_sphere_stays_on_its_line() {
        let sphere = SurfacePoints::on_sphere(lane_vector(Vec3::splat(1000.0)), 1.0, lane_vector(Vec3::X));
        let point = SurfacePoint::from(sphere);
        for slope in [0.1f32, 0.5, 1.0, 3.0, 10.0] {
            let direction = Vec3::new(-1.0, slope, 0.0).normalize();
            let step = point.leaving_towards(direction) - point.position;
            let along = step.dot(direction);
            assert!(along > 0.0 && along < 0.5, "{slope}: {step}");
            // the position at 1000 is rounded to 6e-5
            assert!((step - direction * along).length() < 1.5e-4, "{slope}: {step}");
        }
        // so flat that the chord is shorter than the step
        let step = point.leaving_towards(Vec3::new(-1e-3, 1.0, 0.0).normalize()) - point.position;
        assert!(step.x < -2e-4 && step.y.abs() < 1e-4, "{step}");
    }
}
