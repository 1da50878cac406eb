//! The help: mouse and keys on one card.

use super::theme::bold;
use super::workspace::Workspace;
use super::{UiContext, keys};
use egui::Ui;

pub fn show(workspace: &dyn Workspace, cx: &mut UiContext, ui: &mut Ui) {
    if cx.model.state.help && !cx.model.state.help_was_open {
        // egui lays a new window out twice: once to measure it
        ui.ctx().request_discard("the help is new");
        ui.ctx().request_repaint();
    }
    cx.model.state.help_was_open = cx.model.state.help;
    let mut open = cx.model.state.help;
    let tallest = ui.ctx().content_rect().height() - 80.0;
    let window = egui::Window::new("Mouse and keys").open(&mut open).collapsible(false).resizable(false);
    let shown = window
        .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
        .default_height(tallest)
        .vscroll(true)
        .show(ui.ctx(), |ui| {
            egui::Grid::new("keys").num_columns(2).spacing([16.0, 4.0]).show(ui, |ui| {
                for (what, does) in workspace.help().iter().chain(&keys::KEYS) {
                    ui.label(bold(*what));
                    ui.label(*does);
                    ui.end_row();
                }
            });
        });
    if let Some(shown) = shown {
        cx.dump.note("help", "", shown.response);
    }
    cx.model.state.help = open;
}
