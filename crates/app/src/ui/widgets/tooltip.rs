//! Explanations under the mouse, beside what they explain: below it they would cover the next control.

use egui::{Context, Id, PopupAnchor, Rect, RectAlign, Response, Tooltip};

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
        let anchor = PopupAnchor::ParentRect(beside_the_panel(&self));
        tooltip.popup = tooltip.popup.anchor(anchor).align(PLACES[0]).align_alternatives(&PLACES);
        tooltip.show(|ui| {
            ui.set_max_width(ui.spacing().tooltip_width);
            ui.label(text);
        });
        self
    }
}

/// Where the panel at the right begins.
fn panel_id() -> Id {
    Id::unique("left edge of the panel")
}

/// Notes where the panel at the right begins: explanations of what is on it go left of it, where they cover no other control.
pub fn note_panel(context: &Context, left: f32) {
    context.data_mut(|data| data.insert_temp(panel_id(), left));
}

/// The place of a widget; of one on the panel, from the panel's edge on.
fn beside_the_panel(response: &Response) -> Rect {
    let left: Option<f32> = response.ctx.data(|data| data.get_temp(panel_id()));
    let mut rect = response.rect;
    rect.min.x = left.filter(|left| *left <= rect.left()).unwrap_or(rect.left());
    rect
}
