//! The menu of the tutorial's slides: one choice opens the scene and sets both panes.

use super::widgets::{Explained, menu, rows_of_menu};
use super::{UiCommand, UiContext};
use crate::model::SLIDES;
use egui::Ui;

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let (response, _) = menu("Slides").ui(ui, |ui| {
        rows_of_menu(ui, |ui| rows(cx, ui));
    });
    cx.dump.note("slides", "", response.explained("The tutorial, slide by slide: a scene and what A and B show"));
}

fn rows(cx: &mut UiContext, ui: &mut Ui) {
    let open = cx.model.session.sweep.open;
    let title = if open { "Back to the comparison (S)" } else { "Many pictures at once (S)" };
    let item =
        ui.button(title).explained("Sweeps: a strip of one setting or a matrix of two, each picture with its error");
    if cx.dump.note("slides sweep", open, item).clicked() {
        cx.model.session.trees.open = false;
        cx.model.session.sweep.open = !open;
        ui.close();
    }
    let open = cx.model.session.trees.open;
    let title = if open { "Back from the trees (X)" } else { "What a tree saves (X)" };
    let item =
        ui.button(title).explained("33 million triangles: what a ray is tested against without a tree and with one");
    if cx.dump.note("slides trees", open, item).clicked() {
        cx.model.show_trees(!open);
        ui.close();
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
