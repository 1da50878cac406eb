//! Ray/disk intersection for one lane: see [`DiskLanes::intersect`].

use super::Ray;
use super::lanes::Rays;
use super::shape_list::DiskLanes;
use scene::Vec3;

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
    /// Distance to the disk with `0 < t < tmax`, in lengths of the ray's direction; from either side.
    pub fn intersect(&self, ray: &Ray, tmax: f32) -> Option<f32> {
        let Disk { center, normal, radius } = *self;
        let (met, t) = DiskLanes { center, normal, radius }.intersect(&Rays { tmax, ..ray.lane() });
        met.then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disk_ends_at_its_rim_and_is_met_from_both_sides() {
        let disk = Disk { center: Vec3::new(1.0, 2.0, 3.0), normal: Vec3::Z, radius: 2.0 };
        let along =
            |x: f32, z: f32| disk.intersect(&Ray::new(Vec3::new(x, 2.0, 3.0 - 5.0 * z), Vec3::Z * z), f32::INFINITY);
        assert_eq!((along(1.0, 1.0), along(2.9, 1.0), along(2.9, -1.0)), (Some(5.0), Some(5.0), Some(5.0)));
        assert_eq!((along(3.1, 1.0), along(-1.1, -1.0)), (None, None));
        let within = Ray::new(Vec3::new(-5.0, 2.0, 3.0), Vec3::X);
        assert_eq!(disk.intersect(&within, f32::INFINITY), None);
    }
}
