//! Photon maps on the device: photons of a pass are traced, written as they arrive, counted, and sorted where they have
//! landed; the map does not depend on who came first.
//!
//! The kernels are those of `shaders/pathtrace/integrator/photon/`.

use super::GpuTraceError;
use super::photon_data::{Grid, Photon, PhotonCounts, PhotonParams};
use super::photon_sources::PhotonSources;
use super::pipelines::{BufferKind, group, layout_of};
use super::slices::Slices;
use super::timing::Pace;
use crate::integrator::photon::{PhotonSettings, radius_of_pass};
use crate::shaders;
use crate::stats::Stats;
use gpu::{Gpu, GpuError, wgpu};
use wgpu::{BindGroup, BindGroupLayout, Buffer, BufferUsages, ComputePipeline};

const WHAT: &str = "a pass of photons";

/// Photons at surfaces for each that leaves a light, as far as there is room before they are counted.
const USUAL_SHARE: u32 = 4;

/// Entry points of `sort.wgsl`, in their order.
const STEPS: [&str; 4] = ["count", "allot", "collect", "order"];

/// Where photons are traced and sorted.
#[derive(Debug)]
pub(crate) struct PhotonMaps {
    sort_layout: BindGroupLayout,
    steps: Vec<ComputePipeline>,
    /// Of tracing, and of each step of sorting.
    paces: [Pace; 1 + STEPS.len()],
    /// What the paces were learned of.
    effort: Option<PhotonSettings>,
    room: Option<Room>,
    /// The last map, and what it is of.
    made: Option<(PassKey, BindGroup)>,
}

/// What photons of a pass are a function of, beside the shapes of a scene.
#[derive(Debug, PartialEq)]
struct PassKey {
    settings: PhotonSettings,
    number: u32,
    radius: f32,
    /// What sends them out and what they are aimed at, as the device reads it.
    emission: Vec<u8>,
}

/// What one pass of photons works with.
pub(crate) struct PhotonWork<'a> {
    pub walk: &'a ComputePipeline,
    pub scene: &'a BindGroup,
    /// Of what walks are bound to beside the scene, and of what eyes read.
    pub layouts: [&'a BindGroupLayout; 2],
    pub sources: &'a PhotonSources,
    pub settings: &'a PhotonSettings,
    /// Which of the passes.
    pub number: u32,
    pub slices: Slices<'a>,
}

/// Buffers for so many photons.
#[derive(Debug)]
struct Room {
    /// Of passes that send out as many.
    of_photons: u32,
    capacity: u32,
    asked: Buffer,
    list: Buffer,
    /// How the list begins, to be read.
    counts: Buffer,
    map: Buffer,
    buckets: Buffer,
    entries: Buffer,
}

impl PhotonMaps {
    /// Compiles the kernels that sort photons into buckets.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the device can't take it.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuTraceError> {
        let module = shaders::compose("pathtrace/integrator/photon/sort.wgsl")?.create(gpu)?;
        let (sort_layout, steps) = gpu.checked("the sorting of photons", || {
            let kinds = [BufferKind::Uniform, BufferKind::Read, BufferKind::Written];
            let sort_layout = layout_of(gpu, &[&kinds[..], &[BufferKind::Written; 2]].concat());
            let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &[Some(&sort_layout)],
                immediate_size: 0,
            });
            let pipeline = |entry_point| {
                gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry_point),
                    layout: Some(&pipeline_layout),
                    module: &module,
                    entry_point: Some(entry_point),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    cache: None,
                })
            };
            let steps = STEPS.map(pipeline).into();
            (sort_layout, steps)
        })?;
        Ok(PhotonMaps { sort_layout, steps, paces: Default::default(), effort: None, room: None, made: None })
    }

    /// Photons of another scene are others, and may take longer.
    pub fn forget(&mut self) {
        self.made = None;
        self.paces.iter_mut().for_each(Pace::doubt);
    }

    /// The map of a pass, for the group that eyes read, and what it took: nothing where the last one is asked for again.
    /// `None` where it was stopped.
    ///
    /// # Errors
    /// [`GpuTraceError::Photons`] where more photons land than the device has room for.
    pub fn make(
        &mut self,
        work: &mut PhotonWork,
        stop: &impl Fn() -> bool,
    ) -> Result<Option<(BindGroup, Stats)>, GpuTraceError> {
        let key = work.key();
        // samples that were stopped go on with the map that they had
        if let Some((_, map)) = self.made.as_ref().filter(|(made, _)| *made == key) {
            return Ok(Some((map.clone(), Stats::default())));
        }
        self.made = None;
        self.begin(work.settings.effort());
        let Some((room, counts)) = self.traced(work, stop)? else { return Ok(None) };
        let gpu = work.slices.gpu;
        let sorted = self.sort(work, &room, counts.found, stop)?;
        let map = group(gpu, WHAT, work.layouts[1], &[&room.map])?;
        self.room = Some(room);
        self.made = sorted.then(|| (key, map.clone()));
        Ok(sorted.then(|| (map, work.took(&counts))))
    }

    /// Learns the paces anew where passes cost something else.
    fn begin(&mut self, effort: PhotonSettings) {
        if self.effort != Some(effort) {
            (self.effort, self.paces) = (Some(effort), Default::default());
        }
    }

    /// The photons of a pass in a list that is long enough for all of them; `None` where it was stopped.
    fn traced(
        &mut self,
        work: &mut PhotonWork,
        stop: &impl Fn() -> bool,
    ) -> Result<Option<(Room, PhotonCounts)>, GpuTraceError> {
        let (gpu, photons) = (work.slices.gpu, work.settings.photons);
        let mut room = match self.room.take() {
            Some(room) if room.of_photons == photons => room,
            _ => Room::new(gpu, photons, photons.saturating_mul(USUAL_SHARE).min(most_photons(gpu)))?,
        };
        loop {
            let Some(counts) = self.trace(work, &room, stop)? else {
                self.room = Some(room);
                return Ok(None);
            };
            if counts.found <= room.capacity {
                return Ok(Some((room, counts)));
            }
            drop(room);
            room = Room::new(gpu, photons, with_reserve(gpu, counts.found)?)?;
        }
    }

    /// Traces the photons of a pass into a list.
    fn trace(
        &mut self,
        work: &mut PhotonWork,
        room: &Room,
        stop: &impl Fn() -> bool,
    ) -> Result<Option<PhotonCounts>, GpuTraceError> {
        let gpu = work.slices.gpu;
        let emission = gpu.buffer("what sends out photons", &work.sources.emission, BufferUsages::STORAGE)?;
        let bound = group(gpu, WHAT, work.layouts[0], &[&room.asked, &emission, &room.list])?;
        gpu.queue.write_buffer(&room.list, 0, &[0; size_of::<PhotonCounts>()]);
        let (walk, groups) = (work.walk, [work.scene, &bound]);
        let params = work.params(room.capacity);
        let ask = |first, end| room.ask(gpu, PhotonParams { first, end, ..params });
        let photons = work.settings.photons;
        let all = work.slices.run((walk, &groups), &mut self.paces[0], photons, ask, stop)?;
        if all { room.read_counts(gpu).map(Some) } else { Ok(None) }
    }

    /// Sorts a list of so many photons into a map; false where it was stopped.
    fn sort(
        &mut self,
        work: &mut PhotonWork,
        room: &Room,
        found: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<bool, GpuTraceError> {
        let gpu = work.slices.gpu;
        let grid = Grid::new(work.sources.origin, work.radius(), found);
        room.begin_sorting(gpu, &grid);
        let buffers = [&room.asked, &room.list, &room.map, &room.buckets, &room.entries];
        let bound = group(gpu, WHAT, &self.sort_layout, &buffers)?;
        let params = work.params(room.capacity);
        // two buckets in each word before the photons
        let items = [found, grid.photons, found, found];
        for ((pipeline, pace), items) in self.steps.iter().zip(&mut self.paces[1..]).zip(items) {
            let ask = |first, end| room.ask(gpu, PhotonParams { first, end, ..params });
            if !work.slices.run((pipeline, &[&bound]), pace, items, ask, stop)? {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

impl PhotonWork<'_> {
    fn key(&self) -> PassKey {
        let (settings, number, radius) = (*self.settings, self.number, self.radius());
        PassKey { settings, number, radius, emission: self.sources.emission.clone() }
    }

    fn took(&self, counts: &PhotonCounts) -> Stats {
        let (photons, cut_photons) = (self.settings.photons.into(), counts.cut_photons.into());
        Stats { photons, cut_photons, rays: counts.all_rays(), ..Stats::default() }
    }

    fn params(&self, capacity: u32) -> PhotonParams {
        let PhotonSettings { photons, seed, .. } = *self.settings;
        PhotonParams { first: 0, end: 0, number: self.number, photons, seed, capacity }
    }

    fn radius(&self) -> f32 {
        radius_of_pass(self.sources.radius, self.settings.alpha, self.number)
    }
}

impl Room {
    fn new(gpu: &Gpu, of_photons: u32, capacity: u32) -> Result<Self, GpuTraceError> {
        let buckets = u64::from(capacity.next_power_of_two().max(2));
        let (photons, words) = (u64::from(capacity) * size_of::<Photon>() as u64, buckets * 8);
        let buffer = |size: u64, usage| {
            let descriptor = wgpu::BufferDescriptor { label: Some(WHAT), size, usage, mapped_at_creation: false };
            gpu.checked(WHAT, || gpu.device.create_buffer(&descriptor))
        };
        let storage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let counts = size_of::<PhotonCounts>() as u64;
        let of_all = || -> Result<Self, GpuError> {
            Ok(Room {
                of_photons,
                capacity,
                // uniforms come in 16 bytes
                asked: buffer((size_of::<PhotonParams>() as u64).next_multiple_of(16), uniform)?,
                list: buffer(counts + photons, storage)?,
                counts: buffer(counts, BufferUsages::COPY_DST | BufferUsages::COPY_SRC)?,
                map: buffer(size_of::<Grid>() as u64 + words + photons, storage)?,
                buckets: buffer(4 * (buckets + 1), storage)?,
                entries: buffer(8 * u64::from(capacity), storage)?,
            })
        };
        Ok(of_all()?)
    }

    fn ask(&self, gpu: &Gpu, params: PhotonParams) {
        gpu.queue.write_buffer(&self.asked, 0, bytemuck::bytes_of(&params));
    }

    /// What was found. Waits for it.
    fn read_counts(&self, gpu: &Gpu) -> Result<PhotonCounts, GpuTraceError> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(WHAT) });
        encoder.copy_buffer_to_buffer(&self.list, 0, &self.counts, 0, self.counts.size());
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.read_buffer(WHAT, &self.counts)?;
        Ok(bytemuck::pod_read_unaligned(&bytes))
    }

    /// No bucket has any photon so far.
    fn begin_sorting(&self, gpu: &Gpu, grid: &Grid) {
        gpu.queue.write_buffer(&self.map, 0, bytemuck::bytes_of(grid));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(WHAT) });
        encoder.clear_buffer(&self.buckets, 0, Some(4 * (u64::from(grid.mask) + 2)));
        gpu.queue.submit([encoder.finish()]);
    }
}

/// Most photons of a map: each has its own bytes there, and up to two buckets of eight.
fn most_photons(gpu: &Gpu) -> u32 {
    let limits = gpu.device.limits();
    let bytes = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
    let of_photon = (size_of::<Photon>() + 16) as u64;
    (bytes.saturating_sub(64) / of_photon).min(u64::from(u32::MAX / 8)) as u32
}

/// Room for so many photons, and for some more that the next pass may find.
fn with_reserve(gpu: &Gpu, found: u32) -> Result<u32, GpuTraceError> {
    let limit = most_photons(gpu);
    if found > limit {
        return Err(GpuTraceError::Photons { found, limit, adapter: gpu.describe() });
    }
    Ok(found.saturating_add(found / 4).min(limit))
}

#[cfg(test)]
mod tests;
