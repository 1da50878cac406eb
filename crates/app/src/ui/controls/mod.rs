//! Controls for every workspace, grouped by what they change. What the scene or the technique cannot use is absent.

mod camera;
mod device;
mod display;
mod pane;
mod scene;
mod setting;

use super::UiContext;
use crate::model::PaneId;
use egui::collapsing_header::CollapsingState;
use egui::{CollapsingHeader, RichText, Ui};
use technique::TechniqueName;

/// Width of the panel in points: never more than 30 % of the window.
fn width(window: f32) -> f32 {
    (0.285 * window).clamp(150.0, 300.0)
}

/// Windows lower than this, in points, open with fewer groups unfolded.
const LOW: f32 = 600.0;

/// Whether fewer groups are unfolded at first.
pub fn is_low(ui: &Ui) -> bool {
    ui.ctx().content_rect().height() < LOW
}

/// Shows a workspace's controls at the right, unless they are hidden.
pub fn panel(cx: &mut UiContext, ui: &mut Ui, contents: fn(&mut UiContext, &mut Ui)) {
    if cx.model.state.panel {
        let width = width(ui.available_width());
        egui::Panel::right("controls").resizable(false).exact_size(width).show(ui, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| contents(cx, ui));
        });
    }
}

/// What is changed in the scene; absent where nothing can be.
pub fn scene(cx: &mut UiContext, ui: &mut Ui) {
    if scene::usable(cx.model).next().is_some() {
        group(cx, ui, "Scene (both)", true, scene::show);
    }
}

/// How pictures are shown, and the course of rendering.
pub fn display(cx: &mut UiContext, ui: &mut Ui) {
    group(cx, ui, "Display (both)", true, display::show);
}

/// The camera in numbers.
pub fn camera(cx: &mut UiContext, ui: &mut Ui) {
    group(cx, ui, "Camera (both)", false, camera::show);
}

/// Controls under a title that folds them.
pub fn group(cx: &mut UiContext, ui: &mut Ui, title: &str, open: bool, contents: fn(&mut UiContext, &mut Ui)) {
    let header = CollapsingHeader::new(RichText::new(title).strong()).id_salt(title).default_open(open);
    let shown = header.show_unindented(ui, |ui| contents(cx, ui));
    cx.dump.note(&format!("group {title}"), shown.fully_open(), shown.header_response);
}

/// The technique of one pane in the header, and its settings below.
pub fn pane(cx: &mut UiContext, pane: PaneId, open: bool, ui: &mut Ui) {
    let id = ui.make_persistent_id(("pane", pane));
    let state = CollapsingState::load_with_default_open(ui.ctx(), id, open);
    let (toggle, _, _) = state
        .show_header(ui, |ui| {
            ui.strong(format!("{pane}:"));
            techniques(cx, pane, ui);
        })
        .body_unindented(|ui| {
            // both panes have controls of one name
            ui.ctx().accesskit_node_builder(ui.unique_id(), |node| {
                node.set_role(egui::accesskit::Role::Group);
                node.set_label(format!("Settings of {pane}"));
            });
            pane::show(cx, pane, ui);
        });
    cx.dump.note(&format!("group {pane}"), "", toggle.accessible_name(format!("Settings of {pane}")));
}

fn techniques(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    // three words and the letter in one row, also where the panel is narrow
    ui.spacing_mut().item_spacing.x = 1.0;
    ui.spacing_mut().button_padding.x = 3.0;
    for technique in TechniqueName::OF_LIGHT {
        let chosen = cx.model.session.panes[pane].technique == technique;
        let hover = match technique {
            TechniqueName::Raster => "Rasterised: shadow map, cube map, local shading",
            TechniqueName::Whitted => "Whitted: trees of rays at mirrors and glass, local light elsewhere",
            TechniqueName::Path => "Path traced: light itself, by Monte Carlo",
            TechniqueName::Normals => "The normals of what is seen",
        };
        let button = ui.selectable_label(chosen, technique.title()).on_hover_text(hover);
        if cx.dump.note(&format!("{pane} {}", technique.name()), chosen, button).clicked() {
            cx.model.session.panes[pane].technique = technique;
        }
    }
}
