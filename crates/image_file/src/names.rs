//! Names for pictures that nobody has named.

use crate::{ImageFileError, home_folder};
use std::ffi::OsString;
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
    let numbered = (2..10_000).map(|n| path.with_file_name(numbered(path, n)));
    let free = std::iter::once(path.to_owned()).chain(numbered).find(|path| path.symlink_metadata().is_err());
    free.ok_or_else(|| ImageFileError::Names(path.to_owned()))
}

/// Bytes that a name may have on the file systems of today.
const LONGEST_NAME: usize = 255;

/// `stem-2.png`; of a name that would become too long, as much as fits.
fn numbered(path: &Path, number: u32) -> OsString {
    let mut end = OsString::from(format!("-{number}"));
    if let Some(extension) = path.extension() {
        end.push(".");
        end.push(extension);
    }
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    if name.len() + end.len() > LONGEST_NAME {
        let stem = name.to_string_lossy();
        name = stem[..stem.floor_char_boundary(LONGEST_NAME.saturating_sub(end.len()))].into();
    }
    name.push(end);
    name
}
