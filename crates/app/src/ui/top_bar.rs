//! The bar above the picture: scene, view, export, look. It wraps where the window is narrow.

use super::widgets::{framed, menu};
use super::{Dump, UiCommand, View, ViewModel, Viewer, export_menu};
use crate::model::Theme;
use egui::{Button, Ui};
use scene::builtin;
use std::path::Path;

/// Windows narrower than this, in points, have no room for the bar as it is.
const NARROW: f32 = 740.0;

/// The most letters of a scene's name that the bar shows.
const MOST_LETTERS: usize = 18;

pub fn show(viewer: &mut Viewer, ui: &mut Ui, model: &ViewModel, dump: &mut Dump, commands: &mut Vec<UiCommand>) {
    ui.horizontal_wrapped(|ui| {
        if ui.available_width() < NARROW {
            // closer together, so that it all stays in one row
            ui.spacing_mut().item_spacing.x = 2.0;
            ui.spacing_mut().button_padding.x = 4.0;
        }
        scene_menu(viewer, ui, dump, commands);
        ui.separator();
        for view in View::ALL {
            let chosen = viewer.view == view;
            let button = ui.selectable_label(chosen, view.name()).on_hover_text(explain(view));
            if dump.note(&format!("view {}", view.name()), chosen, button).clicked() {
                viewer.choose(view);
            }
        }
        ui.separator();
        export_menu::show(viewer, ui, model, dump, commands);
        look_menu(viewer, ui, dump);
        steps(viewer, ui, dump);
        let panel = ui.selectable_label(viewer.panel, "Controls").on_hover_text("Show or hide the controls (H)");
        if dump.note("controls", viewer.panel, panel).clicked() {
            viewer.panel = !viewer.panel;
        }
        let help = ui.selectable_label(viewer.help, " ? ").on_hover_text("Mouse and keys (?)").accessible_name("Help");
        if dump.note("help button", viewer.help, help).clicked() {
            viewer.help = !viewer.help;
        }
    });
}

fn steps(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    let [can_undo, can_redo] = [viewer.history.can_undo(&viewer.settings), viewer.history.can_redo()];
    let undo = ui.add_enabled(can_undo, Button::new("Undo"));
    if dump.note("undo", can_undo, undo.on_hover_text("Take back the last change of a setting (Ctrl+Z)")).clicked() {
        viewer.undo();
    }
    let redo = ui.add_enabled(can_redo, Button::new("Redo"));
    if dump.note("redo", can_redo, redo.on_hover_text("Change it again (Ctrl+Shift+Z)")).clicked() {
        viewer.redo();
    }
}

fn explain(view: View) -> &'static str {
    match view {
        View::A => "Pane A alone (1, T swaps A and B)",
        View::B => "Pane B alone (2, T swaps A and B)",
        View::Wipe => "Both, with a line to drag (3; again: turn the line)",
        View::SideBySide => "Both whole, each in half of the window (4)",
        View::ErrorMap => "Where the errors are, and how large (5)",
    }
}

fn scene_menu(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump, commands: &mut Vec<UiCommand>) {
    let name = &viewer.scene.name;
    let short: String = name.chars().take(MOST_LETTERS).collect();
    let title = if short == *name { format!("Scene: {name}") } else { format!("Scene: {short}…") };
    let (response, _) = menu(title).ui(ui, |ui| {
        for name in builtin::names() {
            let item = ui.selectable_label(viewer.scene.name == name, name);
            if dump.note(&format!("scene {name}"), "", item).clicked() {
                commands.push(UiCommand::Open(name.into()));
                ui.close();
            }
        }
        let hard = ui.menu_button("Hard cases", |ui| {
            for name in builtin::hard_names() {
                if dump.note(&format!("scene {name}"), "", ui.button(name)).clicked() {
                    commands.push(UiCommand::Open(name.into()));
                    ui.close();
                }
            }
        });
        dump.note("hard cases", "", hard.response);
        ui.separator();
        let label = ui.label("A scene file (.toml):");
        let edit = egui::TextEdit::singleline(&mut viewer.memory.file_name).hint_text("folder/scene.toml");
        let line = ui.add(edit).labelled_by(label.id);
        let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        dump.note("scene file", &viewer.memory.file_name, line);
        let open = dump.note("open", "", ui.add(framed("Open", ui)));
        let typed = viewer.memory.file_name.trim();
        if (open.clicked() || entered) && !typed.is_empty() {
            let built_in = builtin::text(typed).is_some();
            let path = image_file::typed_path(typed, Path::new(""));
            commands.push(UiCommand::Open(if built_in { typed.to_owned() } else { path.display().to_string() }));
            ui.close();
        }
    });
    dump.note("scene", &viewer.scene.name, response);
}

fn look_menu(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    let (response, _) = menu("Look").ui(ui, |ui| {
        ui.label("Theme");
        for theme in Theme::ALL {
            let item = ui.radio_value(&mut viewer.theme, theme, theme.name());
            dump.note(&format!("theme {}", theme.name()), viewer.theme == theme, item);
        }
        ui.separator();
        let zoom = ui.ctx().zoom_factor();
        ui.label(format!("Text at {:.0} %", 100.0 * zoom));
        ui.horizontal(|ui| {
            for (text, name, factor) in
                [("−", "smaller text", zoom - 0.1), ("100 %", "usual text", 1.0), ("+", "larger text", zoom + 0.1)]
            {
                let button = ui.add(framed(text, ui)).on_hover_text("Ctrl - 0 +").accessible_name(name);
                if dump.note(name, "", button).clicked() {
                    ui.ctx().set_zoom_factor(factor.clamp(0.5, 3.0));
                }
            }
        });
    });
    dump.note("look", viewer.theme.name(), response);
}
