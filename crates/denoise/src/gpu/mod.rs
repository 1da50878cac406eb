//! Filters on a graphics device: the same as the processor's but for rounding. All that a picture goes
//! through is one submission.

mod a_trous;
pub mod shaders;
pub mod unet;

pub use a_trous::{DevicePicture, GpuATrous};

use crate::{DenoiseError, Stop};
use gpu::waiting::PATIENCE;
use gpu::{Gpu, wgpu};
use std::time::{Duration, Instant};

/// How long the device is waited for before `stop` is asked again.
const TURN: Duration = Duration::from_millis(10);

/// Waits for a filter; what is stopped goes on there, and nobody reads it.
fn wait(gpu: &Gpu, what: &str, until: &wgpu::SubmissionIndex, stop: Stop) -> Result<(), DenoiseError> {
    let begun = Instant::now();
    while !gpu.wait(what, Some(until), TURN)? {
        if stop() {
            return Err(DenoiseError::Stopped);
        }
        if begun.elapsed() > PATIENCE {
            return Err(gpu.lost(what, format!("there was no answer in {} seconds", PATIENCE.as_secs())).into());
        }
    }
    Ok(())
}
