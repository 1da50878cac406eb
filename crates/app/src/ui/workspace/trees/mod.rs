//! What a ray is tested against: the same statue without a tree, with two boxes a node and with eight, and how the time
//! grows with its triangles. "Naive ray tracing would not work here."

mod cards;
mod picture;
mod plot;

use super::Workspace;
use crate::model::{COMPARE, Model, Wanted, WantedTrees};
use crate::ui::pressed::{HelpLine, Keys};
use crate::ui::theme::palette;
use crate::ui::widgets::Icon;
use crate::ui::{UiContext, controls as common};
use egui::{Frame, Key, Margin, Ui};

/// Three pictures and a plot.
pub struct Trees;

impl Workspace for Trees {
    fn id(&self) -> &'static str {
        "trees"
    }

    fn name(&self) -> &'static str {
        "Trees"
    }

    fn icon(&self) -> Icon {
        Icon::Trees
    }

    fn about(&self) -> &'static str {
        "What a ray is tested against, without a tree and with two kinds of trees; again: back to the comparison (X)"
    }

    fn keys(&mut self, cx: &mut UiContext, keys: &Keys) {
        let trees = &mut cx.model.session.trees;
        let finer = keys.presses(Key::CloseBracket) as u32;
        trees.level = (trees.level + finer).min(crate::model::TreesSettings::FINEST);
        trees.level = trees.level.saturating_sub(keys.presses(Key::OpenBracket) as u32);
    }

    fn escape(&mut self, cx: &mut UiContext) {
        cx.model.session.workspace = COMPARE;
    }

    fn ui(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        let whole = ui.available_rect_before_wrap();
        common::panel(cx, ui, cards::heads, cards::cards);
        let right = ui.available_rect_before_wrap().right();
        let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::symmetric(10, 6));
        let room = ui.available_height();
        let below = egui::Panel::bottom("plot of trees").resizable(true).default_size(0.42 * room).frame(frame);
        below.size_range(100.0_f32.min(0.5 * room)..=0.6 * room).show(ui, |ui| plot::show(cx, ui));
        egui::CentralPanel::default().show(ui, |ui| picture::show_all(cx, ui));
        let [right, bottom] = [whole.right().min(right), whole.bottom()];
        cx.model.state.seen_corners = [whole.left(), whole.top(), right, bottom];
    }

    fn wanted(&self, model: &Model) -> Wanted {
        let (settings, size) = (model.session.trees, model.state.tree_pixels);
        let there_is_room = size.0 > 0 && size.1 > 0;
        let restarts = model.state.restarts;
        let trees = WantedTrees { level: settings.level, show: settings.show, boxes: settings.boxes, size, restarts };
        Wanted { trees: there_is_room.then_some(trees), ..model.wanted([]) }
    }

    fn help(&self) -> Vec<HelpLine> {
        vec![("[  ]", "a coarser, a finer statue"), ("Esc", "back to the comparison")]
    }
}
