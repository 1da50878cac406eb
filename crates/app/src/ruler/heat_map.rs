//! Errors pixel by pixel in colour: computed, scaled, and as files. PNG for people, with the colour bar below; EXR for
//! other programs, with both pictures and every map as layers of numbers.

use super::Noise;
use compare::{ColourScale, CompareError, ErrorMetric, WITHIN_NOISE, finite_mean, within_noise};
use film::{DisplayTransform, Image, Layer, LayerValues};
use image_file::{ImageFileError, Kind, Records};
use std::borrow::Cow;

/// Two pictures of one size; the first is judged by the second.
#[derive(Debug, Clone)]
pub struct Pair {
    /// What they are called: "A" and "reference".
    pub names: [&'static str; 2],
    /// In linear radiance.
    pub images: [Image; 2],
    /// What is known of the noise of each.
    pub noise: [Noise; 2],
    /// How FLIP sees them.
    pub display: DisplayTransform,
}

impl Pair {
    fn values(&self, map: ErrorMetric) -> Result<Vec<f32>, CompareError> {
        map.of(&self.images[0], &self.images[1], &self.display)
    }

    /// Which pixels differ by no more than both pictures' noise; `None` where neither has any, or that of one is not known.
    fn within_noise(&self) -> Result<Option<Vec<bool>>, CompareError> {
        let [image, reference] = &self.images;
        let [of_image, of_reference] = &self.noise;
        let (Some(a), Some(r)) = (of_image.variances(image)?, of_reference.variances(reference)?) else {
            return Ok(None);
        };
        let noisy = a.is_some() || r.is_some();
        noisy.then(|| within_noise(image, reference, [a.as_deref(), r.as_deref()])).transpose()
    }
}

/// A map of errors under a scale.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// What is mapped.
    pub map: ErrorMetric,
    /// With its sign, by the pictures' names: "A - B".
    pub label: String,
    /// Its colours.
    pub scale: ColourScale,
    /// Pixels in a row.
    pub width: u32,
    /// One number a pixel, rows from the top.
    pub values: Vec<f32>,
    /// Mean of those that are finite.
    pub mean: f64,
    /// How many are not.
    pub nonfinite: u64,
    /// Which pixels may be noise alone, where that is known; FLIP, which sees neighbours together, does not tell.
    pub within_noise: Option<Vec<bool>>,
}

/// What grey pixels are, for legends and files.
pub const GREY: &str = "within 2 standard errors";

/// Height of the colour bar under a PNG, in pixels.
pub const BAR: u32 = 12;

impl HeatMap {
    /// The map of a pair, under a scale up to `held`, or fitted to what of it is not noise.
    ///
    /// # Errors
    /// If the pictures do not have the same pixels.
    pub fn of(pair: &Pair, map: ErrorMetric, held: Option<f32>) -> Result<Self, CompareError> {
        let values = pair.values(map)?;
        let (mean, nonfinite) = finite_mean(&values);
        let within_noise = if map == ErrorMetric::Flip { None } else { pair.within_noise()? };
        let fitted = || ColourScale::fitted(map, &beyond_noise(&values, within_noise.as_deref()));
        let scale = held.map_or_else(fitted, |high| ColourScale::up_to(map, high));
        let label = map.label_of(pair.names[0], pair.names[1]);
        Ok(HeatMap { map, label, scale, width: pair.images[0].width(), values, mean, nonfinite, within_noise })
    }

    /// Pixels in a column.
    pub fn height(&self) -> u32 {
        (self.values.len() / self.width.max(1) as usize) as u32
    }

    /// The map alone as opaque RGBA bytes, rows from the top.
    pub fn rgba(&self) -> Vec<u8> {
        let mut rgba = self.scale.image(&self.values, self.width);
        let within = self.within_noise.iter().flatten();
        for (pixel, _) in rgba.chunks_exact_mut(4).zip(within).filter(|(_, within)| **within) {
            pixel[..3].copy_from_slice(&WITHIN_NOISE);
        }
        rgba
    }

    /// The map with its colour bar below, low at the left, as width, height and opaque RGBA bytes.
    pub fn with_bar(&self) -> (u32, u32, Vec<u8>) {
        let mut rgba = self.rgba();
        rgba.extend(self.scale.bar(self.width, BAR));
        (self.width, self.height() + BAR, rgba)
    }

    /// What its file keeps: what is mapped, and what the colours mean.
    pub fn records(&self) -> Records {
        let mut records = vec![
            ("map", self.label.clone()),
            ("colours", self.scale.map.name().to_owned()),
            ("low", self.scale.low.to_string()),
            ("high", self.scale.high.to_string()),
            ("nonfinite", self.nonfinite.to_string()),
        ];
        records.extend(self.within_noise.as_ref().map(|_| ("grey", GREY.to_owned())));
        records
    }

    /// The bytes of a file of this kind; `more` records stand beside the map's own. `pair` is what the map is of.
    ///
    /// # Errors
    /// If it cannot be encoded.
    pub fn encode(&self, kind: Kind, pair: &Pair, more: Records) -> Result<Vec<u8>, ImageFileError> {
        let records: Records = self.records().into_iter().chain(more).collect();
        match kind {
            Kind::Png => {
                let (width, height, rgba) = self.with_bar();
                image_file::encode_rgba8(width, height, &rgba, &records)
            }
            Kind::Exr => {
                let mut layers: Vec<Layer> =
                    pair.images.iter().zip(pair.names).map(|(image, name)| image.as_layer(name)).collect();
                for map in ErrorMetric::ALL {
                    let values = if map == self.map { self.values.clone() } else { values_of(pair, map)? };
                    layers.push(Layer { name: map.name(), values: LayerValues::Numbers(values.into()) });
                }
                image_file::encode_layers((self.width, self.height()), &layers, &records)
            }
        }
    }
}

/// The values that are not noise; all where nothing is known of it.
fn beyond_noise<'a>(values: &'a [f32], within_noise: Option<&[bool]>) -> Cow<'a, [f32]> {
    let Some(within) = within_noise else { return values.into() };
    values.iter().zip(within).filter(|(_, within)| !**within).map(|(value, _)| *value).collect()
}

fn values_of(pair: &Pair, map: ErrorMetric) -> Result<Vec<f32>, ImageFileError> {
    pair.values(map).map_err(|e| ImageFileError::Encode("EXR", e.to_string()))
}
