//! How far the reading of a large scene is, in words, and whether it goes on.

use std::sync::atomic::{AtomicBool, Ordering};

/// Hears what is being read or made and which share of it is done, from any thread; its answer is whether to go on.
pub type Hear<'a> = dyn Fn(&str, f32) -> bool + Sync + 'a;

/// Tells somebody how far reading is. Once told to stop it stays stopped, and what asks next ends.
pub struct Progress<'a> {
    hear: &'a Hear<'a>,
    stopped: AtomicBool,
}

/// Reading was told to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopped;

impl<'a> Progress<'a> {
    /// Tells `hear` what is done.
    pub fn new(hear: &'a Hear<'a>) -> Self {
        Progress { hear, stopped: AtomicBool::new(false) }
    }

    /// Tells nobody, and never stops.
    pub fn untold() -> Self {
        Progress::new(&|_, _| true)
    }

    /// Says what is being done, and which share of it is.
    ///
    /// # Errors
    /// If it shall go no further.
    pub fn tell(&self, what: &str, share: f32) -> Result<(), Stopped> {
        if !self.is_stopped() && !(self.hear)(what, share.clamp(0.0, 1.0)) {
            self.stopped.store(true, Ordering::Relaxed);
        }
        if self.is_stopped() { Err(Stopped) } else { Ok(()) }
    }

    /// Whether it was told to stop.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}
