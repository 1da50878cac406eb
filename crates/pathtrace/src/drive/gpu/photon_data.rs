//! Mirrors of the structs in `shaders/pathtrace/integrator/photon/map.wgsl` and `shaders/pathtrace/light/aim.wgsl`, field for
//! field. A test compares every offset with the shader compiler's. Padding is spelled out as `unused*`.

use crate::light::{Aim, Bounds, Emitters};
use bytemuck::{Pod, Zeroable};
use scene::Vec3;

/// What a dispatch of photons is asked for.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct PhotonParams {
    /// These items of a list ...
    pub first: u32,
    /// ... up to before this one.
    pub end: u32,
    /// The number of the pass, from 0.
    pub number: u32,
    /// That leave the lights in it.
    pub photons: u32,
    /// The seed of the picture's random numbers.
    pub seed: u32,
    /// Most that the list holds.
    pub capacity: u32,
}

/// How a list of photons begins.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct PhotonCounts {
    /// How many were found, be there room for them or not.
    pub found: u32,
    /// Photons that were cut short.
    pub cut_photons: u32,
    /// Rays traced, the lower 32 bits of their number ...
    pub rays: u32,
    /// ... and above them what overflowed.
    pub rays_high: u32,
}

/// Light that has arrived at a diffuse surface.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Photon {
    /// Where it has met a surface, in world space.
    pub position: Vec3,
    /// On the side that it came from, in 32 bits.
    pub normal: u32,
    /// What it carries of its light's power, RGB.
    pub power: Vec3,
    /// By the photon that left a light, and along its way.
    pub order: u32,
}

/// How a map of photons begins.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Grid {
    /// From where cells are counted.
    pub origin: Vec3,
    /// Over the width of a cell.
    pub cells_per_unit: f32,
    /// In which photons are gathered.
    pub radius: f32,
    /// Buckets less one, a power of two less one, and at least 1.
    pub mask: u32,
    /// Where the photons begin behind the buckets, in words of 16 bytes.
    pub photons: u32,
    /// Padding to the alignment that the shader has.
    pub unused: u32,
}

/// How the list of what sends out photons begins.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct EmissionHeader {
    /// Middle of the sphere around the scene.
    pub center: Vec3,
    /// The radius of the sphere around all shapes.
    pub radius: f32,
    /// Radiance of a sky of one colour.
    pub sky: Vec3,
    /// How many rows tell of what shines.
    pub emitters: u32,
    /// How many spheres photons are aimed at, with two rows each behind them.
    pub targets: u32,
    /// Padding to the alignment that the shader has.
    pub unused: [u32; 3],
}

impl PhotonCounts {
    pub(crate) fn all_rays(&self) -> u64 {
        u64::from(self.rays_high) << 32 | u64::from(self.rays)
    }
}

impl Grid {
    /// Of so many photons.
    pub(crate) fn new(origin: Vec3, radius: f32, photons: u32) -> Self {
        let buckets = photons.next_power_of_two().max(2);
        Grid { origin, cells_per_unit: 0.5 / radius, radius, mask: buckets - 1, photons: buckets / 2, unused: 0 }
    }
}

/// All that sends out photons, and what they are aimed at, as `shaders/pathtrace/light/aim.wgsl` has it.
pub(crate) fn emission(emitters: &Emitters, aim: &Aim) -> Vec<u8> {
    let (Bounds { center, radius }, sky) = (emitters.scene(), emitters.sky());
    let [of_light, targets] = [emitters.chances().len() as u32, aim.targets().len() as u32];
    let header = EmissionHeader { center, radius, sky, emitters: of_light, targets, unused: [0; 3] };
    let chances = emitters.chances().map(|(cumulative, probability)| [cumulative, probability, 0.0, 0.0]);
    let target =
        |(bounds, share): (Bounds, f32)| [bounds.center.extend(bounds.radius).to_array(), [share, 0.0, 0.0, 0.0]];
    let mut rows: Vec<[f32; 4]> = chances.chain(aim.targets().flat_map(target)).collect();
    // a list without rows has one that nobody reads
    rows.resize(rows.len().max(1), [0.0; 4]);
    [bytemuck::bytes_of(&header), bytemuck::cast_slice(&rows)].concat()
}
