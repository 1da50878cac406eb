//! How a pixel's samples are spread: their number over their size, on an axis of ratios where some are far
//! larger than the mean.

use super::super::plots::{decades, fixed, line, tick_of};
use super::mean::style_of;
use crate::model::{Bin, Channel, PaneId, Spread};
use crate::ruler::brief;
use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::Explained;
use compare::tick_text;
use egui::{Rangef, Ui};
use egui_plot::{AxisHints, GridMark, Plot, PlotPoints};

/// Under one sample, on a logarithmic axis.
const NONE: f64 = -0.3;

pub fn plot(cx: &mut UiContext, ui: &mut Ui, width: f32) {
    let (channel, palette) = (cx.model.session.probe.channel, palette(ui));
    let spreads = spreads(cx, channel);
    let heavy = wants_ratios(&spreads);
    let x_axis = AxisHints::new_x().label(channel.name());
    let x_axis = if heavy { x_axis.formatter(|mark, _| tick_of(mark)) } else { x_axis };
    let x_axis = x_axis.label_spacing(Rangef::new(28.0, 40.0));
    let y_axis = AxisHints::new_y().label("samples").formatter(|mark, _| count_of(mark));
    let mut plot = Plot::new("spread of samples").width(width).grid_color(palette.line).include_y(NONE);
    plot = plot.custom_x_axes(vec![x_axis]).custom_y_axes(vec![y_axis]).y_grid_spacer(decades);
    if heavy {
        plot = plot.x_grid_spacer(decades);
    }
    let drawn = fixed(plot).show(ui, |plot| {
        for (pane, spread) in &spreads {
            let bins = if heavy { &spread.logarithmic } else { &spread.even };
            let line = line(pane.name(), outline(bins, heavy)).color(palette.pane(*pane));
            plot.line(line.style(style_of(*pane)).width(1.5));
        }
    });
    let said: Vec<String> = spreads.iter().map(|(pane, spread)| in_words(*pane, spread)).collect();
    let text = said.join("; ");
    let name = format!("Samples by their {}. {text}", channel.name());
    let hover =
        "How many samples are how bright, on a logarithmic scale; zeros are counted beside it. A solid, B dashed";
    cx.dump.note("plot of samples", &text, drawn.response.explained(hover).accessible_name(name));
}

/// Largest samples of so many times each other have no even axis in common.
const APART: f64 = 8.0;

/// Whether samples, or two panes' largest ones, are so far apart that an even axis would show nothing else.
fn wants_ratios(spreads: &[(PaneId, Spread)]) -> bool {
    let largest = || spreads.iter().map(|(_, spread)| spread.largest.0).filter(|largest| *largest > 0.0);
    let (least, most) = (largest().fold(f64::INFINITY, f64::min), largest().fold(0.0, f64::max));
    most > APART * least || spreads.iter().any(|(_, spread)| spread.is_heavy_tailed)
}

/// Fewer than one sample are none.
fn count_of(mark: GridMark) -> String {
    if mark.value < 0.0 { String::new() } else { tick_text(10f64.powf(mark.value).round()) }
}

/// Of each pane that has samples.
pub fn spreads(cx: &UiContext, channel: Channel) -> Vec<(PaneId, Spread)> {
    super::samples(cx).map(|(id, samples)| (id, samples.drawn(channel).spread.clone())).collect()
}

/// Steps of the logarithms of its counts.
fn outline(bins: &[Bin], logarithmic: bool) -> PlotPoints<'static> {
    let place = |value: f64| if logarithmic { value.log10() } else { value };
    let ends = bins.first().zip(bins.last()).map(|(first, last)| [*first.range.start(), *last.range.end()]);
    let mut steps: Vec<[f64; 2]> = ends.iter().map(|[start, _]| [place(*start), NONE]).collect();
    for Bin { range, count } in bins {
        let height = if *count == 0 { NONE } else { f64::from(*count).log10() };
        steps.extend([[place(*range.start()), height], [place(*range.end()), height]]);
    }
    steps.extend(ends.iter().map(|[_, end]| [place(*end), NONE]));
    steps.into()
}

/// "A: 38 % are 0; the largest is 12.500, of sample 17".
pub fn in_words(pane: PaneId, spread: &Spread) -> String {
    let zeros = 100.0 * f64::from(spread.zeros) / f64::from(spread.count.max(1));
    let (largest, sample) = spread.largest;
    format!("{pane}: {zeros:.0} % are 0; the largest is {}, of sample {}", brief(largest), sample + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_says_how_many_found_nothing_and_which_is_the_largest() {
        let spread = Spread { count: 200, zeros: 50, largest: (12.5, 16), ..Spread::default() };
        assert_eq!(in_words(PaneId::A, &spread), "A: 25 % are 0; the largest is 12.500, of sample 17");
    }

    #[test]
    fn panes_whose_samples_are_far_apart_have_an_axis_of_ratios() {
        let of = |largest: f64| (PaneId::A, Spread { largest: (largest, 0), ..Spread::default() });
        assert!(wants_ratios(&[of(0.5), of(20.0)]) && !wants_ratios(&[of(0.5), of(0.7)]));
        assert!(!wants_ratios(&[of(0.0), of(0.7)]) && !wants_ratios(&[]), "what is black has no place on it");
        let heavy = Spread { is_heavy_tailed: true, ..of(0.5).1 };
        assert!(wants_ratios(&[(PaneId::A, heavy)]));
    }

    #[test]
    fn an_outline_goes_up_and_down_between_its_ends() {
        let bins = [Bin { range: 1.0..=10.0, count: 100 }, Bin { range: 10.0..=100.0, count: 0 }];
        let PlotPoints::Owned(points) = outline(&bins, true) else { panic!("points of its own") };
        let places: Vec<[f64; 2]> = points.iter().map(|point| [point.x, point.y]).collect();
        assert_eq!(places, [[0.0, NONE], [0.0, 2.0], [1.0, 2.0], [1.0, NONE], [2.0, NONE], [2.0, NONE]]);
    }
}
