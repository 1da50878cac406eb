//! The names of the faces of a cube map that a pane shows in place of the scene.

use crate::model::PaneId;
use crate::ui::overlay::text_box;
use crate::ui::{UiContext, theme};
use egui::{Align2, Color32, Rect, Ui, pos2, vec2};
use raster::Show;
use raster::maps::faces_of_cross;
use technique::Technique;

/// The map that a pane's picture shows; `None` if it shows what the camera sees.
pub fn map_of(cx: &UiContext, pane: PaneId) -> Option<Show> {
    match cx.shown.panes.get(pane)?.provenance.as_ref()?.technique {
        Technique::Fake(fake) if fake.show.is_map() => Some(fake.show),
        _ => None,
    }
}

/// Names the faces of a pane's cube map, which lies at `place`.
pub fn show(cx: &mut UiContext, ui: &Ui, place: Rect, clip: Rect, pane: PaneId) {
    let size = theme::label_font(ui).size;
    if map_of(cx, pane) != Some(Show::CubeFaces) {
        return;
    }
    for (name, [left, top, side]) in faces_of_cross([place.width(), place.height()]) {
        // a name must leave something to be seen of its face
        if side > 3.0 * size {
            let at = pos2(place.left() + left, place.top() + top) + vec2(10.0, 6.0);
            let box_of_text = text_box(ui, clip, at, Align2::LEFT_TOP, name, Color32::WHITE);
            cx.dump.note_text(&format!("label {pane} face {name}"), name, box_of_text, clip);
        }
    }
}
