//! The thread that rasterises. Where a picture takes long, a rough one comes first, so that the fake follows the mouse
//! too.

use super::post_process::PostProcess;
use super::worker::{Control, Service, Worker};
use super::{FAULT, Job, Order, Picture, step_back};
use crate::model::{Compiling, Drawing, Effort, PaneId};
use film::Film;
use gpu::FaultInjection;
use gpu::{Gpu, GpuError};
use raster::{Raster, RasterError, Repairs};
use std::sync::Arc;
use std::time::{Duration, Instant};
use technique::{FakeSettings, Threads};

/// A picture to make.
pub type FakeJob = Job<FakeSettings>;

/// A picture that takes longer than this is preceded by a rough one.
const PATIENCE: Duration = Duration::from_millis(30);

/// What is asked for.
enum Task {
    Draw(FakeJob),
    /// The last picture once more, for its time alone.
    MeasureAgain,
}

/// The worker; dropping it ends its thread.
pub struct FakeWorker(Worker<Option<Task>>);

impl FakeWorker {
    /// Starts the thread; `window` is the window's device, and `threads` are those that trace beside it.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(
        pane: PaneId,
        window: Gpu,
        threads: Arc<Threads>,
        post_process: Arc<PostProcess>,
    ) -> std::io::Result<Self> {
        let service = move || Fakes {
            pane,
            threads,
            stage: Stage::on(device_beside(&window)),
            fault: FaultInjection::of_fakes(),
            seconds_per_pixel: 0.0,
            repairs: Repairs::NONE,
            post_process,
            order: None,
            drawn: None,
        };
        Worker::start(&format!("fake {pane:?}"), Arc::new(|| ()), service).map(FakeWorker)
    }

    /// Asks for a picture; one that was not begun yet is dropped.
    pub fn submit(&self, job: FakeJob) {
        self.0.post(|slot| *slot = Some(Task::Draw(job)));
    }

    /// Asks for the last picture once more, because the machine rests now: its time is then that of the fake alone.
    pub fn measure_again(&self) {
        self.0.post(|slot| *slot = Some(Task::MeasureAgain));
    }

    /// Drops what was not begun yet.
    pub fn cancel(&self) {
        self.0.post(|slot| *slot = None);
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
    /// Seconds that its pipelines have taken so far.
    compiling: f64,
}

impl Stage {
    fn on(gpu: Result<Gpu, GpuError>) -> Result<Self, String> {
        let gpu = gpu.map_err(|fault| fault.to_string())?;
        let start = Instant::now();
        let raster = Raster::new(&gpu).map_err(|fault| fault.to_string())?;
        Ok(Stage { adapter: gpu.describe().into(), gpu, raster, compiling: start.elapsed().as_secs_f64() })
    }
}

/// Draws fakes for one pane.
struct Fakes {
    threads: Arc<Threads>,
    pane: PaneId,
    stage: Result<Stage, String>,
    fault: Option<FaultInjection>,
    seconds_per_pixel: f64,
    /// Those that this is the time of.
    repairs: Repairs,
    post_process: Arc<PostProcess>,
    /// Of the job in hand, or the last one.
    order: Option<Order>,
    /// The last whole picture, until it is measured again.
    drawn: Option<Drawn>,
}

/// A picture that was drawn, and how.
struct Drawn {
    job: FakeJob,
    seconds: f64,
    kept_maps: bool,
}

impl Service for Fakes {
    type Job = Option<Task>;
    type Update = ();

    fn serve(&mut self, task: Option<Task>, control: &Control<Option<Task>, ()>) {
        match task {
            Some(Task::Draw(job)) => self.draw(job, control),
            Some(Task::MeasureAgain) => self.measure_again(),
            None => {}
        }
    }

    fn recover(&mut self, _control: &Control<Option<Task>, ()>) {
        if let Some(order) = self.order.take() {
            self.post_process.report(self.pane, order, FAULT.into());
        }
        self.stage = Stage::on(Gpu::headless());
    }
}

impl Fakes {
    fn draw(&mut self, job: FakeJob, control: &Control<Option<Task>, ()>) {
        (self.order, self.drawn) = (Some(job.order.clone()), None);
        if let (Some(fault), Ok(stage)) = (&self.fault, &self.stage) {
            fault.count(&stage.gpu);
        }
        self.replace_lost_device();
        let stage = match &mut self.stage {
            Ok(stage) => stage,
            Err(fault) => return self.post_process.report(self.pane, job.order, fault.clone()),
        };
        let (width, height) = job.order.size();
        let pixels = f64::from(width) * f64::from(height);
        let expected = self.seconds_per_pixel * pixels;
        // how long repairs take is not known before, but that a processor takes long for them is
        let unknown = self.repairs != job.settings.repairs && stage.gpu.is_software();
        self.repairs = job.settings.repairs;
        let shrink = if unknown || expected > 4.0 * PATIENCE.as_secs_f64() { 4 } else { 2 };
        let rough = unknown || expected > PATIENCE.as_secs_f64();
        let in_hand = JobInHand { pane: self.pane, post_process: &self.post_process, job: &job, cut: cut(&job) };
        // the first one compiles its pipelines: where the processor plays the device, on a core
        let _spared = (self.seconds_per_pixel == 0.0).then(|| self.threads.spare_a_core());
        if rough {
            in_hand.draw(stage, shrink);
        }
        // a newer job makes the fine picture of this one superfluous
        if (!rough || !control.ends_soon())
            && let Some(seconds) = in_hand.draw_and_measure(stage, &|| control.ends_soon())
        {
            self.seconds_per_pixel = seconds / pixels;
            let kept_maps = stage.raster.work().kept_maps;
            self.drawn = Some(Drawn { job, seconds, kept_maps });
        }
    }

    /// Draws the last picture as before and delivers it with the shorter of its times: what else ran may have slowed the
    /// first one, and nothing makes it faster than it is.
    fn measure_again(&mut self) {
        let Some(Drawn { job, seconds, kept_maps }) = self.drawn.take() else { return };
        self.replace_lost_device();
        let stage = match &mut self.stage {
            Ok(stage) => stage,
            Err(fault) => return self.post_process.report(self.pane, job.order, fault.clone()),
        };
        if !kept_maps {
            stage.raster.forget_maps();
        }
        let in_hand = JobInHand { pane: self.pane, post_process: &self.post_process, job: &job, cut: cut(&job) };
        let start = Instant::now();
        if let Some(film) = in_hand.film(stage, 1) {
            let seconds = start.elapsed().as_secs_f64().min(seconds);
            in_hand.deliver(stage, film, Timing { seconds, shrink: 1, at_rest: true });
        }
    }

    /// A device that was lost stays so: the next picture gets another.
    fn replace_lost_device(&mut self) {
        if self.stage.as_ref().is_ok_and(|stage| stage.gpu.fault().is_some()) {
            self.stage = Stage::on(Gpu::headless());
        }
    }
}

/// How long a picture took, and under which conditions.
struct Timing {
    seconds: f64,
    shrink: u32,
    at_rest: bool,
}

/// A job in hand, and who waits for its pictures.
struct JobInHand<'a> {
    pane: PaneId,
    post_process: &'a PostProcess,
    job: &'a FakeJob,
    cut: Option<Arc<str>>,
}

impl JobInHand<'_> {
    /// Draws the whole picture, and once more if pipelines were compiled for it: only then is its time that of the next
    /// one too. Returns the seconds of the last drawing; `None` if there is none.
    fn draw_and_measure(&self, stage: &mut Stage, ends_soon: &impl Fn() -> bool) -> Option<f64> {
        let cold = self.draw(stage, 1)?;
        if !stage.raster.work().compiled || ends_soon() {
            return Some(cold);
        }
        // as the first one
        stage.raster.forget_maps();
        let start = Instant::now();
        let film = self.film(stage, 1)?;
        // what else runs may slow either of them, and nothing makes one faster than it is
        let warm = start.elapsed().as_secs_f64().min(cold);
        stage.compiling += cold - warm;
        self.deliver(stage, film, Timing { seconds: warm, shrink: 1, at_rest: false });
        Some(warm)
    }

    /// Draws a picture at `1 / shrink` of the size, delivers it, and returns its seconds; or says why there is none.
    fn draw(&self, stage: &mut Stage, shrink: u32) -> Option<f64> {
        let start = Instant::now();
        let film = self.film(stage, shrink)?;
        let seconds = start.elapsed().as_secs_f64();
        self.deliver(stage, film, Timing { seconds, shrink, at_rest: false });
        Some(seconds)
    }

    fn film(&self, stage: &mut Stage, shrink: u32) -> Option<Film> {
        match render(&mut stage.raster, self.job, shrink) {
            Ok(film) => Some(film),
            Err(fault) => {
                self.post_process.report(self.pane, self.job.order.clone(), fault.to_string());
                None
            }
        }
    }

    fn deliver(&self, stage: &Stage, film: Film, Timing { seconds, shrink, at_rest }: Timing) {
        let work = stage.raster.work();
        // another device may have compiled for a picture at rest, whose time is then the one before
        let compiled = work.compiled && !at_rest;
        let compiling = if compiled { Compiling::Included } else { Compiling::Apart(stage.compiling) };
        let picture = Picture {
            image: film.image(),
            external: None,
            before: None,
            lag: None,
            runs: 1,
            spp: None,
            seconds,
            effort: Effort::Drawn(Drawing { compiling, kept_maps: work.kept_maps, at_rest }),
            noisy: false,
            nonfinite: film.nonfinite,
            adapter: stage.adapter.clone(),
            refused: None,
            filter_fault: None,
            cut: self.cut.clone(),
            rough: shrink > 1,
            coarse: false,
            unfinished: shrink > 1 || compiled,
            order: self.job.order.clone(),
        };
        self.post_process.deliver(self.pane, picture);
    }
}

fn cut(job: &FakeJob) -> Option<Arc<str>> {
    let (width, height) = job.order.size();
    let cut = raster::cut(job.order.scene(), job.order.camera(), &job.settings.sized(width, height))?;
    Some(cut.to_string().into())
}

fn render(raster: &mut Raster, job: &FakeJob, shrink: u32) -> Result<Film, RasterError> {
    let (width, height) = job.order.size();
    let settings = job.settings.sized(width.div_ceil(shrink), height.div_ceil(shrink));
    raster.render(&job.settings.applied_to(job.order.scene()), job.order.camera(), &settings)
}
