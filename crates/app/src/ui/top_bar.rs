//! The bar above: the scene at the left, what the workspace adds in the middle, export and look at the right. It wraps where the window is narrow.

use super::theme::palette;
use super::widgets::{Explained, Icon, framed, icon_button, menu};
use super::{UiContext, Workspaces, export_menu, scene_menu, slides_menu};
use crate::model::{TREES, Theme};
use egui::{Frame, Margin, TextStyle, Ui};

/// Windows narrower than this, in sizes of the type, have no room for the bar as it is.
const NARROW: f32 = 57.0;

pub fn show(workspaces: &mut Workspaces, cx: &mut UiContext, ui: &mut Ui) {
    let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::symmetric(10, 6));
    egui::Panel::top("top bar").frame(frame).show(ui, |ui| {
        if ui.available_width() < NARROW * TextStyle::Body.resolve(ui.style()).size {
            // closer together, so that it all stays in one row
            (ui.spacing_mut().item_spacing.x, ui.spacing_mut().button_padding.x) = (2.0, 4.0);
        }
        let former: [f32; 3] = ui.ctx().data(|data| data.get_temp(widths_id())).unwrap_or_default();
        let mut widths = former;
        for row in rows(former, ui.available_width(), ui.spacing().item_spacing.x) {
            ui.horizontal(|ui| {
                ui.set_min_height(ui.spacing().interact_size.y + 6.0);
                for (room_before, part) in row {
                    ui.add_space(room_before);
                    widths[part as usize] = width_of(ui, |ui| part.draw(workspaces, cx, ui));
                }
            });
        }
        if widths != former {
            ui.ctx().data_mut(|data| data.insert_temp(widths_id(), widths));
            ui.ctx().request_discard("the parts of the bar have other widths");
        }
    });
}

/// What stands together on the bar.
#[derive(Clone, Copy)]
enum Part {
    Scene,
    Workspace,
    Tools,
}

impl Part {
    fn draw(self, workspaces: &mut Workspaces, cx: &mut UiContext, ui: &mut Ui) {
        match self {
            Part::Scene => scene_menu::show(cx, ui),
            Part::Workspace => workspaces.open_mut().bar(cx, ui),
            Part::Tools => tools(workspaces, cx, ui),
        }
    }
}

/// How the parts stand, by their widths in the last frame: each row has parts with the room before them. In one row what the workspace adds is
/// in the middle of the window and the tools end at its edge; where they have no room beside each other the middle goes below.
fn rows([left, middle, right]: [f32; 3], all: f32, spacing: f32) -> Vec<Vec<(f32, Part)>> {
    let rest = all - left - middle - right - 2.0 * spacing;
    if rest >= 0.0 {
        let before = (0.5 * (all - middle) - left - spacing).clamp(0.0, rest);
        return vec![vec![(0.0, Part::Scene), (before, Part::Workspace), (rest - before, Part::Tools)]];
    }
    let rest = all - left - right - spacing;
    if rest >= 0.0 {
        return vec![vec![(0.0, Part::Scene), (rest, Part::Tools)], vec![(0.0, Part::Workspace)]];
    }
    [Part::Scene, Part::Workspace, Part::Tools].map(|part| vec![(0.0, part)]).into()
}

fn width_of(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) -> f32 {
    ui.horizontal(contents).response.rect.width()
}

fn widths_id() -> egui::Id {
    egui::Id::unique("widths of the bar")
}

/// Windows narrower than this, in sizes of the type, have the workspaces in the menu of slides alone: with their buttons the bar
/// would take two rows of the picture's height.
const ROOMY: f32 = 86.0;

/// What stands at the right of the bar.
fn tools(workspaces: &mut Workspaces, cx: &mut UiContext, ui: &mut Ui) {
    if ui.ctx().content_rect().width() >= ROOMY * TextStyle::Body.resolve(ui.style()).size {
        workspaces.buttons(cx, ui);
    }
    slides_menu::show(cx, ui);
    steps(cx, ui);
    export_menu::show(cx, ui);
    look_menu(cx, ui);
    let open = cx.model.state.panel;
    let panel = icon_button(Icon::Controls, ("Controls", "Show or hide the controls (H)"), (true, open), ui);
    if cx.dump.note("controls", open, panel).clicked() {
        cx.model.state.panel = !open;
    }
    let open = cx.model.state.help;
    let help = icon_button(Icon::Help, ("Help", "Mouse and keys (?)"), (true, open), ui);
    if cx.dump.note("help button", open, help).clicked() {
        cx.model.state.help = !open;
    }
}

fn steps(cx: &mut UiContext, ui: &mut Ui) {
    let seen = !cx.model.session.is_in(TREES);
    let [can_undo, can_redo] = cx.model.can_undo_and_redo().map(|can| can && seen);
    let hover = "Take back the last change of a setting or of the camera (Ctrl+Z)";
    let undo = icon_button(Icon::Undo, ("Undo", hover), (can_undo, false), ui);
    if cx.dump.note("undo", can_undo, undo).clicked() {
        cx.model.undo();
    }
    let redo = icon_button(Icon::Redo, ("Redo", "Change it again (Ctrl+Shift+Z)"), (can_redo, false), ui);
    if cx.dump.note("redo", can_redo, redo).clicked() {
        cx.model.redo();
    }
}

fn look_menu(cx: &mut UiContext, ui: &mut Ui) {
    let (response, _) = menu("Look").ui(ui, |ui| {
        ui.label("Theme");
        for theme in Theme::ALL {
            let item = ui.radio_value(&mut cx.model.state.theme, theme, theme.name());
            cx.dump.note(&format!("theme {}", theme.name()), cx.model.state.theme == theme, item);
        }
        ui.separator();
        let labels = ui.checkbox(&mut cx.model.state.labels, "Labels on the pictures");
        cx.dump.note("labels", cx.model.state.labels, labels.on_hover_text("Hide or show them (L)"));
        ui.separator();
        let zoom = ui.ctx().zoom_factor();
        ui.label(format!("Text at {:.0} %", 100.0 * zoom));
        ui.horizontal(|ui| {
            for (text, name, factor) in
                [("−", "smaller text", zoom - 0.1), ("100 %", "usual text", 1.0), ("+", "larger text", zoom + 0.1)]
            {
                let button = ui.add(framed(text, ui)).explained("Ctrl - 0 +").accessible_name(name);
                if cx.dump.note(name, "", button).clicked() {
                    ui.ctx().set_zoom_factor(factor.clamp(0.5, 3.0));
                }
            }
        });
    });
    cx.dump.note("look", cx.model.state.theme.name(), response);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_stands_in_the_middle_and_goes_below_where_there_is_no_room() {
        let rooms = |all| {
            rows([100.0, 300.0, 200.0], all, 8.0)
                .into_iter()
                .map(|row| row.into_iter().map(|(room, _)| room).collect::<Vec<_>>())
                .collect::<Vec<_>>()
        };
        assert_eq!(rooms(1000.0), [vec![0.0, 242.0, 142.0]], "350 points lie left of the middle part");
        assert_eq!(rooms(616.0), [vec![0.0, 0.0, 0.0]]);
        assert_eq!(rooms(615.0), [vec![0.0, 307.0], vec![0.0]]);
        assert_eq!(rooms(307.0).len(), 3);
    }
}
