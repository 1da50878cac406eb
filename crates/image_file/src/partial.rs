//! Files in the making: hidden beside their target under a short name of their own, locked as long as their writer lives,
//! so that what a writer that was killed has left behind can be told from what is being written.

use std::ffi::OsStr;
use std::fs::{File, OpenOptions, TryLockError};
use std::hash::{BuildHasher, RandomState};
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

const BEGIN: &str = ".visavis-";
const END: &str = ".partial";

/// Those of this process. Whoever holds the list keeps the process from being ended in the middle of a file.
static IN_THE_MAKING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// As long as this lives, this process begins no file and writes none in place.
#[derive(Debug)]
pub struct NoMoreFiles(#[expect(dead_code, reason = "it is held")] MutexGuard<'static, Vec<PathBuf>>);

/// Removes every file of this process that is not whole yet, after one that is being written in place: for a process that
/// ends in the middle of its work, which holds what this returns to its end. Else a writer that misses its file would
/// write its target in place, and end in the middle of that.
#[must_use = "files are written again once it is dropped"]
pub fn remove_partial_files() -> NoMoreFiles {
    let files = in_the_making();
    files.iter().for_each(|path| _ = std::fs::remove_file(path));
    NoMoreFiles(files)
}

/// To be held while a file is written in place.
pub fn in_the_making() -> MutexGuard<'static, Vec<PathBuf>> {
    IN_THE_MAKING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file that is removed when this is dropped, unless it was moved to its place.
pub struct Partial {
    file: File,
    path: PathBuf,
}

impl Partial {
    /// A new one in this folder, which nobody else can read if it is `private`. What dead writers have left there goes.
    pub fn create(folder: &Path, private: bool) -> std::io::Result<Self> {
        Partial::with_marks(folder, "", private)
    }

    /// Whether a file of such a name can be made in this folder: one with the marks that some file systems refuse is made
    /// and removed.
    pub fn probe(folder: &Path, name: &OsStr) -> std::io::Result<()> {
        let marks: String = name.to_string_lossy().chars().filter(|c| !c.is_alphanumeric()).take(32).collect();
        Partial::with_marks(folder, &marks, false).map(drop)
    }

    fn with_marks(folder: &Path, marks: &str, private: bool) -> std::io::Result<Self> {
        sweep(folder);
        for _ in 0..100 {
            let name = format!("{BEGIN}{:016x}{marks}{END}", RandomState::new().hash_one(std::process::id()));
            match Partial::open(folder.join(name), private) {
                // a sweep was faster than the lock
                Ok(partial) if !partial.is_locked() => {}
                Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
                created => return created,
            }
        }
        Err(Error::new(ErrorKind::AlreadyExists, "no name is free for the file in the making"))
    }

    fn open(path: PathBuf, private: bool) -> std::io::Result<Self> {
        let mut files = in_the_making();
        let file = options(private).open(&path)?;
        files.push(path.clone());
        Ok(Partial { file, path })
    }

    /// False if another program has seen it unlocked and takes it away. File systems without locks are used without.
    fn is_locked(&self) -> bool {
        !matches!(self.file.try_lock(), Err(TryLockError::WouldBlock)) && self.path.exists()
    }

    /// Writes all of it, to the disk.
    pub fn fill(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.file.write_all(bytes).and_then(|()| self.file.sync_all())
    }

    pub fn file(&self) -> &File {
        &self.file
    }

    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        // it has another name by now, or is what is half written and must not stay
        let _ = std::fs::remove_file(&self.path);
        in_the_making().retain(|path| *path != self.path);
    }
}

fn options(private: bool) -> OpenOptions {
    let mut options = File::options();
    options.write(true).create_new(true);
    #[cfg(unix)]
    if private {
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    }
    #[cfg(not(unix))]
    let _ = private;
    options
}

/// Removes files in the making that no living writer has locked. That some cannot be removed is no fault.
fn sweep(folder: &Path) {
    let Ok(listing) = std::fs::read_dir(folder) else { return };
    for entry in listing.flatten().filter(|entry| is_partial(&entry.file_name())) {
        if entry.file_type().is_ok_and(|kind| kind.is_file()) {
            let _ = remove_unless_held(&entry.path());
        }
    }
}

/// Whether a file is one in the making, by its name.
pub fn is_partial(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with(BEGIN) && name.ends_with(END))
}

/// Removes a file unless somebody has locked it, be it since it was looked at: it is locked until it is gone. A file that
/// cannot be locked stays.
///
/// # Errors
/// If it could be locked and cannot be removed.
pub fn remove_unless_held(path: &Path) -> std::io::Result<()> {
    let Ok(file) = File::open(path) else { return Ok(()) };
    if file.try_lock().is_err() {
        return Ok(());
    }
    let removed = std::fs::remove_file(path);
    drop(file);
    removed
}
