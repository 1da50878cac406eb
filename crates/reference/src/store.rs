//! References on disk: one file each in the user's cache folder, the ones not used for longest going when there are too
//! many.

use crate::seal::Seal;
use crate::{Key, Reference};
use image_file::{ImageFileError, Records, hold};
use std::fs::{DirEntry, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// A folder of references.
#[derive(Debug, Clone)]
pub struct Store {
    folder: PathBuf,
    most_bytes: u64,
}

/// Why a store cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// There is no folder for caches.
    #[error("there is no home folder to keep references in; set VISAVIS_CACHE to a folder")]
    NoFolder,
    /// The size limit is no number.
    #[error("VISAVIS_CACHE_MIB {0}: expected a whole number of MiB")]
    Limit(String),
    /// The folder cannot be made or read.
    #[error("cannot keep references ({why}): {}", image_file::shown(folder))]
    Folder {
        /// What stands in the way.
        why: std::io::Error,
        /// The folder.
        folder: PathBuf,
    },
    /// A reference is not what was written.
    #[error("a reference that was kept is damaged and is made anew: {}", image_file::shown(.0))]
    Damaged(PathBuf),
    /// A reference cannot be written.
    #[error(transparent)]
    Picture(#[from] ImageFileError),
}

/// What a store holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Usage {
    /// References.
    pub count: usize,
    /// Their size in bytes.
    pub bytes: u64,
}

struct Entry {
    path: PathBuf,
    bytes: u64,
    used: SystemTime,
}

impl Store {
    /// Bytes that a store holds at most unless `VISAVIS_CACHE_MIB` says otherwise: about 45 references of 1280 x 720.
    pub const MOST_BYTES: u64 = 1 << 30;

    /// The user's store: `$VISAVIS_CACHE`, else `visavis/references` in the folder that the system has for caches.
    ///
    /// # Errors
    /// [`StoreError::NoFolder`], [`StoreError::Limit`].
    pub fn of_the_user() -> Result<Self, StoreError> {
        let most_bytes = match std::env::var("VISAVIS_CACHE_MIB") {
            Ok(word) => word.trim().parse::<u64>().map_err(|_| StoreError::Limit(word))?.saturating_mul(1 << 20),
            Err(_) => Self::MOST_BYTES,
        };
        let chosen = std::env::var_os("VISAVIS_CACHE").filter(|v| !v.is_empty()).map(PathBuf::from);
        let own = || image_file::cache_folder().map(|folder| folder.join("visavis").join("references"));
        let folder = chosen.or_else(own).ok_or(StoreError::NoFolder)?;
        // so that it is told as it is found
        Ok(Store { folder: std::path::absolute(&folder).unwrap_or(folder), most_bytes })
    }

    /// A store in this folder, of at most so many bytes.
    pub fn new(folder: PathBuf, most_bytes: u64) -> Self {
        Store { folder, most_bytes }
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Bytes that it holds at most.
    pub fn most_bytes(&self) -> u64 {
        self.most_bytes
    }

    /// The reference of this key, if it is there.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] if it is not whole.
    pub fn fetch(&self, key: Key) -> Result<Option<Reference>, StoreError> {
        let path = self.path(key);
        // no other program puts another one in its place meanwhile
        let _held = hold(&self.folder, false);
        let kept = self.read(key)?;
        if kept.is_some() {
            // that it was used decides how long it stays; a folder that is read-only keeps it anyway
            let _ = File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        }
        Ok(kept)
    }

    fn read(&self, key: Key) -> Result<Option<Reference>, StoreError> {
        let path = self.path(key);
        let read = match Seal::of(&path) {
            Err(_) => return Ok(None),
            Ok(Seal::Whole) => Reference::read(&path).ok().map(|(reference, _)| reference),
            Ok(Seal::Broken | Seal::Missing) => None,
        };
        read.map(Some).ok_or(StoreError::Damaged(path))
    }

    /// Keeps a reference, unless there is one already that is as fine; those used longest ago go where the limit asks
    /// for it.
    ///
    /// # Errors
    /// [`StoreError::Folder`] or [`StoreError::Picture`], with what is there untouched.
    pub fn put(&self, key: Key, reference: &Reference, records: Records) -> Result<(), StoreError> {
        std::fs::create_dir_all(&self.folder).map_err(|why| self.fault(why))?;
        let bytes = reference.encode(records)?;
        let _held = hold(&self.folder, true);
        // another program may have made a finer one since this one looked
        if !self.read(key).is_ok_and(|kept| kept.is_some_and(|kept| kept.replicates >= reference.replicates)) {
            image_file::write_whole(&self.path(key), &bytes)?;
        }
        self.make_room(key)
    }

    fn make_room(&self, key: Key) -> Result<(), StoreError> {
        let mut entries = self.entries()?;
        entries.sort_by_key(|entry| entry.used);
        let mut bytes: u64 = entries.iter().map(|entry| entry.bytes).sum();
        for oldest in entries.iter().filter(|entry| entry.path != self.path(key)) {
            if bytes <= self.most_bytes {
                break;
            }
            self.remove(&oldest.path)?;
            bytes -= oldest.bytes;
        }
        Ok(())
    }

    /// How much there is.
    ///
    /// # Errors
    /// [`StoreError::Folder`] if it cannot be read.
    pub fn usage(&self) -> Result<Usage, StoreError> {
        let entries = self.entries()?;
        Ok(Usage { count: entries.len(), bytes: entries.iter().map(|entry| entry.bytes).sum() })
    }

    /// Removes all references and what programs that were killed have left of others, and returns what references there
    /// were.
    ///
    /// # Errors
    /// [`StoreError::Folder`] if one cannot be removed.
    pub fn clear(&self) -> Result<Usage, StoreError> {
        let _held = hold(&self.folder, true);
        let usage = self.usage()?;
        for entry in self.entries()? {
            self.remove(&entry.path)?;
        }
        for file in self.files()?.iter().filter(|file| is_in_the_making(file)) {
            self.pardon(image_file::remove_unless_held(&file.path()))?;
        }
        Ok(usage)
    }

    fn remove(&self, path: &Path) -> Result<(), StoreError> {
        self.pardon(std::fs::remove_file(path))
    }

    /// That another program was faster to remove a file is no fault.
    fn pardon(&self, removed: std::io::Result<()>) -> Result<(), StoreError> {
        match removed {
            Err(why) if why.kind() != std::io::ErrorKind::NotFound => Err(self.fault(why)),
            _ => Ok(()),
        }
    }

    fn path(&self, key: Key) -> PathBuf {
        self.folder.join(format!("{key}.exr"))
    }

    /// References alone: whatever else lies in the folder is the user's.
    fn entries(&self) -> Result<Vec<Entry>, StoreError> {
        let of_file = |file: &DirEntry| {
            let meta = file.metadata().ok().filter(|meta| meta.is_file() && is_reference(file))?;
            let used = meta.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            Some(Entry { path: file.path(), bytes: meta.len(), used })
        };
        Ok(self.files()?.iter().filter_map(of_file).collect())
    }

    /// All that lies in the folder; nothing if there is none.
    fn files(&self) -> Result<Vec<DirEntry>, StoreError> {
        match std::fs::read_dir(&self.folder).and_then(Iterator::collect) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
            files => files.map_err(|why| self.fault(why)),
        }
    }

    fn fault(&self, why: std::io::Error) -> StoreError {
        StoreError::Folder { why, folder: self.folder.clone() }
    }
}

/// Whether a file is this program's by its name, and holds records of this program or nothing: others may have names of
/// 32 digits as well.
fn is_reference(file: &DirEntry) -> bool {
    let name = file.file_name();
    let is_named = name.to_str().and_then(|name| name.strip_suffix(".exr")).is_some_and(is_key);
    is_named && head_of(&file.path()).is_ok_and(|head| head.is_empty() || head.windows(8).any(|w| w == b"visavis."))
}

fn is_key(word: &str) -> bool {
    word.len() == 32 && word.bytes().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f'))
}

/// Enough to hold records.
fn head_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(4096).read_to_end(&mut head)?;
    Ok(head)
}

/// Whether a file is one that is being written, or was by a program that did not come to its end.
fn is_in_the_making(file: &DirEntry) -> bool {
    let name = file.file_name();
    // as programs of before named them
    let is_old = |name: &str| name.split_once(".exr.").is_some_and(|(key, _)| is_key(key));
    let is_named = image_file::is_partial(&name)
        || name.to_str().and_then(|name| name.strip_suffix(".partial")).is_some_and(is_old);
    is_named && file.file_type().is_ok_and(|kind| kind.is_file())
}
