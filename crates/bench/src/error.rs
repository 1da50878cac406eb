//! Why a bench cannot go on: one line each, the path last.

use compare::CompareError;
use image_file::ImageFileError;
use pathtrace::gpu::GpuTraceError;
use scene::SceneError;
use std::path::{Path, PathBuf};

/// Why a bench cannot go on. What was measured before stays in the journal.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// The folder for the results cannot be made.
    #[error("cannot make the folder for the results ({why}): {}", image_file::shown(folder))]
    Folder {
        /// What stands in the way.
        why: std::io::Error,
        /// The folder.
        folder: PathBuf,
    },
    /// The disk is full, or the folder may not be written.
    #[error(transparent)]
    File(#[from] ImageFileError),
    /// A filter could not do its work.
    #[error(transparent)]
    Denoise(#[from] denoise::DenoiseError),
    /// The journal cannot be read or written.
    #[error("cannot {what} the journal ({why}); what was measured before stays in it: {}", image_file::shown(path))]
    Journal {
        /// "read" or "write".
        what: &'static str,
        /// What stands in the way.
        why: std::io::Error,
        /// The file.
        path: PathBuf,
    },
    /// A line of the journal is no measurement.
    #[error(
        "line {line} of the journal is damaged ({why}); remove the file to measure again: {}",
        image_file::shown(path)
    )]
    Damaged {
        /// From 1.
        line: usize,
        /// What is wrong with it.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The folder holds another run's results.
    #[error(
        "the folder holds a bench of {differs}; give another folder with -o, or remove the file to begin again: {}",
        image_file::shown(path)
    )]
    OtherRun {
        /// What differs, theirs and ours.
        differs: String,
        /// Their journal.
        path: PathBuf,
    },
    /// Another program writes to the same folder.
    #[error("another bench is running in this folder; wait for it, or give another folder with -o: {}", image_file::shown(.0))]
    Busy(PathBuf),
    /// A peer's table is not as it must be.
    #[error("line {line} of a peer's table: {found}, expected {expected}: {}", image_file::shown(path))]
    Peer {
        /// From 1; 0 if the file cannot be read at all.
        line: usize,
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
        /// The file.
        path: PathBuf,
    },
    /// No such part.
    #[error("there is no bench of the scene {0}: expected {known}", known = crate::plan::SCENES.join(" or "))]
    UnknownScene(String),
    /// A scene does not load.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A film does not fit its reference.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// The graphics device does not trace it.
    #[error(transparent)]
    Gpu(#[from] GpuTraceError),
    /// There is no memory for a picture.
    #[error("not enough memory for a picture of {0}x{1} pixels")]
    Memory(u32, u32),
}

impl BenchError {
    pub(crate) fn journal(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |why| BenchError::Journal { what, why, path }
    }
}
