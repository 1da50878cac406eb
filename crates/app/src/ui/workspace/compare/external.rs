//! The picture area beside another program's picture: all pictures have its size then, so that it can be measured, and are
//! shown in whole pixels where there is room.

use crate::model::{PaneSource, PaneView};
use crate::ui::UiContext;
use egui::{Rect, Vec2, vec2};

/// Width and height of the first picture of another program that is shown; `None` while there is none.
pub fn size(cx: &UiContext) -> Option<(u32, u32)> {
    let of = |shown: &PaneView| shown.external.as_ref().and_then(|_| Some(shown.image.as_ref()?.size()));
    let is_wanted = |pane| *cx.model.session.source(pane) != PaneSource::Made;
    cx.shown.panes.iter().filter(|(pane, _)| is_wanted(*pane)).find_map(|(_, shown)| of(shown))
}

/// Where pictures of this size lie in the room for all and in that for the first: together, and the first.
pub fn within([room, half]: [Rect; 2], size: (u32, u32), pixels_per_point: f32) -> [Rect; 2] {
    let frame = fitted(half, size, pixels_per_point);
    let beside = room.width() - half.width();
    [Rect::from_min_size(frame.min, frame.size() + vec2(beside, 0.0)), frame]
}

/// In the middle of the room, on whole physical pixels: so many of them for each of the picture as there is room for, or as
/// large as the room is.
fn fitted(room: Rect, (width, height): (u32, u32), pixels_per_point: f32) -> Rect {
    let (space, picture) = (room.size() * pixels_per_point, vec2(width as f32, height as f32));
    let factor = (space / picture).min_elem();
    let factor = if factor >= 1.0 { factor.floor() } else { factor };
    let size = (picture * factor).round().max(Vec2::splat(1.0));
    let corner = (room.min.to_vec2() * pixels_per_point + 0.5 * (space - size)).floor();
    Rect::from_min_size((corner / pixels_per_point).to_pos2(), size / pixels_per_point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn a_small_picture_is_shown_in_whole_pixels_and_a_large_one_as_large_as_there_is_room() {
        let room = Rect::from_min_size(pos2(10.0, 40.0), vec2(900.0, 600.0));
        assert_eq!(fitted(room, (256, 256), 1.0).size(), vec2(512.0, 512.0));
        assert_eq!(fitted(room, (640, 480), 1.0), Rect::from_min_size(pos2(140.0, 100.0), vec2(640.0, 480.0)));
        assert_eq!(fitted(room, (1800, 600), 1.0).size(), vec2(900.0, 300.0));
        assert_eq!(fitted(room, (640, 480), 2.0).size(), vec2(640.0, 480.0), "two by two physical pixels");
        let narrow = fitted(room, (1, 8192), 1.0);
        assert!(room.contains_rect(narrow) && narrow.width() == 1.0, "{narrow:?}");
    }

    #[test]
    fn two_pictures_beside_each_other_keep_their_distance() {
        let room = Rect::from_min_size(pos2(0.0, 0.0), vec2(908.0, 600.0));
        let half = Rect::from_min_size(room.min, vec2(450.0, 600.0));
        let [both, first] = within([room, half], (200, 100), 1.0);
        assert_eq!((first.size(), both.width()), (vec2(400.0, 200.0), 858.0));
        assert_eq!(both.min, first.min);
        let second = first.translate(vec2(both.width() - first.width(), 0.0));
        assert_eq!(second.left(), 458.0 + first.left());
    }
}
