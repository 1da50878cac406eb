//! The scene of a case as it is rendered now, rings where rows look, and the verdict with the row that says most.

use super::LookedAt;
use super::table::number;
use crate::model::{CaseMark, PaneId, PictureArea, off_by, telling_row};
use crate::ui::UiContext;
use crate::ui::overlay::{say, spoken, text_box};
use crate::ui::theme::palette;
use check::{Mark, Relation, Verdict};
use egui::{Align2, Color32, Pos2, Rect, Stroke, Ui, pos2, vec2};
use film::Image;

/// Width of a letter and height of a line beside a ring in points, roughly: texts stay within the picture by them.
const LETTER: f32 = 8.0;
const LINE: f32 = 30.0;

/// Radius of a ring in points.
const RING: f32 = 7.0;

/// Draws picture, rings and verdict.
pub fn show(cx: &mut UiContext, looked_at: Option<&LookedAt>, ui: &mut Ui) {
    let room = ui.max_rect();
    let scale = ui.ctx().pixels_per_point();
    let pixels = (room.size() * scale).into();
    let shrink = cx.model.session.resolution.shrink();
    let corners = [room.left(), room.top(), room.right(), room.bottom()];
    cx.model.state.cases.area = PictureArea::new(pixels, pixels, shrink, corners);
    let Some(looked_at) = looked_at else { return };
    let shown = cx.shown.panes.get(PaneId::CASE);
    let is_of_this = shown
        .and_then(|shown| shown.provenance.as_ref())
        .is_some_and(|made| made.shot.source == looked_at.view.source && made.shot.scene.name == looked_at.scene.name);
    match cx.textures.panes.get(PaneId::CASE).filter(|_| is_of_this) {
        Some(texture) => {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(*texture, room, whole, Color32::WHITE);
        }
        None => _ = ui.painter().rect_filled(room, 0.0, palette(ui).card),
    }
    let image = shown.filter(|_| is_of_this).and_then(|shown| shown.image.as_ref());
    let camera = cx.model.state.cases.area.camera(&looked_at.scene.camera);
    let frame = camera.frame(room.width() / room.height().max(1.0));
    let seen = looked_at.view.marks.iter().filter_map(|mark| Some((mark, frame.project(mark.at)?)));
    let seen: Vec<(&Mark, [f32; 2])> = seen.map(|(mark, at)| (mark, [at.x, at.y])).collect();
    let around = |at: &[f32; 2]| Rect::from_center_size(on(room, *at), vec2(2.0 * RING, 2.0 * RING));
    let mut taken: Vec<Rect> = seen.iter().map(|(_, at)| around(at)).collect();
    for (index, (mark, at)) in seen.into_iter().enumerate() {
        let label = ring(cx, ui, room, (index, mark, at), image, &taken);
        taken.push(label);
    }
    if cx.model.state.labels {
        labels(cx, looked_at, ui, room);
    }
    let hints = std::mem::replace(&mut cx.model.state.hint, false);
    say(cx, ui, room, &[""]);
    cx.model.state.hint = hints;
}

/// Where a point of the picture, in [0, 1]^2, lies on the screen.
fn on(room: Rect, at: [f32; 2]) -> Pos2 {
    room.min + vec2(at[0], at[1]) * room.size()
}

/// A ring, what is expected within, and what the picture says so far: where nothing is yet. Returns where that stands.
fn ring(
    cx: &mut UiContext,
    ui: &Ui,
    room: Rect,
    (index, mark, at): (usize, &Mark, [f32; 2]),
    image: Option<&Image>,
    taken: &[Rect],
) -> Rect {
    let place = on(room, at);
    let painter = ui.painter().with_clip_rect(room);
    painter.circle_stroke(place, RING, Stroke::new(4.0, Color32::from_black_alpha(200)));
    painter.circle_stroke(place, RING, Stroke::new(2.0, Color32::WHITE));
    let here = image.and_then(|image| mean_around(image, at));
    let here = here.map_or_else(String::new, |here| format!(", here {here:.4}"));
    let text = format!("expected {}{here}", number(mark.expected));
    let size = vec2(text.len() as f32 * LETTER, LINE);
    let [first, last] = [room.left() + 0.5 * size.x, room.right() - 0.5 * size.x];
    let label =
        |x: f32, y: f32| Rect::from_center_size(pos2((place.x + x).clamp(first, last.max(first)), place.y + y), size);
    // below its ring, above it or beside it, farther away where others stand
    let [aside, away] = [RING + 5.0 + 0.5 * size.x, RING + 5.0 + 0.5 * LINE];
    let close = [label(0.0, away), label(0.0, -away), label(aside, 0.0), label(-aside, 0.0)];
    let far = [label(0.0, away + 1.1 * LINE), label(0.0, -away - 1.1 * LINE)];
    let is_free = |label: &Rect| !taken.iter().any(|other| other.intersects(*label));
    let label = close.into_iter().chain(far).find(is_free).unwrap_or(close[0]);
    text_box(ui, room, label.center(), Align2::CENTER_CENTER, &text, Color32::WHITE);
    cx.dump.note_text(&format!("ring {}", index + 1), &text, label, room);
    spoken(ui, &format!("ring {}", index + 1), &text, label, false);
    label
}

/// The first channel of the pixels around a point, which lies in [0, 1]^2.
fn mean_around(image: &Image, at: [f32; 2]) -> Option<f32> {
    let (width, height) = image.size();
    let place = |share: f32, side: u32| (share * side as f32).floor() as i64;
    let (x, y) = (place(at[0], width), place(at[1], height));
    let around = (-1..=1).flat_map(|j| (-1..=1).map(move |i| (x + i, y + j)));
    let values: Vec<f32> = around
        .filter_map(|(x, y)| image.at(u32::try_from(x).ok()?, u32::try_from(y).ok()?))
        .map(|radiance| radiance.x)
        .collect();
    (!values.is_empty()).then(|| values.iter().sum::<f32>() / values.len() as f32)
}

/// The verdict and what it rests on above, and how the picture was made below.
fn labels(cx: &mut UiContext, looked_at: &LookedAt, ui: &Ui, room: Rect) {
    let text = verdict(cx);
    let place = text_box(ui, room, room.left_top() + vec2(12.0, 12.0), Align2::LEFT_TOP, &text, Color32::WHITE);
    cx.dump.note_text("case verdict", &text, place, room);
    spoken(ui, "case verdict", &text, place, true);
    let shown = cx.shown.panes.get(PaneId::CASE);
    let made = shown.map_or_else(String::new, |shown| {
        let spp = shown.spp.map_or_else(String::new, |spp| format!("{spp} samples a pixel, "));
        let by = shown.adapter.as_deref().unwrap_or_default();
        let fault = shown.fault.as_deref().or(shown.refused.as_deref());
        fault.map_or_else(|| format!(" {spp}{:.1} s, {by}", shown.seconds), |fault| format!(" {fault}"))
    });
    let text = format!("{}{made}", looked_at.view.measured);
    let at = room.left_bottom() + vec2(12.0, -12.0);
    let place = text_box(ui, room, at, Align2::LEFT_BOTTOM, &text, Color32::WHITE);
    cx.dump.note_text("case picture", &text, place, room);
    spoken(ui, "case picture", &text, place, false);
}

/// "passes: 58 rows. Nearest to failing: path mis at (0, 0) ...".
fn verdict(cx: &UiContext) -> String {
    let (case, machine) = (cx.model.state.cases.case(), cx.model.state.cases.machine);
    let mark = cx.shown.cases.mark(machine, case);
    let head = format!("Case {} {}", case.number, if mark == CaseMark::Running { "is running" } else { mark.name() });
    let result = cx.shown.cases.result(machine, case);
    let Some((result, row)) = result.and_then(|result| Some((result, telling_row(&result.rows)?))) else { return head };
    let what = if row.verdict == Verdict::Fail { "Fails" } else { "Nearest to failing" };
    let (subject, quantity, measured) = (&row.subject, &row.quantity, number(row.measured));
    let allowed = match row.relation {
        Relation::AtMost => format!("at most {}", number(row.expected)),
        Relation::Equal => {
            let share = off_by(row);
            let share = if share.is_finite() { format!(", off by {share:.1} of that") } else { String::new() };
            format!("expected {} ± {}{share}", number(row.expected), number(row.tolerance))
        }
    };
    let spoilt = if result.spoilt { " (a twentieth too much on purpose)" } else { "" };
    format!("{head}. {what}: {subject}: {quantity}: {measured}, {allowed}{spoilt}")
}
