//! How far the reading of a large scene is, in words, whether it goes on, and which files it has come by.

use crate::FileRead;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Hears what is being read or made and which share of it is done, from any thread; its answer is whether to go on.
pub type Hear<'a> = dyn Fn(&str, f32) -> bool + Sync + 'a;

/// Tells somebody how far reading is. Once told to stop it stays stopped, and what asks next ends. It keeps the files that
/// are read, which a scene does not: one that is faulty depends on them too.
pub struct Progress<'a> {
    hear: &'a Hear<'a>,
    stopped: AtomicBool,
    files: Mutex<Vec<FileRead>>,
}

/// Reading was told to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopped;

impl<'a> Progress<'a> {
    /// Tells `hear` what is done.
    pub fn new(hear: &'a Hear<'a>) -> Self {
        Progress { hear, stopped: AtomicBool::new(false), files: Mutex::default() }
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

    /// Notes a file that is about to be read.
    pub(crate) fn reads(&self, path: &Path) {
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        if files.iter().all(|known| known.path != path) {
            files.push(FileRead::now(path));
        }
    }

    /// The files that what was read depends on, each once, the scene's own first. Of a scene that is faulty they are those
    /// up to the fault: unless one of them changes, it stays faulty.
    pub fn files(&self) -> Vec<FileRead> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Whether it was told to stop.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}
