//! The mouse on the picture, and the arrow keys once it has the focus: the line, orbit, pan, dolly and zoom, a region,
//! and what is seen of magnified pictures.

use super::{magnify, parts, probe, region};
use crate::model::{Drag, Line, Magnification, View};
use crate::ui::UiContext;
use egui::{CursorIcon, EventFilter, Key, PointerButton, Pos2, Rect, Ui, Vec2};
use scene::{Camera, glam};
use std::f32::consts::PI;

/// How far from the line a drag still takes it, in points.
const GRAB: f32 = 16.0;
/// How far an arrow key moves the line, as a share of the picture.
const NUDGE: f32 = 0.02;

pub fn listen(cx: &mut UiContext, ui: &Ui, response: &egui::Response, rect: Rect, frames: &[Rect]) {
    if response.drag_started() {
        cx.model.state.drag = begun(cx, ui, rect, frames);
    }
    match cx.model.state.drag {
        Drag::Camera if response.dragged() => turn_camera(cx, ui, response, rect),
        Drag::Magnified if response.dragged() => magnify::drag(cx, response.drag_delta(), frames),
        Drag::Region(corners) => region::drag(cx, response, frames, corners),
        Drag::Part { from, moved } if response.dragged() => parts::mouse::drag(cx, ui, response, frames, (from, moved)),
        _ => {}
    }
    move_line(cx, ui, response, rect);
    if let (true, Some(at)) = (response.clicked(), response.interact_pointer_pos()) {
        probe::choose(cx, frames, at);
        parts::mouse::choose(cx, frames, at);
    }
    if response.double_clicked() {
        put_back(cx, response, rect);
    }
    if response.drag_stopped() {
        cx.model.state.drag = Drag::Camera;
    }
    if response.hovered() && !magnify::wheel(cx, ui, frames) {
        let (scroll, zoom) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        if zoom != 1.0 {
            take(cx, cx.model.document.camera.zoomed(zoom));
        } else if scroll != 0.0 {
            take(cx, cx.model.document.camera.dollied((scroll * 0.002).exp()));
        }
    }
}

/// What a drag does that has just begun.
fn begun(cx: &mut UiContext, ui: &Ui, rect: Rect, frames: &[Rect]) -> Drag {
    let (origin, modifiers) = ui.input(|i| (i.pointer.press_origin(), i.modifiers));
    let Some(origin) = origin else { return Drag::Camera };
    if modifiers.command
        && !modifiers.alt
        && let Some(drag) = parts::mouse::begun(cx, frames, origin)
    {
        return drag;
    }
    let model = &cx.model;
    if modifiers.alt || model.state.marking {
        Drag::Region([magnify::picture_at(&model.state.magnification, frames, origin); 2])
    } else if near_the_line(cx, rect, origin) {
        Drag::Line
    } else if modifiers.shift && model.state.magnification.factor() > 1 {
        Drag::Magnified
    } else {
        Drag::Camera
    }
}

/// The line at its first place, or pictures as large as they are.
fn put_back(cx: &mut UiContext, response: &egui::Response, rect: Rect) {
    if response.interact_pointer_pos().is_some_and(|at| near_the_line(cx, rect, at)) {
        cx.model.place_line_again();
    } else {
        cx.model.state.magnification = Magnification::default();
    }
}

fn near_the_line(cx: &UiContext, rect: Rect, at: Pos2) -> bool {
    let (line, wipe) = (cx.model.session.line, cx.model.session.wipe);
    cx.model.seen() == View::Wipe && (along(line, at) - line_at(rect, line, wipe)).abs() < GRAB
}

/// The coordinate that moves the line.
fn along(line: Line, at: Pos2) -> f32 {
    if line == Line::Vertical { at.x } else { at.y }
}

/// Where the line stands, in points: x of a vertical one, y of a horizontal one.
pub fn line_at(rect: Rect, line: Line, wipe: f32) -> f32 {
    match line {
        Line::Vertical => rect.left() + wipe * rect.width(),
        Line::Horizontal => rect.top() + wipe * rect.height(),
    }
}

fn move_line(cx: &mut UiContext, ui: &Ui, response: &egui::Response, rect: Rect) {
    if cx.model.seen() != View::Wipe {
        return;
    }
    let line = cx.model.session.line;
    let (dragging, marking) = (cx.model.state.drag == Drag::Line, cx.model.state.marking);
    if dragging || (!marking && response.hover_pos().is_some_and(|at| near_the_line(cx, rect, at))) {
        let vertical = line == Line::Vertical;
        ui.ctx().set_cursor_icon(if vertical { CursorIcon::ResizeHorizontal } else { CursorIcon::ResizeVertical });
    }
    if response.dragged()
        && dragging
        && let Some(at) = response.interact_pointer_pos()
    {
        cx.model.state.hint = false;
        let (start, length) = (line_at(rect, line, 0.0), line_at(rect, line, 1.0) - line_at(rect, line, 0.0));
        cx.model.session.wipe = ((along(line, at) - start) / length).clamp(0.0, 1.0);
    }
    if response.has_focus() {
        arrows(cx, ui, response);
    }
}

fn arrows(cx: &mut UiContext, ui: &Ui, response: &egui::Response) {
    let filter = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|m| m.set_focus_lock_filter(response.id, filter));
    let (back, forth) = match cx.model.session.line {
        Line::Vertical => (Key::ArrowLeft, Key::ArrowRight),
        Line::Horizontal => (Key::ArrowUp, Key::ArrowDown),
    };
    // with others they are the region's, the magnifier's and the probe's
    let presses = |key| ui.input(|i| if i.modifiers.any() { 0 } else { i.num_presses(key) }) as f32;
    cx.model.session.wipe = (cx.model.session.wipe + NUDGE * (presses(forth) - presses(back))).clamp(0.0, 1.0);
}

fn turn_camera(cx: &mut UiContext, ui: &Ui, response: &egui::Response, rect: Rect) {
    let drag: Vec2 = response.drag_delta() / rect.height();
    if drag == Vec2::ZERO {
        return;
    }
    let other_button = response.dragged_by(PointerButton::Secondary) || response.dragged_by(PointerButton::Middle);
    let pan = other_button || ui.input(|i| i.modifiers.shift);
    let moved = if pan {
        // by the field of view that is seen
        let seen = cx.model.state.picture.camera(&cx.model.document.camera);
        Camera { fov_y: cx.model.document.camera.fov_y, ..seen.panned(glam::Vec2::new(drag.x, drag.y)) }
    } else {
        cx.model.document.camera.orbited(-drag.x * PI, drag.y * PI)
    };
    take(cx, moved);
}

/// Goes to a camera, unless it would see nothing.
fn take(cx: &mut UiContext, camera: Camera) {
    cx.model.state.hint = false;
    if camera.fault().is_none() {
        cx.model.document.camera = camera;
    }
}
