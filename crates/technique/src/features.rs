//! What the pixels of a film show, beside its light: made when a denoiser asks, and seldom again; or in its place.

use crate::{Accumulation, Backend, Renderer, Watch, backend};
use film::{Feature, Features, Film};
use pathtrace::{FeatureFilm, FeaturePass, Integrator, Tracer};
use scene::{Camera, Scene};

/// Samples from which features are so clean that more would change nothing that a filter sees.
const ENOUGH: u32 = 16;

/// Samples with which they are made first: of fewer, what glass sends on by chance would be noise.
const FEWEST: u32 = 4;

/// What a finished film's pixels show, on the current rayon pool; `None` once `stop` says so.
pub fn features_of(
    tracer: &Tracer,
    film: &Film,
    (camera, integrator): (&Camera, &Integrator),
    stop: &(impl Fn() -> bool + Sync),
) -> Option<Features> {
    tracer.features(&pass_of(film, (camera, integrator), ENOUGH), stop)
}

fn pass_of(film: &Film, (camera, integrator): (&Camera, &Integrator), samples: u32) -> FeaturePass {
    let sampler = (integrator.sampler(), integrator.seed());
    FeaturePass::new(camera, (film.width(), film.height()), samples, sampler)
}

impl Renderer {
    /// What a film's pixels show, from few samples at first, and from enough once it has so many itself or is `finished`.
    pub(crate) fn make_features(
        &mut self,
        accumulation: &mut Accumulation,
        (camera, integrator): (&Camera, &Integrator),
        finished: bool,
        watch: &impl Watch,
    ) {
        let samples = if finished || accumulation.spp >= ENOUGH { ENOUGH } else { FEWEST };
        if accumulation.features.as_ref().is_some_and(|(made_from, _)| *made_from >= samples) {
            return;
        }
        let pass = pass_of(accumulation.film(), (camera, integrator), samples);
        let tracer = on_the_processor(&self.backend, &mut self.beside_the_device, &self.scene);
        let stop = || watch.ends_now();
        let traced = self.threads.turn_unless(&stop, self.rank, || tracer.features(&pass, &stop)).flatten();
        if let Some(features) = traced {
            accumulation.features = Some((samples, features));
        }
    }
}

/// What traces what no device does.
pub(crate) fn on_the_processor<'a>(
    backend: &'a Backend,
    beside_the_device: &'a mut Option<Box<Tracer>>,
    scene: &Scene,
) -> &'a Tracer {
    match backend {
        Backend::Cpu(tracer) => tracer,
        Backend::Gpu(_) => beside_the_device.get_or_insert_with(|| Box::new(Tracer::new(scene))),
    }
}

impl Accumulation {
    /// Adds `samples` to every pixel of a film that shows a feature, on the current pool, unless `stop` says so; returns how
    /// many it took in all.
    pub(crate) fn add_features(
        &mut self,
        tracer: &Tracer,
        (camera, integrator): (&Camera, &Integrator),
        (feature, samples): (Feature, u32),
        stop: &(impl Fn() -> bool + Sync),
    ) -> u64 {
        let (until, size) = (self.spp.saturating_add(samples), (self.film.width(), self.film.height()));
        self.begin_pass(backend::threads_name(), until);
        let pass = FeaturePass::new(camera, size, until, (integrator.sampler(), integrator.seed()));
        let sums = self.feature_film.get_or_insert_with(|| FeatureFilm::new(size));
        let stats = tracer.add_features(sums, &pass, stop);
        self.spp = sums.samples_per_pixel();
        self.features = sums.features().map(|features| (self.spp, features));
        if let Some((spp, features)) = &self.features {
            features.fill(&mut self.film, feature, *spp);
        }
        self.stats = self.stats.plus(stats);
        self.is_read();
        stats.samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DenoiseSettings, Pacing, Threads};
    use pathtrace::PathSettings;
    use std::sync::Arc;
    use std::time::Duration;

    struct Patient;

    impl Watch for Patient {
        fn ends_soon(&self, _spp: u32) -> bool {
            false
        }

        /// So little at a time that there are several passes.
        fn pacing(&self, _spent: Duration) -> Pacing {
            Pacing { pass: Duration::ZERO, show: Duration::ZERO, growth: 1 }
        }

        fn show(&self, frame: crate::Frame) {
            assert!(frame.features.is_some(), "they are there without being asked for");
        }
    }

    /// Neither the integrator nor how the samples come in passes has a part in it.
    #[test]
    fn a_renderer_that_shows_features_makes_films_of_them() {
        let scene = Arc::new(scene::builtin::named("whitted").unwrap());
        let threads = Arc::new(Threads::all());
        let dark = PathSettings { bounces: Some(0), ..PathSettings::default() };
        let pass = FeaturePass::new(&scene.camera, (33, 17), 5, (dark.sampler, dark.seed));
        let features = Tracer::new(&scene).features(&pass, &|| false).unwrap();
        for feature in Feature::ALL {
            let mut renderer = Renderer::on_the_processor(scene.clone(), threads.clone());
            renderer.feature = Some(feature);
            let blank = Accumulation::blank((33, 17)).unwrap();
            let rendered = renderer.finish(blank, &scene.camera, (&dark.into(), 5), DenoiseSettings::OFF, &Patient);
            assert!(Some(rendered.film) == features.film(feature, 5), "{feature:?}");
            assert_eq!(rendered.features.as_ref(), Some(&features));
            assert_eq!(rendered.stats.samples, 5 * 33 * 17);
            assert!(rendered.stats.rays > rendered.stats.samples, "mirrors and glass are looked through");
        }
    }
}
