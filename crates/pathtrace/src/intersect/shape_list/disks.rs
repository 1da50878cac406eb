//! Ray/disk intersection in each lane: the plane in f64, as for triangles, so that a disk never shadows itself.
//!
//! Twin: `shaders/pathtrace/intersect/disk.wgsl`.

use crate::intersect::lanes::Rays;
use scene::Vec3;
use simd::{Double, Float};

/// A flat disk, the same in all lanes.
#[derive(Debug, Clone, Copy)]
pub struct DiskLanes {
    /// Centre, world space.
    pub center: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Radius, > 0.
    pub radius: f32,
}

impl DiskLanes {
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
