//! What a device does at most: the roof over what rays can reach (Williams, Waterman and Patterson, "Roofline", 2009).

use super::DeviceReportError;
use super::shaders::compose;
use gpu::compute::{Binding, Compute};
use gpu::{Gpu, GpuError, wgpu};
use std::time::Instant;
use wgpu::BufferUsages;

/// Steps of a thread in the shader, each of two times four multiplications with additions.
pub const STEPS: u32 = 256;

/// Operations of a step: of eight numbers, a multiplication and an addition.
const OPERATIONS: f64 = 16.0;

/// Numbers that are read and written, each of 16 bytes, where the device's limits allow: 64 MiB, more than caches hold.
const NUMBERS: u64 = 1 << 22;

/// What a device does at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peaks {
    /// Multiplications and additions of f32, in operations a second.
    pub operations: f64,
    /// Bytes read and written, a second.
    pub bytes: f64,
}

/// Measures both, each for so many seconds at least.
///
/// # Errors
/// [`DeviceReportError`] if the device fails.
pub fn peaks(gpu: &Gpu, seconds: f64) -> Result<Peaks, DeviceReportError> {
    let shader = compose("bench/peaks.wgsl")?;
    let limits = gpu.device.limits();
    let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) / 16;
    let most = most.min(256 * u64::from(limits.max_compute_workgroups_per_dimension));
    let count = NUMBERS.min(most) as usize;
    let numbers = gpu.buffer("numbers", &vec![[0.25f32, 0.5, 0.75, 1.0]; count], BufferUsages::STORAGE)?;
    let results = gpu.buffer("results", &vec![[0.0f32; 4]; count], BufferUsages::STORAGE)?;
    let rate = |entry: &str| -> Result<f64, GpuError> {
        let compute = Compute::new(gpu, &shader, entry, None, &[Binding::Read, Binding::Written], &[])?;
        let resources = [numbers.as_entire_binding(), results.as_entire_binding()];
        let passes = |times: u32| -> Result<f64, GpuError> {
            let start = Instant::now();
            gpu.checked(entry, || {
                let group = compute.bind(gpu, &resources);
                let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                for _ in 0..times {
                    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                    compute.record(&mut pass, None, &group, [count as u32, 1, 1]);
                }
                gpu.queue.submit([encoder.finish()]);
            })?;
            gpu.wait_for_all(entry)?;
            Ok(start.elapsed().as_secs_f64())
        };
        passes(1)?;
        let mut times = 1;
        loop {
            let took = passes(times)?;
            if took >= seconds || times >= MOST_TIMES {
                return Ok(count as f64 * f64::from(times) / took);
            }
            times *= 2;
        }
    };
    Ok(Peaks { operations: rate("arithmetic")? * OPERATIONS * f64::from(STEPS), bytes: rate("movement")? * 32.0 })
}

/// Passes in one submission, at most.
const MOST_TIMES: u32 = 1 << 14;
