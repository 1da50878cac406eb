//! What a user may choose about the fake.

use crate::knobs::FakeKnobs;
use crate::lights;
use crate::repair::{Repair, Repairs};
use film::Feature;
use scene::Scene;

/// Segments of spheres whose tessellation is repaired.
pub(crate) const REPAIRED_SEGMENTS: u32 = 160;

/// Size and manner of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RasterSettings {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Which of the two fakes.
    pub fake: Fake,
    /// Which local illumination model.
    pub shading: Shading,
    /// Numbers in place of the scene's.
    pub knobs: FakeKnobs,
    /// What is repaired of the fair fake; nothing is as taught.
    pub repairs: Repairs,
    /// What is shown: the picture, what of surfaces it is made from, or a map.
    pub show: Show,
}

impl RasterSettings {
    /// A picture of this size by the default fake and shading, with the scene's numbers.
    pub fn new(width: u32, height: u32) -> Self {
        RasterSettings {
            width,
            height,
            fake: Fake::default(),
            shading: Shading::default(),
            knobs: FakeKnobs::default(),
            repairs: Repairs::NONE,
            show: Show::default(),
        }
    }

    /// The scene with the numbers of knobs and repairs in place of its own.
    pub(crate) fn applied(&self, scene: &Scene) -> Scene {
        let mut scene = self.knobs.applied(scene);
        if self.repairs().has(Repair::Antialiasing) {
            scene.fake.segments = scene.fake.segments.max(REPAIRED_SEGMENTS);
        }
        scene
    }

    /// What is repaired of this fake.
    pub(crate) fn repairs(&self) -> Repairs {
        if self.fake == Fake::Fair { self.repairs } else { Repairs::NONE }
    }
}

/// What a film of the fake holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Show {
    /// The scene.
    #[default]
    Picture,
    /// The cube map of the scene's first glass, unfolded to a cross that is seen from inside: -z in the middle, -x, +x
    /// and +z beside it, +y above and -y below. What the texels hold, each as a square: radiance; as taught, the light
    /// of its bytes.
    CubeFaces,
    /// What the shadow map keeps, of the sun or else of the area light as a cross: grey from white (nearest to the
    /// light) to [`crate::maps::DARKEST`] (farthest), even steps of display brightness; black where nothing was drawn.
    ShadowMap,
    /// What [`crate::Raster::features`] gives of the scene, as [`film::Features::fill`] shows it.
    Feature(Feature),
}

impl Show {
    /// All of them, the default first.
    pub const ALL: [Show; 6] = [
        Show::Picture,
        Show::Feature(Feature::Albedo),
        Show::Feature(Feature::Normal),
        Show::Feature(Feature::Depth),
        Show::CubeFaces,
        Show::ShadowMap,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Show::Picture => "picture",
            Show::CubeFaces => "cube-faces",
            Show::ShadowMap => "shadow-map",
            Show::Feature(feature) => feature.name(),
        }
    }

    /// What is shown under that name.
    pub fn named(name: &str) -> Option<Show> {
        Show::ALL.into_iter().find(|show| show.name() == name)
    }

    /// What of surfaces it shows, if not their light or a map.
    pub fn feature(self) -> Option<Feature> {
        if let Show::Feature(feature) = self { Some(feature) } else { None }
    }

    /// Whether it is a map, which the camera does not see.
    pub fn is_map(self) -> bool {
        matches!(self, Show::CubeFaces | Show::ShadowMap)
    }

    /// Whether `scene` has it: there are no cube maps without glass and no shadow map without sun and area light.
    pub fn available(self, scene: &Scene) -> bool {
        match self {
            Show::Picture | Show::Feature(_) => true,
            Show::CubeFaces => {
                scene.shapes.iter().any(|s| matches!(scene.material_of(s).bsdf, scene::Bsdf::Dielectric { .. }))
            }
            Show::ShadowMap => scene.sun.is_some() || lights::AreaLight::brightest(scene).is_some(),
        }
    }
}

/// The two fakes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Fake {
    /// The fake on the truth's data: linear and unclamped.
    #[default]
    Fair,
    /// The tutorial's viewer, number for number.
    AsTaught,
}

/// The local illumination models; see [`crate::shading`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shading {
    /// three.js' MeshPhong, which is a normalised Blinn-Phong with Fresnel; fair, on glTF's metallic-roughness as three.js'
    /// MeshStandard draws it, Cook and Torrance's.
    #[default]
    Three,
    /// The slides' Phong.
    Phong,
    /// The slides' Blinn-Phong.
    BlinnPhong,
    /// Cook and Torrance's, by glTF's terms, on every surface.
    CookTorrance,
}

impl Fake {
    /// All of them, the default first.
    pub const ALL: [Fake; 2] = [Fake::Fair, Fake::AsTaught];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Fake::Fair => "fair",
            Fake::AsTaught => "as-taught",
        }
    }

    /// The fake of that name.
    pub fn named(name: &str) -> Option<Fake> {
        Fake::ALL.into_iter().find(|fake| fake.name() == name)
    }
}

impl Shading {
    /// All of them, the default first.
    pub const ALL: [Shading; 4] = [Shading::Three, Shading::Phong, Shading::BlinnPhong, Shading::CookTorrance];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Shading::Three => "three",
            Shading::Phong => "phong",
            Shading::BlinnPhong => "blinn-phong",
            Shading::CookTorrance => "cook-torrance",
        }
    }

    /// The model of that name.
    pub fn named(name: &str) -> Option<Shading> {
        Shading::ALL.into_iter().find(|shading| shading.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        assert!(Fake::ALL.iter().all(|&fake| Fake::named(fake.name()) == Some(fake)));
        assert!(Shading::ALL.iter().all(|&shading| Shading::named(shading.name()) == Some(shading)));
        assert!(Show::ALL.iter().all(|&show| Show::named(show.name()) == Some(show)));
        assert_eq!(Fake::named("Fair"), None);
    }
}
