//! What is on the screen, for tests that click: names, rectangles and values of the widgets.

use egui::{Id, Rect, Response};

/// A widget as last drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Widget {
    /// Its name, stable across versions.
    pub name: String,
    /// Where it is, in points.
    pub rect: Rect,
    /// What of it is not clipped away, in points.
    pub visible: Rect,
    /// Its state as text.
    pub value: String,
    /// What egui knows it by; `None` for painted text.
    pub id: Option<Id>,
}

/// The widgets of one frame.
#[derive(Debug, Default)]
pub struct Dump {
    widgets: Vec<Widget>,
}

impl Dump {
    /// Notes a widget and hands its response on.
    pub fn note(&mut self, name: &str, value: impl ToString, response: Response) -> Response {
        self.widgets.push(Widget {
            name: name.to_owned(),
            rect: response.rect,
            visible: response.interact_rect,
            value: value.to_string(),
            id: Some(response.id),
        });
        response
    }

    /// Notes a text that is painted without being a widget.
    pub fn note_text(&mut self, name: &str, text: &str, rect: Rect, clip: Rect) {
        let visible = rect.intersect(clip);
        self.widgets.push(Widget { name: name.to_owned(), rect, visible, value: text.to_owned(), id: None });
    }

    /// The widgets noted so far, in drawing order.
    pub fn widgets(&self) -> &[Widget] {
        &self.widgets
    }

    /// One JSON object; rectangles `[left, top, right, bottom]` in physical pixels. `focused` has the keyboard after the
    /// frame, which Tab may have moved in its course; `state` adds to the object.
    pub fn json(&self, pixels_per_point: f32, focused: Option<Id>, state: serde_json::Value) -> String {
        let focus = self.widgets.iter().find(|w| focused.is_some() && w.id == focused).map(|w| &w.name);
        let corners =
            |r: &Rect| [r.left(), r.top(), r.right(), r.bottom()].map(|points| f64::from(points * pixels_per_point));
        let widgets: Vec<_> = self
            .widgets
            .iter()
            .map(|w| {
                let (rect, visible) = (corners(&w.rect), corners(&w.visible));
                serde_json::json!({ "name": w.name, "rect": rect, "visible": visible, "value": w.value })
            })
            .collect();
        serde_json::json!({ "widgets": widgets, "focus": focus, "state": state }).to_string()
    }
}
