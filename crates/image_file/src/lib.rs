//! Pictures on disk: PNG through the display transform with its records in text chunks, EXR linear with its records in
//! the header. Written beside the target and moved there, so that a file is whole or not there.

mod codes;
mod error;
mod exr;
mod folders;
mod lock;
mod names;
mod partial;
mod png;
mod primaries;
mod whole;

pub use self::exr::Layers;
pub use codes::{CodeCurve, Codes, decode_codes};
pub use error::{ImageFileError, escaped, shown};
pub use folders::{cache_folder, default_folder, home_folder, state_folder};
pub use lock::hold;
pub use names::{free_name, typed_path};
pub use partial::{NoMoreFiles, is_partial, remove_partial_files, remove_unless_held};
pub use whole::{check_writable, is_same_file, write_new, write_or_keep, write_whole};

use film::{DisplayTransform, Image, Layer, LayerValues, Vec3};
use std::iter;
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
fn check_pixels(width: usize, height: usize, most: u64, path: &Path) -> Result<(), ImageFileError> {
    let pixels = width as u64 * height as u64;
    if pixels > most {
        return Err(ImageFileError::TooLarge { width, height, most, path: path.to_owned() });
    }
    Ok(())
}

/// What is to be said of pixels that are so many times as wide as high.
fn oblong(ratio: f64) -> Option<String> {
    match ratio {
        1.0 => None,
        _ if ratio > 0.0 && ratio.is_finite() => {
            Some(format!("its pixels are {ratio:.3} times as wide as high, and taken as squares"))
        }
        _ => Some("what it says of its pixels' width and height makes no sense: they are taken as squares".into()),
    }
}

/// What a file says, if it is a picture.
fn image_of((width, height): (u32, u32), radiances: Vec<Vec3>, path: &Path) -> Result<Image, ImageFileError> {
    if radiances.is_empty() {
        return Err(ImageFileError::read(path, "it is empty"));
    }
    Image::new(width, height, radiances).ok_or_else(|| ImageFileError::read(path, "its pixels are not of its size"))
}

/// The bytes of a file of this kind: PNG through `display` and without the layers, EXR linear with the radiance as its
/// first layer; both keep `records`.
///
/// # Errors
/// If the picture cannot be encoded.
pub fn encode(
    kind: Kind,
    image: &Image,
    display: &DisplayTransform,
    records: &Records,
) -> Result<Vec<u8>, ImageFileError> {
    with_records(kind, image, display, records)
}

/// As [`encode`], with what was read by [`records`] of another picture.
///
/// # Errors
/// If the picture cannot be encoded.
pub fn encode_with_read(
    kind: Kind,
    image: &Image,
    display: &DisplayTransform,
    records: &[(String, String)],
) -> Result<Vec<u8>, ImageFileError> {
    with_records(kind, image, display, records)
}

fn with_records(
    kind: Kind,
    image: &Image,
    display: &DisplayTransform,
    records: &[(impl AsRef<str>, String)],
) -> Result<Vec<u8>, ImageFileError> {
    match kind {
        Kind::Png => png::bytes(image.width(), image.height(), &display.rgba8_of(image), records),
        Kind::Exr => {
            let layers: Vec<Layer> =
                iter::once(image.as_layer("radiance")).chain(image.layers.iter().cloned()).collect();
            exr::bytes(image.size(), &layers, records)
        }
    }
}

/// The bytes of a PNG of opaque RGBA pixels, rows from the top, that keeps `records`.
///
/// # Errors
/// If the picture cannot be encoded.
pub fn encode_rgba8(width: u32, height: u32, rgba: &[u8], records: &Records) -> Result<Vec<u8>, ImageFileError> {
    png::bytes(width, height, rgba, records)
}

/// The bytes of an EXR with these layers alone, of `size` pixels each, that keeps `records`.
///
/// # Errors
/// If they cannot be encoded.
pub fn encode_layers(size: (u32, u32), layers: &[Layer], records: &Records) -> Result<Vec<u8>, ImageFileError> {
    exr::bytes(size, layers, records)
}

/// The values of the layer of this name in an .exr, which its channels tell the kind of: R, G and B; X, Y and Z; Z, of depths;
/// or Y. `None` if there is none of `size` pixels.
///
/// # Errors
/// [`ImageFileError`]: one line that says why and names the path.
pub fn load_layer(path: &Path, name: &str, size: (u32, u32)) -> Result<Option<LayerValues>, ImageFileError> {
    exr::layer(path, name, size)
}

/// The layers of an .exr beside its picture, which is of this size.
///
/// # Errors
/// [`ImageFileError`]: one line that says why and names the path.
pub fn load_layers(path: &Path, size: (u32, u32)) -> Result<Layers, ImageFileError> {
    exr::layers(path, size)
}

/// A picture that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// Linear radiance in the colours of Rec. 709; without further layers.
    pub image: Image,
    /// What of the file it does not show, or shows by a choice of this program: a line each, the path last.
    pub notes: Vec<String>,
}

/// Reads a picture. An .exr is read as it is, also what is not finite; over its display window, black where it has no data;
/// its R, G and B, those of the layer that is named as a renderer's picture or of the only one, else its luminance Y. A .png
/// is read as its chunks say, else as sRGB, over black. Other primaries are converted.
///
/// # Errors
/// [`ImageFileError`]: one line that says why and names the path.
pub fn read(path: &Path) -> Result<Loaded, ImageFileError> {
    // a pipe or a device might never end
    if std::fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return Err(ImageFileError::read(path, "it is not a file"));
    }
    let mut loaded = match Kind::of(path) {
        Some(Kind::Png) => png::load(path),
        Some(Kind::Exr) => exr::load(path),
        None => Err(ImageFileError::Kind(path.to_owned())),
    }?;
    loaded.notes.iter_mut().for_each(|note| *note += &format!(": {}", shown(path)));
    Ok(loaded)
}

/// What the numbers of a picture on a surface mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// Colours by the curve of sRGB.
    Srgb,
    /// They are what they are: normals, roughness.
    Linear,
}

/// A picture on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Texels {
    /// Width and height of the picture in texels.
    pub size: (u32, u32),
    /// Red, green and blue, linear, and alpha, row by row from the top.
    pub texels: Vec<[f32; 4]>,
}

/// Texels that a picture on a surface may have at most: they take 1 GiB.
pub const MOST_TEXELS: u64 = 1 << 26;

/// Reads a .png as a picture on a surface, of `most` texels and of [`MOST_TEXELS`] at most. What it says of its own colours
/// does not count: models say it.
///
/// # Errors
/// [`ImageFileError`]: one line that says why and names the path.
pub fn texels(path: &Path, encoding: Encoding, most: u64) -> Result<Texels, ImageFileError> {
    if Kind::of(path) != Some(Kind::Png) {
        return Err(ImageFileError::read(path, "a picture on a surface is a .png"));
    }
    if std::fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return Err(ImageFileError::read(path, "it is not a file"));
    }
    let file = std::fs::File::open(path).map_err(|why| ImageFileError::read(path, why))?;
    png::texels(std::io::BufReader::new(file), encoding, most.min(MOST_TEXELS), path)
}

/// As [`read`], for whom what the picture does not show is nothing to tell of.
///
/// # Errors
/// As [`read`].
pub fn load(path: &Path) -> Result<Image, ImageFileError> {
    read(path).map(|loaded| loaded.image)
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
