//! The menu of the tutorial's slides: one choice opens the scene and sets both panes.

use super::widgets::{Explained, menu, rows_of_menu};
use super::{UiCommand, UiContext};
use crate::model::{CASES, LADDER, SLIDES, SWEEP, TREES};
use egui::Ui;

/// Workspaces that answer a question of the lecture: what leads to each and back from it, and what it shows.
const WORKSPACES: [(&str, [&str; 2], &str); 4] = [
    (
        SWEEP,
        ["Many pictures at once (S)", "Back to the comparison (S)"],
        "Sweeps: a strip of one setting or a matrix of two, each picture with its error",
    ),
    (
        LADDER,
        ["What went wrong here? (D)", "Back from the ladder (D)"],
        "From the fake to the truth, one defect at a time: the error that each leaves, and what its repair costs",
    ),
    (
        TREES,
        ["What a tree saves (X)", "Back from the trees (X)"],
        "33 million triangles: what a ray is tested against without a tree and with one",
    ),
    (
        CASES,
        ["What must be so", "Back from the hard cases"],
        "Hard cases: scenes whose right answers are known, measured here and looked at",
    ),
];

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let (response, _) = menu("Slides").ui(ui, |ui| {
        rows_of_menu(ui, |ui| rows(cx, ui));
    });
    cx.dump.note("slides", "", response.explained("The tutorial, slide by slide: a scene and what A and B show"));
}

fn rows(cx: &mut UiContext, ui: &mut Ui) {
    for (workspace, titles, about) in WORKSPACES {
        let open = cx.model.session.is_in(workspace);
        let item = ui.button(titles[usize::from(open)]).explained(about);
        if cx.dump.note(&format!("slides {workspace}"), open, item).clicked() {
            cx.model.turn_to(workspace);
            ui.close();
        }
    }
    for slide in SLIDES {
        let item = ui.button(slide.title).explained(slide.about);
        if cx.dump.note(&format!("slide {}", slide.name), "", item).clicked() {
            let scene = cx.model.show_slide(slide);
            cx.commands.extend(scene.map(|scene| UiCommand::Open(scene.into())));
            ui.close();
        }
    }
}
