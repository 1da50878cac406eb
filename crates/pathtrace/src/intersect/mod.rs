//! Where rays meet shapes, in f32 and without a single absolute epsilon.
//!
//! [`triangle`] is watertight, [`sphere`] holds far away and huge, [`disk`] is flat; [`accel`] puts them into a BVH
//! whose boxes are padded against the rounding of its box test, [`shape_list`] tests all of a small scene against a ray
//! in each lane, and [`aggregate`] chooses between these. A large
//! mesh is in none of them: it has a [`mesh_tree`] in its own space, and [`instances`] say where it stands. All find a [`Hit`], and fetch a [`Intersection`] for the
//! one that is left; its [`SurfacePoint`] says how far to step off the surface.
//!
//! Of lights nothing is known here but their numbers, which hits bring along.

pub mod accel;
pub mod aggregate;
pub(crate) mod attributes;
pub(crate) mod baking;
pub(crate) mod bvh2;
mod bvh8;
mod bvh8_build;
mod bvh8_collapse;
mod bvh8_leaf;
#[cfg(test)]
mod bvh8_tests;
mod bvh8_walk;
pub mod coincident;
pub(crate) mod contact;
pub mod counted;
pub(crate) mod cutouts;
pub mod disk;
mod hit;
#[cfg(test)]
mod instance_tests;
pub mod instances;
mod mesh_build;
pub mod mesh_kept;
mod mesh_known;
pub mod mesh_tree;
mod mesh_unpacked;
#[cfg(test)]
mod mesh_unpacked_tests;
mod mesh_walk;
mod owners;
pub(crate) mod pairs;
pub(crate) mod primitive;
pub(crate) mod ray;
pub mod shape_list;
pub mod sphere;
mod surface_point;
pub mod triangle;

pub use accel::Accel;
pub use attributes::SurfaceAttributes;
pub use hit::{Blocker, Hit, Hits, Intersection, Intersections, NO_INSTANCE, NO_LIGHT, NO_PRIMITIVE};
pub use mesh_build::Progress;
pub use mesh_tree::MeshTree;
pub use ray::{Ray, Rays, SHADOW_END};
pub use surface_point::{SurfacePoint, SurfacePoints};
pub use triangle::triangle_normal;

/// Higham's bound on the relative error of `n` roundings in a row, f32.
pub const fn gamma(n: u32) -> f32 {
    let error = n as f32 * (0.5 * f32::EPSILON);
    error / (1.0 - error)
}
