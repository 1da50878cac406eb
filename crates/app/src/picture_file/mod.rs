//! Pictures on disk: PNG through the display transform with its records in text chunks, EXR linear with its records in the
//! header. Written beside the target and moved there, so that a file is whole or not there.

mod exr;
mod names;
mod png;

pub use names::{default_folder, free_name, typed_path};

use crate::technique::Records;
use anyhow::bail;
use scene::Vec3;
use scene::display::DisplayTransform;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The kind of a picture file, by its extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Display-transformed, 8 bits.
    Png,
    /// Linear, 32-bit float.
    Exr,
}

impl Kind {
    /// The kind of a file name; `None` if it ends in neither .png nor .exr.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "png" => Some(Kind::Png),
            "exr" => Some(Kind::Exr),
            _ => None,
        }
    }
}

/// Pixels that a picture may have at most, written or read: a film of them takes 8 GiB.
pub const MOST_PIXELS: u64 = 1 << 27;

/// Refuses a picture before memory is taken for it.
fn check_pixels(width: usize, height: usize, path: &Path) -> anyhow::Result<()> {
    let pixels = width as u64 * height as u64;
    if pixels > MOST_PIXELS {
        bail!("cannot read the picture: {width}x{height} pixels are more than {MOST_PIXELS}: {}", path.display());
    }
    Ok(())
}

/// Linear radiance, rows from the top.
#[derive(Debug, Clone, Copy)]
pub struct Linear<'a> {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` of them.
    pub radiances: &'a [Vec3],
}

/// Fails at once if `path` cannot be written, before anyone waits for a picture.
///
/// # Errors
/// One line that says why and names the path.
pub fn check_writable(path: &Path) -> anyhow::Result<()> {
    let target = behind_links(path);
    if target.is_dir() {
        bail!("cannot write the picture: this is a folder: {}", path.display());
    }
    if target.exists() && !target.is_file() {
        bail!("cannot write the picture: this is not a file: {}", path.display());
    }
    let partial = partial_path(&target);
    std::fs::File::create(&partial).with_context_path(path)?;
    std::fs::remove_file(&partial).with_context_path(path)
}

/// The bytes of a file of this kind: PNG through `display`, EXR linear; both keep `records`.
///
/// # Errors
/// If the picture cannot be encoded.
pub fn encode(kind: Kind, picture: Linear, display: &DisplayTransform, records: &Records) -> anyhow::Result<Vec<u8>> {
    match kind {
        Kind::Png => {
            let rgba = display.to_rgba8(picture.radiances.iter().copied());
            png::bytes(picture.width, picture.height, &rgba, records)
        }
        Kind::Exr => exr::bytes(picture, records),
    }
}

/// The bytes of a PNG of opaque RGBA pixels, rows from the top, that keeps `records`.
///
/// # Errors
/// If the picture cannot be encoded.
pub fn encode_rgba8(width: u32, height: u32, rgba: &[u8], records: &Records) -> anyhow::Result<Vec<u8>> {
    png::bytes(width, height, rgba, records)
}

/// A picture as it was read: linear radiance, whatever stands there, also what is not finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Radiances {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Rows from the top.
    pub radiances: Vec<Vec3>,
}

/// A named picture of one or three channels in a file of several.
#[derive(Debug)]
pub struct Layer<'a> {
    /// Its name in the file.
    pub name: &'static str,
    /// Its pixels.
    pub values: LayerValues<'a>,
}

/// Rows from the top.
#[derive(Debug)]
pub enum LayerValues<'a> {
    /// Red, green and blue.
    Rgb(&'a [Vec3]),
    /// One number a pixel.
    Numbers(Vec<f32>),
}

/// The bytes of an EXR with these layers, all of one size.
///
/// # Errors
/// If they cannot be encoded.
pub fn encode_layers(width: u32, height: u32, layers: &[Layer]) -> anyhow::Result<Vec<u8>> {
    exr::layers(width, height, layers)
}

/// Reads an .exr as it is, or a .png with its sRGB encoding undone.
///
/// # Errors
/// One line that says why and names the path.
pub fn load(path: &Path) -> anyhow::Result<Radiances> {
    let picture = match Kind::of(path) {
        Some(Kind::Png) => png::load(path)?,
        Some(Kind::Exr) => exr::load(path)?,
        None => bail!("cannot read the picture: its name must end in .png or .exr: {}", path.display()),
    };
    if picture.radiances.is_empty() {
        bail!("cannot read the picture: it is empty: {}", path.display());
    }
    Ok(picture)
}

/// What a picture of this program keeps about how it was made, names and values; empty for other pictures.
///
/// # Errors
/// One line that says why and names the path.
pub fn records(path: &Path) -> anyhow::Result<Vec<(String, String)>> {
    match Kind::of(path) {
        Some(Kind::Png) => png::records(path),
        Some(Kind::Exr) => exr::records(path),
        None => bail!("cannot read the picture: its name must end in .png or .exr: {}", path.display()),
    }
}

/// Writes `bytes` to a file beside `path`, then moves it there.
///
/// # Errors
/// One line that says why and names the path; nothing is left behind then.
pub fn write_whole(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let target = behind_links(path);
    let partial = partial_path(&target);
    let written = std::fs::File::create(&partial)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| std::fs::rename(&partial, &target));
    if written.is_err() {
        // what is half written must not stay; that it cannot be removed adds nothing to the first error
        let _ = std::fs::remove_file(&partial);
    }
    written.with_context_path(path)
}

/// As [`write_whole`], but never over another file: where there is one, a number is added to the name. Returns the name.
///
/// # Errors
/// As [`write_whole`].
pub fn write_new(path: &Path, bytes: &[u8]) -> anyhow::Result<PathBuf> {
    let partial = partial_path(path);
    let written =
        std::fs::File::create(&partial).and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()));
    let moved = written.with_context_path(path).and_then(|()| {
        loop {
            let free = free_name(path)?;
            match move_to_new(&partial, &free) {
                // someone else was faster
                Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => {}
                moved => return moved.with_context_path(&free).map(|()| free),
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

trait WithContextPath<T> {
    fn with_context_path(self, path: &Path) -> anyhow::Result<T>;
}

impl<T> WithContextPath<T> for std::io::Result<T> {
    fn with_context_path(self, path: &Path) -> anyhow::Result<T> {
        self.map_err(|e| anyhow::anyhow!("cannot write the file ({e}): {}", path.display()))
    }
}

fn cannot_read(path: &Path, error: &dyn std::fmt::Display) -> anyhow::Error {
    let line = error.to_string().lines().collect::<Vec<_>>().join(", ");
    anyhow::anyhow!("cannot read the picture ({line}): {}", path.display())
}
