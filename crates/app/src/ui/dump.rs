//! What is on the screen, for tests that click: names, rectangles and values of the widgets.

use egui::{Rect, Response};

/// A widget as last drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Widget {
    /// Its name, stable across versions.
    pub name: String,
    /// Where it is, in points.
    pub rect: Rect,
    /// Its state as text.
    pub value: String,
}

/// The widgets of one frame.
#[derive(Debug, Default)]
pub struct Dump {
    widgets: Vec<Widget>,
}

impl Dump {
    /// Notes a widget and hands its response on.
    pub fn note(&mut self, name: &str, value: impl ToString, response: Response) -> Response {
        self.widgets.push(Widget { name: name.to_owned(), rect: response.rect, value: value.to_string() });
        response
    }

    /// The widgets noted so far, in drawing order.
    pub fn widgets(&self) -> &[Widget] {
        &self.widgets
    }

    /// One JSON object; rectangles `[left, top, right, bottom]` in physical pixels. `state` adds to it.
    pub fn json(&self, pixels_per_point: f32, state: serde_json::Value) -> String {
        let widgets: Vec<_> = self
            .widgets
            .iter()
            .map(|w| {
                let corners =
                    [w.rect.left(), w.rect.top(), w.rect.right(), w.rect.bottom()].map(|v| v * pixels_per_point);
                serde_json::json!({ "name": w.name, "rect": corners, "value": w.value })
            })
            .collect();
        serde_json::json!({ "widgets": widgets, "state": state }).to_string()
    }
}
