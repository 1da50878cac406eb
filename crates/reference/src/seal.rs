//! A hash of all of a file at its end, behind what readers of EXR look at: one flipped bit is noticed.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Stands between what is hashed and the hash.
const MARK: [u8; 16] = *b"\nvisavis.blake3\n";

/// Bytes of a seal.
const LENGTH: usize = MARK.len() + blake3::OUT_LEN;

/// What the end of a file says of the rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seal {
    /// It is as it was written.
    Whole,
    /// It has been changed, or cut.
    Broken,
    /// Nothing: it is another program's, or older than seals.
    Missing,
}

/// These bytes with their seal.
pub fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let hash = blake3::hash(&bytes);
    bytes.extend(MARK);
    bytes.extend(hash.as_bytes());
    bytes
}

impl Seal {
    /// That of a file.
    pub fn of(path: &Path) -> std::io::Result<Self> {
        // a pipe or a device might never end
        if !std::fs::metadata(path)?.is_file() {
            return Ok(Seal::Missing);
        }
        let mut file = File::open(path)?;
        let end = file.metadata()?.len();
        let tail_from = end.saturating_sub(LENGTH as u64);
        file.seek(SeekFrom::Start(tail_from))?;
        let mut tail = Vec::new();
        file.read_to_end(&mut tail)?;
        // found later where the file is cut
        let Some(at) = tail.windows(MARK.len()).position(|window| window == MARK) else { return Ok(Seal::Missing) };
        file.rewind()?;
        let mut hasher = blake3::Hasher::new();
        hasher.update_reader(file.take(tail_from + at as u64))?;
        let is_whole = hasher.finalize().as_bytes()[..] == tail[at + MARK.len()..];
        Ok(if is_whole { Seal::Whole } else { Seal::Broken })
    }
}
