//! Where rays meet shapes, in f32 and without a single absolute epsilon.
//!
//! [`triangle`] is watertight, [`sphere`] holds far away and huge, [`disk`] is flat; [`accel`] puts them into a BVH
//! whose boxes are padded against the rounding of its box test, [`shape_list`] tests all of a small scene against a ray
//! in each lane, and [`aggregate`] chooses between these. [`surface_point`] says where a hit lies and how far to step
//! off it; [`lanes`] has rays, points and hits in each lane.
//!
//! Twin of [`Ray`] and [`gamma`]: `shaders/pathtrace/intersect/ray.wgsl`.

pub mod accel;
pub mod aggregate;
mod bvh8;
mod bvh8_build;
mod bvh8_collapse;
mod bvh8_leaf;
#[cfg(test)]
mod bvh8_tests;
mod bvh8_walk;
pub mod disk;
pub mod lanes;
pub mod shape_list;
pub mod sphere;
pub mod surface_point;
pub mod triangle;

pub use accel::{Accel, Hit, NO_LIGHT};
pub use surface_point::SurfacePoint;
pub use triangle::triangle_normal;

use scene::Vec3;

/// A ray; points on it are `origin + t * direction` for `0 < t < tmax`.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// Where it starts, world space.
    pub origin: Vec3,
    /// Where it goes; unit length but for shadow rays, which end at [`SHADOW_END`]. Never has a -0.0.
    pub direction: Vec3,
    /// Hits must lie before this.
    pub tmax: f32,
}

impl Ray {
    /// A ray without end along the unit vector `direction`.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Ray { origin, direction: without_negative_zero(direction), tmax: f32::INFINITY }
    }

    /// As one lane's ray.
    pub fn lane(&self) -> lanes::Rays<f32> {
        let [origin, direction] = [self.origin, self.direction].map(crate::vectors::lane_vector);
        lanes::Rays { origin, direction, tmax: self.tmax }
    }

    /// A shadow ray: everything strictly between two points.
    pub fn between(from: Vec3, to: Vec3) -> Self {
        Ray { origin: from, direction: without_negative_zero(to - from), tmax: SHADOW_END }
    }
}

/// Where a shadow ray between two points ends, in lengths of its direction. Its end at 1 is rounded with the direction:
/// what lies as near to it is not known to lie before it, and an area light there must not shadow itself.
pub const SHADOW_END: f32 = 1.0 - gamma(8);

/// Wide box tests choose near and far planes by the sign of the direction, where -0.0 is a trap.
fn without_negative_zero(v: Vec3) -> Vec3 {
    v + Vec3::ZERO
}

/// Higham's bound on the relative error of `n` roundings in a row, f32.
pub const fn gamma(n: u32) -> f32 {
    let error = n as f32 * (0.5 * f32::EPSILON);
    error / (1.0 - error)
}
