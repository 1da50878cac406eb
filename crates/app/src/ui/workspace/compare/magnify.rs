//! Pictures shown larger, pixel by pixel: all at once, about the mouse.

use crate::model::Magnification;
use crate::ui::UiContext;
use crate::ui::overlay::text_box;
use crate::ui::pressed::Keys;
use egui::{Align2, Color32, Event, Key, Modifiers, MouseWheelUnit, Painter, Pos2, Rect, TextureId, Ui, Vec2, vec2};

/// How far a wheel that counts in points turns for one step.
const STEP: f32 = 40.0;

/// Where the picture of a frame lies whose part is seen that a magnification shows: on whole physical pixels.
pub fn place(magnification: &Magnification, frame: Rect, pixels_per_point: f32) -> Rect {
    let size = frame.size() * magnification.factor() as f32;
    let [x, y] = magnification.picture_at([0.0; 2]);
    let offset = (vec2(x, y) * size * pixels_per_point).round() / pixels_per_point;
    Rect::from_min_size(frame.min - offset, size)
}

/// Draws what of a texture at `place` lies in `clip`, without corners far beyond the screen.
pub fn paint(painter: &Painter, texture: TextureId, place: Rect, clip: Rect) {
    let seen = place.intersect(clip);
    let share = |at: Pos2| ((at - place.min) / place.size()).to_pos2();
    let uv = Rect::from_min_max(share(seen.min), share(seen.max));
    painter.with_clip_rect(clip).image(texture, seen, uv, Color32::WHITE);
}

/// What lies at a point, in shares of the picture whose frame it is in or nearest to.
pub fn picture_at(magnification: &Magnification, frames: &[Rect], at: Pos2) -> [f32; 2] {
    magnification.picture_at(share_of_frame(frames, at))
}

/// The same in shares of the picture that another point is in or nearest to.
pub fn picture_at_from(magnification: &Magnification, frames: &[Rect], (from, at): (Pos2, Pos2)) -> [f32; 2] {
    magnification.picture_at(share_of_frame_at(frames, from, at))
}

fn share_of_frame(frames: &[Rect], at: Pos2) -> [f32; 2] {
    share_of_frame_at(frames, at, at)
}

fn share_of_frame_at(frames: &[Rect], from: Pos2, at: Pos2) -> [f32; 2] {
    let nearest = frames.iter().min_by(|a, b| a.distance_to_pos(from).total_cmp(&b.distance_to_pos(from)));
    let share = nearest.map_or(Vec2::splat(0.5), |frame| (at - frame.min) / frame.size());
    [share.x, share.y]
}

/// Moves what is seen along with the mouse.
pub fn drag(cx: &mut UiContext, by: Vec2, frames: &[Rect]) {
    let Some(frame) = frames.first() else { return };
    let share = by / frame.size();
    cx.model.state.magnification = cx.model.state.magnification.dragged([share.x, share.y]);
}

/// Shift and the wheel magnify about the mouse; returns whether that was meant.
pub fn wheel(cx: &mut UiContext, ui: &Ui, frames: &[Rect]) -> bool {
    let (shift, turned, at) =
        ui.input(|i| (i.modifiers.shift, i.events.iter().map(steps).sum::<f32>(), i.pointer.hover_pos()));
    let Some(at) = at.filter(|_| shift || turned != 0.0) else { return false };
    cx.model.state.wheel += turned;
    let whole = cx.model.state.wheel.trunc();
    cx.model.state.wheel -= whole;
    magnify(cx, whole as i32, share_of_frame(frames, at));
    true
}

/// Steps of a wheel that is turned with Shift; some systems turn its direction then.
fn steps(event: &Event) -> f32 {
    match event {
        Event::MouseWheel { unit, delta, modifiers, .. } if modifiers.shift_only() => {
            let turned = if delta.y == 0.0 { delta.x } else { delta.y };
            if *unit == MouseWheelUnit::Point { turned / STEP } else { turned }
        }
        _ => 0.0,
    }
}

/// The keys of the magnifier: about the mouse if it is on the pictures, else about their middle.
pub fn keys(cx: &mut UiContext, ui: &Ui, frames: &[Rect]) {
    if ui.ctx().text_edit_focused() {
        return;
    }
    let keys = Keys::of(ui.ctx());
    let steps = ui.input(|i| i.events.iter().filter(|event| is_larger(event)).count()) as i32;
    let steps = steps - keys.presses(Key::Minus) as i32;
    let on_pictures = |at: &Pos2| frames.iter().any(|frame| frame.contains(*at));
    let at = ui.input(|i| i.pointer.hover_pos()).filter(on_pictures);
    let share = at.map_or([0.5; 2], |at| share_of_frame(frames, at));
    magnify(cx, steps, share);
    if keys.presses(Key::Num0) > 0 {
        cx.model.state.magnification = Magnification::default();
    }
}

/// On many keyboards it takes Shift. Who lets go of that first leaves it pressed, and its next press is told as a repetition.
fn is_larger(event: &Event) -> bool {
    match event {
        Event::Key { key: Key::Plus, pressed: true, modifiers, .. } => {
            [Modifiers::NONE, Modifiers::SHIFT].iter().any(|with| modifiers.matches_exact(*with))
        }
        Event::Key { key: Key::Equals, pressed: true, repeat: false, modifiers, .. } => modifiers.is_none(),
        _ => false,
    }
}

fn magnify(cx: &mut UiContext, steps: i32, at: [f32; 2]) {
    if steps != 0 {
        cx.model.state.magnification = cx.model.state.magnification.stepped(steps, at);
    }
}

/// Says "8x" in the lower right corner.
pub fn label(cx: &mut UiContext, ui: &Ui, rect: Rect) {
    let factor = cx.model.state.magnification.factor();
    if factor > 1 && cx.model.state.labels {
        let at = rect.right_bottom() - vec2(12.0, 12.0 + cx.model.state.said_height);
        let text = format!("{factor}x");
        let place = text_box(ui, rect, at, Align2::RIGHT_BOTTOM, &text, Color32::WHITE);
        cx.dump.note_text("label magnification", &text, place, rect);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn a_magnified_picture_lies_on_whole_physical_pixels() {
        let frame = Rect::from_min_size(pos2(10.0, 44.0), vec2(901.0, 607.0));
        for scale in [1.0, 1.25, 1.5, 2.0] {
            let frame = Rect::from_min_size(pos2(12.0, 44.0) / scale, frame.size() / scale);
            let magnification = Magnification::default().by(8, [0.317, 0.711]);
            let place = place(&magnification, frame, scale);
            let corner = place.min.to_vec2() * scale;
            assert!((corner - corner.round()).length() < 1e-2, "{corner:?} at {scale}");
            assert!((place.size() - 8.0 * frame.size()).length() < 1e-3 && place.contains_rect(frame), "{place:?}");
        }
    }

    #[test]
    fn a_point_beside_the_frames_belongs_to_the_nearest() {
        let frames = [
            Rect::from_min_size(pos2(0.0, 0.0), vec2(100.0, 50.0)),
            Rect::from_min_size(pos2(108.0, 0.0), vec2(100.0, 50.0)),
        ];
        let at = |x, y| picture_at(&Magnification::default(), &frames, pos2(x, y));
        assert_eq!(at(50.0, 25.0), [0.5, 0.5]);
        assert_eq!(at(158.0, 10.0), [0.5, 0.2]);
        assert_eq!(at(101.0, 25.0), [1.01, 0.5]);
        let across = (pos2(90.0, 25.0), pos2(158.0, 25.0));
        assert_eq!(picture_at_from(&Magnification::default(), &frames, across), [1.58, 0.5]);
    }
}
