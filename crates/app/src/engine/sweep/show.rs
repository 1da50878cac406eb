//! The thread that turns tiles into bytes for the screen, and measures how far they are from the reference.

use crate::engine::worker::{Control, Service};
use crate::model::TileErrors;
use crate::ruler::ReferenceImage;
use crate::sweep::{Tile, measure};
use film::DisplayTransform;
use std::collections::BTreeMap;
use std::sync::Arc;

/// All tiles as they are now, and what they are shown and measured by.
#[derive(Debug, Clone)]
pub struct Show {
    /// Counts the sweeps that were shown, to tell old ones.
    pub number: u64,
    /// In the order of the plan.
    pub tiles: Vec<Option<Arc<Tile>>>,
    /// What they are measured by.
    pub reference: Option<Arc<ReferenceImage>>,
    /// How they are shown.
    pub display: DisplayTransform,
}

/// What is new of the tiles of a sweep.
#[derive(Debug, Default)]
pub struct Shown {
    /// Of which sweep it is, as its job counts them.
    pub number: u64,
    /// By their places in the plan, from 0.
    pub tiles: BTreeMap<usize, ShownTile>,
}

/// A tile as it is shown.
#[derive(Debug, Clone)]
pub struct ShownTile {
    /// Its picture in linear radiance, and what is known of it.
    pub tile: Arc<Tile>,
    /// Four bytes a pixel, rows from the top; `None` where they are as before.
    pub rgba: Option<Vec<u8>>,
    /// How far it is from the reference, where there is one.
    pub errors: Option<TileErrors>,
}

/// Shows and measures what has changed.
#[derive(Default)]
pub struct Shower {
    number: u64,
    done: BTreeMap<usize, Done>,
}

/// What a tile was last shown and measured by.
struct Done {
    tile: Arc<Tile>,
    display: DisplayTransform,
    measured: Option<(Arc<Tile>, Arc<ReferenceImage>, DisplayTransform, TileErrors)>,
}

type ShowControl = Control<Option<Show>, Shown>;

impl Service for Shower {
    type Job = Option<Show>;
    type Update = Shown;

    fn serve(&mut self, show: Option<Show>, control: &ShowControl) {
        let Some(show) = show else { return };
        if self.number != show.number {
            (self.number, self.done) = (show.number, BTreeMap::new());
        }
        let tiles = || show.tiles.iter().enumerate().filter_map(|(place, tile)| Some((place, tile.as_ref()?)));
        for (place, tile) in tiles() {
            self.picture(place, tile, &show, control);
        }
        // figures wait for pictures
        for (place, tile) in tiles() {
            if control.ends_soon() {
                return;
            }
            self.measure(place, tile, &show, control);
        }
    }

    fn recover(&mut self, _control: &ShowControl) {
        self.done.clear();
    }
}

impl Shower {
    fn picture(&mut self, place: usize, tile: &Arc<Tile>, show: &Show, control: &ShowControl) {
        let same = |done: &Done| Arc::ptr_eq(&done.tile, tile) && done.display == show.display;
        if self.done.get(&place).is_some_and(same) {
            return;
        }
        let rgba = show.display.rgba8_of(&tile.image);
        let measured = self.done.remove(&place).and_then(|done| done.measured);
        // errors are of one picture alone
        let errors = measured.as_ref().filter(|(of, ..)| Arc::ptr_eq(of, tile)).map(|(.., errors)| *errors);
        self.done.insert(place, Done { tile: tile.clone(), display: show.display, measured });
        tell(control, show, place, ShownTile { tile: tile.clone(), rgba: Some(rgba), errors });
    }

    fn measure(&mut self, place: usize, tile: &Arc<Tile>, show: &Show, control: &ShowControl) {
        let (Some(reference), Some(done)) = (&show.reference, self.done.get_mut(&place)) else { return };
        let same = |(of, by, display, _): &(Arc<Tile>, Arc<ReferenceImage>, DisplayTransform, _)| {
            Arc::ptr_eq(of, tile) && Arc::ptr_eq(by, reference) && *display == show.display
        };
        let has_light = tile.provenance.technique.has_a_reference() && tile.facts.has_a_picture();
        if done.measured.as_ref().is_some_and(same) || !has_light {
            return;
        }
        let Ok(errors) = measure(&tile.image, reference, &show.display) else { return };
        done.measured = Some((tile.clone(), reference.clone(), show.display, errors));
        tell(control, show, place, ShownTile { tile: tile.clone(), rgba: None, errors: Some(errors) });
    }
}

/// Bytes that nobody has collected yet stay, if nothing newer takes their place.
fn tell(control: &ShowControl, show: &Show, place: usize, mut tile: ShownTile) {
    control.tell(|shown| {
        if shown.number != show.number {
            *shown = Shown { number: show.number, tiles: BTreeMap::new() };
        }
        let before = shown.tiles.remove(&place).and_then(|before| before.rgba);
        tile.rgba = tile.rgba.take().or(before);
        shown.tiles.insert(place, tile);
    });
}
