//! The region that figures speak of: marked by a drag, and drawn on every picture.

use super::magnify;
use crate::model::{Drag, Region};
use crate::ui::UiContext;
use egui::{Color32, CursorIcon, Painter, Rect, Response, Stroke, StrokeKind, Ui, vec2};

/// Smaller than this, in points, it is a slip of the mouse.
const LEAST: f32 = 4.0;

/// Goes on with a drag that marks it, and takes it when that ends.
pub fn drag(cx: &mut UiContext, response: &Response, frames: &[Rect], [from, to]: [[f32; 2]; 2]) {
    let state = &mut cx.model.state;
    // in the picture that it began in, also where it goes beyond that
    let begun = response.ctx.input(|i| i.pointer.press_origin());
    let place = |at| magnify::picture_at_from(&state.magnification, frames, (begun.unwrap_or(at), at));
    let to = response.interact_pointer_pos().map_or(to, place);
    state.drag = Drag::Region([from, to]);
    if !response.drag_stopped() {
        return;
    }
    let size = frames.first().map_or(vec2(1.0, 1.0), Rect::size) * state.magnification.factor() as f32;
    let large = |region: &Region| {
        let [width, height] = [0, 1].map(|axis| region.end[axis] - region.start[axis]);
        width * size.x >= LEAST && height * size.y >= LEAST
    };
    if let Some(region) = Region::between(from, to).filter(large) {
        cx.model.session.comparison.region = Some(region);
        (state.marking, state.hint) = (false, false);
    }
}

/// Draws it on a picture that lies at `place`, or what of it is being marked.
pub fn show(cx: &UiContext, painter: &Painter, place: Rect) {
    let marked = match cx.model.state.drag {
        Drag::Region([from, to]) => Region::between(from, to),
        _ => cx.model.session.comparison.region,
    };
    let Some(Region { start, end }) = marked else { return };
    let corner = |[x, y]: [f32; 2]| place.min + vec2(x, y) * place.size();
    let rect = Rect::from_min_max(corner(start), corner(end));
    for (width, colour) in [(4.0, Color32::from_black_alpha(170)), (2.0, Color32::from_rgb(255, 225, 90))] {
        painter.rect_stroke(rect, 0.0, Stroke::new(width, colour), StrokeKind::Middle);
    }
}

/// Begins to mark one, or goes back to the whole picture.
pub fn toggle(cx: &mut UiContext) {
    if !end(cx) {
        cx.model.state.marking = true;
    }
}

/// Ends what is marked or to be marked; returns whether there was anything.
pub fn end(cx: &mut UiContext) -> bool {
    if matches!(cx.model.state.drag, Drag::Region(_)) {
        // what was there before the drag stays
        (cx.model.state.drag, cx.model.state.marking) = (Drag::Camera, false);
        return true;
    }
    let marking = std::mem::take(&mut cx.model.state.marking);
    marking || cx.model.session.comparison.region.take().is_some()
}

/// Says what a drag would do.
pub fn show_cursor(cx: &UiContext, ui: &Ui, response: &Response) {
    if cx.model.state.marking && response.hovered() {
        ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
    }
}
