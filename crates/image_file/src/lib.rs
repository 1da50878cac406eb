//! Pictures on disk: PNG through the display transform with its records in text chunks, EXR linear with its records in
//! the header. Written beside the target and moved there, so that a file is whole or not there.

mod error;
mod exr;
mod folders;
mod names;
mod png;
mod whole;

pub use error::ImageFileError;
pub use folders::{cache_folder, default_folder, home_folder};
pub use names::{free_name, typed_path};
pub use whole::{check_writable, write_new, write_whole};

use film::DisplayTransform;
use film::Vec3;
use std::path::Path;

/// Names and values that a file keeps, in the order in which they are written.
pub type Records = Vec<(&'static str, String)>;

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
fn check_pixels(width: usize, height: usize, path: &Path) -> Result<(), ImageFileError> {
    let pixels = width as u64 * height as u64;
    if pixels > MOST_PIXELS {
        return Err(ImageFileError::read(path, format!("{width}x{height} pixels are more than {MOST_PIXELS}")));
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

/// The bytes of a file of this kind: PNG through `display`, EXR linear; both keep `records`.
///
/// # Errors
/// If the picture cannot be encoded.
pub fn encode(
    kind: Kind,
    picture: Linear,
    display: &DisplayTransform,
    records: &Records,
) -> Result<Vec<u8>, ImageFileError> {
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
pub fn encode_rgba8(width: u32, height: u32, rgba: &[u8], records: &Records) -> Result<Vec<u8>, ImageFileError> {
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

/// The bytes of an EXR with these layers, all of one size, that keeps `records`.
///
/// # Errors
/// If they cannot be encoded.
pub fn encode_layers(width: u32, height: u32, layers: &[Layer], records: &Records) -> Result<Vec<u8>, ImageFileError> {
    exr::layers(width, height, layers, records)
}

/// The layer of this name in an .exr, red, green and blue; `None` if there is none.
///
/// # Errors
/// [`ImageFileError`]: one line that says why and names the path.
pub fn load_layer(path: &Path, name: &str) -> Result<Option<Radiances>, ImageFileError> {
    exr::layer(path, name)
}

/// Reads an .exr as it is, or a .png with its sRGB encoding undone.
///
/// # Errors
/// [`ImageFileError`]: one line that says why and names the path.
pub fn load(path: &Path) -> Result<Radiances, ImageFileError> {
    let picture = match Kind::of(path) {
        Some(Kind::Png) => png::load(path)?,
        Some(Kind::Exr) => exr::load(path)?,
        None => return Err(ImageFileError::Kind(path.to_owned())),
    };
    if picture.radiances.is_empty() {
        return Err(ImageFileError::read(path, "it is empty"));
    }
    Ok(picture)
}

/// What a picture of this program keeps about how it was made, names and values; empty for other pictures.
///
/// # Errors
/// [`ImageFileError`]: one line that says why and names the path.
pub fn records(path: &Path) -> Result<Vec<(String, String)>, ImageFileError> {
    match Kind::of(path) {
        Some(Kind::Png) => png::records(path),
        Some(Kind::Exr) => exr::records(path),
        None => Err(ImageFileError::Kind(path.to_owned())),
    }
}
