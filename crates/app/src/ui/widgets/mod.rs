//! Sliders, choices and menus with their names: a visible one, one for screen readers and one for the dump.

use super::Dump;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Button, DragValue, PopupCloseBehavior, Response, Slider, SliderClamping, Ui};
use std::ops::RangeInclusive;

/// A slider over real numbers.
pub struct Stepped<'a> {
    /// Its name in the dump.
    pub name: &'a str,
    /// What it changes, in words, above it.
    pub label: &'a str,
    /// More about it.
    pub hover: &'a str,
    /// What it may be.
    pub range: RangeInclusive<f32>,
    /// How far apart its stops are.
    pub step: f64,
    /// The unit.
    pub suffix: &'a str,
}

impl Stepped<'_> {
    /// Shows it and returns whether the user has changed `value`.
    ///
    /// It changes only when the user does it. egui's own default rounds and clamps whatever it is shown, in every
    /// frame: a scene's number between two steps would be altered by looking at it, and one that does not survive the
    /// way there and back, as 1 / (1 / ratio), would never come to rest.
    pub fn show(self, value: &mut f32, ui: &mut Ui, dump: &mut Dump) -> bool {
        let label = dump.note(&format!("text {}", self.name), self.label, ui.label(self.label));
        let slider = Slider::new(value, self.range).step_by(self.step).clamping(SliderClamping::Edits);
        let step = self.step;
        let finite = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
        let slider = slider.custom_formatter(move |value, _| digits(value, step)).custom_parser(finite);
        fit(ui);
        let response = ui.add(slider.suffix(self.suffix)).labelled_by(label.id).on_hover_text(self.hover);
        dump.note(self.name, *value, response).changed()
    }
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

/// A slider over powers of two, with the number beside it to be typed. Returns whether the user has changed `value`.
pub fn doubling(
    [name, label]: [&str; 2],
    value: &mut u32,
    exponents: RangeInclusive<u32>,
    ui: &mut Ui,
    dump: &mut Dump,
) -> bool {
    let label = dump.note(&format!("text {name}"), label, ui.label(label));
    let before = *value;
    ui.horizontal(|ui| {
        let mut exponent = value.max(&mut 1).ilog2();
        let slider = Slider::new(&mut exponent, exponents.clone()).show_value(false).clamping(SliderClamping::Edits);
        fit(ui);
        let response = ui.add(slider).labelled_by(label.id);
        if dump.note(name, before, response).changed() {
            *value = 1 << exponent;
        }
        let range = 1u32 << exponents.start()..=1 << exponents.end();
        let typed = ui.add(DragValue::new(value).range(range).clamp_existing_to_range(false)).labelled_by(label.id);
        dump.note(&format!("{name} value"), before, typed);
    });
    *value != before
}

/// A slider over whole numbers. Returns whether the user has changed `value`.
pub fn whole(
    [name, label]: [&str; 2],
    value: &mut u32,
    range: RangeInclusive<u32>,
    ui: &mut Ui,
    dump: &mut Dump,
) -> bool {
    let label = dump.note(&format!("text {name}"), label, ui.label(label));
    fit(ui);
    let response = ui.add(Slider::new(value, range).clamping(SliderClamping::Edits)).labelled_by(label.id);
    dump.note(name, *value, response).changed()
}

/// A number to drag or type.
pub fn number(name: &str, label: &str, value: DragValue, text: String, ui: &mut Ui, dump: &mut Dump) -> Response {
    dump.note(name, text, ui.add(value).accessible_name(label))
}

/// Sliders take the width that the panel leaves beside their value.
pub fn fit(ui: &mut Ui) {
    let value = 4.6 * ui.text_style_height(&egui::TextStyle::Body);
    ui.spacing_mut().slider_width = (ui.available_width() - value).clamp(40.0, 160.0);
}

/// A row of words of which one is chosen; wraps where the panel is narrow. `words` are name and explanation; `prefix`
/// begins their names in the dump. Returns the index of the one that was clicked.
pub fn choice(
    prefix: &str,
    words: impl IntoIterator<Item = (String, &'static str, bool)>,
    ui: &mut Ui,
    dump: &mut Dump,
) -> Option<usize> {
    let mut clicked = None;
    ui.horizontal_wrapped(|ui| {
        for (index, (word, hover, chosen)) in words.into_iter().enumerate() {
            let button = ui.selectable_label(chosen, &word).on_hover_text(hover);
            if dump.note(&format!("{prefix} {word}"), chosen, button).clicked() {
                clicked = Some(index);
            }
        }
    });
    clicked
}

/// A menu that stays open while one uses what is in it.
pub fn menu(title: impl Into<String>) -> MenuButton<'static> {
    let stay = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    MenuButton::new(title.into()).config(stay)
}

/// A button with a ground, which menus leave out: it does something, and what has none is a choice.
pub fn framed<'a>(text: &'a str, ui: &Ui) -> Button<'a> {
    let inside_menus_too = ui.ctx().global_style().visuals.widgets.inactive.weak_bg_fill;
    Button::new(text).fill(inside_menus_too)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_show_the_decimals_of_their_step_and_more_only_between_steps() {
        assert_eq!([digits(0.7, 0.01), digits(2.5, 0.1), digits(12.34, 0.1)], ["0.70", "2.5", "12.34"]);
        assert_eq!([digits(f64::from(0.7f32), 0.01), digits(1.0 / 3.0, 0.01)], ["0.70", "0.333"]);
    }
}
