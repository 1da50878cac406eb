//! Ray/disk intersection.
//!
//! Twin: `shaders/pathtrace/intersect/disk.wgsl`.

use super::Rays;
use scene::Vec3;
use simd::{Double, Float};

/// A flat disk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disk {
    /// Centre, world space.
    pub center: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Radius, > 0.
    pub radius: f32,
}

impl Disk {
    /// Where a ray meets the disk from either side, and its distance with `0 < t < tmax`, in lengths of its direction.
    #[inline(always)]
    pub fn intersect<F: Float>(&self, rays: &Rays<F>) -> (F::M, F) {
        let (normal, center) = (self.normal.as_dvec3(), self.center.as_dvec3());
        let (o, d) = (rays.origin, rays.direction);
        let to_center = [
            F::D::splat(center.x) - o.x.widen(),
            F::D::splat(center.y) - o.y.widen(),
            F::D::splat(center.z) - o.z.widen(),
        ];
        let d = [d.x.widen(), d.y.widen(), d.z.widen()];
        let t = (to_center[0] * normal.x + to_center[1] * normal.y + to_center[2] * normal.z)
            / (d[0] * normal.x + d[1] * normal.y + d[2] * normal.z);
        let off = [d[0] * t - to_center[0], d[1] * t - to_center[1], d[2] * t - to_center[2]];
        let off_center = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
        let radius = f64::from(self.radius);
        let within = !F::D::splat(radius * radius).lt(off_center);
        let distance = t.narrow();
        // NaN and infinity, from a ray in the plane or beside it, fail here
        (within & distance.gt(F::splat(0.0)) & distance.lt(rays.tmax), distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::Ray;

    #[test]
    fn a_disk_ends_at_its_rim_and_is_met_from_both_sides() {
        let disk = Disk { center: Vec3::new(1.0, 2.0, 3.0), normal: Vec3::Z, radius: 2.0 };
        let meet = |ray: Ray| {
            let (met, t) = disk.intersect(&ray.lane());
            met.then_some(t)
        };
        let along = |x: f32, z: f32| meet(Ray::new(Vec3::new(x, 2.0, 3.0 - 5.0 * z), Vec3::Z * z));
        assert_eq!((along(1.0, 1.0), along(2.9, 1.0), along(2.9, -1.0)), (Some(5.0), Some(5.0), Some(5.0)));
        assert_eq!((along(3.1, 1.0), along(-1.1, -1.0)), (None, None));
        let within = Ray::new(Vec3::new(-5.0, 2.0, 3.0), Vec3::X);
        assert_eq!(meet(within), None);
    }
}
