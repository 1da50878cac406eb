//! The settings of the fake.

use super::Records;
use raster::{Fake, RasterSettings, Shading};
use scene::Scene;

/// The settings of the fake.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FakeSettings {
    /// Fair or as taught.
    pub fake: Fake,
    /// Whose highlight.
    pub shading: Shading,
    /// Share of the surroundings in fake glass, in [0, 1]; the rest is white. `None`: the scene's.
    pub reflectivity: Option<f32>,
}

impl FakeSettings {
    /// The scene with the fake's own numbers changed.
    pub fn applied_to(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        if let Some(share) = self.reflectivity {
            scene.set_reflectivity(share);
        }
        scene
    }

    /// With a size, as the raster wants them.
    pub fn sized(&self, width: u32, height: u32) -> RasterSettings {
        RasterSettings { fake: self.fake, shading: self.shading, ..RasterSettings::new(width, height) }
    }

    /// For a pane's label: "fake (raster, fair)".
    pub fn label(&self) -> String {
        format!("fake (raster, {})", self.fake.name())
    }

    /// The options of `visavis render` that say the same; what is left to the scene is left out.
    pub fn options(&self) -> Records {
        let mut options = vec![("fake", self.fake.name().into()), ("shading", self.shading.name().into())];
        options.extend(self.reflectivity.map(|share| ("reflectivity", share.to_string())));
        options
    }

    /// Whether it shows the scene rather than one of its maps.
    pub fn shows_the_scene(&self) -> bool {
        true
    }
}
