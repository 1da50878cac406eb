//! Cards: what belongs together on a panel, with the colour of its pane on the edge.

use crate::ui::theme::{palette, semi_bold};
use egui::collapsing_header::CollapsingState;
use egui::{Align2, Color32, CornerRadius, FontId, Frame, Id, Margin, Rect, Response, Sense, Stroke, StrokeKind};
use egui::{Role, TextStyle, Ui, WidgetInfo, pos2, vec2};

/// Between the edge of a card and what is on it.
const INSIDE: Margin = Margin { left: 11, right: 11, top: 9, bottom: 10 };

/// A card over the whole width; `edge` colours its left side.
pub fn card<R>(edge: Option<Color32>, ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let palette = palette(ui);
    let line = if palette.card == palette.panel { Stroke::NONE } else { Stroke::new(1.0, palette.card) };
    let frame = Frame::new().fill(palette.card).corner_radius(CornerRadius::same(9)).inner_margin(INSIDE).stroke(line);
    let shown = frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        contents(ui)
    });
    if let Some(colour) = edge {
        let rect = shown.response.rect;
        let left = Rect::from_min_max(rect.min, pos2(rect.left() + 3.0, rect.bottom()));
        ui.painter().rect_filled(left, CornerRadius { nw: 3, sw: 3, ne: 0, se: 0 }, colour);
    }
    ui.add_space(4.0);
    shown.inner
}

/// A title that folds what is below it. `id` remembers whether it does; `open` says it at first. Returns the title and whether it is unfolded.
pub fn fold(
    title: &str,
    colour: Option<Color32>,
    (id, open): (Id, bool),
    ui: &mut Ui,
    contents: impl FnOnce(&mut Ui),
) -> (Response, bool) {
    let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, open);
    let size = vec2(ui.available_width(), ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    if response.clicked() {
        state.toggle(ui);
    }
    let open = state.is_open();
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, open, title));
    let colour = if response.hovered() { None } else { colour };
    paint_title(ui, rect, title, colour.unwrap_or(palette(ui).text), open);
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 4.0, Stroke::new(1.0, palette(ui).accent), StrokeKind::Outside);
    }
    state.store(ui.ctx());
    if open {
        contents(ui);
    }
    (response, open)
}

fn paint_title(ui: &Ui, rect: Rect, title: &str, colour: Color32, open: bool) {
    let icon = ui.spacing().icon_width;
    let chevron = Rect::from_min_size(rect.min, vec2(0.8 * icon, rect.height()));
    paint_chevron(ui, chevron, open);
    let font = FontId::new(TextStyle::Body.resolve(ui.style()).size, semi_bold());
    let at = pos2(chevron.right() + 6.0, rect.center().y);
    ui.painter().with_clip_rect(rect).text(at, Align2::LEFT_CENTER, title, font, colour);
}

/// Points down where what is below is unfolded, and right where it is not.
fn paint_chevron(ui: &Ui, rect: Rect, open: bool) {
    let reach = 0.3 * rect.width();
    let corners = if open {
        [vec2(-1.0, -0.5), vec2(0.0, 0.5), vec2(1.0, -0.5)]
    } else {
        [vec2(-0.5, -1.0), vec2(0.5, 0.0), vec2(-0.5, 1.0)]
    };
    let points = corners.map(|corner| rect.center() + reach * corner);
    ui.painter().line(points.to_vec(), Stroke::new(1.5, palette(ui).dim));
}
