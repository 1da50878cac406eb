//! A file that the user chooses in the system's own dialogue.

use super::{ExportSubject, PaneId};
use std::path::PathBuf;

/// What the file is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilePurpose {
    /// A scene or a picture to open.
    Open,
    /// A reference to compare with.
    Reference,
    /// To follow it in a pane whenever it changes.
    Follow(PaneId),
    /// A file to save a picture to.
    Export(ExportSubject),
}

/// A dialogue to show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileWish {
    /// What the file is for.
    pub purpose: FilePurpose,
    /// Where to begin: a file to save to, or something in the folder to look into.
    pub near: PathBuf,
}
