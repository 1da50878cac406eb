//! What is seen of surfaces at each pixel, without any light: what denoisers are guided by ("auxiliary features").

use crate::colour::grey_of_depth;
use crate::{Film, Layer, LayerValues, Pixel, Vec3};
use std::sync::Arc;

/// What of a surface is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Feature {
    /// What share of light surfaces send back, [`Features::albedo`].
    Albedo,
    /// Which way surfaces face, [`Features::normal`].
    Normal,
    /// How far away they are, [`Features::depth`].
    Depth,
}

impl Feature {
    /// All of them, in the order of menus.
    pub const ALL: [Feature; 3] = [Feature::Albedo, Feature::Normal, Feature::Depth];

    /// The name on the command line, and of its layer in a file.
    pub fn name(self) -> &'static str {
        match self {
            Feature::Albedo => Features::ALBEDO,
            Feature::Normal => Features::NORMAL,
            Feature::Depth => Features::DEPTH,
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Feature> {
        Feature::ALL.into_iter().find(|feature| feature.name() == name)
    }
}

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
            Layer { name: Self::NORMAL, values: LayerValues::Directions(self.normal.clone()) },
            Layer { name: Self::DEPTH, values: LayerValues::Depths(self.depth.clone()) },
        ]
    }

    /// A film to look at one of them, as [`Features::fill`] shows it; `None` where there is no memory for it.
    pub fn film(&self, feature: Feature, samples: u32) -> Option<Film> {
        let mut film = Film::try_new(self.width, self.height)?;
        self.fill(&mut film, feature, samples);
        Some(film)
    }

    /// Makes a film of as many pixels one of them, of so many samples a pixel: albedo as light of its colour; normals as
    /// colours, -1 to 1 along each axis as 0 to 1, and black where nothing is met; depths as [`grey_of_depth`] between the
    /// nearest and the farthest one.
    pub fn fill(&self, film: &mut Film, feature: Feature, samples: u32) {
        let range = self.range_of_depths();
        for (index, pixel) in film.pixels_mut().iter_mut().enumerate() {
            let depth = self.depth[index];
            let colour = match feature {
                Feature::Albedo => self.albedo[index],
                Feature::Normal if depth == f32::INFINITY => Vec3::ZERO,
                Feature::Normal => 0.5 * self.normal[index] + 0.5,
                Feature::Depth => Vec3::splat(grey_of_depth(depth, range)),
            };
            *pixel = Pixel::steady(colour, samples);
        }
    }

    /// The nearest and the farthest depth of what is met.
    fn range_of_depths(&self) -> [f32; 2] {
        let met = || self.depth.iter().copied().filter(|depth| depth.is_finite());
        [met().fold(f32::INFINITY, f32::min), met().fold(0.0, f32::max)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{DARKEST, srgb_encode};

    #[test]
    fn features_have_a_value_of_each_kind_for_each_pixel() {
        let of = |pixels| Features::new((2, 1), vec![Vec3::X; pixels], vec![Vec3::Z; 2], vec![1.0, f32::INFINITY]);
        assert!(of(2).is_some_and(|features| features.layers().len() == 3) && of(3).is_none());
    }

    #[test]
    fn features_are_looked_at_as_colours_and_depths_as_even_steps_of_grey() {
        let depth = vec![2.0, 3.0, 4.0, f32::INFINITY];
        let albedo = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE];
        let features = Features::new((4, 1), albedo.clone(), vec![-Vec3::Z, Vec3::Y, Vec3::ZERO, Vec3::ZERO], depth);
        let shown = |feature| {
            let film = features.as_ref().unwrap().film(feature, 3).unwrap();
            assert_eq!(film.samples_per_pixel(), 3);
            film.radiances().collect::<Vec<_>>()
        };
        assert_eq!(shown(Feature::Albedo), albedo);
        let half = Vec3::splat(0.5);
        let normals = [Vec3::new(0.5, 0.5, 0.0), Vec3::new(0.5, 1.0, 0.5), half, Vec3::ZERO];
        assert_eq!(shown(Feature::Normal), normals);
        let codes = shown(Feature::Depth).iter().map(|grey| srgb_encode(grey.x)).collect::<Vec<_>>();
        let darkest = srgb_encode(DARKEST);
        for (code, expected) in codes.iter().zip([1.0, 0.5 + 0.5 * darkest, darkest, 0.0]) {
            assert!((code - expected).abs() < 1e-5, "{codes:?}");
        }
    }
}
