//! How bright the pixels of A and B are: counts over stops, with the radiance that is shown as white.

use super::plots;
use crate::model::{IN_THE_REGION, PaneId, PaneView};
use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::Explained;
use compare::{Histogram, tick_text};
use egui::{Rangef, RichText, Ui};
use egui_plot::{AxisHints, LineStyle, Plot, PlotPoint, PlotPoints, VLine, uniform_grid_spacer};

/// Of the plot, in points.
const HEIGHT: f32 = 130.0;

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    cx.model.state.histograms = true;
    let shown = |(id, pane): (PaneId, &PaneView)| Some((id, pane.histogram.clone()?));
    let histograms: Vec<(PaneId, _)> = cx.shown.panes.iter().filter_map(shown).collect();
    let palette = palette(ui);
    let white = f64::from(-cx.model.session.display.exposure);
    let plot = Plot::new("histogram")
        .height(HEIGHT)
        .x_grid_spacer(uniform_grid_spacer(|_| [2.0, 4.0, 8.0]))
        .y_grid_spacer(uniform_grid_spacer(|_| [1.0, 2.0, 4.0]))
        .custom_x_axes(vec![
            AxisHints::new_x()
                .label("stops")
                .formatter(|mark, _| format!("{:+.0}", mark.value))
                .label_spacing(Rangef::new(18.0, 28.0)),
        ])
        .custom_y_axes(vec![
            AxisHints::new_y()
                .label("pixels")
                .formatter(|mark, _| tick_text(10f64.powf(mark.value).round()))
                .label_spacing(Rangef::new(12.0, 18.0)),
        ])
        .grid_color(palette.line)
        .include_y(0.0);
    let drawn = plots::fixed(plot).show(ui, |plot| {
        plot.vline(VLine::new("white", white).color(palette.dim).style(LineStyle::Dotted { spacing: 5.0 }));
        for (id, histogram) in &histograms {
            let style = if *id == PaneId::A { LineStyle::Solid } else { LineStyle::Dashed { length: 7.0 } };
            let line = plots::line(id.name(), PlotPoints::Owned(outline(histogram)));
            plot.line(line.color(palette.pane(*id)).style(style).width(2.0));
        }
    });
    let said: Vec<String> = histograms.iter().map(|(id, histogram)| in_words(*id, histogram)).collect();
    let place = cx.model.session.comparison.region.map_or_else(String::new, |_| format!(" {IN_THE_REGION}"));
    let text = format!("Pixels{place} by their luminance. {}", said.join("; "));
    let hover = "Stops above a luminance of 1, and the number of pixels on a logarithmic scale. A solid, B dashed; what is right of the dotted line is shown as white";
    cx.dump.note("histogram", &text, drawn.response.explained(hover).accessible_name(&text));
    let words = if place.is_empty() { said.join("\n") } else { format!("{}:\n{}", place.trim(), said.join("\n")) };
    ui.label(RichText::new(words).color(palette.dim));
}

/// "A: median -2.1 stops, 1234 darker than all".
fn in_words(id: PaneId, histogram: &Histogram) -> String {
    let median = histogram.median().map_or_else(|| "half is black".into(), |stop| format!("median {stop:+.1} stops"));
    let darker = if histogram.darker > 0 { format!(", {} black", histogram.darker) } else { String::new() };
    let brighter =
        if histogram.brighter > 0 { format!(", {} off the scale", histogram.brighter) } else { String::new() };
    format!("{id}: {median}{darker}{brighter}")
}

/// A line through the logarithms of its counts over the middles of their stops, down to one pixel where there are none.
fn outline(histogram: &Histogram) -> Vec<PlotPoint> {
    let mut outline: Vec<PlotPoint> = Vec::new();
    let mut end = None;
    for ([low, high], count) in histogram.bins() {
        let [low, high] = [low, high].map(f64::from);
        let half = 0.5 * (high - low);
        if let Some(end) = end.filter(|end| *end < low) {
            outline.push(PlotPoint::new(end + half, 0.0));
            if end + half < low - half {
                outline.push(PlotPoint::new(low - half, 0.0));
            }
        }
        outline.push(PlotPoint::new(low + half, f64::from(count).log10()));
        end = Some(high);
    }
    outline
}

#[cfg(test)]
mod tests {
    use super::*;
    use film::Vec3;

    #[test]
    fn the_outline_has_a_place_for_each_bin_and_goes_down_where_there_are_no_pixels() {
        let pixels = |bright: f32| -> Vec<Vec3> {
            [1.1; 10].into_iter().chain([1.2; 1000]).chain([bright; 100]).map(Vec3::splat).collect()
        };
        let places = |bright: f32| {
            let outline = outline(&Histogram::of(pixels(bright).iter()));
            outline.iter().map(|point| [point.x, point.y]).collect::<Vec<_>>()
        };
        let rising = [[0.125, 1.0], [0.375, 3.0]];
        assert_eq!(places(1.42), [rising[0], rising[1], [0.625, 2.0]], "side by side");
        assert_eq!(places(1.7), [rising[0], rising[1], [0.625, 0.0], [0.875, 2.0]], "one bin between");
        assert_eq!(places(4.1), [rising[0], rising[1], [0.625, 0.0], [1.875, 0.0], [2.125, 2.0]]);
    }
}
