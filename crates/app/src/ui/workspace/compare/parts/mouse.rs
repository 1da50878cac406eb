//! The mouse on the pictures while parts are open: a click chooses what lies there, Ctrl and a drag move it.

use super::edit;
use crate::model::{Drag, ObjectMap};
use crate::ui::UiContext;
use crate::ui::overlay::{spoken, text_box};
use crate::ui::workspace::compare::magnify;
use egui::{Align2, Color32, Pos2, Rect, Response, Ui, vec2};
use scene::Vec3;
use scene::edit::{Subject, Value};
use scene::glam::Vec2;

/// Degrees about the middle of the sun that count as the sun, if it is not larger itself.
const SUN: f32 = 1.0;
/// A vertical that is seen along less than this, as a share of its length, is not followed as far as the mouse goes.
const LEAST_SEEN: f32 = 0.2;

/// What lies at a place, in shares of the picture.
fn part_at(map: &ObjectMap, at: [f32; 2]) -> Subject {
    if let Some(shape) = map.shape_at(at) {
        return Subject::Shape(map.scene.shape_name(shape).into_owned());
    }
    let aspect = map.size.0 as f32 / map.size.1.max(1) as f32;
    let direction = map.camera.frame(aspect).direction(Vec2::from(at));
    let is_there = |sun: scene::Sun| direction.dot(sun.towards) >= sun.angular_radius.max(SUN).to_radians().cos();
    if map.scene.sun.is_some_and(is_there) { Subject::Sun } else { Subject::Sky }
}

/// What is called so there: "sphere 3, glass".
fn name_at(map: &ObjectMap, at: [f32; 2]) -> String {
    let Some(shape) = map.shape_at(at).filter(|shape| *shape < map.scene.shapes.len()) else {
        return if part_at(map, at) == Subject::Sun { "sun".into() } else { "sky".into() };
    };
    let (name, worn) = (map.scene.shape_name(shape), &map.scene.material_of(&map.scene.shapes[shape]).name);
    if name == worn.as_str() { name.into_owned() } else { format!("{name}, {worn}") }
}

/// The map of the shapes and the place in it that is under a point of the window, if it is known what lies there.
fn place_under<'a>(cx: &UiContext<'a>, frames: &[Rect], at: Pos2) -> Option<(&'a ObjectMap, [f32; 2])> {
    let share = magnify::picture_at(&cx.model.state.magnification, frames, at);
    let within = share.iter().all(|share| (0.0..1.0).contains(share));
    let map = cx.shown.objects.as_deref().filter(|_| within && cx.model.state.parts.open)?;
    Some((map, share))
}

/// What lies under a point of the window, if it is known.
fn part_under(cx: &UiContext, frames: &[Rect], at: Pos2) -> Option<Subject> {
    place_under(cx, frames, at).map(|(map, share)| part_at(map, share))
}

/// A click chooses what lies there, and another at the same place what lies behind.
pub fn choose(cx: &mut UiContext, frames: &[Rect], at: Pos2) {
    let Some((map, share)) = place_under(cx, frames, at) else { return };
    cx.model.state.hint = false;
    match part_at(map, share) {
        Subject::Shape(_) => cx.model.choose_at(share, cx.shown),
        other => {
            cx.model.state.parts.selected = Some(other);
            cx.model.state.parts.looked_into = None;
        }
    }
}

/// The name of what lies under the mouse, beside it.
pub fn show_name(cx: &mut UiContext, ui: &Ui, response: &Response, frames: &[Rect]) {
    let busy = cx.model.state.posing || cx.model.state.loupe || ui.input(|i| i.pointer.any_down());
    let Some(at) = response.hover_pos().filter(|_| !busy) else { return };
    let Some((map, share)) = place_under(cx, frames, at) else { return };
    let text = name_at(map, share);
    let area = response.rect;
    let (left, top) = (at.x < area.center().x, at.y < area.center().y);
    let offset = vec2(if left { 16.0 } else { -12.0 }, if top { 20.0 } else { -12.0 });
    let align = match (left, top) {
        (true, true) => Align2::LEFT_TOP,
        (true, false) => Align2::LEFT_BOTTOM,
        (false, true) => Align2::RIGHT_TOP,
        (false, false) => Align2::RIGHT_BOTTOM,
    };
    let place = text_box(ui, area, at + offset, align, &text, Color32::WHITE);
    cx.dump.note_text("part under the mouse", &text, place, area);
    spoken(ui, "part under the mouse", &text, place, false);
}

/// The drag that moves the shape that it begins on, or else the one that is chosen.
pub fn begun(cx: &mut UiContext, frames: &[Rect], origin: Pos2) -> Option<Drag> {
    if !cx.model.state.parts.open {
        return None;
    }
    let under = part_under(cx, frames, origin).filter(|part| matches!(part, Subject::Shape(_)));
    let part = under.or_else(|| cx.model.state.parts.selected.clone())?;
    let seen = cx.model.document.seen();
    let index = part.index_in(seen).filter(|_| matches!(part, Subject::Shape(_)))?;
    let from = seen.shapes[index].geometry.center();
    cx.model.state.parts.selected = Some(part);
    Some(Drag::Part { from, moved: false })
}

/// Moves the chosen shape in the plane parallel to the picture, or with Shift along the vertical alone.
pub fn drag(cx: &mut UiContext, ui: &Ui, response: &Response, frames: &[Rect], (from, moved): (Vec3, bool)) {
    let state = &cx.model.state;
    let (origin, shift) = ui.input(|i| (i.pointer.press_origin(), i.modifiers.shift));
    let (Some(origin), Some(at)) = (origin, response.interact_pointer_pos()) else { return };
    let Some(part) = state.parts.selected.clone() else { return };
    let place = |at| Vec2::from(magnify::picture_at_from(&state.magnification, frames, (origin, at)));
    let by = place(at) - place(origin);
    if response.drag_delta() == egui::Vec2::ZERO && !moved {
        return;
    }
    let (width, height) = state.picture.size;
    let camera = state.picture.camera(&cx.model.document.camera).frame(width as f32 / height.max(1) as f32);
    let depth = (from - camera.eye).dot(camera.forward);
    let depth = if depth > 0.0 { depth } else { (from - camera.eye).length() };
    let along = 2.0 * depth * (by.x * camera.right - by.y * camera.up);
    let up = camera.up.normalize_or_zero();
    let along = if shift { Vec3::Y * (along.dot(up) / up.y.abs().max(LEAST_SEEN) * up.y.signum()) } else { along };
    cx.model.state.drag = Drag::Part { from, moved: true };
    if let Some(property) = part.property("center") {
        edit(cx.model, &part, property, Some(Value::Triple(from + along)));
    }
}

/// Gives up a drag in hand; returns whether there was one.
pub fn give_up(cx: &mut UiContext) -> bool {
    let Drag::Part { from, moved } = cx.model.state.drag else { return false };
    cx.model.state.drag = Drag::Nothing;
    let seen = cx.model.document.seen();
    let index = cx.model.state.parts.selected.as_ref().and_then(|part| part.index_in(seen));
    let stands = index.and_then(|index| Some(seen.shapes.get(index)?.geometry.center()));
    if moved && stands != Some(from) {
        // what is in hand is the last step
        cx.model.undo();
        cx.model.apply_changes();
    }
    true
}
