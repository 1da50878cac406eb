//! The control of a row of the table of settings: one widget for each kind.

use crate::model::{PaneId, SwitchedOff};
use crate::ui::Dump;
use crate::ui::widgets::{Stepped, choice, doubling, fit, whole};
use egui::{DragValue, Slider, SliderClamping, Ui};
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
}

impl Place<'_> {
    /// Shows the control of a row: what is set, or the scene's own. Returns what the user has set it to, if anything.
    pub fn show<T>(&mut self, setting: &Setting<T>, of: &T, ui: &mut Ui) -> Option<Value> {
        let value = (setting.get)(of).or_else(|| (setting.own)(self.scene))?;
        let control = &setting.control;
        let short = control.dump_name.map_or_else(|| setting.name.replace('-', " "), str::to_owned);
        let name = self.dump_name(&short);
        let label = control.label_of(value);
        let hover = control.hover_among(self.pane.map(|(_, technique)| technique));
        match (value, &control.look) {
            (Value::Number(number), Look::Steps { range, step }) => {
                let suffix = if matches!(setting.kind, Kind::DegreesBelow(_)) { "°" } else { "" };
                let (range, step) = (range.clone(), *step);
                let slider = Stepped { name: &name, label: &label, hover, range, step, suffix };
                let mut number = number;
                slider.show(&mut number, ui, self.dump).then_some(Value::Number(number))
            }
            (Value::Whole(number), look) => self.whole([&name, &label, hover], number, look, ui),
            (Value::Word(_), Look::Words(_)) => {
                if !label.is_empty() {
                    ui.label(label);
                }
                let words = setting.words(self.scene);
                let shown = words.iter().map(|(word, of_word, hover)| (word.to_string(), *hover, *of_word == value));
                choice(&name, shown, ui, self.dump).map(|index| words[index].1)
            }
            (Value::Bounces(bounces), Look::Whole(range)) => {
                self.bounces([&short, &label, hover], bounces, range.clone(), ui)
            }
            (Value::Roulette(roulette), Look::Steps { range, step }) => {
                ui.label(label);
                self.roulette(&name, roulette, (range.clone(), *step), ui)
            }
            // the table's tests allow no other pair
            _ => None,
        }
    }

    /// "A shadow map", or "sun radius" for the scene.
    fn dump_name(&self, name: &str) -> String {
        self.pane.map_or_else(|| name.to_owned(), |(pane, _)| format!("{pane} {name}"))
    }

    fn whole(&mut self, [name, label, hover]: [&str; 3], before: u32, look: &Look, ui: &mut Ui) -> Option<Value> {
        let mut number = before;
        match look {
            Look::Doubling(exponents) => {
                doubling([name, label], &mut number, exponents.clone(), ui, self.dump);
            }
            Look::Whole(range) => {
                whole([name, label], &mut number, range.clone(), ui, self.dump);
            }
            Look::Typed | Look::Steps { .. } | Look::Words(_) => {
                ui.horizontal(|ui| {
                    let label = ui.label(label);
                    let typed = ui.add(DragValue::new(&mut number)).labelled_by(label.id);
                    self.dump.note(name, number, typed.on_hover_text(hover));
                });
            }
        }
        (number != before).then_some(Value::Whole(number))
    }

    /// A limit to be switched on, and the slider of it.
    fn bounces(
        &mut self,
        [name, label, hover]: [&str; 3],
        before: Option<u32>,
        range: RangeInclusive<u32>,
        ui: &mut Ui,
    ) -> Option<Value> {
        let mut limited = before.is_some();
        let check = ui.checkbox(&mut limited, label).on_hover_text(hover);
        let mut bounces = before;
        if self.dump.note(&self.dump_name(&format!("limit {name}")), limited, check).changed() {
            bounces = limited.then_some(self.kept.bounces);
        }
        if let Some(bounces) = &mut bounces {
            fit(ui);
            let slider = Slider::new(bounces, range).clamping(SliderClamping::Edits);
            let slider = ui.add(slider).accessible_name("Bounces").on_hover_text("0 is direct light only");
            self.kept.bounces = *bounces;
            self.dump.note(&self.dump_name(name), *bounces, slider);
        }
        (bounces != before).then_some(Value::Bounces(bounces))
    }

    /// Its two rules to be switched on, each or both, and the slider of the probability.
    fn roulette(
        &mut self,
        name: &str,
        before: Roulette,
        (range, step): (RangeInclusive<f32>, f64),
        ui: &mut Ui,
    ) -> Option<Value> {
        let words = [
            ("off".to_owned(), "Paths end by the number of bounces alone", before == Roulette::OFF),
            ("P".to_owned(), "Each vertex is survived with probability P", before.probability.is_some()),
            ("throughput".to_owned(), "Dark paths end sooner than bright ones", before.throughput),
        ];
        let mut roulette = before;
        match choice(name, words, ui, self.dump) {
            Some(0) => roulette = Roulette::OFF,
            Some(1) if roulette.probability.is_some() => roulette.probability = None,
            Some(1) => roulette.probability = Some(self.kept.probability),
            Some(_) => roulette.throughput = !roulette.throughput,
            None => {}
        }
        if let Some(p) = &mut roulette.probability {
            let slider = Stepped {
                name: &format!("{name} probability"),
                label: "Probability P to survive a vertex",
                hover: "What survives is divided by P, so that the mean stays",
                range,
                step,
                suffix: "",
            };
            slider.show(p, ui, self.dump);
            self.kept.probability = *p;
        }
        (roulette != before).then_some(Value::Roulette(roulette))
    }
}
