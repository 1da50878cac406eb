//! Which effects of light the map of errors names: asked for and put up.

use super::Viewer;
use crate::model::Wanted;
use crate::viewer::presentation::Presentation;
use serde_json::{Value, json};
use technique::Shot;

impl Viewer {
    /// Asks for the effects of what is wanted, and for their shares of the errors that are shown.
    pub(super) fn ask_effects(&mut self, wanted: &Wanted) {
        let errors = self.presentation.shown.map.as_ref();
        self.engine.follow_effects(&mut self.effects, wanted.effects.clone(), errors);
    }

    /// Puts up what is new of them.
    pub(super) fn collect_effects(&mut self) {
        match self.effects.collect() {
            Some(Ok(found)) => self.presentation.shown.effects = Some(found),
            Some(Err(why)) => self.model.say(Err(format!("effects cannot be found in the picture: {why}"))),
            None => {}
        }
    }

    /// What is known of them, for tests.
    pub(super) fn effects_dump(&self) -> Value {
        let shares = self.presentation.shown.effects.iter().flat_map(|effects| &effects.shares);
        shares.map(|share| json!([share.effect.name(), share.pixels, share.error])).collect()
    }
}

impl Presentation {
    /// Takes down the effects of another view than is wanted.
    pub(super) fn keep_effects(&mut self, wanted: &Wanted) {
        let is_wanted = |shot: &Shot| wanted.effects.as_ref().is_some_and(|wish| wish.is_of_the_same_view(shot));
        self.shown.effects.take_if(|effects| !is_wanted(&effects.of_view.shot));
    }
}
