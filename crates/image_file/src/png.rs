//! PNG: sRGB bytes, and records in text chunks as `visavis.name`.

mod chunks;
mod colours;
mod read;

pub use chunks::records;
pub use read::{load, texels};

use super::ImageFileError;

/// Opaque RGBA bytes as a PNG without alpha.
pub fn bytes(
    width: u32,
    height: u32,
    rgba: &[u8],
    records: &[(impl AsRef<str>, String)],
) -> Result<Vec<u8>, ImageFileError> {
    encode(width, height, rgba, records).map_err(|e| ImageFileError::Encode("PNG", e.to_string()))
}

fn encode(
    width: u32,
    height: u32,
    rgba: &[u8],
    records: &[(impl AsRef<str>, String)],
) -> Result<Vec<u8>, png::EncodingError> {
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    encoder.add_itxt_chunk("Software".into(), concat!("Visavis ", env!("CARGO_PKG_VERSION")).into())?;
    for (name, value) in records {
        encoder.add_itxt_chunk(format!("visavis.{}", name.as_ref()), value.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}
