//! When a window's device that has failed is begun again: not in every frame, should it fail at once.

use gpu::FaultInjection;
use gpu::Gpu;
use std::time::{Duration, Instant};

/// Time before the second attempt; each further one waits twice as long.
const PAUSE: Duration = Duration::from_secs(2);

/// What fails so often is not a lost device.
const MOST_ATTEMPTS: u32 = 6;

/// Attempts so far.
#[derive(Debug)]
pub struct DeviceRecovery {
    attempts: u32,
    last: Option<Instant>,
    /// Whether egui was told the smaller size the last time.
    smaller: bool,
    fault: Option<FaultInjection>,
}

impl DeviceRecovery {
    /// None yet.
    pub fn new() -> Self {
        DeviceRecovery { attempts: 0, last: None, smaller: false, fault: FaultInjection::of_the_window() }
    }

    /// Whether it is time for an attempt, which then counts.
    pub fn is_due(&mut self) -> bool {
        let pause = PAUSE * 2u32.pow(self.attempts.saturating_sub(1));
        if self.attempts >= MOST_ATTEMPTS || self.last.is_some_and(|last| last.elapsed() < pause) {
            return false;
        }
        self.last = Some(Instant::now());
        self.attempts += 1;
        true
    }

    /// The largest side of a texture to tell egui, of a device that takes `limit`: another one than the last time, for
    /// egui sends its letters again only where that has changed.
    pub fn another_side(&mut self, limit: usize) -> usize {
        self.smaller = !self.smaller;
        limit - usize::from(self.smaller)
    }

    /// Burns down the fault, if there is one.
    pub fn count_frame(&self, gpu: &Gpu) {
        self.fault.iter().for_each(|fault| fault.count(gpu));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn egui_is_told_another_size_each_time_and_attempts_end() {
        let mut recovery = DeviceRecovery::new();
        assert!(recovery.is_due() && !recovery.is_due());
        assert_eq!([0; 3].map(|_| recovery.another_side(100)), [99, 100, 99]);
        recovery.attempts = MOST_ATTEMPTS;
        recovery.last = None;
        assert!(!recovery.is_due());
    }
}
