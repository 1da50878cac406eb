//! Work cut into dispatches that each fit a budget of time, so that no driver gives the device up, a window that shares it
//! stays alive, and a user who has seen enough is heard.

use super::GpuTraceError;
use super::film::{Band, GpuFilm, lost};
use super::film_data::{Exposure, MOST_SAMPLES};
use super::timing::{Pace, Stopwatch};
use gpu::{Gpu, wgpu};
use std::time::Duration;

/// Threads of a group along x and y, as in the shaders.
const GROUP: u32 = 8;

/// Samples of a pixel in one dispatch where a whole band does not fit the budget: threads whose paths end early go on with
/// their next sample, which keeps their neighbours company.
const SAMPLES_OF_A_PART: u32 = 4;

/// How long to wait for a dispatch. A path may be long, but not that long.
const PATIENCE: Duration = Duration::from_secs(60);

/// What runs the dispatches of one call.
pub(super) struct Dispatcher<'a> {
    pub gpu: &'a Gpu,
    pub pipeline: &'a wgpu::ComputePipeline,
    pub scene: &'a wgpu::BindGroup,
    pub stopwatch: &'a mut Stopwatch,
    pub pace: &'a mut Pace,
    /// Seconds that a dispatch may take.
    pub budget: f64,
    /// Dispatches on their way, oldest first: where their times are, how many samples they take, what to wait for.
    pub in_flight: Vec<(usize, f64, wgpu::SubmissionIndex)>,
    pub submitted: usize,
}

impl Dispatcher<'_> {
    /// Brings every pixel to `until` samples, unless `stop` says so between two dispatches.
    pub fn run(
        mut self,
        film: &mut GpuFilm,
        exposure: Exposure,
        until: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<(), GpuTraceError> {
        self.stopwatch.restart();
        let width = film.width();
        while film.samples_done < until {
            let samples = self.samples_at_once(film, until - film.samples_done);
            if film.unfolded + samples > MOST_SAMPLES {
                self.finish(0)?;
                film.fold(self.gpu)?;
            }
            film.unfolded += samples;
            let done = film.samples_done + samples;
            for band in &film.bands {
                let mut row = 0;
                while row < band.rows {
                    if stop() {
                        return self.finish(0);
                    }
                    let rows = self.rows_at_once(width, samples).min(band.rows - row);
                    let first_row = band.first_row + row;
                    let end_row = first_row + rows;
                    let asked = Exposure { film_row: band.first_row, first_row, end_row, until: done, ..exposure };
                    self.dispatch(band, asked, (width, rows, samples))?;
                    row += rows;
                }
            }
            film.samples_done = done;
        }
        self.finish(0)
    }

    /// As many as fit the budget with a whole picture, or a few with a part of it.
    fn samples_at_once(&self, film: &GpuFilm, wanted: u32) -> u32 {
        let pixels = f64::from(film.width()) * f64::from(film.height());
        let fit = (self.pace.samples_that_fit() / pixels) as u32;
        fit.max(SAMPLES_OF_A_PART).min(wanted).min(MOST_SAMPLES)
    }

    /// Whole groups of rows, unless not even one fits.
    fn rows_at_once(&self, width: u32, samples: u32) -> u32 {
        let fit = (self.pace.samples_that_fit() / (f64::from(width) * f64::from(samples))) as u32;
        if fit > GROUP { fit / GROUP * GROUP } else { fit.max(1) }
    }

    fn dispatch(
        &mut self,
        band: &Band,
        asked: Exposure,
        (width, rows, samples): (u32, u32, u32),
    ) -> Result<(), GpuTraceError> {
        let gpu = self.gpu;
        let slot = self.submitted % 2;
        gpu.queue.write_buffer(&band.asked, 0, bytemuck::bytes_of(&asked));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: None });
        {
            let timestamp_writes = self.stopwatch.marks(slot);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
            pass.set_pipeline(self.pipeline);
            pass.set_bind_group(0, self.scene, &[]);
            pass.set_bind_group(1, &band.group, &[]);
            pass.dispatch_workgroups(width.div_ceil(GROUP), rows.div_ceil(GROUP), 1);
        }
        self.stopwatch.collect(&mut encoder, slot);
        let index = gpu.queue.submit([encoder.finish()]);
        self.stopwatch.submitted(slot);
        self.submitted += 1;
        let work = f64::from(width) * f64::from(rows) * f64::from(samples);
        self.in_flight.push((slot, work, index));
        self.finish(1)
    }

    /// Waits until at most `most` dispatches are on their way.
    fn finish(&mut self, most: usize) -> Result<(), GpuTraceError> {
        while self.in_flight.len() > most {
            let (slot, work, index) = self.in_flight.remove(0);
            let wait = wgpu::PollType::Wait { submission_index: Some(index), timeout: Some(PATIENCE) };
            match self.gpu.device.poll(wait) {
                Ok(_) => {}
                Err(wgpu::PollError::Timeout) => {
                    let seconds = PATIENCE.as_secs();
                    return Err(GpuTraceError::Hangs(format!("a dispatch took more than {seconds} seconds")));
                }
                Err(why) => return Err(lost(self.gpu, why.to_string())),
            }
            if let Some(why) = self.gpu.fault() {
                return Err(lost(self.gpu, why));
            }
            let seconds = self.stopwatch.seconds(slot);
            self.pace.learn(work, seconds, self.budget);
        }
        Ok(())
    }
}
