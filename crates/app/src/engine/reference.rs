//! The thread that makes the reference of what is seen: from the store at once if it is there, else picture by picture,
//! while the panes are at rest, for they have priority. It keeps what it has made: when it is good enough, after each
//! doubling, and when something else is asked for or the window closes.

use super::post_process::PostProcess;
use super::{Inbox, Wake, step_back};
use crate::model::{Origin, Progress};
use crate::ruler::ReferenceImage;
use pathtrace::{FEWEST_REPLICATES, Tracer};
use reference::{Goal, Key, Maker, Reference, Store};
use scene::Scene;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use technique::Shot;

/// A reference to come by.
#[derive(Debug, Clone)]
pub struct Wish {
    /// Counts views as [`super::Order::view`] does.
    pub view: u64,
    /// What it shall show.
    pub shot: Shot,
    /// Where from.
    pub origin: Origin,
}

/// What the UI collects: the latest progress, and what went wrong, a line each.
#[derive(Debug, Default)]
pub struct ReferenceUpdate {
    /// How far it has come.
    pub progress: Option<Progress>,
    /// Lines for the user.
    pub faults: Vec<String>,
}

/// The worker; dropping it ends its thread once what it has made is kept.
pub struct ReferenceWorker {
    inbox: Arc<Inbox<Option<Commission>>>,
    update: Arc<Inbox<ReferenceUpdate>>,
    gate: Arc<Gate>,
    /// Stops the reference in hand.
    cancel: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// A wish, and the flag that stops it.
type Commission = (Wish, Arc<AtomicBool>);

impl ReferenceWorker {
    /// Starts the thread and its pool, which leaves one core to the UI; `wake` is called whenever
    /// [`ReferenceWorker::update`] has something.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn start(post_process: Arc<PostProcess>, wake: Wake) -> anyhow::Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = cores.saturating_sub(1).max(1);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("reference_worker {i}"))
            .start_handler(|_| step_back())
            .build()?;
        let inbox = Arc::new(Inbox::<Option<Commission>>::default());
        let (update, gate) = (Arc::new(Inbox::default()), Arc::new(Gate::default()));
        let mut bench = Bench { post_process, wake, update: update.clone(), gate: gate.clone(), tracer: None };
        let thread = std::thread::Builder::new().name("reference_worker".into()).spawn({
            let commissions = inbox.clone();
            move || {
                while let Some(commission) = commissions.take() {
                    if let Some((wish, cancel)) = commission {
                        pool.install(|| bench.serve(&wish, &cancel));
                    }
                }
            }
        })?;
        Ok(ReferenceWorker { inbox, update, gate, cancel: Arc::default(), thread: Some(thread) })
    }

    /// Asks for a reference. The one in hand stops at once and is kept.
    pub fn submit(&mut self, wish: Wish) {
        self.cancel();
        let cancel = self.cancel.clone();
        self.inbox.post(|slot| *slot = Some((wish, cancel)));
    }

    /// Stops the one in hand.
    pub fn cancel(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
        self.cancel = Arc::default();
        self.inbox.post(|slot| *slot = None);
        self.gate.look_again();
    }

    /// Holds the work where it is, or lets it go on.
    pub fn hold(&self, held: bool) {
        self.gate.hold(held);
    }

    /// What is new since the last call.
    pub fn update(&self) -> Option<ReferenceUpdate> {
        self.update.take_now()
    }
}

impl Drop for ReferenceWorker {
    fn drop(&mut self) {
        self.cancel();
        self.inbox.close();
        if let Some(thread) = self.thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}

/// Where the work waits while it is held, in the middle of a picture too: what is traced of it is not lost.
#[derive(Default)]
struct Gate {
    /// Read before every sample, so without the lock.
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

    fn look_again(&self) {
        // under the lock, so that nobody is between looking and waiting
        let _guard = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
        self.changed.notify_all();
    }

    /// Waits until the gate is open or the work is cancelled, and returns whether it is.
    fn stops(&self, cancel: &AtomicBool) -> bool {
        if self.held.load(Ordering::Relaxed) {
            let mut guard = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
            while self.held.load(Ordering::Relaxed) && !cancel.load(Ordering::Relaxed) {
                guard = self.changed.wait(guard).unwrap_or_else(PoisonError::into_inner);
            }
        }
        cancel.load(Ordering::Relaxed)
    }
}

/// What the thread works with.
struct Bench {
    post_process: Arc<PostProcess>,
    wake: Wake,
    update: Arc<Inbox<ReferenceUpdate>>,
    gate: Arc<Gate>,
    /// The scene of the last wish, ready for rays.
    tracer: Option<(Arc<Scene>, Tracer)>,
}

impl Bench {
    fn serve(&mut self, wish: &Wish, cancel: &AtomicBool) {
        let Origin::File(file) = &wish.origin else { return self.make(wish, cancel) };
        match load(file, wish.shot.size) {
            Ok(reference) => self.show(wish, &reference, true),
            Err(fault) => {
                self.fail(fault);
                self.make(&Wish { origin: Origin::Made, ..wish.clone() }, cancel);
            }
        }
    }

    fn make(&mut self, wish: &Wish, cancel: &AtomicBool) {
        let key = Key::of(&wish.shot);
        let store = Store::of_the_user().map_err(|fault| self.fail(fault.to_string())).ok();
        let kept = store.as_ref().and_then(|store| store.get(key));
        match &kept {
            Some(kept) => self.show(wish, kept, false),
            None => self.tell(wish, (0, None, 0.0), false),
        }
        let tracer = match self.tracer.take() {
            Some((scene, tracer)) if Arc::ptr_eq(&scene, &wish.shot.scene) => tracer,
            _ => Tracer::new(&wish.shot.scene),
        };
        let mut keeper = Keeper { store, key, wish, kept: kept.as_ref().map_or(0, |kept| kept.replicates) };
        match Maker::new(&tracer, &wish.shot, kept.as_ref()) {
            Some(mut maker) => self.work(&mut maker, &Goal::default(), &mut keeper, cancel),
            None => self.fail("not enough memory for a reference; make the window smaller".into()),
        }
        self.tracer = Some((wish.shot.scene.clone(), tracer));
    }

    fn work(&self, maker: &mut Maker, goal: &Goal, keeper: &mut Keeper, cancel: &AtomicBool) {
        while !maker.is_done(goal) && maker.step(&|| self.gate.stops(cancel)) {
            let reference = maker.reference();
            let done = maker.is_done(goal);
            self.show(keeper.wish, &reference, done);
            if done || reference.replicates >= keeper.next() {
                keeper.keep(&reference).unwrap_or_else(|fault| self.fail(fault));
            }
        }
        let reference = maker.reference();
        if maker.is_done(goal) {
            self.show(keeper.wish, &reference, true);
        }
        keeper.keep(&reference).unwrap_or_else(|fault| self.fail(fault));
    }

    /// Hands it to the post_process. One picture alone tells nothing of its own noise, and waits for the second.
    fn show(&self, wish: &Wish, reference: &Reference, done: bool) {
        let enough = reference.replicates != 1;
        if enough {
            self.post_process.set_reference(Some((wish.view, ReferenceImage::of(reference))));
        }
        let noise = reference.rel_mse().filter(|_| enough);
        self.tell(wish, (reference.replicates, noise, reference.seconds), done);
    }

    fn tell(&self, wish: &Wish, (pictures, noise, seconds): (u32, Option<f64>, f64), done: bool) {
        let origin = wish.origin.clone();
        let progress = Progress { view: wish.view, origin, pictures, noise, seconds, done };
        self.update.post(|update| update.progress = Some(progress));
        (self.wake)();
    }

    fn fail(&self, fault: String) {
        self.update.post(|update| update.faults.push(fault));
        (self.wake)();
    }
}

/// A reference from a file, of the size of the picture.
fn load(file: &Path, (width, height): (u32, u32)) -> Result<Reference, String> {
    let reference = Reference::load(file).map_err(|fault| fault.to_string())?;
    let (w, h) = reference.image.size();
    if (w, h) == (width, height) {
        return Ok(reference);
    }
    Err(format!("the reference has {w}x{h} pixels, the picture {width}x{height}: {}", file.display()))
}

/// Puts one reference into the store, now and then.
struct Keeper<'a> {
    store: Option<Store>,
    key: Key,
    wish: &'a Wish,
    /// Pictures of the one that is in the store; 0 if there is none.
    kept: u32,
}

impl Keeper<'_> {
    /// How many pictures are worth keeping: a first time, and then each doubling.
    fn next(&self) -> u32 {
        FEWEST_REPLICATES.max(2 * self.kept)
    }

    /// Keeps it, if it has become finer and there are enough pictures to tell its noise.
    fn keep(&mut self, reference: &Reference) -> Result<(), String> {
        if reference.replicates < FEWEST_REPLICATES || reference.replicates <= self.kept {
            return Ok(());
        }
        // a store that failed once is not tried again: one line is enough
        let Some(store) = self.store.take() else { return Ok(()) };
        store.put(self.key, reference, reference::records(&self.wish.shot)).map_err(|fault| fault.to_string())?;
        self.kept = reference.replicates;
        self.store = Some(store);
        Ok(())
    }
}
