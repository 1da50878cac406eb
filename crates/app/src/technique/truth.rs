//! The settings of the truth.

use pathtrace::{PathSettings, Roulette};
use scene::Scene;

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
        let by_chance = !self.path.estimator.samples_lights();
        match (delta_sun, by_chance) {
            (true, true) => Some("a sun of radius 0 cannot be hit by chance: its light is missing"),
            (true, false) if scene.needs().dielectric || scene.needs().mirror => {
                Some("a sun of radius 0 casts no caustic: no path can find it behind glass or mirror")
            }
            _ => None,
        }
    }
}

/// "off", "throughput", the probability, or "0.8+throughput".
pub fn roulette_name(roulette: Roulette) -> String {
    match (roulette.probability, roulette.throughput) {
        (None, false) => "off".into(),
        (None, true) => "throughput".into(),
        (Some(p), false) => p.to_string(),
        (Some(p), true) => format!("{p}+throughput"),
    }
}

/// "inf" or the number.
pub fn bounces_name(bounces: Option<u32>) -> String {
    bounces.map_or("inf".into(), |n| n.to_string())
}
