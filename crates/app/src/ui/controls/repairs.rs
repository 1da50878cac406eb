//! The repairs of the fake: a box to tick for each, in the order in which light meets the defects; those that have nothing to
//! repair in the scene say what it lacks.

use super::setting::Place;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, choice};
use egui::{Checkbox, RichText, Ui};
use raster::repair::{Repair, Repairs, Row};
use technique::settings::Value;

/// All at once, and what stands behind each.
const AT_ONCE: [(&str, Repairs, &str); 2] = [
    ("none", Repairs::NONE, "The fair fake as it is"),
    ("all", Repairs::ALL, "Everything that can be repaired of the fake"),
];

impl Place<'_> {
    /// None or all, and then one by one. Returns what is repaired now, if that has changed.
    pub(super) fn repairs(
        &mut self,
        (name, label, hover): (&str, &str, &str),
        before: Repairs,
        ui: &mut Ui,
    ) -> Option<Value> {
        ui.label(RichText::new(label).color(palette(ui).dim)).explained(hover);
        let words = AT_ONCE.map(|(word, all, hover)| (word.to_owned(), hover, all == before));
        let mut repairs = choice((name, label), words, ui, self.dump).map_or(before, |index| AT_ONCE[index].1);
        for repair in Repair::ALL {
            self.repair(name, repair, &mut repairs, ui);
        }
        (repairs != before).then_some(Value::Repairs(repairs))
    }

    fn repair(&mut self, name: &str, repair: Repair, repairs: &mut Repairs, ui: &mut Ui) {
        let row = repair.row();
        let missing = (row.missing_in)(self.scene);
        let mut on = repairs.has(repair);
        let box_of_it = Checkbox::new(&mut on, row.title);
        let check = ui.add_enabled(missing.is_none(), box_of_it).explained(&explanation(row));
        let check = check.on_disabled_hover_text(
            missing.map_or_else(String::new, |what| format!("Nothing to repair here: the scene has no {what}")),
        );
        if self.dump.note(&format!("{name} {}", row.name), on, check).changed() {
            *repairs = if on { repairs.with(repair) } else { repairs.without(repair) };
        }
    }
}

fn explanation(row: &Row) -> String {
    format!("{} ({})", row.text, row.slide)
}
