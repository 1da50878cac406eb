//! The thread that rasterises. Where a picture takes long, a rough one comes first, so that the fake follows the mouse
//! too.

use super::post_process::PostProcess;
use super::{Inbox, Job, Picture, step_back};
use crate::model::PaneId;
use film::Film;
use gpu::FaultInjection;
use gpu::{Gpu, GpuError};
use raster::{Raster, RasterError};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use technique::FakeSettings;

/// A picture to make.
pub type FakeJob = Job<FakeSettings>;

/// A picture that takes longer than this is preceded by a rough one.
const PATIENCE: Duration = Duration::from_millis(30);

/// The worker; dropping it ends its thread.
pub struct FakeWorker {
    inbox: Arc<Inbox<Option<FakeJob>>>,
    thread: Option<JoinHandle<()>>,
}

impl FakeWorker {
    /// Starts the thread; `window` is the window's device.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(side: PaneId, window: Gpu, post_process: Arc<PostProcess>) -> std::io::Result<Self> {
        let inbox = Arc::new(Inbox::default());
        let jobs = inbox.clone();
        let thread = std::thread::Builder::new()
            .name(format!("fake {side:?}"))
            .spawn(move || work(side, &window, &jobs, &post_process))?;
        Ok(FakeWorker { inbox, thread: Some(thread) })
    }

    /// Asks for a picture; one that was not begun yet is dropped.
    pub fn submit(&self, job: FakeJob) {
        self.inbox.post(|slot| *slot = Some(job));
    }

    /// Drops what was not begun yet.
    pub fn cancel(&self) {
        self.inbox.post(|slot| *slot = None);
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

/// The window's own device; but where the processor plays that another one, because there a frame of the window would
/// wait in one queue behind the whole of the fake.
fn device_beside(window: &Gpu) -> Result<Gpu, GpuError> {
    if !window.is_software() {
        return Ok(window.clone());
    }
    step_back();
    Gpu::headless()
}

/// What a fake is drawn on.
struct Stage {
    gpu: Gpu,
    raster: Raster,
    adapter: Arc<str>,
}

impl Stage {
    fn on(gpu: Result<Gpu, GpuError>) -> Result<Self, String> {
        let gpu = gpu.map_err(|fault| fault.to_string())?;
        let raster = Raster::new(&gpu).map_err(|fault| fault.to_string())?;
        Ok(Stage { adapter: gpu.describe().into(), gpu, raster })
    }
}

fn work(side: PaneId, window: &Gpu, jobs: &Inbox<Option<FakeJob>>, post_process: &PostProcess) {
    let mut stage = Stage::on(device_beside(window));
    let fault = FaultInjection::of_fakes();
    let mut seconds_per_pixel = 0.0;
    while let Some(job) = jobs.take() {
        let Some(job) = job else { continue };
        if let (Some(fault), Ok(stage)) = (&fault, &stage) {
            fault.count(&stage.gpu);
        }
        // a device that was lost stays so: the next picture gets another
        if stage.as_ref().is_ok_and(|stage| stage.gpu.fault().is_some()) {
            stage = Stage::on(Gpu::headless());
        }
        let Stage { gpu: _, raster, adapter } = match &mut stage {
            Ok(stage) => stage,
            Err(fault) => {
                post_process.report(side, job.order, fault.clone());
                continue;
            }
        };
        let (width, height) = job.order.size();
        let expected = seconds_per_pixel * f64::from(width) * f64::from(height);
        let shrink = if expected > 4.0 * PATIENCE.as_secs_f64() { 4 } else { 2 };
        let rough = expected > PATIENCE.as_secs_f64();
        if rough {
            render_job(side, raster, post_process, &job, shrink, adapter);
        }
        // a newer job makes the fine picture of this one superfluous
        if !rough || !jobs.has_fresh() {
            let start = Instant::now();
            render_job(side, raster, post_process, &job, 1, adapter);
            seconds_per_pixel = start.elapsed().as_secs_f64() / (f64::from(width) * f64::from(height));
        }
    }
}

/// Makes one picture at `1 / shrink` of the size and delivers it, or why there is none.
fn render_job(
    side: PaneId,
    raster: &mut Raster,
    post_process: &PostProcess,
    job: &FakeJob,
    shrink: u32,
    adapter: &Arc<str>,
) {
    let start = Instant::now();
    match render(raster, job, shrink) {
        Ok(film) => post_process.deliver(
            side,
            Picture {
                image: film.image(),
                spp: None,
                seconds: start.elapsed().as_secs_f64(),
                nonfinite: film.nonfinite,
                adapter: adapter.clone(),
                refused: None,
                rough: shrink > 1,
                unfinished: shrink > 1,
                order: job.order.clone(),
            },
        ),
        Err(fault) => post_process.report(side, job.order.clone(), fault.to_string()),
    }
}

fn render(raster: &mut Raster, job: &FakeJob, shrink: u32) -> Result<Film, RasterError> {
    let (width, height) = job.order.size();
    let settings = job.settings.sized(width.div_ceil(shrink), height.div_ceil(shrink));
    raster.render(&job.settings.applied_to(job.order.scene()), job.order.camera(), &settings)
}
