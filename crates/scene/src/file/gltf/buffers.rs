//! Buffers, and the ranges of them that views name.

use super::container::Parts;
use super::json::Root;
use super::{Refused, uri};
use std::cell::Cell;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Bytes of a model at most, all of its buffers together.
pub const MOST_BYTES: u64 = 4 << 30;

/// Sparse elements that are read at most, as often as a primitive names them.
const MOST_SPARSE: u64 = 1 << 26;

/// A glTF file with all its buffers.
pub struct Document {
    pub root: Root,
    /// Where the file lies: what it names lies there or below.
    pub folder: PathBuf,
    file: Vec<u8>,
    buffers: Vec<Buffer>,
    sparse_left: Cell<u64>,
}

enum Buffer {
    /// The binary chunk of the file itself.
    Chunk(Range<usize>),
    Read(Vec<u8>),
}

impl Document {
    /// Reads the buffers that the JSON names, all of them `most` bytes at most.
    pub fn new(root: Root, file: Vec<u8>, parts: &Parts, folder: &Path, most: u64) -> Result<Self, Refused> {
        let mut left = most;
        let too_many = || format!("with it the buffers have more than {most} bytes");
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (index, buffer) in root.buffers.iter().enumerate() {
            let fault = |Refused(why)| Refused(format!("buffer {index}: {why}"));
            let length = buffer.byte_length;
            if length == 0 {
                return Err(fault(Refused("its byteLength is 0: expected 1 or more".into())));
            }
            if length > left {
                return Err(fault(Refused(too_many())));
            }
            let read = match (&buffer.uri, &parts.binary) {
                // files are often padded, and buffers share one: what is read counts, not what is asked for
                (Some(uri), _) => Buffer::Read(uri::bytes(uri, folder, left).map_err(fault)?),
                (None, Some(chunk)) if index == 0 => Buffer::Chunk(chunk.clone()),
                (None, _) => return Err(fault(Refused("it names no file, and there is no binary data here".into()))),
            };
            let found = read.bytes(&file).len() as u64;
            if found < length {
                let line = format!("it should have {length} bytes, and has {found}: it is not whole");
                return Err(fault(Refused(line)));
            }
            left = left.checked_sub(found).ok_or_else(|| fault(Refused(too_many())))?;
            buffers.push(read);
        }
        Ok(Document { root, folder: folder.to_owned(), file, buffers, sparse_left: Cell::new(MOST_SPARSE) })
    }

    /// Takes so many sparse elements off those that may be read.
    pub fn count_sparse(&self, count: u64) -> Result<(), Refused> {
        let left = self.sparse_left.get().checked_sub(count);
        self.sparse_left.set(left.ok_or_else(|| Refused(format!("more than {MOST_SPARSE} sparse elements")))?);
        Ok(())
    }

    /// The bytes of a view, and from one element to the next if it says so.
    pub fn view(&self, index: u32) -> Result<View<'_>, Refused> {
        let Some(view) = self.root.buffer_views.get(index as usize) else {
            return Err(Refused(format!(
                "bufferView {index} is named, but there are {}",
                self.root.buffer_views.len()
            )));
        };
        let Some(buffer) = self.buffers.get(view.buffer as usize) else {
            return Err(Refused(format!("bufferView {index}: there is no buffer {}", view.buffer)));
        };
        let bytes = buffer.bytes(&self.file);
        let end = u128::from(view.byte_offset) + u128::from(view.byte_length);
        if end > bytes.len() as u128 {
            let (buffer, length) = (view.buffer, bytes.len());
            return Err(Refused(format!(
                "bufferView {index} ends at byte {end} of buffer {buffer}, which has {length}"
            )));
        }
        let bytes = &bytes[view.byte_offset as usize..end as usize];
        Ok(View { bytes, offset: view.byte_offset, stride: view.byte_stride })
    }
}

impl Buffer {
    fn bytes<'a>(&'a self, file: &'a [u8]) -> &'a [u8] {
        match self {
            Buffer::Chunk(range) => &file[range.clone()],
            Buffer::Read(bytes) => bytes,
        }
    }
}

/// A range of a buffer.
pub struct View<'a> {
    pub bytes: &'a [u8],
    /// Where it begins in its buffer.
    pub offset: u64,
    pub stride: Option<u64>,
}
