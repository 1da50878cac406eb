//! EXR: linear radiance, and records as text attributes `visavis.name`.

mod channels;
mod layers;
mod read;

pub use layers::{Layers, layers};
pub use read::{layer, load};

use super::ImageFileError;
use ::exr::meta::header::Header;
use exr::prelude as exr;
use film::{Layer, LayerValues, Vec3};
use std::path::Path;

/// The channels of a colour.
const COLOUR: [&str; 3] = ["R", "G", "B"];
/// Those of a direction.
const DIRECTION: [&str; 3] = ["X", "Y", "Z"];
/// That of a number, as of luminance.
const NUMBER: &str = "Y";
/// That of a distance from the camera.
const DEPTH: &str = "Z";

/// A file of these layers, each with its own channels of 32-bit floats.
pub fn bytes(
    (width, height): (u32, u32),
    layers: &[Layer],
    records: &[(impl AsRef<str>, String)],
) -> Result<Vec<u8>, ImageFileError> {
    use exr::WritableImage as _;
    let size = exr::Vec2(width as usize, height as usize);
    let layers = layers.iter().map(|layer| {
        let channels = exr::AnyChannels::sort(channels_of(&layer.values).into());
        exr::Layer::new(size, attributes(layer.name, records), exr::Encoding::FAST_LOSSLESS, channels)
    });
    let window = exr::IntegerBounds::new((0, 0), size);
    let image = exr::Image::from_layers(exr::ImageAttributes::new(window), layers.collect::<exr::Layers<_>>());
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(|e| ImageFileError::Encode("EXR", e.to_string()))?;
    Ok(bytes.into_inner())
}

/// Under the names that OpenEXR's documentation gives to what they are.
fn channels_of(values: &LayerValues) -> Vec<exr::AnyChannel<exr::FlatSamples>> {
    let channel = |name: &str, values: Vec<f32>| exr::AnyChannel::new(name, exr::FlatSamples::F32(values));
    let three = |names: [&str; 3], values: &[Vec3]| {
        let axes = names.into_iter().enumerate();
        axes.map(|(axis, name)| channel(name, values.iter().map(|value| value[axis]).collect())).collect()
    };
    match values {
        LayerValues::Rgb(colours) => three(COLOUR, colours),
        LayerValues::Directions(directions) => three(DIRECTION, directions),
        LayerValues::Numbers(numbers) => vec![channel(NUMBER, numbers.to_vec())],
        LayerValues::Depths(depths) => vec![channel(DEPTH, depths.to_vec())],
    }
}

/// A layer's name, and the records, which stand with every layer.
fn attributes(name: &str, records: &[(impl AsRef<str>, String)]) -> exr::LayerAttributes {
    let mut attributes = exr::LayerAttributes::named(name);
    attributes.software_name = exr::Text::new_or_none(concat!("Visavis ", env!("CARGO_PKG_VERSION")));
    for (name, value) in records {
        attributes.other.insert(text(&format!("visavis.{}", name.as_ref())), exr::AttributeValue::Text(text(value)));
    }
    attributes
}

/// A text in UTF-8, which OpenEXR takes as it takes any bytes.
fn text(words: &str) -> exr::Text {
    exr::Text::from_slice_unchecked(words.as_bytes())
}

/// The records of an EXR of this program; none in another's.
pub fn records(path: &Path) -> Result<Vec<(String, String)>, ImageFileError> {
    let meta = exr::MetaData::read_from_file(path, false).map_err(|e| ImageFileError::read(path, e))?;
    Ok(records_of(&meta.headers).collect())
}

/// They stand with every layer.
fn records_of(headers: &[Header]) -> impl Iterator<Item = (String, String)> {
    headers.iter().take(1).flat_map(|header| &header.own_attributes.other).filter_map(|(name, value)| {
        let exr::AttributeValue::Text(value) = value else { return None };
        let utf8 = |text: &exr::Text| String::from_utf8_lossy(text.as_slice()).into_owned();
        Some((utf8(name).strip_prefix("visavis.")?.to_owned(), utf8(value)))
    })
}
