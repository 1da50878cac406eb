//! A workspace that shows nothing, to begin another one from.

use super::Workspace;
use crate::model::{Model, Wanted};
use crate::ui::overlay::say;
use crate::ui::widgets::Icon;
use crate::ui::{UiContext, controls};
use egui::Ui;

/// Has neither pictures nor state.
pub struct Empty;

impl Workspace for Empty {
    fn id(&self) -> &'static str {
        "empty"
    }

    fn name(&self) -> &'static str {
        "Empty"
    }

    fn icon(&self) -> Icon {
        Icon::Empty
    }

    fn ui(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        controls::panel(cx, ui, |_, _| (), controls::scene);
        egui::CentralPanel::default().show(ui, |ui| say(cx, ui, ui.max_rect(), &["Nothing is shown here."]));
    }

    fn wanted(&self, model: &Model) -> Wanted {
        model.wanted([])
    }
}
