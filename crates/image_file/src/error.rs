//! Why a picture cannot be read or written: one line, the path last.

use std::path::{Path, PathBuf};

/// Why a file could not be read or written.
#[derive(Debug, Clone, thiserror::Error)]
pub enum ImageFileError {
    /// It is damaged, missing, too large, or not what its name says.
    #[error("cannot read the picture ({why}): {}", shown(path))]
    Read {
        /// What stands in the way.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// It has more pixels than memory is taken for.
    #[error("cannot read the picture ({width}x{height} pixels are more than {most}): {}", shown(path))]
    TooLarge {
        /// Pixels from left to right.
        width: usize,
        /// Pixels from top to bottom.
        height: usize,
        /// Pixels that it may have.
        most: u64,
        /// The picture's file, as it was named.
        path: PathBuf,
    },
    /// The disk is full, the folder is missing, it may not be written.
    #[error("cannot write the file ({why}): {}", shown(path))]
    Write {
        /// What stands in the way.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// It could not be written where it was asked for, and is somewhere else.
    #[error("{fault}; it is kept as {}", shown(kept))]
    Kept {
        /// Why it is not where it was asked for.
        fault: Box<ImageFileError>,
        /// The file that holds it instead.
        kept: PathBuf,
    },
    /// The name tells no kind of picture.
    #[error("cannot read the picture: its name must end in .png or .exr: {}", shown(.0))]
    Kind(PathBuf),
    /// The pixels make no file of this kind.
    #[error("cannot encode the picture as {0}: {1}")]
    Encode(&'static str, String),
    /// There is nowhere to save to.
    #[error("there is no home folder and no current folder to save to: {0}")]
    NoFolder(String),
    /// Every numbered name is taken.
    #[error("too many pictures of this name: {}", shown(.0))]
    Names(PathBuf),
}

impl ImageFileError {
    pub(crate) fn read(path: &Path, why: impl ToString) -> Self {
        ImageFileError::Read { why: one_line(why), path: path.to_owned() }
    }

    pub(crate) fn write(path: &Path, why: impl ToString) -> Self {
        ImageFileError::Write { why: one_line(why), path: path.to_owned() }
    }
}

fn one_line(why: impl ToString) -> String {
    why.to_string().lines().collect::<Vec<_>>().join(", ")
}

/// A path in one line: a name may have any character but `/`.
pub fn shown(path: &Path) -> String {
    escaped(&path.display().to_string())
}

/// Text in one line, which moves no cursor: control characters as they are written in a string of Rust.
pub fn escaped(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { c.escape_default().to_string() } else { c.to_string() }).collect()
}
