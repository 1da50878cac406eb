//! Small pictures for the page: each technique beside the truth, and where it is wrong, with the colours' scale.

use crate::BenchError;
use crate::line::{USUAL, title};
use crate::plan::Part;
use crate::references::Truth;
use compare::{ColourScale, ErrorMetric, Tick};
use film::{DisplayTransform, Image};
use image_file::{Records, encode_rgba8};
use pathtrace::Integrator;
use raster::{Fake, Raster};
use technique::{Accumulation, FakeSettings, Renderer, Technique, TreeSettings};

/// One technique beside the truth.
pub struct PicturePair {
    /// The technique, for people.
    pub title: String,
    /// Its picture, PNG.
    pub picture: Vec<u8>,
    /// The truth, PNG.
    pub truth: Vec<u8>,
    /// Picture minus truth, PNG.
    pub map: Vec<u8>,
    /// The map's colours from its low end to its high one, PNG.
    pub bar: Vec<u8>,
    /// Marks along the bar.
    pub ticks: Vec<Tick>,
    /// What the map shows.
    pub label: &'static str,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

const BAR: (u32, u32) = (256, 12);

/// Samples per pixel of what has noise: few, so that it is seen.
const PATH_SPP: u32 = 16;

/// The fakes, where something can draw them, Whitted's picture, a path-traced one and those by other light transport.
///
/// # Errors
/// [`BenchError::Memory`], [`BenchError::File`] if a picture cannot be encoded.
pub fn of(
    part: &Part,
    renderer: &mut Renderer,
    raster: Option<&mut Raster>,
    truth: &Truth,
) -> Result<Vec<PicturePair>, BenchError> {
    let (mut pairs, scene) = (Vec::new(), renderer.scene().clone());
    if let Some(raster) = raster {
        for fake in [Fake::AsTaught, Fake::Fair] {
            let settings = FakeSettings { fake, ..FakeSettings::default() };
            // a device that fails was told of where the fake was measured
            if let Ok(film) = raster.render(&scene, &scene.camera, &settings.sized(part.width, part.height)) {
                pairs.push(pair(title(&Technique::Fake(settings)), &film.image(), truth)?);
            }
        }
    }
    let TreeSettings { tree, spp, .. } = TreeSettings::default();
    let whitted = traced(part, renderer, &tree.into(), spp)?;
    pairs.push(pair(format!("Whitted, {spp} samples per pixel"), &whitted, truth)?);
    if let Technique::Traced(usual) = USUAL {
        let paths = traced(part, renderer, &usual.integrator, PATH_SPP)?;
        pairs.push(pair(format!("paths, {}, {PATH_SPP} samples per pixel", title(&USUAL)), &paths, truth)?);
    }
    for technique in part.other_transport(&scene) {
        let Technique::Traced(settings) = technique else { continue };
        let other = traced(part, renderer, &settings.integrator, PATH_SPP)?;
        pairs.push(pair(format!("{}, {PATH_SPP} samples per pixel", title(&technique)), &other, truth)?);
    }
    Ok(pairs)
}

fn traced(part: &Part, renderer: &mut Renderer, integrator: &Integrator, spp: u32) -> Result<Image, BenchError> {
    let (size, camera) = ((part.width, part.height), renderer.scene().camera);
    let mut accumulation = Accumulation::blank(size).ok_or(BenchError::Memory(size.0, size.1))?;
    renderer.add(&mut accumulation, &camera, integrator, spp, &|| false)?;
    Ok(accumulation.film().image())
}

fn pair(title: String, image: &Image, truth: &Truth) -> Result<PicturePair, BenchError> {
    let display = DisplayTransform::default();
    let (width, height) = image.size();
    let png = |rgba: &[u8], (width, height)| encode_rgba8(width, height, rgba, &Records::new());
    let values = ErrorMetric::Signed.of(image, &truth.reference.image, &display)?;
    let scale = ColourScale::fitted(ErrorMetric::Signed, &values);
    Ok(PicturePair {
        title,
        picture: png(&display.rgba8_of(image), (width, height))?,
        truth: png(&display.rgba8_of(&truth.reference.image), (width, height))?,
        map: png(&scale.image(&values, width), (width, height))?,
        bar: png(&scale.bar(BAR.0, BAR.1), BAR)?,
        ticks: scale.ticks(6),
        label: scale.label,
        size: (width, height),
    })
}

/// The address of a file of this media type within the page: RFC 2397, with the base 64 of RFC 4648.
pub fn data_uri(media_type: &str, bytes: &[u8]) -> String {
    format!("data:{media_type};base64,{}", base64(bytes))
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = three.iter().enumerate().fold(0, |bits, (i, byte)| bits | u32::from(*byte) << (16 - 8 * i));
        for digit in 0..4 {
            // n bytes fill n + 1 digits
            let filled = digit <= three.len();
            let index = (bits >> (18 - 6 * digit)) & 63;
            text.push(if filled { char::from(DIGITS[index as usize]) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_64_is_that_of_the_rfcs_examples() {
        let examples =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("fooba", "Zm9vYmE=")];
        assert!(examples.iter().all(|(plain, coded)| base64(plain.as_bytes()) == *coded));
        assert_eq!(base64(&[255, 255, 254]), "///+");
    }
}
