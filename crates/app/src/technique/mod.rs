//! A technique with its settings: what a pane of the viewer or one call of `visavis render` makes of a scene.

use pathtrace::{PathSettings, Roulette};
use raster::{Fake, RasterSettings, Shading};
use scene::Scene;

/// A way to turn a scene into a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Technique {
    /// The fake: rasterised on the GPU.
    Raster,
    /// The truth: path traced on the CPU.
    Path,
}

impl Technique {
    /// All, by name.
    pub const ALL: [Technique; 2] = [Technique::Raster, Technique::Path];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Technique::Raster => "raster",
            Technique::Path => "path",
        }
    }

    /// The technique of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|t| t.name() == name)
    }
}

/// The settings of the fake.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FakeSettings {
    /// Fair or as taught.
    pub fake: Fake,
    /// Whose highlight.
    pub shading: Shading,
}

impl FakeSettings {
    /// With a size, as the raster wants them.
    pub fn sized(&self, width: u32, height: u32) -> RasterSettings {
        RasterSettings { width, height, fake: self.fake, shading: self.shading }
    }

    /// For a pane's label: "fake (raster, fair)".
    pub fn label(&self) -> String {
        format!("fake (raster, {})", self.fake.name())
    }
}

/// The settings of the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TruthSettings {
    /// How paths walk.
    pub path: PathSettings,
    /// Samples per pixel at which rendering stops.
    pub spp: u32,
}

impl Default for TruthSettings {
    fn default() -> Self {
        TruthSettings { path: PathSettings::default(), spp: 256 }
    }
}

impl TruthSettings {
    /// For a pane's label: "truth (path, light)".
    pub fn label(&self) -> String {
        format!("truth (path, {})", self.path.estimator.name())
    }

    /// What these settings cannot see in this scene, to be said rather than hidden.
    pub fn blind_spot(&self, scene: &Scene) -> Option<&'static str> {
        let delta_sun = scene.sun.is_some_and(|sun| sun.angular_radius == 0.0);
        let by_chance = self.path.estimator != pathtrace::Estimator::Light;
        match (delta_sun, by_chance) {
            (true, true) => Some("a sun of radius 0 cannot be hit by chance: its light is missing"),
            (true, false) if scene.needs().dielectric || scene.needs().mirror => {
                Some("a sun of radius 0 casts no caustic: no path can find it behind glass or mirror")
            }
            _ => None,
        }
    }
}

/// "off", "throughput" or the probability.
pub fn roulette_name(roulette: Roulette) -> String {
    match roulette {
        Roulette::Off => "off".into(),
        Roulette::Throughput => "throughput".into(),
        Roulette::Probability(p) => p.to_string(),
    }
}

/// "inf" or the number.
pub fn bounces_name(bounces: Option<u32>) -> String {
    bounces.map_or("inf".into(), |n| n.to_string())
}
