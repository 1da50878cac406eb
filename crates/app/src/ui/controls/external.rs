//! A pane's picture from another program: received, or from a file that is followed.

use crate::model::{FilePurpose, FileWish, PaneId, PaneSource, USUAL_PORT};
use crate::ui::widgets::{Explained, choice, framed};
use crate::ui::{UiContext, dialogue_button};
use egui::{DragValue, TextEdit, Ui};
use std::path::{Path, PathBuf};

/// Where the picture comes from, and what is to be known of that.
pub fn show(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let source = cx.model.session.source(pane).clone();
    let label = format!("Picture of {pane}");
    let words = [
        ("made here", "By the technique that is chosen above", source == PaneSource::Made),
        (
            "received",
            "From a renderer of yours on this machine that shows its pictures in tev: pbrt, Mitsuba, or your own",
            matches!(source, PaneSource::Received(_)),
        ),
        (
            "a file",
            "Of a renderer of yours, read again whenever it changes (.exr, .png)",
            matches!(source, PaneSource::Followed(_)),
        ),
    ];
    let words = words.map(|(word, hover, chosen)| (word.to_owned(), hover, chosen));
    let prefix = format!("{pane} picture");
    let clicked = choice((&prefix, &label), words, ui, cx.dump);
    match clicked {
        Some(0) => cx.model.session.set_source(pane, PaneSource::Made),
        Some(1) => cx.model.session.set_source(pane, PaneSource::Received(free_port(cx, pane))),
        _ => {}
    }
    let asked_for_a_file = cx.model.state.picture_files.get(pane).is_some();
    match cx.model.session.source(pane).clone() {
        PaneSource::Received(port) => received(cx, pane, port, ui),
        PaneSource::Followed(file) => followed(cx, pane, Some(&file), ui),
        PaneSource::Made if clicked == Some(2) || (asked_for_a_file && clicked.is_none()) => {
            followed(cx, pane, None, ui)
        }
        PaneSource::Made => {}
    }
    if clicked.is_some_and(|word| word < 2) {
        cx.model.state.picture_files.remove(pane);
    }
}

/// The usual port, or the one after that where another pane listens on it.
fn free_port(cx: &UiContext, pane: PaneId) -> u16 {
    let taken = |port: u16| {
        let mut others = cx.model.session.sources.iter().filter(|(other, _)| *other != pane);
        others.any(|(_, source)| *source == PaneSource::Received(port))
    };
    (USUAL_PORT..).find(|port| !taken(*port)).unwrap_or(USUAL_PORT)
}

fn received(cx: &mut UiContext, pane: PaneId, port: u16, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let label = ui.label("Port on 127.0.0.1");
        let mut number = port;
        let value = DragValue::new(&mut number).range(1..=u16::MAX).speed(0.2).update_while_editing(false);
        let hover = "To which the renderer sends; nobody outside of this machine is heard";
        let typed = ui.add(value).labelled_by(label.id).explained(hover);
        let typed = typed.accessible_name(format!("Port of {pane}"));
        if cx.dump.note(&format!("{pane} port"), port, typed).changed() {
            cx.model.session.set_source(pane, PaneSource::Received(number));
        }
    });
    let text = format!("pbrt --display-server localhost:{port} scene.pbrt");
    cx.dump.note(&format!("text {pane} sender"), &text, ui.label(egui::RichText::new(&text).small()));
}

/// The file, as typed or chosen.
fn followed(cx: &mut UiContext, pane: PaneId, file: Option<&Path>, ui: &mut Ui) {
    let label = ui.label("Picture of another program (.exr, .png):");
    if cx.model.state.picture_files.get(pane).is_none() {
        let there = file.map_or(String::new(), |file| file.display().to_string());
        cx.model.state.picture_files.insert(pane, there);
    }
    let typed = cx.model.state.picture_files.entry(pane);
    let edit = TextEdit::singleline(typed).hint_text("folder/mine.exr").desired_width(f32::INFINITY);
    let line = ui.add(edit).labelled_by(label.id).explained("It is read again whenever it changes");
    let line = line.accessible_name(format!("Picture file of {pane}"));
    let entered = line.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    cx.dump.note(&format!("{pane} picture file"), &*typed, line);
    let path = image_file::typed_path(typed, Path::new(""));
    let wanted = !typed.trim().is_empty();
    ui.horizontal(|ui| {
        let button = ui.add(framed("Follow", ui)).accessible_name(format!("Follow the picture file of {pane}"));
        if (cx.dump.note(&format!("{pane} follow"), "", button).clicked() || entered) && wanted {
            follow(cx, pane, path.clone());
        }
        let wish = FileWish { purpose: FilePurpose::Follow(pane), near: path };
        dialogue_button(&format!("{pane} choose picture"), &format!("Choose a picture for {pane}"), wish, cx, ui);
    });
}

fn follow(cx: &mut UiContext, pane: PaneId, file: PathBuf) {
    if let Err(fault) = cx.model.follow(pane, &file) {
        cx.model.say(Err(fault));
    }
}
