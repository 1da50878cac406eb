//! The picture of a PNG in linear light: grey or coloured, 1 to 16 bits, with a palette or without.

use super::chunks;
use super::colours::{Colours, Transfer};
use crate::primaries::converted;
use crate::{Encoding, ImageFileError, Loaded, MOST_PIXELS, Texels, check_pixels, image_of};
use film::Vec3;
use std::fs::File;
use std::io::{BufRead, BufReader, Seek};
use std::path::Path;

/// Pixels as the decoder gives them: grey or red, green and blue, with alpha or without, of 8 or 16 bits.
struct Decoded {
    bytes: Vec<u8>,
    channels: usize,
    depth: png::BitDepth,
}

impl Decoded {
    /// A number from 0 to 1.
    fn number(&self, index: usize) -> f32 {
        match self.depth {
            png::BitDepth::Sixteen => {
                f32::from(u16::from_be_bytes([self.bytes[2 * index], self.bytes[2 * index + 1]])) / 65535.0
            }
            _ => f32::from(self.bytes[index]) / 255.0,
        }
    }

    fn pixels(&self) -> usize {
        self.bytes.len() / self.channels / if self.depth == png::BitDepth::Sixteen { 2 } else { 1 }
    }

    /// The colour of a pixel as it is encoded, and its alpha.
    fn pixel(&self, index: usize) -> (Vec3, f32) {
        let first = index * self.channels;
        let colour = match self.channels {
            1 | 2 => Vec3::splat(self.number(first)),
            _ => Vec3::new(self.number(first), self.number(first + 1), self.number(first + 2)),
        };
        (colour, if self.channels.is_multiple_of(2) { self.number(first + self.channels - 1) } else { 1.0 })
    }
}

/// A decoder that expands palettes and few bits, of a picture that has at most so many pixels.
fn decoder<R: BufRead + Seek>(file: R, most: u64, path: &Path) -> Result<png::Decoder<R>, ImageFileError> {
    let mut decoder = png::Decoder::new(file);
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    let header = decoder.read_header_info().map_err(|e| ImageFileError::read(path, e))?;
    check_pixels(header.width as usize, header.height as usize, most, path)?;
    Ok(decoder)
}

fn decoded<R: BufRead + Seek>(reader: &mut png::Reader<R>, path: &Path) -> Result<Decoded, ImageFileError> {
    let fault = |e: &dyn std::fmt::Display| ImageFileError::read(path, e);
    let (kind, depth) = reader.output_color_type();
    let size = reader.output_buffer_size().ok_or_else(|| fault(&"it is too large"))?;
    let mut decoded = Decoded { bytes: vec![0; size], channels: kind.samples(), depth };
    reader.next_frame(&mut decoded.bytes).map_err(|e| fault(&e))?;
    Ok(decoded)
}

/// The picture over black.
pub fn load(path: &Path) -> Result<Loaded, ImageFileError> {
    let fault = |e: &dyn std::fmt::Display| ImageFileError::read(path, e);
    let file = BufReader::new(File::open(path).map_err(|e| fault(&e))?);
    let mut reader = decoder(file, MOST_PIXELS, path)?.read_info().map_err(|e| fault(&e))?;
    let decoded = decoded(&mut reader, path)?;
    let info = reader.info();
    let mut colours = Colours::of(info, &chunks::names(path).map_err(|e| fault(&e))?);
    colours.notes.extend(what_is_left_out(info));
    let (radiances, translucent) = in_light(&decoded, &colours);
    if translucent {
        colours.notes.push("its alpha is applied: what it lets through is black".into());
    }
    Ok(Loaded { image: image_of((info.width, info.height), radiances, path)?, notes: colours.notes })
}

/// The picture with its alpha, of at most so many texels.
pub fn texels(file: impl BufRead + Seek, encoding: Encoding, most: u64, path: &Path) -> Result<Texels, ImageFileError> {
    let decoder = decoder(file, most, path)?;
    let mut reader = decoder.read_info().map_err(|e| ImageFileError::read(path, e))?;
    let decoded = decoded(&mut reader, path)?;
    let texel = |index| {
        let (code, alpha) = decoded.pixel(index);
        let colour = match encoding {
            Encoding::Srgb => code.map(|code| Transfer::Srgb.decode(code)),
            Encoding::Linear => code,
        };
        colour.extend(alpha).to_array()
    };
    let size = (reader.info().width, reader.info().height);
    Ok(Texels { size, texels: (0..decoded.pixels()).map(texel).collect() })
}

fn in_light(decoded: &Decoded, colours: &Colours) -> (Vec<Vec3>, bool) {
    let mut translucent = false;
    let pixels = (0..decoded.pixels()).map(|index| {
        let (code, alpha) = decoded.pixel(index);
        let light = code.map(|code| colours.transfer.decode(code));
        let light = colours.matrix.map_or(light, |matrix| converted(&matrix, light));
        translucent |= alpha < 1.0;
        alpha * light
    });
    (pixels.collect(), translucent)
}

fn what_is_left_out(info: &png::Info) -> impl Iterator<Item = String> {
    let frames = info.animation_control.map(|animation| animation.num_frames).filter(|frames| *frames > 1);
    let frames = frames.map(|frames| format!("this is the first of its {frames} frames"));
    let ratio = info.pixel_dims.map(|per_unit| f64::from(per_unit.yppu) / f64::from(per_unit.xppu));
    let oblong = ratio.and_then(crate::oblong);
    frames.into_iter().chain(oblong)
}
