//! Files that are whole or not there: written beside the target, then moved. Where moving would change more than the
//! content (a second name, an owner, an access list), or the folder forbids it, the file that is there is written in place.

use crate::partial::Partial;
use crate::{ImageFileError, free_name, home_folder};
use std::fs::{File, Metadata};
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Fails at once if `path` cannot be written, before anyone waits for a picture: a file that is there is opened for
/// writing, one that is not is made and removed.
///
/// # Errors
/// [`ImageFileError::Write`], one line that says why and names the path.
pub fn check_writable(path: &Path) -> Result<(), ImageFileError> {
    let checked = target_of(path).and_then(|target| match open_existing(&target)? {
        Some(_) => Ok(()),
        None => Partial::create_new(target, false).map(drop),
    });
    checked.map_err(|e| ImageFileError::write(path, e))
}

/// Makes `bytes` the content of `path`. A file that is there keeps its mode, its owner and its other names.
///
/// # Errors
/// [`ImageFileError::Write`], one line that says why and names the path; what was there stays, unless the disk failed while
/// it was written in place.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), ImageFileError> {
    let written = target_of(path).and_then(|target| match open_existing(&target)? {
        Some(existing) => overwrite(&target, existing, bytes),
        None => create(&target, bytes),
    });
    written.map_err(|e| ImageFileError::write(path, e))
}

/// As [`write_whole`], of what must not be lost: if it cannot be put where it was asked for, it is put beside it under a
/// number, else into the folder for temporary files, else into the home folder.
///
/// # Errors
/// [`ImageFileError::Kept`], which says where it is, or [`ImageFileError::Write`] if it is nowhere.
pub fn write_or_keep(path: &Path, bytes: &[u8]) -> Result<(), ImageFileError> {
    let Err(fault) = write_whole(path, bytes) else { return Ok(()) };
    let name = path.file_name().unwrap_or_default();
    let elsewhere = [Some(path.to_owned()), Some(std::env::temp_dir().join(name)), home_folder().map(|h| h.join(name))];
    match elsewhere.iter().flatten().find_map(|place| write_new(place, bytes).ok()) {
        Some(kept) => Err(ImageFileError::Kept { fault: Box::new(fault), kept }),
        None => Err(fault),
    }
}

/// As [`write_whole`], but never over another file: where there is one, a number is added to the name. Returns the
/// name.
///
/// # Errors
/// As [`write_whole`].
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<PathBuf, ImageFileError> {
    let fault = |e| ImageFileError::write(path, e);
    let mut partial = Partial::create(folder_of(path), false).map_err(fault)?;
    partial.fill(bytes).map_err(fault)?;
    loop {
        let free = free_name(path)?;
        match move_to_new(partial.path(), &free) {
            // someone else was faster
            Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
            moved => return moved.map_err(|e| ImageFileError::write(&free, e)).map(|()| free),
        }
    }
}

/// A second name fails where there is a file already, which moving does not; some file systems know no second names.
fn move_to_new(partial: &Path, path: &Path) -> std::io::Result<()> {
    match std::fs::hard_link(partial, path) {
        Err(e) if e.kind() != ErrorKind::AlreadyExists && path.symlink_metadata().is_err() => {
            std::fs::rename(partial, path)
        }
        outcome => outcome,
    }
}

/// Whether two names stand for one file, which writing to either changes.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    if let (Ok(a), Ok(b)) = (a.metadata(), b.metadata()) {
        use std::os::unix::fs::MetadataExt;
        return (a.dev(), a.ino()) == (b.dev(), b.ino());
    }
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// The file that a name stands for: links are written through, not replaced.
fn target_of(path: &Path) -> std::io::Result<PathBuf> {
    let mut target = path.to_owned();
    // as many links in a row as Linux follows
    for _ in 0..40 {
        let Ok(next) = std::fs::read_link(&target) else { return Ok(target) };
        target = target.parent().map_or(next.clone(), |folder| folder.join(&next));
    }
    Err(Error::other("too many links in a row"))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| *folder != "").unwrap_or(Path::new("."))
}

/// The file that is there, for writing: the one test that knows all that may forbid it.
fn open_existing(target: &Path) -> std::io::Result<Option<File>> {
    match target.symlink_metadata() {
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(None),
        Err(e) => Err(e),
        Ok(found) if found.is_dir() => Err(Error::new(ErrorKind::IsADirectory, "this is a folder")),
        // a pipe or a device takes what it gets as it likes
        Ok(found) if !found.is_file() => Err(Error::other("this is not a file")),
        Ok(_) => File::options().write(true).open(target).map(Some),
    }
}

/// Moving is for whatever the folder takes; what cannot be moved is written where it belongs.
fn create(target: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut partial = Partial::create(folder_of(target), false)?;
    partial.fill(bytes)?;
    std::fs::rename(partial.path(), target)
        .or_else(|_| File::create(target).and_then(|file| write_in_place(file, bytes)))
}

fn overwrite(target: &Path, existing: File, bytes: &[u8]) -> std::io::Result<()> {
    let found = existing.metadata()?;
    if has_more_than_a_mode(&existing, &found) {
        return write_in_place(existing, bytes);
    }
    let Ok(mut partial) = Partial::create(folder_of(target), true) else { return write_in_place(existing, bytes) };
    // a full disk must not cost what is there as well
    partial.fill(bytes)?;
    let replaced = take_owner_and_mode(partial.file(), &found).and_then(|()| std::fs::rename(partial.path(), target));
    replaced.or_else(|_| write_in_place(existing, bytes))
}

fn write_in_place(mut file: File, bytes: &[u8]) -> std::io::Result<()> {
    file.write_all(bytes)?;
    file.set_len(bytes.len() as u64)?;
    file.sync_all()
}

/// Whether a new file in its place would not be the same one to everybody.
#[cfg(unix)]
fn has_more_than_a_mode(file: &File, found: &Metadata) -> bool {
    std::os::unix::fs::MetadataExt::nlink(found) > 1 || has_attributes(file)
}

#[cfg(not(unix))]
fn has_more_than_a_mode(_: &File, _: &Metadata) -> bool {
    false
}

/// Access lists and what users keep with a file. A security label is the folder's to give.
#[cfg(any(target_os = "linux", target_os = "android", target_os = "macos"))]
fn has_attributes(file: &File) -> bool {
    let mut names = [0; 4096];
    let own = |name: &[u8]| !name.is_empty() && !name.starts_with(b"security.");
    match rustix::fs::flistxattr(file, &mut names) {
        Ok(length) => names.get(..length).is_some_and(|names| names.split(|byte| *byte == 0).any(own)),
        // more than fit; a file system without attributes has none
        Err(fault) => fault == rustix::io::Errno::RANGE,
    }
}

#[cfg(all(unix, not(any(target_os = "linux", target_os = "android", target_os = "macos"))))]
fn has_attributes(_: &File) -> bool {
    false
}

/// The owner first: changing it may take bits of the mode.
fn take_owner_and_mode(file: &File, found: &Metadata) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let own = file.metadata()?;
        if (own.uid(), own.gid()) != (found.uid(), found.gid()) {
            std::os::unix::fs::fchown(file, Some(found.uid()), Some(found.gid()))?;
        }
    }
    file.set_permissions(found.permissions())
}

#[cfg(test)]
mod tests;
