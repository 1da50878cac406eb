//! The picture area: one pane, both under the wipe or both side by side, or the map of their errors, and what is known
//! about each on top.

use super::{external, flicker, label, loupe, magnify, map, map_faces, mouse, parts, probe, region};
use crate::model::{Line, PaneId, PictureArea, View};
use crate::ui::UiContext;
use crate::ui::overlay::{say, spoken, text_box};
use crate::ui::theme::palette;
use egui::{Align2, Color32, Rect, Sense, Stroke, Ui, pos2, vec2};
use scene::Vec3;

/// Between two pictures side by side, in points.
const GAP: f32 = 8.0;

/// One pane in the picture area.
struct Shown {
    pane: PaneId,
    /// Where its picture lies as large as it is.
    frame: Rect,
    /// What of it is seen.
    clip: Rect,
}

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let scale = ui.ctx().pixels_per_point();
    let room = whole_pixels(ui.max_rect(), scale);
    flicker::turn(cx, ui);
    let view = cx.model.seen();
    let half = if view == View::SideBySide { left_half(room, scale) } else { room };
    let external = external::size(cx);
    let [rect, frame] = match external {
        Some(size) => external::within([room, half], size, scale),
        None => [room, half],
    };
    let [whole, part] = [rect, frame].map(|rect| (rect.size() * scale).round().into());
    let corners = [rect.left(), rect.top(), rect.right(), rect.bottom()];
    cx.model.state.picture = match external {
        Some(size) => PictureArea::of_size(size, corners),
        None => PictureArea::new(whole, part, cx.model.session.resolution.shrink(), corners),
    };
    if external.is_some() {
        ui.painter().rect_filled(room, 0.0, palette(ui).ground);
    }
    cx.model.place_line();

    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let mut frames: Vec<Rect> = arranged(cx, rect, frame).iter().map(|shown| shown.frame).collect();
    if frames.is_empty() {
        frames.push(rect);
    }
    mouse::listen(cx, ui, &response, rect, &frames);
    region::show_cursor(cx, ui, &response);
    magnify::keys(cx, ui, &frames);
    let shown = arranged(cx, rect, frame);
    for Shown { pane, frame, clip } in &shown {
        let place = place(cx, *pane, *frame, *clip, scale);
        picture(cx, ui, place, *clip, *pane);
        map_faces::show(cx, ui, place, *clip, *pane);
        if map_faces::map_of(cx, *pane).is_none() {
            outline(cx, ui, place, *clip, *pane);
            region::show(cx, &ui.painter().with_clip_rect(*clip), place);
            probe::mark(cx, &ui.painter().with_clip_rect(*clip), place);
        }
    }
    if view == View::Wipe {
        line(ui, rect, cx.model.session.line, cx.model.session.wipe);
    }
    if view == View::ErrorMap {
        let place = magnify::place(&cx.model.state.magnification, rect, scale);
        map::show(cx, ui, (place, rect), response.hover_pos());
    }
    for Shown { pane, clip, .. } in &shown {
        label::show(cx, ui, *clip, *pane);
    }
    magnify::label(cx, ui, rect);
    loupe::show(cx, ui, rect, &frames, response.hover_pos());
    parts::mouse::show_name(cx, ui, &response, &frames);
    if !cx.model.state.posing {
        let hints = ["Drag the line.", "Drag the picture to orbit.", "T swaps A and B.", "? shows all keys."];
        let without_a_line = usize::from(view != View::Wipe);
        say(cx, ui, room, &hints[without_a_line..]);
    }
    let response = response.accessible_name(format!("Picture: {}", view.name()));
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 0.0, Stroke::new(2.0, Color32::YELLOW), egui::StrokeKind::Inside);
    }
    cx.dump.note("picture", view.name(), response);
}

fn arranged(cx: &UiContext, rect: Rect, frame: Rect) -> Vec<Shown> {
    let shown = |pane, frame, clip| Shown { pane, frame, clip };
    match cx.model.seen() {
        View::Pane(pane) => vec![shown(pane, rect, rect)],
        View::Wipe => {
            let (of_a, of_b) = match cx.model.session.line {
                Line::Vertical => rect.split_left_right_at_fraction(cx.model.session.wipe),
                Line::Horizontal => rect.split_top_bottom_at_fraction(cx.model.session.wipe),
            };
            vec![shown(PaneId::A, rect, of_a), shown(PaneId::B, rect, of_b)]
        }
        View::SideBySide => {
            let beside = frame.translate(vec2(rect.width() - frame.width(), 0.0));
            vec![shown(PaneId::A, frame, frame), shown(PaneId::B, beside, beside)]
        }
        View::ErrorMap => Vec::new(),
    }
}

/// Where a pane's picture lies. A map of the fake's is no picture of the scene, and nothing of it lies where it does in
/// the other pane: it is shown whole in what is seen of its pane, rather than cut by the wipe or magnified.
fn place(cx: &UiContext, pane: PaneId, frame: Rect, clip: Rect, pixels_per_point: f32) -> Rect {
    if map_faces::map_of(cx, pane).is_none() {
        return magnify::place(&cx.model.state.magnification, frame, pixels_per_point);
    }
    if frame == clip {
        return frame;
    }
    let shrink = (clip.width() / frame.width()).min(clip.height() / frame.height());
    Rect::from_center_size(clip.center(), frame.size() * shrink)
}

/// The largest rectangle on whole physical pixels inside: a pane is shown 1:1.
fn whole_pixels(rect: Rect, pixels_per_point: f32) -> Rect {
    let (min, max) = (rect.min.to_vec2() * pixels_per_point, rect.max.to_vec2() * pixels_per_point);
    Rect::from_min_max((min.ceil() / pixels_per_point).to_pos2(), (max.floor() / pixels_per_point).to_pos2())
}

/// The left half, of whole physical pixels and without the gap between the halves.
fn left_half(rect: Rect, pixels_per_point: f32) -> Rect {
    let half = ((rect.width() - GAP) * pixels_per_point / 2.0).floor().max(1.0) / pixels_per_point;
    Rect::from_min_size(rect.min, vec2(half, rect.height()))
}

fn picture(cx: &mut UiContext, ui: &Ui, rect: Rect, clip: Rect, pane: PaneId) {
    let in_the_middle = |text: &str, colour| text_box(ui, clip, clip.center(), Align2::CENTER_CENTER, text, colour);
    let fault = cx.shown.panes.get(pane).and_then(|shown| shown.fault.as_ref());
    match (fault, cx.textures.panes.get(pane)) {
        (Some(fault), _) => {
            let (name, text) = (format!("label fault {pane}"), format!("{pane}: {fault}"));
            let place = in_the_middle(&text, Color32::from_rgb(255, 150, 150));
            cx.dump.note_text(&name, &text, place, clip);
            spoken(ui, &name, &text, place, true);
        }
        (None, Some(texture)) => {
            if !rect.contains_rect(clip) {
                // around a map that is shown smaller it goes on as within
                let around = cx.model.session.display.rgba8(Vec3::splat(raster::maps::BACKGROUND));
                ui.painter().rect_filled(clip, 0.0, Color32::from_rgb(around[0], around[1], around[2]));
            }
            magnify::paint(ui.painter(), *texture, rect, clip);
        }
        (None, None) => {
            let waiting = cx.shown.waiting.get(pane);
            let place = in_the_middle(waiting.map_or("rendering ...", String::as_str), Color32::WHITE);
            if let Some(words) = waiting {
                let (name, text) = (format!("waiting {pane}"), format!("{pane}: {words}"));
                cx.dump.note_text(&name, &text, place, clip);
                spoken(ui, &name, &text, place, false);
            }
        }
    }
}

/// The outline of the part in hand, where the picture is of the view that it was made for: over one that lags behind the
/// camera it would lie beside what it outlines.
fn outline(cx: &mut UiContext, ui: &Ui, rect: Rect, clip: Rect, pane: PaneId) {
    let shown = cx.shown.panes.get(pane).filter(|shown| shown.fault.is_none());
    let shot = shown.and_then(|shown| Some(&shown.provenance.as_ref()?.shot));
    let is_of_it = cx.shown.objects.as_ref().zip(shot).is_some_and(|(map, shot)| map.is_of(shot));
    if let Some(texture) = cx.textures.outline.filter(|_| is_of_it) {
        magnify::paint(ui.painter(), texture, rect, clip);
        cx.dump.note_text(&format!("outline {pane}"), "", rect, clip);
    }
}

fn line(ui: &Ui, rect: Rect, line: Line, wipe: f32) {
    let painter = ui.painter();
    let ends = |width, colour| Stroke::new(width, colour);
    let at = mouse::line_at(rect, line, wipe);
    let (middle, handle) = match line {
        Line::Vertical => (pos2(at, rect.center().y), vec2(12.0, 44.0)),
        Line::Horizontal => (pos2(rect.center().x, at), vec2(44.0, 12.0)),
    };
    for stroke in [ends(4.0, Color32::from_black_alpha(140)), ends(2.0, Color32::WHITE)] {
        match line {
            Line::Vertical => painter.vline(at, rect.y_range(), stroke),
            Line::Horizontal => painter.hline(rect.x_range(), at, stroke),
        };
    }
    let handle = Rect::from_center_size(middle, handle);
    painter.rect(handle, 6.0, Color32::WHITE, ends(1.0, Color32::BLACK), egui::StrokeKind::Outside);
}
