//! A film on the device: sums beside what a host's film already held, in bands of rows that each fit into one
//! binding.

use super::GpuTraceError;
use super::dispatch::Pass;
use super::film_data::{Pixel, RenderParams};
use crate::stats::Stats;
use film::Film;
use gpu::waiting::PATIENCE;
use gpu::{Gpu, GpuError, wgpu};
use rayon::prelude::*;
use std::sync::mpsc;
use wgpu::BufferUsages;

/// A film that a [`crate::gpu::GpuTracer`] adds samples to.
#[derive(Debug)]
pub struct GpuFilm {
    /// What was there before the device's sums.
    before: Film,
    /// What the sums in `before` took, as far as this film made them.
    stats: Stats,
    pub(crate) bands: Vec<Band>,
    /// Samples that every pixel has, those of `before` too.
    pub(crate) samples_done: u32,
    /// Samples of a pixel that the device may have summed since `before`.
    pub(crate) unfolded: u32,
    /// A pass that was stopped.
    pub(crate) pass: Option<Pass>,
    reading: Option<Reading>,
    /// Where the last reading arrived, for the next.
    staging: Vec<wgpu::Buffer>,
}

/// Rows of a film.
#[derive(Debug)]
pub(crate) struct Band {
    pub(crate) first_row: u32,
    pub(crate) rows: u32,
    pub(crate) sums: wgpu::Buffer,
    pub(crate) asked: wgpu::Buffer,
    pub(crate) group: wgpu::BindGroup,
}

/// Sums on their way to the host.
#[derive(Debug)]
struct Reading {
    staging: Vec<wgpu::Buffer>,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
    arrived: usize,
}

const WHAT: &str = "the path traced film";

impl GpuFilm {
    pub(crate) fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, before: Film) -> Result<Self, GpuTraceError> {
        let (width, height) = (before.width(), before.height());
        gpu.check_size(WHAT, width, height)?;
        let limits = gpu.device.limits();
        let row = u64::from(width) * size_of::<Pixel>() as u64;
        let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        let rows_that_fit = (limit / row).min(u64::from(height)) as u32;
        if rows_that_fit == 0 {
            return Err(GpuError::TooManyBytes { what: "a row of the film".to_owned(), bytes: row, limit }.into());
        }
        let bands = (0..height).step_by(rows_that_fit as usize).map(|first_row| {
            let rows = rows_that_fit.min(height - first_row);
            let pixels = before.pixels()[(first_row * width) as usize..][..(rows * width) as usize].iter();
            let pixels: Vec<Pixel> = pixels.map(|pixel| Pixel::beginning(pixel.samples)).collect();
            Band::new(gpu, layout, first_row, rows, &pixels)
        });
        let bands = bands.collect::<Result<_, GpuError>>()?;
        let samples_done = before.samples_per_pixel();
        Ok(GpuFilm {
            before,
            stats: Stats::default(),
            bands,
            samples_done,
            unfolded: 0,
            pass: None,
            reading: None,
            staging: Vec::new(),
        })
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.before.width()
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.before.height()
    }

    /// Samples that every pixel has.
    pub fn samples_per_pixel(&self) -> u32 {
        self.samples_done
    }

    /// Counts what was traced for the film beside its samples.
    pub(crate) fn count(&mut self, took: Stats) {
        self.stats = self.stats.plus(took);
    }

    /// The film as it is once all work handed in so far is done, and what it took. Waits for that.
    ///
    /// # Errors
    /// [`gpu::GpuError::Lost`] and others if the device fails.
    pub fn read(&mut self, gpu: &Gpu) -> Result<(Film, Stats), GpuTraceError> {
        // one that is on its way may be of less
        self.reading = None;
        self.begin_reading(gpu)?;
        loop {
            if let Some(read) = self.poll_reading(gpu)? {
                return Ok(read);
            }
            if !gpu.wait(WHAT, None, PATIENCE)? {
                return Err(GpuTraceError::Hangs(format!("{WHAT} did not come in {} seconds", PATIENCE.as_secs())));
            }
        }
    }

    /// Asks for the film as it is once all work handed in so far is done, without waiting. While an earlier reading is
    /// on its way nothing new is asked for.
    ///
    /// # Errors
    /// [`gpu::GpuError::Refused`] if there is no memory to read into.
    pub fn begin_reading(&mut self, gpu: &Gpu) -> Result<(), GpuTraceError> {
        if self.reading.is_some() {
            return Ok(());
        }
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(WHAT) });
        let mut staging = std::mem::take(&mut self.staging);
        for band in &self.bands[staging.len()..] {
            let (size, usage) = (band.sums.size(), BufferUsages::COPY_DST | BufferUsages::MAP_READ);
            let descriptor = wgpu::BufferDescriptor { label: Some(WHAT), size, usage, mapped_at_creation: false };
            staging.push(gpu.checked(WHAT, || gpu.device.create_buffer(&descriptor))?);
        }
        for (band, buffer) in self.bands.iter().zip(&staging) {
            encoder.copy_buffer_to_buffer(&band.sums, 0, buffer, 0, band.sums.size());
        }
        gpu.queue.submit([encoder.finish()]);
        let (send, mapped) = mpsc::channel();
        for buffer in &staging {
            let send = send.clone();
            // nobody listens any more only if this film is gone
            buffer.map_async(wgpu::MapMode::Read, .., move |outcome| drop(send.send(outcome)));
        }
        self.reading = Some(Reading { staging, mapped, arrived: 0 });
        Ok(())
    }

    /// The film that was asked for with [`GpuFilm::begin_reading`], if it has arrived. Never waits.
    ///
    /// # Errors
    /// [`gpu::GpuError::Lost`] if the device fails, [`GpuTraceError::Memory`] for want of memory.
    pub fn poll_reading(&mut self, gpu: &Gpu) -> Result<Option<(Film, Stats)>, GpuTraceError> {
        let Some(reading) = &mut self.reading else { return Ok(None) };
        gpu.look(WHAT)?;
        while let Ok(outcome) = reading.mapped.try_recv() {
            if let Err(why) = outcome {
                self.reading = None;
                return Err(lost(gpu, why.to_string()));
            }
            reading.arrived += 1;
        }
        if reading.arrived < reading.staging.len() {
            return Ok(None);
        }
        let Some(Reading { staging, .. }) = self.reading.take() else { return Ok(None) };
        let read = self.add_up(gpu, &staging)?;
        staging.iter().for_each(wgpu::Buffer::unmap);
        self.staging = staging;
        Ok(Some(read))
    }

    fn add_up(&self, gpu: &Gpu, staging: &[wgpu::Buffer]) -> Result<(Film, Stats), GpuTraceError> {
        let (width, height) = (self.width(), self.height());
        let mut film = Film::try_new(width, height).ok_or(GpuTraceError::Memory { width, height })?;
        film.pixels_mut().copy_from_slice(self.before.pixels());
        film.nonfinite = self.before.nonfinite;
        let mut stats = self.stats;
        for (band, staging) in self.bands.iter().zip(staging) {
            let bytes = staging.get_mapped_range(..).map_err(|why| lost(gpu, why.to_string()))?;
            let sums: &[Pixel] = bytemuck::cast_slice(&bytes);
            let pixels = &mut film.pixels_mut()[(band.first_row * width) as usize..];
            // 64 bytes of each pixel, two million of them on a large screen: by all threads
            let added = pixels.par_iter_mut().zip(sums).with_min_len(1 << 14).map(|(pixel, sums)| {
                let samples = u64::from(sums.samples.saturating_sub(pixel.samples));
                let (rays, cut_paths, not_finite) = sums.add_to(pixel);
                (Stats { samples, rays, cut_paths, ..Stats::default() }, not_finite)
            });
            let none = || (Stats::default(), 0);
            let (took, not_finite) = added.reduce(none, |(a, m), (b, n)| (a.plus(b), m + n));
            stats = stats.plus(took);
            film.nonfinite += not_finite;
        }
        Ok((film, stats))
    }

    /// Moves the device's sums to the host, whose sums are f64, and begins new ones.
    pub(crate) fn fold(&mut self, gpu: &Gpu) -> Result<(), GpuTraceError> {
        self.reading = None;
        self.unfolded = 0;
        (self.before, self.stats) = self.read(gpu)?;
        let width = self.before.width();
        for band in &self.bands {
            let pixels = &self.before.pixels()[(band.first_row * width) as usize..][..(band.rows * width) as usize];
            let pixels: Vec<Pixel> = pixels.iter().map(|pixel| Pixel::beginning(pixel.samples)).collect();
            gpu.queue.write_buffer(&band.sums, 0, bytemuck::cast_slice(&pixels));
        }
        Ok(())
    }
}

pub(crate) fn lost(gpu: &Gpu, why: String) -> GpuTraceError {
    gpu.lost(WHAT, why).into()
}

impl Band {
    fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        first_row: u32,
        rows: u32,
        pixels: &[Pixel],
    ) -> Result<Self, GpuError> {
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let sums = gpu.buffer(WHAT, pixels, usage)?;
        let params: RenderParams = bytemuck::Zeroable::zeroed();
        let asked = gpu.buffer("what is asked for", &[params], BufferUsages::UNIFORM | BufferUsages::COPY_DST)?;
        let group = gpu.checked(WHAT, || {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(WHAT),
                layout,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: asked.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: sums.as_entire_binding() },
                ],
            })
        })?;
        Ok(Band { first_row, rows, sums, asked, group })
    }
}
