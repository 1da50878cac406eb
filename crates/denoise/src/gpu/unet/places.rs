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
    /// What is submitted by itself, in the order of work.
    pub slices: Vec<Slice>,
    buffers: Vec<Buffer>,
}

/// Some rows of a layer.
#[derive(Debug)]
pub struct Slice {
    /// The layer's row in the graph of the network.
    pub index: usize,
    /// It, over these rows.
    pub layer: Layer,
    /// What it is bound to; nothing of the last one, which writes a picture.
    pub group: Option<BindGroup>,
    params: Buffer,
}

/// Operations of a submission: a millisecond of a fast device, and half a frame of one that does .25 Tflop/s, which
/// draws a window meanwhile.
pub const MOST_OPERATIONS: f64 = 8e9;

impl Places {
    /// Memory for values of so many bytes a `block` of four channels, and layers in slices of so many operations.
    ///
    /// # Errors
    /// [`GpuError`] if the device has not so much.
    pub fn new(
        gpu: &Gpu,
        shaders: &Shaders,
        layers: &[Layer],
        weights: &Buffer,
        size: [usize; 2],
        (block, most_operations): (u64, f64),
    ) -> Result<Self, GpuError> {
        let (blocks, layers) = sized(layers, size);
        let buffers = blocks.map(|blocks| storage(gpu, blocks * block)).into_iter().collect::<Result<Vec<_>, _>>()?;
        let mut places = Places { size, layers, slices: Vec::new(), buffers };
        let sliced = places.layers.iter().enumerate();
        let sliced = sliced.flat_map(|(index, layer)| layer.slices(most_operations).map(move |slice| (index, slice)));
        places.slices = sliced.map(|part| places.slice(gpu, shaders, weights, part)).collect::<Result<_, _>>()?;
        Ok(places)
    }

    fn slice(
        &self,
        gpu: &Gpu,
        shaders: &Shaders,
        weights: &Buffer,
        (index, layer): (usize, Layer),
    ) -> Result<Slice, GpuError> {
        let params = gpu.buffer(WHAT, &[layer], BufferUsages::UNIFORM)?;
        let mut slice = Slice { index, layer, group: None, params };
        if index + 1 < GRAPH.len() {
            let written = self.at(GRAPH[index].writes).as_entire_binding();
            let bound = [&self.bound(&slice, weights)[..], &[written]].concat();
            slice.group = Some(gpu.checked(WHAT, || shaders.layer.bind(gpu, &bound))?);
        }
        Ok(slice)
    }

    /// What a layer is bound to beside where it writes: a layer that reads one place has it in both roles.
    pub fn bound<'a>(&'a self, slice: &'a Slice, weights: &'a Buffer) -> Vec<gpu::wgpu::BindingResource<'a>> {
        let reads = GRAPH[slice.index].reads;
        let [halved, full] = [reads[0].0, reads[reads.len() - 1].0].map(|place| self.at(place));
        [&slice.params, halved, full, weights].map(Buffer::as_entire_binding).to_vec()
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
