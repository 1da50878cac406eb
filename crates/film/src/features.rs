//! What is seen of surfaces at each pixel, without any light: what denoisers are guided by ("auxiliary features").

use crate::{Image, Layer, LayerValues, Vec3};
use std::sync::Arc;

/// Means over each pixel of a picture, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Features {
    width: u32,
    height: u32,
    /// Albedo of the first surface that is not specular, in [0, 1]; where there is none, what shines there, at most 1.
    pub albedo: Arc<[Vec3]>,
    /// Normal of that surface in the scene's axes, on the camera's side, at most of length 1; null where there is none.
    pub normal: Arc<[Vec3]>,
    /// Distance from the camera to the first surface of any kind, in the scene's unit; infinite where there is none.
    pub depth: Arc<[f32]>,
}

impl Features {
    /// The name of the albedo's layer.
    pub const ALBEDO: &str = "albedo";
    /// The name of the normals' layer.
    pub const NORMAL: &str = "normal";
    /// The name of the depths' layer.
    pub const DEPTH: &str = "depth";

    /// Of `width` x `height` pixels each; `None` if any of them has another number.
    pub fn new(
        (width, height): (u32, u32),
        albedo: impl Into<Arc<[Vec3]>>,
        normal: impl Into<Arc<[Vec3]>>,
        depth: impl Into<Arc<[f32]>>,
    ) -> Option<Self> {
        let (albedo, normal, depth) = (albedo.into(), normal.into(), depth.into());
        let pixels = u64::from(width) * u64::from(height);
        let fit = [albedo.len(), normal.len(), depth.len()].into_iter().all(|length| length as u64 == pixels);
        fit.then_some(Features { width, height, albedo, normal, depth })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Layers of a picture's file, which share the pixels.
    pub fn layers(&self) -> [Layer; 3] {
        [
            Layer { name: Self::ALBEDO, values: LayerValues::Rgb(self.albedo.clone()) },
            Layer { name: Self::NORMAL, values: LayerValues::Rgb(self.normal.clone()) },
            Layer { name: Self::DEPTH, values: LayerValues::Numbers(self.depth.clone()) },
        ]
    }

    /// Those that a picture has as layers; `None` if it lacks any.
    pub fn of(image: &Image) -> Option<Self> {
        let colours = |name| Some(Arc::from(image.rgb_layer(name)?));
        let depth: Arc<[f32]> = image.number_layer(Self::DEPTH)?.into();
        Features::new(image.size(), colours(Self::ALBEDO)?, colours(Self::NORMAL)?, depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_come_back_from_a_pictures_layers() {
        let features = Features::new((2, 1), vec![Vec3::X, Vec3::Y], vec![Vec3::Z; 2], vec![1.0, f32::INFINITY]);
        let features = features.unwrap();
        let mut image = Image::new(2, 1, vec![Vec3::ONE; 2]).unwrap();
        assert_eq!(Features::of(&image), None);
        image.layers.extend(features.layers());
        assert_eq!(Features::of(&image), Some(features));
        assert_eq!(Features::new((2, 2), vec![Vec3::X; 4], vec![Vec3::X; 4], vec![0.0; 3]), None);
    }
}
