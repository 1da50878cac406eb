//! Names for pictures that nobody has named.

use crate::{ImageFileError, home_folder};
use std::path::{Path, PathBuf};

/// What a user has typed, as a path: blanks around it do not count, `~` is the home folder, and a name without a folder
/// lies below `folder`.
pub fn typed_path(typed: &str, folder: &Path) -> PathBuf {
    let typed = typed.trim();
    match (typed.strip_prefix('~'), home_folder()) {
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
