//! PNG: sRGB bytes, and records in text chunks as `visavis.name`.

use super::{ImageFileError, Records, check_pixels, image_of};
use film::{Image, Vec3, colour};
use std::path::Path;

/// Opaque RGBA bytes as a PNG without alpha.
pub fn bytes(width: u32, height: u32, rgba: &[u8], records: &Records) -> Result<Vec<u8>, ImageFileError> {
    encode(width, height, rgba, records).map_err(|e| ImageFileError::Encode("PNG", e.to_string()))
}

fn encode(width: u32, height: u32, rgba: &[u8], records: &Records) -> Result<Vec<u8>, png::EncodingError> {
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    encoder.add_itxt_chunk("Software".into(), concat!("Visavis ", env!("CARGO_PKG_VERSION")).into())?;
    for (name, value) in records {
        encoder.add_itxt_chunk(format!("visavis.{name}"), value.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}

/// The records of a PNG of this program; none in another's.
pub fn records(path: &Path) -> Result<Vec<(String, String)>, ImageFileError> {
    let file = std::fs::File::open(path).map_err(|e| ImageFileError::read(path, e))?;
    let reader =
        png::Decoder::new(std::io::BufReader::new(file)).read_info().map_err(|e| ImageFileError::read(path, e))?;
    // this program does not compress them, and what others compress may be of any size
    let ours = |chunk: &png::text_metadata::ITXtChunk| {
        if chunk.compressed {
            return None;
        }
        Some((chunk.keyword.strip_prefix("visavis.")?.to_owned(), chunk.get_text().ok()?))
    };
    Ok(reader.info().utf8_text.iter().filter_map(ours).collect())
}

/// A PNG with its sRGB encoding undone.
pub fn load(path: &Path) -> Result<Image, ImageFileError> {
    let (width, height) = image::image_dimensions(path).map_err(|e| ImageFileError::read(path, e))?;
    check_pixels(width as usize, height as usize, path)?;
    let picture = image::ImageReader::open(path)
        .map_err(image::ImageError::from)
        .and_then(image::ImageReader::decode)
        .map_err(|e| ImageFileError::read(path, e))?
        .into_rgb32f();
    let radiances = picture.pixels().map(|p| Vec3::from_array(p.0.map(colour::srgb_decode))).collect();
    image_of(picture.dimensions(), radiances, path)
}
