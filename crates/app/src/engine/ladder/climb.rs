//! The thread that climbs: rung by rung, told as they are reached, and then the reference. Where the best comes first, a
//! reference that tells rungs apart comes before them.

use crate::engine::FAULT;
use crate::engine::make_reference::{OpenStore, ReferenceMaking, ReferenceWatch};
use crate::engine::worker::{Control, Service};
use crate::ladder::{Climber, Made, RungMaker, SPP};
use crate::model::{Order, Origin, Progress, Rung, TileFacts, WantedLadder};
use crate::ruler::ReferenceImage;
use crate::sweep::{Devices, Onlooker, Tile, TileMaker};
use gpu::Gpu;
use pathtrace::FEWEST_REPLICATES;
use reference::Reference;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// A ladder to climb.
#[derive(Debug, Clone)]
pub struct Job {
    /// Counts what was asked for.
    pub number: u64,
    /// What is seen, and what is repaired.
    pub ladder: WantedLadder,
}

/// What is new of a ladder.
#[derive(Default)]
pub struct Climb {
    /// Of which ladder it is, as its job counts them.
    pub number: u64,
    /// Rungs that were reached, in their order.
    pub made: Vec<Made>,
    /// What they are measured by.
    pub reference: Option<Arc<ReferenceImage>>,
    /// How far that has come.
    pub progress: Option<Progress>,
    /// What is being done; `Some(None)` once nothing is.
    pub doing: Option<Option<String>>,
    /// Why it came no farther: one line.
    pub fault: Option<String>,
}

type ClimbControl = Control<Option<Job>, Climb>;

/// Pictures of one view that stay for its next ladder: those of two ladders.
const MOST_KEPT: usize = 2 * Rung::COUNT;

/// Pictures of a reference that rungs are measured by: two alone know little of their own noise.
const FIRST: u32 = 4;

/// Climbs one ladder after the other.
pub struct Climbs {
    gpu: Gpu,
    devices: Box<dyn Fn() -> Devices + Send>,
    /// Made for the first ladder, and again after a fault.
    maker: Option<RungMaker>,
    references: ReferenceMaking,
    restarts: u64,
    /// The number of the ladder in hand.
    in_hand: u64,
}

impl Climbs {
    /// The fake is drawn by `gpu`, and rays are traced by what `devices` opens; references are kept where `open_store` says.
    pub fn new(gpu: Gpu, devices: impl Fn() -> Devices + Send + 'static, open_store: OpenStore) -> Self {
        let references = ReferenceMaking::new(devices().threads, open_store);
        Climbs { gpu, devices: Box::new(devices), maker: None, references, restarts: 0, in_hand: 0 }
    }
}

impl Service for Climbs {
    type Job = Option<Job>;
    type Update = Climb;

    fn serve(&mut self, job: Option<Job>, control: &ClimbControl) {
        // pictures stay: who comes back finds them
        let Some(job) = job else { return };
        self.in_hand = job.number;
        let watch = ClimbWatch::new(&job, control);
        match self.climb(&job, &watch) {
            Ok(()) if !control.ends_soon() => watch.say(None),
            Ok(()) => {}
            Err(fault) => {
                // what has failed once is opened anew
                self.maker = None;
                watch.fail(format!("{fault:#}. R tries it again"));
                watch.say(None);
            }
        }
    }

    fn recover(&mut self, control: &ClimbControl) {
        self.maker = None;
        self.references.forget();
        let number = self.in_hand;
        control.tell(|update| {
            let update = note(update, number);
            (update.fault, update.doing) = (Some(FAULT.into()), Some(None));
        });
    }
}

impl Climbs {
    fn climb(&mut self, job: &Job, watch: &ClimbWatch) -> anyhow::Result<()> {
        let WantedLadder { shot, repairs, order, restarts, .. } = &job.ladder;
        watch.say(Some("making the fake ready".into()));
        let mut maker = match self.maker.take() {
            Some(maker) => maker,
            None => RungMaker::new(&self.gpu, TileMaker::new((self.devices)()), MOST_KEPT)?,
        };
        maker.forget_other_views(shot);
        if self.restarts != *restarts {
            self.restarts = *restarts;
            maker.forget();
        }
        let (kept, _) = self.references.fetch(shot, watch);
        watch.show(kept.as_ref(), false);
        if *order == Order::BestFirst && kept.is_none() {
            watch.say(Some("making a reference that tells rungs apart".into()));
            self.references.make(shot, &watch.until(FEWEST_REPLICATES));
        }
        let reference = watch.reference();
        if *order == Order::Light || reference.is_some() {
            let (onlooker, of_all) = (watch, reference.as_deref());
            let maker = &mut maker;
            let mut climber = Climber { shot, reference: of_all, maker, onlooker, spp: SPP };
            watch.say(Some("climbing".into()));
            climber.climb(repairs, *order, |made| {
                watch.reach(made);
                Ok(())
            })?;
        }
        self.maker = Some(maker);
        if !watch.control.ends_soon() {
            watch.say(Some("making the reference".into()));
            self.references.make(shot, watch);
        }
        Ok(())
    }
}

/// The reference as if it were a tile of what this one shows.
pub fn tile_of(reference: &ReferenceImage, like: &Tile) -> Arc<Tile> {
    let image = reference.image.clone();
    // without samples and not done it is shown, and not measured by itself
    let facts = TileFacts::default();
    Arc::new(Tile { image, ..Tile::without_light(facts, like.provenance.clone()) })
}

fn note(update: &mut Climb, number: u64) -> &mut Climb {
    if update.number != number {
        *update = Climb { number, ..Climb::default() };
    }
    update
}

/// Who waits for a ladder and its reference.
struct ClimbWatch<'a> {
    number: u64,
    control: &'a ClimbControl,
    /// Pictures of the reference after which it is enough.
    enough: u32,
    /// What the reference has been so far.
    seen: Arc<Seen>,
}

/// A reference as it was last told.
#[derive(Default)]
struct Seen {
    pictures: AtomicU32,
    image: Mutex<Option<(u32, Arc<ReferenceImage>)>>,
}

impl<'a> ClimbWatch<'a> {
    fn new(job: &Job, control: &'a ClimbControl) -> Self {
        ClimbWatch { number: job.number, control, enough: u32::MAX, seen: Arc::default() }
    }

    /// The same for as many pictures of the reference.
    fn until(&self, enough: u32) -> Self {
        ClimbWatch { number: self.number, control: self.control, enough, seen: self.seen.clone() }
    }

    fn tell(&self, change: impl FnOnce(&mut Climb)) {
        self.control.tell(|update| change(note(update, self.number)));
    }

    fn say(&self, doing: Option<String>) {
        self.tell(|update| update.doing = Some(doing));
    }

    fn reach(&self, made: Made) {
        self.tell(|update| {
            update.doing = Some(Some(format!("climbing: {}", made.rung.title())));
            update.made.push(made);
        });
    }

    fn reference(&self) -> Option<Arc<ReferenceImage>> {
        let image = self.seen.image.lock().unwrap_or_else(PoisonError::into_inner);
        image.as_ref().map(|(_, image)| image.clone())
    }

    /// The reference to measure by from now on, where it has twice the pictures of the last: each has all rungs measured again, and
    /// those of one are not held against those of another.
    fn finer(&self, reference: &Reference, done: bool) -> Option<Arc<ReferenceImage>> {
        let mut known = self.seen.image.lock().unwrap_or_else(PoisonError::into_inner);
        let before = known.as_ref().map_or(0, |(pictures, _)| *pictures);
        let pictures = reference.replicates;
        let finer = if done { pictures > before } else { pictures >= FIRST.max(2 * before) };
        if !finer {
            return None;
        }
        let image = Arc::new(ReferenceImage::of(reference));
        *known = Some((pictures, image.clone()));
        Some(image)
    }
}

impl Onlooker for ClimbWatch<'_> {
    fn ends_now(&self) -> bool {
        self.control.ends_now()
    }

    fn is_held(&self) -> bool {
        self.control.is_held()
    }

    fn wait(&self) {
        self.control.wait();
    }
}

impl ReferenceWatch for ClimbWatch<'_> {
    fn ends_soon(&self) -> bool {
        self.control.ends_soon() || self.seen.pictures.load(Ordering::Relaxed) >= self.enough
    }

    fn is_held(&self) -> bool {
        self.control.is_held()
    }

    fn wait(&self) {
        self.control.wait();
    }

    fn show(&self, reference: Option<&Reference>, done: bool) {
        let (pictures, seconds) = reference.map_or((0, 0.0), |reference| (reference.replicates, reference.seconds));
        self.seen.pictures.store(pictures, Ordering::Relaxed);
        let image = reference.and_then(|reference| self.finer(reference, done));
        let noise = reference.filter(|reference| reference.replicates > 1).and_then(Reference::rel_mse);
        let progress = Progress { view: self.number, origin: Origin::Made, pictures, noise, seconds, done };
        self.tell(|update| {
            update.reference = image.or(update.reference.take());
            update.progress = Some(progress);
        });
    }

    fn fail(&self, fault: String) {
        self.tell(|update| update.fault = Some(fault));
    }
}
