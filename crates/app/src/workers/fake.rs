//! The thread that rasterises.

use super::darkroom::Darkroom;
use super::{Inbox, Order, Picture, Side};
use crate::technique::FakeSettings;
use gpu::Gpu;
use raster::Raster;
use scene::{Camera, Scene};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

/// A picture to make.
#[derive(Debug, Clone)]
pub struct FakeJob {
    /// What is seen.
    pub scene: Arc<Scene>,
    /// From where.
    pub camera: Camera,
    /// How.
    pub settings: FakeSettings,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// What for.
    pub order: Order,
}

/// The worker; dropping it ends its thread.
pub struct FakeWorker {
    inbox: Arc<Inbox<Option<FakeJob>>>,
    thread: Option<JoinHandle<()>>,
}

impl FakeWorker {
    /// Starts the thread.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(gpu: Gpu, darkroom: Arc<Darkroom>) -> std::io::Result<Self> {
        let inbox = Arc::new(Inbox::default());
        let jobs = inbox.clone();
        let thread = std::thread::Builder::new().name("fake".into()).spawn(move || work(&gpu, &jobs, &darkroom))?;
        Ok(FakeWorker { inbox, thread: Some(thread) })
    }

    /// Asks for a picture; one that was not begun yet is dropped.
    pub fn submit(&self, job: FakeJob) {
        self.inbox.post(|slot| *slot = Some(job));
    }
}

impl Drop for FakeWorker {
    fn drop(&mut self) {
        self.inbox.close();
        if let Some(thread) = self.thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}

fn work(gpu: &Gpu, jobs: &Inbox<Option<FakeJob>>, darkroom: &Darkroom) {
    let mut raster = Raster::new(gpu);
    while let Some(job) = jobs.take() {
        let Some(job) = job else { continue };
        let start = Instant::now();
        let made = match &mut raster {
            Ok(raster) => {
                let settings = job.settings.sized(job.size.0, job.size.1);
                raster.render(&job.scene, &job.camera, &settings).map_err(|e| e.to_string())
            }
            Err(e) => Err(e.to_string()),
        };
        match made {
            Ok(film) => darkroom.deliver(
                Side::A,
                Picture {
                    width: film.width(),
                    height: film.height(),
                    radiances: film.radiances().collect(),
                    spp: None,
                    seconds: start.elapsed().as_secs_f64(),
                    rough: false,
                    order: job.order,
                },
            ),
            Err(fault) => darkroom.report(Side::A, job.order, fault),
        }
    }
}
