//! The bar above the picture: scene, view, saving.

use super::{Dump, Request, View, Viewer};
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{PopupCloseBehavior, Ui};
use scene::builtin;

pub fn show(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump, requests: &mut Vec<Request>) {
    ui.horizontal(|ui| {
        scene_menu(viewer, ui, dump, requests);
        ui.separator();
        for view in View::ALL {
            let chosen = viewer.view == view;
            let button = ui.selectable_label(chosen, view.name()).on_hover_text(explain(view));
            if dump.note(&format!("view {}", view.name()), chosen, button).clicked() {
                viewer.view = view;
            }
        }
        ui.separator();
        let save = ui.button("Save picture").on_hover_text("Save what is shown as PNG (Ctrl+S)");
        if dump.note("save", "", save).clicked() {
            requests.push(Request::Save);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let panel = ui.selectable_label(viewer.panel, "Controls").on_hover_text("Show or hide the controls (H)");
            if dump.note("controls", viewer.panel, panel).clicked() {
                viewer.panel = !viewer.panel;
            }
            if let Some((message, failed)) = &viewer.message {
                let colour = if *failed { ui.visuals().error_fg_color } else { ui.visuals().text_color() };
                let label = ui.add(egui::Label::new(egui::RichText::new(message).color(colour)).truncate());
                dump.note("message", message, label);
            }
        });
    });
}

fn explain(view: View) -> &'static str {
    match view {
        View::A => "The fake alone (1, T swaps A and B)",
        View::B => "The truth alone (2, T swaps A and B)",
        View::Wipe => "A left and B right of a line to drag (3)",
        View::SideBySide => "Both whole, each in half of the window (4)",
    }
}

fn scene_menu(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump, requests: &mut Vec<Request>) {
    let stay = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let title = format!("Scene: {}", viewer.scene.name);
    let (response, _) = MenuButton::new(title).config(stay).ui(ui, |ui| {
        for name in builtin::names() {
            let item = ui.selectable_label(viewer.scene.name == name, name);
            if dump.note(&format!("scene {name}"), "", item).clicked() {
                requests.push(Request::Open(name.into()));
                ui.close();
            }
        }
        ui.separator();
        ui.label("A scene file (.toml):");
        let line = ui.add(egui::TextEdit::singleline(&mut viewer.file_name).hint_text("folder/scene.toml"));
        let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        dump.note("scene file", &viewer.file_name, line);
        if (ui.button("Open").clicked() || entered) && !viewer.file_name.is_empty() {
            requests.push(Request::Open(viewer.file_name.clone()));
            ui.close();
        }
    });
    dump.note("scene", &viewer.scene.name, response);
}
