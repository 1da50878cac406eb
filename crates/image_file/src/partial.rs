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

/// Those of this process.
static IN_THE_MAKING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes every file of this process that is not whole yet: for one that ends in the middle of its work.
pub fn remove_partial_files() {
    in_the_making().iter().for_each(|path| _ = std::fs::remove_file(path));
}

fn in_the_making() -> MutexGuard<'static, Vec<PathBuf>> {
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
        sweep(folder);
        for _ in 0..100 {
            let name = format!("{BEGIN}{:016x}{END}", RandomState::new().hash_one(std::process::id()));
            match Partial::create_new(folder.join(name), private) {
                // a sweep was faster than the lock
                Ok(partial) if !partial.is_locked() => {}
                Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
                created => return created,
            }
        }
        Err(Error::new(ErrorKind::AlreadyExists, "no name is free for the file in the making"))
    }

    /// An empty file of this name where there is none.
    pub fn create_new(path: PathBuf, private: bool) -> std::io::Result<Self> {
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
    let is_partial = |name: &OsStr| name.to_str().is_some_and(|name| name.starts_with(BEGIN) && name.ends_with(END));
    for entry in listing.flatten().filter(|entry| is_partial(&entry.file_name())) {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}
