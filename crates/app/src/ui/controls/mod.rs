//! The panel of controls, grouped by what they change. What the scene or the technique cannot use is absent.

mod camera;
mod comparison;
mod device;
mod display;
mod fake;
mod scene;
mod truth;
mod whitted;

pub use comparison::state as reference_state;

use super::{Dump, UiCommand, View, ViewModel, Viewer};
use crate::engine::Side;
use crate::technique::Technique;
use egui::collapsing_header::CollapsingState;
use egui::{CollapsingHeader, RichText, Ui};

/// Width of the panel in points: never more than 30 % of the window.
pub fn width(window: f32) -> f32 {
    (0.285 * window).clamp(150.0, 300.0)
}

/// Windows lower than this, in points, open with fewer groups unfolded.
const LOW: f32 = 600.0;

pub fn show(viewer: &mut Viewer, ui: &mut Ui, model: &ViewModel, dump: &mut Dump, commands: &mut Vec<UiCommand>) {
    let low = ui.ctx().content_rect().height() < LOW;
    if viewer.view == View::ErrorMap {
        let fitted = model.map.as_ref().map(|map| map.drawn.map.scale.high);
        group(ui, dump, "Error map", true, |ui, dump| comparison::map(viewer, ui, fitted, dump));
    }
    if viewer.scene.refraction_ratio().is_some() || viewer.scene.sun.is_some() {
        group(ui, dump, "Scene (both)", true, |ui, dump| scene::show(viewer, ui, dump));
    }
    for side in [Side::A, Side::B] {
        pane(viewer, side, !low || side == Side::B, ui, dump);
    }
    group(ui, dump, "Display (both)", true, |ui, dump| display::show(viewer, ui, dump));
    group(ui, dump, "Compare with", false, |ui, dump| {
        comparison::against(viewer, ui, model, dump, commands);
    });
    group(ui, dump, "Camera (both)", false, |ui, dump| camera::show(viewer, ui, dump));
}

fn group(ui: &mut Ui, dump: &mut Dump, title: &str, open: bool, contents: impl FnOnce(&mut Ui, &mut Dump)) {
    let header = CollapsingHeader::new(RichText::new(title).strong()).id_salt(title).default_open(open);
    let shown = header.show_unindented(ui, |ui| contents(ui, dump));
    dump.note(&format!("group {title}"), shown.fully_open(), shown.header_response);
}

/// The technique of one pane in the header, and its settings below.
fn pane(viewer: &mut Viewer, side: Side, open: bool, ui: &mut Ui, dump: &mut Dump) {
    let id = ui.make_persistent_id(("pane", side as usize));
    let state = CollapsingState::load_with_default_open(ui.ctx(), id, open);
    let (toggle, _, _) = state
        .show_header(ui, |ui| {
            ui.strong(format!("{side:?}:"));
            techniques(viewer, side, ui, dump);
        })
        .body_unindented(|ui| {
            // both panes have controls of one name
            ui.ctx().accesskit_node_builder(ui.unique_id(), |node| {
                node.set_role(egui::accesskit::Role::Group);
                node.set_label(format!("Settings of {side:?}"));
            });
            match viewer.settings.panes[side as usize].technique {
                Technique::Raster => fake::show(viewer, side, ui, dump),
                Technique::Whitted => whitted::show(viewer, side, ui, dump),
                Technique::Path => truth::show(viewer, side, ui, dump),
            }
        });
    dump.note(&format!("group {side:?}"), "", toggle.accessible_name(format!("Settings of {side:?}")));
}

fn techniques(viewer: &mut Viewer, side: Side, ui: &mut Ui, dump: &mut Dump) {
    // three words and the side in one row, also where the panel is narrow
    ui.spacing_mut().item_spacing.x = 1.0;
    ui.spacing_mut().button_padding.x = 3.0;
    for technique in Technique::ALL {
        let chosen = viewer.settings.panes[side as usize].technique == technique;
        let hover = match technique {
            Technique::Raster => "Rasterised: shadow map, cube map, local shading",
            Technique::Whitted => "Whitted: trees of rays at mirrors and glass, local light elsewhere",
            Technique::Path => "Path traced: light itself, by Monte Carlo",
        };
        let button = ui.selectable_label(chosen, technique.title()).on_hover_text(hover);
        if dump.note(&format!("{side:?} {}", technique.name()), chosen, button).clicked() {
            viewer.settings.panes[side as usize].technique = technique;
        }
    }
}
