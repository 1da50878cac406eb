//! A thread beside the UI that serves one job after the other. A newer job replaces one that was not begun; the one in hand
//! can be cancelled, or held where it is. A panic ends its job and not the thread.

use super::Wake;
use super::mailbox::Mailbox;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// What a worker's thread does with jobs.
pub trait Service {
    /// What is asked for; the default asks for nothing.
    type Job: Default + Send + 'static;
    /// What the thread reports back while it serves a job.
    type Update: Default + Send + 'static;

    /// Does one job, as far as `control` lets it.
    fn serve(&mut self, job: Self::Job, control: &Control<Self::Job, Self::Update>);

    /// A fault of ours, or of a driver's, has ended the last job: says so, and makes ready for the next.
    fn recover(&mut self, control: &Control<Self::Job, Self::Update>);
}

/// A thread and what is posted to it. Dropping it ends the thread.
pub struct Worker<Job, Update = ()> {
    shared: Arc<Shared<Job, Update>>,
    /// Cancels what was posted last.
    cancel: Mutex<Arc<AtomicBool>>,
    thread: Mutex<Option<JoinHandle<()>>>,
}

struct Shared<Job, Update> {
    jobs: Mailbox<Posted<Job>>,
    updates: Mailbox<Update>,
    gate: Gate,
    wake: Wake,
}

/// A job, and the flag that cancels it.
#[derive(Default)]
struct Posted<Job> {
    job: Job,
    cancel: Arc<AtomicBool>,
}

/// How the job in hand goes on, and where it tells what comes of it.
pub struct Control<Job, Update> {
    shared: Arc<Shared<Job, Update>>,
    cancel: Arc<AtomicBool>,
}

impl<Job: Default + Send + 'static, Update: Default + Send + 'static> Worker<Job, Update> {
    /// Starts a thread of this name, on which `service` is made. `wake` is called whenever [`Worker::collect`] has
    /// something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start<S: Service<Job = Job, Update = Update>>(
        name: &str,
        wake: Wake,
        service: impl FnOnce() -> S + Send + 'static,
    ) -> std::io::Result<Self> {
        let (jobs, updates, gate) = (Mailbox::default(), Mailbox::default(), Gate::default());
        let shared = Arc::new(Shared { jobs, updates, gate, wake });
        let thread = std::thread::Builder::new().name(name.to_owned()).spawn({
            let shared = shared.clone();
            move || work(&mut service(), shared)
        })?;
        Ok(Worker { shared, cancel: Mutex::default(), thread: Mutex::new(Some(thread)) })
    }

    /// Changes what is asked for and was not begun.
    pub fn post(&self, change: impl FnOnce(&mut Job)) {
        let cancel = self.cancel.lock().unwrap_or_else(PoisonError::into_inner).clone();
        self.shared.jobs.post(|posted| {
            change(&mut posted.job);
            posted.cancel = cancel;
        });
        self.shared.gate.look_again();
    }

    /// Ends the job in hand, and drops what was not begun.
    pub fn cancel(&self) {
        let cancelled = std::mem::take(&mut *self.cancel.lock().unwrap_or_else(PoisonError::into_inner));
        cancelled.store(true, Ordering::Relaxed);
        self.post(|job| *job = Job::default());
    }

    /// Holds the job in hand where it is, or lets it go on.
    pub fn hold(&self, held: bool) {
        self.shared.gate.hold(held);
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<Update> {
        self.shared.updates.take_now()
    }

    /// Waits until the thread has ended, after the job in hand.
    pub fn close(&self) {
        self.shared.jobs.close();
        self.join();
    }

    /// Waits until the thread has ended, after all that it was asked for.
    pub fn close_when_done(&self) {
        self.shared.jobs.close_when_empty();
        self.join();
    }

    /// Lets the thread end by itself; what it tells is not heard.
    pub fn leave(self) {
        self.shared.jobs.close_when_empty();
        self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
    }

    fn join(&self) {
        self.shared.gate.look_again();
        let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(thread) = thread {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}

impl<Job, Update> Drop for Worker<Job, Update> {
    fn drop(&mut self) {
        let thread = self.thread.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(thread) = thread {
            self.cancel.get_mut().unwrap_or_else(PoisonError::into_inner).store(true, Ordering::Relaxed);
            self.shared.jobs.close();
            self.shared.gate.look_again();
            // as above
            let _ = thread.join();
        }
    }
}

fn work<S: Service>(service: &mut S, shared: Arc<Shared<S::Job, S::Update>>) {
    let mut control = Control { shared: shared.clone(), cancel: Arc::default() };
    while let Some(Posted { job, cancel }) = shared.jobs.take() {
        control.cancel = cancel;
        let served = catch_unwind(AssertUnwindSafe(|| service.serve(job, &control)));
        if served.is_err() {
            // what it held may fail once more while it goes
            drop(catch_unwind(AssertUnwindSafe(|| service.recover(&control))));
        }
    }
}

impl<Job: Default, Update: Default> Control<Job, Update> {
    /// Whether the job in hand shall end at once.
    pub fn ends_now(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// Whether it shall end soon: it is cancelled, or something newer was posted.
    pub fn ends_soon(&self) -> bool {
        self.ends_now() || self.shared.jobs.has_fresh()
    }

    /// Whether it shall wait where it is.
    pub fn is_held(&self) -> bool {
        self.shared.gate.is_held()
    }

    /// Waits until it is held no more, or shall end soon.
    pub fn wait(&self) {
        self.shared.gate.pass(|| self.ends_soon());
    }

    /// Waits so long, or until it shall end soon.
    pub fn rest(&self, time: Duration) {
        self.shared.gate.rest(time, || self.ends_soon());
    }

    /// Changes what is collected, and wakes the UI thread.
    pub fn tell(&self, change: impl FnOnce(&mut Update)) {
        self.shared.updates.post(change);
        (self.shared.wake)();
    }
}

/// Where a worker waits while it is held.
#[derive(Default)]
struct Gate {
    /// Read before every segment of a path, so without the lock.
    held: AtomicBool,
    lock: Mutex<()>,
    changed: Condvar,
}

impl Gate {
    fn hold(&self, held: bool) {
        if self.held.swap(held, Ordering::Relaxed) != held {
            self.look_again();
        }
    }

    fn is_held(&self) -> bool {
        self.held.load(Ordering::Relaxed)
    }

    fn look_again(&self) {
        // under the lock, so that nobody is between looking and waiting
        let _guard = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
        self.changed.notify_all();
    }

    /// Waits until the gate is open or `ends` says so.
    fn pass(&self, ends: impl Fn() -> bool) {
        let mut guard = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
        while self.is_held() && !ends() {
            guard = self.changed.wait(guard).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Waits for so long or until `ends` says so.
    fn rest(&self, time: Duration, ends: impl Fn() -> bool) {
        let guard = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
        // a lock that a panic has left behind guards nothing
        drop(self.changed.wait_timeout_while(guard, time, |()| !ends()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    /// Panics at 0, waits to be cancelled at 1, waits to be let go at 2, and tells what it has served.
    struct Numbers;

    impl Service for Numbers {
        type Job = Option<u32>;
        type Update = Vec<u32>;

        fn serve(&mut self, job: Option<u32>, control: &Control<Option<u32>, Vec<u32>>) {
            let Some(number) = job else { return };
            assert!(number > 0, "on purpose");
            while number == 1 && !control.ends_now() {
                std::thread::yield_now();
            }
            if number == 2 {
                control.wait();
            }
            control.tell(|served| served.push(number));
        }

        fn recover(&mut self, control: &Control<Option<u32>, Vec<u32>>) {
            control.tell(|served| served.push(99));
        }
    }

    fn worker() -> Worker<Option<u32>, Vec<u32>> {
        Worker::start("numbers", Arc::new(|| ()), || Numbers).unwrap()
    }

    fn collected(worker: &Worker<Option<u32>, Vec<u32>>, count: usize) -> Vec<u32> {
        let (start, mut all) = (Instant::now(), Vec::new());
        while all.len() < count {
            all.extend(worker.collect().unwrap_or_default());
            assert!(start.elapsed() < Duration::from_secs(60), "{all:?}");
            std::thread::yield_now();
        }
        all
    }

    #[test]
    fn a_panic_ends_its_job_and_not_the_thread() {
        let worker = worker();
        worker.post(|job| *job = Some(0));
        assert_eq!(collected(&worker, 1), [99]);
        worker.post(|job| *job = Some(3));
        assert_eq!(collected(&worker, 1), [3]);
    }

    #[test]
    fn cancelling_ends_the_job_in_hand_and_not_the_next() {
        let worker = worker();
        worker.post(|job| *job = Some(1));
        worker.cancel();
        worker.post(|job| *job = Some(1));
        worker.cancel();
        worker.post(|job| *job = Some(3));
        assert_eq!(collected(&worker, 1).last(), Some(&3));
    }

    #[test]
    fn one_that_is_held_goes_on_when_it_is_let_go_and_ends_when_it_is_dropped() {
        let worker = worker();
        worker.hold(true);
        worker.post(|job| *job = Some(2));
        worker.hold(false);
        assert_eq!(collected(&worker, 1), [2]);
        worker.hold(true);
        worker.post(|job| *job = Some(2));
        drop(worker);
    }
}
