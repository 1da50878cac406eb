//! Ray/sphere intersection that survives distance and size, for one lane: see [`SphereLanes::intersect`]. The
//! textbook's `b^2 - 4ac` loses three quarters of the rays at a unit sphere 10,000 units away.

use super::Ray;
use super::lanes::{Rays, SphereLanes};
use crate::vectors::glam_vector;
use scene::Vec3;

/// An analytic sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Centre, world space.
    pub center: Vec3,
    /// Radius, > 0.
    pub radius: f32,
}

impl Sphere {
    fn lane(&self) -> SphereLanes<f32> {
        SphereLanes::new(self.center, self.radius)
    }

    /// Distance to the nearest meeting with `0 < t < tmax`, in lengths of the ray's direction.
    #[inline]
    pub fn intersect(&self, ray: &Ray, tmax: f32) -> Option<f32> {
        let (met, t) = self.lane().intersect(&Rays { tmax, ..ray.lane() });
        met.then_some(t)
    }

    /// The point at the distance `t` of [`Sphere::intersect`], relative to the centre.
    pub fn meeting(&self, ray: &Ray, t: f32) -> Vec3 {
        glam_vector(self.lane().meeting(&ray.lane(), t))
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
