//! Cost over triangles, both in powers of ten: the line of a list goes on as its triangles do, where measuring it would
//! take too long, and that is said.

use crate::model::{TreePlot, TreePoint, TreesSettings, extrapolated, statue_triangles};
use crate::ruler::brief;
use crate::ui::UiContext;
use crate::ui::theme::{Palette, palette};
use crate::ui::workspace::compare::plots::{decades, fixed, line, tick_of};
use egui::{Color32, Pos2, Rect, Shape, Stroke, Ui, vec2};
use egui_plot::{HoverPosition, LineStyle, MarkerShape, Plot, Points};
use pathtrace::intersect::counted::Structure;

/// Draws what was measured so far.
pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let (what, palette) = (cx.model.session.trees.plot, palette(ui));
    let points = &cx.shown.trees.points;
    let extrapolated = extrapolated(points, what);
    let (coarsest, finest) = (statue_triangles(0) as f64, statue_triangles(TreesSettings::FINEST) as f64);
    let type_size = egui::TextStyle::Body.resolve(ui.style()).size;
    let plot = Plot::new("trees")
        .include_x(coarsest.log10())
        .include_x(finest.log10())
        .y_axis_min_width(3.6 * type_size)
        .x_axis_label("triangles")
        .y_axis_label(what.label())
        .x_grid_spacer(decades)
        .y_grid_spacer(decades)
        .x_axis_formatter(|mark, _| tick_of(mark))
        .y_axis_formatter(|mark, _| tick_of(mark))
        .grid_color(palette.line)
        .label_formatter(said_of);
    let shown = fixed(plot).show(ui, |plot| {
        for structure in Structure::ALL {
            let of: Vec<&TreePoint> = points.iter().filter(|point| point.structure == structure).collect();
            let places: Vec<[f64; 2]> =
                of.iter().map(|point| logs(point.triangles as f64, point.value(what))).collect();
            let colour = colour_of(structure, palette);
            plot.line(line(structure.name(), places.clone()).color(colour).width(2.0));
            plot.points(Points::new(structure.name(), places).color(colour).radius(MARK).shape(mark_of(structure)));
        }
        if let Some(ends) = &extrapolated {
            let places: Vec<[f64; 2]> = ends.iter().map(|&(x, y)| logs(x, y)).collect();
            let colour = colour_of(Structure::List, palette);
            let style = LineStyle::Dashed { length: DASH };
            plot.line(line(EXTRAPOLATED, places).color(colour).style(style).width(1.5));
        }
    });
    key(cx, ui, *shown.transform.frame(), extrapolated.is_some());
    let said = spoken(points, what);
    cx.dump.note("plot trees", points.len(), shown.response.accessible_name(said));
}

/// Half the size of a mark in points.
const MARK: f32 = 4.0;
/// Points of a line that is no measurement that are drawn before as many are left out.
const DASH: f32 = 8.0;
/// What such a line is.
const EXTRAPOLATED: &str = "no tree, extrapolated";

/// What lines are, in the upper left corner of the plot, where they end last: a piece of each with its mark.
fn key(cx: &mut UiContext, ui: &Ui, plot: Rect, with_extrapolated: bool) {
    let palette = palette(ui);
    let measured = Structure::ALL.map(|structure| (structure.name(), Some(structure)));
    let entries = measured.into_iter().chain(with_extrapolated.then_some((EXTRAPOLATED, None)));
    let font = egui::TextStyle::Body.resolve(ui.style());
    let lines: Vec<_> = entries
        .map(|(name, structure)| (ui.painter().layout_no_wrap(name.into(), font.clone(), palette.text), structure))
        .collect();
    let widest = lines.iter().map(|(text, _)| text.size().x).fold(0.0, f32::max);
    let height: f32 = lines.iter().map(|(text, _)| text.size().y).sum();
    let (piece, gap) = (7.0 * MARK, 6.0);
    let ground = Rect::from_min_size(plot.min + vec2(8.0, 8.0), vec2(piece + widest + 3.0 * gap, height + 2.0 * gap));
    let painter = ui.painter().with_clip_rect(plot);
    painter.rect_filled(ground, 4.0, palette.panel.gamma_multiply(0.85));
    let mut at = ground.min + vec2(gap, gap);
    for (text, structure) in lines {
        let size = text.size();
        let place = Rect::from_min_size(at, vec2(piece + gap + size.x, size.y));
        let colour = colour_of(structure.unwrap_or(Structure::List), palette);
        let ends = [place.left_center(), place.left_center() + vec2(piece, 0.0)];
        match structure {
            Some(structure) => {
                painter.line_segment(ends, Stroke::new(2.0, colour));
                painter.add(mark(mark_of(structure), ends[0].lerp(ends[1], 0.5), colour));
            }
            None => painter.extend(Shape::dashed_line(&ends, Stroke::new(1.5, colour), DASH, DASH)),
        }
        cx.dump.note_text(&format!("key {}", text.text()), "", place, plot);
        painter.galley(at + vec2(piece + gap, 0.0), text, palette.text);
        at.y += size.y;
    }
}

/// What marks the points of a structure: nobody needs colours to tell them apart.
fn mark_of(structure: Structure) -> MarkerShape {
    match structure {
        Structure::List => MarkerShape::Circle,
        Structure::Two => MarkerShape::Square,
        Structure::Eight => MarkerShape::Diamond,
    }
}

/// A mark as the plot draws it.
fn mark(shape: MarkerShape, middle: Pos2, colour: Color32) -> Shape {
    let corners = match shape {
        MarkerShape::Square => {
            [vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)].map(|c| c / 2f32.sqrt())
        }
        MarkerShape::Diamond => [vec2(0.0, -1.0), vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(-1.0, 0.0)],
        _ => return Shape::circle_filled(middle, MARK, colour),
    };
    Shape::convex_polygon(corners.map(|corner| middle + MARK * corner).into(), colour, Stroke::NONE)
}

fn colour_of(structure: Structure, palette: &Palette) -> Color32 {
    match structure {
        Structure::List => palette.error,
        Structure::Two => palette.pane(crate::model::PaneId::B),
        Structure::Eight => palette.pane(crate::model::PaneId::A),
    }
}

fn logs(x: f64, y: f64) -> [f64; 2] {
    [x.log10(), y.max(1e-12).log10()]
}

fn said_of(place: &HoverPosition) -> Option<String> {
    let HoverPosition::NearDataPoint { position, .. } = place else { return None };
    let [x, y] = [position.x, position.y].map(|log| 10f64.powf(log));
    Some(format!("{} triangles: {}", crate::model::grouped(x.round() as u64), brief(y)))
}

/// The plot in words, for those who do not see it.
fn spoken(points: &[TreePoint], what: TreePlot) -> String {
    let last = |structure| points.iter().rfind(|point: &&TreePoint| point.structure == structure);
    let words = Structure::ALL.into_iter().filter_map(last).map(|point| {
        let (name, triangles) = (point.structure.name(), crate::model::grouped(point.triangles));
        format!("{name} at {triangles} triangles {}", brief(point.value(what)))
    });
    let all: Vec<String> = words.collect();
    if all.is_empty() { "Plot of costs: none yet".into() } else { format!("{}: {}", what.label(), all.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structures_are_told_apart_by_their_marks_alone() {
        let corners = |structure| match mark(mark_of(structure), Pos2::ZERO, Color32::WHITE) {
            Shape::Path(path) => path.points.iter().map(|at| [at.x, at.y].map(|side| side.round() as i32)).collect(),
            _ => Vec::new(),
        };
        let all = Structure::ALL.map(corners);
        assert!(all[0] != all[1] && all[1] != all[2] && all[0] != all[2], "{all:?}");
    }
}
