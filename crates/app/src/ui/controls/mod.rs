//! Controls for every workspace, each group on a card. What the scene or the technique cannot use is absent.

mod bugs;
mod camera;
mod device;
mod display;
mod external;
mod head;
mod light;
mod pane;
mod presets;
mod repairs;
mod scene;
mod setting;

pub use head::head;

use super::UiContext;
use super::theme::palette;
use super::widgets::{card, fold, note_panel};
use crate::model::PaneId;
use egui::{Align, Frame, Id, Layout, Margin, Response, RichText, TextStyle, Ui, vec2};

/// Width of the panel in points: as the type asks for, but never more than 28 % of the window.
fn width(ui: &Ui) -> f32 {
    let type_size = TextStyle::Body.resolve(ui.style()).size;
    (22.8 * type_size).min(0.28 * ui.available_width()).max(150.0)
}

/// Windows lower than this, in points, open with fewer groups unfolded.
const LOW: f32 = 600.0;

/// Whether fewer groups are unfolded at first.
pub fn is_low(ui: &Ui) -> bool {
    ui.ctx().content_rect().height() < LOW
}

/// Draws a part of a panel.
type Part = fn(&mut UiContext, &mut Ui);

/// Shows a workspace's controls at the right, unless they are hidden: `heads` are always in sight, `cards` are scrolled.
pub fn panel(cx: &mut UiContext, ui: &mut Ui, heads: Part, cards: Part) {
    panel_with(cx, ui, |_, _| (), heads, cards);
}

/// The same with what is in hand: it stands above the cards, and where the window is low above all.
pub fn panel_with(
    cx: &mut UiContext,
    ui: &mut Ui,
    in_hand: impl FnOnce(&mut UiContext, &mut Ui),
    heads: Part,
    cards: Part,
) {
    if !cx.model.state.panel {
        return;
    }
    let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin { left: 8, right: 8, top: 8, bottom: 0 });
    let panel = egui::Panel::right("controls").resizable(false).exact_size(width(ui)).frame(frame);
    panel.show(ui, |ui| {
        note_panel(ui.ctx(), ui.max_rect().left());
        let scrolled = egui::ScrollArea::vertical().auto_shrink(false);
        if is_low(ui) {
            // heads that stay would leave the cards no room
            scrolled.show(ui, |ui| {
                in_hand(cx, ui);
                heads(cx, ui);
                ui.add_space(4.0);
                cards(cx, ui);
            });
        } else {
            heads(cx, ui);
            ui.add_space(4.0);
            scrolled.show(ui, |ui| {
                in_hand(cx, ui);
                cards(cx, ui);
            });
        }
    });
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

/// The camera in numbers: unfolded once it was moved in this scene.
pub fn camera(cx: &mut UiContext, ui: &mut Ui) {
    let document = &cx.model.document;
    let known = Id::unique(("camera was moved", document.opened));
    let moved = document.camera != document.scene.camera || ui.ctx().data(|data| data.get_temp(known)).unwrap_or(false);
    ui.ctx().data_mut(|data| data.insert_temp(known, moved));
    // one card for a camera that was never moved and another for one that was: each folds by itself
    let id = ui.make_persistent_id(("camera", document.opened, moved));
    card(None, ui, |ui| {
        let (title, open) = fold("Camera (both)", None, (id, moved), ui, |ui| camera::show(cx, ui));
        cx.dump.note("group Camera (both)", open, title);
    });
}

/// Controls under a title that folds them.
pub fn group(cx: &mut UiContext, ui: &mut Ui, title: &str, open: bool, contents: Part) {
    let id = ui.make_persistent_id(title);
    card(None, ui, |ui| {
        let (header, open) = fold(title, None, (id, open), ui, |ui| contents(cx, ui));
        cx.dump.note(&format!("group {title}"), open, header);
    });
}

/// A row of the heads: a name, and what is chosen under it.
pub fn named(name: RichText, ui: &mut Ui, contents: impl FnOnce(&mut Ui)) -> Response {
    let width = TextStyle::Body.resolve(ui.style()).size;
    let row = ui.horizontal(|ui| {
        // as high as the words beside it
        let size = vec2(width, ui.spacing().interact_size.y + 4.0);
        let cell = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_size(size);
            ui.label(name)
        });
        contents(ui);
        cell.inner
    });
    row.inner
}

/// The settings of a pane's technique, on a card in its colour.
pub fn pane(cx: &mut UiContext, pane: PaneId, open: bool, ui: &mut Ui) {
    let (id, colour) = (ui.make_persistent_id(("pane", pane)), palette(ui).pane(pane));
    card(Some(colour), ui, |ui| {
        let title = format!("Settings of {pane}");
        let (header, open) = fold(&title, Some(colour), (id, open), ui, |ui| {
            ui.scope(|ui| {
                // both panes have controls of one name
                ui.ctx().accesskit_node_builder(ui.unique_id(), |node| {
                    node.set_role(egui::accesskit::Role::Group);
                    node.set_label(format!("Settings of {pane}"));
                });
                pane::show(cx, pane, ui);
            });
        });
        cx.dump.note(&format!("group {pane}"), open, header);
    });
}
