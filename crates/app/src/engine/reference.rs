//! The thread that makes the reference of what is seen, or reads it from a file, while the panes are at rest,
//! for they have priority.

use super::make_reference::{OpenStore, ReferenceMaking, ReferenceWatch};
use super::post_process::PostProcess;
use super::worker::{Control, Service, Worker};
use super::{Wake, step_back};
use crate::model::{Origin, Progress};
use crate::ruler::{ReferenceImage, kept_scene};
use reference::Reference;
use std::path::Path;
use std::sync::Arc;
use technique::{Shot, Threads};

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
            References { post_process, making: ReferenceMaking::new(threads, open_store) }
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
    making: ReferenceMaking,
}

impl Service for References {
    type Job = Option<Wish>;
    type Update = ReferenceUpdate;

    fn serve(&mut self, wish: Option<Wish>, control: &ReferenceControl) {
        let Some(wish) = wish else { return };
        let Origin::File(file) = &wish.origin else { return self.make(&wish, control) };
        match load(file, &wish.shot) {
            Ok((reference, notes)) => {
                self.watch(&wish, control).show(Some(&reference), true);
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
        self.making.forget();
        fail(control, "the reference stopped at a fault of its own".into());
    }
}

impl References {
    fn watch<'a>(&self, wish: &'a Wish, control: &'a ReferenceControl) -> Asked<'a> {
        Asked { wish, control, post_process: self.post_process.clone() }
    }

    fn make(&mut self, wish: &Wish, control: &ReferenceControl) {
        let watch = self.watch(wish, control);
        self.making.make(&wish.shot, &watch);
    }
}

/// Who has asked for a reference, and hands it on to measure pictures by.
struct Asked<'a> {
    wish: &'a Wish,
    control: &'a ReferenceControl,
    post_process: Arc<PostProcess>,
}

impl ReferenceWatch for Asked<'_> {
    fn ends_soon(&self) -> bool {
        self.control.ends_soon()
    }

    fn is_held(&self) -> bool {
        self.control.is_held()
    }

    fn wait(&self) {
        self.control.wait();
    }

    /// One picture alone tells nothing of its own noise, and waits for the second.
    fn show(&self, reference: Option<&Reference>, done: bool) {
        let enough = reference.filter(|reference| reference.replicates != 1);
        if let Some(reference) = enough {
            self.post_process.set_reference(Some((self.wish.view, ReferenceImage::of(reference))));
        }
        let (view, origin) = (self.wish.view, self.wish.origin.clone());
        let (pictures, seconds) = reference.map_or((0, 0.0), |reference| (reference.replicates, reference.seconds));
        let noise = enough.and_then(Reference::rel_mse);
        let progress = Progress { view, origin, pictures, noise, seconds, done };
        self.control.tell(|update| update.progress = Some(progress));
    }

    fn fail(&self, fault: String) {
        fail(self.control, fault);
    }
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
