//! Lists cut into dispatches that each fit a budget of time, one after another: [`super::dispatch`] for what is no film.

use super::GpuTraceError;
use super::timing::{Pace, Stopwatch};
use gpu::waiting::PATIENCE;
use gpu::{Gpu, wgpu};

/// Threads of a group, as in the shaders.
const THREADS: u32 = 64;

/// Groups along one axis that every device can take.
const MOST_GROUPS: u32 = 65_535;

/// What runs dispatches over lists.
pub(crate) struct Slices<'a> {
    pub gpu: &'a Gpu,
    pub stopwatch: &'a mut Stopwatch,
    /// Seconds that a dispatch may take.
    pub budget: f64,
    /// What all dispatches have taken.
    pub seconds: &'a mut f64,
    /// What is being done, for errors.
    pub what: &'static str,
}

impl Slices<'_> {
    /// Runs a pipeline over so many items, `pace` of them at a time; false where `stop` says so between two dispatches.
    /// `ask` tells the device the first item, and the one after the last.
    pub fn run(
        &mut self,
        (pipeline, groups): (&wgpu::ComputePipeline, &[&wgpu::BindGroup]),
        pace: &mut Pace,
        items: u32,
        ask: impl Fn(u32, u32),
        stop: &impl Fn() -> bool,
    ) -> Result<bool, GpuTraceError> {
        self.stopwatch.restart();
        let mut first = 0;
        while first < items {
            if stop() {
                return Ok(false);
            }
            let fit = (pace.samples_that_fit() as u32).clamp(1, MOST_GROUPS * THREADS);
            let end = first.saturating_add(fit.next_multiple_of(THREADS).min(MOST_GROUPS * THREADS)).min(items);
            ask(first, end);
            let seconds = self.dispatch(pipeline, groups, (end - first).div_ceil(THREADS))?;
            pace.learn(f64::from(end - first), seconds, self.budget);
            first = end;
        }
        Ok(true)
    }

    fn dispatch(
        &mut self,
        pipeline: &wgpu::ComputePipeline,
        groups: &[&wgpu::BindGroup],
        count: u32,
    ) -> Result<f64, GpuTraceError> {
        let gpu = self.gpu;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(self.what) });
        {
            let timestamp_writes = self.stopwatch.marks(0);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
            pass.set_pipeline(pipeline);
            for (index, group) in (0..).zip(groups) {
                pass.set_bind_group(index, *group, &[]);
            }
            pass.dispatch_workgroups(count, 1, 1);
        }
        self.stopwatch.collect(&mut encoder, 0);
        let index = gpu.queue.submit([encoder.finish()]);
        self.stopwatch.submitted(0);
        if !gpu.wait(self.what, Some(&index), PATIENCE)? {
            let (what, seconds) = (self.what, PATIENCE.as_secs());
            return Err(GpuTraceError::Hangs(format!("{what} took more than {seconds} seconds")));
        }
        let seconds = self.stopwatch.seconds(0);
        *self.seconds += seconds;
        Ok(seconds)
    }
}
