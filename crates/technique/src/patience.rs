//! Someone who ends a while later than another, where nothing has been shown yet: else a drag would never show anything.

use crate::{DenoiseSettings, Frame, Pacing, TreeProgress, Watch};
use pathtrace::gpu::GpuTraceError;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Watches for another; until something is shown, or its time is over, as if nothing newer had come.
pub(crate) struct Patient<'a, W> {
    watch: &'a W,
    until: Instant,
    has_shown: AtomicBool,
}

impl<'a, W> Patient<'a, W> {
    pub(crate) fn until(watch: &'a W, until: Instant) -> Self {
        Patient { watch, until, has_shown: AtomicBool::new(false) }
    }

    fn waits(&self) -> bool {
        !self.has_shown.load(Ordering::Relaxed) && Instant::now() < self.until
    }
}

impl<W: Watch> Watch for Patient<'_, W> {
    fn ends_now(&self) -> bool {
        self.watch.ends_now() && !self.waits()
    }

    fn ends_soon(&self, spp: u32) -> bool {
        self.watch.ends_soon(spp) && !self.waits()
    }

    fn wants_features(&self) -> bool {
        self.watch.wants_features()
    }

    fn denoise(&self) -> DenoiseSettings {
        self.watch.denoise()
    }

    fn ends_after_run(&self) -> bool {
        self.watch.ends_after_run() && !self.waits()
    }

    fn skips_filters(&self) -> bool {
        self.watch.skips_filters() && !self.waits()
    }

    fn keeps_parts(&self) -> bool {
        self.watch.keeps_parts()
    }

    fn parts_meet_at(&self) -> Option<u32> {
        self.watch.parts_meet_at()
    }

    fn is_held(&self) -> bool {
        self.watch.is_held() && !self.waits()
    }

    fn wait(&self) {
        self.watch.wait();
    }

    fn pacing(&self, spent: Duration) -> Pacing {
        let pacing = self.watch.pacing(spent);
        if self.waits() { Pacing { show: Duration::ZERO, ..pacing } } else { pacing }
    }

    fn show(&self, frame: Frame) {
        self.watch.show(frame);
        self.has_shown.store(true, Ordering::Relaxed);
    }

    fn waits_for_trees(&self, trees: Option<TreeProgress>) {
        self.watch.waits_for_trees(trees);
    }

    fn count(&self, spp: u32) {
        self.watch.count(spp);
    }

    fn told_of_loss(&self, fault: &GpuTraceError, spp: u32) {
        self.watch.told_of_loss(fault, spp);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Adapters, Denoiser, DeviceChoice, ProgressiveRenderer, Request, Shot, TRUST, Threads, TracedSettings};
    use pathtrace::PathSettings;
    use std::sync::{Arc, Mutex};

    const VIEW: DenoiseSettings =
        DenoiseSettings { denoiser: Denoiser::ATrous, trust: 1.0, shows_trust: true, ..DenoiseSettings::OFF };

    /// A drag goes on: something newer is there from the first.
    #[derive(Default)]
    struct Dragging {
        /// Samples per pixel, and whether there is a weight.
        shown: Mutex<Vec<(u32, bool)>>,
    }

    impl Watch for Dragging {
        fn ends_now(&self) -> bool {
            true
        }

        fn ends_soon(&self, _spp: u32) -> bool {
            true
        }

        fn denoise(&self) -> DenoiseSettings {
            VIEW
        }

        fn pacing(&self, _spent: Duration) -> Pacing {
            Pacing { pass: Duration::ZERO, show: Duration::from_secs(3600), growth: 1 }
        }

        fn show(&self, frame: Frame) {
            let image = frame.denoised.unwrap().unwrap().image;
            let weight = image.layers.iter().any(|layer| layer.name == TRUST);
            self.shown.lock().unwrap().push((frame.film.samples_per_pixel(), weight));
        }
    }

    #[test]
    fn a_drag_shows_of_each_view_how_far_samples_are_trusted() {
        let scene = Arc::new(scene::builtin::named("cornell").unwrap());
        let light = TracedSettings::new(PathSettings::default().into(), 64);
        let settings = TracedSettings { denoise: VIEW, device: DeviceChoice::Cpu, ..light };
        let mut renderer = ProgressiveRenderer::new(Adapters::default(), Arc::new(Threads::all()));
        for view in 0..3 {
            let camera = scene.camera.orbited(0.1 * view as f32, 0.0);
            let shot = Shot { scene: scene.clone(), camera, ..Shot::of((*scene).clone(), (33, 17)) };
            let drag = Dragging::default();
            renderer.render(&Request { shot, settings, restarts: 0 }, &drag).unwrap();
            assert_eq!(drag.shown.into_inner().unwrap(), [(2, true)], "view {view}: of two parts, of a sample each");
        }
    }
}
