//! Features on a graphics device. The sums of some pixels at a time go there, each dispatch adds a sample to some of them,
//! and they come back: whatever becomes of the device, the film is here, and the processor can go on with it.
//!
//! Mirror of `FeatureParams` in `shaders/pathtrace/features.wgsl`.

use super::sums::Sums;
use super::{FeatureFilm, FeaturePass};
use crate::drive::gpu::film_data::PictureFrame;
use crate::drive::gpu::pipelines::{Bound, group};
use crate::drive::gpu::slices::Slices;
use crate::drive::gpu::timing::Pace;
use crate::drive::gpu::{GpuTraceError, PipelineKey};
use crate::gpu_tracer::GpuTracer;
use crate::sampling::sampler::SamplerKind;
use crate::stats::Stats;
use bytemuck::{Pod, Zeroable};
use film::Features;
use gpu::{Gpu, wgpu};
use wgpu::{BindGroup, BindGroupLayout, BufferUsages, ComputePipeline};

/// What a dispatch is asked for.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FeatureParams {
    /// What the camera sees.
    pub frame: PictureFrame,
    /// Of the picture, in pixels.
    pub size: [u32; 2],
    /// The list at hand begins with this pixel of the picture ...
    pub start: u32,
    /// ... and these of it are sampled ...
    pub first: u32,
    /// ... up to before this one.
    pub end: u32,
    /// Samples that every pixel shall have.
    pub until: u32,
    /// The seed of the picture's random numbers.
    pub seed: u32,
    /// Fills the last 16 bytes, of which uniforms consist.
    pub unused: u32,
}

/// What errors call it.
pub(crate) const WHAT: &str = "what pixels show";

/// Pixels whose sums are on a device at a time, 48 MB of them. Whole groups of all kinds of lanes, as are what a dispatch
/// leaves, so that the processor can complete a pass that is stopped.
const MOST_PIXELS: usize = 1 << 20;

/// What a pass of features works with.
pub(crate) struct FeatureWork<'a> {
    pub pipeline: ComputePipeline,
    pub scene: &'a BindGroup,
    /// Of what is bound beside the scene.
    pub layout: &'a BindGroupLayout,
    pub pace: &'a mut Pace,
    pub slices: Slices<'a>,
}

impl GpuTracer {
    /// What denoisers are guided by, as [`crate::Tracer::features`]; `None` once `stop` says so.
    ///
    /// # Errors
    /// [`GpuTraceError`] if the device fails.
    pub fn features(
        &mut self,
        pass: &FeaturePass,
        stop: &impl Fn() -> bool,
    ) -> Result<Option<Features>, GpuTraceError> {
        let mut film = FeatureFilm::new(pass.size());
        self.add_features(&mut film, pass, stop)?;
        Ok(film.features().filter(|_| !stop()))
    }

    /// Adds samples to what is known of pixels, which are of the pass's size. `stop` is asked between dispatches; once it
    /// says so some are left without, which the next pass completes, wherever it is made.
    ///
    /// # Errors
    /// [`GpuTraceError`] if the device fails; `film` then lacks some samples, as if it had been stopped.
    pub fn add_features(
        &mut self,
        film: &mut FeatureFilm,
        pass: &FeaturePass,
        stop: &impl Fn() -> bool,
    ) -> Result<Stats, GpuTraceError> {
        let mut work = self.feature_work(&key(pass.sampler.0))?;
        let mut stats = Stats::default();
        let mut start = 0;
        for sums in film.sums.chunks_mut(pixels_at_a_time(work.slices.gpu)) {
            if stop() {
                break;
            }
            stats = stats.plus(work.add(pass, start, sums, stop)?);
            start += sums.len() as u32;
        }
        Ok(stats)
    }

    /// Whether features can be traced at once, without compiling anything first.
    pub fn has_compiled_features(&self, sampler: SamplerKind) -> bool {
        self.pipelines.has_compiled(&key(sampler))
    }
}

/// The shader, and what of a pass is compiled into it.
pub(crate) fn key(sampler: SamplerKind) -> PipelineKey {
    PipelineKey::new("pathtrace/features.wgsl", sampler, &[]).bound_to(Bound::Features)
}

/// As many as one binding holds.
fn pixels_at_a_time(gpu: &Gpu) -> usize {
    let limits = gpu.device.limits();
    let bytes = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
    // no device holds less than 2^16 of them
    let fit = (bytes / size_of::<Sums>() as u64).max(1).ilog2();
    MOST_PIXELS.min(1 << fit)
}

impl FeatureWork<'_> {
    /// Brings the pixels from `start` on to the pass's samples, as far as it is not stopped.
    fn add(
        &mut self,
        pass: &FeaturePass,
        start: u32,
        sums: &mut [Sums],
        stop: &impl Fn() -> bool,
    ) -> Result<Stats, GpuTraceError> {
        let gpu = self.slices.gpu;
        let params = pass.params(start);
        let asked = gpu.buffer("what is asked for", &[params], BufferUsages::UNIFORM | BufferUsages::COPY_DST)?;
        let on_device = gpu.buffer(WHAT, sums, BufferUsages::STORAGE | BufferUsages::COPY_SRC)?;
        let bound = group(gpu, WHAT, self.layout, &[&asked, &on_device])?;
        let ask = |first, end| {
            let params = FeatureParams { first, end, ..params };
            gpu.queue.write_buffer(&asked, 0, bytemuck::bytes_of(&params));
        };
        let least = sums.iter().map(|sums| sums.samples).min().unwrap_or(pass.samples);
        for _ in least..pass.samples {
            let groups = [self.scene, &bound];
            if !self.slices.run((&self.pipeline, &groups), self.pace, sums.len() as u32, ask, stop)? {
                break;
            }
        }
        let after: Vec<Sums> = bytemuck::pod_collect_to_vec(&gpu.read_buffer(WHAT, &on_device)?);
        let stats = sums.iter().zip(&after).map(|(before, after)| taken(before, after));
        let stats = stats.fold(Stats::default(), Stats::plus);
        sums.copy_from_slice(&after);
        Ok(stats)
    }
}

/// What the samples between two sums took.
fn taken(before: &Sums, after: &Sums) -> Stats {
    let (samples, rays) = (after.samples - before.samples, after.rays.wrapping_sub(before.rays));
    Stats { samples: samples.into(), rays: rays.into(), ..Stats::default() }
}

impl FeaturePass {
    fn params(&self, start: u32) -> FeatureParams {
        let FeaturePass { ref frame, size, samples: until, sampler: (_, seed) } = *self;
        FeatureParams { frame: frame.into(), size, start, until, seed, ..FeatureParams::zeroed() }
    }
}
