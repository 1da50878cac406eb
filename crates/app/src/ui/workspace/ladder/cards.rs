//! The controls beside the pictures: in which order defects are repaired, which of them, and what becomes of it all.

use crate::model::{Destination, ExportRequest, ExportSubject, FilePurpose, FileWish, LadderShows, Order, Progress};
use crate::ruler::{brief, counted};
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, choice, framed};
use crate::ui::{UiCommand, UiContext, controls as common, dialogue_button, export_menu};
use compare::ErrorMetric;
use egui::{RichText, Ui};
use raster::Repairs;

/// What is being done, always in sight.
pub fn heads(cx: &mut UiContext, ui: &mut Ui) {
    ui.label(RichText::new("What went wrong here?").heading());
    let shown = &cx.shown.ladder;
    let doing = match (&shown.fault, cx.model.state.paused) {
        (Some(fault), _) => fault.clone(),
        (None, true) => "paused (P)".into(),
        (None, false) => shown.doing.clone().unwrap_or_else(|| "done".into()),
    };
    let colour = if shown.fault.is_some() { palette(ui).error } else { palette(ui).dim };
    let line = ui.label(RichText::new(&doing).color(colour));
    cx.dump.note("text ladder doing", &doing, line);
}

pub fn cards(cx: &mut UiContext, ui: &mut Ui) {
    common::group(cx, ui, "Ladder", true, ladder);
    if cx.model.session.ladder.shows == LadderShows::Errors {
        common::group(cx, ui, "Map of errors", true, metric);
    }
    common::group(cx, ui, "This rung", true, rung);
    common::group(cx, ui, "All rungs", true, all);
    common::scene(cx, ui);
    common::display(cx, ui);
    common::camera(cx, ui);
}

/// Which repairs stand at once behind a word.
const AT_ONCE: [(&str, Repairs, &str); 2] = [
    ("none", Repairs::NONE, "The fake as it is, and rays"),
    ("all", Repairs::ALL, "Whatever the scene has something to repair for"),
];

fn ladder(cx: &mut UiContext, ui: &mut Ui) {
    let order = cx.model.session.ladder.order;
    let words = Order::ALL.map(|each| (word(each).to_owned(), explain(each), each == order));
    ui.label(RichText::new("Repaired next").color(palette(ui).dim));
    if let Some(index) = choice(("ladder order", "Order"), words, ui, cx.dump) {
        cx.model.session.ladder.order = Order::ALL[index];
    }
    let repairs = cx.model.session.ladder.repairs;
    ui.label(RichText::new("Climbed").color(palette(ui).dim));
    let words = AT_ONCE.map(|(word, all, hover)| (word.to_owned(), hover, all == repairs));
    if let Some(index) = choice(("ladder repairs", "Repairs"), words, ui, cx.dump) {
        cx.model.session.ladder.repairs = AT_ONCE[index].1;
    }
    let measured = cx.shown.ladder.rungs.iter().flatten().any(|facts| facts.errors.is_some());
    let state = reference_state(cx.shown.ladder.reference.as_ref(), (measured, cx.model.state.paused));
    cx.dump.note("text ladder reference", &state, ui.label(&state));
}

fn word(order: Order) -> &'static str {
    match order {
        Order::Light => "as light meets it",
        Order::BestFirst => "best first",
    }
}

fn explain(order: Order) -> &'static str {
    match order {
        Order::Light => "Defects in the order in which light meets them",
        Order::BestFirst => {
            "Of all that is left, what takes most error away for its milliseconds: every rung is tried again and again, which takes a while"
        }
    }
}

fn reference_state(progress: Option<&Progress>, (measured, paused): (bool, bool)) -> String {
    let Some(Progress { pictures, noise, seconds, done, .. }) = progress.filter(|_| measured) else {
        let pictures = progress.map_or(0, |progress| progress.pictures);
        let made =
            if pictures == 0 { String::new() } else { format!(": {} so far", counted(pictures as usize, "picture")) };
        return format!("No reference yet, errors come with it{made}");
    };
    let noise = noise.map_or_else(String::new, |noise| format!(", noise (relMSE) {}", brief(noise)));
    let course = match (done, paused) {
        (true, _) => "",
        (false, true) => ", paused",
        (false, false) => " ...",
    };
    format!("Against the reference: {}{noise}, {seconds:.0} s{course}", counted(*pictures as usize, "picture"))
}

fn metric(cx: &mut UiContext, ui: &mut Ui) {
    let metric = cx.model.session.comparison.metric;
    let words = ErrorMetric::ALL.map(|each| (each.name().to_owned(), "", each == metric));
    if let Some(index) = choice(("ladder map", "Map"), words, ui, cx.dump) {
        cx.model.session.comparison.metric = ErrorMetric::ALL[index];
    }
}

fn rung(cx: &mut UiContext, ui: &mut Ui) {
    let rung = cx.model.session.ladder.selected;
    ui.label(rung.title());
    let pane = cx.shown.ladder.facts(rung).map(|facts| facts.pane);
    let button = ui.add_enabled(pane.is_some(), framed("Open in compare", ui));
    let button =
        button.explained("It becomes A and path tracing B, as large as the window: undo brings back what they were");
    if cx.dump.note("compare rung", pane.is_some(), button).clicked()
        && let Some(pane) = pane
    {
        cx.model.compare_rung(rung, pane);
    }
}

fn all(cx: &mut UiContext, ui: &mut Ui) {
    let folder = export_menu::ladder_folder(cx.model);
    ui.horizontal_wrapped(|ui| {
        let hover = format!(
            "A picture of each rung, a table, a chart and a sheet of all, in a new folder: {}",
            image_file::shown(&folder)
        );
        let button = ui.add(framed("Save all", ui)).explained(&hover).accessible_name("Save all rungs");
        if cx.dump.note("save ladder", "", button).clicked() {
            let to = Destination::File(folder.clone());
            cx.commands.push(UiCommand::Export(ExportRequest { subject: ExportSubject::Ladder, to }));
        }
        let wish = FileWish { purpose: FilePurpose::Export(ExportSubject::Ladder), near: folder };
        dialogue_button("choose ladder", "Choose where to save all rungs", wish, cx, ui);
    });
    let command = cx.model.ladder_command();
    let button = ui.add(framed("Copy the command", ui)).explained(&command);
    let button = button.accessible_name("Copy the command that makes all rungs");
    if cx.dump.note("command ladder", &command, button).clicked() {
        ui.ctx().copy_text(command);
        cx.model.say(Ok("Copied the command that makes all rungs".into()));
    }
}
