//! What both are compared with, the reference's state, and the map of errors.

use crate::model::{CompareWith, FilePurpose, FileWish, Origin, PaneId, Progress};
use crate::ruler::brief;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, choice, framed, parse_number};
use crate::ui::{Dump, UiCommand, UiContext, controls, dialogue_button};
use compare::ErrorMetric;
use egui::{DragValue, RichText, Ui};
use pathtrace::FEWEST_REPLICATES;
use std::path::Path;
use technique::settings::capitalised;

pub fn against(cx: &mut UiContext, ui: &mut Ui) {
    let words = CompareWith::ALL.map(|a| (a.name().to_owned(), explain(a), cx.model.session.comparison.with == a));
    let label = "Against";
    let title = controls::named(RichText::new(label).color(palette(ui).dim), ui, |ui| {
        if let Some(index) = choice(("compare with", label), words, ui, cx.dump) {
            cx.model.session.comparison.with = CompareWith::ALL[index];
        }
    });
    title.explained("What A and B are held against: errors are of something against something");
}

/// How far the reference has come, and another one from a file.
pub fn reference(cx: &mut UiContext, ui: &mut Ui) {
    let state = reference_state(cx);
    cx.dump.note("text reference", &state, ui.label(capitalised(&state)));
    load(cx, ui);
}

/// How far the reference has come.
pub fn reference_state(cx: &UiContext) -> String {
    let Some(Progress { origin, pictures, noise, seconds, done, .. }) = &cx.shown.reference else {
        return "reference: ...".into();
    };
    let noise = noise.map_or_else(String::new, |noise| format!(", noise (relMSE) {}", brief(noise)));
    match origin {
        Origin::File(file) => {
            let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
            format!("reference: {name}{noise}")
        }
        Origin::Made => {
            let of = if *pictures < FEWEST_REPLICATES { format!(" of {FEWEST_REPLICATES}") } else { String::new() };
            let course = match (done, cx.model.state.paused, cx.shown.panes.values().any(|pane| pane.unfinished)) {
                (true, ..) => "",
                (false, true, _) => ", paused",
                (false, false, true) => ", waits for A and B",
                (false, false, false) => " ...",
            };
            format!("reference: {pictures}{of} pictures{noise}, {seconds:.0} s{course}")
        }
    }
}

fn load(cx: &mut UiContext, ui: &mut Ui) {
    let label = ui.label("Load a reference (.exr):");
    let typed = &mut cx.model.state.reference_file;
    let edit = egui::TextEdit::singleline(typed).hint_text("folder/reference.exr").desired_width(f32::INFINITY);
    let (width, height) = cx.model.state.picture.size;
    let line = ui.add(edit).labelled_by(label.id).explained(&format!("A picture of {width}x{height} pixels"));
    let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    cx.dump.note("reference file", &*typed, line);
    let path = image_file::typed_path(typed, Path::new(""));
    let wanted = !typed.trim().is_empty();
    ui.horizontal(|ui| {
        let button =
            cx.dump.note("load reference", "", ui.add(framed("Load", ui)).accessible_name("Load the reference"));
        if (button.clicked() || entered) && wanted {
            cx.commands.push(UiCommand::LoadReference(path.clone()));
        }
        let wish = FileWish { purpose: FilePurpose::Reference, near: path };
        dialogue_button("choose reference", "Choose a reference", wish, cx, ui);
    });
}

pub fn map(cx: &mut UiContext, ui: &mut Ui) {
    let fitted = cx.shown.map.as_ref().map(|map| map.map.scale.high);
    let comparison = &mut cx.model.session.comparison;
    if comparison.with == CompareWith::Reference {
        let panes: Vec<PaneId> = cx.model.session.panes.ids().collect();
        let words = panes.iter().map(|&pane| (format!("{pane} - reference"), whose(pane), comparison.of == pane));
        if let Some(index) = choice(("map of", ""), words, ui, cx.dump) {
            comparison.of = panes[index];
        }
    }
    let words = ErrorMetric::ALL.map(|map| (title(map), describe(map), comparison.metric == map));
    if let Some(index) = choice(("map", ""), words, ui, cx.dump) {
        comparison.metric = ErrorMetric::ALL[index];
    }
    if let Some(held) = comparison.held_mut() {
        scale(held, ui, fitted, cx.dump);
    }
    super::effects::controls(cx, ui);
}

/// Two settings can be compared under one scale: held where it is, or typed.
fn scale(held: &mut Option<f32>, ui: &mut Ui, fitted: Option<f32>, dump: &mut Dump) {
    ui.horizontal_wrapped(|ui| {
        let mut holds = held.is_some();
        let check = ui.checkbox(&mut holds, "Hold the scale").explained("Else it is fitted to every new picture");
        if dump.note("hold scale", holds, check).changed() {
            *held = holds.then(|| fitted.unwrap_or(1.0));
        }
        let mut high = held.or(fitted).unwrap_or(1.0);
        let speed = 0.01 * f64::from(high);
        let value = DragValue::new(&mut high).range(1e-9..=1e9).speed(speed).max_decimals(9).prefix("up to ");
        let value = value
            .custom_formatter(|value, _| brief(value))
            .custom_parser(|text| parse_number(text).ok())
            .update_while_editing(false);
        let typed = ui.add(value.clamp_existing_to_range(false)).explained("The value at the end of the scale");
        if dump.note("scale end", high, typed.accessible_name("End of the scale")).changed() {
            *held = Some(high);
        }
    });
}

fn explain(with: CompareWith) -> &'static str {
    match with {
        CompareWith::EachOther => "How far A is from B: neither of them need be right",
        CompareWith::Reference => "How far both are from the truth, as well as it can be known: its own noise is told",
    }
}

fn whose(pane: PaneId) -> &'static str {
    match pane {
        PaneId::A => "The errors of A against the reference (T changes to B)",
        _ => "The errors of B against the reference (T changes to A)",
    }
}

fn title(map: ErrorMetric) -> String {
    if map == ErrorMetric::Flip { "FLIP".into() } else { map.name().replace('-', " ") }
}

fn describe(map: ErrorMetric) -> &'static str {
    match map {
        ErrorMetric::Signed => "The difference with its sign: orange is too bright, blue too dark",
        ErrorMetric::Absolute => "The size of the difference, in radiance",
        ErrorMetric::Relative => "The same as a share of the right value",
        ErrorMetric::SquaredRelative => "What relMSE is the mean of",
        ErrorMetric::Flip => "What people see when they toggle between both on a screen",
    }
}
