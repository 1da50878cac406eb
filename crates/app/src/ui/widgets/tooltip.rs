//! Explanations under the mouse, beside what they explain: below it they would cover the next control.

use egui::{RectAlign, Response, Tooltip};

/// Something that can be explained.
pub trait Explained {
    /// Explains it at its left, or where there is room; nothing is said by an empty text.
    fn explained(self, text: &str) -> Self;
}

/// Where explanations go, in this order: beside a panel at the right is the picture.
const PLACES: [RectAlign; 4] =
    [RectAlign::LEFT_START, RectAlign::RIGHT_START, RectAlign::TOP_START, RectAlign::BOTTOM_START];

impl Explained for Response {
    fn explained(self, text: &str) -> Self {
        if text.is_empty() {
            return self;
        }
        self.ctx.accesskit_node_builder(self.id, |node| node.set_description(text));
        let mut tooltip = Tooltip::for_enabled(&self).gap(12.0);
        tooltip.popup = tooltip.popup.align(PLACES[0]).align_alternatives(&PLACES);
        tooltip.show(|ui| {
            ui.set_max_width(ui.spacing().tooltip_width);
            ui.label(text);
        });
        self
    }
}
