//! Which shape each pixel shows: put up as it comes.

use super::{Place, TextureStore, Viewer};
use crate::engine::objects::FoundObjects;
use crate::model::Wanted;
use crate::viewer::presentation::Presentation;
use egui::TextureFilter;
use serde_json::{Value, json};

impl Viewer {
    /// Puts up what is new of where parts are seen.
    pub(super) fn collect_objects(&mut self, textures: &mut impl TextureStore) {
        match self.engine.objects.collect() {
            Some(Ok(found)) => self.presentation.update_objects(found, textures),
            Some(Err(why)) => self.model.say(Err(format!("parts cannot be found in the picture: {why}"))),
            None => {}
        }
    }

    /// What is known of where parts are seen, for tests.
    pub(super) fn objects_dump(&self) -> Value {
        let shown = &self.presentation.shown;
        json!({
            "size": shown.objects.as_ref().map(|map| map.size),
            "outlined": self.presentation.textures.outline.is_some(),
            "along": shown.along.as_ref().map(|along| &along.shapes),
        })
    }
}

impl Presentation {
    fn update_objects(&mut self, found: FoundObjects, textures: &mut impl TextureStore) {
        let FoundObjects { map, outline, along } = found;
        // linear: the map is coarser than the picture
        self.textures.outline =
            outline.map(|outline| textures.upload(Place::Outline, outline.size, &outline.rgba, TextureFilter::Linear));
        (self.shown.objects, self.shown.along) = (Some(map), along);
    }

    /// Takes down what is of another view than is wanted, and what lay behind each other at another place.
    pub(super) fn keep_objects(&mut self, wanted: &Wanted) {
        let wish = wanted.objects.as_ref();
        let is_wanted = |map: &_| wish.is_some_and(|wish| wish.is_of_the_view_of(map));
        if !self.shown.objects.as_deref().is_some_and(is_wanted) {
            (self.shown.objects, self.shown.along, self.textures.outline) = (None, None, None);
        }
        self.shown.along.take_if(|along| wish.and_then(|wish| wish.looked_into) != Some(along.at));
    }
}
