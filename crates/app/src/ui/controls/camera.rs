//! The camera in numbers, how many pixels its picture has, and places to come back to.

use crate::ui::widgets::number;
use crate::ui::{Dump, Resolution, Viewer};
use egui::{DragValue, Ui};
use scene::{Camera, Vec3};

pub fn show(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    let mut camera = viewer.camera;
    let speed = 0.005 * f64::from((camera.target - camera.eye).length());
    point("Eye", &mut camera.eye, speed, ui, dump);
    point("Target", &mut camera.target, speed, ui, dump);
    ui.horizontal(|ui| {
        ui.label("Field of view");
        let value = DragValue::new(&mut camera.fov_y).range(Camera::FIELD_OF_VIEW).speed(0.2).suffix("°");
        let text = viewer.camera.fov_y.to_string();
        number("field of view", "Vertical field of view in degrees", value, text, ui, dump);
    });
    // a step that would leave the camera seeing nothing is not taken
    if camera.fault().is_none() {
        viewer.camera = camera;
    }
    resolutions(viewer, ui, dump);
    bookmarks(viewer, ui, dump);
}

fn resolutions(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Resolution");
        for resolution in Resolution::ALL {
            let chosen = viewer.settings.resolution == resolution;
            let button = ui.selectable_label(chosen, resolution.name()).on_hover_text(match resolution {
                Resolution::Full => "Every pixel; while something changes pictures begin coarser where they must",
                Resolution::Half => "A pixel for two by two: done in a quarter of the time, exported as small",
                Resolution::Quarter => "A pixel for four by four: done in a sixteenth of the time, exported as small",
            });
            if dump.note(&format!("resolution {}", resolution.name()), chosen, button).clicked() {
                viewer.settings.resolution = resolution;
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

fn bookmarks(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    ui.horizontal_wrapped(|ui| {
        let reset = ui.button("Reset").on_hover_text("Back to the scene's own camera (C)");
        if dump.note("reset camera", "", reset).clicked() {
            viewer.camera = viewer.scene.camera;
        }
        let add = ui.button("Bookmark").on_hover_text("Keep this place to come back to");
        if dump.note("add bookmark", viewer.bookmarks.len(), add).clicked() {
            viewer.bookmarks.push(viewer.camera);
        }
    });
    let mut dropped = None;
    ui.horizontal_wrapped(|ui| {
        for (index, place) in viewer.bookmarks.iter().enumerate() {
            let here = viewer.camera == *place;
            let name = format!("Place {}", index + 1);
            let button =
                ui.selectable_label(here, &name).on_hover_text("Click: go there. Right click or Delete: forget it");
            let button = dump.note(&format!("bookmark {}", index + 1), here, button);
            if button.clicked() {
                viewer.camera = *place;
            }
            let deleted = button.has_focus() && ui.input(|i| i.key_pressed(egui::Key::Delete));
            if button.secondary_clicked() || deleted {
                dropped = Some(index);
            }
        }
    });
    if let Some(index) = dropped {
        viewer.bookmarks.remove(index);
    }
}
