//! The drawer of plots: how errors fall while pictures are made, over logarithmic axes, on which a power is a straight
//! line. egui_plot has linear axes alone: places are logarithms to base 10 here, and only ticks and hovers say numbers.

use crate::model::{
    Cost, Curve, Destination, ExportRequest, ExportSubject, Measure, Owner, PlotFile, PlotSettings, guide,
    judge_of_all, pin,
};
use crate::ruler::brief;
use crate::ui::theme::{Palette, palette};
use crate::ui::widgets::{Explained, choice, framed};
use crate::ui::{UiCommand, UiContext, export_menu};
use compare::{log_ticks, tick_text};
use egui::{Color32, Frame, Margin, RichText, Shape, Stroke, Ui, vec2};
use egui_plot::{
    GridInput, GridMark, HLine, HoverPosition, Line, LineStyle, MarkerShape, Plot, PlotPoints, PlotUi, Points,
};

/// Of the drawer at first, in points.
const HEIGHT: f32 = 240.0;
/// What lines are takes at most so many points of its width.
const KEY: f32 = 330.0;
/// Below this a plot says nothing.
const LEAST_HEIGHT: f32 = 120.0;

/// What stands for nothing, as the name of a line that has none in the legend.
const UNNAMED: &str = "";

/// Height that a drawer below the pictures may take at most, in points: all that are open leave them two fifths of the window.
pub fn drawer_room(cx: &UiContext, ui: &Ui) -> f32 {
    let open = [cx.model.session.plots.open, cx.model.session.probe.open].iter().filter(|open| **open).count();
    0.6 * ui.ctx().content_rect().height() / open.max(1) as f32
}

/// Draws the drawer, if it is open.
pub fn drawer(cx: &mut UiContext, ui: &mut Ui) {
    if !cx.model.session.plots.open {
        return;
    }
    let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::symmetric(10, 6));
    let most = drawer_room(cx, ui);
    let panel = egui::Panel::bottom("plots").resizable(true).default_size(HEIGHT.min(most)).frame(frame);
    let panel = panel.size_range(LEAST_HEIGHT.min(most)..=most);
    panel.show(ui, |ui| {
        let mut curves = cx.shown.curves();
        head(cx, ui, &curves);
        curves.splice(0..0, cx.model.state.pinned.iter().cloned());
        let key_width = KEY.min(0.4 * ui.available_width());
        ui.horizontal_top(|ui| {
            let width = ui.available_width() - key_width - ui.spacing().item_spacing.x;
            plot(cx, ui, &curves, width);
            ui.vertical(|ui| {
                ui.set_width(key_width);
                egui::ScrollArea::vertical().show(ui, |ui| key(cx, ui, &curves));
            });
        });
    });
}

/// What is plotted, and what can be done with it.
fn head(cx: &mut UiContext, ui: &mut Ui, curves: &[Curve]) {
    ui.horizontal_wrapped(|ui| {
        let plots = &mut cx.model.session.plots;
        let words = Measure::ALL.map(|m| (m.name().to_owned(), explain(m), plots.measure == m));
        if let Some(index) = choice(("plot of", "Plot"), words, ui, cx.dump) {
            plots.measure = Measure::ALL[index];
        }
        ui.label(RichText::new("over").color(palette(ui).dim));
        let words = Cost::ALL.map(|c| (c.name().to_owned(), explain_cost(c), plots.over == c));
        if let Some(index) = choice(("plot over", "Over"), words, ui, cx.dump) {
            plots.over = Cost::ALL[index];
        }
        pins(cx, ui, curves);
        let any = !curves.is_empty() || !cx.model.state.pinned.is_empty();
        for (kind, hover) in [
            (PlotFile::Csv, "All moments of all curves as a table of comma-separated values"),
            (PlotFile::Svg, "What is shown as a picture for slides and papers"),
        ] {
            let button = ui.add_enabled(any, framed(kind.name(), ui));
            let button = button.explained(hover).accessible_name(format!("Save the plot as {}", kind.name()));
            if cx.dump.note(&format!("plot {}", kind.name()), any, button).clicked() {
                let subject = ExportSubject::Plot(kind);
                let to = Destination::File(export_menu::plot_file(cx.model, kind));
                cx.commands.push(UiCommand::Export(ExportRequest { subject, to }));
            }
        }
        let close = ui.add(framed("Close", ui)).explained("Hide the plots (G)").accessible_name("Close the plots");
        if cx.dump.note("close plots", "", close).clicked() {
            cx.model.session.plots.open = false;
        }
    });
}

/// Curves to compare later ones with.
fn pins(cx: &mut UiContext, ui: &mut Ui, curves: &[Curve]) {
    let button = ui.add_enabled(!curves.is_empty(), framed("Pin", ui));
    let button = button.explained("Keep these curves, to compare with what you choose next").accessible_name("Pin");
    if cx.dump.note("pin curves", curves.len(), button).clicked() && !pin(&mut cx.model.state.pinned, curves.to_vec()) {
        cx.model.say(Err("there is no room for more pinned curves: unpin them first".into()));
    }
    let pinned = cx.model.state.pinned.len();
    if pinned > 0 {
        let button = ui.add(framed("Unpin all", ui)).explained("Forget the curves that were kept");
        if cx.dump.note("unpin curves", pinned, button).clicked() {
            cx.model.state.pinned.clear();
        }
    }
}

fn plot(cx: &mut UiContext, ui: &mut Ui, curves: &[Curve], width: f32) {
    let (settings, palette) = (cx.model.session.plots, palette(ui));
    let floor = floor(cx, settings.measure);
    let plot = Plot::new("errors")
        .width(width)
        .x_axis_label(settings.over.label())
        .y_axis_label(settings.measure.name())
        .x_grid_spacer(decades)
        .y_grid_spacer(decades)
        .x_axis_formatter(|mark, _| tick_of(mark))
        .y_axis_formatter(|mark, _| tick_of(mark))
        .grid_color(palette.line)
        .label_formatter(move |place| said_of(place, settings));
    let shown = fixed(plot).show(ui, |plot| {
        for curve in curves {
            draw(plot, curve, settings, palette);
        }
        if let Some(ends) = guide(curves, settings) {
            let (colour, style, width) = GUIDE.of(palette);
            let line = line(settings.measure.slope_name(), logs(ends.into_iter())).color(colour);
            plot.line(line.style(style).width(width).allow_hover(false));
        }
        if let Some(floor) = floor {
            let (colour, style, width) = FLOOR.of(palette);
            let line = HLine::new("noise of the reference", floor.log10()).color(colour);
            plot.hline(line.style(style).width(width).allow_hover(false));
        }
    });
    let said = spoken(curves, settings);
    let response =
        shown.response.accessible_name(if said.is_empty() { "Plot of errors: none yet".into() } else { said });
    cx.dump.note("plot", curves.len(), response);
}

/// It always fits what there is: nothing is lost by a slip of the mouse.
pub fn fixed(plot: Plot) -> Plot {
    let plot = plot.allow_drag(false).allow_zoom(false).allow_scroll(false);
    plot.allow_boxed_zoom(false).allow_axis_zoom_drag(false)
}

/// A line that goes through all of its points. By itself a plot merges those that lie within a pixel of each other to a band
/// from the lowest to the highest: that slants the steps of an outline and thins what is steep.
pub fn line<'a>(name: impl Into<String>, points: impl Into<PlotPoints<'a>>) -> Line<'a> {
    Line::new(name, points).allow_band(false)
}

/// What lines are, each with its latest error: beside the plot, where no line is hidden.
fn key(cx: &UiContext, ui: &mut Ui, curves: &[Curve]) {
    let (settings, palette) = (cx.model.session.plots, palette(ui));
    for curve in curves {
        let latest = curve.latest(settings.measure).map_or(String::new(), |error| format!("{}  ", brief(error)));
        entry(ui, look(curve.owner, palette), &format!("{latest}{}", curve.name_among(curves)), palette.text);
    }
    if guide(curves, settings).is_some() {
        entry(ui, GUIDE.of(palette), settings.measure.slope_name(), palette.dim);
    }
    if floor(cx, settings.measure).is_some() {
        entry(ui, FLOOR.of(palette), "noise of the reference", palette.dim);
    }
    let against = judge_of_all(curves).map(|judge| format!("against {judge}"));
    let nothing = curves.is_empty().then(|| "no errors have been measured yet".into());
    if let Some(text) = against.or(nothing) {
        ui.label(RichText::new(text).color(palette.dim));
    }
}

/// A piece of a line, and what it is.
fn entry(ui: &mut Ui, (colour, style, width): Look, text: &str, text_colour: Color32) {
    ui.horizontal(|ui| {
        let size = vec2(1.2 * ui.spacing().interact_size.y, ui.text_style_height(&egui::TextStyle::Body));
        let (_, rect) = ui.allocate_space(size);
        let ends = [rect.left_center(), rect.right_center()];
        let stroke = Stroke::new(width, colour);
        match style {
            LineStyle::Solid => drop(ui.painter().line_segment(ends, stroke)),
            LineStyle::Dashed { length } => {
                ui.painter().extend(Shape::dashed_line(&ends, stroke, length, 0.6 * length));
            }
            LineStyle::Dotted { spacing } => ui.painter().extend(Shape::dotted_line(&ends, colour, spacing, width)),
        }
        ui.add(egui::Label::new(RichText::new(text).color(text_colour)).truncate()).on_hover_text(text);
    });
}

/// The errors that the reference itself has: below them nothing can be told.
fn floor(cx: &UiContext, measure: Measure) -> Option<f64> {
    let of_panes = || cx.shown.panes.values().find_map(|pane| pane.errors?.1.reference_noise);
    let of_the_whole = |noise: &f64| cx.model.session.comparison.region.is_none().then_some(*noise);
    let floor = match measure {
        // it is told of the whole picture alone
        Measure::RelMse => cx.shown.reference.as_ref()?.noise.as_ref().and_then(of_the_whole),
        Measure::Rmse => of_panes().map(f64::sqrt),
        Measure::Mae => None,
    };
    floor.filter(|floor| *floor > 0.0)
}

fn draw(plot: &mut PlotUi, curve: &Curve, settings: PlotSettings, palette: &Palette) {
    let (colour, style, width) = look(curve.owner, palette);
    if curve.is_level(settings.over) {
        if let Some(error) = curve.latest(settings.measure) {
            plot.hline(HLine::new(&*curve.name, error.log10()).color(colour).style(style).width(width));
        }
        return;
    }
    let places = curve.places(settings);
    plot.line(line(&*curve.name, logs(places.iter().copied())).color(colour).style(style).width(width));
    let last = places.into_iter().last();
    let mark = Points::new(UNNAMED, logs(last.into_iter())).color(colour).radius(1.5 * width + 1.0);
    plot.points(mark.shape(MarkerShape::Circle).allow_hover(false));
}

/// Colour, style and width of a line.
type Look = (Color32, LineStyle, f32);

/// A line that is no curve: grey.
struct Grey {
    style: LineStyle,
    width: f32,
}

const GUIDE: Grey = Grey { style: LineStyle::Dotted { spacing: 6.0 }, width: 1.5 };
const FLOOR: Grey = Grey { style: LineStyle::Dashed { length: 4.0 }, width: 1.0 };

impl Grey {
    fn of(&self, palette: &Palette) -> Look {
        (palette.dim, self.style, self.width)
    }
}

/// A is solid, B dashed, so that nobody needs their colours to tell them apart; what is pinned is thin.
fn look(owner: Owner, palette: &Palette) -> Look {
    match owner {
        Owner::Pane(pane) => {
            let style =
                if pane == crate::model::PaneId::A { LineStyle::Solid } else { LineStyle::Dashed { length: 9.0 } };
            (palette.pane(pane), style, 2.5)
        }
        Owner::Pinned(index) => (palette.pinned[index % palette.pinned.len()], LineStyle::Solid, 1.5),
    }
}

fn logs<'a>(places: impl Iterator<Item = [f64; 2]>) -> PlotPoints<'a> {
    places.map(|place| place.map(f64::log10)).collect()
}

/// Marks at round numbers, of which powers of ten stand out.
pub fn decades(input: GridInput) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let mark = |value: f64| {
        let log = value.log10();
        let step_size = if (log - log.round()).abs() < 1e-9 { 1.0 } else { 0.3 };
        GridMark { value: log, step_size }
    };
    log_ticks(low, high).into_iter().map(mark).collect()
}

/// A logarithm's number: 1, 2 or 5 of a power of ten, from which 10 to a power is off by a rounding.
pub fn tick_of(mark: GridMark) -> String {
    let decade = 10f64.powf(mark.value.floor());
    tick_text((10f64.powf(mark.value) / decade).round() * decade)
}

/// "A: Path tracing, light", "64 samples: relMSE 0.002".
fn said_of(place: &HoverPosition, settings: PlotSettings) -> Option<String> {
    let HoverPosition::NearDataPoint { plot_name, position, .. } = place else { return None };
    let (cost, error) = (10f64.powf(position.x), brief(10f64.powf(position.y)));
    let cost = match settings.over {
        Cost::Samples => format!("{cost:.0} spp"),
        Cost::Seconds => format!("{} s", brief(cost)),
    };
    Some(format!("{plot_name}\n{cost}: {} {error}", settings.measure.name()))
}

/// The latest of each curve, for those who do not see it.
fn spoken(curves: &[Curve], settings: PlotSettings) -> String {
    let latest = |curve: &Curve| {
        let error = brief(curve.latest(settings.measure)?);
        Some(format!("{}: {} {error}", curve.name_among(curves), settings.measure.name()))
    };
    curves.iter().filter_map(latest).collect::<Vec<_>>().join("; ")
}

fn explain(measure: Measure) -> &'static str {
    match measure {
        Measure::RelMse => "Mean of squared differences relative to the right value: noise falls like 1 / samples",
        Measure::Rmse => {
            "Root of the mean squared difference, in radiance: noise falls like 1 / square root of samples"
        }
        Measure::Mae => "Mean absolute difference, in radiance: noise falls like 1 / square root of samples",
    }
}

fn explain_cost(cost: Cost) -> &'static str {
    match cost {
        Cost::Samples => "How good a sample is",
        Cost::Seconds => "What counts in the end: how good a second is",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_of_which_powers_of_ten_stand_out() {
        let marks = decades(GridInput { bounds: (-1.1, 1.1), base_step_size: 0.1 });
        let texts: Vec<String> = marks.iter().map(|mark| tick_of(*mark)).collect();
        assert_eq!(texts, ["0.1", "0.2", "0.5", "1", "2", "5", "10"]);
        assert!(marks.iter().all(|mark| (mark.step_size == 1.0) == ["0.1", "1", "10"].contains(&&*tick_of(*mark))));
        let wide = decades(GridInput { bounds: (-4.0, 4.0), base_step_size: 0.1 });
        let texts: Vec<String> = wide.into_iter().map(tick_of).collect();
        assert_eq!(texts, ["1e-4", "0.001", "0.01", "0.1", "1", "10", "100", "1000", "10000"]);
    }
}
