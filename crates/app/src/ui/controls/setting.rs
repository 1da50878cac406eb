//! The control of a row of the table of settings: one widget for each kind.

use crate::model::{PaneId, SwitchedOff};
use crate::ui::Dump;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, NumberRow, Scale, choice};
use egui::{Checkbox, RichText, Ui};
use pathtrace::Roulette;
use scene::Scene;
use std::ops::RangeInclusive;
use technique::TechniqueName;
use technique::settings::{Kind, Look, Setting, Value};

/// Where controls stand, and what they look up.
pub struct Place<'a> {
    /// The pane that they set and its technique; `None` for what is changed in the scene.
    pub pane: Option<(PaneId, TechniqueName)>,
    /// Has the numbers that a setting leaves alone.
    pub scene: &'a Scene,
    /// What a setting comes back to when it is switched on again.
    pub kept: &'a mut SwitchedOff,
    /// Where the widgets are noted.
    pub dump: &'a mut Dump,
    /// Why what was typed does not count: a line for the user.
    pub fault: Option<String>,
}

/// What a user has done to a setting.
pub enum Change {
    /// Given it a value.
    Set(Value),
    /// Asked for what is usual: the scene's own, or that of a new pane.
    Reset,
}

/// A number of a setting, as its row shows it.
struct Shown<'a> {
    name: &'a str,
    told: Value,
    value: f64,
    scale: Scale,
    bounds: RangeInclusive<f64>,
}

impl Place<'_> {
    /// Shows the control of a row: what is set, or the scene's own. Returns what the user has done to it, if anything.
    pub fn show<T>(&mut self, setting: &Setting<T>, of: &T, ui: &mut Ui) -> Option<Change> {
        let value = (setting.get)(of).or_else(|| (setting.own)(self.scene))?;
        let control = &setting.control;
        let short = control.dump_name.map_or_else(|| setting.name.replace('-', " "), str::to_owned);
        let name = self.dump_name(&short);
        match (value, &control.look) {
            (Value::Word(_), Look::Words(_)) => self.words(setting, (&name, value), ui).map(Change::Set),
            (Value::Roulette(roulette), Look::Steps { range, step }) => {
                self.roulette(&name, roulette, (range.clone(), *step), ui).map(Change::Set)
            }
            (Value::LightPaths(paths), Look::LightPaths) => {
                let said = (name.as_str(), control.label, &*self.explanation(setting));
                self.light_paths(said, paths, ui).map(Change::Set)
            }
            (Value::Repairs(repairs), Look::Repairs) => {
                let label = control.label_of(value);
                let said = (name.as_str(), label.as_str(), &*self.explanation(setting));
                self.repairs(said, repairs, ui).map(Change::Set)
            }
            (Value::Bugs(bugs), Look::Bugs) => {
                let label = control.label_of(value);
                let said = (name.as_str(), label.as_str(), &*self.explanation(setting));
                self.bugs(said, bugs, ui).map(Change::Set)
            }
            (value, look) => {
                let shown = Shown {
                    name: &name,
                    told: value,
                    value: number_of(value)?,
                    scale: scale_of(look)?,
                    bounds: bounds_of(&setting.kind),
                };
                self.number(setting, shown, ui)
            }
        }
    }

    /// "A shadow map", or "sun radius" for the scene.
    fn dump_name(&self, name: &str) -> String {
        self.pane.map_or_else(|| name.to_owned(), |(pane, _)| format!("{pane} {name}"))
    }

    fn explanation<T>(&self, setting: &Setting<T>) -> String {
        setting.explanation(self.pane.map(|(_, technique)| technique))
    }

    fn label(&mut self, text: &str, hover: &str, ui: &mut Ui) {
        if !text.is_empty() {
            let dim = palette(ui).dim;
            ui.label(RichText::new(text).color(dim)).explained(hover);
        }
    }

    fn number<T>(&mut self, setting: &Setting<T>, shown: Shown, ui: &mut Ui) -> Option<Change> {
        let Shown { name, told, value, scale, bounds } = shown;
        let row = NumberRow {
            name,
            label: setting.control.label,
            hover: &self.explanation(setting),
            scale,
            bounds,
            unit: if matches!(setting.kind, Kind::DegreesBelow(_)) { "°" } else { "" },
            aside: (setting.control.aside)(told),
            resets: true,
            tint: palette(ui).slider(self.pane.map(|(pane, _)| pane)),
        };
        let mut number = value;
        let done = row.show(&mut number, ui, self.dump);
        self.fault = done.fault.or(self.fault.take());
        match (done.reset, done.changed) {
            (true, _) => Some(Change::Reset),
            (false, true) => value_like(told, number).map(Change::Set),
            (false, false) => None,
        }
    }

    fn words<T>(&mut self, setting: &Setting<T>, (name, value): (&str, Value), ui: &mut Ui) -> Option<Value> {
        self.label(setting.control.label, &self.explanation(setting), ui);
        let mut words = setting.words(self.pane.map(|(_, technique)| technique), self.scene);
        if let Value::Word(word) = value
            && words.iter().all(|(_, offered, _)| *offered != value)
        {
            words.push((word, value, BY_OPTION));
        }
        let shown = words.iter().map(|(word, of_word, hover)| (word.to_string(), *hover, *of_word == value));
        let chosen = choice((name, setting.control.label), shown, ui, self.dump).map(|index| words[index].1);
        let below = (setting.control.below)(value);
        if !below.is_empty() {
            let line = ui.label(below);
            self.dump.note(&format!("text {name}"), below, line);
        }
        chosen
    }

    /// Its two rules to be switched on, each or both, and the slider of the probability.
    fn roulette(
        &mut self,
        name: &str,
        before: Roulette,
        (range, step): (RangeInclusive<f32>, f64),
        ui: &mut Ui,
    ) -> Option<Value> {
        let mut roulette = before;
        let mut by_p = before.probability.is_some();
        if self.check(&format!("{name} P"), "Roulette: survive with P", SURVIVE, &mut by_p, ui) {
            roulette.probability = by_p.then_some(self.kept.probability);
        }
        if let Some(p) = &mut roulette.probability {
            self.probability(name, p, (range, step), ui);
            self.kept.probability = *p;
        }
        self.check(&format!("{name} throughput"), "Roulette by throughput", DARK, &mut roulette.throughput, ui);
        (roulette != before).then_some(Value::Roulette(roulette))
    }

    fn probability(&mut self, name: &str, p: &mut f32, (range, step): (RangeInclusive<f32>, f64), ui: &mut Ui) {
        let mut number = f64::from(*p);
        let row = NumberRow {
            name: &format!("{name} probability"),
            label: "Probability P to survive a vertex",
            hover: "What survives is divided by P, so that the mean stays",
            scale: Scale::Steps { range: f64::from(*range.start())..=f64::from(*range.end()), step },
            bounds: 1e-6..=1.0,
            unit: "",
            aside: String::new(),
            resets: true,
            tint: palette(ui).slider(self.pane.map(|(pane, _)| pane)),
        };
        let told = row.show(&mut number, ui, self.dump);
        self.fault = told.fault.or(self.fault.take());
        *p = if told.reset { SwitchedOff::default().probability } else { number as f32 };
    }

    fn check(&mut self, name: &str, text: &str, hover: &str, on: &mut bool, ui: &mut Ui) -> bool {
        let check = ui.add(Checkbox::new(on, text)).explained(hover);
        self.dump.note(name, *on, check).changed()
    }
}

/// Of a word that the window does not offer.
const BY_OPTION: &str = "Chosen by an option or a preset; another word leaves it, and undo brings it back";
const SURVIVE: &str = "Each vertex is survived with probability P and what survives is divided by P: unbiased, and noisier the smaller P. \
    With neither rule paths end by the number of bounces alone";
const DARK: &str = "Paths that carry little light end sooner than bright ones: unbiased, and less noise for the time";

/// A setting's number, with no limit as infinity.
fn number_of(value: Value) -> Option<f64> {
    match value {
        Value::Number(number) => Some(f64::from(number)),
        Value::Whole(number) => Some(f64::from(number)),
        Value::Bounces(bounces) => Some(bounces.map_or(f64::INFINITY, f64::from)),
        Value::Word(_) | Value::Roulette(_) | Value::LightPaths(_) | Value::Repairs(_) | Value::Bugs(_) => None,
    }
}

/// The same way back, to a value of the kind of another.
fn value_like(value: Value, number: f64) -> Option<Value> {
    match value {
        Value::Number(_) => Some(Value::Number(number as f32)),
        Value::Whole(_) => Some(Value::Whole(number as u32)),
        Value::Bounces(_) => Some(Value::Bounces(number.is_finite().then_some(number as u32))),
        Value::Word(_) | Value::Roulette(_) | Value::LightPaths(_) | Value::Repairs(_) | Value::Bugs(_) => None,
    }
}

fn scale_of(look: &Look) -> Option<Scale> {
    match look {
        Look::Steps { range, step } => {
            Some(Scale::Steps { range: f64::from(*range.start())..=f64::from(*range.end()), step: *step })
        }
        Look::Logarithmic(range) => Some(Scale::Logarithmic(f64::from(*range.start())..=f64::from(*range.end()))),
        Look::Whole(range) => Some(Scale::Whole(range.clone())),
        Look::WholeOrNone(range) => Some(Scale::WholeOrNone(range.clone())),
        Look::Doubling(exponents) => Some(Scale::Doubling(exponents.clone())),
        Look::Typed => Some(Scale::Typed),
        Look::Words(_) | Look::LightPaths | Look::Repairs | Look::Bugs => None,
    }
}

/// What may be typed: what the option takes.
fn bounds_of(kind: &Kind) -> RangeInclusive<f64> {
    match kind {
        Kind::Number(range) => f64::from(*range.start())..=f64::from(*range.end()),
        Kind::DegreesBelow(most) => 0.0..=f64::from(most.next_down()),
        Kind::Whole(range) => f64::from(*range.start())..=f64::from(*range.end()),
        Kind::Bounces => 0.0..=f64::INFINITY,
        Kind::Choice(_) | Kind::Roulette | Kind::LightPaths | Kind::Repairs | Kind::Bugs => 0.0..=1.0,
    }
}
