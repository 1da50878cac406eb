//! Words of which one is chosen, on one ground so that they are seen to belong together.

use super::Explained;
use crate::ui::Dump;
use crate::ui::theme::palette;
use egui::{Button, CornerRadius, Frame, Margin, Stroke, Ui, vec2};

/// A row of words of which one is chosen; wraps where the panel is narrow. `words` are name, explanation and whether it is chosen; `prefix`
/// begins their names in the dump. Returns the index of the one that was clicked.
pub fn choice(
    prefix: &str,
    words: impl IntoIterator<Item = (String, &'static str, bool)>,
    ui: &mut Ui,
    dump: &mut Dump,
) -> Option<usize> {
    let mut clicked = None;
    segmented(ui, |ui| {
        for (index, (word, hover, chosen)) in words.into_iter().enumerate() {
            let button = ui.add(Button::selectable(chosen, &word)).explained(hover);
            if dump.note(&format!("{prefix} {word}"), chosen, button).clicked() {
                clicked = Some(index);
            }
        }
    });
    clicked
}

/// The ground of words to choose from.
pub fn segmented<R>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let palette = palette(ui);
    // on a card the panel's colour shows, and on a panel the card's
    let ground = if palette.panel == palette.card { palette.ground } else { palette.panel };
    let frame = Frame::new().fill(ground).corner_radius(CornerRadius::same(7)).inner_margin(Margin::same(2));
    let frame = frame.stroke(Stroke::new(1.0, palette.line));
    let shown = frame.show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(2.0, 2.0);
        ui.spacing_mut().button_padding.x = 7.0;
        ui.spacing_mut().interact_size.y -= 4.0;
        let visuals = ui.visuals_mut();
        visuals.widgets.inactive.fg_stroke.color = palette.dim;
        for widget in [&mut visuals.widgets.inactive, &mut visuals.widgets.hovered, &mut visuals.widgets.active] {
            widget.corner_radius = CornerRadius::same(5);
        }
        ui.horizontal_wrapped(contents).inner
    });
    shown.inner
}
