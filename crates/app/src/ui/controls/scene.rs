//! What is changed in the scene, for both panes at once.

use super::setting::{Change, Place};
use crate::model::{Model, SwitchedOff};
use crate::ui::UiContext;
use egui::Ui;
use technique::SceneChanges;
use technique::settings::{OF_SCENES, Setting};

/// What can be changed in the scene that is open.
pub fn usable(model: &Model) -> impl Iterator<Item = &'static Setting<SceneChanges>> {
    OF_SCENES.iter().filter(|row| row.needs.missing_in(model.document.seen()).is_none())
}

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    for setting in usable(cx.model).collect::<Vec<_>>() {
        let document = &mut cx.model.document;
        let seen = document.seen().clone();
        let kept = &mut SwitchedOff::default();
        let mut place = Place { pane: None, scene: &seen, kept, dump: cx.dump, fault: None };
        match place.show(setting, &document.changes, ui) {
            Some(Change::Set(value)) => (setting.set)(&mut document.changes, value),
            Some(Change::Reset) => document.changes.reset(setting),
            None => {}
        }
        if let Some(fault) = place.fault {
            cx.model.say(Err(fault));
        }
    }
}
