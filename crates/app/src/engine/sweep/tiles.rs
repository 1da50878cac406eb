//! The thread that makes a sweep: a first picture of every tile, then one tile after the other, then the reference of
//! what all of them show. Tiles that are whole stay for the next sweep, which may want some of them again.

use crate::engine::FAULT;
use crate::engine::make_reference::{OpenStore, ReferenceMaking, ReferenceWatch};
use crate::engine::worker::{Control, Service};
use crate::model::{MOST_TILES, Origin, PlannedTile, Progress, TileFacts, WantedSweep};
use crate::ruler::ReferenceImage;
use crate::sweep::{Asked, Devices, Onlooker, Tile, TileMaker};
use reference::Reference;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;
use technique::{Accumulation, Device, Provenance, Shot, Technique};

/// A sweep to make.
#[derive(Debug, Clone)]
pub struct Job {
    /// Counts what was asked for.
    pub number: u64,
    /// What is seen, and the tiles.
    pub sweep: WantedSweep,
    /// How often the user began anew.
    pub restarts: u64,
}

/// What is new of a sweep.
#[derive(Debug, Default)]
pub struct TilesUpdate {
    /// Of which sweep it is, as its job counts them.
    pub number: u64,
    /// Tiles by their places.
    pub tiles: BTreeMap<usize, Arc<Tile>>,
    /// What they are measured by.
    pub reference: Option<Arc<ReferenceImage>>,
    /// How far that has come.
    pub progress: Option<Progress>,
    /// Lines for the user.
    pub faults: Vec<String>,
}

type TilesControl = Control<Option<Job>, TilesUpdate>;

/// Makes one sweep after the other.
pub struct Tiles {
    devices: Box<dyn Fn() -> Devices + Send>,
    maker: TileMaker,
    references: ReferenceMaking,
    /// Whole tiles of the last sweeps of one view, the latest last.
    kept: Vec<(Wish, Arc<Tile>)>,
    /// The tile in hand.
    in_hand: Option<(u64, usize, PlannedTile, Shot)>,
}

/// What a tile depends on beside what is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wish {
    technique: Technique,
    seconds: Option<f32>,
    restarts: u64,
}

impl Tiles {
    /// By what `devices` opens; references are kept where `open_store` says.
    pub fn new(devices: impl Fn() -> Devices + Send + 'static, open_store: OpenStore) -> Self {
        let opened = devices();
        let references = ReferenceMaking::new(opened.threads.clone(), open_store);
        let (maker, kept) = (TileMaker::new(opened), Vec::new());
        Tiles { devices: Box::new(devices), maker, references, kept, in_hand: None }
    }
}

impl Service for Tiles {
    type Job = Option<Job>;
    type Update = TilesUpdate;

    fn serve(&mut self, job: Option<Job>, control: &TilesControl) {
        let Some(job) = job else { return };
        let watch = SweepWatch { job: &job, place: 0, control };
        self.forget_other_views(&job.sweep.shot);
        let mut films: Vec<Option<Accumulation>> = Vec::new();
        let known: Vec<_> = job.sweep.plan.tiles.iter().map(|tile| self.known(&job, tile)).collect();
        for (place, known) in known.iter().enumerate() {
            known.iter().for_each(|tile| watch.at(place).tell(tile.clone()));
        }
        // what is kept of it is there before the first tile is done
        let (reference, _) = self.references.fetch(&job.sweep.shot, &watch);
        reference.iter().for_each(|reference| watch.show(Some(reference), false));
        let missing = |place: &usize| known[*place].is_none();
        let places: Vec<usize> = (0..known.len()).filter(missing).collect();
        for place in &places {
            films.push(self.begin(&job, *place, control));
        }
        for (place, film) in places.into_iter().zip(films) {
            if control.ends_now() {
                return;
            }
            self.finish(&job, (place, film), control);
        }
        self.in_hand = None;
        self.references.make(&job.sweep.shot, &watch);
    }

    fn recover(&mut self, control: &TilesControl) {
        self.maker = TileMaker::new((self.devices)());
        self.references.forget();
        if let Some((number, place, planned, shot)) = self.in_hand.take() {
            let tile = Arc::new(failed(&shot, &planned, FAULT.into()));
            control.tell(|update| note(update, number).tiles.extend([(place, tile)]));
        }
    }
}

impl Tiles {
    fn wish(job: &Job, tile: &PlannedTile) -> Wish {
        Wish { technique: tile.pane.in_use(), seconds: job.sweep.plan.seconds, restarts: job.restarts }
    }

    fn known(&self, job: &Job, tile: &PlannedTile) -> Option<Arc<Tile>> {
        let wish = Tiles::wish(job, tile);
        self.kept.iter().find(|(kept, _)| *kept == wish).map(|(_, tile)| tile.clone())
    }

    fn forget_other_views(&mut self, shot: &Shot) {
        self.kept.retain(|(_, tile)| tile.provenance.shot.is_of_the_same_view(shot));
        let too_many = self.kept.len().saturating_sub(2 * MOST_TILES);
        self.kept.drain(..too_many);
    }

    fn begin(&mut self, job: &Job, place: usize, control: &TilesControl) -> Option<Accumulation> {
        let watch = SweepWatch { job, place, control };
        if control.ends_now() {
            return None;
        }
        self.take_in_hand(job, place);
        // what is wrong is told when it is to be finished
        self.maker.begin(watch.asked(), &watch).ok().flatten()
    }

    fn finish(&mut self, job: &Job, (place, film): (usize, Option<Accumulation>), control: &TilesControl) {
        let watch = SweepWatch { job, place, control };
        self.take_in_hand(job, place);
        match self.maker.finish(watch.asked(), film, &watch) {
            Ok(tile) => {
                let tile = Arc::new(tile);
                if tile.facts.done {
                    self.kept.push((Tiles::wish(job, watch.planned()), tile.clone()));
                }
                watch.tell(tile);
            }
            Err(fault) => watch.tell(Arc::new(failed(&job.sweep.shot, watch.planned(), format!("{fault:#}")))),
        }
    }

    fn take_in_hand(&mut self, job: &Job, place: usize) {
        let planned = job.sweep.plan.tiles[place].clone();
        self.in_hand = Some((job.number, place, planned, job.sweep.shot.clone()));
    }
}

/// A tile of which there is nothing but why.
fn failed(shot: &Shot, planned: &PlannedTile, fault: String) -> Tile {
    let facts = TileFacts { done: true, fault: Some(fault), ..TileFacts::default() };
    let provenance = Provenance { shot: shot.clone(), technique: planned.pane.in_use(), device: Device::Cpu };
    Tile::without_light(facts, provenance)
}

fn note(update: &mut TilesUpdate, number: u64) -> &mut TilesUpdate {
    if update.number != number {
        *update = TilesUpdate { number, ..TilesUpdate::default() };
    }
    update
}

/// Who waits for a tile at its place, and for the reference.
struct SweepWatch<'a> {
    job: &'a Job,
    place: usize,
    control: &'a TilesControl,
}

impl SweepWatch<'_> {
    fn at(&self, place: usize) -> Self {
        SweepWatch { place, ..*self }
    }

    fn planned(&self) -> &PlannedTile {
        &self.job.sweep.plan.tiles[self.place]
    }

    fn asked(&self) -> Asked<'_> {
        let limit = self.job.sweep.plan.seconds.map(Duration::from_secs_f32);
        Asked { shot: &self.job.sweep.shot, pane: &self.planned().pane, limit }
    }

    fn tell(&self, tile: Arc<Tile>) {
        self.control.tell(|update| note(update, self.job.number).tiles.extend([(self.place, tile)]));
    }
}

impl Onlooker for SweepWatch<'_> {
    fn ends_now(&self) -> bool {
        self.control.ends_now()
    }

    fn is_held(&self) -> bool {
        self.control.is_held()
    }

    fn wait(&self) {
        self.control.wait();
    }

    fn see(&self, tile: Tile) {
        self.tell(Arc::new(tile));
    }
}

impl ReferenceWatch for SweepWatch<'_> {
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
        let image = enough.map(|reference| Arc::new(ReferenceImage::of(reference)));
        let (pictures, seconds) = reference.map_or((0, 0.0), |reference| (reference.replicates, reference.seconds));
        let noise = enough.and_then(Reference::rel_mse);
        let progress = Progress { view: self.job.number, origin: Origin::Made, pictures, noise, seconds, done };
        self.control.tell(|update| {
            let update = note(update, self.job.number);
            update.reference = image.or(update.reference.take());
            update.progress = Some(progress);
        });
    }

    fn fail(&self, fault: String) {
        self.control.tell(|update| note(update, self.job.number).faults.push(fault));
    }
}
