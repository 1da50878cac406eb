//! The settings of what is traced by rays: path tracing, and Whitted's step towards it.

use crate::{DenoiseSettings, DeviceChoice};
use film::Feature;
use pathtrace::{
    Bug, Bugs, Integrator, LightTracingSettings, MetropolisSettings, NormalsSettings, PathSettings, PhotonSettings,
    Roulette, WhittedSettings,
};
use scene::{Scene, Sun};
use std::sync::Arc;

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
    /// Pictures of so many samples each, of one seed after the other, whose mean is shown.
    pub runs: u32,
    /// Angular radius of the sun for these rays alone, in degrees; `None`: the scene's. References know nothing of it.
    pub sun_radius: Option<f32>,
    /// What the picture goes through before it is shown.
    pub denoise: DenoiseSettings,
    /// What of the surfaces that rays come to is shown, in place of their light.
    pub feature: Option<Feature>,
}

impl TracedSettings {
    /// An integrator that stops at so many samples per pixel, where the device is not chosen and the sun the scene's.
    pub const fn new(integrator: Integrator, spp: u32) -> Self {
        let (device, denoise) = (DeviceChoice::Auto, DenoiseSettings::OFF);
        TracedSettings { integrator, device, adapter: 0, spp, runs: 1, sun_radius: None, denoise, feature: None }
    }
}

/// The settings of path tracing, which without limits tends to the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TruthSettings {
    /// How paths walk.
    pub path: PathSettings,
    /// Samples per pixel at which rendering stops.
    pub spp: u32,
    /// The sun for these paths alone, as in [`TracedSettings`].
    pub sun_radius: Option<f32>,
}

/// The settings of a picture by Whitted's method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TreeSettings {
    /// How trees of rays grow.
    pub tree: WhittedSettings,
    /// Samples per pixel at which rendering stops.
    pub spp: u32,
    /// The sun for these trees alone, as in [`TracedSettings`].
    pub sun_radius: Option<f32>,
}

/// The settings of a picture by photon mapping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhotonPaneSettings {
    /// How photons are traced and gathered.
    pub photon: PhotonSettings,
    /// Samples per pixel, which are passes, at which rendering stops.
    pub spp: u32,
    /// The sun for these photons alone, as in [`TracedSettings`].
    pub sun_radius: Option<f32>,
}

/// The settings of a picture by light tracing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightPaneSettings {
    /// How photons are traced.
    pub light: LightTracingSettings,
    /// Samples per pixel, which are passes, at which rendering stops.
    pub spp: u32,
    /// The sun for these photons alone, as in [`TracedSettings`].
    pub sun_radius: Option<f32>,
}

/// The settings of a picture by Metropolis' chains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainSettings {
    /// How chains walk, and how many there are.
    pub metropolis: MetropolisSettings,
    /// Runs at which rendering stops, each a sample of every pixel.
    pub spp: u32,
    /// The sun for these paths alone, as in [`TracedSettings`].
    pub sun_radius: Option<f32>,
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
        TracedSettings::new(normals.into(), spp)
    }
}

impl Default for TruthSettings {
    fn default() -> Self {
        TruthSettings { path: PathSettings::default(), spp: 256, sun_radius: None }
    }
}

impl Default for ChainSettings {
    fn default() -> Self {
        ChainSettings { metropolis: MetropolisSettings::default(), spp: 256, sun_radius: None }
    }
}

impl Default for TreeSettings {
    /// Few samples: only edges and soft shadows need them.
    fn default() -> Self {
        TreeSettings { tree: WhittedSettings::default(), spp: 16, sun_radius: None }
    }
}

impl Default for PhotonPaneSettings {
    fn default() -> Self {
        PhotonPaneSettings { photon: PhotonSettings::default(), spp: 256, sun_radius: None }
    }
}

impl Default for LightPaneSettings {
    fn default() -> Self {
        LightPaneSettings { light: LightTracingSettings::default(), spp: 256, sun_radius: None }
    }
}

impl From<PhotonPaneSettings> for TracedSettings {
    fn from(PhotonPaneSettings { photon, spp, sun_radius }: PhotonPaneSettings) -> Self {
        TracedSettings { sun_radius, ..TracedSettings::new(photon.into(), spp) }
    }
}

impl From<LightPaneSettings> for TracedSettings {
    fn from(LightPaneSettings { light, spp, sun_radius }: LightPaneSettings) -> Self {
        TracedSettings { sun_radius, ..TracedSettings::new(light.into(), spp) }
    }
}

impl From<TruthSettings> for TracedSettings {
    fn from(TruthSettings { path, spp, sun_radius }: TruthSettings) -> Self {
        TracedSettings { sun_radius, ..TracedSettings::new(path.into(), spp) }
    }
}

impl From<ChainSettings> for TracedSettings {
    fn from(ChainSettings { metropolis, spp, sun_radius }: ChainSettings) -> Self {
        TracedSettings { sun_radius, ..TracedSettings::new(metropolis.into(), spp) }
    }
}

impl From<TreeSettings> for TracedSettings {
    fn from(TreeSettings { tree, spp, sun_radius }: TreeSettings) -> Self {
        TracedSettings { sun_radius, ..TracedSettings::new(tree.into(), spp) }
    }
}

impl TracedSettings {
    /// The scene as these rays see it: the same one if its own sun is as wide.
    pub fn applied_to(&self, scene: &Arc<Scene>) -> Arc<Scene> {
        let own = scene.sun.map(|sun| sun.angular_radius);
        if self.sun_radius.is_none() || own.is_none() || self.sun_radius == own {
            return scene.clone();
        }
        let sun = scene.sun.map(|sun| Sun { angular_radius: self.sun_radius.unwrap_or(sun.angular_radius), ..sun });
        Arc::new(Scene { sun, ..(**scene).clone() })
    }

    /// The wish for a device, of what one can trace; else the processor.
    pub fn device_choice(&self) -> DeviceChoice {
        if self.needs_the_processor().is_some() { DeviceChoice::Cpu } else { self.device }
    }

    /// Why no graphics device can trace it, as a line for the user; `None` if one can.
    pub fn needs_the_processor(&self) -> Option<&'static str> {
        match self.feature {
            Some(_) => None,
            None => self.integrator.needs_the_processor(),
        }
    }

    /// The bug that is on in this scene and not told, where there is one.
    pub fn hidden_bug(&self, scene: &Arc<Scene>) -> Option<Bug> {
        let Integrator::Path(path) = self.integrator else { return None };
        path.hidden_bug(Bugs::suited_to(&self.applied_to(scene)))
    }

    /// Whether these rays see a sun without a disc.
    pub(crate) fn sees_a_delta_sun(&self, scene: &Scene) -> bool {
        scene.sun.is_some_and(|sun| self.sun_radius.unwrap_or(sun.angular_radius) == 0.0)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlindSpot, PaneSettings, Technique, TechniqueName};

    #[test]
    fn a_sun_of_their_own_is_seen_by_these_rays_and_kept_in_records() {
        let scene = Arc::new(scene::builtin::named("whitted").unwrap());
        let own = TracedSettings::from(TreeSettings::default());
        assert!(Arc::ptr_eq(&own.applied_to(&scene), &scene));
        let point = TracedSettings { sun_radius: Some(0.0), ..own };
        let seen = point.applied_to(&scene);
        assert_eq!(seen.sun.map(|sun| sun.angular_radius), Some(0.0));
        assert_eq!(Scene { sun: scene.sun, ..(*seen).clone() }, *scene, "all else is as it was");
        assert!(Arc::ptr_eq(&TracedSettings { sun_radius: Some(2.5), ..own }.applied_to(&scene), &scene));
        let records = |traced| Technique::Traced(traced).options(4);
        assert!(records(point).contains(&("traced-sun", "0".into())));
        assert!(records(own).iter().all(|(name, _)| *name != "traced-sun"));
    }

    #[test]
    fn another_scene_has_its_own_sun_again_and_a_point_sun_is_a_blind_spot() {
        let scene = scene::builtin::named("whitted").unwrap();
        let mut pane = PaneSettings::of(TechniqueName::Path);
        (pane.truth.sun_radius, pane.whitted.sun_radius) = (Some(0.0), Some(0.0));
        let blind = |pane: &PaneSettings| match pane.in_use() {
            Technique::Traced(traced) => traced.blind_spots(&scene),
            Technique::Fake(_) => Vec::new(),
        };
        assert!(matches!(blind(&pane)[..], [BlindSpot::LongChains]), "{:?}", blind(&pane));
        pane.forget_the_scene(&scene);
        assert_eq!((pane.truth.sun_radius, pane.whitted.sun_radius, blind(&pane)), (None, None, Vec::new()));
    }
}
