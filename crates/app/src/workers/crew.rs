//! The threads beside the UI as one: asks them for whatever no longer fits what the viewer shows, and ends them.

use super::Wake;
use super::darkroom::{Darkroom, Shelf};
use super::fake::{FakeJob, FakeWorker};
use super::truth::{TruthJob, TruthWorker};
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
    asked: Asked,
}

/// What each worker was last asked for.
#[derive(Default)]
struct Asked {
    scene: Option<(Revisions, Arc<Scene>)>,
    fake: Option<(u64, Camera, FakeSettings, (u32, u32))>,
    truth: Option<(u64, Camera, TruthSettings, (u32, u32))>,
    display: Option<DisplayTransform>,
    jobs: u64,
}

impl Crew {
    /// Starts the threads; `wake` is called whenever [`Crew::collect`] has something.
    ///
    /// # Errors
    /// If the system gives no threads, or no device for the fake.
    pub fn start(window: &Gpu, wake: Wake) -> anyhow::Result<Self> {
        let (darkroom, thread) = Darkroom::start(wake).context("no thread for the darkroom")?;
        Ok(Crew {
            fake: FakeWorker::start(fake_gpu(window)?, darkroom.clone()).context("no thread for the fake")?,
            truth: TruthWorker::start(darkroom.clone()).context("no threads for the truth")?,
            darkroom,
            darkroom_thread: Some(thread),
            asked: Asked::default(),
        })
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<Shelf> {
        self.darkroom.collect()
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
        let (camera, size) = (viewer.camera, viewer.picture_size);
        let fake = (viewer.revisions.fake, camera, viewer.fake, size);
        if asked.fake != Some(fake) {
            asked.fake = Some(fake);
            asked.jobs += 1;
            self.fake.submit(FakeJob { scene: scene.clone(), camera, settings: viewer.fake, size, job: asked.jobs });
        }
        let truth = (viewer.revisions.truth, camera, viewer.truth, size);
        if asked.truth == Some(truth) {
            return None;
        }
        asked.truth = Some(truth);
        asked.jobs += 1;
        self.truth.submit(TruthJob { scene, camera, settings: viewer.truth, size, job: asked.jobs });
        Some(asked.jobs)
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
