//! Ray/sphere intersection that survives distance and size. The textbook's `b^2 - 4ac` loses three quarters of the rays
//! at a unit sphere 10,000 units away.
//!
//! Twin: `shaders/pathtrace/intersect/sphere.wgsl`.

use super::{Ray, Rays};
use crate::vectors::in_all_lanes;
use scene::Vec3;
use simd::{Float, Vector};

/// An analytic sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Centre, world space.
    pub center: Vec3,
    /// Radius, > 0.
    pub radius: f32,
}

impl Sphere {
    /// The sphere in all lanes.
    #[inline(always)]
    pub fn lanes<F: Float>(&self) -> SphereLanes<F> {
        SphereLanes { center: in_all_lanes(self.center), radius: F::splat(self.radius) }
    }

    /// Distance to the nearest meeting with `0 < t < tmax`, in lengths of the ray's direction.
    #[inline]
    pub fn intersect(&self, ray: &Ray, tmax: f32) -> Option<f32> {
        let (met, t) = self.lanes().intersect(&Rays { tmax, ..ray.lane() });
        met.then_some(t)
    }
}

/// A sphere in each lane.
#[derive(Debug, Clone, Copy)]
pub struct SphereLanes<F> {
    /// Centre, world space.
    pub center: Vector<F>,
    /// Radius, > 0.
    pub radius: F,
}

impl<F: Float> SphereLanes<F> {
    /// Where a ray meets the sphere, and the distance of the nearest meeting with `0 < t < tmax`, in lengths of its
    /// direction. Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection" (Ray Tracing
    /// Gems, chapter 7).
    #[inline(always)]
    pub fn intersect(&self, rays: &Rays<F>) -> (F::M, F) {
        let (zero, d) = (F::splat(0.0), rays.direction);
        let f = rays.origin - self.center;
        let a = d.length_squared();
        let b = -f.dot(d);
        // squared distance of the centre from the line, without the cancellation of b^2 - a c
        let off_axis = f + d * (b / a);
        let discriminant = self.radius * self.radius - off_axis.length_squared();
        let q = b + (a * discriminant.max(zero)).sqrt().copysign(b);
        let c = f.length_squared() - self.radius * self.radius;
        let (t0, t1) = (c / q, q / a);
        let (near, far) = (t0.min(t1), t0.max(t1));
        let t = F::select(near.gt(zero), near, far);
        (discriminant.ge(zero) & t.gt(zero) & t.lt(rays.tmax), t)
    }

    /// The point at the distance `t` of [`SphereLanes::intersect`], relative to the centre. From the point of the ray
    /// nearest to the centre, not along the ray: what a long `t` rounds does not turn the normal.
    #[inline(always)]
    pub fn meeting(&self, rays: &Rays<F>, t: F) -> Vector<F> {
        let f = rays.origin - self.center;
        let d = rays.direction;
        let a = d.length_squared();
        let middle = -f.dot(d) / a;
        let off_axis = f + d * middle;
        let within = (self.radius * self.radius - off_axis.length_squared()).max(F::splat(0.0));
        off_axis + d * (within / a).sqrt().copysign(t - middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::sampler::Sampler;
    use crate::sampling::{to_world, uniform_hemisphere};

    /// Distance, radius and largest error of t, as measured for this test in f32 with a margin; the reference is f64 on
    /// the same f32 ray. Impact parameters up to .99 radius.
    #[test]
    fn no_ray_is_lost_far_away_or_at_huge_spheres() {
        for (distance, radius, tolerance) in
            [(10.0, 1.0, 1e-5), (1e3, 1.0, 1e-3), (1e4, 1.0, 1e-2), (100.0, 1e3, 3e-4), (10.0, 1e5, 3e-2)]
        {
            let sphere = Sphere { center: Vec3::ZERO, radius };
            for sample in 0..20_000 {
                let u = Sampler::independent(1, sample, 2).unit4(0);
                let from = uniform_hemisphere([u[0], u[1]]);
                let origin = from * (radius + distance);
                let impact = 0.99 * radius * u[2].sqrt();
                let angle = u[3] * std::f32::consts::TAU;
                let aim = to_world(Vec3::new(impact * angle.cos(), impact * angle.sin(), 0.0), from);
                let ray = Ray::new(origin, (aim - origin).normalize());
                let t = sphere.intersect(&ray, f32::INFINITY).expect("a hit");
                let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
                let (a, b, c) = (d.length_squared(), o.dot(d), o.length_squared() - f64::from(radius).powi(2));
                let exact = (-b - (b * b - a * c).sqrt()) / a;
                assert!((f64::from(t) - exact).abs() < tolerance, "{distance} {radius}: {t} {exact}");
            }
        }
        let central = Ray::new(Vec3::new(0.0, 0.0, 1e4), -Vec3::Z);
        assert_eq!(Sphere { center: Vec3::ZERO, radius: 1.0 }.intersect(&central, f32::INFINITY), Some(9999.0));
    }
}
