//! The tiles in a grid, each with its caption, as large as there is room.

use super::controls::hover_of_tiles;
use crate::model::{PaneId, PictureArea, PlannedTile, SweepPlan, best, captions};
use crate::ui::UiContext;
use crate::ui::overlay::say;
use crate::ui::theme::{figures, palette, semi_bold};
use crate::ui::widgets::Explained;
use egui::text::{LayoutJob, TextWrapping};
use egui::{Color32, FontId, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2, vec2};

/// Between tiles, in points.
const GAP: f32 = 10.0;

/// Width over height of a tile: what is left of the window in between.
const NARROWEST: f32 = 1.0;
const WIDEST: f32 = 16.0 / 9.0;

/// The least height of a tile that is drawn, in points.
const LEAST: f32 = 24.0;

/// What a strip must win by another row, in area of its tiles.
const MUCH_LARGER: f32 = 1.5;

/// How tiles stand, in points.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Grid {
    columns: usize,
    /// Width and height of a tile.
    size: Vec2,
    /// Height of a caption.
    caption: f32,
}

impl Grid {
    /// In so many columns.
    fn in_columns(columns: usize, count: usize, room: Vec2, caption: f32) -> Self {
        let rows = count.div_ceil(columns);
        let width = (room.x - GAP * (columns - 1) as f32) / columns as f32;
        let height = (room.y - GAP * (rows - 1) as f32) / rows as f32 - caption;
        let size = vec2(width.min(height * WIDEST), height.min(width / NARROWEST));
        Grid { columns, size: size.max(vec2(LEAST, LEAST)).floor(), caption }
    }

    /// A matrix as it is; a strip in one row, unless its tiles are much larger in several.
    fn of(plan: &SweepPlan, room: Vec2, caption: f32) -> Self {
        let count = plan.tiles.len();
        let columns = plan.columns.values.len();
        if plan.rows.is_some() {
            return Grid::in_columns(columns, count, room, caption);
        }
        let grids = (1..=columns).rev().map(|columns| Grid::in_columns(columns, count, room, caption));
        let area = |grid: &Grid| grid.size.x * grid.size.y;
        let larger = |one: Grid, other: Grid| if area(&other) > MUCH_LARGER * area(&one) { other } else { one };
        grids.reduce(larger).unwrap_or_else(|| Grid::in_columns(1, 1, room, caption))
    }

    fn rect(&self, index: usize, corner: egui::Pos2) -> Rect {
        let (column, row) = ((index % self.columns) as f32, (index / self.columns) as f32);
        let step = self.size + vec2(GAP, GAP + self.caption);
        Rect::from_min_size(corner + vec2(column * step.x, row * step.y), self.size)
    }

    /// Left of the middle by as much as right of it.
    fn corner(&self, room: Rect) -> egui::Pos2 {
        let width = self.columns as f32 * (self.size.x + GAP) - GAP;
        pos2(room.left() + (0.5 * (room.width() - width)).max(0.0).floor(), room.top())
    }
}

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let room = ui.max_rect();
    let Some(plan) = cx.model.state.sweep.plan.clone() else {
        let fault = cx.model.state.sweep.fault.clone().unwrap_or_default();
        return speak(cx, ui, room, &fault);
    };
    let font = figures().resolve(ui.style());
    let row = 1.3 * font.size;
    let labels = cx.model.state.labels;
    let lines = if labels { 2 + plan.tiles.first().map_or(1, |tile| tile.names.len()) } else { 0 };
    let grid = Grid::of(&plan, room.size(), lines as f32 * row);
    note_area(cx, ui, &grid);
    let measure = cx.model.session.sweep.measure;
    let captions = captions(&plan, &cx.shown.sweep.tiles, measure);
    let all_known = cx.shown.sweep.tiles.len() == plan.tiles.len();
    let fitting = fitting(ui, captions.iter().flatten(), grid.size.x, &font);
    let best = if all_known { best(&cx.shown.sweep.tiles, measure) } else { Vec::new() };
    let corner = grid.corner(room);
    for (index, (tile, caption)) in plan.tiles.iter().zip(captions).enumerate() {
        let rect = grid.rect(index, corner);
        let best = best.contains(&index);
        show_tile(cx, ui, rect, (index, tile), (&caption, best));
        if labels {
            letter(ui, rect, (&caption, best), (&fitting, row));
        }
    }
    speak(cx, ui, room, "");
}

/// The type at which the longest line fits below a tile, if that can still be read.
fn fitting<'a>(ui: &Ui, lines: impl Iterator<Item = &'a String>, room: f32, font: &FontId) -> FontId {
    let strong = FontId::new(font.size, semi_bold());
    let width = |line: &String| ui.painter().layout_no_wrap(line.clone(), strong.clone(), Color32::WHITE).size().x;
    let longest = lines.map(width).fold(1.0, f32::max);
    FontId { size: font.size * (0.98 * room / longest).clamp(SMALLEST, 1.0), ..font.clone() }
}

/// The smallest type of a caption, as a share of the usual.
const SMALLEST: f32 = 0.65;

/// Says what is to be said, and no hints of the comparison.
fn speak(cx: &mut UiContext, ui: &Ui, room: Rect, hint: &str) {
    let hints = std::mem::replace(&mut cx.model.state.hint, !hint.is_empty());
    say(cx, ui, room, &[hint]);
    cx.model.state.hint = hints;
}

/// Pictures are made as large as they are shown.
fn note_area(cx: &mut UiContext, ui: &Ui, grid: &Grid) {
    let pixels = (grid.size * ui.ctx().pixels_per_point()).into();
    let shrink = cx.model.session.resolution.shrink();
    cx.model.state.sweep.area = PictureArea::new(pixels, pixels, shrink, [0.0; 4]);
}

fn show_tile(
    cx: &mut UiContext,
    ui: &mut Ui,
    rect: Rect,
    (index, tile): (usize, &PlannedTile),
    (caption, best): (&[String], bool),
) {
    let response = ui.interact(rect, ui.scope_id().with(("tile", index)), Sense::click());
    let palette = palette(ui);
    match cx.textures.tiles.get(index).copied().flatten() {
        Some(texture) => {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture, rect, whole, Color32::WHITE);
        }
        None => _ = ui.painter().rect_filled(rect, 2.0, palette.card),
    }
    let frame = match (response.has_focus() || response.hovered(), best) {
        (true, _) => Some(Stroke::new(3.0, palette.text)),
        (false, true) => Some(Stroke::new(3.0, palette.accent)),
        (false, false) => None,
    };
    frame.into_iter().for_each(|stroke| _ = ui.painter().rect_stroke(rect, 2.0, stroke, StrokeKind::Outside));
    let spoken = format!("{}: {}", tile.name(), caption[tile.names.len()..].join(", "));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &spoken));
    let response = response.explained(&hover_of_tiles());
    let response = cx.dump.note(&format!("tile {}", index + 1), spoken, response);
    choose(cx, ui, tile, &response);
}

/// A tile that is clicked becomes A, or B with Shift.
fn choose(cx: &mut UiContext, ui: &Ui, tile: &PlannedTile, response: &Response) {
    if response.clicked() {
        let pane = if ui.input(|i| i.modifiers.shift) { PaneId::B } else { PaneId::A };
        cx.model.compare_tile(tile, pane);
        ui.ctx().request_repaint();
    }
}

fn letter(ui: &Ui, rect: Rect, (caption, best): (&[String], bool), (font, row): (&FontId, f32)) {
    let palette = palette(ui);
    for (number, text) in caption.iter().enumerate() {
        let last = number + 1 == caption.len();
        let (colour, font) = match number {
            0 => (palette.text, FontId::new(font.size, semi_bold())),
            _ if best && last => (palette.accent, font.clone()),
            _ => (palette.dim, font.clone()),
        };
        let mut job = LayoutJob::simple_singleline(text.clone(), font, colour);
        job.wrap = TextWrapping::truncate_at_width(rect.width());
        let galley = ui.painter().layout_job(job);
        ui.painter().galley(pos2(rect.left(), rect.bottom() + 4.0 + number as f32 * row), galley, colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_as_large_as_there_is_room_and_neither_narrow_nor_flat() {
        let room = vec2(980.0, 640.0);
        for count in 1..=8 {
            let best = (1..=count).map(|columns| Grid::in_columns(columns, count, room, 50.0));
            for grid in best.filter(|grid| grid.size.y > LEAST) {
                let rows = count.div_ceil(grid.columns) as f32;
                let all = vec2(grid.columns as f32, rows) * (grid.size + vec2(GAP, GAP + 50.0)) - vec2(GAP, GAP);
                assert!(all.x <= room.x && all.y <= room.y, "{grid:?}");
                // to a point
                let [width, height] = [grid.size.x, grid.size.y];
                assert!(width + 1.0 >= height && width <= WIDEST * (height + 1.0), "{grid:?}");
            }
        }
    }
}
