//! Pictures on surfaces, .png and .jpg, as models keep them: numbers whose meaning the model tells and no chunk of the
//! file. Nobody vouches for them, so that sizes are checked before memory is taken.

use film::colour::srgb_decode;
use std::io::Cursor;
use zune_core::bytestream::ZCursor;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

/// Pixels that such a picture may have.
const MOST_PIXELS: u64 = 1 << 26;

/// Passes over a progressive JPEG: encoders make about ten, and each costs the whole picture's time.
const MOST_SCANS: usize = 32;

/// What the codes of colours stand for; those of alpha are linear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CodeCurve {
    /// The numbers themselves, from 0 to 1.
    Linear,
    /// The curve of sRGB, by IEC 61966-2-1.
    Srgb,
}

/// A picture as it is encoded: grey or red, green and blue, with alpha or without, of 8 or 16 bits.
#[derive(Debug)]
pub struct Codes {
    size: (u32, u32),
    bytes: Vec<u8>,
    channels: usize,
    is_16_bit: bool,
}

impl Codes {
    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Red, green, blue and alpha of each pixel, row by row from the top.
    pub fn texels(&self, curve: CodeCurve) -> Vec<[f32; 4]> {
        let light = |code: f32| match curve {
            CodeCurve::Linear => code,
            CodeCurve::Srgb => srgb_decode(code),
        };
        if self.is_16_bit {
            let number = |wide: &[u8; 2]| f32::from(u16::from_be_bytes(*wide)) / 65535.0;
            return texels(self.bytes.as_chunks().0, self.channels, |code| light(number(code)), number);
        }
        let shares: [f32; 256] = std::array::from_fn(|code| code as f32 / 255.0);
        let lights = shares.map(light);
        texels(&self.bytes, self.channels, |code| lights[usize::from(*code)], |code| shares[usize::from(*code)])
    }
}

fn texels<T>(codes: &[T], channels: usize, light: impl Fn(&T) -> f32, alpha: impl Fn(&T) -> f32) -> Vec<[f32; 4]> {
    let texel = |pixel: &[T]| match pixel {
        [r, g, b, a] => [light(r), light(g), light(b), alpha(a)],
        [r, g, b] => [light(r), light(g), light(b), 1.0],
        [grey, a] => [light(grey), light(grey), light(grey), alpha(a)],
        [grey, ..] => [light(grey), light(grey), light(grey), 1.0],
        [] => [0.0; 4],
    };
    codes.chunks_exact(channels.max(1)).map(texel).collect()
}

/// Decodes a PNG or a JPEG, which its first bytes tell, of `most` pixels at most.
///
/// # Errors
/// A line that says why not.
pub fn decode_codes(bytes: &[u8], most: u64) -> Result<Codes, String> {
    let most = most.min(MOST_PIXELS);
    if bytes.starts_with(b"\x89PNG") {
        png_codes(bytes, most)
    } else if bytes.starts_with(b"\xff\xd8\xff") {
        jpeg_codes(bytes, most)
    } else {
        Err("it is neither a PNG nor a JPEG".into())
    }
}

fn check_pixels(width: u64, height: u64, most: u64) -> Result<(), String> {
    // both fit 32 bits
    if width * height > most {
        return Err(format!(
            "its {width} x {height} pixels are more than the {most} that are left for it: make it smaller"
        ));
    }
    Ok(())
}

fn one_line(why: impl ToString) -> String {
    crate::escaped(&why.to_string().lines().collect::<Vec<_>>().join(", "))
}

fn png_codes(bytes: &[u8], most: u64) -> Result<Codes, String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info().map_err(one_line)?;
    let (width, height) = (header.width, header.height);
    check_pixels(width.into(), height.into(), most)?;
    let mut reader = decoder.read_info().map_err(one_line)?;
    let (kind, depth) = reader.output_color_type();
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut bytes = vec![0; size];
    reader.next_frame(&mut bytes).map_err(one_line)?;
    let is_16_bit = depth == png::BitDepth::Sixteen;
    Ok(Codes { size: (width, height), bytes, channels: kind.samples(), is_16_bit })
}

fn jpeg_codes(bytes: &[u8], most: u64) -> Result<Codes, String> {
    let options = DecoderOptions::new_safe().jpeg_set_max_scans(MOST_SCANS);
    let options = options.set_max_width(u16::MAX.into()).set_max_height(u16::MAX.into());
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(one_line)?;
    let info = decoder.info().ok_or("it has no header")?;
    check_pixels(info.width.into(), info.height.into(), most)?;
    let bytes = decoder.decode().map_err(one_line)?;
    let channels = decoder.output_colorspace().ok_or("it has no colours")?.num_components();
    Ok(Codes { size: (info.width.into(), info.height.into()), bytes, channels, is_16_bit: false })
}
