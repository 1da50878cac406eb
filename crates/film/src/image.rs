//! A picture in linear radiance that threads can share: what a film is shown, written and measured as.

use crate::{Film, Vec3};
use std::sync::Arc;

/// Linear radiance in rows from the top, and further values of the same pixels. Clones share the pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    radiances: Arc<[Vec3]>,
    /// What else is known of each pixel, by name: "standard error".
    pub layers: Vec<Layer>,
}

/// Values of every pixel of a picture, under a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// The name in a file of several layers.
    pub name: &'static str,
    /// As many as the picture has pixels.
    pub values: LayerValues,
}

/// Rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub enum LayerValues {
    /// Red, green and blue.
    Rgb(Arc<[Vec3]>),
    /// Along x, y and z.
    Directions(Arc<[Vec3]>),
    /// One number a pixel.
    Numbers(Arc<[f32]>),
    /// One distance from the camera a pixel; infinite where nothing is.
    Depths(Arc<[f32]>),
}

impl LayerValues {
    fn len(&self) -> usize {
        match self {
            LayerValues::Rgb(values) | LayerValues::Directions(values) => values.len(),
            LayerValues::Numbers(values) | LayerValues::Depths(values) => values.len(),
        }
    }
}

impl Image {
    /// A picture of `width` x `height` pixels, rows from the top; `None` if their number is another.
    pub fn new(width: u32, height: u32, radiances: impl Into<Arc<[Vec3]>>) -> Option<Self> {
        let radiances = radiances.into();
        let fits = radiances.len() as u64 == u64::from(width) * u64::from(height);
        fits.then_some(Image { width, height, radiances, layers: Vec::new() })
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// What `f` makes of each pixel, without layers.
    pub fn map(&self, f: impl FnMut(Vec3) -> Vec3) -> Self {
        Image { radiances: self.radiances.iter().copied().map(f).collect(), layers: Vec::new(), ..*self }
    }

    /// Linear radiance of each pixel, rows from the top.
    pub fn radiances(&self) -> &[Vec3] {
        &self.radiances
    }

    /// Radiance of the pixel at column `x`, row `y` from the top left; `None` outside.
    pub fn at(&self, x: u32, y: u32) -> Option<Vec3> {
        let inside = x < self.width && y < self.height;
        inside.then(|| self.radiances[(y * self.width + x) as usize])
    }

    /// The radiance as a layer, which shares it.
    pub fn as_layer(&self, name: &'static str) -> Layer {
        Layer { name, values: LayerValues::Rgb(self.radiances.clone()) }
    }

    /// The colours or directions of the layer of this name; `None` if there is none, or if it has one number a pixel.
    pub fn rgb_layer(&self, name: &str) -> Option<&[Vec3]> {
        let layer = self.layers.iter().find(|layer| layer.name == name)?;
        match &layer.values {
            LayerValues::Rgb(values) | LayerValues::Directions(values) => Some(values),
            LayerValues::Numbers(_) | LayerValues::Depths(_) => None,
        }
    }

    /// The same picture with another layer, which has a value for each pixel.
    pub fn with_layer(mut self, name: &'static str, values: LayerValues) -> Self {
        debug_assert_eq!(values.len(), self.radiances.len());
        self.layers.push(Layer { name, values });
        self
    }
}

impl Film {
    /// The mean of each pixel.
    pub fn image(&self) -> Image {
        Image { width: self.width(), height: self.height(), radiances: self.radiances().collect(), layers: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_has_as_many_pixels_as_it_says() {
        assert!(Image::new(2, 2, vec![Vec3::ZERO; 3]).is_none());
        let image = Image::new(2, 1, vec![Vec3::ZERO, Vec3::ONE]).unwrap();
        assert_eq!((image.at(1, 0), image.at(2, 0), image.at(0, 1)), (Some(Vec3::ONE), None, None));
    }

    #[test]
    fn a_mapped_picture_has_the_same_size() {
        let image = Image::new(1, 2, vec![Vec3::ZERO, Vec3::ONE]).unwrap();
        assert_eq!(Image::new(1, 2, vec![Vec3::ONE, Vec3::splat(3.0)]), Some(image.map(|v| 2.0 * v + Vec3::ONE)));
    }

    #[test]
    fn a_layer_is_found_by_its_name() {
        let image = Image::new(1, 1, vec![Vec3::ONE]).unwrap().with_layer("depth", LayerValues::Numbers([2.0].into()));
        let image = image.with_layer("albedo", LayerValues::Rgb([Vec3::ZERO].into()));
        assert_eq!((image.rgb_layer("albedo"), image.rgb_layer("depth")), (Some(&[Vec3::ZERO][..]), None));
    }
}
