//! The thread that path traces: a rough picture at once, then ever more samples, until the wished number or a new job.

use super::darkroom::Darkroom;
use super::{Inbox, Order, Picture, Side};
use crate::technique::TruthSettings;
use pathtrace::Tracer;
use scene::{Camera, Film, Scene};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A picture to make.
#[derive(Debug, Clone)]
pub struct TruthJob {
    /// What is seen.
    pub scene: Arc<Scene>,
    /// From where.
    pub camera: Camera,
    /// How, and how long.
    pub settings: TruthSettings,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// What for.
    pub order: Order,
}

/// A job, and the flag that stops it.
type Commission = (TruthJob, Arc<AtomicBool>);

/// The worker; dropping it ends its thread.
pub struct TruthWorker {
    inbox: Arc<Inbox<Option<Commission>>>,
    /// Stops the job in hand.
    cancel: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Time that a job may go on after a newer one came, if it has not shown anything yet: else a drag would never show
/// anything.
const GRACE: Duration = Duration::from_millis(80);
/// Time that a rough picture may take: with the two frames of the window around it, it shall be on the screen within a
/// tenth of a second.
const ROUGH: Duration = Duration::from_millis(20);
/// Least and most time between two pictures once the resolution is full: an eighth of the time spent so far, because
/// showing costs too, and a picture changes ever less.
const REFRESH: [Duration; 2] = [Duration::from_millis(150), Duration::from_secs(1)];

impl TruthWorker {
    /// Starts the thread and its pool, which leaves one core to the UI.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn start(darkroom: Arc<Darkroom>) -> anyhow::Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(cores.saturating_sub(1).max(1))
            .thread_name(|i| format!("truth {i}"))
            .build()?;
        let inbox = Arc::new(Inbox::default());
        let commissions: Arc<Inbox<Option<Commission>>> = inbox.clone();
        let thread = std::thread::Builder::new().name("truth".into()).spawn(move || {
            let mut painter = Painter { darkroom, tracer: None, seconds_per_sample: 1e-6, begun: Instant::now() };
            while let Some(commission) = commissions.take() {
                if let Some((job, cancel)) = commission {
                    pool.install(|| painter.paint(&job, &cancel));
                }
            }
        })?;
        Ok(TruthWorker { inbox, cancel: Arc::default(), thread: Some(thread) })
    }

    /// Asks for a picture; the one in hand stops at once.
    pub fn submit(&mut self, job: TruthJob) {
        self.cancel.store(true, Ordering::Relaxed);
        self.cancel = Arc::default();
        let cancel = self.cancel.clone();
        self.inbox.post(|slot| *slot = Some((job, cancel)));
    }
}

impl Drop for TruthWorker {
    fn drop(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
        self.inbox.close();
        if let Some(thread) = self.thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}

struct Painter {
    darkroom: Arc<Darkroom>,
    /// The scene of the last job, ready for rays.
    tracer: Option<(Arc<Scene>, Tracer)>,
    /// Measured on the last job: what one sample of one pixel costs on the whole pool.
    seconds_per_sample: f64,
    /// When the job in hand was begun.
    begun: Instant,
}

impl Painter {
    fn paint(&mut self, job: &TruthJob, cancel: &AtomicBool) {
        self.begun = Instant::now();
        let tracer = match self.tracer.take() {
            Some((scene, tracer)) if Arc::ptr_eq(&scene, &job.scene) => tracer,
            _ => Tracer::new(&job.scene),
        };
        self.rough(&tracer, job, cancel);
        self.refine(&tracer, job, cancel);
        self.tracer = Some((job.scene.clone(), tracer));
    }

    /// Pictures of an eighth, a quarter and half the resolution, beginning with the finest that is ready in time.
    fn rough(&mut self, tracer: &Tracer, job: &TruthJob, cancel: &AtomicBool) {
        let pixels = f64::from(job.size.0) * f64::from(job.size.1);
        let budget = ROUGH.as_secs_f64() / self.seconds_per_sample;
        let mut shown = false;
        for shrink in [8, 4, 2] {
            let (pixels, finer) = (pixels / f64::from(shrink * shrink), pixels / f64::from(shrink * shrink / 4));
            if finer <= budget {
                continue;
            }
            let mut film = Film::new(job.size.0.div_ceil(shrink), job.size.1.div_ceil(shrink));
            let samples = ((budget / pixels) as u32).clamp(1, job.settings.spp.min(16));
            let start = Instant::now();
            let (begun, first) = (self.begun, !shown);
            let stop = || cancel.load(Ordering::Relaxed) && !(first && begun.elapsed() < GRACE);
            self.expose(tracer, &mut film, job, samples, &stop);
            if stop() {
                return;
            }
            self.deliver(&film, job, start.elapsed(), true);
            shown = true;
        }
    }

    fn refine(&mut self, tracer: &Tracer, job: &TruthJob, cancel: &AtomicBool) {
        let mut film = Film::new(job.size.0, job.size.1);
        let (mut done, mut spent, mut shown) = (0, Duration::ZERO, Instant::now());
        while done < job.settings.spp {
            let start = Instant::now();
            let per_pass = self.seconds_per_sample * film.pixels().len() as f64;
            let refresh = (spent / 8).clamp(REFRESH[0], REFRESH[1]);
            let fitting = (refresh.as_secs_f64() / per_pass) as u32;
            let samples = fitting.clamp(1, done.max(1)).min(job.settings.spp - done);
            self.expose(tracer, &mut film, job, samples, &|| cancel.load(Ordering::Relaxed));
            if cancel.load(Ordering::Relaxed) {
                return;
            }
            done += samples;
            spent += start.elapsed();
            if done == samples || done == job.settings.spp || shown.elapsed() >= refresh {
                self.deliver(&film, job, spent, false);
                shown = Instant::now();
            }
        }
    }

    fn expose(
        &mut self,
        tracer: &Tracer,
        film: &mut Film,
        job: &TruthJob,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) {
        let start = Instant::now();
        let stats = tracer.render(film, &job.camera, &job.settings.path, samples, stop);
        if stats.samples > 1000 {
            self.seconds_per_sample = start.elapsed().as_secs_f64() / stats.samples as f64;
        }
    }

    fn deliver(&self, film: &Film, job: &TruthJob, spent: Duration, rough: bool) {
        self.darkroom.deliver(
            Side::B,
            Picture {
                width: film.width(),
                height: film.height(),
                radiances: film.radiances().collect(),
                spp: Some(film.samples_per_pixel()),
                seconds: spent.as_secs_f64(),
                rough,
                order: job.order.clone(),
            },
        );
    }
}
