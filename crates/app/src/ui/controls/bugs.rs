//! Break the truth: bugs of a path tracer, a box to tick for each; and a bug that is on and not told, for the student to
//! find. Folded away at first.

use super::pane::rows;
use super::setting::Place;
use crate::model::PaneId;
use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, fold};
use egui::{Checkbox, RichText, Ui};
use pathtrace::{Bug, BugRow, Bugs};
use technique::settings::{Setting, Value};
use technique::{PaneSettings, Technique};

/// Names of the rows that stand here.
const ROWS: [&str; 2] = ["bugs", "find-bug"];

/// Whether a row stands here.
pub fn is_here(row: &Setting<PaneSettings>) -> bool {
    ROWS.contains(&row.name)
}

/// Both rows; while a bug is to be found the boxes are hidden, and there is a list to guess from.
pub fn show(cx: &mut UiContext, pane: PaneId, here: &[&Setting<PaneSettings>], ui: &mut Ui) {
    if here.is_empty() {
        return;
    }
    let id = ui.make_persistent_id(("break the truth", pane));
    let title = "Break the truth";
    let (header, open) = fold(title, Some(palette(ui).dim), (id, false), ui, |ui| {
        let finding = cx.model.session.panes[pane].truth.path.find_bug > 0;
        let shown: Vec<_> = here.iter().copied().filter(|row| !finding || row.name != "bugs").collect();
        rows(cx, pane, &shown, ui);
        find(cx, pane, ui);
    });
    cx.dump.note(&format!("{pane} break the truth"), open, header);
}

/// The game: another bug, or the list to guess from.
fn find(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let path = &mut cx.model.session.panes[pane].truth.path;
    let number = path.find_bug;
    let (label, hover) = match number {
        0 => ("Find the bug", "Switches on a bug and does not tell which"),
        _ => ("Another bug", "The next number, and most likely another bug"),
    };
    let another = ui.button(label).explained(hover);
    if cx.dump.note(&format!("{pane} find the bug"), number, another).clicked() {
        (path.bugs, path.find_bug) = (Bugs::NONE, number.checked_add(1).unwrap_or(1));
    }
    if number == 0 {
        return;
    }
    let give_up = ui.button("No bug").explained("The path tracer as it is, without bugs");
    if cx.dump.note(&format!("{pane} no bug"), number, give_up).clicked() {
        path.find_bug = 0;
    }
    guess(cx, pane, number, ui);
}

/// Which bug it is: a click tells whether that is right.
fn guess(cx: &mut UiContext, pane: PaneId, number: u32, ui: &mut Ui) {
    let scene = cx.model.document.seen().clone();
    let Technique::Traced(traced) = cx.model.session.panes[pane].in_use() else { return };
    let Some(hidden) = traced.hidden_bug(&scene) else {
        ui.label("Nothing to find: no bug shows in this scene with these settings");
        return;
    };
    // a guess is of one number: another number, or a scene in which it is another bug, has none yet
    let id = ui.make_persistent_id(("guessed bug", pane));
    let mut guessed = ui.data(|data| data.get_temp::<(u32, Bug, Bug)>(id));
    guessed = guessed.filter(|(of, bug, _)| (*of, *bug) == (number, hidden));
    ui.label(RichText::new("Which one is it?").color(palette(ui).dim));
    for bug in Bugs::suited_to(&scene).iter() {
        let row = bug.row();
        let chosen = guessed.is_some_and(|(.., guess)| guess == bug);
        let button = ui.selectable_label(chosen, row.title).explained(&hint(row));
        if cx.dump.note(&format!("{pane} guess {}", row.name), chosen, button).clicked() {
            guessed = Some((number, hidden, bug));
            ui.data_mut(|data| data.insert_temp(id, (number, hidden, bug)));
        }
    }
    if let Some((.., guess)) = guessed {
        let verdict = verdict(guess, hidden);
        cx.dump.note(&format!("text {pane} guess"), &verdict, ui.label(&verdict));
    }
}

/// What a guess is told.
fn verdict(guess: Bug, hidden: Bug) -> String {
    let row = guess.row();
    if guess == hidden { format!("Right. {} ({})", row.text, row.slide) } else { format!("No. {}", row.hint) }
}

fn hint(row: &BugRow) -> String {
    format!("How it is found: {}", row.hint)
}

impl Place<'_> {
    /// A box for each bug. Returns those that are on now, if that has changed.
    pub(super) fn bugs(
        &mut self,
        (name, label, hover): (&str, &str, &str),
        before: Bugs,
        ui: &mut Ui,
    ) -> Option<Value> {
        ui.label(RichText::new(label).color(palette(ui).dim)).explained(hover);
        let mut bugs = before;
        for bug in Bug::ALL {
            self.bug(name, bug, &mut bugs, ui);
        }
        (bugs != before).then_some(Value::Bugs(bugs))
    }

    fn bug(&mut self, name: &str, bug: Bug, bugs: &mut Bugs, ui: &mut Ui) {
        let row = bug.row();
        let missing = (row.missing_in)(self.scene);
        let mut on = bugs.has(bug);
        // one that is on can be switched off whatever the scene
        let box_of_it = Checkbox::new(&mut on, row.title);
        let check = ui.add_enabled(missing.is_none() || bugs.has(bug), box_of_it).explained(&explanation(row));
        let check = check.on_disabled_hover_text(
            missing.map_or_else(String::new, |what| format!("Nothing to break here: the scene has no {what}")),
        );
        if self.dump.note(&format!("{name} {}", row.name), on, check).changed() {
            *bugs = if on { bugs.with(bug) } else { bugs.without(bug) };
        }
    }
}

fn explanation(row: &BugRow) -> String {
    format!("{} {} ({})", row.text, row.hint, row.slide)
}
