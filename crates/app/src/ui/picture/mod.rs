//! The picture area: one side, both under the wipe or both side by side, what is known about each on top, and the mouse: the line, orbit,
//! pan and zoom.

use super::{Dump, Pane, View, Viewer};
use crate::workers::Side;
use egui::{Align2, Color32, CursorIcon, FontId, Pos2, Rect, Sense, Stroke, Ui, Vec2, pos2, vec2};
use scene::glam;

/// How far from the line a drag still takes it, in points.
const GRAB: f32 = 14.0;
const WHOLE: Rect = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));

pub fn show(viewer: &mut Viewer, ui: &mut Ui, panes: &[Pane; 2], dump: &mut Dump) {
    let rect = whole_pixels(ui.max_rect(), ui.ctx().pixels_per_point());
    viewer.picture_rect = rect;
    let frame = if viewer.view == View::SideBySide { left_half(rect, ui.ctx().pixels_per_point()) } else { rect };
    let pixels = frame.size() * ui.ctx().pixels_per_point();
    viewer.picture_size = (pixels.x.round().max(1.0) as u32, pixels.y.round().max(1.0) as u32);

    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    mouse(viewer, ui, &response, rect);
    let line_x = rect.left() + viewer.wipe * rect.width();
    let (left, right) = rect.split_left_right_at_x(line_x);
    let beside = frame.translate(vec2(rect.width() - frame.width(), 0.0));
    // where each side's picture lies, and what of it is seen
    let shown = match viewer.view {
        View::A => vec![(Side::A, rect, rect)],
        View::B => vec![(Side::B, rect, rect)],
        View::Wipe => vec![(Side::A, rect, left), (Side::B, rect, right)],
        View::SideBySide => vec![(Side::A, frame, frame), (Side::B, beside, beside)],
    };
    for &(side, place, clip) in &shown {
        pane(ui, place, clip, &panes[side as usize]);
    }
    if viewer.view == View::Wipe {
        line(ui, rect, line_x);
    }
    for &(side, _, clip) in &shown {
        label(viewer, ui, clip, side, &panes[side as usize]);
    }
    if viewer.hint {
        let line = if viewer.view == View::Wipe { "Drag the line. " } else { "" };
        let text = format!("{line}T swaps A and B. Drag the picture to orbit, Shift to pan, wheel to zoom.");
        text_box(ui, rect, rect.center_bottom() - vec2(0.0, 12.0), Align2::CENTER_BOTTOM, &text, Color32::WHITE);
    }
    dump.note("picture", viewer.view.name(), response);
}

/// The largest rectangle on whole physical pixels inside: a pane is shown 1:1.
fn whole_pixels(rect: Rect, pixels_per_point: f32) -> Rect {
    let (min, max) = (rect.min.to_vec2() * pixels_per_point, rect.max.to_vec2() * pixels_per_point);
    Rect::from_min_max((min.ceil() / pixels_per_point).to_pos2(), (max.floor() / pixels_per_point).to_pos2())
}

/// The left half, of whole physical pixels and one short of the middle, so that a line stays between the halves.
fn left_half(rect: Rect, pixels_per_point: f32) -> Rect {
    let half = ((rect.width() * pixels_per_point - 1.0) / 2.0).floor().max(1.0) / pixels_per_point;
    Rect::from_min_size(rect.min, vec2(half, rect.height()))
}

fn pane(ui: &Ui, rect: Rect, clip: Rect, pane: &Pane) {
    let painter = ui.painter().with_clip_rect(clip);
    match (&pane.fault, pane.texture) {
        (Some(fault), _) => {
            text_box(ui, clip, clip.center(), Align2::CENTER_CENTER, fault, ui.visuals().error_fg_color)
        }
        (None, Some(texture)) => {
            painter.image(texture, rect, WHOLE, Color32::WHITE);
        }
        (None, None) => text_box(ui, clip, clip.center(), Align2::CENTER_CENTER, "rendering ...", Color32::WHITE),
    }
}

fn line(ui: &Ui, rect: Rect, x: f32) {
    let painter = ui.painter();
    painter.vline(x, rect.y_range(), Stroke::new(4.0, Color32::from_black_alpha(140)));
    painter.vline(x, rect.y_range(), Stroke::new(2.0, Color32::WHITE));
    let handle = Rect::from_center_size(pos2(x, rect.center().y), vec2(12.0, 44.0));
    painter.rect(handle, 6.0, Color32::WHITE, Stroke::new(1.0, Color32::BLACK), egui::StrokeKind::Outside);
}

/// Name, cost and error on the picture: A at the left edge, B at the right edge under the wipe.
fn label(viewer: &Viewer, ui: &Ui, clip: Rect, side: Side, pane: &Pane) {
    if pane.texture.is_none() {
        return;
    }
    let (name, colour) = match side {
        Side::A => (format!("A: {}", pane.label), Color32::from_rgb(120, 190, 255)),
        Side::B => (format!("B: {}", pane.label), Color32::from_rgb(255, 180, 90)),
    };
    let mut text = name;
    match pane.spp {
        Some(spp) if pane.rough => text += &format!("\n{spp} spp, rough"),
        Some(spp) => text += &format!("\n{spp} of {} spp, {:.1} s", viewer.truth.spp, pane.seconds),
        None => text += &format!("\n{:.0} ms", pane.seconds * 1000.0),
    }
    if let Some(e) = pane.errors {
        let other = if side == Side::A { "A - B" } else { "B - A" };
        text +=
            &format!("\n{other}: relMSE {:.3}, RMSE {:.3}\nbias {:+.1} %", e.rel_mse, e.rmse, 100.0 * e.relative_bias);
    }
    let (corner, align) = match (viewer.view, side) {
        (View::Wipe, Side::B) => (clip.right_top() + vec2(-10.0, 10.0), Align2::RIGHT_TOP),
        _ => (clip.left_top() + vec2(10.0, 10.0), Align2::LEFT_TOP),
    };
    text_box(ui, clip, corner, align, &text, colour);
}

/// Text on a dark ground that keeps it readable over any picture.
fn text_box(ui: &Ui, clip: Rect, at: Pos2, align: Align2, text: &str, colour: Color32) {
    let painter = ui.painter().with_clip_rect(clip);
    let width = (clip.width() - 20.0).max(40.0);
    let galley = painter.layout(text.to_owned(), FontId::proportional(15.0), colour, width);
    let place = align.anchor_size(at, galley.size());
    painter.rect_filled(place.expand2(vec2(6.0, 3.0)), 4.0, Color32::from_black_alpha(200));
    painter.galley(place.min, galley, colour);
}

fn mouse(viewer: &mut Viewer, ui: &Ui, response: &egui::Response, rect: Rect) {
    let line_x = rect.left() + viewer.wipe * rect.width();
    let near_line = |p: Pos2| viewer.view == View::Wipe && (p.x - line_x).abs() < GRAB;
    if response.drag_started() {
        let from = ui.input(|i| i.pointer.press_origin());
        viewer.dragging_line = from.is_some_and(near_line);
    }
    if viewer.dragging_line || response.hover_pos().is_some_and(near_line) {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    if response.double_clicked() && response.interact_pointer_pos().is_some_and(near_line) {
        viewer.wipe = 0.5;
    }
    if response.dragged() && viewer.dragging_line {
        viewer.hint = false;
        if let Some(p) = response.interact_pointer_pos() {
            viewer.wipe = ((p.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
        }
    } else if response.dragged() {
        move_camera(viewer, ui, response, rect);
    }
    if response.drag_stopped() {
        viewer.dragging_line = false;
    }
    let scroll = ui.input(|i| i.smooth_scroll_delta().y);
    if response.hovered() && scroll != 0.0 {
        viewer.hint = false;
        viewer.camera = keep_if_sane(viewer.camera, viewer.camera.dollied((scroll * 0.002).exp()));
    }
}

fn move_camera(viewer: &mut Viewer, ui: &Ui, response: &egui::Response, rect: Rect) {
    let drag: Vec2 = response.drag_delta() / rect.height();
    if drag == Vec2::ZERO {
        return;
    }
    viewer.hint = false;
    let pan = ui.input(|i| i.modifiers.shift) || response.dragged_by(egui::PointerButton::Secondary);
    let moved = if pan || response.dragged_by(egui::PointerButton::Middle) {
        viewer.camera.panned(glam::Vec2::new(drag.x, drag.y))
    } else {
        viewer.camera.orbited(-drag.x * std::f32::consts::PI, drag.y * std::f32::consts::PI)
    };
    viewer.camera = keep_if_sane(viewer.camera, moved);
}

/// A step that would leave the camera seeing nothing is not taken.
fn keep_if_sane(old: scene::Camera, new: scene::Camera) -> scene::Camera {
    if new.fault().is_none() { new } else { old }
}
