//! A-trous wavelets on a graphics device: guides and light without albedo, levels from one list of light to the other and
//! back, and albedo again. Shaders: `shaders/denoise/a_trous/`.

use super::{shaders, wait};
use crate::a_trous::{Guide, LEVELS};
use crate::{DenoiseError, Stop, check_memory};
use film::{Image, Vec3};
use gpu::compute::{Binding, Compute};
use gpu::{Gpu, GpuError, wgpu};
use wgpu::{BindGroup, Buffer, BufferUsages};

const WHAT: &str = "a picture to denoise";

/// Bytes of a pixel in the largest of the lists.
const MOST_BYTES: u64 = 16;

/// The filter, compiled for a device.
#[derive(Debug)]
pub struct GpuATrous {
    gpu: Gpu,
    prepare: Compute,
    moments: Compute,
    level: Compute,
    finish: Compute,
}

/// A picture and what is known of it, on the device.
#[derive(Debug)]
pub struct DevicePicture {
    size: (u32, u32),
    colors: Buffer,
    knows_variance: bool,
    prepare: BindGroup,
    /// Of the passes over light, one after the other.
    passes: Vec<BindGroup>,
    finish: BindGroup,
}

/// As the shaders read them.
#[derive(Debug, Clone, Copy, bytemuck::NoUninit)]
#[repr(C)]
struct Params {
    width: u32,
    height: u32,
    step: u32,
    knows_variance: u32,
}

impl GpuATrous {
    /// Compiles the passes, which takes a moment: once for each device.
    ///
    /// # Errors
    /// [`DenoiseError::Device`] if the device can't take them.
    pub fn new(gpu: &Gpu) -> Result<Self, DenoiseError> {
        let compute = |file: &str, entry_point: &str, read: usize, written: usize| {
            let shader = shaders::compose(&format!("denoise/a_trous/{file}")).map_err(GpuError::from)?;
            let lists = [vec![Binding::Read; read], vec![Binding::Written; written]].concat();
            let bindings = [&[Binding::Uniform][..], &lists].concat();
            Compute::new(gpu, &shader, entry_point, None, &bindings, &[])
        };
        Ok(GpuATrous {
            gpu: gpu.clone(),
            prepare: compute("prepare.wgsl", "prepare", 5, 3)?,
            moments: compute("pass.wgsl", "moments", 3, 1)?,
            level: compute("pass.wgsl", "level", 3, 1)?,
            finish: compute("finish.wgsl", "finish", 2, 1)?,
        })
    }

    /// As [`crate::a_trous::a_trous`], but for rounding: normals and albedos guide in sixteen bits a component.
    ///
    /// # Errors
    /// [`DenoiseError`] if a layer is of another size, if `stop` said so, or if the device has no memory for it or fails.
    pub fn apply(&self, color: &Image, guide: Guide, stop: Stop) -> Result<Image, DenoiseError> {
        let picture = self.upload(color, guide)?;
        if stop() {
            return Err(DenoiseError::Stopped);
        }
        wait(&self.gpu, WHAT, &self.submit(&picture)?, stop)?;
        self.read(&picture)
    }

    /// Brings a picture to the device.
    ///
    /// # Errors
    /// As [`GpuATrous::apply`].
    pub fn upload(&self, color: &Image, guide: Guide) -> Result<DevicePicture, DenoiseError> {
        guide.check(color)?;
        // a lost device would call it a fault of the first buffer
        self.gpu.look(WHAT)?;
        let pixels = color.radiances().len() as u64;
        self.check_room(pixels)?;
        let given = |data: &[f32]| self.gpu.buffer(WHAT, data, BufferUsages::STORAGE);
        let rgb = |data: &[Vec3]| given(bytemuck::cast_slice(data));
        let colors = bytemuck::cast_slice::<_, f32>(color.radiances());
        let colors = self.gpu.buffer(WHAT, colors, BufferUsages::STORAGE | BufferUsages::COPY_SRC)?;
        let [normals, albedos] = [rgb(guide.features.normal)?, rgb(guide.features.albedo)?];
        let [depths, variances] = [given(guide.depth)?, given(guide.variance.unwrap_or_default())?];
        let [guides, slopes] = [self.room(16 * pixels)?, self.room(8 * pixels)?];
        let light = [self.room(16 * pixels)?, self.room(16 * pixels)?];
        let params = self.params(color.size(), guide.variance.is_some())?;
        let of_picture = [&params[0], &colors, &normals, &albedos, &depths, &variances, &guides, &slopes, &light[0]];
        let passes = self.passes(guide.variance.is_some()).zip(&params).zip(0..);
        let bound = passes.map(|((pass, params), number)| {
            let [from, to] = [&light[number % 2], &light[(number + 1) % 2]];
            bind(&self.gpu, pass, &[params, &guides, &slopes, from, to])
        });
        let passes: Vec<BindGroup> = bound.collect::<Result<_, _>>()?;
        let last = &light[passes.len() % 2];
        Ok(DevicePicture {
            size: color.size(),
            prepare: bind(&self.gpu, &self.prepare, &of_picture)?,
            finish: bind(&self.gpu, &self.finish, &[&params[0], &albedos, last, &colors])?,
            passes,
            knows_variance: guide.variance.is_some(),
            colors,
        })
    }

    /// Sends all passes on their way; the picture becomes the denoised one.
    ///
    /// # Errors
    /// [`DenoiseError::Device`] if the device objects.
    pub fn submit(&self, picture: &DevicePicture) -> Result<wgpu::SubmissionIndex, DenoiseError> {
        let items = [picture.size.0, picture.size.1, 1];
        let levels = self.passes(picture.knows_variance).zip(&picture.passes);
        let all = std::iter::once((&self.prepare, &picture.prepare));
        let all = all.chain(levels).chain(std::iter::once((&self.finish, &picture.finish)));
        // one submission each, between which a slow device draws the frames of a window
        let submit = |(compute, bound): (&Compute, &BindGroup)| {
            let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            compute.record(&mut pass, None, bound, items);
            drop(pass);
            self.gpu.queue.submit([encoder.finish()])
        };
        let last = self.gpu.checked(WHAT, || all.map(submit).last())?;
        last.ok_or(DenoiseError::Size)
    }

    /// The picture as it is on the device.
    ///
    /// # Errors
    /// [`DenoiseError::Device`] if the device fails.
    pub fn read(&self, picture: &DevicePicture) -> Result<Image, DenoiseError> {
        let (width, height) = picture.size;
        // bytes, and pixels of them
        check_memory(3 * size_of::<Vec3>() * width as usize * height as usize)?;
        let bytes = self.gpu.read_buffer(WHAT, &picture.colors)?;
        let pixels = bytes.chunks_exact(size_of::<Vec3>()).map(bytemuck::pod_read_unaligned::<Vec3>);
        let pixels = pixels.take(width as usize * height as usize).collect::<Vec<_>>();
        Image::new(width, height, pixels).ok_or(DenoiseError::Size)
    }

    /// What goes over light.
    fn passes(&self, knows_variance: bool) -> impl Iterator<Item = &Compute> {
        let moments = (!knows_variance).then_some(&self.moments);
        moments.into_iter().chain((0..LEVELS).map(|_| &self.level))
    }

    /// What each pass is told.
    fn params(&self, (width, height): (u32, u32), knows_variance: bool) -> Result<Vec<Buffer>, DenoiseError> {
        let moments = (!knows_variance).then_some(1);
        let steps = moments.into_iter().chain((0..LEVELS).map(|level| 1 << level));
        let params = steps.map(|step| Params { width, height, step, knows_variance: u32::from(knows_variance) });
        Ok(params.map(|params| self.gpu.buffer(WHAT, &[params], BufferUsages::UNIFORM)).collect::<Result<_, _>>()?)
    }

    /// That no list is longer than the device allows.
    fn check_room(&self, pixels: u64) -> Result<(), GpuError> {
        let limits = self.gpu.device.limits();
        let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        let bytes = MOST_BYTES * pixels;
        if bytes <= limit { Ok(()) } else { Err(GpuError::TooManyBytes { what: WHAT.into(), bytes, limit }) }
    }

    fn room(&self, bytes: u64) -> Result<Buffer, GpuError> {
        let (size, usage) = (bytes.max(MOST_BYTES), BufferUsages::STORAGE);
        let descriptor = wgpu::BufferDescriptor { label: Some(WHAT), size, usage, mapped_at_creation: false };
        self.gpu.checked(WHAT, || self.gpu.device.create_buffer(&descriptor))
    }
}

fn bind(gpu: &Gpu, compute: &Compute, buffers: &[&Buffer]) -> Result<BindGroup, GpuError> {
    let resources: Vec<_> = buffers.iter().map(|buffer| buffer.as_entire_binding()).collect();
    gpu.checked(WHAT, || compute.bind(gpu, &resources))
}
