//! Names for pictures that nobody has named.

use crate::ImageFileError;
use std::path::{Path, PathBuf};

/// Where pictures go unless the user says otherwise: the pictures folder of the home folder if there is one, else the
/// home folder, else the current one.
///
/// # Errors
/// If there is no current folder either.
pub fn default_folder() -> Result<PathBuf, ImageFileError> {
    let home = ["HOME", "USERPROFILE"].iter().find_map(std::env::var_os).map(PathBuf::from).filter(|p| p.is_dir());
    match home {
        Some(home) => Ok(Some(home.join("Pictures")).filter(|p| p.is_dir()).unwrap_or(home)),
        None => std::env::current_dir().map_err(|e| ImageFileError::NoFolder(e.to_string())),
    }
}

/// What a user has typed, as a path: blanks around it do not count, `~` is the home folder, and a name without a folder
/// lies below `folder`.
pub fn typed_path(typed: &str, folder: &Path) -> PathBuf {
    let typed = typed.trim();
    let home = || std::env::var_os("HOME").map(PathBuf::from);
    match (typed.strip_prefix('~'), home()) {
        (Some(""), Some(home)) => home,
        (Some(rest), Some(home)) if rest.starts_with('/') => home.join(&rest[1..]),
        _ => folder.join(typed),
    }
}

/// `path` itself, or the first of `stem-2.png`, `stem-3.png`, ... beside it that does not exist yet.
///
/// # Errors
/// If all of ten thousand do.
pub fn free_name(path: &Path) -> Result<PathBuf, ImageFileError> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let numbered = (2..10_000).map(|n| path.with_file_name(format!("{stem}-{n}.{extension}")));
    let free = std::iter::once(path.to_owned()).chain(numbered).find(|path| path.symlink_metadata().is_err());
    free.ok_or_else(|| ImageFileError::Names(path.to_owned()))
}
