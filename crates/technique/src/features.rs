//! What the pixels of a film show, beside its light: made when a denoiser asks, and seldom again; or in its place.

use crate::{Accumulation, Backend, Device, Renderer, Watch};
use film::{Feature, Features, Film};
use pathtrace::gpu::GpuTraceError;
use pathtrace::{FeatureFilm, FeaturePass, Integrator, Tracer};
use scene::Camera;

/// Samples from which features are so clean that more would change nothing that a filter sees.
const ENOUGH: u32 = 16;

/// Samples with which they are made first for a denoiser: of fewer, what glass sends on by chance would be noise. Where earlier
/// views alone are looked up by them, one is enough, and there is no time for more.
const FEWEST: u32 = 4;

/// Most samples of a film that shows a feature: more would change nothing but the rounding of its sums, which are f32.
pub(crate) const MOST: u32 = 4096;

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
    /// Whether it can begin at once: a device may have to compile first.
    pub(crate) fn has_compiled(&self, integrator: &Integrator) -> bool {
        match self.feature {
            Some(_) => self.backend.has_compiled_features(integrator.sampler()),
            None => self.backend.has_compiled(integrator),
        }
    }

    /// What a film's pixels show, from few samples at first, and from enough once it has so many itself or is `finished`.
    pub(crate) fn make_features(
        &mut self,
        accumulation: &mut Accumulation,
        (camera, integrator): (&Camera, &Integrator),
        finished: bool,
        watch: &impl Watch,
    ) {
        let first = if watch.denoise().is_on() { FEWEST } else { 1 };
        let samples = if finished || accumulation.spp >= ENOUGH { ENOUGH } else { first };
        if accumulation.features.as_ref().is_some_and(|(made_from, _)| *made_from >= samples) {
            return;
        }
        let pass = pass_of(accumulation.film(), (camera, integrator), samples);
        let size = (accumulation.film().width(), accumulation.film().height());
        if let Err(fault) = denoise::check_memory(FeatureFilm::memory(size)) {
            accumulation.features_fault = Some(fault);
            return;
        }
        let mut sums = FeatureFilm::new(size);
        let stop = || watch.ends_now();
        if let Err(fault) = self.sample_features(&mut sums, &pass, &stop) {
            let fault = self.replace(accumulation, fault);
            watch.told_of_loss(&fault, accumulation.spp);
            // the processor, which has taken over, does not fail
            let _ = self.sample_features(&mut sums, &pass, &stop);
        }
        if sums.samples_per_pixel() >= samples {
            accumulation.features = sums.features().map(|features| (samples, features));
        }
    }

    fn sample_features(
        &mut self,
        sums: &mut FeatureFilm,
        pass: &FeaturePass,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Result<(), GpuTraceError> {
        let Renderer { backend, threads, rank, .. } = self;
        let on_device = backend.device() == Device::Gpu;
        let mut add = || backend.add_features(sums, pass, stop);
        let added = if on_device { Some(add()) } else { threads.turn_unless(stop, *rank, add) };
        added.map_or(Ok(()), |added| added.map(drop))
    }
}

impl Accumulation {
    /// Adds `samples` to every pixel of a film that shows a feature, unless `stop` says so; returns how many it took in all. The
    /// processor does it on the current pool.
    ///
    /// # Errors
    /// If the device fails; the next pass completes what it has done.
    pub(crate) fn add_features(
        &mut self,
        backend: &mut Backend,
        (camera, integrator): (&Camera, &Integrator),
        (feature, samples): (Feature, u32),
        stop: &(impl Fn() -> bool + Sync),
    ) -> Result<u64, GpuTraceError> {
        let (until, size) = (self.spp.saturating_add(samples), (self.film.width(), self.film.height()));
        self.begin_pass(backend.maker(), until);
        let pass = FeaturePass::new(camera, size, until, (integrator.sampler(), integrator.seed()));
        let sums = self.feature_film.get_or_insert_with(|| FeatureFilm::new(size));
        let before = sums.samples();
        let added = backend.add_features(sums, &pass, stop);
        // a device that fails may have added some before
        let adds_some = sums.samples() > before;
        self.spp = sums.samples_per_pixel();
        self.features = sums.features().map(|features| (self.spp, features));
        if let Some((spp, features)) = &self.features {
            features.fill(&mut self.film, feature, *spp);
        }
        if adds_some || added.is_ok() {
            self.is_read();
        }
        let stats = added?;
        self.stats = self.stats.plus(stats);
        Ok(stats.samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Adapters, DenoiseSettings, DeviceChoice, Frame, Pacing, ProgressiveRenderer, Rendered, Request};
    use crate::{SceneChanges, Shot, Threads, TracedSettings};
    use film::Vec3;
    use gpu::Gpu;
    use pathtrace::{MetropolisSettings, PathSettings};
    use scene::Scene;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};
    use std::time::Duration;

    const SIZE: (u32, u32) = (33, 17);

    /// Counts the losses of devices that it is told of, and rough pictures.
    #[derive(Default)]
    struct Counts {
        losses: AtomicU32,
        rough: AtomicU32,
    }

    impl Watch for Counts {
        fn ends_soon(&self, _spp: u32) -> bool {
            false
        }

        /// So little at a time that there are several passes.
        fn pacing(&self, _spent: Duration) -> Pacing {
            Pacing { pass: Duration::ZERO, show: Duration::ZERO, growth: 1 }
        }

        fn show(&self, frame: Frame) {
            assert!(frame.features.is_some(), "they are there without being asked for");
            self.rough.fetch_add(frame.rough.into(), Ordering::Relaxed);
        }

        fn told_of_loss(&self, _fault: &GpuTraceError, _spp: u32) {
            self.losses.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn pass(scene: &Scene, (samples, integrator): (u32, &Integrator)) -> FeaturePass {
        FeaturePass::new(&scene.camera, SIZE, samples, (integrator.sampler(), integrator.seed()))
    }

    fn finished(mut renderer: Renderer, integrator: &Integrator, samples: u32, watch: &impl Watch) -> Rendered {
        let (camera, blank) = (renderer.scene().camera, Accumulation::blank(SIZE).unwrap());
        renderer.finish(blank, &camera, (integrator, samples), DenoiseSettings::OFF, watch)
    }

    fn whitted() -> (Arc<Scene>, Arc<Threads>) {
        (Arc::new(scene::builtin::named("whitted").unwrap()), Arc::new(Threads::all()))
    }

    /// Neither the integrator nor how the samples come in passes has a part in it.
    #[test]
    fn a_renderer_that_shows_features_makes_films_of_them() {
        let (scene, threads) = whitted();
        let dark = PathSettings { bounces: Some(0), ..PathSettings::default() }.into();
        let features = Tracer::new(&scene).features(&pass(&scene, (5, &dark)), &|| false).unwrap();
        for feature in Feature::ALL {
            let mut renderer = Renderer::on_the_processor(scene.clone(), threads.clone());
            renderer.feature = Some(feature);
            let rendered = finished(renderer, &dark, 5, &Counts::default());
            assert!(Some(rendered.film) == features.film(feature, 5), "{feature:?}");
            assert_eq!(rendered.features.as_ref(), Some(&features));
            assert_eq!(rendered.stats.samples, 5 * 33 * 17);
            assert!(rendered.stats.rays > rendered.stats.samples, "mirrors and glass are looked through");
        }
    }

    /// Also of an integrator that the processor alone can follow.
    #[test]
    fn a_device_makes_films_of_features_and_is_named() {
        let (gpu, (scene, threads)) = (Gpu::headless().unwrap(), whitted());
        let integrator = MetropolisSettings::default().into();
        let expected = Tracer::new(&scene).features(&pass(&scene, (5, &integrator)), &|| false).unwrap();
        let mut renderer = Renderer::new(scene.clone(), Backend::on_the_device(&gpu, &scene).unwrap(), threads);
        renderer.feature = Some(Feature::Normal);
        let rendered = finished(renderer, &integrator, 5, &Counts::default());
        assert_eq!((rendered.device, rendered.made_by), (Device::Gpu, gpu.describe()));
        let features = rendered.features.unwrap();
        assert!(Some(rendered.film) == features.film(Feature::Normal, 5));
        assert_eq!(rendered.stats.samples, 5 * 33 * 17);
        // an edge where rounding decides is in few pixels
        let alike = |(a, b): (&Vec3, &Vec3)| a.abs_diff_eq(*b, 1e-3);
        assert!(features.normal.iter().zip(&*expected.normal).filter(|pair| !alike(*pair)).count() < 6);
    }

    #[test]
    fn the_processor_shows_what_a_lost_device_does_not() {
        let (gpu, (scene, threads)) = (Gpu::headless().unwrap(), whitted());
        let integrator = PathSettings::default().into();
        let expected = |samples| Tracer::new(&scene).features(&pass(&scene, (samples, &integrator)), &|| false);
        let on_the_device =
            || Renderer::new(scene.clone(), Backend::on_the_device(&gpu, &scene).unwrap(), threads.clone());
        let [mut showing, mut beside_light] = [on_the_device(), on_the_device()];
        gpu.device.destroy();
        showing.feature = Some(Feature::Albedo);
        let counts = Counts::default();
        let losses = || counts.losses.load(Ordering::Relaxed);
        let rendered = finished(showing, &integrator, 2, &counts);
        assert_eq!((rendered.device, rendered.features, losses()), (Device::Cpu, expected(2), 1));
        assert!(!rendered.made_by.contains(&gpu.describe()), "{}", rendered.made_by);
        let mut accumulation = Accumulation::blank(SIZE).unwrap();
        beside_light.make_features(&mut accumulation, (&scene.camera, &integrator), true, &counts);
        assert_eq!(accumulation.features, expected(ENOUGH).map(|features| (ENOUGH, features)));
        assert_eq!((beside_light.device(), losses()), (Device::Cpu, 2));
    }

    /// Those that the processor makes before a device is open as well.
    #[test]
    fn rough_pictures_are_of_what_is_shown() {
        let (scene, threads) = whitted();
        let (changes, camera) = (SceneChanges::default(), scene.camera);
        let shot = Shot { source: "whitted".into(), changes, scene, camera, own_up: camera.up, size: (640, 360) };
        let light = TracedSettings::new(PathSettings::default().into(), 1);
        let settings = TracedSettings { device: DeviceChoice::Gpu, feature: Some(Feature::Albedo), ..light };
        let mut renderer = ProgressiveRenderer::new(Adapters::of(&Gpu::adapters()), threads);
        let counts = Counts::default();
        renderer.render(&Request { shot, settings, restarts: 0 }, &counts).unwrap();
        assert!(counts.rough.into_inner() > 0);
    }
}
