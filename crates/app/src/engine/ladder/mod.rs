//! Ladders beside the UI: a thread that climbs from the fake to the truth and makes their reference (`climb`), the one of sweeps
//! that turns pictures into bytes and errors, and one for the map of a rung's errors.

mod climb;
mod to_save;

pub use to_save::LadderToSave;

use self::climb::{Climb, Climbs, Job};
use super::Wake;
use super::ask::Engine;
use super::error_map::ErrorMapWorker;
use super::sweep::devices;
use super::sweep::show::{Show, Shower, Shown, ShownTile};
use super::worker::Worker;
use crate::ladder::Made;
use crate::model::{ErrorMap, ErrorMapJob, Progress, Rung, Wanted, WantedLadder};
use crate::ruler::{Noise, Pair, ReferenceImage};
use crate::sweep::Tile;
use film::DisplayTransform;
use std::sync::Arc;

/// The threads; dropping it ends them.
pub struct LadderStudy {
    climbs: Worker<Option<Job>, Climb>,
    show: Worker<Option<Show>, Shown>,
    maps: ErrorMapWorker,
    /// What was asked for last.
    asked: Option<WantedLadder>,
    /// Counts the ladders that were asked for.
    number: u64,
    /// The rungs of it that were reached, in their order.
    made: Vec<Made>,
    reference: Option<Arc<ReferenceImage>>,
    display: DisplayTransform,
    /// What the map that was asked for last is of.
    mapped: Option<Mapped>,
}

/// What a map of errors depends on.
#[derive(Clone)]
struct Mapped {
    wish: (Rung, compare::ErrorMetric, Option<f32>),
    tile: Arc<Tile>,
    reference: Arc<ReferenceImage>,
    display: DisplayTransform,
}

impl Mapped {
    fn is_the_same(&self, other: &Mapped) -> bool {
        self.wish == other.wish
            && Arc::ptr_eq(&self.tile, &other.tile)
            && Arc::ptr_eq(&self.reference, &other.reference)
            && self.display == other.display
    }
}

/// What is new of a ladder.
#[derive(Default)]
pub struct LadderNews {
    /// Counts ladders: what was known of one with another number holds no more.
    pub number: u64,
    /// All rungs that were reached so far, in their order.
    pub made: Vec<Made>,
    /// Pictures and errors by [`Rung::place`], and the reference's picture behind the last of them.
    pub shown: Vec<(usize, ShownTile)>,
    /// How far the reference has come.
    pub reference: Option<Progress>,
    /// The map that was drawn, or that there is none.
    pub map: Option<Option<(Rung, ErrorMap)>>,
    /// What is being done; `Some(None)` once nothing is.
    pub doing: Option<Option<String>>,
    /// Why it came no farther: one line.
    pub fault: Option<String>,
}

/// Where the reference's picture stands behind the rungs'.
pub const OF_THE_REFERENCE: usize = Rung::COUNT;

impl LadderStudy {
    fn start(engine: &Engine) -> std::io::Result<Self> {
        let (gpu, adapters, threads) = (engine.gpu.clone(), engine.adapters.clone(), engine.threads.clone());
        let (wake, open_store): (Wake, _) = (engine.wake.clone(), engine.open_store.clone());
        let climbs = Worker::start("ladder", wake.clone(), move || {
            super::step_back();
            let of_rungs = gpu.clone();
            Climbs::new(gpu, move || devices(of_rungs.clone(), adapters.clone(), threads.clone()), open_store)
        })?;
        let show = Worker::start("ladder shown", wake.clone(), || {
            super::step_back();
            Shower::default()
        })?;
        let maps = ErrorMapWorker::start(wake)?;
        let (made, reference, display) = (Vec::new(), None, DisplayTransform::default());
        Ok(LadderStudy { climbs, show, maps, asked: None, number: 0, made, reference, display, mapped: None })
    }

    fn ask(&mut self, wanted: &Wanted) {
        self.climbs.hold(wanted.paused);
        let same = match (&self.asked, &wanted.ladder) {
            (Some(asked), Some(wanted)) => asked.is_of_the_same_ladder(wanted),
            (asked, wanted) => asked.is_none() == wanted.is_none(),
        };
        if !same {
            self.climbs.cancel();
            self.number += 1;
            (self.made, self.reference) = (Vec::new(), None);
            if let Some(ladder) = &wanted.ladder {
                let job = Job { number: self.number, ladder: ladder.clone() };
                self.climbs.post(|slot| *slot = Some(job));
            }
        }
        self.asked.clone_from(&wanted.ladder);
        if self.display != wanted.display {
            self.display = wanted.display;
            self.show_all();
        }
        self.draw_map();
    }

    fn collect(&mut self) -> LadderNews {
        let mut news = LadderNews { number: self.number, ..LadderNews::default() };
        if let Some(update) = self.climbs.collect().filter(|update| update.number == self.number) {
            self.made.extend(update.made);
            self.reference = update.reference.or(self.reference.take());
            (news.reference, news.doing, news.fault) = (update.progress, update.doing, update.fault);
            news.made.clone_from(&self.made);
            self.show_all();
            self.draw_map();
        }
        if let Some(shown) = self.show.collect().filter(|shown| shown.number == self.number) {
            news.shown = shown.tiles.into_iter().collect();
        }
        news.map = self.maps.collect().map(|drawn| {
            // it may be of the rung that was looked at before
            let of = |map: &ErrorMap| Rung::all().find(|rung| rung.title() == map.map_job.pair.names[0]);
            drawn.and_then(|map| Some((of(&map)?, map)))
        });
        news
    }

    fn show_all(&self) {
        let mut tiles = vec![None; Rung::COUNT + 1];
        self.made.iter().for_each(|made| tiles[made.rung.place()] = Some(made.tile.clone()));
        let pictured = self.reference.as_ref().zip(self.made.first());
        tiles[OF_THE_REFERENCE] = pictured.map(|(reference, made)| climb::tile_of(reference, &made.tile));
        let show = Show { number: self.number, tiles, reference: self.reference.clone(), display: self.display };
        self.show.post(|slot| *slot = Some(show));
    }

    /// Asks for the map that is looked at, unless it is the one that was asked for before.
    fn draw_map(&mut self) {
        let wish = self.asked.as_ref().and_then(|asked| asked.map);
        let of = wish.and_then(|wish| {
            let tile = self.made.iter().find(|made| made.rung == wish.0)?.tile.clone();
            Some(Mapped { wish, tile, reference: self.reference.clone()?, display: self.display })
        });
        let same = match (&self.mapped, &of) {
            (Some(before), Some(now)) => before.is_the_same(now),
            (before, now) => before.is_none() == now.is_none(),
        };
        if same {
            return;
        }
        self.maps.submit(of.as_ref().map(|mapped| {
            let Mapped { wish: (rung, map, held), tile, reference, display } = mapped;
            let pair = Pair {
                names: [rung.title(), "reference"],
                images: [tile.image.clone(), reference.image.clone()],
                noise: [noise_of(*rung), reference.noise_of_pixels()],
                display: *display,
            };
            ErrorMapJob { pair, map: *map, held: *held, region: None }
        }));
        self.mapped = of;
    }
}

/// What is known of the noise of a rung's pixels: rasterised ones have none.
fn noise_of(rung: Rung) -> Noise {
    if matches!(rung, Rung::Whitted | Rung::Path) { Noise::Unknown } else { Noise::None }
}

impl Drop for LadderStudy {
    fn drop(&mut self) {
        // a reference in hand is kept before its thread ends
        self.climbs.cancel();
        self.maps.close();
    }
}

impl Engine {
    /// Asks for the ladder that is wanted, if one is.
    pub(super) fn ask_ladder(&mut self, wanted: &Wanted) {
        if self.ladder.is_none() && wanted.ladder.is_some() {
            // without threads there is none; the next frame tries again
            self.ladder = LadderStudy::start(self).ok();
        }
        self.ladder.iter_mut().for_each(|ladder| ladder.ask(wanted));
    }

    /// All that is needed to save the rungs `made` of the ladder of a scene; `None` without a reference.
    pub fn ladder_to_save(&self, scene: &str, rungs: &[Made]) -> Option<LadderToSave> {
        let reference = self.ladder.as_ref()?.reference.clone()?;
        Some(LadderToSave { scene: scene.to_owned(), rungs: rungs.to_vec(), reference })
    }

    /// What is new of the ladder since the last call.
    pub fn ladder_news(&mut self) -> Option<LadderNews> {
        self.ladder.as_mut().map(LadderStudy::collect)
    }
}
