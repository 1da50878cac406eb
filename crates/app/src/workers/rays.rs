//! The thread that traces rays: a rough picture at once, then ever more samples, until the wished number or a new job. The
//! last films are kept: a job that differs only in the wished number goes on where one of them stopped, and a view that
//! was left for a moment is there again.

use super::darkroom::Darkroom;
use super::{Inbox, Job, Picture, Side};
use crate::technique::RaySettings;
use pathtrace::Tracer;
use scene::{Film, Scene};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A picture to make.
pub type RayJob = Job<RaySettings>;

/// A job, and the flag that stops it.
type Commission = (RayJob, Arc<AtomicBool>);

/// The worker; dropping it ends its thread.
pub struct RayWorker {
    inbox: Arc<Inbox<Option<Commission>>>,
    /// Stops the job in hand.
    cancel: Arc<AtomicBool>,
    /// The job in hand, or the last one.
    last: Option<RayJob>,
    gate: Arc<Gate>,
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

/// Films that are kept beside the one in hand: one to come back to.
const MOST_KEPT: usize = 2;

impl RayWorker {
    /// Starts the thread and its pool, which leaves one core to the UI.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn start(side: Side, darkroom: Arc<Darkroom>) -> anyhow::Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(cores.saturating_sub(1).max(1))
            .thread_name(move |i| format!("rays {side:?} {i}"))
            .build()?;
        let inbox = Arc::new(Inbox::default());
        let gate = Arc::new(Gate::default());
        let thread = std::thread::Builder::new().name(format!("rays {side:?}")).spawn({
            let commissions: Arc<Inbox<Option<Commission>>> = inbox.clone();
            let gate = gate.clone();
            move || {
                let mut painter = Painter {
                    side,
                    darkroom,
                    gate,
                    adapter: format!("{} threads", pool.current_num_threads()).into(),
                    tracer: None,
                    kept: Vec::new(),
                    seconds_per_sample: 1e-6,
                    begun: Instant::now(),
                };
                while let Some(commission) = commissions.take() {
                    if let Some((job, cancel)) = commission {
                        let stop = Stop { cancel: &cancel, newer: &|| commissions.has_fresh() };
                        pool.install(|| painter.paint(&job, &stop));
                    }
                }
            }
        })?;
        Ok(RayWorker { inbox, cancel: Arc::default(), last: None, gate, thread: Some(thread) })
    }

    /// Asks for a picture. The one in hand stops at once, or after its pass if it only shall have more or fewer samples.
    pub fn submit(&mut self, job: RayJob) {
        if !self.last.as_ref().is_some_and(|last| same_picture(last, &job)) {
            self.cancel();
        }
        self.last = Some(job.clone());
        let cancel = self.cancel.clone();
        self.inbox.post(|slot| *slot = Some((job, cancel)));
        self.gate.look_again();
    }

    /// Stops the picture in hand.
    pub fn cancel(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
        self.cancel = Arc::default();
        self.last = None;
        self.inbox.post(|slot| *slot = None);
        self.gate.look_again();
    }

    /// Holds the picture where it is, or lets it go on. While held, a new job still shows its first full picture.
    pub fn hold(&self, held: bool) {
        self.gate.hold(held);
    }
}

impl Drop for RayWorker {
    fn drop(&mut self) {
        self.cancel();
        self.inbox.close();
        if let Some(thread) = self.thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}

/// Where a worker waits while it is held.
#[derive(Default)]
struct Gate {
    held: Mutex<bool>,
    changed: Condvar,
}

impl Gate {
    fn hold(&self, held: bool) {
        *self.held.lock().unwrap_or_else(PoisonError::into_inner) = held;
        self.changed.notify_all();
    }

    fn look_again(&self) {
        // under the lock, so that nobody is between looking and waiting
        let _held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        self.changed.notify_all();
    }

    /// Waits until the gate is open or the job shall stop; `before` runs once if there is anything to wait for.
    fn pass(&self, stop: &Stop, before: impl FnOnce()) {
        let mut before = Some(before);
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        while *held && !stop.soon() {
            if let Some(before) = before.take() {
                before();
            }
            held = self.changed.wait(held).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// When a job ends before it is done.
struct Stop<'a> {
    cancel: &'a AtomicBool,
    newer: &'a (dyn Fn() -> bool + Sync),
}

impl Stop<'_> {
    /// At once, in the middle of a sample's pass.
    fn now(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// After the pass in hand.
    fn soon(&self) -> bool {
        self.now() || (self.newer)()
    }
}

/// A film and what has gone into it.
struct Exposed {
    film: Film,
    /// Samples that every pixel has.
    spp: u32,
    spent: Duration,
    /// The job it belongs to; its wished number of samples may grow.
    job: RayJob,
}

struct Painter {
    side: Side,
    darkroom: Arc<Darkroom>,
    gate: Arc<Gate>,
    /// How many threads there are, in words.
    adapter: Arc<str>,
    /// The scene of the last job, ready for rays.
    tracer: Option<(Arc<Scene>, Tracer)>,
    /// The films of the last jobs, the latest last.
    kept: Vec<Exposed>,
    /// Measured on the last job: what one sample of one pixel costs on the whole pool.
    seconds_per_sample: f64,
    /// When the job in hand was begun.
    begun: Instant,
}

impl Painter {
    fn paint(&mut self, job: &RayJob, stop: &Stop) {
        self.begun = Instant::now();
        let tracer = match self.tracer.take() {
            Some((scene, tracer)) if Arc::ptr_eq(&scene, &job.order.scene) => tracer,
            _ => {
                self.kept.clear();
                Tracer::new(&job.order.scene)
            }
        };
        let exposed = match self.best_kept(job) {
            Some(exposed) => Some(Exposed { job: job.clone(), ..exposed }),
            None => {
                self.rough(&tracer, job, stop);
                if stop.now() { None } else { self.blank(job) }
            }
        };
        let exposed = exposed.map(|exposed| self.refine(&tracer, exposed, stop));
        self.kept.extend(exposed.filter(|exposed| exposed.spp > 0));
        if self.kept.len() > MOST_KEPT {
            self.kept.remove(0);
        }
        self.tracer = Some((job.order.scene.clone(), tracer));
    }

    /// The kept film that is nearest to what `job` asks for, of the same picture.
    fn best_kept(&mut self, job: &RayJob) -> Option<Exposed> {
        // a pass that was stopped has left some pixels with more samples than others
        let most = |exposed: &Exposed| exposed.film.pixels().iter().map(|pixel| pixel.samples).max().unwrap_or(0);
        let serves = |exposed: &Exposed| same_picture(&exposed.job, job) && most(exposed) <= job.settings.spp;
        let serving = self.kept.iter().enumerate().filter(|(_, exposed)| serves(exposed));
        let (index, _) = serving.max_by_key(|(_, exposed)| exposed.spp)?;
        Some(self.kept.remove(index))
    }

    /// A film without light, or a word that there is no memory for it.
    fn blank(&self, job: &RayJob) -> Option<Exposed> {
        let (width, height) = job.order.size();
        let film = Film::try_new(width, height);
        if film.is_none() {
            let fault = format!("not enough memory for {width} x {height} pixels; make the window smaller");
            self.darkroom.report(self.side, job.order.clone(), fault);
        }
        film.map(|film| Exposed { film, spp: 0, spent: Duration::ZERO, job: job.clone() })
    }

    /// Pictures of an eighth, a quarter and half the resolution, beginning with the finest that is ready in time.
    fn rough(&mut self, tracer: &Tracer, job: &RayJob, stop: &Stop) {
        let (width, height) = job.order.size();
        let pixels = f64::from(width) * f64::from(height);
        let budget = ROUGH.as_secs_f64() / self.seconds_per_sample;
        let mut shown = false;
        for shrink in [8, 4, 2] {
            let (pixels, finer) = (pixels / f64::from(shrink * shrink), pixels / f64::from(shrink * shrink / 4));
            if finer <= budget {
                continue;
            }
            let mut film = Film::new(width.div_ceil(shrink), height.div_ceil(shrink));
            let samples = ((budget / pixels) as u32).clamp(1, job.settings.spp.min(16));
            let start = Instant::now();
            let (begun, first) = (self.begun, !shown);
            let stop = || stop.now() && !(first && begun.elapsed() < GRACE);
            self.expose(tracer, &mut film, job, samples, &stop);
            if stop() {
                return;
            }
            self.deliver(&film, job, start.elapsed(), [true, true]);
            shown = true;
        }
    }

    /// Adds samples up to the wished number, or as many as there is time for. A pass that was stopped in the middle is
    /// completed by the next one.
    fn refine(&mut self, tracer: &Tracer, mut exposed: Exposed, stop: &Stop) -> Exposed {
        let wished = exposed.job.settings.spp;
        let mut shown = Instant::now();
        // a film that goes on is shown at once, for the label says how far it shall go
        if exposed.spp > 0 {
            self.show(&exposed);
        }
        while exposed.spp < wished {
            // while held, a new picture still gets its first pass
            if exposed.spp > 0 {
                self.gate.pass(stop, || self.show(&exposed));
            }
            if stop.soon() {
                break;
            }
            let start = Instant::now();
            let per_pass = self.seconds_per_sample * exposed.film.pixels().len() as f64;
            let refresh = (exposed.spent / 8).clamp(REFRESH[0], REFRESH[1]);
            let fitting = (refresh.as_secs_f64() / per_pass) as u32;
            let samples = fitting.clamp(1, exposed.spp.max(1)).min(wished - exposed.spp);
            let Exposed { film, job, .. } = &mut exposed;
            self.expose(tracer, film, job, samples, &|| stop.now());
            if stop.now() {
                break;
            }
            exposed.spp += samples;
            exposed.spent += start.elapsed();
            if exposed.spp == samples || exposed.spp == wished || shown.elapsed() >= refresh {
                self.show(&exposed);
                shown = Instant::now();
            }
        }
        exposed
    }

    fn expose(
        &mut self,
        tracer: &Tracer,
        film: &mut Film,
        job: &RayJob,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) {
        let start = Instant::now();
        let stats = job.settings.render(tracer, film, job.order.camera(), samples, stop);
        if stats.samples > 1000 {
            self.seconds_per_sample = start.elapsed().as_secs_f64() / stats.samples as f64;
        }
    }

    fn show(&self, exposed: &Exposed) {
        let unfinished = exposed.spp < exposed.job.settings.spp;
        self.deliver(&exposed.film, &exposed.job, exposed.spent, [false, unfinished]);
    }

    fn deliver(&self, film: &Film, job: &RayJob, spent: Duration, [rough, unfinished]: [bool; 2]) {
        self.darkroom.deliver(
            self.side,
            Picture {
                width: film.width(),
                height: film.height(),
                radiances: film.radiances().collect(),
                spp: Some(film.samples_per_pixel()),
                seconds: spent.as_secs_f64(),
                nonfinite: film.nonfinite,
                adapter: self.adapter.clone(),
                rough,
                unfinished,
                order: job.order.clone(),
            },
        );
    }
}

/// Whether two jobs differ in the wished number of samples alone.
fn same_picture(a: &RayJob, b: &RayJob) -> bool {
    let ((of_a, a), (of_b, b)) = ((&a.settings.method, &a.order), (&b.settings.method, &b.order));
    of_a == of_b
        && Arc::ptr_eq(&a.scene, &b.scene)
        && (a.camera(), a.size(), a.restarts) == (b.camera(), b.size(), b.restarts)
}
