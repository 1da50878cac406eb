//! The thread that traces rays for one pane. Its [`ProgressiveRenderer`] makes one job's picture after the other.

use super::post_process::PostProcess;
use super::{Inbox, Job, Order, Picture, step_back};
use crate::model::PaneId;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;
use technique::{Adapters, Frame, Pacing, ProgressiveRenderer, Request, Threads, TracedSettings, Watch};

/// A picture to make.
pub type RayJob = Job<TracedSettings>;

/// A job, and the flag that stops it.
type Commission = (RayJob, Arc<AtomicBool>);

/// Least and most time between two pictures once the resolution is full: an eighth of the time spent so far, because
/// showing costs too, and a picture changes ever less.
const REFRESH: [Duration; 2] = [Duration::from_millis(150), Duration::from_secs(1)];

/// The worker; dropping it ends its thread.
pub struct RayWorker {
    inbox: Arc<Inbox<Option<Commission>>>,
    /// Stops the job in hand.
    cancel: Arc<AtomicBool>,
    /// The job in hand, or the last one.
    last: Option<Request>,
    gate: Arc<Gate>,
    thread: Option<JoinHandle<()>>,
}

impl RayWorker {
    /// Starts the thread, which traces on `threads` or by one of `adapters`.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(
        side: PaneId,
        (adapters, threads): (Adapters, Arc<Threads>),
        post_process: Arc<PostProcess>,
    ) -> std::io::Result<Self> {
        let inbox = Arc::new(Inbox::default());
        let gate = Arc::new(Gate::default());
        let thread = std::thread::Builder::new().name(format!("rays {side:?}")).spawn({
            let commissions: Arc<Inbox<Option<Commission>>> = inbox.clone();
            let gate = gate.clone();
            move || {
                step_back();
                let new_renderer = || ProgressiveRenderer::new(adapters.clone(), threads.clone());
                let mut renderer = new_renderer();
                while let Some(commission) = commissions.take() {
                    let Some((job, cancel)) = commission else { continue };
                    let stop = Stop { cancel: &cancel, newer: &|| commissions.has_fresh() };
                    let pane = Pane { side, order: &job.order, stop, gate: &gate, post_process: &post_process };
                    // a fault of ours, or of a driver's: the pane says so, and the next job begins anew
                    let rendered = catch_unwind(AssertUnwindSafe(|| renderer.render(&request_of(&job), &pane)));
                    match rendered {
                        Ok(Ok(())) => {}
                        Ok(Err(_)) => {
                            let (width, height) = job.order.size();
                            let fault =
                                format!("not enough memory for {width} x {height} pixels; make the window smaller");
                            post_process.report(side, job.order, fault);
                        }
                        Err(_) => {
                            post_process.report(side, job.order, "the renderer stopped at a fault of its own".into());
                            // what it held may fail once more while it goes
                            drop(catch_unwind(AssertUnwindSafe(|| renderer = new_renderer())));
                        }
                    }
                }
            }
        })?;
        Ok(RayWorker { inbox, cancel: Arc::default(), last: None, gate, thread: Some(thread) })
    }

    /// Asks for a picture. The one in hand stops at once, or after its pass if it only shall have more or fewer
    /// samples.
    pub fn submit(&mut self, job: RayJob) {
        let request = request_of(&job);
        if !self.last.as_ref().is_some_and(|last| last.is_same_picture(&request)) {
            self.cancel();
        }
        self.last = Some(request);
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

fn request_of(job: &RayJob) -> Request {
    let Order { restarts, provenance, .. } = &job.order;
    Request { shot: provenance.shot.clone(), settings: job.settings, restarts: *restarts }
}

/// A pane that waits for a job's pictures.
struct Pane<'a> {
    side: PaneId,
    order: &'a Order,
    stop: Stop<'a>,
    gate: &'a Gate,
    post_process: &'a PostProcess,
}

impl Watch for Pane<'_> {
    fn ends_now(&self) -> bool {
        self.stop.now()
    }

    fn ends_soon(&self, _spp: u32) -> bool {
        self.stop.soon()
    }

    fn is_held(&self) -> bool {
        self.gate.is_held()
    }

    fn wait(&self) {
        self.gate.pass(&self.stop);
    }

    fn pacing(&self, spent: Duration) -> Pacing {
        let refresh = (spent / 8).clamp(REFRESH[0], REFRESH[1]);
        Pacing { pass: refresh, show: refresh, growth: 1 }
    }

    fn show(&self, frame: Frame) {
        let film = frame.film;
        let picture = Picture {
            image: film.image(),
            spp: Some(film.samples_per_pixel()),
            seconds: frame.seconds,
            nonfinite: film.nonfinite,
            adapter: frame.made_by.into(),
            refused: frame.refused,
            rough: frame.rough,
            unfinished: frame.unfinished,
            order: self.order.made_on(frame.device),
        };
        self.post_process.deliver(self.side, picture);
    }
}

/// Where a worker waits while it is held.
#[derive(Default)]
pub struct Gate {
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

    /// Whether there would be anything to wait for.
    pub fn is_held(&self) -> bool {
        *self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until the gate is open or the job shall stop.
    pub fn pass(&self, stop: &Stop) {
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        while *held && !stop.soon() {
            held = self.changed.wait(held).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// When a job ends before it is done.
pub struct Stop<'a> {
    cancel: &'a AtomicBool,
    newer: &'a (dyn Fn() -> bool + Sync),
}

impl Stop<'_> {
    /// At once, in the middle of a sample's pass.
    pub fn now(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// After the pass in hand.
    pub fn soon(&self) -> bool {
        self.now() || (self.newer)()
    }
}
