//! Three numbers of linear light as a colour: egui's picker, and the numbers themselves to be typed.

use super::control::Place;
use crate::ui::widgets::{Explained, NumberRow, Scale};
use egui::{Color32, Ui};
use scene::Vec3;
use std::ops::RangeInclusive;

/// What stands behind each number for screen readers.
const CHANNELS: [(&str, &str); 3] = [("r", "red"), ("g", "green"), ("b", "blue")];

/// Strengths of light that a slider spans.
const STRENGTHS: RangeInclusive<f64> = 0.01..=1000.0;
/// The largest number of a light.
const MOST: f64 = 1e12;

impl Place<'_> {
    /// Shares of light, each from 0 to 1.
    pub(super) fn colour(&mut self, (label, help): (&str, &str), colour: Vec3, ui: &mut Ui) -> Option<Vec3> {
        let shown = ui.horizontal_wrapped(|ui| {
            let picked = self.picker(label, colour, ui);
            let scale = Scale::Steps { range: 0.0..=1.0, step: 0.01 };
            self.triple(CHANNELS, (label, help), (scale, 0.0..=1.0, ""), colour, ui).or(picked)
        });
        shown.inner
    }

    /// Light of any strength: its colour, its numbers, and a slider of the largest of them.
    pub(super) fn light(
        &mut self,
        (label, help): (&str, &str),
        tint: Color32,
        light: Vec3,
        ui: &mut Ui,
    ) -> Option<Vec3> {
        let strength = light.max_element();
        // what is dark has no colour, and shines as soon as it is given one
        let (colour, picked_at) = if strength > 0.0 { (light / strength, strength) } else { (Vec3::ONE, 1.0) };
        let numbers = ui.horizontal_wrapped(|ui| {
            let picked = self.picker(label, colour, ui).map(|colour| colour * picked_at);
            let scale = Scale::Logarithmic(STRENGTHS);
            self.triple(CHANNELS, (label, help), (scale, 0.0..=MOST, ""), light, ui).or(picked)
        });
        let name = format!("{} strength", self.name);
        let row = NumberRow {
            name: &name,
            label: "Strength",
            hover: "The largest of the three numbers; the colour stays",
            scale: Scale::Logarithmic(STRENGTHS),
            bounds: 0.0..=MOST,
            unit: "",
            aside: String::new(),
            resets: false,
            tint,
        };
        let mut number = f64::from(strength);
        let told = row.show(&mut number, ui, self.dump);
        self.fault = told.fault.or(self.fault.take());
        numbers.inner.or_else(|| told.changed.then_some(colour * number as f32))
    }

    /// A colour is what it was unless the user picks another: there and back through hue and saturation it would change.
    fn picker(&mut self, label: &str, colour: Vec3, ui: &mut Ui) -> Option<Vec3> {
        let mut picked = colour.to_array();
        let button = ui.color_edit_button_rgb(&mut picked).explained("Pick another colour");
        let button = button.accessible_name(format!("{label}: pick"));
        let changed = self.dump.note(&format!("{} picker", self.name), colour, button).changed();
        changed.then(|| Vec3::from(picked).clamp(Vec3::ZERO, Vec3::ONE))
    }
}
