//! The thread that traces rays for one pane. Its [`ProgressiveRenderer`] makes one job's picture after the other; the
//! last films are kept: a job that differs only in the wished number goes on where one of them stopped, and a view that
//! was left for a moment is there again.

use super::post_process::PostProcess;
use super::progressive::{ProgressiveRenderer, same_picture};
use super::{Inbox, Job, step_back};
use crate::model::PaneId;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use technique::{Adapters, TracedSettings};

/// A picture to make.
pub type RayJob = Job<TracedSettings>;

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

impl RayWorker {
    /// Starts the thread and its pool, which leaves one core to the UI. `adapters` can trace rays too.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn start(side: PaneId, adapters: Adapters, post_process: Arc<PostProcess>) -> anyhow::Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(cores.saturating_sub(1).max(1))
            .thread_name(move |i| format!("rays {side:?} {i}"))
            .start_handler(|_| step_back())
            .build()?;
        let inbox = Arc::new(Inbox::default());
        let gate = Arc::new(Gate::default());
        let thread = std::thread::Builder::new().name(format!("rays {side:?}")).spawn({
            let commissions: Arc<Inbox<Option<Commission>>> = inbox.clone();
            let gate = gate.clone();
            move || {
                let new_painter =
                    || ProgressiveRenderer::new(side, adapters.clone(), post_process.clone(), gate.clone());
                let mut renderer = new_painter();
                while let Some(commission) = commissions.take() {
                    let Some((job, cancel)) = commission else { continue };
                    let stop = Stop { cancel: &cancel, newer: &|| commissions.has_fresh() };
                    // a fault of ours, or of a driver's: the pane says so, and the next job begins anew
                    let rendered = catch_unwind(AssertUnwindSafe(|| pool.install(|| renderer.render_job(&job, &stop))));
                    if rendered.is_err() {
                        post_process.report(side, job.order, "the renderer stopped at a fault of its own".into());
                        // what it held may fail once more while it goes
                        drop(catch_unwind(AssertUnwindSafe(|| renderer = new_painter())));
                    }
                }
            }
        })?;
        Ok(RayWorker { inbox, cancel: Arc::default(), last: None, gate, thread: Some(thread) })
    }

    /// Asks for a picture. The one in hand stops at once, or after its pass if it only shall have more or fewer
    /// samples.
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
