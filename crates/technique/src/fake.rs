//! The settings of the fake.

use raster::{Fake, FakeKnobs, RasterSettings, Repairs, Shading, Show};
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
    /// The other numbers that may be turned.
    pub knobs: FakeKnobs,
    /// What is repaired of the fair fake.
    pub repairs: Repairs,
    /// The picture, what is seen without its light, or one of the maps that it is made from.
    pub show: Show,
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

    /// Takes `scene`'s own numbers again, and looks at the picture where it has no such map.
    pub fn forget_the_scene(&mut self, scene: &Scene) {
        self.reflectivity = None;
        let FakeKnobs { filter, bias, refracted, textures, gather, .. } = self.knobs;
        self.knobs = FakeKnobs { filter, bias, refracted, textures, gather, ..FakeKnobs::default() };
        if !self.show.available(scene) {
            self.show = Show::Picture;
        }
    }

    /// With a size, as the raster wants them.
    pub fn sized(&self, width: u32, height: u32) -> RasterSettings {
        let &FakeSettings { fake, shading, knobs, repairs, show, .. } = self;
        RasterSettings { width, height, fake, shading, knobs, repairs, show }
    }

    /// Whether it shows the scene's light, rather than what it falls on or a map.
    pub fn shows_the_scene(&self) -> bool {
        self.show == Show::Picture
    }
}
