//! The settings of what is traced by rays: the truth, and Whitted's step towards it.

use crate::DeviceChoice;
use pathtrace::{
    Estimator, GlassShadows, Integrator, LightSampling, NormalsSettings, PathSettings, Roulette, WhittedSettings,
};
use scene::Scene;

/// An integrator, where and how long it goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracedSettings {
    /// How light is followed, with its settings.
    pub integrator: Integrator,
    /// The wish for a device; what traces in the end is in [`crate::Provenance`].
    pub device: DeviceChoice,
    /// By which of the adapters, where by one: the best is 0.
    pub adapter: u8,
    /// Samples per pixel at which rendering stops.
    pub spp: u32,
}

/// The settings of the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TruthSettings {
    /// How paths walk.
    pub path: PathSettings,
    /// Samples per pixel at which rendering stops.
    pub spp: u32,
}

/// The settings of a picture by Whitted's method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TreeSettings {
    /// How trees of rays grow.
    pub tree: WhittedSettings,
    /// Samples per pixel at which rendering stops.
    pub spp: u32,
}

/// The settings of a picture of normals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalsPaneSettings {
    /// How they are shown.
    pub normals: NormalsSettings,
    /// Samples per pixel at which rendering stops.
    pub spp: u32,
}

impl Default for NormalsPaneSettings {
    /// Few samples: only edges need them.
    fn default() -> Self {
        NormalsPaneSettings { normals: NormalsSettings::default(), spp: 16 }
    }
}

impl From<NormalsPaneSettings> for TracedSettings {
    fn from(NormalsPaneSettings { normals, spp }: NormalsPaneSettings) -> Self {
        TracedSettings { integrator: normals.into(), device: DeviceChoice::default(), adapter: 0, spp }
    }
}

impl Default for TruthSettings {
    fn default() -> Self {
        TruthSettings { path: PathSettings::default(), spp: 256 }
    }
}

impl Default for TreeSettings {
    /// Few samples: only edges and soft shadows need them.
    fn default() -> Self {
        TreeSettings { tree: WhittedSettings::default(), spp: 16 }
    }
}

impl From<TruthSettings> for TracedSettings {
    fn from(TruthSettings { path, spp }: TruthSettings) -> Self {
        TracedSettings { integrator: path.into(), device: DeviceChoice::default(), adapter: 0, spp }
    }
}

impl From<TreeSettings> for TracedSettings {
    fn from(TreeSettings { tree, spp }: TreeSettings) -> Self {
        TracedSettings { integrator: tree.into(), device: DeviceChoice::default(), adapter: 0, spp }
    }
}

impl TracedSettings {
    /// For a pane's label: "truth (path, light)", "Whitted (depth 8)".
    pub fn label(&self) -> String {
        match self.integrator {
            Integrator::Path(path) => format!("truth (path, {})", path.estimator.name()),
            Integrator::Whitted(tree) => format!("Whitted (depth {})", tree.depth),
            Integrator::Normals(normals) => format!("normals ({})", normals.space.name()),
        }
    }

    /// What these settings cannot see in this scene, to be said rather than hidden.
    pub fn blind_spot(&self, scene: &Scene) -> Option<&'static str> {
        let delta_sun = scene.sun.is_some_and(|sun| sun.angular_radius == 0.0);
        let specular = scene.needs().dielectric || scene.needs().mirror;
        match self.integrator {
            Integrator::Whitted(tree) if specular && tree.glass_shadows == GlassShadows::Clear => {
                Some("light passes glass straight on: no caustic; mirrors send none on")
            }
            Integrator::Whitted(_) => Some("light from one surface on another is missing: ambient light stands for it"),
            Integrator::Path(path) if path.estimator.light == LightSampling::BsdfOnly => {
                let points = !scene.point_lights.is_empty();
                match (delta_sun, points) {
                    (true, _) => Some("a sun of radius 0 cannot be hit by chance: its light is missing"),
                    (false, true) => Some("a point light cannot be hit by chance: its light is missing"),
                    (false, false) => None,
                }
            }
            Integrator::Path(_) if specular && delta_sun => {
                Some("a sun of radius 0 casts no caustic: no path can find it behind glass or mirror")
            }
            Integrator::Path(_) if specular && !scene.point_lights.is_empty() => {
                Some("a point light casts no caustic: no path can find it behind glass or mirror")
            }
            Integrator::Path(path) if scene.needs().rough_conductor && path.estimator != Estimator::MIS => {
                Some("smooth rough metal is noise without mis: light in a narrow reflection is hardly ever found")
            }
            Integrator::Path(_) | Integrator::Normals(_) => None,
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
