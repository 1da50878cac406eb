//! Words of which one is chosen, on one ground so that they are seen to belong together.

use super::Explained;
use crate::ui::Dump;
use crate::ui::theme::palette;
use egui::{Button, Color32, CornerRadius, Frame, Margin, Stroke, TextStyle, Ui, vec2};

/// A row of words of which one is chosen; wraps where the panel is narrow. `words` are name, explanation and whether it is chosen; `prefix`
/// begins their names in the dump, and `label`, what stands before them, those for screen readers, to whom "on" alone says nothing: empty where
/// the words say enough. Returns the index of the one that was clicked.
pub fn choice(
    (prefix, label): (&str, &str),
    words: impl IntoIterator<Item = (String, &'static str, bool)>,
    ui: &mut Ui,
    dump: &mut Dump,
) -> Option<usize> {
    let mut clicked = None;
    segmented(ui, |ui| {
        for (index, (word, hover, chosen)) in words.into_iter().enumerate() {
            let spoken = if label.is_empty() { word.clone() } else { format!("{label}: {word}") };
            let button = ui.add(Button::selectable(chosen, &word)).explained(hover).accessible_name(spoken);
            if dump.note(&format!("{prefix} {word}"), chosen, button).clicked() {
                clicked = Some(index);
            }
        }
    });
    clicked
}

/// At both sides of a word.
const PADDING: f32 = 7.0;
/// Points between two words of a choice.
const GAP: f32 = 2.0;
/// Points of the frame around all of its words.
const AROUND: i8 = 2;
/// Of the line about the ground.
const LINE: f32 = 1.0;

/// How wide the ground of these words is where they stand in one row.
pub fn width_of_segments<'a>(words: impl Iterator<Item = &'a str>, ui: &Ui) -> f32 {
    let font = TextStyle::Button.resolve(ui.style());
    let text = |word: &str| ui.painter().layout_no_wrap(word.to_owned(), font.clone(), Color32::PLACEHOLDER).size().x;
    let segments: f32 = words.map(|word| text(word) + 2.0 * PADDING + GAP).sum();
    segments - GAP + 2.0 * (f32::from(AROUND) + LINE)
}

/// The ground of words to choose from.
pub fn segmented<R>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let palette = palette(ui);
    // on a card the panel's colour shows, and on a panel the card's
    let ground = if palette.panel == palette.card { palette.ground } else { palette.panel };
    let frame = Frame::new().fill(ground).corner_radius(CornerRadius::same(7)).inner_margin(Margin::same(AROUND));
    let frame = frame.stroke(Stroke::new(LINE, palette.line));
    let shown = frame.show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(GAP, GAP);
        ui.spacing_mut().button_padding.x = PADDING;
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
