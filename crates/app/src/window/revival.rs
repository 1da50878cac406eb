//! When a window's device that has failed is begun again: not in every frame, should it fail at once.

use crate::fuse::Fuse;
use gpu::Gpu;
use std::time::{Duration, Instant};

/// Time before the second attempt; each further one waits twice as long.
const PAUSE: Duration = Duration::from_secs(2);

/// What fails so often is not a lost device.
const MOST_ATTEMPTS: u32 = 6;

/// Attempts so far.
#[derive(Debug)]
pub struct Revival {
    attempts: u32,
    last: Option<Instant>,
    /// Whether egui was told the smaller size the last time.
    smaller: bool,
    fuse: Option<Fuse>,
}

impl Revival {
    /// None yet.
    pub fn new() -> Self {
        Revival { attempts: 0, last: None, smaller: false, fuse: Fuse::of_the_window() }
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

    /// The largest side of a texture to tell egui, of a device that takes `limit`: another one than the last time, for egui
    /// sends its letters again only where that has changed.
    pub fn another_side(&mut self, limit: usize) -> usize {
        self.smaller = !self.smaller;
        limit - usize::from(self.smaller)
    }

    /// Burns down the fuse, if there is one.
    pub fn count_frame(&self, gpu: &Gpu) {
        self.fuse.iter().for_each(|fuse| fuse.burn(gpu));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn egui_is_told_another_size_each_time_and_attempts_end() {
        let mut revival = Revival::new();
        assert!(revival.is_due() && !revival.is_due());
        assert_eq!([0; 3].map(|_| revival.another_side(100)), [99, 100, 99]);
        revival.attempts = MOST_ATTEMPTS;
        revival.last = None;
        assert!(!revival.is_due());
    }
}
