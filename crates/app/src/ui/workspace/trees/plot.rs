//! Cost over triangles, both in powers of ten: the line of a list goes on as its triangles do, where measuring it would
//! take too long, and that is said.

use crate::model::{TreePlot, TreePoint, TreesSettings, extrapolated, statue_triangles};
use crate::ruler::brief;
use crate::ui::UiContext;
use crate::ui::theme::{Palette, palette};
use crate::ui::workspace::compare::plots::{decades, fixed, line, tick_of};
use egui::{Color32, Ui};
use egui_plot::{HoverPosition, Legend, LineStyle, MarkerShape, Plot, Points};
use pathtrace::intersect::counted::Structure;

/// Draws what was measured so far.
pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let (what, palette) = (cx.model.session.trees.plot, palette(ui));
    let points = &cx.shown.trees.points;
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
        .legend(Legend::default().position(egui_plot::Corner::LeftTop))
        .label_formatter(said_of);
    let shown = fixed(plot).show(ui, |plot| {
        for structure in Structure::ALL {
            let of: Vec<&TreePoint> = points.iter().filter(|point| point.structure == structure).collect();
            let places: Vec<[f64; 2]> =
                of.iter().map(|point| logs(point.triangles as f64, point.value(what))).collect();
            let colour = colour_of(structure, palette);
            plot.line(line(structure.name(), places.clone()).color(colour).width(2.0));
            plot.points(Points::new(structure.name(), places).color(colour).radius(3.5).shape(MarkerShape::Circle));
        }
        if let Some(ends) = extrapolated(points, what) {
            let places: Vec<[f64; 2]> = ends.iter().map(|&(x, y)| logs(x, y)).collect();
            let colour = colour_of(Structure::List, palette);
            let style = LineStyle::Dashed { length: 8.0 };
            plot.line(line("no tree, extrapolated", places).color(colour).style(style).width(1.5));
        }
    });
    let said = spoken(points, what);
    cx.dump.note("plot trees", points.len(), shown.response.accessible_name(said));
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
