//! Rays through the statue: put up as they come.

use super::{Place, TextureStore, Viewer};
use crate::engine::restore::SESSION;
use crate::model::{SavedSession, TREES};
use egui::TextureFilter;
use image_file::Records;
use serde_json::{Value, json};

impl Viewer {
    /// Puts up what is new of the trees.
    pub(super) fn collect_trees(&mut self, textures: &mut impl TextureStore) {
        let Some(news) = self.engine.trees_news() else { return };
        let shown = &mut self.presentation.shown.trees;
        for (known, new) in shown.facts.iter_mut().zip(news.facts) {
            *known = new.or(known.take());
        }
        shown.most = news.most.unwrap_or(shown.most);
        shown.points = news.points.unwrap_or_else(|| std::mem::take(&mut shown.points));
        shown.doing = news.doing.unwrap_or_else(|| shown.doing.take());
        shown.camera = news.camera.or(shown.camera);
        for (place, picture) in news.pictures.into_iter().enumerate() {
            let Some(picture) = picture else { continue };
            let up = textures.upload(Place::Trees(place), picture.size, &picture.rgba, TextureFilter::Nearest);
            self.presentation.textures.trees[place] = Some(up);
        }
    }

    /// What a picture of the trees or of a ladder keeps: the session, which opens as them.
    pub(super) fn records_of_the_session(&self) -> Records {
        let document = &self.model.document;
        vec![(SESSION, SavedSession::of(&self.model, None).text(&document.scene, &document.source))]
    }

    /// What is known of the trees, for tests.
    pub(super) fn trees_dump(&self) -> Value {
        let trees = &self.presentation.shown.trees;
        let facts = trees.facts.iter().flatten().map(|facts| {
            json!({
                "structure": facts.structure.name(), "rays": facts.rays,
                "boxes": facts.boxes_a_ray, "triangles": facts.triangles_a_ray,
            })
        });
        let facts: Vec<Value> = facts.collect();
        json!({ "open": self.model.session.is_in(TREES), "facts": facts, "points": trees.points.len(), "doing": trees.doing })
    }
}
