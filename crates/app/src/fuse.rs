//! For tests of what happens when a graphics device is lost: destroys it after a number of dispatches, pictures or frames that
//! the environment says.

use gpu::Gpu;
use std::cell::Cell;

/// Of a fuse that has burned down.
const SPENT: u32 = u32::MAX;

/// Burns down with each use.
#[derive(Debug)]
pub struct Fuse {
    left: Cell<u32>,
}

impl Fuse {
    /// The fuse that this variable lights, if it is set.
    pub fn lit_by(variable: &str) -> Option<Self> {
        let left = std::env::var(variable).ok()?.parse().ok()?;
        Some(Fuse { left: Cell::new(left) })
    }

    /// Of the device that traces rays, in dispatches.
    pub fn of_rays() -> Option<Self> {
        Fuse::lit_by("VISAVIS_GPU_FAILS_AFTER")
    }

    /// Of the device that draws fakes, in pictures.
    pub fn of_fakes() -> Option<Self> {
        Fuse::lit_by("VISAVIS_FAKE_FAILS_AFTER")
    }

    /// Of the window's device, in frames.
    pub fn of_the_window() -> Option<Self> {
        Fuse::lit_by("VISAVIS_WINDOW_FAILS_AFTER")
    }

    /// Takes one away; the device goes with the last.
    pub fn burn(&self, gpu: &Gpu) {
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
