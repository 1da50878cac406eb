//! The one set of icons: strokes on a square of 24 by 24, drawn in the colour of the text around them, sharp at any size.

use super::Explained;
use crate::ui::theme::palette;
use egui::{Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

/// What an icon stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Icon {
    /// An arrow back, for what is taken back.
    Undo,
    /// An arrow forth, for what is done again.
    Redo,
    /// The controls at the right.
    Controls,
    /// A question mark, for mouse and keys.
    Help,
    /// Two pictures with a line between them.
    Compare,
    /// Three pictures in a row, and three below.
    Sweep,
    /// A node, two below it, and four below these.
    Trees,
    /// A ladder of four rungs.
    Ladder,
    /// Two axes and a falling line.
    Plots,
    /// The corners of a rectangle, and a point in it.
    Region,
    /// A small square in a cross of hairs.
    Probe,
    /// A box, seen from a corner.
    Parts,
    /// A list of what is right, and what is not.
    Cases,
    /// A frame with nothing in it.
    Empty,
}

impl Icon {
    /// Its strokes, from corner to corner.
    fn strokes(self) -> &'static [&'static [(f32, f32)]] {
        match self {
            Icon::Undo => &[&[(9.0, 5.0), (4.0, 10.0), (9.0, 15.0)], UNDO_BOW],
            Icon::Redo => &[&[(15.0, 5.0), (20.0, 10.0), (15.0, 15.0)], REDO_BOW],
            Icon::Controls => &[
                &[(4.0, 7.0), (20.0, 7.0)],
                &[(4.0, 12.0), (20.0, 12.0)],
                &[(4.0, 17.0), (20.0, 17.0)],
                &[(9.0, 5.0), (9.0, 9.0)],
                &[(15.0, 10.0), (15.0, 14.0)],
                &[(8.0, 15.0), (8.0, 19.0)],
            ],
            Icon::Help => &[
                &[
                    (8.5, 9.0),
                    (9.0, 6.5),
                    (12.0, 5.0),
                    (15.0, 6.5),
                    (15.5, 9.0),
                    (14.0, 11.0),
                    (12.0, 12.5),
                    (12.0, 15.0),
                ],
                &[(12.0, 18.0), (12.0, 19.5)],
            ],
            Icon::Compare => {
                &[&[(3.0, 5.0), (21.0, 5.0), (21.0, 19.0), (3.0, 19.0), (3.0, 5.0)], &[(12.0, 5.0), (12.0, 19.0)]]
            }
            Icon::Sweep => &[
                &[(3.0, 5.0), (21.0, 5.0), (21.0, 19.0), (3.0, 19.0), (3.0, 5.0)],
                &[(9.0, 5.0), (9.0, 19.0)],
                &[(15.0, 5.0), (15.0, 19.0)],
                &[(3.0, 12.0), (21.0, 12.0)],
            ],
            Icon::Trees => &[
                &[(12.0, 4.0), (6.0, 12.0), (3.0, 20.0)],
                &[(6.0, 12.0), (9.0, 20.0)],
                &[(12.0, 4.0), (18.0, 12.0), (21.0, 20.0)],
                &[(18.0, 12.0), (15.0, 20.0)],
            ],
            Icon::Ladder => &[
                &[(7.0, 3.0), (7.0, 21.0)],
                &[(17.0, 3.0), (17.0, 21.0)],
                &[(7.0, 6.0), (17.0, 6.0)],
                &[(7.0, 10.0), (17.0, 10.0)],
                &[(7.0, 14.0), (17.0, 14.0)],
                &[(7.0, 18.0), (17.0, 18.0)],
            ],
            Icon::Plots => {
                &[&[(4.0, 4.0), (4.0, 20.0), (20.0, 20.0)], &[(7.0, 7.0), (11.0, 12.0), (15.0, 14.5), (20.0, 16.0)]]
            }
            Icon::Region => &[
                &[(4.0, 9.0), (4.0, 5.0), (9.0, 5.0)],
                &[(15.0, 5.0), (20.0, 5.0), (20.0, 9.0)],
                &[(20.0, 15.0), (20.0, 19.0), (15.0, 19.0)],
                &[(9.0, 19.0), (4.0, 19.0), (4.0, 15.0)],
                &[(11.0, 12.0), (13.0, 12.0)],
                &[(12.0, 11.0), (12.0, 13.0)],
            ],
            Icon::Probe => &[
                &[(9.5, 9.5), (14.5, 9.5), (14.5, 14.5), (9.5, 14.5), (9.5, 9.5)],
                &[(12.0, 3.0), (12.0, 9.5)],
                &[(12.0, 14.5), (12.0, 21.0)],
                &[(3.0, 12.0), (9.5, 12.0)],
                &[(14.5, 12.0), (21.0, 12.0)],
            ],
            Icon::Parts => &[
                &[(12.0, 3.0), (20.0, 7.5), (20.0, 16.5), (12.0, 21.0), (4.0, 16.5), (4.0, 7.5), (12.0, 3.0)],
                &[(4.0, 7.5), (12.0, 12.0), (20.0, 7.5)],
                &[(12.0, 12.0), (12.0, 21.0)],
            ],
            Icon::Cases => &[
                &[(4.0, 7.0), (6.0, 9.0), (9.0, 5.0)],
                &[(12.0, 7.0), (20.0, 7.0)],
                &[(4.0, 14.5), (8.5, 19.0)],
                &[(8.5, 14.5), (4.0, 19.0)],
                &[(12.0, 17.0), (20.0, 17.0)],
            ],
            Icon::Empty => &[&[(3.0, 5.0), (21.0, 5.0), (21.0, 19.0), (3.0, 19.0), (3.0, 5.0)]],
        }
    }

    /// Draws it into the square in the middle of `rect`.
    pub fn paint(self, ui: &Ui, rect: Rect, side: f32, stroke: Stroke) {
        let corner = rect.center() - 0.5 * vec2(side, side);
        let place = |&(x, y): &(f32, f32)| -> Pos2 { corner + side / 24.0 * vec2(x, y) };
        for line in self.strokes() {
            ui.painter().line(line.iter().map(place).collect(), stroke);
        }
    }
}

const UNDO_BOW: &[(f32, f32)] =
    &[(4.0, 10.0), (14.0, 10.0), (17.5, 11.2), (19.6, 13.8), (19.6, 16.2), (17.5, 18.8), (14.0, 20.0), (10.0, 20.0)];
const REDO_BOW: &[(f32, f32)] =
    &[(20.0, 10.0), (10.0, 10.0), (6.5, 11.2), (4.4, 13.8), (4.4, 16.2), (6.5, 18.8), (10.0, 20.0), (14.0, 20.0)];

/// A button that is an icon, for eyes; screen readers have its name, and the mouse an explanation.
pub fn icon_button(icon: Icon, (name, hover): (&str, &str), (enabled, chosen): (bool, bool), ui: &mut Ui) -> Response {
    let height = ui.spacing().interact_size.y;
    let sense = if enabled { Sense::click() } else { Sense::hover() };
    let (rect, response) = ui.allocate_exact_size(vec2(1.2 * height, height), sense);
    let palette = palette(ui);
    let visuals = ui.style().interact_selectable(&response, chosen);
    if chosen || (enabled && response.hovered()) {
        let ground = if chosen { palette.chosen } else { palette.hovered };
        ui.painter().rect_filled(rect, visuals.corner_radius, ground);
    }
    if response.has_focus() {
        ui.painter().rect_stroke(rect, visuals.corner_radius, Stroke::new(1.0, palette.accent), StrokeKind::Inside);
    }
    let colour = if enabled { palette.text } else { palette.dim.gamma_multiply(0.6) };
    icon.paint(ui, rect, 0.72 * height, Stroke::new((height / 16.0).max(1.4), colour));
    response.widget_info(|| WidgetInfo::selected(Role::Button, enabled, chosen, name));
    response.explained(hover)
}

/// An icon above a word, for the rail at the left; returns the whole as a button.
pub fn icon_and_word(icon: Icon, word: &str, chosen: bool, ui: &mut Ui) -> Response {
    let side = 4.0 * ui.text_style_height(&egui::TextStyle::Small);
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::click());
    let palette = palette(ui);
    if chosen || response.hovered() {
        ui.painter().rect_filled(rect, 8.0, if chosen { palette.card } else { palette.hovered });
    }
    let colour = if chosen { palette.text } else { palette.dim };
    let upper = Rect::from_min_max(rect.min, pos2(rect.right(), rect.top() + 0.62 * side));
    icon.paint(ui, upper, 0.4 * side, Stroke::new(1.6, colour));
    let font = egui::TextStyle::Small.resolve(ui.style());
    let at = pos2(rect.center().x, rect.bottom() - 0.08 * side);
    ui.painter().text(at, egui::Align2::CENTER_BOTTOM, word, font, colour);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, word));
    response
}
