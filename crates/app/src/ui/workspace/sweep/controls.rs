//! What is varied, by how much, and what the tiles are measured by.

use crate::model::{
    Axis, Destination, Equal, ExportRequest, ExportSubject, PaneId, Progress, SWEEPS, SweepFile, SweepMeasure, variable,
};
use crate::ruler::{brief, counted};
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, NumberRow, Scale, choice, framed, menu, rows_of_menu};
use crate::ui::{Dump, UiCommand, UiContext, export_menu};
use egui::{RichText, TextEdit, Ui};
use scene::Scene;
use technique::TechniqueName;

/// Those that are set up by one click.
pub fn presets(cx: &mut UiContext, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        for (index, preset) in SWEEPS.iter().enumerate() {
            let button = ui.add(framed(preset.title, ui));
            let button = button.explained(&format!("{} ({})", preset.about, index + 1));
            if cx.dump.note(&format!("sweep {}", preset.name), "", button).clicked() {
                cx.model.take_sweep(preset);
            }
        }
    });
}

/// Columns, rows, and what is the same of all tiles.
pub fn varied(cx: &mut UiContext, ui: &mut Ui) {
    let sweep = &mut cx.model.session.sweep;
    let technique = cx.model.session.panes.get(sweep.of).map_or(TechniqueName::Path, |pane| pane.technique);
    let of = (technique, &**cx.model.document.seen());
    axis("Columns", false, &mut sweep.columns, of, ui, cx.dump);
    axis("Rows", true, &mut sweep.rows, of, ui, cx.dump);
    let words = Equal::ALL.map(|equal| (equal.name().to_owned(), explain(equal), sweep.equal == equal));
    ui.label(RichText::new("Equal").color(palette(ui).dim));
    if let Some(index) = choice(("equal", "Equal"), words, ui, cx.dump) {
        sweep.equal = Equal::ALL[index];
    }
    if sweep.equal == Equal::Time {
        seconds(cx, ui);
    }
    if let Some(fault) = &cx.model.state.sweep.fault {
        let line = ui.label(RichText::new(fault).color(palette(ui).error));
        cx.dump.note("text sweep fault", fault, line);
    }
}

/// A setting, chosen from a menu, and its values, typed.
fn axis(
    name: &str,
    may_be_none: bool,
    axis: &mut Axis,
    (technique, scene): (TechniqueName, &Scene),
    ui: &mut Ui,
    dump: &mut Dump,
) {
    let chosen = if axis.is_empty() { "none" } else { &axis.setting };
    let (button, _) = menu(format!("{name}: {chosen}")).ui(ui, |ui| {
        rows_of_menu(ui, |ui| {
            if may_be_none && dump.note(&format!("{name} none"), "", ui.button("none")).clicked() {
                *axis = Axis::default();
                ui.close();
            }
            for setting in variable(technique) {
                if dump.note(&format!("{name} {setting}"), "", ui.button(setting)).clicked() {
                    *axis = Axis::usual(setting, technique, scene);
                    ui.close();
                }
            }
        });
    });
    dump.note(name, &axis.setting, button);
    if axis.is_empty() {
        return;
    }
    let edit = ui.add(TextEdit::singleline(&mut axis.values).hint_text("1, 4, 16").desired_width(f32::INFINITY));
    let label = format!("Values of {name}");
    let edit = edit.explained("2 to 8 values with commas between").accessible_name(&label);
    dump.note(&label, &axis.values, edit);
}

fn seconds(cx: &mut UiContext, ui: &mut Ui) {
    let mut seconds = f64::from(cx.model.session.sweep.seconds);
    let row = NumberRow {
        name: "sweep seconds",
        label: "Seconds a tile",
        hover: "Rendering alone, on every thread: what a tile really took stands below it",
        scale: Scale::Logarithmic(0.1..=60.0),
        bounds: 0.01..=3600.0,
        unit: " s",
        aside: String::new(),
        resets: true,
        tint: palette(ui).slider(None),
    };
    let told = row.show(&mut seconds, ui, cx.dump);
    if told.changed || told.reset {
        cx.model.session.sweep.seconds = if told.reset { 1.0 } else { seconds as f32 };
    }
    if let Some(fault) = told.fault {
        cx.model.say(Err(fault));
    }
}

fn explain(equal: Equal) -> &'static str {
    match equal {
        Equal::Samples => "Every tile has the samples per pixel that the pane is set to, or that are varied",
        Equal::Time => "Every tile is rendered for the same time; the fake and what is done sooner take what they take",
    }
}

/// Which error captions tell, how far the reference is, and all of it as files.
pub fn errors(cx: &mut UiContext, ui: &mut Ui) {
    let sweep = &mut cx.model.session.sweep;
    let words = SweepMeasure::ALL.map(|measure| (measure.name().to_owned(), "", sweep.measure == measure));
    if let Some(index) = choice(("sweep error", "Error"), words, ui, cx.dump) {
        sweep.measure = SweepMeasure::ALL[index];
    }
    let state = reference_state(cx.shown.sweep.reference.as_ref(), cx.model.state.paused);
    cx.dump.note("text sweep reference", &state, ui.label(&state));
    ui.horizontal(|ui| {
        for (file, hover) in [
            (SweepFile::Picture, "All tiles with their captions as one picture (Ctrl+S), which says how each was made"),
            (SweepFile::Table, "The captions as a table, with all errors"),
        ] {
            let label = format!("Save the sweep as {}", file.name());
            let button = ui.add(framed(file.name(), ui)).explained(hover).accessible_name(&label);
            if cx.dump.note(&label, "", button).clicked() {
                let to = Destination::File(export_menu::sweep_file(cx.model, file));
                cx.commands.push(UiCommand::Export(ExportRequest { subject: ExportSubject::Sweep(file), to }));
            }
        }
    });
}

fn reference_state(progress: Option<&Progress>, paused: bool) -> String {
    let Some(Progress { pictures, noise, seconds, done, .. }) = progress else {
        return "Against the reference, which is made once all tiles are".into();
    };
    let noise = noise.map_or_else(String::new, |noise| format!(", noise (relMSE) {}", brief(noise)));
    let course = if *done {
        ""
    } else if paused {
        ", paused"
    } else {
        " ..."
    };
    let pictures = counted(*pictures as usize, "picture");
    format!("Against the reference: {pictures}{noise}, {seconds:.0} s{course}")
}

/// What a pane that a tile is given to is called in explanations.
pub fn hover_of_tiles() -> String {
    format!("Click: {} becomes it; Shift: {}", PaneId::A, PaneId::B)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Origin;

    #[test]
    fn how_far_the_reference_is_is_told_in_the_right_number() {
        let of = |pictures| Progress { view: 1, origin: Origin::Made, pictures, noise: None, seconds: 2.0, done: true };
        assert_eq!(reference_state(Some(&of(1)), false), "Against the reference: 1 picture, 2 s");
        assert_eq!(reference_state(Some(&of(4)), false), "Against the reference: 4 pictures, 2 s");
    }
}
