//! When a window's device that has failed is begun again: not in every frame, should it fail at once.

use crate::fuse::Fuse;
use gpu::Gpu;
use std::time::{Duration, Instant};

/// Least time between two attempts.
const PAUSE: Duration = Duration::from_secs(2);

/// Attempts so far.
#[derive(Debug)]
pub struct Revival {
    attempts: u32,
    last: Option<Instant>,
    fuse: Option<Fuse>,
}

impl Revival {
    /// None yet.
    pub fn new() -> Self {
        Revival { attempts: 0, last: None, fuse: Fuse::of_the_window() }
    }

    /// Whether it is time for an attempt, which then counts.
    pub fn is_due(&mut self) -> bool {
        if self.last.is_some_and(|last| last.elapsed() < PAUSE) {
            return false;
        }
        self.last = Some(Instant::now());
        self.attempts += 1;
        true
    }

    /// Whether the last attempt was the first, the third, ...
    pub fn is_odd(&self) -> bool {
        self.attempts % 2 == 1
    }

    /// Burns down the fuse, if there is one.
    pub fn count_frame(&self, gpu: &Gpu) {
        self.fuse.iter().for_each(|fuse| fuse.burn(gpu));
    }
}
