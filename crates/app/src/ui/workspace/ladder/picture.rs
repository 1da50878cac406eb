//! The picture of the rung that is selected: beside the reference, in front of a line, or as the map of its errors.

use crate::model::{LadderShows, Rung};
use crate::ui::UiContext;
use crate::ui::overlay::{say, spoken, text_box};
use crate::ui::theme::palette;
use crate::ui::workspace::compare::legend;
use egui::{
    Align2, Color32, CursorIcon, EventFilter, Key, Rect, Response, Sense, Stroke, TextureId, Ui, Vec2, pos2, vec2,
};

/// Between two pictures, in points.
const GAP: f32 = 8.0;
/// Width over height of all pictures.
const ASPECT: f32 = 16.0 / 9.0;
/// What an arrow key moves the line by, in shares of the picture.
const STEP: f32 = 0.02;

/// A picture that may be shown, and what it is called.
struct Picture {
    texture: Option<TextureId>,
    name: String,
    /// What is said where there is none.
    without: &'static str,
}

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let room = ui.max_rect();
    let ladder = cx.model.session.ladder;
    let rung = of_rung(cx, ladder.selected);
    let reference = Picture {
        texture: cx.textures.ladder.reference,
        name: "Reference".into(),
        without: "no reference yet: it is made once the rungs are there",
    };
    match ladder.shows {
        LadderShows::Beside => {
            let [first, second] = beside(room);
            whole(cx, ui, first, &rung);
            whole(cx, ui, second, &reference);
        }
        LadderShows::Wipe => wipe(cx, ui, fitted(room), [&rung, &reference]),
        LadderShows::Step => match cx.shown.ladder.below(ladder.selected) {
            Some(below) => {
                let below = of_rung(cx, below);
                wipe(cx, ui, fitted(room), [&below, &rung]);
            }
            None => whole(cx, ui, fitted(room), &rung),
        },
        LadderShows::Errors => errors(cx, ui, room, &rung),
    }
    let hints = std::mem::replace(&mut cx.model.state.hint, false);
    say(cx, ui, room, &[""]);
    cx.model.state.hint = hints;
}

fn of_rung(cx: &UiContext, rung: Rung) -> Picture {
    let climbed = cx.model.climbs(rung);
    let reached = cx.shown.ladder.facts(rung).is_some();
    let texture = cx.textures.ladder.rungs.get(rung.place()).copied().flatten().filter(|_| climbed && reached);
    let without = match (climbed, cx.shown.ladder.fault.is_some()) {
        (false, _) => "this rung is not climbed",
        (true, false) => "rendering ...",
        (true, true) => "this rung was not reached",
    };
    Picture { texture, name: rung.title().to_owned(), without }
}

/// The largest picture in the middle of a room.
fn fitted(room: Rect) -> Rect {
    let width = room.width().min(room.height() * ASPECT).max(16.0).floor();
    Rect::from_center_size(room.center(), vec2(width, (width / ASPECT).floor()))
}

/// Two pictures beside each other or below one another, whichever shows more.
fn beside(room: Rect) -> [Rect; 2] {
    let halves = [room.split_left_right_at_fraction(0.5), room.split_top_bottom_at_fraction(0.5)];
    let larger = halves.map(|(a, b)| [fitted(a.shrink(0.5 * GAP)), fitted(b.shrink(0.5 * GAP))]);
    let [across, down] = larger;
    if across[0].width() >= down[0].width() { across } else { down }
}

fn whole(cx: &mut UiContext, ui: &Ui, place: Rect, picture: &Picture) {
    paint(cx, ui, place, place, picture);
    label(cx, ui, place, picture, Align2::LEFT_TOP);
}

/// Two pictures of one place on either side of a line, which the mouse and the arrow keys move.
fn wipe(cx: &mut UiContext, ui: &Ui, place: Rect, [left, right]: [&Picture; 2]) {
    let response = ui.interact(place, ui.scope_id().with("wipe of the ladder"), Sense::click_and_drag());
    let response = response.accessible_name(format!("Picture: {} before {}", left.name, right.name));
    move_line(cx, ui, &response, place);
    let at = place.left() + cx.model.session.wipe * place.width();
    let (of_left, of_right) = place.split_left_right_at_x(at);
    paint(cx, ui, place, of_left, left);
    paint(cx, ui, place, of_right, right);
    for (width, colour) in [(4.0, Color32::from_black_alpha(140)), (2.0, Color32::WHITE)] {
        ui.painter().vline(at, place.y_range(), Stroke::new(width, colour));
    }
    if response.has_focus() {
        ui.painter().rect_stroke(place, 0.0, Stroke::new(2.0, Color32::YELLOW), egui::StrokeKind::Inside);
    }
    cx.dump.note("ladder picture", cx.model.session.wipe, response);
    label(cx, ui, place, left, Align2::LEFT_TOP);
    label(cx, ui, place, right, Align2::RIGHT_TOP);
}

fn move_line(cx: &mut UiContext, ui: &Ui, response: &Response, place: Rect) {
    if response.hovered() {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    let wipe = &mut cx.model.session.wipe;
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged() || response.clicked()) {
        *wipe = ((at.x - place.left()) / place.width()).clamp(0.0, 1.0);
    }
    if response.has_focus() {
        let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        let presses = |key| ui.input(|input| input.num_presses(key)) as f32;
        let steps = presses(Key::ArrowRight) - presses(Key::ArrowLeft);
        *wipe = (*wipe + STEP * steps).clamp(0.0, 1.0);
    }
}

/// At the foot of the room, so that where there is any the legend stands above it.
fn errors(cx: &mut UiContext, ui: &Ui, room: Rect, rung: &Picture) {
    let place = fitted(room);
    let place = place.translate(vec2(0.0, room.bottom() - place.bottom()));
    let shown = cx.shown;
    let selected = cx.model.session.ladder.selected;
    let map = shown.ladder.map.as_ref().filter(|(of, _)| *of == selected);
    let (Some((_, map)), Some(texture)) = (map, cx.textures.ladder.map) else {
        paint(cx, ui, place, place, rung);
        let text = "the map of errors comes with the reference";
        let at = text_box(ui, place, place.center(), Align2::CENTER_CENTER, text, Color32::WHITE);
        cx.dump.note_text("label no map", text, at, place);
        spoken(ui, "label no map", text, at, false);
        return;
    };
    let picture = Picture { texture: Some(texture), name: String::new(), without: "" };
    paint(cx, ui, place, place, &picture);
    if cx.model.state.labels {
        legend(cx, ui, room, map, None);
    }
}

/// The part of a picture at `place` that lies in `clip`.
fn paint(cx: &mut UiContext, ui: &Ui, place: Rect, clip: Rect, picture: &Picture) {
    let painter = ui.painter().with_clip_rect(clip);
    match picture.texture {
        Some(texture) => {
            let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(texture, place, all, Color32::WHITE);
        }
        None => {
            painter.rect_filled(place, 2.0, palette(ui).card);
            let name = format!("label without {}", picture.name);
            let at = text_box(ui, clip, clip.center(), Align2::CENTER_CENTER, picture.without, Color32::WHITE);
            cx.dump.note_text(&name, picture.without, at, clip);
            spoken(ui, &name, picture.without, at, false);
        }
    }
}

fn label(cx: &mut UiContext, ui: &Ui, place: Rect, picture: &Picture, corner: Align2) {
    if !cx.model.state.labels {
        return;
    }
    let inner = place.shrink2(Vec2::new(12.0, 8.0));
    let at = if corner == Align2::RIGHT_TOP { inner.right_top() } else { inner.left_top() };
    let at = text_box(ui, place, at, corner, &picture.name, Color32::WHITE);
    let name = format!("label {}", picture.name);
    cx.dump.note_text(&name, &picture.name, at, place);
    spoken(ui, &name, &picture.name, at, false);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_pictures_lie_where_they_are_largest() {
        let room = |width, height| Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height));
        let [a, b] = beside(room(500.0, 600.0));
        assert!(a.bottom() <= b.top() && a.width() > 450.0, "below one another: {a:?} {b:?}");
        let [a, b] = beside(room(1200.0, 400.0));
        assert!(a.right() <= b.left() && a.width() > 580.0, "beside each other: {a:?} {b:?}");
    }
}
