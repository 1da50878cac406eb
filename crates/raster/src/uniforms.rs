//! The numbers of a frame on the device, from which dynamic offsets choose.

use crate::error::RasterError;
use crate::plan::Plan;
use bytemuck::Pod;
use gpu::{Gpu, GpuError};
use wgpu::BufferUsages;

/// Distance of uniforms that dynamic offsets choose from: every device allows this one.
const STRIDE: usize = 256;

/// The uniform buffers; they grow with the scene.
#[derive(Debug)]
pub struct Uniforms {
    /// The uniform buffer of all cameras.
    pub views: wgpu::Buffer,
    /// The uniform buffer of the lights.
    pub lights: wgpu::Buffer,
    /// The uniform buffer of all shapes.
    pub objects: wgpu::Buffer,
}

impl Uniforms {
    /// Buffers that the first frame replaces.
    pub fn new(gpu: &Gpu) -> Result<Uniforms, GpuError> {
        let empty = || uniforms(gpu, "the fake's numbers", &[0; STRIDE]);
        Ok(Uniforms { views: empty()?, lights: empty()?, objects: empty()? })
    }

    /// Fills them with a frame's numbers.
    pub fn write(&mut self, gpu: &Gpu, plan: &Plan) -> Result<(), RasterError> {
        fill(gpu, "the cameras", &mut self.views, &spaced(&plan.views))?;
        fill(gpu, "the lights", &mut self.lights, bytemuck::bytes_of(&plan.lights))?;
        let shapes = format!("a scene of {} shapes", plan.objects.len());
        fill(gpu, &shapes, &mut self.objects, &spaced(&plan.objects))?;
        Ok(())
    }
}

fn uniforms(gpu: &Gpu, what: &str, bytes: &[u8]) -> Result<wgpu::Buffer, GpuError> {
    gpu.buffer(what, bytes, BufferUsages::UNIFORM | BufferUsages::COPY_DST)
}

fn fill(gpu: &Gpu, what: &str, buffer: &mut wgpu::Buffer, bytes: &[u8]) -> Result<(), GpuError> {
    if (buffer.size() as usize) < bytes.len() {
        *buffer = uniforms(gpu, what, bytes)?;
    } else {
        gpu.queue.write_buffer(buffer, 0, bytes);
    }
    Ok(())
}

fn spaced<T: Pod>(items: &[T]) -> Vec<u8> {
    let mut bytes = vec![0; STRIDE * items.len()];
    for (slot, item) in bytes.chunks_exact_mut(STRIDE).zip(items) {
        slot[..size_of::<T>()].copy_from_slice(bytemuck::bytes_of(item));
    }
    bytes
}

/// Where the uniforms of this number begin.
pub fn offset(slot: usize) -> u32 {
    (slot * STRIDE) as u32
}
