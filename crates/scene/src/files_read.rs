//! Which files a scene is read from, and how they were then: whoever watches them reads the scene again where one changes.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What tells that a file was written: its time and its size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileStamp {
    modified: Option<SystemTime>,
    bytes: u64,
}

impl FileStamp {
    /// Of the file of this name; `None` if there is none.
    pub fn of(path: &Path) -> Option<Self> {
        let found = std::fs::metadata(path).ok().filter(|found| found.is_file())?;
        Some(FileStamp { modified: found.modified().ok(), bytes: found.len() })
    }
}

/// A file that a scene is read from, or that it names and that is not there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileRead {
    /// Where it lies, as the scene's own file was named: relative to the same folder.
    pub path: PathBuf,
    /// As it was before it was read, so that what is written meanwhile is newer; `None` if it was not there.
    pub stamp: Option<FileStamp>,
}

impl FileRead {
    /// As it is now.
    pub fn now(path: &Path) -> Self {
        FileRead { path: path.to_owned(), stamp: FileStamp::of(path) }
    }

    /// Whether it is another one by now, or is gone, or has come.
    pub fn has_changed(&self) -> bool {
        FileStamp::of(&self.path) != self.stamp
    }
}
