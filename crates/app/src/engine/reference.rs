//! The thread that makes the reference of what is seen: from the store at once if it is there, else picture by picture,
//! while the panes are at rest, for they have priority. It keeps what it has made: when it is good enough, after each
//! doubling, and when something else is asked for or the window closes.

use super::post_process::PostProcess;
use super::worker::{Control, Service, Worker};
use super::{Wake, step_back};
use crate::model::{Origin, Progress};
use crate::ruler::{ReferenceImage, kept_scene};
use pathtrace::FEWEST_REPLICATES;
use reference::{Goal, Key, Maker, Reference, Store, StoreError};
use std::path::Path;
use std::sync::Arc;
use technique::{Rank, Renderer, Shot, Threads};

/// Where references are kept, looked up anew for each.
pub type OpenStore = Arc<dyn Fn() -> Result<Store, StoreError> + Send + Sync>;

/// A reference to come by.
#[derive(Debug, Clone)]
pub struct Wish {
    /// Counts views as [`super::Order::view`] does.
    pub view: u64,
    /// What it shall show.
    pub shot: Shot,
    /// Whether it is made here or read from a file.
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
pub struct ReferenceWorker(Worker<Option<Wish>, ReferenceUpdate>);

impl ReferenceWorker {
    /// Starts the thread, which traces on `threads`; `wake` is called whenever [`ReferenceWorker::update`] has
    /// something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(
        threads: Arc<Threads>,
        post_process: Arc<PostProcess>,
        open_store: OpenStore,
        wake: Wake,
    ) -> std::io::Result<Self> {
        let service = move || {
            step_back();
            References { post_process, threads, open_store, renderer: None }
        };
        Worker::start("reference_worker", wake, service).map(ReferenceWorker)
    }

    /// Asks for a reference. The one in hand stops at once and is kept.
    pub fn submit(&mut self, wish: Wish) {
        self.0.cancel();
        self.0.post(|slot| *slot = Some(wish));
    }

    /// Stops the one in hand.
    pub fn cancel(&mut self) {
        self.0.cancel();
    }

    /// Holds the work where it is, or lets it go on.
    pub fn hold(&self, held: bool) {
        self.0.hold(held);
    }

    /// What is new since the last call.
    pub fn update(&self) -> Option<ReferenceUpdate> {
        self.0.collect()
    }
}

type ReferenceControl = Control<Option<Wish>, ReferenceUpdate>;

/// Makes one reference after the other.
struct References {
    post_process: Arc<PostProcess>,
    threads: Arc<Threads>,
    open_store: OpenStore,
    /// The scene of the last wish, ready for rays.
    renderer: Option<Renderer>,
}

impl Service for References {
    type Job = Option<Wish>;
    type Update = ReferenceUpdate;

    fn serve(&mut self, wish: Option<Wish>, control: &ReferenceControl) {
        let Some(wish) = wish else { return };
        let Origin::File(file) = &wish.origin else { return self.make(&wish, control) };
        match load(file, &wish.shot) {
            Ok((reference, notes)) => {
                self.show(&wish, &reference, true, control);
                // one line: a later one would take the place of those before
                if !notes.is_empty() {
                    fail(control, notes.join("; "));
                }
            }
            Err(fault) => {
                fail(control, fault);
                self.make(&Wish { origin: Origin::Made, ..wish.clone() }, control);
            }
        }
    }

    fn recover(&mut self, control: &ReferenceControl) {
        self.renderer = None;
        fail(control, "the reference stopped at a fault of its own".into());
    }
}

impl References {
    fn make(&mut self, wish: &Wish, control: &ReferenceControl) {
        let key = Key::of(&wish.shot);
        let store = (self.open_store)().map_err(|fault| fail(control, fault.to_string())).ok();
        let fetched = store.as_ref().map_or(Ok(None), |store| store.fetch(key));
        let kept = fetched.map_err(|fault| fail(control, fault.to_string())).ok().flatten();
        match &kept {
            Some(kept) => self.show(wish, kept, false, control),
            None => tell(control, wish, (0, None, 0.0), false),
        }
        let scene = &wish.shot.scene;
        let mut renderer = match self.renderer.take() {
            Some(renderer) if Arc::ptr_eq(renderer.scene(), scene) => renderer,
            _ => Renderer::on_the_processor(scene.clone(), self.threads.clone()),
        };
        // panes go first
        renderer.rank = Rank::Background;
        let mut keeper = Keeper { store, key, wish, kept: kept.as_ref().map_or(0, |kept| kept.replicates) };
        match Maker::new(&mut renderer, &wish.shot, kept.as_ref()) {
            Some(mut maker) => self.work(&mut maker, &Goal::default(), &mut keeper, control),
            None => fail(control, "not enough memory for a reference; make the window smaller".into()),
        }
        self.renderer = Some(renderer);
    }

    fn work(&self, maker: &mut Maker, goal: &Goal, keeper: &mut Keeper, control: &ReferenceControl) {
        while !maker.is_done(goal) && !control.ends_soon() {
            // who waits holds no threads
            control.wait();
            if !maker.step(&|| control.is_held() || control.ends_soon()) {
                continue;
            }
            let reference = maker.reference();
            let done = maker.is_done(goal);
            self.show(keeper.wish, &reference, done, control);
            if done || reference.replicates >= keeper.next() {
                keeper.keep(&reference).unwrap_or_else(|fault| fail(control, fault));
            }
        }
        let reference = maker.reference();
        if maker.is_done(goal) {
            self.show(keeper.wish, &reference, true, control);
        }
        keeper.keep(&reference).unwrap_or_else(|fault| fail(control, fault));
    }

    /// Hands it on, to measure pictures by. One picture alone tells nothing of its own noise, and waits for the second.
    fn show(&self, wish: &Wish, reference: &Reference, done: bool, control: &ReferenceControl) {
        let enough = reference.replicates != 1;
        if enough {
            self.post_process.set_reference(Some((wish.view, ReferenceImage::of(reference))));
        }
        let noise = reference.rel_mse().filter(|_| enough);
        tell(control, wish, (reference.replicates, noise, reference.seconds), done);
    }
}

fn tell(control: &ReferenceControl, wish: &Wish, (pictures, noise, seconds): (u32, Option<f64>, f64), done: bool) {
    let origin = wish.origin.clone();
    let progress = Progress { view: wish.view, origin, pictures, noise, seconds, done };
    control.tell(|update| update.progress = Some(progress));
}

fn fail(control: &ReferenceControl, fault: String) {
    control.tell(|update| update.faults.push(fault));
}

/// A reference from a file, of the size of the picture, and what there is to say of it: what of the file it does not show,
/// and whether it is of the same scene.
fn load(file: &Path, shot: &Shot) -> Result<(Reference, Vec<String>), String> {
    let (reference, notes) = Reference::load_with_notes(file).map_err(|fault| fault.to_string())?;
    match misfit(file, reference.image.size(), shot) {
        None => Ok((reference, notes.into_iter().chain(of_another_scene(file, shot)).collect())),
        Some(line) => Err(line),
    }
}

/// Why a reference of this size is none of what is seen: one line, with what makes one that is.
pub fn misfit(file: &Path, (w, h): (u32, u32), shot: &Shot) -> Option<String> {
    let (width, height) = shot.size;
    ((w, h) != shot.size).then(|| {
        let (file, command) = (image_file::shown(file), shot.reference_command());
        format!(
            "the reference has {w}x{h} pixels, the picture {width}x{height}: {file}; one that fits is made by {command}"
        )
    })
}

/// A line where the file is of another scene than what is seen, or does not tell.
fn of_another_scene(file: &Path, shot: &Shot) -> Option<String> {
    match kept_scene(file) {
        Ok(Some(then)) if !then.has_the_truth_of(&shot.scene.as_read) => {
            Some(format!("this reference is of another scene, or of one that has changed: {}", file.display()))
        }
        Ok(_) => None,
        Err(line) => Some(line),
    }
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
