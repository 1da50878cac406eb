//! A number: its name at the left, its value at the right, to be typed, and under both a slider as wide as there is room.

use super::Explained;
use crate::ui::Dump;
use crate::ui::theme::palette;
use egui::{
    Align, Color32, DragValue, Id, Key, Label, Layout, PointerButton, Rect, Response, RichText, Slider, SliderClamping,
    TextStyle, Ui,
};
use egui::{pos2, vec2};
use std::cell::RefCell;
use std::ops::RangeInclusive;

/// How a slider's place belongs to its value.
#[derive(Debug, Clone, PartialEq)]
pub enum Scale {
    /// Even steps over a range.
    Steps {
        /// What the slider reaches; what is typed may go on to the bounds.
        range: RangeInclusive<f64>,
        /// How far apart its stops are.
        step: f64,
    },
    /// Positive numbers of a range, in steps of equal ratios.
    Logarithmic(RangeInclusive<f64>),
    /// Whole numbers of a range.
    Whole(RangeInclusive<u32>),
    /// Powers of two with these exponents.
    Doubling(RangeInclusive<u32>),
    /// Whole numbers that are typed or dragged, without a slider.
    Typed,
    /// Whole numbers, and behind the last one "no limit": infinity.
    WholeOrNone(RangeInclusive<u32>),
}

/// A number with its names and bounds.
pub struct NumberRow<'a> {
    /// Its name in the dump.
    pub name: &'a str,
    /// What it is, in words.
    pub label: &'a str,
    /// What is told of it under the mouse; empty for nothing.
    pub hover: &'a str,
    /// Where the slider goes.
    pub scale: Scale,
    /// What may be typed.
    pub bounds: RangeInclusive<f64>,
    /// The unit, after the number.
    pub unit: &'a str,
    /// What the number means, after its unit.
    pub aside: String,
    /// Whether a double click on the slider brings back what is usual.
    pub resets: bool,
    /// The colour of the rail before the handle.
    pub tint: Color32,
}

/// What a user has done to a number.
#[derive(Debug, Default)]
pub struct Told {
    /// Whether it was changed.
    pub changed: bool,
    /// Whether what is usual shall come back in its place.
    pub reset: bool,
    /// Why what was typed does not count: a line.
    pub fault: Option<String>,
}

impl Scale {
    fn place_of(&self, value: f64) -> f64 {
        match self {
            Scale::Steps { .. } | Scale::Whole(_) | Scale::Typed => value,
            Scale::Logarithmic(range) => value.max(*range.start()).log10(),
            Scale::Doubling(_) => value.max(1.0).log2().floor(),
            Scale::WholeOrNone(range) => value.min(f64::from(*range.end()) + 1.0),
        }
    }

    fn value_at(&self, place: f64) -> f64 {
        match self {
            Scale::Steps { .. } | Scale::Whole(_) | Scale::Typed => place,
            Scale::Logarithmic(_) => in_three_digits(10f64.powf(place)),
            Scale::Doubling(_) => place.exp2(),
            Scale::WholeOrNone(range) if place > f64::from(*range.end()) => f64::INFINITY,
            Scale::WholeOrNone(_) => place,
        }
    }

    fn range(&self) -> RangeInclusive<f64> {
        match self {
            Scale::Steps { range, .. } => range.clone(),
            Scale::Logarithmic(range) => range.start().log10()..=range.end().log10(),
            Scale::Whole(range) => f64::from(*range.start())..=f64::from(*range.end()),
            Scale::Typed => 0.0..=1.0,
            Scale::Doubling(exponents) => f64::from(*exponents.start())..=f64::from(*exponents.end()),
            Scale::WholeOrNone(range) => f64::from(*range.start())..=f64::from(*range.end()) + 1.0,
        }
    }

    fn step(&self) -> f64 {
        match self {
            Scale::Steps { step, .. } => *step,
            Scale::Logarithmic(_) => 0.01,
            _ => 1.0,
        }
    }

    /// How much a pixel of dragging changes the number beside the slider.
    fn speed(&self, value: f64) -> f64 {
        match self {
            _ if self.is_whole() => 0.05 + 0.01 * value.min(1e6),
            Scale::Logarithmic(_) => 0.01 * value,
            _ => self.step(),
        }
    }

    /// As it stands at the right, without unit.
    fn text(&self, value: f64) -> String {
        match self {
            _ if value.is_infinite() => "no limit".into(),
            Scale::Steps { step, .. } => digits(value, *step),
            Scale::Logarithmic(_) => in_three_digits(value).to_string(),
            _ => format!("{value:.0}"),
        }
    }

    fn parse(&self, text: &str) -> Result<f64, String> {
        match (self, text.trim()) {
            (Scale::WholeOrNone(_), "no limit" | "unlimited" | "inf" | "∞") => Ok(f64::INFINITY),
            // which may stand between thousands
            (_, text) if self.is_whole() && text.contains(',') => Err(format!("\"{text}\" is no whole number")),
            (_, text) => parse_number(text),
        }
    }

    fn is_whole(&self) -> bool {
        !matches!(self, Scale::Steps { .. } | Scale::Logarithmic(_))
    }
}

impl NumberRow<'_> {
    /// Shows it; what the user does changes `value`.
    ///
    /// It changes only when the user does it. egui's own default rounds and clamps whatever it is shown, in every
    /// frame: a scene's number between two steps would be altered by looking at it, and one that does not survive the
    /// way there and back, as 1 / (1 / ratio), would never come to rest. What is typed counts on Enter or when the field is left.
    pub fn show(self, value: &mut f64, ui: &mut Ui, dump: &mut Dump) -> Told {
        let before = *value;
        let fault = RefCell::new(None);
        let shown = ui.scope(|ui| {
            ui.visuals_mut().selection.bg_fill = self.tint;
            ui.spacing_mut().item_spacing.y = 1.0;
            let label = self.head(value, &fault, ui, dump);
            self.scale != Scale::Typed && self.slider(value, &label, ui, dump)
        });
        ui.add_space(2.0);
        Told { changed: *value != before, reset: shown.inner, fault: fault.into_inner() }
    }

    /// Shows its value alone, to be typed or dragged; its label is for screen readers.
    pub fn show_bare(self, value: &mut f64, ui: &mut Ui, dump: &mut Dump) -> Told {
        let before = *value;
        let fault = RefCell::new(None);
        let response = self.drag_value(value, &fault, ui).accessible_name(self.label).explained(self.hover);
        dump.note(self.name, before as f32, response);
        Told { changed: *value != before, reset: false, fault: fault.into_inner() }
    }

    /// Name and value in one row, or in two where they do not fit beside each other.
    fn head(&self, value: &mut f64, fault: &RefCell<Option<String>>, ui: &mut Ui, dump: &mut Dump) -> Response {
        let text = format!("{}{}{}", self.scale.text(*value), self.unit, self.aside);
        let fits = width(self.label, ui) + width(&text, ui) + 24.0 <= ui.available_width();
        let dim = palette(ui).dim;
        let name = |ui: &mut Ui| ui.add(Label::new(RichText::new(self.label).color(dim)));
        let right = Layout::right_to_left(Align::Center);
        let size = vec2(ui.available_width(), ui.spacing().interact_size.y - 4.0);
        let label = if fits {
            let row = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
                ui.set_min_size(size);
                let label = name(ui);
                ui.with_layout(right, |ui| self.typed(value, fault, &label, ui, dump));
                label
            });
            row.inner
        } else {
            let label = name(ui);
            ui.allocate_ui_with_layout(size, right, |ui| self.typed(value, fault, &label, ui, dump));
            label
        };
        dump.note(&format!("text {}", self.name), self.label, label).explained(self.hover)
    }

    fn typed(&self, value: &mut f64, fault: &RefCell<Option<String>>, label: &Response, ui: &mut Ui, dump: &mut Dump) {
        // quiet until the mouse is there
        let quiet = &mut ui.visuals_mut().widgets.inactive;
        (quiet.weak_bg_fill, quiet.bg_stroke.color) = (Color32::TRANSPARENT, Color32::TRANSPARENT);
        ui.spacing_mut().button_padding = vec2(2.0, 0.0);
        ui.spacing_mut().interact_size = vec2(0.0, ui.available_height());
        let before = *value;
        let response = self.drag_value(value, fault, ui).labelled_by(label.id).explained(self.hover);
        let name = if self.scale == Scale::Typed { self.name.to_owned() } else { format!("{} value", self.name) };
        dump.note(&name, self.scale.text(before), response);
    }

    fn drag_value(&self, value: &mut f64, fault: &RefCell<Option<String>>, ui: &mut Ui) -> Response {
        // egui takes what stands in a field one frame after Esc has left it
        let given_up = has_given_up(ui);
        let parse = |text: &str| match self.read(text) {
            _ if given_up => None,
            Ok(value) => Some(value),
            Err(why) => {
                *fault.borrow_mut() = Some(why);
                None
            }
        };
        let (speed, suffix) = (self.scale.speed(*value), self.suffix(*value, ui));
        let drag = DragValue::new(value).speed(speed).range(self.bounds.clone()).clamp_existing_to_range(false);
        let drag = drag.update_while_editing(false).custom_parser(parse);
        let response = ui.add(drag.custom_formatter(|value, _| self.scale.text(value)).suffix(suffix));
        if self.scale.is_whole() {
            *value = value.round();
        }
        response
    }

    /// Its unit and what it means, as far as there is room.
    fn suffix(&self, value: f64, ui: &Ui) -> String {
        let whole = format!("{}{}", self.unit, self.aside);
        let fits = width(&format!("{}{whole}", self.scale.text(value)), ui) + 8.0 <= ui.available_width();
        if fits { whole } else { self.unit.to_owned() }
    }

    /// What a typed text says.
    fn read(&self, text: &str) -> Result<f64, String> {
        // what a value means stands in brackets after it, and may be that of another one
        let text = text.split(" (").next().unwrap_or_default().trim();
        let text = text.trim_end_matches(self.unit.trim()).trim();
        let stays = format!("{} stays", self.label);
        let value = self.scale.parse(text).map_err(|why| format!("{why}; {stays}"))?;
        if !self.bounds.contains(&value) {
            let [least, most] = [self.bounds.start(), self.bounds.end()].map(|bound| (*bound as f32).to_string());
            return Err(format!("{text} is outside {least} to {most}; {stays}"));
        }
        if self.scale.is_whole() && value.fract() != 0.0 {
            return Err(format!("{text} is no whole number; {stays}"));
        }
        Ok(value)
    }

    /// Returns whether what is usual shall come back.
    fn slider(&self, value: &mut f64, label: &Response, ui: &mut Ui, dump: &mut Dump) -> bool {
        let before = *value;
        let mut place = self.scale.place_of(before);
        ui.spacing_mut().slider_width = ui.available_width();
        ui.spacing_mut().interact_size.y = (0.64 * ui.spacing().interact_size.y).round();
        let slider = Slider::new(&mut place, self.scale.range()).show_value(false).clamping(SliderClamping::Edits);
        let response = ui.add(slider.step_by(self.scale.step())).labelled_by(label.id).explained(self.hover);
        if response.changed() {
            *value = self.scale.value_at(place);
        }
        // egui's sliders hear drags alone
        let twice = ui.input(|i| i.pointer.button_double_clicked(PointerButton::Primary));
        let reset = self.resets && twice && response.contains_pointer();
        let (start, end) = self.scale.range().into_inner();
        paint_handle(ui, response.rect, (self.scale.place_of(*value) - start) / (end - start));
        let shown = if before.is_infinite() { "inf".to_owned() } else { (before as f32).to_string() };
        dump.note(self.name, shown, response);
        reset
    }
}

fn width(text: &str, ui: &Ui) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::WHITE).size().x
}

/// Whether Esc was pressed in this frame or in one of the two before.
fn has_given_up(ui: &Ui) -> bool {
    let (id, now) = (Id::unique("frame of the last Esc"), ui.ctx().cumulative_frame_nr());
    if ui.input(|i| i.key_pressed(Key::Escape)) {
        ui.ctx().data_mut(|data| data.insert_temp(id, now));
    }
    let last: Option<u64> = ui.ctx().data(|data| data.get_temp(id));
    last.is_some_and(|last| now.saturating_sub(last) <= 2)
}

/// A solid handle over egui's, whose inside has the colour of the rail.
fn paint_handle(ui: &Ui, slider: Rect, share: f64) {
    // as egui has it for a slider of this height
    let radius = slider.height() / 2.5;
    let reach = slider.x_range().shrink(radius);
    let at = reach.min + (share.clamp(0.0, 1.0) as f32) * (reach.max - reach.min);
    ui.painter().circle_filled(pos2(at, slider.center().y), radius, palette(ui).handle);
}

/// A number as people write it: with a decimal point or a decimal comma.
///
/// # Errors
/// If it is none.
pub fn parse_number(text: &str) -> Result<f64, String> {
    let text = text.trim().replace('−', "-");
    let pointed = if text.contains('.') { text.clone() } else { text.replacen(',', ".", 1) };
    match pointed.parse() {
        Ok(value) if f64::is_finite(value) => Ok(value),
        _ => Err(format!("\"{text}\" is no number")),
    }
}

/// A positive number in as many digits as tell it from the next place of a slider: 0.273, 10.6, 1230.
fn in_three_digits(value: f64) -> f64 {
    let power = value.log10().floor();
    if !power.is_finite() {
        return value;
    }
    // divided by a power of ten that is whole, so that the nearest double comes out
    let (shift, digits) = (10f64.powf((2.0 - power).abs()), 2.0 - power);
    if digits >= 0.0 { (value * shift).round() / shift } else { (value / shift).round() * shift }
}

/// A number with as many decimals as its step has, and up to three where it stands between two steps.
fn digits(value: f64, step: f64) -> String {
    let least = [1.0, 0.1, 0.01, 0.001].iter().filter(|&&power| step < power).count();
    let most = least.max(3);
    let shift = 10f64.powi(most as i32);
    let on_a_step = |decimals: &usize| format!("{value:.decimals$}").parse() == Ok((value * shift).round() / shift);
    let decimals = (least..most).find(on_a_step).unwrap_or(most);
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(scale: Scale, bounds: RangeInclusive<f64>) -> NumberRow<'static> {
        let (name, label, hover, unit) = ("ratio", "Ratio", "", "°");
        NumberRow { name, label, hover, scale, bounds, unit, aside: String::new(), resets: false, tint: Color32::WHITE }
    }

    #[test]
    fn numbers_show_the_decimals_of_their_step_and_more_only_between_steps() {
        assert_eq!([digits(0.7, 0.01), digits(2.5, 0.1), digits(12.34, 0.1)], ["0.70", "2.5", "12.34"]);
        assert_eq!([digits(f64::from(0.7f32), 0.01), digits(1.0 / 3.0, 0.01)], ["0.70", "0.333"]);
    }

    #[test]
    fn a_decimal_comma_is_a_decimal_point() {
        assert_eq!(
            ["0,7", " .7 ", "1e-3", "-2,5", "−1"].map(parse_number),
            [Ok(0.7), Ok(0.7), Ok(1e-3), Ok(-2.5), Ok(-1.0)]
        );
        for wrong in ["1,234,567", "1.234,5", "", "nan", "inf", "seven"] {
            assert!(parse_number(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn what_is_out_of_range_is_told_and_what_has_its_unit_is_taken() {
        let ratio = row(Scale::Steps { range: 0.4..=2.5, step: 0.01 }, 0.001..=1000.0);
        assert_eq!([ratio.read("0,3"), ratio.read("0.3 °")], [Ok(0.3), Ok(0.3)]);
        assert_eq!(ratio.read("0"), Err("0 is outside 0.001 to 1000; Ratio stays".into()));
        assert_eq!(ratio.read("a"), Err("\"a\" is no number; Ratio stays".into()));
        let count = row(Scale::Doubling(0..=16), 1.0..=4e9);
        assert_eq!(count.read("2.5"), Err("2.5 is no whole number; Ratio stays".into()));
        assert_eq!(count.read("1,000"), Err("\"1,000\" is no whole number; Ratio stays".into()));
    }

    /// A radius of .27, which is usual in `whitted`, has room on both sides.
    #[test]
    fn equal_ways_on_a_logarithmic_slider_are_equal_ratios() {
        let radius = Scale::Logarithmic(0.01..=20.0);
        let (start, end) = radius.range().into_inner();
        let share = (radius.place_of(0.273) - start) / (end - start);
        assert!((0.4..0.5).contains(&share), "{share}");
        assert_eq!(
            [0.01, 0.1, 0.2732, 10.643, 20.0].map(|v| radius.value_at(radius.place_of(v))),
            [0.01, 0.1, 0.273, 10.6, 20.0]
        );
        assert_eq!([0.012_345, 0.273_2, 10.643, 1234.5].map(|v| radius.text(v)), ["0.0123", "0.273", "10.6", "1230"]);
        assert_eq!(radius.place_of(1e-6), start, "what was typed below the slider is at its end");
        assert_eq!(radius.parse("0,25"), Ok(0.25));
    }

    #[test]
    fn a_slider_ends_at_no_limit_where_there_may_be_none() {
        let bounces = Scale::WholeOrNone(0..=20);
        assert_eq!([bounces.place_of(f64::INFINITY), bounces.place_of(50.0), bounces.place_of(3.0)], [21.0, 21.0, 3.0]);
        assert_eq!([bounces.value_at(21.0), bounces.value_at(20.0)], [f64::INFINITY, 20.0]);
        assert_eq!(
            ["no limit", "inf", "7"].map(|text| bounces.parse(text)),
            [Ok(f64::INFINITY), Ok(f64::INFINITY), Ok(7.0)]
        );
        let spp = Scale::Doubling(0..=16);
        assert_eq!([spp.place_of(100.0), spp.value_at(6.0)], [6.0, 64.0]);
    }
}
