//! What a pane of the viewer or one call of `visavis render` is set to.

use crate::{
    ChainSettings, DenoiseSettings, DeviceChoice, FakeSettings, LightPaneSettings, NormalsPaneSettings,
    PhotonPaneSettings, Technique, TechniqueName, TracedSettings, TreeSettings, TruthSettings,
};
use film::Feature;
use pathtrace::{Estimator, Integrator};
use scene::{Needs, Scene};

/// What a pane is set to: a technique, and the settings of each so that coming back to one finds them again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaneSettings {
    /// The technique that is used.
    pub technique: TechniqueName,
    /// Where its rays are traced.
    pub device: DeviceChoice,
    /// By which of the adapters, where by one.
    pub adapter: u8,
    /// What pictures of rays go through before they are shown.
    pub denoise: DenoiseSettings,
    /// Pictures of rays whose mean is shown, as in [`TracedSettings`].
    pub runs: u32,
    /// What pictures of rays show in place of light, as in [`TracedSettings`].
    pub feature: Option<Feature>,
    /// The settings of the fake.
    pub fake: FakeSettings,
    /// The settings of Whitted's method.
    pub whitted: TreeSettings,
    /// The settings of path tracing.
    pub truth: TruthSettings,
    /// The settings of photon mapping.
    pub photon: PhotonPaneSettings,
    /// The settings of light tracing.
    pub light: LightPaneSettings,
    /// The settings of Metropolis' chains.
    pub metropolis: ChainSettings,
    /// The settings of a picture of normals.
    pub normals: NormalsPaneSettings,
}

impl PaneSettings {
    /// A pane of this technique with its default settings.
    pub fn of(technique: TechniqueName) -> Self {
        PaneSettings {
            technique,
            device: DeviceChoice::default(),
            adapter: 0,
            denoise: DenoiseSettings::OFF,
            runs: 1,
            feature: None,
            fake: FakeSettings::default(),
            whitted: TreeSettings::default(),
            truth: TruthSettings::default(),
            photon: PhotonPaneSettings::default(),
            light: LightPaneSettings::default(),
            metropolis: ChainSettings::default(),
            normals: NormalsPaneSettings::default(),
        }
    }

    /// The technique in use with its settings.
    pub fn in_use(&self) -> Technique {
        match self.technique {
            TechniqueName::Raster => Technique::Fake(self.fake),
            TechniqueName::Whitted => Technique::Traced(self.here(self.whitted.into())),
            TechniqueName::Path => Technique::Traced(self.here(self.truth.into())),
            TechniqueName::Photon => Technique::Traced(self.here(self.photon.into())),
            TechniqueName::LightTracing => Technique::Traced(self.here(self.light.into())),
            TechniqueName::Metropolis => Technique::Traced(self.here(self.metropolis.into())),
            // which show nothing else
            TechniqueName::Normals => {
                Technique::Traced(TracedSettings { feature: None, ..self.here(self.normals.into()) })
            }
        }
    }

    fn here(&self, traced: TracedSettings) -> TracedSettings {
        let &PaneSettings { device, adapter, denoise, runs, feature, .. } = self;
        TracedSettings { device, adapter, denoise, runs, feature, ..traced }
    }

    /// Takes `scene`'s own numbers again, and looks at the picture where it has no such map.
    pub fn forget_the_scene(&mut self, scene: &Scene) {
        self.fake.forget_the_scene(scene);
        self.whitted.tree.ambient = None;
        (self.whitted.sun_radius, self.truth.sun_radius) = (None, None);
        (self.photon.sun_radius, self.light.sun_radius, self.metropolis.sun_radius) = (None, None, None);
        self.photon.photon.radius = None;
    }

    /// Takes the estimator that `scene` asks for, unless another than a new pane's was chosen.
    pub fn take_usual_estimator(&mut self, scene: &Scene) {
        self.take_usual_estimator_after(&Needs::default(), scene);
    }

    /// Takes the estimator that `scene` asks for, unless another was chosen than what a scene with the needs `before` asks
    /// for.
    pub fn take_usual_estimator_after(&mut self, before: &Needs, scene: &Scene) {
        for path in [&mut self.truth.path, &mut self.metropolis.metropolis.path] {
            if path.estimator == Estimator::usual_for(before) {
                path.estimator = Estimator::usual_for(&scene.needs());
            }
        }
    }

    /// Samples per pixel at which rendering stops; `None` for a technique that does not sample.
    pub fn wished_spp(&self) -> Option<u32> {
        match self.in_use() {
            Technique::Fake(_) => None,
            Technique::Traced(traced) => Some(traced.spp),
        }
    }
}

impl From<Technique> for PaneSettings {
    /// A pane that is set to it.
    fn from(technique: Technique) -> Self {
        let pane = PaneSettings::of(technique.name());
        match technique {
            Technique::Fake(fake) => PaneSettings { fake, ..pane },
            Technique::Traced(traced) => {
                let TracedSettings { integrator, device, adapter, spp, sun_radius, feature, .. } = traced;
                let (denoise, runs) = (technique.denoise(), technique.runs());
                let pane = PaneSettings { device, adapter, denoise, runs, feature, ..pane };
                match integrator {
                    Integrator::Path(path) => PaneSettings { truth: TruthSettings { path, spp, sun_radius }, ..pane },
                    Integrator::Whitted(tree) => {
                        PaneSettings { whitted: TreeSettings { tree, spp, sun_radius }, ..pane }
                    }
                    Integrator::Photon(photon) => {
                        PaneSettings { photon: PhotonPaneSettings { photon, spp, sun_radius }, ..pane }
                    }
                    Integrator::LightTracing(light) => {
                        PaneSettings { light: LightPaneSettings { light, spp, sun_radius }, ..pane }
                    }
                    Integrator::Metropolis(metropolis) => {
                        PaneSettings { metropolis: ChainSettings { metropolis, spp, sun_radius }, ..pane }
                    }
                    Integrator::Normals(normals) => {
                        PaneSettings { normals: NormalsPaneSettings { normals, spp }, ..pane }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_estimator_goes_with_its_scene_and_one_that_was_chosen_stays() {
        let [cornell, whitted] = ["cornell", "whitted"].map(|name| scene::builtin::named(name).unwrap());
        let estimators = |pane: &PaneSettings| [pane.truth.path.estimator, pane.metropolis.metropolis.path.estimator];
        let mut pane = PaneSettings::of(TechniqueName::Path);
        pane.take_usual_estimator(&cornell);
        assert_eq!(estimators(&pane), [Estimator::LIGHT; 2]);
        pane.take_usual_estimator_after(&cornell.needs(), &whitted);
        assert_eq!(estimators(&pane), [Estimator::MIS; 2], "what its spheres focus");
        pane.take_usual_estimator_after(&whitted.needs(), &cornell);
        assert_eq!(estimators(&pane), [Estimator::LIGHT; 2]);
        pane.truth.path.estimator = Estimator::COSINE;
        pane.take_usual_estimator_after(&cornell.needs(), &whitted);
        assert_eq!(estimators(&pane), [Estimator::COSINE, Estimator::MIS]);
        pane.truth.path.estimator = Estimator::LIGHT;
        pane.take_usual_estimator_after(&whitted.needs(), &whitted);
        assert_eq!(pane.truth.path.estimator, Estimator::LIGHT, "chosen, where mis is usual");
    }
}
