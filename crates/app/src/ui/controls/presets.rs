//! Settings by name, for a pane.

use crate::model::PaneId;
use crate::ui::UiContext;
use crate::ui::widgets::{Explained, menu as menu_of, rows_of_menu};
use egui::{Color32, TextStyle, Ui};
use technique::presets;

/// What may stand on the menu's button, the more telling first.
pub const TITLES: [&str; 2] = ["Presets", "…"];

/// How wide the menu's button is.
pub fn width(title: &str, ui: &Ui) -> f32 {
    let font = TextStyle::Button.resolve(ui.style());
    let text = ui.painter().layout_no_wrap(title.into(), font, Color32::PLACEHOLDER);
    text.size().x + 2.0 * ui.spacing().button_padding.x
}

/// The menu of presets of a pane.
pub fn menu(cx: &mut UiContext, pane: PaneId, title: &str, ui: &mut Ui) {
    let (response, _) = menu_of(title).ui(ui, |ui| {
        rows_of_menu(ui, |ui| {
            for preset in presets::ALL {
                let hover = format!("{}: {}", preset.about, preset.words());
                let button = ui.button(preset.title).explained(&hover);
                if cx.dump.note(&format!("{pane} preset {}", preset.name), "", button).clicked() {
                    cx.model.take_preset(pane, preset);
                    ui.close();
                }
            }
        })
    });
    let button = response.explained("The tutorial's settings by name");
    cx.dump.note(&format!("{pane} presets"), "", button.accessible_name(format!("Presets of {pane}")));
}
