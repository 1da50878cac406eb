//! How far the reference of what is seen has come.

use std::path::PathBuf;

/// Where a reference comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// Made here, or in the store because it was made before.
    Made,
    /// A file that the user has chosen.
    File(PathBuf),
}

/// How far the reference has come.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// The view that it belongs to, counted by who makes it.
    pub view: u64,
    /// Where it comes from.
    pub origin: Origin,
    /// Pictures that it is the mean of.
    pub pictures: u32,
    /// Its own relMSE, if that is known.
    pub noise: Option<f64>,
    /// Seconds that were spent on it.
    pub seconds: f64,
    /// Whether no more will come.
    pub done: bool,
}
