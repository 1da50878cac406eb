//! EXR: linear radiance, and records as text attributes `visavis.name`.

use super::{ImageFileError, Records, check_pixels, image_of};
use exr::prelude as exr;
use film::{Image, Layer, LayerValues, Vec3};
use std::path::Path;

/// A file of these layers, each with its own channels of 32-bit floats.
pub fn bytes((width, height): (u32, u32), layers: &[Layer], records: &Records) -> Result<Vec<u8>, ImageFileError> {
    use exr::WritableImage as _;
    let size = exr::Vec2(width as usize, height as usize);
    let channel = |name: &str, values: Vec<f32>| exr::AnyChannel::new(name, exr::FlatSamples::F32(values));
    let layers = layers.iter().map(|layer| {
        let channels = match &layer.values {
            LayerValues::Rgb(pixels) => ["R", "G", "B"]
                .into_iter()
                .enumerate()
                .map(|(axis, name)| channel(name, pixels.iter().map(|p| p[axis]).collect()))
                .collect(),
            LayerValues::Numbers(values) => std::iter::once(channel("Y", values.to_vec())).collect(),
        };
        exr::Layer::new(
            size,
            attributes(layer.name, records),
            exr::Encoding::FAST_LOSSLESS,
            exr::AnyChannels::sort(channels),
        )
    });
    let window = exr::IntegerBounds::new((0, 0), size);
    let image = exr::Image::from_layers(exr::ImageAttributes::new(window), layers.collect::<exr::Layers<_>>());
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(|e| ImageFileError::Encode("EXR", e.to_string()))?;
    Ok(bytes.into_inner())
}

/// A layer's name, and the records, which stand with every layer.
fn attributes(name: &str, records: &Records) -> exr::LayerAttributes {
    let mut attributes = exr::LayerAttributes::named(name);
    attributes.software_name = exr::Text::new_or_none(concat!("Visavis ", env!("CARGO_PKG_VERSION")));
    for (name, value) in records {
        attributes.other.insert(text(&format!("visavis.{name}")), exr::AttributeValue::Text(text(value)));
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
    let texts =
        meta.headers.iter().take(1).flat_map(|header| &header.own_attributes.other).filter_map(|(name, value)| {
            let exr::AttributeValue::Text(value) = value else { return None };
            let utf8 = |text: &exr::Text| String::from_utf8_lossy(text.as_slice()).into_owned();
            Some((utf8(name).strip_prefix("visavis.")?.to_owned(), utf8(value)))
        });
    Ok(texts.collect())
}

/// The layer of this name, if it has red, green and blue and is of this size.
pub fn layer(path: &Path, name: &str, size: (u32, u32)) -> Result<Option<LayerValues>, ImageFileError> {
    use exr::{ReadChannels as _, ReadLayers as _};
    check_sizes(path)?;
    let reader = exr::read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = reader.from_file(path).map_err(|e| ImageFileError::read(path, e))?;
    let named =
        |layer: &&exr::Layer<exr::AnyChannels<exr::FlatSamples>>| layer.attributes.layer_name == Some(text(name));
    let Some(layer) = image.layer_data.iter().find(named) else { return Ok(None) };
    if layer.size != exr::Vec2(size.0 as usize, size.1 as usize) {
        return Ok(None);
    }
    let channel = |name: &str| layer.channel_data.list.iter().find(|channel| channel.name.eq(name));
    let (Some(r), Some(g), Some(b)) = (channel("R"), channel("G"), channel("B")) else { return Ok(None) };
    let [r, g, b] = [r, g, b].map(|channel| channel.sample_data.values_as_f32());
    Ok(Some(LayerValues::Rgb(r.zip(g).zip(b).map(|((r, g), b)| Vec3::new(r, g, b)).collect())))
}

/// Refuses a file before memory is taken for any of its layers.
fn check_sizes(path: &Path) -> Result<(), ImageFileError> {
    let meta = exr::MetaData::read_from_file(path, false).map_err(|e| ImageFileError::read(path, e))?;
    meta.headers.iter().try_for_each(|header| check_pixels(header.layer_size.width(), header.layer_size.height(), path))
}

/// The first layer with red, green and blue.
pub fn load(path: &Path) -> Result<Image, ImageFileError> {
    check_sizes(path)?;
    let picture = exr::read_first_rgba_layer_from_file(
        path,
        |size, _| (size, vec![Vec3::ZERO; size.width() * size.height()]),
        |(size, pixels): &mut (exr::Vec2<usize>, Vec<Vec3>), at, (r, g, b, _): (f32, f32, f32, f32)| {
            pixels[at.y() * size.width() + at.x()] = Vec3::new(r, g, b);
        },
    )
    .map_err(|e| ImageFileError::read(path, e))?;
    let (size, pixels) = picture.layer_data.channel_data.pixels;
    image_of((size.width() as u32, size.height() as u32), pixels, path)
}
