//! The bar above: scene, what the workspace adds, export, look. It wraps where the window is narrow.

use super::widgets::{framed, menu};
use super::{UiCommand, UiContext, Workspaces, export_menu};
use crate::model::Theme;
use egui::{Button, Ui};
use scene::builtin;
use std::path::Path;

/// Windows narrower than this, in points, have no room for the bar as it is.
const NARROW: f32 = 740.0;

/// The most letters of a scene's name that the bar shows.
const MOST_LETTERS: usize = 18;

pub fn show(workspaces: &mut Workspaces, cx: &mut UiContext, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        if ui.available_width() < NARROW {
            // closer together, so that it all stays in one row
            ui.spacing_mut().item_spacing.x = 2.0;
            ui.spacing_mut().button_padding.x = 4.0;
        }
        workspaces.tabs(cx, ui);
        scene_menu(cx, ui);
        ui.separator();
        workspaces.open_mut().bar(cx, ui);
        ui.separator();
        export_menu::show(cx, ui);
        look_menu(cx, ui);
        steps(cx, ui);
        let panel =
            ui.selectable_label(cx.model.state.panel, "Controls").on_hover_text("Show or hide the controls (H)");
        if cx.dump.note("controls", cx.model.state.panel, panel).clicked() {
            cx.model.state.panel = !cx.model.state.panel;
        }
        let help =
            ui.selectable_label(cx.model.state.help, " ? ").on_hover_text("Mouse and keys (?)").accessible_name("Help");
        if cx.dump.note("help button", cx.model.state.help, help).clicked() {
            cx.model.state.help = !cx.model.state.help;
        }
    });
}

fn steps(cx: &mut UiContext, ui: &mut Ui) {
    let [can_undo, can_redo] = cx.model.can_undo_and_redo();
    let undo = ui.add_enabled(can_undo, Button::new("Undo"));
    if cx.dump.note("undo", can_undo, undo.on_hover_text("Take back the last change of a setting (Ctrl+Z)")).clicked() {
        cx.model.undo();
    }
    let redo = ui.add_enabled(can_redo, Button::new("Redo"));
    if cx.dump.note("redo", can_redo, redo.on_hover_text("Change it again (Ctrl+Shift+Z)")).clicked() {
        cx.model.redo();
    }
}

fn scene_menu(cx: &mut UiContext, ui: &mut Ui) {
    let name = &cx.model.document.scene.name;
    let short: String = name.chars().take(MOST_LETTERS).collect();
    let title = if short == *name { format!("Scene: {name}") } else { format!("Scene: {short}…") };
    let (response, _) = menu(title).ui(ui, |ui| {
        for name in builtin::names() {
            let item = ui.selectable_label(cx.model.document.scene.name == name, name);
            if cx.dump.note(&format!("scene {name}"), "", item).clicked() {
                cx.commands.push(UiCommand::Open(name.into()));
                ui.close();
            }
        }
        let hard = ui.menu_button("Hard cases", |ui| {
            for name in builtin::hard_names() {
                if cx.dump.note(&format!("scene {name}"), "", ui.button(name)).clicked() {
                    cx.commands.push(UiCommand::Open(name.into()));
                    ui.close();
                }
            }
        });
        cx.dump.note("hard cases", "", hard.response);
        ui.separator();
        let label = ui.label("A scene file (.toml):");
        let edit = egui::TextEdit::singleline(&mut cx.model.state.scene_file).hint_text("folder/scene.toml");
        let line = ui.add(edit).labelled_by(label.id);
        let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        cx.dump.note("scene file", &cx.model.state.scene_file, line);
        let open = cx.dump.note("open", "", ui.add(framed("Open", ui)));
        let typed = cx.model.state.scene_file.trim();
        if (open.clicked() || entered) && !typed.is_empty() {
            let built_in = builtin::text(typed).is_some();
            let path = image_file::typed_path(typed, Path::new(""));
            cx.commands.push(UiCommand::Open(if built_in { typed.to_owned() } else { path.display().to_string() }));
            ui.close();
        }
    });
    cx.dump.note("scene", &cx.model.document.scene.name, response);
}

fn look_menu(cx: &mut UiContext, ui: &mut Ui) {
    let (response, _) = menu("Look").ui(ui, |ui| {
        ui.label("Theme");
        for theme in Theme::ALL {
            let item = ui.radio_value(&mut cx.model.state.theme, theme, theme.name());
            cx.dump.note(&format!("theme {}", theme.name()), cx.model.state.theme == theme, item);
        }
        ui.separator();
        let zoom = ui.ctx().zoom_factor();
        ui.label(format!("Text at {:.0} %", 100.0 * zoom));
        ui.horizontal(|ui| {
            for (text, name, factor) in
                [("−", "smaller text", zoom - 0.1), ("100 %", "usual text", 1.0), ("+", "larger text", zoom + 0.1)]
            {
                let button = ui.add(framed(text, ui)).on_hover_text("Ctrl - 0 +").accessible_name(name);
                if cx.dump.note(name, "", button).clicked() {
                    ui.ctx().set_zoom_factor(factor.clamp(0.5, 3.0));
                }
            }
        });
    });
    cx.dump.note("look", cx.model.state.theme.name(), response);
}
