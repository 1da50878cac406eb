//! Losing a graphics device on purpose, for tests of what happens then: it is destroyed after as many dispatches,
//! pictures or frames as an environment variable says. One hook at run time for all of them, because a cargo feature
//! would build every crate that traces twice.

use crate::Gpu;
use std::cell::Cell;

/// Left of a countdown that has come to its end.
const SPENT: u32 = u32::MAX;

/// A countdown to the loss of a device.
#[derive(Debug)]
pub struct FaultInjection {
    left: Cell<u32>,
}

impl FaultInjection {
    /// The countdown of the device that traces rays, in dispatches.
    pub fn of_rays() -> Option<Self> {
        FaultInjection::from_env("VISAVIS_GPU_FAILS_AFTER")
    }

    /// That of the device that draws fakes, in pictures.
    pub fn of_fakes() -> Option<Self> {
        FaultInjection::from_env("VISAVIS_FAKE_FAILS_AFTER")
    }

    /// That of the window's device, in frames.
    pub fn of_the_window() -> Option<Self> {
        FaultInjection::from_env("VISAVIS_WINDOW_FAILS_AFTER")
    }

    fn from_env(variable: &str) -> Option<Self> {
        let left = std::env::var(variable).ok()?.parse().ok()?;
        Some(FaultInjection { left: Cell::new(left) })
    }

    /// Counts one down; the device goes with the last.
    pub fn count(&self, gpu: &Gpu) {
        match self.left.get() {
            SPENT => {}
            0 => {
                gpu.device.destroy();
                // a device that is lost by itself tells so
                gpu.remember("the graphics device was lost: a test asked for it".into());
                self.left.set(SPENT);
            }
            left => self.left.set(left - 1),
        }
    }
}
