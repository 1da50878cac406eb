//! The tree of parts: a row for each that is in sight, however many there are.

use super::rows::{Row, USUAL};
use super::{Parts, edit, words};
use crate::model::{Model, PartFacts, PartTree};
use crate::ui::UiContext;
use crate::ui::theme::{palette, semi_bold};
use crate::ui::widgets::Explained;
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Color32, FontId, Rect, Response, Role, ScrollArea, Sense, Stroke, StrokeKind, TextStyle, Ui, WidgetInfo, pos2, vec2,
};
use scene::edit::{Subject, Value};

/// How far a row stands in for each branch that it is in, in points.
const STEP: f32 = 12.0;

/// A row as it is drawn.
#[derive(Default)]
struct Look {
    /// What it is called.
    text: String,
    /// How screen readers and tests call it.
    name: String,
    /// What stands at its right, dim.
    aside: String,
    /// The part that it stands for, if it can be changed.
    part: Option<Subject>,
    /// Its colours, of a material; none where it is clear.
    colours: Option<Vec<Color32>>,
    depth: usize,
    /// Whether what is below it is unfolded, if there is anything.
    open: Option<bool>,
    chosen: bool,
    changed: bool,
    hidden: bool,
    is_title: bool,
}

pub fn row_height(ui: &Ui) -> f32 {
    ui.spacing().interact_size.y - 3.0
}

pub fn text_width(text: &str, ui: &Ui) -> f32 {
    let font = TextStyle::Button.resolve(ui.style());
    ui.painter().layout_no_wrap(text.into(), font, Color32::PLACEHOLDER).size().x
}

/// The rows that are in sight, in an area of this height.
pub fn show(parts: &mut Parts, cx: &mut UiContext, ui: &mut Ui, height: f32) {
    let (Some(tree), Some(facts)) = (parts.tree.take(), parts.facts.take()) else { return };
    parts.list.lay_out(&tree, &facts);
    let row = row_height(ui);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        let step = row + ui.spacing().item_spacing.y;
        let mut area = ScrollArea::vertical().id_salt("parts").max_height(height).min_scrolled_height(height);
        area = area.auto_shrink(false);
        if let Some(offset) = to_scroll_to(parts, cx.model, (&tree, &facts), step, height) {
            area = area.vertical_scroll_offset(offset);
        }
        let shown = area.show_rows(ui, row, parts.list.rows.len(), |ui, range| {
            for index in range {
                let Some(row) = parts.list.rows.get(index).copied() else { continue };
                let look = look(parts, cx.model, row, &tree, &facts);
                if draw(cx, ui, &look).clicked() {
                    click(parts, cx.model, row, look.part, &tree);
                }
            }
        });
        parts.seen = [shown.state.clamped_offset().y, shown.inner_rect.height()];
    });
    (parts.tree, parts.facts) = (Some(tree), Some(facts));
}

/// Where the tree has to stand so that the chosen row is seen, if it is not.
fn to_scroll_to(
    parts: &mut Parts,
    model: &Model,
    (tree, facts): (&PartTree, &PartFacts),
    step: f32,
    height: f32,
) -> Option<f32> {
    if !std::mem::take(&mut parts.scroll) {
        return None;
    }
    let chosen = model.state.parts.selected.as_ref()?;
    let rows = parts.list.rows.iter().enumerate();
    let rows = rows.filter(|(_, row)| row.is_of(chosen, parts.chosen_shape, tree, facts));
    let mut places = rows.map(|(index, row)| (index as f32 * step, matches!(row, Row::Shining(_)))).collect::<Vec<_>>();
    let [offset, seen] = [parts.seen[0], if parts.seen[1] > 0.0 { parts.seen[1] } else { height }];
    let in_sight = |top: f32| top >= offset && top + step <= offset + seen;
    // a light that is a shape has two rows: that among the shapes is its own
    places.sort_by_key(|(_, shines)| *shines);
    if places.iter().any(|(top, _)| in_sight(*top)) {
        return None;
    }
    places.first().map(|(top, _)| (top - 0.4 * seen).max(0.0))
}

fn click(parts: &mut Parts, model: &mut Model, row: Row, part: Option<Subject>, tree: &PartTree) {
    match row {
        Row::Section(..) | Row::Branch { .. } => parts.list.turn_over(row, tree),
        Row::Camera(index) => model.document.camera = tree.scene().cameras[index].camera,
        Row::Variant(index) => {
            model.document.changes.edits.variant = index.map(|index| tree.scene().variants[index].name.clone());
            model.apply_changes();
        }
        _ => model.state.parts.selected = part,
    }
}

fn look(parts: &Parts, model: &Model, row: Row, tree: &PartTree, facts: &PartFacts) -> Look {
    let (scene, edits) = (tree.scene(), &model.document.changes.edits);
    let open = parts.list.is_open(row, tree);
    let part = |part: Subject, kind: &str, text: String| {
        let chosen = model.state.parts.selected.as_ref().is_some_and(|chosen| *chosen == part);
        let changed = edits.changes(&part);
        let name = if kind.is_empty() { text.clone() } else { format!("{kind} {text}") };
        Look { text, name, chosen, changed, part: Some(part), depth: 1, ..Look::default() }
    };
    let plain = |kind: &str, text: &str, chosen: bool| Look {
        text: text.into(),
        name: format!("{kind} {text}"),
        chosen,
        depth: 1,
        ..Look::default()
    };
    match row {
        Row::Section(section, count) => Look {
            text: section.name().into(),
            name: format!("{} ({count})", section.name()),
            aside: count.to_string(),
            open,
            is_title: true,
            ..Look::default()
        },
        Row::Camera(index) => {
            let named = &scene.cameras[index];
            plain("Camera", &named.name, model.document.camera == named.camera)
        }
        Row::Sun => part(Subject::Sun, "", "Sun".into()),
        Row::Sky => part(Subject::Sky, "", "Sky".into()),
        Row::Light(index) => {
            let name = scene.light_name(index).into_owned();
            part(Subject::Light(name.clone()), "Light", name)
        }
        Row::Shining(index) => {
            let name = facts.scene().shape_name(index as usize).into_owned();
            part(Subject::Shape(name.clone()), "Light", name)
        }
        Row::Branch { index, depth } => {
            let branch = tree.branch(index);
            let within = |name: &str| name.strip_prefix(&branch.path).is_some_and(|rest| rest.starts_with('/'));
            let changes = |(part, _): (&Subject, _)| matches!(part, Subject::Shape(name) if within(name));
            Look {
                text: branch.label.clone(),
                name: format!("Shapes of {}", branch.path),
                aside: branch.shapes.to_string(),
                changed: edits.iter().any(changes),
                depth: depth + 1,
                open,
                ..Look::default()
            }
        }
        Row::Shape { index, label_at, depth } => {
            let name = scene.shape_name(index as usize);
            let subject = Subject::Shape(name.to_string());
            let hidden = is_hidden(model, &subject);
            let look = part(subject, "Shape", name.to_string());
            let text = name.get(label_at as usize..).unwrap_or(&name).to_owned();
            let name = if hidden { format!("{}, left out", look.name) } else { look.name.clone() };
            Look { text, name, hidden, depth: depth + 1, ..look }
        }
        Row::Material(index) => {
            let name = scene.materials[index].name.clone();
            let look = part(Subject::Material(name.clone()), "Material", name);
            let count = facts.wearers.get(index).copied().unwrap_or_default();
            let colours = facts.scene().materials.get(index).map(words::swatch);
            Look { aside: count.to_string(), colours, ..look }
        }
        Row::Variant(index) => {
            let name = index.map(|index| scene.variants[index].name.as_str());
            plain("Variant", name.unwrap_or(USUAL), edits.variant.as_deref() == name)
        }
    }
}

fn is_hidden(model: &Model, part: &Subject) -> bool {
    let hidden = part.property("hidden").and_then(|property| model.document.changes.edits.get(part, property));
    hidden.and_then(Value::flag).unwrap_or(false)
}

/// Draws a row, with the menu that a right click opens.
fn draw(cx: &mut UiContext, ui: &mut Ui, look: &Look) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), row_height(ui)), Sense::click());
    let on = look.chosen || look.open == Some(true);
    let name = format!("{}{}", look.name, if look.changed { ", changed" } else { "" });
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, on, &name));
    let colours = palette(ui);
    if look.chosen || response.hovered() {
        ui.painter().rect_filled(rect, 5.0, if look.chosen { colours.chosen } else { colours.hovered });
    }
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 5.0, Stroke::new(1.0, colours.accent), StrokeKind::Inside);
    }
    let mut left = rect.left() + 4.0 + STEP * look.depth as f32;
    if let Some(open) = look.open {
        chevron(ui, pos2(left - 1.0, rect.center().y), open);
        left += 10.0;
    }
    if let Some(swatch) = &look.colours {
        let side = (0.5 * rect.height()).round();
        paint_swatch(ui, Rect::from_min_size(pos2(left, rect.center().y - 0.5 * side), vec2(side, side)), swatch);
        left += side + 6.0;
    }
    let mut right = rect.right() - 4.0;
    if look.hidden {
        right = show_again(cx, ui, rect, look);
    } else if !look.aside.is_empty() {
        let font = TextStyle::Small.resolve(ui.style());
        let galley = ui.painter().layout_no_wrap(look.aside.clone(), font, colours.dim);
        right -= galley.size().x;
        ui.painter().galley(pos2(right, rect.center().y - 0.5 * galley.size().y), galley, colours.dim);
    }
    if look.changed {
        right -= 9.0;
        ui.painter().circle_filled(pos2(right, rect.center().y), 3.0, colours.accent);
    }
    let is_cut = text(ui, look, left, right - 5.0, rect);
    let response = cx.dump.note(&format!("part {}", look.name), on, response);
    menu(cx, &response, look);
    let whole = look.name.split_once(' ').map_or(look.text.as_str(), |(_, name)| name);
    response.explained(if is_cut || (look.part.is_some() && whole != look.text) { whole } else { "" })
}

/// Returns whether there is no room for all of it.
fn text(ui: &Ui, look: &Look, left: f32, right: f32, rect: Rect) -> bool {
    let (colours, size) = (palette(ui), TextStyle::Body.resolve(ui.style()).size);
    let font = if look.is_title { FontId::new(size, semi_bold()) } else { TextStyle::Body.resolve(ui.style()) };
    let colour = if look.hidden { colours.dim.gamma_multiply(0.75) } else { colours.text };
    let shown = if look.text.trim().is_empty() { "(no name)" } else { &look.text };
    let mut job = LayoutJob::simple_singleline(shown.into(), font, colour);
    job.wrap = TextWrapping::truncate_at_width((right - left).max(8.0));
    let galley = ui.painter().layout_job(job);
    let is_cut = galley.elided;
    ui.painter().galley(pos2(left, rect.center().y - 0.5 * galley.size().y), galley, colour);
    is_cut
}

/// A button at the right end of a row that brings its shape back; returns where it begins.
fn show_again(cx: &mut UiContext, ui: &mut Ui, rect: Rect, look: &Look) -> f32 {
    let width = text_width("Show", ui) + 10.0;
    let place = Rect::from_min_max(pos2(rect.right() - width, rect.top() + 1.0), rect.right_bottom() - vec2(1.0, 1.0));
    let response = ui.interact(place, ui.scope_id().with((&look.name, "show")), Sense::click());
    let name = format!("Show {} again", look.text);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    let colours = palette(ui);
    let ground = if response.hovered() { colours.chosen } else { colours.hovered };
    ui.painter().rect_filled(place, 5.0, ground);
    if response.has_focus() {
        ui.painter().rect_stroke(place, 5.0, Stroke::new(1.0, colours.accent), StrokeKind::Inside);
    }
    let font = TextStyle::Small.resolve(ui.style());
    ui.painter().text(place.center(), egui::Align2::CENTER_CENTER, "Show", font, colours.text);
    if cx.dump.note(&format!("show {}", look.text), "", response).clicked() {
        hide(cx.model, look, false);
    }
    place.left()
}

/// What else can be done with a part.
fn menu(cx: &mut UiContext, response: &Response, look: &Look) {
    let Some(part) = &look.part else { return };
    response.context_menu(|ui| {
        if ui.add_enabled(look.changed, egui::Button::new("Leave as in the file")).clicked() {
            cx.model.document.changes.edits.reset_all(part);
            cx.model.apply_changes();
            ui.close();
        }
        let is_shape = matches!(part, Subject::Shape(_));
        if is_shape && ui.button(if look.hidden { "Show again" } else { "Leave out" }).clicked() {
            hide(cx.model, look, !look.hidden);
            ui.close();
        }
    });
}

fn hide(model: &mut Model, look: &Look, hidden: bool) {
    if let Some((part, property)) = look.part.as_ref().and_then(|part| Some((part, part.property("hidden")?))) {
        edit(model, part, property, hidden.then_some(Value::Flag(true)));
    }
}

fn chevron(ui: &Ui, at: egui::Pos2, open: bool) {
    let corners = if open {
        [vec2(-1.0, -0.5), vec2(0.0, 0.5), vec2(1.0, -0.5)]
    } else {
        [vec2(-0.5, -1.0), vec2(0.5, 0.0), vec2(-0.5, 1.0)]
    };
    let points = corners.map(|corner| at + 3.6 * corner).to_vec();
    ui.painter().line(points, Stroke::new(1.5, palette(ui).dim));
}

/// One colour, two halves of a checkerboard, or an empty square for what is clear.
fn paint_swatch(ui: &Ui, rect: Rect, swatch: &[Color32]) {
    let painter = ui.painter();
    match swatch {
        [] => _ = painter.line_segment([rect.left_bottom(), rect.right_top()], Stroke::new(1.0, palette(ui).dim)),
        [one] => _ = painter.rect_filled(rect, 2.0, *one),
        [first, second, ..] => {
            let middle = rect.center().x;
            painter.rect_filled(Rect::from_min_max(rect.min, pos2(middle, rect.bottom())), 0.0, *first);
            painter.rect_filled(Rect::from_min_max(pos2(middle, rect.top()), rect.max), 0.0, *second);
        }
    }
    painter.rect_stroke(rect, 2.0, Stroke::new(1.0, palette(ui).filled), StrokeKind::Outside);
}
