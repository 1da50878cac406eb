//! How the mean of a pixel's samples settles: over their number, on a logarithmic axis, with two standard errors about it.

use super::super::plots::{decades, fixed, line, tick_of};
use super::{probed, radiance, value_without_samples};
use crate::model::{Channel, PaneId, RunningMean};
use crate::ruler::brief;
use crate::ui::UiContext;
use crate::ui::theme::{Palette, palette};
use crate::ui::widgets::Explained;
use egui::{Color32, Rangef, Ui};
use egui_plot::{AxisHints, FilledArea, GridMark, HLine, LineStyle, Plot, PlotPoints, PlotUi, uniform_grid_spacer};

/// Standard errors at each side of the mean, between which the truth lies in 95 of 100 pixels.
pub const ERRORS: f64 = 2.0;

/// What a band lets through.
const BAND: f32 = 0.22;

const HOVER: &str = "The mean of the first samples, with two standard errors at each side by their spread. A solid, B dashed; dotted \
                     the reference";

pub fn plot(cx: &mut UiContext, ui: &mut Ui, width: f32) {
    let (channel, palette) = (cx.model.session.probe.channel, palette(ui));
    let reference = reference(cx).map(|radiance| channel.of(radiance));
    let plot = Plot::new("running means")
        .width(width)
        .custom_x_axes(vec![AxisHints::new_x().label("samples").formatter(|mark, _| tick_of(mark))])
        .custom_y_axes(vec![
            AxisHints::new_y()
                .label(format!("mean {}", channel.name()))
                .label_spacing(Rangef::new(12.0, 18.0))
                .formatter(|mark, _| even_tick(mark)),
        ])
        .x_grid_spacer(decades)
        .y_grid_spacer(uniform_grid_spacer(|input| {
            let step = round_step((input.bounds.1 - input.bounds.0) / MARKS);
            [step, 5.0 * step, 10.0 * step]
        }))
        .grid_color(palette.line);
    let panes: Vec<PaneId> = cx.model.session.panes.ids().collect();
    let drawn = fixed(plot).show(ui, |plot| {
        for pane in &panes {
            draw(cx, plot, *pane, channel, palette);
        }
        if let Some(value) = reference {
            let line = HLine::new("reference", value).color(palette.text).width(1.5);
            plot.hline(line.style(LineStyle::Dotted { spacing: 5.0 }));
        }
    });
    let said: Vec<String> = panes.into_iter().filter_map(|pane| in_words(cx, pane, channel)).collect();
    let said = said.into_iter().chain(reference.map(|value| format!("reference {}", brief(value))));
    let text = said.collect::<Vec<_>>().join("; ");
    let name = format!("Mean {} of the samples. {text}", channel.name());
    let response = drawn.response.explained(HOVER).accessible_name(name);
    cx.dump.note("plot of means", &text, response);
}

/// A multiple of a round step, without the digits that it is off by.
fn even_tick(mark: GridMark) -> String {
    (mark.value as f32).to_string()
}

/// Marks along the axis of means, about.
const MARKS: f64 = 5.0;

/// 1, 2 or 5 of a power of ten, the first that is no smaller than this.
fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.max(f64::MIN_POSITIVE).log10().floor());
    let step = [1.0, 2.0, 5.0].into_iter().find(|step| step * decade >= least);
    step.unwrap_or(10.0) * decade
}

fn draw(cx: &UiContext, plot: &mut PlotUi, pane: PaneId, channel: Channel, palette: &Palette) {
    let (colour, style) = (palette.pane(pane), style_of(pane));
    if let Some(value) = value_without_samples(cx, pane) {
        plot.hline(HLine::new(pane.name(), channel.of(value)).color(colour).style(style).width(2.5));
        return;
    }
    let Some(samples) = probed(cx, pane).and_then(|probe| probe.samples.as_ref()) else { return };
    let course = &samples.drawn(channel).course;
    band(plot, pane, course, colour);
    let places: PlotPoints = course.iter().map(|mean| [place(mean), mean.mean]).collect();
    plot.line(line(pane.name(), places).color(colour).style(style).width(2.5));
}

/// Two standard errors at each side, from where they are known.
fn band(plot: &mut PlotUi, pane: PaneId, course: &[RunningMean], colour: Color32) {
    let known: Vec<&RunningMean> = course.iter().filter(|mean| mean.samples > 1).collect();
    if known.len() < 2 {
        return;
    }
    let xs: Vec<f64> = known.iter().map(|mean| place(mean)).collect();
    let edge = |side: f64| known.iter().map(|mean| mean.mean + side * ERRORS * mean.error).collect::<Vec<_>>();
    let area = FilledArea::new(format!("{pane}: 2 standard errors"), &xs, &edge(-1.0), &edge(1.0));
    plot.add(area.fill_color(colour.gamma_multiply(BAND)).allow_hover(false));
}

fn place(mean: &RunningMean) -> f64 {
    f64::from(mean.samples).log10()
}

/// A is solid, B dashed, as in all plots.
pub fn style_of(pane: PaneId) -> LineStyle {
    if pane == PaneId::A { LineStyle::Solid } else { LineStyle::Dashed { length: 9.0 } }
}

/// What the reference has there, where there is one.
fn reference(cx: &UiContext) -> Option<film::Vec3> {
    let image = cx.shown.panes.values().find_map(|pane| pane.reference.as_ref())?;
    radiance(cx, &image.image)
}

/// "A: 0.512 ± 0.013 of 256 samples", or why there is no such thing.
fn in_words(cx: &UiContext, pane: PaneId, channel: Channel) -> Option<String> {
    if let Some(value) = value_without_samples(cx, pane) {
        return Some(format!("{pane}: {}, one value without samples", brief(channel.of(value))));
    }
    let probe = probed(cx, pane)?;
    if let Some(fault) = &probe.fault {
        return Some(format!("{pane}: {fault}"));
    }
    let last = probe.samples.as_ref()?.drawn(channel).course.last()?;
    Some(format!("{pane}: {} ± {} of {} samples", brief(last.mean), brief(ERRORS * last.error), last.samples))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_no_smaller_than_asked_for() {
        let steps = [0.013, 0.2, 3.1, 60.0].map(round_step);
        let expected = [0.02, 0.2, 5.0, 100.0];
        assert!(steps.iter().zip(expected).all(|(step, expected)| (step / expected - 1.0).abs() < 1e-12), "{steps:?}");
        assert!(round_step(0.0) > 0.0);
        let told = [-0.5, 0.0, 0.1 + 0.2].map(|value| even_tick(GridMark { value, step_size: 0.5 }));
        assert_eq!(told, ["-0.5", "0", "0.3"]);
    }
}
