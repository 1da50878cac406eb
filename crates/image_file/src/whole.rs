//! Files that are whole or not there: written beside the target, then moved.

use crate::{ImageFileError, free_name};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Fails at once if `path` cannot be written, before anyone waits for a picture.
///
/// # Errors
/// [`ImageFileError::Write`], one line that says why and names the path.
pub fn check_writable(path: &Path) -> Result<(), ImageFileError> {
    let target = behind_links(path);
    if target.is_dir() {
        return Err(ImageFileError::write(path, "this is a folder"));
    }
    if target.exists() && !target.is_file() {
        return Err(ImageFileError::write(path, "this is not a file"));
    }
    let partial = partial_path(&target);
    std::fs::File::create(&partial).map_err(|e| ImageFileError::write(path, e))?;
    std::fs::remove_file(&partial).map_err(|e| ImageFileError::write(path, e))
}

/// Writes `bytes` to a file beside `path`, then moves it there.
///
/// # Errors
/// [`ImageFileError::Write`], one line that says why and names the path; nothing is left behind then.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), ImageFileError> {
    let target = behind_links(path);
    let partial = partial_path(&target);
    let written = std::fs::File::create(&partial)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| std::fs::rename(&partial, &target));
    if written.is_err() {
        // what is half written must not stay; that it cannot be removed adds nothing to the first error
        let _ = std::fs::remove_file(&partial);
    }
    written.map_err(|e| ImageFileError::write(path, e))
}

/// As [`write_whole`], but never over another file: where there is one, a number is added to the name. Returns the
/// name.
///
/// # Errors
/// As [`write_whole`].
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<PathBuf, ImageFileError> {
    let partial = partial_path(path);
    let written =
        std::fs::File::create(&partial).and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()));
    let moved = written.map_err(|e| ImageFileError::write(path, e)).and_then(|()| {
        loop {
            let free = free_name(path)?;
            match move_to_new(&partial, &free) {
                // someone else was faster
                Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => {}
                moved => return moved.map_err(|e| ImageFileError::write(&free, e)).map(|()| free),
            }
        }
    });
    // it is the picture by another name now, or what is half written and must not stay
    let _ = std::fs::remove_file(&partial);
    moved
}

/// A second name fails where there is a file already, which moving does not; some file systems know no second names.
fn move_to_new(partial: &Path, path: &Path) -> std::io::Result<()> {
    match std::fs::hard_link(partial, path) {
        Err(e) if e.kind() != std::io::ErrorKind::AlreadyExists && path.symlink_metadata().is_err() => {
            std::fs::rename(partial, path)
        }
        outcome => outcome,
    }
}

/// The file that a name stands for: links are written through, not replaced.
fn behind_links(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    // as many links in a row as Linux follows
    for _ in 0..40 {
        let Ok(next) = std::fs::read_link(&target) else { break };
        target = target.parent().map_or(next.clone(), |folder| folder.join(&next));
    }
    target
}

fn partial_path(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.partial", std::process::id()));
    path.with_file_name(name)
}
