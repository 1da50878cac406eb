//! References on disk: one file each in the user's cache folder, the ones not used for longest going when there are too
//! many.

use crate::{Key, Reference};
use image_file::{ImageFileError, Records};
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
    #[error("cannot keep references ({why}): {}", folder.display())]
    Folder {
        /// What stands in the way.
        why: std::io::Error,
        /// The folder.
        folder: PathBuf,
    },
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
        Ok(Store { folder, most_bytes })
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

    /// The reference of this key, if it is there and whole.
    pub fn get(&self, key: Key) -> Option<Reference> {
        let path = self.path(key);
        let reference = Reference::load(&path).ok()?;
        // that it was used decides how long it stays; a folder that is read-only keeps it anyway
        let _ = std::fs::File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        Some(reference)
    }

    /// Keeps a reference, in place of the one that is there; those used longest ago go where the limit asks for it.
    ///
    /// # Errors
    /// [`StoreError::Folder`] or [`StoreError::Picture`], with what is there untouched.
    pub fn put(&self, key: Key, reference: &Reference, records: Records) -> Result<(), StoreError> {
        std::fs::create_dir_all(&self.folder).map_err(|why| self.fault(why))?;
        image_file::write_whole(&self.path(key), &reference.encode(records)?)?;
        let mut entries = self.entries()?;
        entries.sort_by_key(|entry| entry.used);
        let mut bytes: u64 = entries.iter().map(|entry| entry.bytes).sum();
        for oldest in entries.iter().filter(|entry| entry.path != self.path(key)) {
            if bytes <= self.most_bytes {
                break;
            }
            self.remove(oldest)?;
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

    /// Removes all references, and returns what there was.
    ///
    /// # Errors
    /// [`StoreError::Folder`] if one cannot be removed.
    pub fn clear(&self) -> Result<Usage, StoreError> {
        let usage = self.usage()?;
        for entry in self.entries()? {
            self.remove(&entry)?;
        }
        Ok(usage)
    }

    /// That another program was faster is no fault.
    fn remove(&self, entry: &Entry) -> Result<(), StoreError> {
        match std::fs::remove_file(&entry.path) {
            Err(why) if why.kind() != std::io::ErrorKind::NotFound => Err(self.fault(why)),
            _ => Ok(()),
        }
    }

    fn path(&self, key: Key) -> PathBuf {
        self.folder.join(format!("{key}.exr"))
    }

    /// References alone: whatever else lies in the folder is the user's.
    fn entries(&self) -> Result<Vec<Entry>, StoreError> {
        let listing = match std::fs::read_dir(&self.folder) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
            listing => listing.map_err(|why| self.fault(why))?,
        };
        let of_a_key = |name: &str| {
            name.strip_suffix(".exr").is_some_and(|key| key.len() == 32 && u128::from_str_radix(key, 16).is_ok())
        };
        let mut entries = Vec::new();
        for file in listing {
            let file = file.map_err(|why| self.fault(why))?;
            if file.file_name().to_str().is_some_and(of_a_key)
                && let Ok(meta) = file.metadata()
                && meta.is_file()
            {
                let used = meta.modified().unwrap_or(SystemTime::UNIX_EPOCH);
                entries.push(Entry { path: file.path(), bytes: meta.len(), used });
            }
        }
        Ok(entries)
    }

    fn fault(&self, why: std::io::Error) -> StoreError {
        StoreError::Folder { why, folder: self.folder.clone() }
    }
}
