//! Files that are whole or not there: written beside the target, then moved. Where moving would change more than the
//! content (a second name, an owner, an access list), or the folder forbids it, the file that is there is written in place.

use crate::partial::{Partial, in_the_making};
use crate::{ImageFileError, free_name, home_folder};
use std::fs::{File, Metadata};
use std::io::{Error, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Fails at once if `path` cannot be written, before anyone waits for a picture: a file that is there is opened for
/// writing; for one that is not another is made in its folder and removed.
///
/// # Errors
/// [`ImageFileError::Write`], one line that says why and names the path.
pub fn check_writable(path: &Path) -> Result<(), ImageFileError> {
    let checked = target_of(path).and_then(|target| match open_existing(&target)? {
        Some(_) => Ok(()),
        None => check_new(&target),
    });
    checked.map_err(|e| ImageFileError::write(path, e))
}

fn check_new(target: &Path) -> std::io::Result<()> {
    let folder = folder_of(target);
    match target.file_name() {
        Some(name) if !ends_in_a_separator(target) => {
            if keeps_all_names(folder) {
                may_add_to(folder)
            } else {
                Partial::probe(folder, name)
            }
        }
        _ => Err(Error::new(ErrorKind::IsADirectory, "this is the name of a folder")),
    }
}

fn ends_in_a_separator(path: &Path) -> bool {
    path.as_os_str().as_encoded_bytes().last().is_some_and(|byte| std::path::is_separator(char::from(*byte)))
}

/// Makes `bytes` the content of `path`. A file that is there keeps its mode, its owner and its other names.
///
/// # Errors
/// [`ImageFileError::Write`], one line that says why and names the path; what was there stays, unless it was written in
/// place and the disk failed where it had room before.
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
    let mut partial = beside(path, false).map_err(fault)?;
    if let Some(partial) = &mut partial {
        partial.fill(bytes).map_err(fault)?;
    }
    loop {
        let free = free_name(path)?;
        let written = match &partial {
            Some(partial) => move_to_new(partial.path(), &free),
            None => File::create_new(&free).and_then(|file| write_in_place(file, bytes)),
        };
        match written {
            // someone else was faster
            Err(ref e) if e.kind() == ErrorKind::AlreadyExists => {}
            _ => return written.map_err(|e| ImageFileError::write(&free, e)).map(|()| free),
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
        Ok(_) => match File::options().write(true).open(target) {
            // somebody has just removed it
            Err(e) if e.kind() == ErrorKind::NotFound => Ok(None),
            opened => opened.map(Some),
        },
    }
}

/// Moving is for whatever the folder takes; what cannot be moved is written where it belongs.
fn create(target: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if let Some(mut partial) = beside(target, false)? {
        partial.fill(bytes)?;
        if std::fs::rename(partial.path(), target).is_ok() {
            return Ok(());
        }
    }
    let new = File::options().write(true).create(true).truncate(false).open(target)?;
    let was_empty = new.metadata()?.len() == 0;
    let written = write_in_place(new, bytes);
    if written.is_err() && was_empty {
        let _ = std::fs::remove_file(target);
    }
    written
}

fn overwrite(target: &Path, existing: File, bytes: &[u8]) -> std::io::Result<()> {
    let found = existing.metadata()?;
    if let Ok(Some(mut partial)) = beside(target, true) {
        // a full disk must not cost what is there as well, also where it is written in place
        partial.fill(bytes)?;
        if !has_more_than_a_mode(&existing, &found)
            && take_owner_and_mode(partial.file(), &found).is_ok()
            && std::fs::rename(partial.path(), target).is_ok()
        {
            return Ok(());
        }
    }
    write_in_place(existing, bytes)
}

/// `None` where it could be neither moved nor removed.
fn beside(target: &Path, private: bool) -> std::io::Result<Option<Partial>> {
    let folder = folder_of(target);
    if keeps_all_names(folder) { Ok(None) } else { Partial::create(folder, private).map(Some) }
}

/// What is longer than before is written first: if the disk has no room for it, what was there is still whole.
fn write_in_place(mut file: File, bytes: &[u8]) -> std::io::Result<()> {
    let _held = in_the_making();
    let found = file.metadata()?;
    let (head, tail) = bytes.split_at(bytes.len().min(found.len() as usize));
    let grown = file.seek(SeekFrom::End(0)).and_then(|_| file.write_all(tail)).and_then(|()| file.sync_all());
    if let Err(fault) = grown {
        file.set_len(found.len())?;
        return Err(fault);
    }
    file.rewind()?;
    file.write_all(head)?;
    file.set_len(bytes.len() as u64)?;
    // writing may take bits of the mode, which whoever is not the owner cannot give back
    let _ = file.set_permissions(found.permissions());
    file.sync_all()
}

/// Whether files can be added to a folder, but neither moved nor removed there.
#[cfg(any(target_os = "linux", target_os = "android"))]
fn keeps_all_names(folder: &Path) -> bool {
    use rustix::fs::{AtFlags, CWD, StatxAttributes, StatxFlags, statx};
    statx(CWD, folder, AtFlags::empty(), StatxFlags::empty())
        .is_ok_and(|found| found.stx_attributes.contains(StatxAttributes::APPEND))
}

/// By `UF_APPEND` and `SF_APPEND` of sys/stat.h.
#[cfg(target_os = "macos")]
fn keeps_all_names(folder: &Path) -> bool {
    use std::os::macos::fs::MetadataExt;
    folder.metadata().is_ok_and(|found| found.st_flags() & 0x0004_0004 != 0)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_os = "macos")))]
fn keeps_all_names(_: &Path) -> bool {
    false
}

fn may_add_to(folder: &Path) -> std::io::Result<()> {
    #[cfg(unix)]
    rustix::fs::access(folder, rustix::fs::Access::WRITE_OK | rustix::fs::Access::EXEC_OK)?;
    #[cfg(not(unix))]
    let _ = folder;
    Ok(())
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

/// A security label is the folder's to give; macOS notes at nearly every file where it came from and when it was used.
#[cfg(any(target_os = "linux", target_os = "android", target_os = "macos"))]
const SYSTEM_ATTRIBUTES: [&[u8]; 2] = [b"security.", b"com.apple."];

/// Access lists and what users keep with a file.
#[cfg(any(target_os = "linux", target_os = "android", target_os = "macos"))]
fn has_attributes(file: &File) -> bool {
    let mut names = [0; 4096];
    let own = |name: &[u8]| !name.is_empty() && !SYSTEM_ATTRIBUTES.iter().any(|begin| name.starts_with(begin));
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
