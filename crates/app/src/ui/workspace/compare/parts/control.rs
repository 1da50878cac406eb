//! The control of a property: one widget for each kind.

use crate::ui::Dump;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, Icon, NumberRow, Scale, choice, icon_button};
use egui::{Align, Checkbox, ComboBox, Layout, RichText, Ui};
use scene::Vec3;
use scene::edit::{Kind, Property, Value};
use std::ops::RangeInclusive;

/// More words than these are a menu.
const MOST_SEGMENTS: usize = 5;
/// And so are words of more letters, together.
const MOST_LETTERS: usize = 60;
/// Degrees that are a step of a turn.
const TURN_STEP: f64 = 1.0;

/// A property with what it is.
pub struct Field {
    /// Its row in the table.
    pub property: &'static Property,
    /// What it is now.
    pub value: Value,
    /// What else it could be, if it is a word.
    pub words: Vec<String>,
    /// Whether it is other than in the file.
    pub changed: bool,
}

/// What a user has done to a property.
pub enum Change {
    /// Given it a value.
    Set(Value),
    /// Asked for the scene's own.
    Reset,
}

/// Where a control stands.
pub struct Place<'a> {
    /// Its name in the dump.
    pub name: &'a str,
    /// By how much coordinates go.
    pub step: f64,
    /// Where the widgets are noted.
    pub dump: &'a mut Dump,
    /// Why what was typed does not count: a line for the user.
    pub fault: Option<String>,
}

impl Place<'_> {
    /// Shows the control of a property. Returns what the user has done to it, if anything.
    pub fn show(&mut self, field: &Field, ui: &mut Ui) -> Option<Change> {
        let said = (field.property.label, field.property.help);
        match (&field.property.kind, &field.value) {
            (Kind::Number { .. }, Value::Number(number)) => self.number(field, *number, ui),
            (Kind::Flag, Value::Flag(flag)) => self.flag(field, *flag, ui),
            (Kind::Word, Value::Word(word)) => {
                let reset = self.head(field, "", ui);
                self.word(field, word, ui).map(Value::Word).map(Change::Set).or(reset)
            }
            (kind, Value::Triple(triple)) => {
                let axes = if matches!(kind, Kind::Point | Kind::Turn) { " x, y, z" } else { "" };
                let reset = self.head(field, axes, ui);
                let tint = if field.changed { palette(ui).accent } else { palette(ui).filled };
                let changed = match kind {
                    Kind::Colour => self.colour(said, *triple, ui),
                    Kind::Light => self.light(said, tint, *triple, ui),
                    Kind::Turn => self.axes(said, (TURN_STEP, "°"), *triple, ui),
                    _ => self.axes(said, (self.step, ""), *triple, ui),
                };
                changed.map(Value::Triple).map(Change::Set).or(reset)
            }
            _ => None,
        }
    }

    /// What it is called and, where it is changed, a button that leaves it to the file again.
    fn head(&mut self, field: &Field, more: &str, ui: &mut Ui) -> Option<Change> {
        let Property { label, help, .. } = field.property;
        let row = ui.horizontal(|ui| {
            ui.label(RichText::new(format!("{label}{more}")).color(palette(ui).dim)).explained(help);
            field.changed && ui.with_layout(Layout::right_to_left(Align::Center), |ui| self.reset(label, ui)).inner
        });
        row.inner.then_some(Change::Reset)
    }

    fn reset(&mut self, label: &str, ui: &mut Ui) -> bool {
        ui.spacing_mut().interact_size.y -= 6.0;
        let name = format!("{label}: as in the file");
        let button = icon_button(Icon::Undo, (&name, "As in the file"), (true, false), ui);
        self.dump.note(&format!("{} reset", self.name), "", button).clicked()
    }

    /// The slider of a changed number has another colour; a double click on it brings back what the file has.
    fn number(&mut self, field: &Field, number: f32, ui: &mut Ui) -> Option<Change> {
        let Kind::Number { range, shown, logarithmic, unit } = &field.property.kind else { return None };
        let wide = |range: &RangeInclusive<f32>| f64::from(*range.start())..=f64::from(*range.end());
        let shown = wide(shown);
        let step = step_of(shown.end() - shown.start());
        let row = NumberRow {
            name: self.name,
            label: field.property.label,
            hover: field.property.help,
            scale: if *logarithmic { Scale::Logarithmic(shown) } else { Scale::Steps { range: shown, step } },
            bounds: wide(range),
            unit,
            aside: String::new(),
            resets: true,
            tint: if field.changed { palette(ui).accent } else { palette(ui).filled },
        };
        let mut typed = f64::from(number);
        let told = row.show(&mut typed, ui, self.dump);
        self.fault = told.fault.or(self.fault.take());
        match (told.reset, told.changed) {
            (true, _) => field.changed.then_some(Change::Reset),
            (false, true) => Some(Change::Set(Value::Number(typed as f32))),
            (false, false) => None,
        }
    }

    fn flag(&mut self, field: &Field, flag: bool, ui: &mut Ui) -> Option<Change> {
        let mut on = flag;
        let check = ui.add(Checkbox::new(&mut on, field.property.label)).explained(field.property.help);
        let clicked = self.dump.note(self.name, on, check).changed();
        clicked.then_some(if on { Change::Set(Value::Flag(true)) } else { Change::Reset })
    }

    /// Words beside each other where they are few, else a menu. Returns the one that was clicked.
    fn word(&mut self, field: &Field, chosen: &str, ui: &mut Ui) -> Option<String> {
        let (label, words) = (field.property.label, &field.words);
        let letters: usize = words.iter().map(String::len).sum();
        let index = if words.len() <= MOST_SEGMENTS && letters <= MOST_LETTERS {
            let segments = words.iter().map(|word| (in_words(word), field.property.help, word == chosen));
            choice((self.name, label), segments, ui, self.dump)
        } else {
            self.menu(label, words, chosen, ui)
        };
        index.map(|index| words[index].clone())
    }

    fn menu(&mut self, label: &str, words: &[String], chosen: &str, ui: &mut Ui) -> Option<usize> {
        let mut clicked = None;
        let combo = ComboBox::from_id_salt(self.name).selected_text(in_words(chosen)).width(ui.available_width() - 8.0);
        let response = combo.truncate().show_ui(ui, |ui| {
            for (index, word) in words.iter().enumerate() {
                let item = ui.selectable_label(word == chosen, in_words(word));
                if self.dump.note(&format!("{} {word}", self.name), word == chosen, item).clicked() {
                    clicked = Some(index);
                }
            }
        });
        let response = response.response.accessible_name(format!("{label}: {} (menu)", in_words(chosen)));
        self.dump.note(self.name, chosen, response);
        clicked
    }

    fn axes(
        &mut self,
        said: (&str, &str),
        (step, unit): (f64, &'static str),
        values: Vec3,
        ui: &mut Ui,
    ) -> Option<Vec3> {
        let names = [("x", "x"), ("y", "y"), ("z", "z")];
        let scale = Scale::Steps { range: 0.0..=1.0, step };
        ui.horizontal_wrapped(|ui| self.triple(names, said, (scale, -1e12..=1e12, unit), values, ui)).inner
    }

    /// Three numbers to be typed or dragged. Returns them if one was changed.
    pub(super) fn triple(
        &mut self,
        names: [(&str, &str); 3],
        (label, help): (&str, &str),
        (scale, bounds, unit): (Scale, RangeInclusive<f64>, &'static str),
        values: Vec3,
        ui: &mut Ui,
    ) -> Option<Vec3> {
        let mut changed = values;
        for ((short, long), value) in names.into_iter().zip(changed.as_mut()) {
            let row = NumberRow {
                name: &format!("{} {short}", self.name),
                label: &format!("{label}, {long}"),
                hover: help,
                scale: scale.clone(),
                bounds: bounds.clone(),
                unit,
                aside: String::new(),
                resets: false,
                tint: palette(ui).dim,
            };
            let mut number = f64::from(*value);
            let told = row.show_bare(&mut number, ui, self.dump);
            if told.changed {
                *value = number as f32;
            }
            self.fault = told.fault.or(self.fault.take());
        }
        (changed != values).then_some(changed)
    }
}

/// Words of files as people read them.
fn in_words(word: &str) -> String {
    word.replace('_', " ")
}

/// A power of ten that divides a range into about a hundred steps.
fn step_of(range: f64) -> f64 {
    10f64.powf((range / 90.0).log10().floor())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_such_as_people_count_in() {
        let steps = [0.99, 1.0, 2.0, 5.0, 90.0, 360.0].map(step_of);
        assert_eq!(steps, [0.01, 0.01, 0.01, 0.01, 1.0, 1.0]);
    }
}
