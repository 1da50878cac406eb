//! What both are compared with, the reference's state, and the map of errors.

use crate::engine::Side;
use crate::engine::reference::{Origin, Progress};
use crate::ruler::{Against, brief};
use crate::ui::widgets::{choice, framed};
use crate::ui::{Dump, UiCommand, ViewModel, Viewer};
use compare::ErrorMetric;
use egui::{DragValue, Ui};
use pathtrace::FEWEST_REPLICATES;
use std::path::Path;

pub fn against(viewer: &mut Viewer, ui: &mut Ui, model: &ViewModel, dump: &mut Dump, commands: &mut Vec<UiCommand>) {
    let words = Against::ALL.map(|a| (a.name().to_owned(), explain(a), viewer.comparison.against == a));
    if let Some(index) = choice("compare with", words, ui, dump) {
        viewer.comparison.against = Against::ALL[index];
    }
    if viewer.comparison.against == Against::Reference {
        let state = state(model, viewer.paused);
        dump.note("text reference", &state, ui.label(&state));
        load(viewer, ui, dump, commands);
    }
}

/// How far the reference has come.
pub fn state(model: &ViewModel, paused: bool) -> String {
    let Some(Progress { origin, pictures, noise, seconds, done, .. }) = &model.reference else {
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
            let course = match (done, paused, model.panes.iter().any(|pane| pane.unfinished)) {
                (true, ..) => "",
                (false, true, _) => ", paused",
                (false, false, true) => ", waits for A and B",
                (false, false, false) => " ...",
            };
            format!("reference: {pictures}{of} pictures{noise}, {seconds:.0} s{course}")
        }
    }
}

fn load(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump, commands: &mut Vec<UiCommand>) {
    let label = ui.label("Load a reference (.exr):");
    let typed = &mut viewer.comparison.file_name;
    let edit = egui::TextEdit::singleline(typed).hint_text("folder/reference.exr").desired_width(f32::INFINITY);
    let (width, height) = viewer.picture_size;
    let line = ui.add(edit).labelled_by(label.id).on_hover_text(format!("A picture of {width}x{height} pixels"));
    let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    dump.note("reference file", &*typed, line);
    let button = dump.note("load reference", "", ui.add(framed("Load", ui)).accessible_name("Load the reference"));
    if (button.clicked() || entered) && !typed.trim().is_empty() {
        commands.push(UiCommand::LoadReference(image_file::typed_path(typed, Path::new(""))));
    }
}

pub fn map(viewer: &mut Viewer, ui: &mut Ui, fitted: Option<f32>, dump: &mut Dump) {
    let comparison = &mut viewer.comparison;
    if comparison.against == Against::Reference {
        let words = Side::ALL.map(|side| (format!("{} - reference", side.name()), whose(side), comparison.of == side));
        if let Some(index) = choice("map of", words, ui, dump) {
            comparison.of = Side::ALL[index];
        }
    }
    let words = ErrorMetric::ALL.map(|map| (title(map), describe(map), comparison.map == map));
    if let Some(index) = choice("map", words, ui, dump) {
        comparison.map = ErrorMetric::ALL[index];
    }
    if let Some(held) = comparison.held_mut() {
        scale(held, ui, fitted, dump);
    }
}

/// Two settings can be compared under one scale: held where it is, or typed.
fn scale(held: &mut Option<f32>, ui: &mut Ui, fitted: Option<f32>, dump: &mut Dump) {
    ui.horizontal_wrapped(|ui| {
        let mut holds = held.is_some();
        let check = ui.checkbox(&mut holds, "Hold the scale").on_hover_text("Else it is fitted to every new picture");
        if dump.note("hold scale", holds, check).changed() {
            *held = holds.then(|| fitted.unwrap_or(1.0));
        }
        let mut high = held.or(fitted).unwrap_or(1.0);
        let speed = 0.01 * f64::from(high);
        let value = DragValue::new(&mut high).range(1e-9..=1e9).speed(speed).max_decimals(9).prefix("up to ");
        let value = value.custom_formatter(|value, _| brief(value)).custom_parser(|text| text.trim().parse().ok());
        let typed = ui.add(value.clamp_existing_to_range(false)).on_hover_text("The value at the end of the scale");
        if dump.note("scale end", high, typed.accessible_name("End of the scale")).changed() {
            *held = Some(high);
        }
    });
}

fn explain(against: Against) -> &'static str {
    match against {
        Against::EachOther => "The errors of A against B, and of B against A",
        Against::Reference => {
            "The errors of both against the truth as well as it can be known, with its own noise told"
        }
    }
}

fn whose(side: Side) -> &'static str {
    match side {
        Side::A => "The errors of A against the reference (T changes to B)",
        Side::B => "The errors of B against the reference (T changes to A)",
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
