//! Where values lie on the device, for inputs of one size, and what each layer is bound to.

use super::Shaders;
use super::weights::{Layer, sized};
use crate::network::{GRAPH, PLACES, Place};
use gpu::wgpu::{BindGroup, Buffer, BufferDescriptor, BufferUsages};
use gpu::{Gpu, GpuError};

const WHAT: &str = "what a denoising network has in mind";

/// Memory of a network for inputs of one size.
#[derive(Debug)]
pub struct Places {
    /// Columns and rows of the input.
    pub size: [usize; 2],
    /// The layers, with their sizes.
    pub layers: Vec<Layer>,
    /// What those are bound to whose values other layers read.
    pub groups: Vec<BindGroup>,
    /// The parameters of each.
    params: Vec<Buffer>,
    buffers: Vec<Buffer>,
}

impl Places {
    /// Memory for values of so many bytes a block of four channels.
    ///
    /// # Errors
    /// [`GpuError`] if the device has not so much.
    pub fn new(
        gpu: &Gpu,
        shaders: &Shaders,
        layers: &[Layer],
        weights: &Buffer,
        size: [usize; 2],
        block: u64,
    ) -> Result<Self, GpuError> {
        let (blocks, layers) = sized(layers, size);
        let buffers = blocks.map(|blocks| storage(gpu, blocks * block)).into_iter().collect::<Result<Vec<_>, _>>()?;
        let uniform = |layer: &Layer| gpu.buffer(WHAT, std::slice::from_ref(layer), BufferUsages::UNIFORM);
        let params = layers.iter().map(uniform).collect::<Result<Vec<_>, _>>()?;
        let mut places = Places { size, layers, groups: Vec::new(), params, buffers };
        places.groups = gpu.checked(WHAT, || {
            let group = |index: usize| {
                let written = places.at(GRAPH[index].writes).as_entire_binding();
                shaders.layer.bind(gpu, &[&places.bound(index, weights)[..], &[written]].concat())
            };
            (0..GRAPH.len() - 1).map(group).collect()
        })?;
        Ok(places)
    }

    /// What a layer is bound to beside where it writes: a layer that reads one place has it in both roles.
    pub fn bound<'a>(&'a self, index: usize, weights: &'a Buffer) -> Vec<gpu::wgpu::BindingResource<'a>> {
        let reads = GRAPH[index].reads;
        let [halved, full] = [reads[0].0, reads[reads.len() - 1].0].map(|place| self.at(place));
        [&self.params[index], halved, full, weights].map(Buffer::as_entire_binding).to_vec()
    }

    /// The buffer of a place.
    pub fn at(&self, place: Place) -> &Buffer {
        &self.buffers[place as usize]
    }
}

/// How many pixels an input may have for values to fit `budget` bytes in all, and each place `largest`.
pub fn most_pixels(layers: &[Layer], block: u64, budget: u64, largest: u64) -> usize {
    const SIDE: usize = crate::network::ALIGNMENT;
    let (blocks, _): ([u64; PLACES], _) = sized(layers, [SIDE, SIDE]);
    let pixels = (SIDE * SIDE) as u64;
    let of_all = budget * pixels / (block * blocks.iter().sum::<u64>());
    let of_one = largest * pixels / (block * blocks.into_iter().max().unwrap_or(1));
    of_all.min(of_one) as usize
}

/// A buffer of so many bytes, without contents, that shaders write and that is read from.
pub fn storage(gpu: &Gpu, size: u64) -> Result<Buffer, GpuError> {
    let limit = gpu.device.limits().max_buffer_size;
    if size > limit {
        return Err(GpuError::TooManyBytes { what: WHAT.to_owned(), bytes: size, limit });
    }
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
    let descriptor = BufferDescriptor { label: Some(WHAT), size, usage, mapped_at_creation: false };
    gpu.checked(WHAT, || gpu.device.create_buffer(&descriptor))
}
