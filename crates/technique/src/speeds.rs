//! How fast samples come.

use crate::Device;
use std::time::Duration;

/// Seconds that one sample of one pixel takes, by device, as measured on the last passes; a guess at first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Speeds(pub(crate) [f64; 2]);

impl Default for Speeds {
    fn default() -> Self {
        Speeds([1e-6; 2])
    }
}

/// Samples below which a pass says nothing about its speed.
const TOO_FEW_TO_MEASURE: u64 = 1000;

impl Speeds {
    pub(crate) fn of(self, device: Device) -> f64 {
        self.0[device as usize]
    }

    /// Learns from a pass that took so many samples.
    pub(crate) fn note(&mut self, device: Device, taken: u64, spent: Duration) {
        if taken > TOO_FEW_TO_MEASURE {
            self.0[device as usize] = spent.as_secs_f64() / taken as f64;
        }
    }
}
