//! Sums of what a pixel's samples show, which go to a graphics device and back as they are.
//!
//! Mirror of `Sums` in `shaders/pathtrace/features.wgsl`, field for field. A test compares every offset
//! with the shader compiler's.

use bytemuck::{Pod, Zeroable};
use scene::Vec3;

/// Of one pixel's samples.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Sums {
    /// Of surfaces, and of what shines at most 1.
    pub albedo: Vec3,
    /// Samples taken, those that met nothing among them.
    pub samples: u32,
    /// Of unit normals on the camera's side.
    pub normal: Vec3,
    /// To the first surfaces.
    pub distance: f32,
    /// Samples that met anything.
    pub met: u32,
    /// Rays that a device has traced for them, which may have overflowed.
    pub rays: u32,
    /// Fills the last 16 bytes, to which vectors are aligned.
    pub unused: [u32; 2],
}

impl Sums {
    /// Mean distance to the first surface; infinite where there is none.
    pub fn depth(&self) -> f32 {
        if self.met == 0 { f32::INFINITY } else { self.distance / self.met as f32 }
    }
}
