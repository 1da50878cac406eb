//! What the window shows while there is no scene yet.

use super::overlay::spoken;
use super::pressed::Keys;
use super::theme::{self, palette};
use super::{Dump, UiCommand};
use crate::model::Theme;
use egui::{Align2, CentralPanel, Frame, Key, TextStyle, Ui, vec2};

/// Says what is read and, once that is known, how far it is; returns what the user wants instead.
pub fn show_waiting(
    (name, doing): (&str, Option<&str>),
    theme: Theme,
    dump: &mut Dump,
    ui: &mut Ui,
) -> Option<UiCommand> {
    if theme::apply(theme, ui.ctx()) {
        ui.ctx().request_discard("another theme");
        ui.ctx().request_repaint();
        return None;
    }
    let palette = palette(ui);
    CentralPanel::default().frame(Frame::new().fill(palette.panel)).show(ui, |ui| {
        let room = ui.available_rect_before_wrap();
        let lines = [
            ("opening", format!("Opening {name}"), TextStyle::Heading, palette.text),
            ("loading", doing.unwrap_or("reading (Esc stops)").to_owned(), TextStyle::Body, palette.dim),
        ];
        let mut top = room.center();
        for (what, text, style, colour) in lines {
            let galley = ui.painter().layout(text.clone(), style.resolve(ui.style()), colour, 0.9 * room.width());
            let place = Align2::CENTER_TOP.anchor_size(top, galley.size());
            top = place.center_bottom() + vec2(0.0, 8.0);
            ui.painter().galley(place.min, galley, colour);
            dump.note_text(what, &text, place, room);
            spoken(ui, what, &text, place, true);
        }
    });
    let keys = Keys::of(ui.ctx());
    let stops = (keys.presses(Key::Escape) > 0).then_some(UiCommand::StopLoading);
    (keys.command(Key::Q) > 0).then_some(UiCommand::Quit).or(stops)
}
