//! How errors have fallen, as lines for slides, papers and reports.

use crate::model::{Curve, Owner, PaneId, PlotSettings, guide, judge_of_all};
use compare::{LogLogPlot, PlotPoint, Range, Series, Stroke};

/// The plot of curves as an SVG document of its own, on white.
pub fn svg(curves: &[Curve], settings: PlotSettings, scene: &str) -> String {
    let against = judge_of_all(curves).map_or(String::new(), |judge| format!(" against {judge}"));
    let series_of = |curve: &Curve| Series { name: curve.name_among(curves), ..series(curve, settings) };
    let mut series: Vec<Series> = curves.iter().map(series_of).collect();
    series.extend(guide(curves, settings).map(|ends| Series {
        name: settings.measure.slope_name().into(),
        points: ends.map(point).into(),
        colour: GREY,
        stroke: Stroke::Dashed,
    }));
    let title = format!("{} of {scene}{against}", settings.measure.name());
    let plot = LogLogPlot {
        title: &title,
        x_label: settings.over.label(),
        y_label: settings.measure.name(),
        x_ticks: Vec::new(),
        series,
    };
    plot.svg()
}

/// The number of grey among the colours of plots.
const GREY: usize = 6;

fn series(curve: &Curve, settings: PlotSettings) -> Series {
    let (colour, stroke) = match curve.owner {
        Owner::Pane(PaneId::A) => (0, Stroke::Solid),
        Owner::Pane(_) => (1, Stroke::Dashed),
        // after those of panes, and without the guide's
        Owner::Pinned(index) => (2 + index + usize::from(index >= GREY - 2), Stroke::Solid),
    };
    if curve.is_level(settings.over) {
        let level = curve.latest(settings.measure).map(|error| point([f64::NAN, error]));
        return Series { name: curve.name.clone(), points: level.into_iter().collect(), colour, stroke: Stroke::Level };
    }
    Series { name: curve.name.clone(), points: curve.places(settings).into_iter().map(point).collect(), colour, stroke }
}

fn point([x, y]: [f64; 2]) -> PlotPoint {
    PlotPoint { x: Range::exactly(x), y: Range::exactly(y), hollow: false }
}
