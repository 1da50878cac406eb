//! The rungs of a ladder: put up as they are reached, and kept to be saved.

use super::{Place, TextureStore, Viewer};
use crate::engine::export::{Content, Export};
use crate::engine::ladder::OF_THE_REFERENCE;
use crate::engine::sweep::ShownTile;
use crate::ladder::Made;
use crate::model::{Destination, LADDER, LadderView, Rung, RungFacts};
use egui::TextureFilter;
use serde_json::{Value, json};
use std::sync::Arc;

/// What there is of a ladder.
#[derive(Default)]
pub struct MadeLadder {
    /// As the engine counts it.
    number: u64,
    /// In the order in which they were reached.
    rungs: Vec<Made>,
}

impl Viewer {
    /// Puts up what is new of the ladder.
    pub(super) fn collect_ladder(&mut self, textures: &mut impl TextureStore) {
        let Some(news) = self.engine.ladder_news() else { return };
        if self.ladder.number != news.number {
            self.ladder = MadeLadder { number: news.number, rungs: Vec::new() };
            self.presentation.shown.ladder = LadderView::default();
            self.presentation.textures.ladder = Default::default();
        }
        let shown = &mut self.presentation.shown.ladder;
        shown.rungs.resize(Rung::COUNT, None);
        if !news.made.is_empty() {
            for made in &news.made {
                let facts = &mut shown.rungs[made.rung.place()];
                let errors = facts.as_ref().and_then(|facts| facts.errors);
                let Made { pane, frame_ms, anew_ms, .. } = *made;
                *facts = Some(RungFacts { pane, errors, frame_ms, anew_ms });
            }
            shown.climbed = news.made.iter().map(|made| made.rung).collect();
            self.ladder.rungs = news.made;
        }
        shown.reference = news.reference.or(shown.reference.take());
        shown.doing = news.doing.unwrap_or_else(|| shown.doing.take());
        shown.fault = news.fault.clone().or(shown.fault.take());
        news.fault.into_iter().for_each(|fault| self.model.say(Err(fault)));
        if let Some(map) = news.map {
            self.presentation.textures.ladder.map = map.as_ref().map(|(_, map)| {
                let size = (map.map.width, map.map.height());
                textures.upload(Place::LadderMap, size, &map.rgba, TextureFilter::Nearest)
            });
            self.presentation.shown.ladder.map = map.map(|(rung, map)| (rung, Arc::new(map)));
        }
        for (place, tile) in news.shown {
            self.put_up_rung(place, tile, textures);
        }
    }

    fn put_up_rung(&mut self, place: usize, shown: ShownTile, textures: &mut impl TextureStore) {
        let ShownTile { tile, rgba, errors } = shown;
        if let Some(rgba) = rgba {
            // smaller than their place
            let up = textures.upload(Place::Rung(place), tile.image.size(), &rgba, TextureFilter::Linear);
            let of = &mut self.presentation.textures.ladder;
            if place == OF_THE_REFERENCE {
                of.reference = Some(up);
            } else {
                of.rungs.resize(Rung::COUNT, None);
                of.rungs[place] = Some(up);
            }
        }
        let facts = self.presentation.shown.ladder.rungs.get_mut(place).and_then(Option::as_mut);
        if let (Some(facts), Some(errors)) = (facts, errors) {
            facts.errors = Some(errors);
        }
    }

    /// Writes all rungs into a folder, as `visavis ladder` does.
    pub(super) fn export_ladder(&mut self, to: Destination) {
        let rungs = &self.ladder.rungs;
        let is_whole = rungs.last().is_some_and(|made| made.rung == Rung::Path);
        match self.engine.ladder_to_save(&self.model.document.scene.name, rungs).filter(|_| is_whole) {
            Some(ladder) => {
                let content = Content::Ladder(Box::new(ladder));
                self.engine.export(Export { content, records: Vec::new(), to });
            }
            None => self.model.say(Err("not all rungs are reached and measured yet; try again in a moment".into())),
        }
    }

    /// What is known of the ladder, for tests.
    pub(super) fn ladder_dump(&self) -> Value {
        let ladder = &self.presentation.shown.ladder;
        let textures = &self.presentation.textures.ladder;
        let rung = |rung: &Rung| {
            let facts = ladder.facts(*rung);
            json!({
                "name": rung.name(), "anew_ms": facts.map(|facts| facts.anew_ms),
                "rel_mse": facts.and_then(|facts| Some(facts.errors?.errors.rel_mse)),
                "picture": textures.rungs.get(rung.place()).is_some_and(Option::is_some),
            })
        };
        json!({
            "open": self.model.session.is_in(LADDER),
            "rungs": ladder.climbed.iter().map(rung).collect::<Vec<_>>(),
            "selected": self.model.session.ladder.selected.name(),
            "reference": ladder.reference.as_ref().map(|r| [r.pictures, u32::from(r.done)]),
            "map": ladder.map.as_ref().map(|(rung, _)| rung.name()),
            "doing": ladder.doing,
            "fault": ladder.fault,
        })
    }
}
