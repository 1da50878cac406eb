//! The camera in numbers, how many pixels its picture has, and places to come back to.

use crate::model::Resolution;
use crate::ui::widgets::{Explained, number};
use crate::ui::{Dump, UiContext};
use egui::{DragValue, Ui};
use scene::{Camera, Vec3};

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let mut camera = cx.model.document.camera;
    let speed = 0.005 * f64::from((camera.target - camera.eye).length());
    point("Eye", &mut camera.eye, speed, ui, cx.dump);
    point("Target", &mut camera.target, speed, ui, cx.dump);
    ui.horizontal(|ui| {
        ui.label("Field of view");
        let value = DragValue::new(&mut camera.fov_y).range(Camera::FIELD_OF_VIEW).speed(0.2).suffix("°");
        let text = cx.model.document.camera.fov_y.to_string();
        number("field of view", "Vertical field of view in degrees", value, text, ui, cx.dump);
    });
    // a step that would leave the camera seeing nothing is not taken
    if camera.fault().is_none() {
        cx.model.document.camera = camera;
    }
    resolutions(cx, ui);
    bookmarks(cx, ui);
}

fn resolutions(cx: &mut UiContext, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Resolution");
        for resolution in Resolution::ALL {
            let chosen = cx.model.session.resolution == resolution;
            let button = ui.selectable_label(chosen, resolution.name()).explained(match resolution {
                Resolution::Full => "Every pixel; while something changes pictures begin coarser where they must",
                Resolution::Half => "A pixel for two by two: done in a quarter of the time, exported as small",
                Resolution::Quarter => "A pixel for four by four: done in a sixteenth of the time, exported as small",
            });
            if cx.dump.note(&format!("resolution {}", resolution.name()), chosen, button).clicked() {
                cx.model.session.resolution = resolution;
            }
        }
    });
}

fn point(name: &str, point: &mut Vec3, speed: f64, ui: &mut Ui, dump: &mut Dump) {
    ui.label(format!("{name} x, y, z"));
    ui.horizontal_wrapped(|ui| {
        for (axis, value) in ["x", "y", "z"].into_iter().zip(point.as_mut()) {
            let text = value.to_string();
            let drag = DragValue::new(value).speed(speed).max_decimals(3);
            number(&format!("{} {axis}", name.to_lowercase()), &format!("{name} {axis}"), drag, text, ui, dump);
        }
    });
}

fn bookmarks(cx: &mut UiContext, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let reset = ui.button("Reset").explained("Back to the scene's own camera (C)");
        if cx.dump.note("reset camera", "", reset).clicked() {
            cx.model.document.camera = cx.model.document.scene.camera;
        }
        let add = ui.button("Bookmark").explained("Keep this place to come back to");
        if cx.dump.note("add bookmark", cx.model.document.bookmarks.len(), add).clicked() {
            cx.model.document.bookmarks.push(cx.model.document.camera);
        }
    });
    let mut dropped = None;
    ui.horizontal_wrapped(|ui| {
        for (index, place) in cx.model.document.bookmarks.iter().enumerate() {
            let here = cx.model.document.camera == *place;
            let name = format!("Place {}", index + 1);
            let button =
                ui.selectable_label(here, &name).explained("Click: go there. Right click or Delete: forget it");
            let button = cx.dump.note(&format!("bookmark {}", index + 1), here, button);
            if button.clicked() {
                cx.model.document.camera = *place;
            }
            let deleted = button.has_focus() && ui.input(|i| i.key_pressed(egui::Key::Delete));
            if button.secondary_clicked() || deleted {
                dropped = Some(index);
            }
        }
    });
    if let Some(index) = dropped {
        cx.model.document.bookmarks.remove(index);
    }
}
