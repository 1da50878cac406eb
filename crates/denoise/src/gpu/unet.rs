//! The U-Net of Open Image Denoise on the graphics device: the graph and the weights of [`Network`], and what is around
//! it, in the shaders of `shaders/denoise/unet/`. Values between layers may be of half precision where a device has that,
//! sums are of single.

mod places;
mod timing;
pub(crate) mod weights;

pub use timing::LayerTime;

use super::shaders::LIBRARY;
use crate::network::{ALIGNMENT, Network, Place};
use crate::tiles::{Tile, tiles};
use crate::transfer::{Transfer, exposure, sanitized};
use crate::{DenoiseError, Features, Stop, check_memory};
use film::{Image, Vec3};
use gpu::compute::{Binding, Compute};
use gpu::waiting::PATIENCE;
use gpu::wgpu::{self, BindGroup, Buffer, BufferUsages, SubmissionIndex};
use gpu::wgsl::{self, Source};
use gpu::{Gpu, GpuError};
use places::{MOST_OPERATIONS, Places, most_pixels, storage};
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};
use weights::{Layer, packed};

/// Bytes of values between layers that are on the device at once: a picture of 1920 x 1080 in one tile,
/// also of single precision.
const MOST_BYTES: u64 = 1 << 30;

/// The last layer gives three channels.
pub(super) const ONE_BLOCK: [(&str, f64); 1] = [("BLOCKS", 1.0)];

/// Comes in the place of `number.wgsl` where values are halves.
const HALF: &[Source<'static>] = &[Source {
    path: "denoise/unet/number.wgsl",
    text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders/denoise/unet/number_half.wgsl")),
}];

const WHAT: &str = "a denoised picture";

/// Of what precision values between layers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Numbers {
    /// 16 bits, on devices that have them.
    Half,
    /// Single precision, 32 bits a number.
    Single,
}

impl Numbers {
    /// Those that a device can take, the smallest first.
    pub fn available(gpu: &Gpu) -> impl Iterator<Item = Numbers> {
        let half = gpu.device.features().contains(wgpu::Features::SHADER_F16);
        [Numbers::Half, Numbers::Single].into_iter().skip(usize::from(!half))
    }

    /// Bytes of four channels of a pixel.
    fn block(self) -> u64 {
        match self {
            Numbers::Half => 8,
            Numbers::Single => 16,
        }
    }

    fn library(self) -> Vec<&'static [Source<'static>]> {
        match self {
            Numbers::Half => [&[HALF][..], &LIBRARY].concat(),
            Numbers::Single => LIBRARY.to_vec(),
        }
    }
}

/// A network on a device. It keeps its memory there from one picture to the next of the same size.
#[derive(Debug)]
pub struct GpuUnet {
    gpu: Gpu,
    numbers: Numbers,
    shaders: Shaders,
    layers: Vec<Layer>,
    weights: Buffer,
    places: Mutex<Option<Places>>,
    /// Floating-point operations of a submission, about as many at most.
    most_operations: f64,
}

#[derive(Debug)]
struct Shaders {
    input: Compute,
    layer: Compute,
    output: Compute,
}

impl Shaders {
    fn new(gpu: &Gpu, numbers: Numbers) -> Result<Self, GpuError> {
        let shader = |name: &str, entry_point: &str, bindings: &[Binding], constants: &[(&str, f64)]| {
            let composed = wgsl::compose(&numbers.library(), &format!("denoise/unet/{name}.wgsl"))?;
            Compute::new(gpu, &composed, entry_point, None, bindings, constants)
        };
        use Binding::{Read, Uniform, Written};
        Ok(Shaders {
            input: shader("input", "fill", &[Uniform, Read, Written], &[])?,
            layer: shader("layer", "convolve", &[Uniform, Read, Read, Read, Written], &[])?,
            output: shader("output", "convolve", &[Uniform, Read, Read, Read, Written, Uniform], &ONE_BLOCK)?,
        })
    }
}

/// A part of a picture as the shaders know it.
#[derive(Debug, Clone, Copy, bytemuck::NoUninit)]
#[repr(C)]
struct TileParams {
    size: [u32; 2],
    inside: [u32; 2],
    first: [u32; 2],
    written: [u32; 2],
    exposure: f32,
    white: f32,
    /// Uniforms come in 16 bytes.
    padding: [u32; 2],
}

impl TileParams {
    fn new(tile: &Tile, picture: [usize; 2], transfer: Transfer) -> Self {
        let of = |axis: usize| {
            let (read, written) = (&tile.read[axis], &tile.written[axis]);
            [read.len(), read.end.min(picture[axis]) - read.start, written.start - read.start]
                .into_iter()
                .chain([written.end.min(picture[axis]) - written.start])
                .map(|number| number as u32)
                .collect::<Vec<_>>()
        };
        let [columns, rows] = [0, 1].map(of);
        let both = |index: usize| [columns[index], rows[index]];
        let Transfer { exposure, white } = transfer;
        let [size, inside, first, written] = [0, 1, 2, 3].map(both);
        TileParams { size, inside, first, written, exposure, white, padding: [0; 2] }
    }
}

impl GpuUnet {
    /// A network with numbers of single precision, whose pictures are the processor's but for rounding. With halves they are up to
    /// 3e-3 of it apart (relative L2), where lamps are bright.
    ///
    /// # Errors
    /// [`GpuError`] if the device does not take it.
    pub fn new(gpu: &Gpu, network: &Network) -> Result<Self, GpuError> {
        GpuUnet::with_numbers(gpu, network, Numbers::Single)
    }

    /// A network with these numbers.
    ///
    /// # Errors
    /// [`GpuError`] if the device does not take it.
    pub fn with_numbers(gpu: &Gpu, network: &Network, numbers: Numbers) -> Result<Self, GpuError> {
        let (layers, weights) = packed(network);
        let weights = gpu.buffer("the weights of a denoising network", &weights, BufferUsages::STORAGE)?;
        let shaders = Shaders::new(gpu, numbers)?;
        Ok(GpuUnet {
            gpu: gpu.clone(),
            numbers,
            shaders,
            layers,
            weights,
            places: Mutex::new(None),
            most_operations: MOST_OPERATIONS,
        })
    }

    /// As [`Network::denoise`], to roundings. Memory on the device: at most 1 GiB for values between layers, and 60 bytes
    /// for each pixel of a tile.
    ///
    /// # Errors
    /// [`DenoiseError`] if features are of another size, `stop` said so (asked between layers), or the device failed.
    pub fn denoise(&self, color: &Image, features: Features, stop: Stop) -> Result<Image, DenoiseError> {
        self.denoise_in_tiles(color, features, self.most_pixels(), stop)
    }

    /// As [`GpuUnet::denoise`], with at most so many pixels on the device at once.
    ///
    /// # Errors
    /// As [`GpuUnet::denoise`].
    pub fn denoise_in_tiles(
        &self,
        color: &Image,
        features: Features,
        most_pixels: usize,
        stop: Stop,
    ) -> Result<Image, DenoiseError> {
        features.check(color)?;
        let picture = [color.width() as usize, color.height() as usize];
        // the picture that comes out, and what goes in of a tile
        let of_tile = color.radiances().len().min(most_pixels);
        check_memory(size_of_val(color.radiances()) + size_of::<[Vec3; 4]>() * of_tile)?;
        let transfer = Transfer::new(exposure(color.radiances(), picture[0]));
        let mut denoised = vec![Vec3::ZERO; color.radiances().len()];
        for tile in tiles(picture, most_pixels) {
            let pixels = pixels(&tile, picture, color.radiances(), features);
            let params = TileParams::new(&tile, picture, transfer);
            let radiances = self.run(&params, &pixels, stop)?;
            let width = params.written[0] as usize;
            let rows = denoised.chunks_mut(picture[0]).skip(tile.written[1].start);
            for (row, written) in rows.zip(radiances.chunks_exact(width)) {
                row[tile.written[0].start..][..width].copy_from_slice(written);
            }
        }
        Image::new(color.width(), color.height(), denoised).ok_or(DenoiseError::Size)
    }

    /// How many pixels the device holds at once.
    fn most_pixels(&self) -> usize {
        let limits = self.gpu.device.limits();
        let largest = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        most_pixels(&self.layers, self.numbers.block(), MOST_BYTES, largest)
    }

    /// Floating-point operations for each pixel, those of channels that pad a block included.
    pub fn operations_per_pixel(&self) -> f64 {
        let (_, layers) = weights::sized(&self.layers, [ALIGNMENT, ALIGNMENT]);
        layers.iter().map(timing::operations).sum::<f64>() / (ALIGNMENT * ALIGNMENT) as f64
    }

    /// What the network says of the pixels of a tile.
    fn run(&self, tile: &TileParams, pixels: &[[Vec3; 3]], stop: Stop) -> Result<Vec<Vec3>, DenoiseError> {
        let places = self.places(tile.size.map(|side| side as usize))?;
        let made = self.run_in(&places, tile, pixels, stop);
        // also of a picture that was stopped: the queue keeps the order of what comes next
        if matches!(made, Ok(_) | Err(DenoiseError::Stopped)) {
            *self.places.lock().unwrap_or_else(PoisonError::into_inner) = Some(places);
        }
        made
    }

    fn run_in(
        &self,
        places: &Places,
        tile: &TileParams,
        pixels: &[[Vec3; 3]],
        stop: Stop,
    ) -> Result<Vec<Vec3>, DenoiseError> {
        let source = self.gpu.buffer("a noisy picture", pixels, BufferUsages::STORAGE)?;
        let params = self.gpu.buffer("a tile", std::slice::from_ref(tile), BufferUsages::UNIFORM)?;
        let [columns, rows] = tile.written.map(u64::from);
        let radiances = storage(&self.gpu, columns * rows * size_of::<Vec3>() as u64)?;
        let mut queue = Queue { gpu: &self.gpu, before: None, stop };
        queue.submit(&self.shaders.input, [tile.size[0], tile.size[1], 1], || {
            let bound = [&params, &source, places.at(Place::Input)].map(Buffer::as_entire_binding);
            self.shaders.input.bind(&self.gpu, &bound)
        })?;
        for slice in &places.slices {
            let items = items(&slice.layer);
            match &slice.group {
                Some(group) => queue.submit(&self.shaders.layer, items, || group.clone())?,
                None => queue.submit(&self.shaders.output, items, || {
                    let mut bound = places.bound(slice, &self.weights);
                    bound.extend([&radiances, &params].map(Buffer::as_entire_binding));
                    self.shaders.output.bind(&self.gpu, &bound)
                })?,
            }
        }
        let bytes = self.gpu.read_buffer(WHAT, &radiances)?;
        Ok(bytes.chunks_exact(size_of::<Vec3>()).map(bytemuck::pod_read_unaligned).map(sanitized).collect())
    }

    /// Memory for inputs of this size: that of the picture before if it fits.
    fn places(&self, size: [usize; 2]) -> Result<Places, GpuError> {
        let most = self.most_operations;
        let kept = self.places.lock().unwrap_or_else(PoisonError::into_inner).take();
        match kept.filter(|places| places.size == size) {
            Some(places) => Ok(places),
            None => {
                Places::new(&self.gpu, &self.shaders, &self.layers, &self.weights, size, (self.numbers.block(), most))
            }
        }
    }
}

/// Threads of a layer along x, y and z: a workgroup of them for each group of blocks and each tile of pixels.
fn items(layer: &Layer) -> [u32; 3] {
    [64 * layer.groups(), layer.size[0].div_ceil(weights::TILE as u32), layer.rows]
}

/// Colour, albedo and normal of the pixels of a tile that the picture has.
fn pixels(tile: &Tile, picture: [usize; 2], color: &[Vec3], features: Features) -> Vec<[Vec3; 3]> {
    let [columns, rows] = [0, 1].map(|axis| tile.read[axis].start..tile.read[axis].end.min(picture[axis]));
    let pixel = |index: usize| [color[index], features.albedo[index], features.normal[index]];
    let width = columns.len();
    let at = |i: usize| pixel((rows.start + i / width) * picture[0] + columns.start + i % width);
    (0..width * rows.len()).into_par_iter().map(at).collect()
}

/// Submissions one after the other, some rows of a layer each, so that none takes long where a device is slow: two are on
/// their way at most.
struct Queue<'a> {
    gpu: &'a Gpu,
    before: Option<SubmissionIndex>,
    stop: Stop<'a>,
}

impl Queue<'_> {
    fn submit(
        &mut self,
        shader: &Compute,
        items: [u32; 3],
        group: impl FnOnce() -> BindGroup,
    ) -> Result<(), DenoiseError> {
        if (self.stop)() {
            return Err(DenoiseError::Stopped);
        }
        let index = self.gpu.checked(WHAT, || {
            let group = group();
            let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            shader.record(&mut pass, None, &group, items);
            drop(pass);
            self.gpu.queue.submit([encoder.finish()])
        })?;
        match self.before.replace(index) {
            Some(before) => self.finish(&before),
            None => Ok(()),
        }
    }

    fn finish(&self, submission: &SubmissionIndex) -> Result<(), DenoiseError> {
        if self.gpu.wait(WHAT, Some(submission), PATIENCE)? {
            return Ok(());
        }
        let why = format!("a layer of the network took more than {} seconds", PATIENCE.as_secs());
        Err(self.gpu.lost(WHAT, why).into())
    }
}

#[cfg(test)]
mod tests;
