//! The loupe: what lies about the mouse, pixel by pixel, in A, B, the reference and the error, with the numbers of the pixel
//! in the middle, in radiance and as the bytes that are shown.

use super::{magnify, map_faces};
use crate::model::{Against, PaneId};
use crate::ruler::brief;
use crate::ui::overlay::spoken;
use crate::ui::{UiContext, theme};
use compare::{ColourScale, ErrorMetric};
use egui::{Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Stroke, StrokeKind, Ui, pos2, vec2};
use film::{DisplayTransform, Image, Vec3};

/// Pixels along a side: as many at each side of the one in the middle.
const SIDE: usize = 9;
const PIXELS: usize = SIDE * SIDE;
const MIDDLE: usize = PIXELS / 2;

/// Between the loupe and the mouse, and around what is in it, in points.
const GAP: f32 = 12.0;

/// What one picture has there.
struct Tile {
    name: String,
    /// Rows from the top; `None` beyond its edge.
    colours: [Option<[u8; 3]>; PIXELS],
    /// What is said of the pixel in the middle, line by line.
    numbers: Vec<String>,
}

pub fn show(cx: &mut UiContext, ui: &Ui, rect: Rect, frames: &[Rect], hover: Option<Pos2>) {
    let (true, false, Some(at)) = (cx.model.state.loupe, cx.model.state.posing, hover) else { return };
    let share = magnify::picture_at(&cx.model.state.magnification, frames, at);
    let tiles = tiles(cx, share);
    if tiles.is_empty() {
        return;
    }
    let mut font = theme::figures().resolve(ui.style());
    let widest = tiles.iter().flat_map(|tile| tile.numbers.iter().chain([&tile.name]));
    let widest = |font: &FontId| {
        let width = |text: &String| ui.painter().layout_no_wrap(text.clone(), font.clone(), Color32::WHITE).size().x;
        widest.clone().map(width).fold(0.0, f32::max)
    };
    let room_for_text = (rect.width() - GAP) / tiles.len() as f32 - GAP;
    font.size *= (room_for_text / widest(&font)).clamp(0.3, 1.0);
    let room = (rect.width() - GAP) / tiles.len() as f32 - GAP;
    let cell = (font.size * 0.9).min(room / SIDE as f32).floor().max(2.0);
    let lines = tiles.iter().map(|tile| tile.numbers.len()).max().unwrap_or_default();
    let line = 1.35 * font.size;
    let width = widest(&font).max(cell * SIDE as f32);
    let size =
        vec2((width + GAP) * tiles.len() as f32 + GAP, cell * SIDE as f32 + line * (lines + 1) as f32 + 2.0 * GAP);
    let place = beside(at, size, rect);
    let painter = ui.painter().with_clip_rect(rect);
    let edge = Stroke::new(1.0, Color32::from_gray(110));
    painter.rect(place, 7.0, Color32::BLACK, edge, StrokeKind::Inside);
    for (index, tile) in tiles.iter().enumerate() {
        let corner = place.min + vec2(GAP + (width + GAP) * index as f32, GAP);
        draw(&painter, tile, corner, cell, (&font, line));
    }
    let text = tiles.iter().map(said).collect::<Vec<_>>().join("\n");
    cx.dump.note_text("loupe under the mouse", &text, place, rect);
    spoken(ui, "loupe under the mouse", &text, place, false);
}

/// Below the mouse at its right, or above and at its left; where neither side has room, in the corner farthest from it.
fn beside(at: Pos2, size: egui::Vec2, rect: Rect) -> Rect {
    let clear = |at: f32, size: f32, low: f32, high: f32| {
        let (after, before) = (at + GAP, at - GAP - size);
        [after, before].into_iter().find(|start| *start >= low && start + size <= high)
    };
    let [x, y] = [clear(at.x, size.x, rect.left(), rect.right()), clear(at.y, size.y, rect.top(), rect.bottom())];
    // one that clears the mouse is enough
    let far = |at: f32, size: f32, low: f32, high: f32| if at - low > high - at { low } else { (high - size).max(low) };
    let left = x.unwrap_or_else(|| far(at.x, size.x, rect.left(), rect.right()));
    let top = y.unwrap_or_else(|| far(at.y, size.y, rect.top(), rect.bottom()));
    Rect::from_min_size(pos2(left, top), size)
}

fn said(tile: &Tile) -> String {
    format!("{}: {}", tile.name, tile.numbers.join(", "))
}

/// Of A, B, the reference and the error of what is judged.
fn tiles(cx: &UiContext, share: [f32; 2]) -> Vec<Tile> {
    let display = cx.model.session.display;
    let shown = &cx.shown.panes;
    // a map of the fake does not lie where the scene does
    let image = |pane: PaneId| {
        let shown = shown.get(pane).filter(|_| map_faces::map_of(cx, pane).is_none())?;
        shown.image.as_ref()
    };
    let comparison = cx.model.session.comparison.mapped();
    let reference =
        shown.get(comparison.of).and_then(|shown| shown.reference.as_ref()).map(|reference| &reference.image);
    let judge = match comparison.against {
        Against::Pane(judge) => image(judge),
        Against::Reference => reference,
    };
    let panes = cx.model.session.panes.ids().filter_map(|pane| Some((pane.name(), image(pane)?)));
    let pictures = panes.chain(reference.map(|reference| ("reference", reference)));
    let mut tiles: Vec<Tile> = pictures.map(|(name, image)| of_picture(name, image, share, &display)).collect();
    if let (Some(image), Some(judge)) = (image(comparison.of), judge.filter(|_| judged(cx, comparison.of))) {
        let metric = match cx.model.session.comparison.metric {
            // it is of a pixel's neighbours too
            ErrorMetric::Flip => ErrorMetric::Signed,
            metric => metric,
        };
        let names = [comparison.of.name(), comparison.against.name()];
        let scale = cx.shown.map.as_ref().map(|map| &map.map).filter(|map| map.map == metric).map(|map| map.scale);
        tiles.extend(of_error(metric, names, [image, judge], share, scale));
    }
    tiles
}

/// Whether what a pane shows has errors.
fn judged(cx: &UiContext, pane: PaneId) -> bool {
    cx.shown.panes.get(pane).is_some_and(|shown| shown.errors.is_some())
}

fn of_picture(name: &str, image: &Image, share: [f32; 2], display: &DisplayTransform) -> Tile {
    let around = around(image, share);
    let numbers = around[MIDDLE].map_or_else(Vec::new, |middle| {
        let bytes = display.rgba8(middle);
        let channels = ["R", "G", "B"].into_iter().zip(middle.to_array()).zip(bytes);
        channels.map(|((name, value), byte)| format!("{name} {} ({byte})", brief(f64::from(value)))).collect()
    });
    let shown = |radiance: Vec3| {
        let [r, g, b, _] = display.rgba8(radiance);
        [r, g, b]
    };
    Tile { name: name.into(), colours: around.map(|radiance| radiance.map(shown)), numbers }
}

fn of_error(
    metric: ErrorMetric,
    names: [&str; 2],
    images: [&Image; 2],
    share: [f32; 2],
    scale: Option<ColourScale>,
) -> Option<Tile> {
    let [image, judge] = images.map(|image| around(image, share));
    let cut =
        |around: &[Option<Vec3>; PIXELS]| Image::new(SIDE as u32, SIDE as u32, around.map(Option::unwrap_or_default));
    let values = metric.of(&cut(&image)?, &cut(&judge)?, &DisplayTransform::default()).ok()?;
    let scale = scale.unwrap_or_else(|| ColourScale::fitted(metric, &values));
    let rgba = scale.image(&values, SIDE as u32);
    let colour = |pixel: usize| {
        image[pixel].and(judge[pixel])?;
        rgba.get(4 * pixel..4 * pixel + 3)?.try_into().ok()
    };
    let name = metric.label_of(names[0], names[1]);
    Some(Tile { name, colours: std::array::from_fn(colour), numbers: vec![brief(f64::from(values[MIDDLE]))] })
}

/// The pixels about a place, in shares of a picture; `None` beyond its edge.
fn around(image: &Image, share: [f32; 2]) -> [Option<Vec3>; PIXELS] {
    let (width, height) = image.size();
    let [x, y] = [(share[0], width), (share[1], height)].map(|(share, side)| (share * side as f32).floor() as i64);
    std::array::from_fn(|index| {
        let offset = |step: usize| step as i64 - (SIDE / 2) as i64;
        let (column, row) = (x + offset(index % SIDE), y + offset(index / SIDE));
        image.at(u32::try_from(column).ok().filter(|column| *column < width)?, u32::try_from(row).ok()?)
    })
}

fn draw(painter: &Painter, tile: &Tile, corner: Pos2, cell: f32, (font, line): (&FontId, f32)) {
    let mut mesh = Mesh::default();
    let square = |pixel: usize| {
        let step = vec2((pixel % SIDE) as f32, (pixel / SIDE) as f32);
        Rect::from_min_size(corner + cell * step, vec2(cell, cell))
    };
    for (pixel, colour) in tile.colours.iter().enumerate() {
        if let Some([r, g, b]) = *colour {
            mesh.add_colored_rect(square(pixel), Color32::from_rgb(r, g, b));
        }
    }
    painter.add(mesh);
    for (width, colour) in [(3.0, Color32::BLACK), (1.0, Color32::WHITE)] {
        painter.rect_stroke(square(MIDDLE), 0.0, Stroke::new(width, colour), StrokeKind::Outside);
    }
    let mut at = corner + vec2(0.0, cell * SIDE as f32 + 2.0);
    for text in std::iter::once(&tile.name).chain(&tile.numbers) {
        painter.text(at, Align2::LEFT_TOP, text, font.clone(), Color32::WHITE);
        at.y += line;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 20 by 10 pixels whose red is the column and whose green is the row.
    fn numbered(scale: f32) -> Image {
        let pixel = |i: u32| scale * Vec3::new((i % 20) as f32, (i / 20) as f32, 0.0);
        Image::new(20, 10, (0..200).map(pixel).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn it_shows_the_pixels_about_the_mouse_and_nothing_beyond_the_edge() {
        let middle = around(&numbered(1.0), [0.525, 0.55]);
        assert_eq!(middle[MIDDLE], Some(Vec3::new(10.0, 5.0, 0.0)));
        assert_eq!((middle[0], middle[PIXELS - 1]), (Some(Vec3::new(6.0, 1.0, 0.0)), Some(Vec3::new(14.0, 9.0, 0.0))));
        let corner = around(&numbered(1.0), [0.99, 0.01]);
        assert_eq!(corner[MIDDLE], Some(Vec3::new(19.0, 0.0, 0.0)));
        assert_eq!(corner.iter().flatten().count(), 25, "no row above, no column at the right");
    }

    #[test]
    fn its_numbers_are_radiance_and_the_byte_that_is_shown_and_the_error_of_the_metric() {
        let grey = |value: f32| Image::new(1, 1, [Vec3::splat(value)]).unwrap();
        let tile = of_picture("A", &grey(0.5), [0.5; 2], &DisplayTransform::default());
        assert_eq!(tile.numbers, ["R 0.500 (188)", "G 0.500 (188)", "B 0.500 (188)"]);
        assert_eq!(tile.colours.iter().flatten().collect::<Vec<_>>(), [&[188; 3]]);
        let of = |metric| of_error(metric, ["A", "B"], [&grey(0.25), &grey(0.5)], [0.5; 2], None).unwrap();
        assert_eq!(
            (of(ErrorMetric::Signed).numbers, of(ErrorMetric::Signed).name),
            (vec!["-0.250".into()], "A - B".into())
        );
        assert_eq!(of(ErrorMetric::Absolute).numbers, ["0.250"]);
        assert_eq!(of(ErrorMetric::Absolute).colours.iter().flatten().count(), 1);
    }

    #[test]
    fn it_stands_beside_the_mouse_within_the_pictures() {
        let rect = Rect::from_min_size(pos2(0.0, 40.0), vec2(900.0, 600.0));
        for at in [pos2(5.0, 45.0), pos2(890.0, 45.0), pos2(890.0, 630.0), pos2(450.0, 330.0)] {
            let place = beside(at, vec2(400.0, 200.0), rect);
            assert!(rect.contains_rect(place) && !place.contains(at), "{place:?} at {at:?}");
            // too wide to stand beside it, as on a small projector
            let place = beside(at, vec2(880.0, 200.0), rect);
            assert!(rect.contains_rect(place) && !place.contains(at), "{place:?} at {at:?}");
        }
        let low = Rect::from_min_size(pos2(0.0, 40.0), vec2(738.0, 430.0));
        for at in [pos2(150.0, 100.0), pos2(600.0, 400.0)] {
            let place = beside(at, vec2(708.0, 315.0), low);
            assert!(low.contains_rect(place) && !place.contains(at), "{place:?} at {at:?}");
        }
        assert!(low.contains_rect(beside(pos2(369.0, 255.0), vec2(708.0, 315.0), low)), "no room beside the middle");
    }
}
