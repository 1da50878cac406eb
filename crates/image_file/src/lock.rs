//! One program at a time changes what is kept in a folder.

use std::fs::{File, TryLockError};
use std::path::Path;
use std::time::{Duration, Instant};

/// How long others are waited for: one that holds a folder for longer has been stopped.
const PATIENCE: Duration = Duration::from_secs(5);

/// How often it is looked whether they are done.
const PAUSE: Duration = Duration::from_millis(5);

/// The file that stands for the folder where a folder cannot be locked. It stays: whoever removed it would let others hold
/// two of them.
#[cfg(not(unix))]
const LOCK_FILE: &str = ".visavis.lock";

/// Holds a folder, alone or together with others who look, until the file is dropped. `None` where that cannot be had:
/// file systems without locks are used without.
pub fn hold(folder: &Path, alone: bool) -> Option<File> {
    let file = open(folder).ok()?;
    let begun = Instant::now();
    loop {
        match if alone { file.try_lock() } else { file.try_lock_shared() } {
            Ok(()) => return Some(file),
            Err(TryLockError::WouldBlock) if begun.elapsed() < PATIENCE => std::thread::sleep(PAUSE),
            Err(_) => return None,
        }
    }
}

#[cfg(unix)]
fn open(folder: &Path) -> std::io::Result<File> {
    File::open(folder)
}

#[cfg(not(unix))]
fn open(folder: &Path) -> std::io::Result<File> {
    File::options().create(true).truncate(false).write(true).open(folder.join(LOCK_FILE))
}
