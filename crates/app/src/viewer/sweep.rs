//! The tiles of a sweep: put up as they come, and kept for export.

use super::{Place, TextureStore, Viewer};
use crate::engine::export::{Content, Export};
use crate::engine::restore::SESSION;
use crate::engine::sweep::ShownTile;
use crate::model::{Destination, SWEEP, SavedSession, SweepFile, SweepView, TileFacts, sweep_csv};
use crate::sweep::{Sheet, Tile};
use egui::TextureFilter;
use serde_json::{Value, json};
use std::sync::Arc;

/// What there is of a sweep.
#[derive(Debug, Default)]
pub struct MadeSweep {
    /// As the engine counts it.
    number: u64,
    /// In the order of the plan.
    tiles: Vec<Option<Arc<Tile>>>,
}

impl Viewer {
    /// Puts up what is new of the sweep.
    pub(super) fn collect_sweep(&mut self, textures: &mut impl TextureStore) {
        let Some(news) = self.engine.sweep_news() else { return };
        if self.sweep.number != news.number {
            self.sweep = MadeSweep { number: news.number, tiles: Vec::new() };
            self.presentation.shown.sweep = SweepView::default();
            self.presentation.textures.tiles.clear();
        }
        for (place, tile) in news.tiles {
            self.put_up_tile(place, tile, textures);
        }
        let shown = &mut self.presentation.shown.sweep;
        shown.reference = news.reference.or(shown.reference.take());
        news.faults.into_iter().for_each(|fault| self.model.say(Err(fault)));
    }

    fn put_up_tile(&mut self, place: usize, shown: ShownTile, textures: &mut impl TextureStore) {
        let ShownTile { tile, rgba, errors } = shown;
        let view = &mut self.presentation.shown.sweep.tiles;
        let places = view.len().max(place + 1);
        view.resize(places, TileFacts::default());
        // while it is made, the figure of a moment ago stands until the next has been measured
        let errors = errors.or(view[place].errors.filter(|_| !tile.facts.done));
        view[place] = TileFacts { errors, ..tile.facts.clone() };
        let up = &mut self.presentation.textures.tiles;
        up.resize(up.len().max(places), None);
        if let Some(rgba) = rgba.filter(|_| tile.facts.has_a_picture()) {
            let size = tile.image.size();
            up[place] = Some(textures.upload(Place::Tile(place), size, &rgba, TextureFilter::Nearest));
        }
        self.sweep.tiles.resize(places, None);
        self.sweep.tiles[place] = Some(tile);
    }

    /// Writes all tiles with their captions, or the captions as a table.
    pub(super) fn export_sweep(&mut self, file: SweepFile, to: Destination) {
        let facts = &self.presentation.shown.sweep.tiles;
        let done = facts.iter().filter(|tile| tile.done).count();
        let plan = self.model.state.sweep.plan.clone().filter(|plan| plan.tiles.len() == done);
        let Some(plan) = plan else {
            return self.model.say(Err("not all tiles are done yet; try again in a moment".into()));
        };
        let (measure, display) = (self.model.session.sweep.measure, self.model.session.display);
        let mut saved = SavedSession::of(&self.model, None);
        saved.session.show_sweep(&plan);
        let content = match file {
            SweepFile::Table => Content::Text(sweep_csv(&plan, facts)),
            SweepFile::Picture => Content::Sweep(Box::new(Sheet {
                plan,
                tiles: self.sweep.tiles.clone(),
                facts: facts.clone(),
                measure,
                display,
            })),
        };
        let document = &self.model.document;
        let session = saved.text(&document.scene, &document.source);
        self.engine.export(Export { content, records: vec![(SESSION, session)], to });
    }

    /// What is known of the tiles, for tests.
    pub(super) fn sweep_dump(&self) -> Value {
        let sweep = &self.presentation.shown.sweep;
        let tile = |tile: &TileFacts| {
            json!({
                "spp": tile.spp, "seconds": tile.seconds, "done": tile.done, "fault": tile.fault,
                "rel_mse": tile.errors.map(|errors| errors.errors.rel_mse),
            })
        };
        let tiles: Vec<Value> = sweep.tiles.iter().map(tile).collect();
        json!({
            "open": self.model.session.is_in(SWEEP),
            "tiles": tiles,
            "reference": sweep.reference.as_ref().map(|r| [r.pictures, u32::from(r.done)]),
        })
    }
}
