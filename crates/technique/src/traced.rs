//! The settings of what is traced by rays: path tracing, and Whitted's step towards it.

use crate::DeviceChoice;
use pathtrace::{Integrator, NormalsSettings, PathSettings, Roulette, WhittedSettings};

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

/// The settings of path tracing, which without limits tends to the truth.
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
