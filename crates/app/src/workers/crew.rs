//! The threads beside the UI as one: asks them for whatever no longer fits what the viewer shows, and ends them.

use super::darkroom::{Darkroom, News, Shelf};
use super::fake::{FakeJob, FakeWorker};
use super::loader::Loader;
use super::truth::{TruthJob, TruthWorker};
use super::{Order, Wake};
use crate::technique::{FakeSettings, TruthSettings};
use crate::ui::{Revisions, Viewer};
use anyhow::Context;
use gpu::Gpu;
use scene::display::DisplayTransform;
use scene::{Camera, Scene};
use std::sync::Arc;
use std::thread::JoinHandle;

/// The workers; dropping it ends their threads.
pub struct Crew {
    fake: FakeWorker,
    truth: TruthWorker,
    darkroom: Arc<Darkroom>,
    darkroom_thread: Option<JoinHandle<()>>,
    loader: Loader,
    asked: Asked,
}

/// What each worker was last asked for.
#[derive(Default)]
struct Asked {
    scene: Option<(Revisions, Arc<Scene>)>,
    view: Option<View>,
    fake: Option<(u64, u64, FakeSettings)>,
    truth: Option<(u64, u64, TruthSettings)>,
    display: Option<DisplayTransform>,
    /// The first view of the scene that is open.
    oldest_view: u64,
    /// Counts views and jobs.
    views: u64,
    jobs: u64,
}

/// What both sides share.
#[derive(PartialEq)]
struct View {
    opened: u64,
    shared: u64,
    camera: Camera,
    size: (u32, u32),
}

impl Crew {
    /// Starts the threads; `wake` is called whenever [`Crew::collect`] has something.
    ///
    /// # Errors
    /// If the system gives no threads, or no device for the fake.
    pub fn start(window: &Gpu, wake: Wake) -> anyhow::Result<Self> {
        let (darkroom, thread) = Darkroom::start(wake.clone()).context("no thread for the darkroom")?;
        Ok(Crew {
            fake: FakeWorker::start(fake_gpu(window)?, darkroom.clone()).context("no thread for the fake")?,
            truth: TruthWorker::start(darkroom.clone()).context("no threads for the truth")?,
            darkroom,
            darkroom_thread: Some(thread),
            loader: Loader::new(wake),
            asked: Asked::default(),
        })
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<Shelf> {
        let mut shelf = self.darkroom.collect()?;
        for place in &mut shelf {
            place.take_if(|news| matches!(news, News::Picture(d) if d.picture.order.view < self.asked.oldest_view));
        }
        Some(shelf)
    }

    /// Asks for what has changed in the viewer; returns the number of a new job of the truth, if there is one.
    pub fn ask(&mut self, viewer: &Viewer) -> Option<u64> {
        let asked = &mut self.asked;
        let scene = match &asked.scene {
            Some((revisions, scene)) if *revisions == viewer.revisions => scene.clone(),
            _ => Arc::new(viewer.scene.clone()),
        };
        asked.scene = Some((viewer.revisions, scene.clone()));
        if asked.display != Some(viewer.display) {
            asked.display = Some(viewer.display);
            self.darkroom.set_display(viewer.display);
        }
        let Revisions { opened, shared, fake, truth } = viewer.revisions;
        let (camera, size) = (viewer.camera, viewer.picture_size);
        let view = View { opened, shared, camera, size };
        if asked.view.as_ref() != Some(&view) {
            asked.views += 1;
            if asked.view.as_ref().is_some_and(|old| old.opened != opened) {
                asked.oldest_view = asked.views;
                self.darkroom.forget_before(asked.views);
            }
            asked.view = Some(view);
        }
        if asked.fake != Some((asked.views, fake, viewer.fake)) {
            asked.fake = Some((asked.views, fake, viewer.fake));
            let order = asked.order(viewer.fake.label());
            self.fake.submit(FakeJob { scene: scene.clone(), camera, settings: viewer.fake, size, order });
        }
        if asked.truth == Some((asked.views, truth, viewer.truth)) {
            return None;
        }
        asked.truth = Some((asked.views, truth, viewer.truth));
        let order = asked.order(viewer.truth.label());
        self.truth.submit(TruthJob { scene, camera, settings: viewer.truth, size, order });
        Some(asked.jobs)
    }

    /// Reads a scene beside the UI.
    pub fn load(&self, name: String) {
        self.loader.load(name);
    }

    /// The scene that was read since the last call, or why it was not.
    pub fn loaded(&self) -> Option<Result<Scene, String>> {
        self.loader.loaded()
    }
}

impl Asked {
    fn order(&mut self, label: String) -> Order {
        self.jobs += 1;
        Order { job: self.jobs, view: self.views, label }
    }
}

/// The device of the fake: the window's own, but where the processor plays the graphics device another one, because there
/// a frame of the window would wait in one queue behind the whole of the fake.
fn fake_gpu(window: &Gpu) -> anyhow::Result<Gpu> {
    if window.is_software() { Ok(Gpu::headless()?) } else { Ok(window.clone()) }
}

impl Drop for Crew {
    fn drop(&mut self) {
        self.darkroom.close();
        if let Some(thread) = self.darkroom_thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}
