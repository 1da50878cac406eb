//! What is done until the trees of large meshes are there: where that takes a while, the scene is shown with coarse meshes
//! in their place. Nothing of these pictures is kept.

use super::{ProgressiveRenderer, Request};
use crate::coarse::coarse;
use crate::renderer::Renderer;
use crate::{Accumulation, Backend, Device, Frame, Pacing, Rank, TreeProgress, Trees, Watch};
use scene::Scene;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long trees are waited for before a coarse picture is worth its while.
const SOON: Duration = Duration::from_millis(200);

/// Samples per pixel of a coarse picture at most: building has the cores after that.
const SAMPLES: u32 = 4;

/// A scene with coarse meshes, ready for rays.
pub(super) struct Coarse {
    of: Arc<Scene>,
    /// `None` where the scene has nothing that can be coarse.
    renderer: Option<Renderer>,
}

impl ProgressiveRenderer {
    /// The trees that the scene is made ready with, unless it is, or a device has them; `None` if it ends before.
    pub(super) fn trees(&mut self, request: &Request, watch: &impl Watch) -> Option<Option<Trees>> {
        if self.has_trees(request) {
            return Some(None);
        }
        let scene = &request.shot.scene;
        let is_known = self.coarse.as_ref().is_some_and(|coarse| Arc::ptr_eq(&coarse.of, scene));
        let begun = Instant::now();
        let waits = |_| !is_known && !watch.ends_now() && begun.elapsed() < SOON;
        let soon = Trees::of(scene, &waits);
        let trees = if soon.is_some() || (watch.ends_now() && !is_known) {
            soon
        } else {
            self.trees_beside_coarse_pictures(request, watch)
        };
        if trees.is_some() {
            self.coarse = None;
        }
        trees.map(Some)
    }

    fn has_trees(&mut self, request: &Request) -> bool {
        let (scene, device, adapter) = (&request.shot.scene, self.device_for(request), self.adapter_for(request));
        self.ready.as_ref().is_some_and(|ready| {
            let is_on_the_device = device == Device::Gpu && ready.is_ready_for(ready.scene(), device, &adapter);
            ready.is_ready_for(scene, device, &adapter)
                || (is_on_the_device && Trees::are_shared_by(ready.scene(), scene))
        })
    }

    fn trees_beside_coarse_pictures(&mut self, request: &Request, watch: &impl Watch) -> Option<Trees> {
        let there = AtomicBool::new(false);
        let hear = |trees: Option<TreeProgress>| {
            trees.into_iter().for_each(|trees| watch.waits_for_trees(Some(trees)));
            !watch.ends_now()
        };
        let wait = || {
            let trees = Trees::of(&request.shot.scene, &hear);
            there.store(trees.is_some(), Ordering::Relaxed);
            trees
        };
        let trees = std::thread::scope(|scope| {
            let waiting = scope.spawn(wait);
            self.show_coarse(request, &Coarsely { watch, there: &there });
            waiting.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        });
        watch.waits_for_trees(None);
        trees
    }

    /// Pictures with coarse meshes, from the rough to a few samples, until the watch ends it.
    fn show_coarse(&mut self, request: &Request, watch: &impl Watch) {
        let Some(mut renderer) = self.coarse_renderer(&request.shot.scene, watch) else { return };
        renderer.feature = request.settings.feature;
        self.rough(&mut renderer, request, watch);
        // without memory for it the rough ones are all
        if let Some(mut film) = Accumulation::blank(request.shot.size).filter(|_| !watch.ends_now()) {
            let wished = (&request.settings.integrator, request.settings.spp.min(SAMPLES));
            renderer.refine(&mut film, &request.shot.camera, wished, watch);
        }
        self.coarse = Some(Coarse { of: request.shot.scene.clone(), renderer: Some(renderer) });
    }

    fn coarse_renderer(&mut self, scene: &Arc<Scene>, watch: &impl Watch) -> Option<Renderer> {
        if let Some(Coarse { renderer, .. }) = self.coarse.take_if(|coarse| Arc::ptr_eq(&coarse.of, scene)) {
            return renderer;
        }
        let Some(coarse) = coarse(scene) else {
            self.coarse = Some(Coarse { of: scene.clone(), renderer: None });
            return None;
        };
        let ready = || Backend::on_the_processor(&coarse);
        let backend = self.threads.turn_unless(&|| watch.ends_now(), Rank::RoughPicture, ready)?;
        Some(Renderer::new(Arc::new(coarse), backend, self.threads.clone()).with_speeds(self.speeds))
    }
}

/// Watches for another while coarse meshes stand for those whose trees are not there yet.
struct Coarsely<'a, W> {
    watch: &'a W,
    there: &'a AtomicBool,
}

impl<W: Watch> Watch for Coarsely<'_, W> {
    fn ends_now(&self) -> bool {
        self.there.load(Ordering::Relaxed) || self.watch.ends_now()
    }

    fn ends_soon(&self, spp: u32) -> bool {
        self.ends_now() || self.watch.ends_soon(spp)
    }

    fn pacing(&self, spent: Duration) -> Pacing {
        self.watch.pacing(spent)
    }

    fn show(&self, frame: Frame) {
        self.watch.show(Frame { rough: true, coarse: true, unfinished: true, ..frame });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Adapters, DeviceChoice, Shot, Threads, TracedSettings};
    use pathtrace::PathSettings;
    use std::sync::Mutex;

    /// Whether a picture is coarse, rough and unfinished, its film's size and its radiances.
    type Sight = ([bool; 3], (u32, u32), Vec<scene::Vec3>);

    /// Keeps what it is shown.
    #[derive(Default)]
    struct Looking {
        shown: Mutex<Vec<Sight>>,
    }

    impl Watch for Looking {
        fn ends_soon(&self, _spp: u32) -> bool {
            false
        }

        fn pacing(&self, _spent: Duration) -> Pacing {
            Pacing { pass: Duration::ZERO, show: Duration::ZERO, growth: 1 }
        }

        fn show(&self, frame: Frame) {
            let image = frame.film.image();
            let state = [frame.coarse, frame.rough, frame.unfinished];
            self.shown.lock().unwrap().push((state, image.size(), image.radiances().to_vec()));
        }
    }

    fn statues(spp: u32) -> Request {
        let scene = scene::builtin::named("statues").unwrap();
        let settings =
            TracedSettings { device: DeviceChoice::Cpu, ..TracedSettings::new(PathSettings::default().into(), spp) };
        Request { shot: Shot::of(scene, (48, 27)), settings, restarts: 0 }
    }

    fn renderer() -> ProgressiveRenderer {
        ProgressiveRenderer::new(Adapters::default(), Arc::new(Threads::all()))
    }

    #[test]
    fn coarse_pictures_are_told_to_be_such_and_nothing_of_them_is_kept() {
        let (mut renderer, looking, there) = (renderer(), Looking::default(), AtomicBool::new(false));
        renderer.show_coarse(&statues(64), &Coarsely { watch: &looking, there: &there });
        assert!(renderer.kept.is_empty() && renderer.ready.is_none() && renderer.coarse.is_some());
        let shown = looking.shown.into_inner().unwrap();
        assert!(shown.iter().all(|(state, ..)| *state == [true; 3]));
        let (_, size, radiances) = shown.last().expect("a picture");
        assert_eq!(*size, (48, 27));
        assert!(radiances.iter().any(|radiance| radiance.max_element() > 0.0));
    }

    #[test]
    fn once_trees_are_there_the_coarse_picture_ends_and_the_film_is_that_of_a_scene_that_had_them() {
        let there = AtomicBool::new(true);
        let (mut renderer, looking) = (renderer(), Looking::default());
        renderer.show_coarse(&statues(64), &Coarsely { watch: &looking, there: &there });
        assert!(looking.shown.into_inner().unwrap().iter().all(|(_, size, _)| size.0 < 48), "no whole picture");
        let request = statues(2);
        let film = |renderer: &mut ProgressiveRenderer| {
            let looking = Looking::default();
            renderer.render(&request, &looking).unwrap();
            let shown = looking.shown.into_inner().unwrap();
            let first = shown.iter().position(|(state, ..)| !state[0]).expect("a picture of the scene itself");
            assert!(shown[first..].iter().all(|(state, ..)| !state[0]), "no coarse one after it");
            shown.into_iter().last().expect("a picture")
        };
        let beside = film(&mut renderer);
        let _trees = Trees::of(&request.shot.scene, &|_| true);
        let ready = film(&mut self::renderer());
        assert_eq!(beside, ready);
        assert_eq!(ready.0, [false; 3]);
    }
}
