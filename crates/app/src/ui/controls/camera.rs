//! The camera in numbers, how many pixels its picture has, and places to come back to.

use crate::model::Resolution;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, NumberRow, Scale};
use crate::ui::{Dump, UiContext};
use egui::{ComboBox, Ui};
use scene::{Camera, Vec3};

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let before = cx.model.document.camera;
    let mut camera = before;
    let step = f64::from((0.005 * (camera.target - camera.eye).length()).max(1e-6));
    let faults = [
        point("Eye", &mut camera.eye, step, ui, cx.dump),
        point("Target", &mut camera.target, step, ui, cx.dump),
        field_of_view(cx, &mut camera, ui),
    ];
    match camera.fault() {
        None => cx.model.document.camera = camera,
        // a step that would leave it blind is not taken
        Some(fault) => cx.model.say(Err(format!("a camera there would see nothing: {fault}; it stays"))),
    }
    if let Some(fault) = faults.into_iter().flatten().next() {
        cx.model.say(Err(fault));
    }
    resolutions(cx, ui);
    of_the_file(cx, ui);
    bookmarks(cx, ui);
}

/// The cameras that the scene's file names.
fn of_the_file(cx: &mut UiContext, ui: &mut Ui) {
    let cameras = cx.model.document.scene.cameras.clone();
    if cameras.is_empty() {
        return;
    }
    let here = cameras.iter().find(|named| named.camera == cx.model.document.camera);
    let chosen = here.map_or("The file's cameras", |named| named.name.as_str());
    let combo = ComboBox::from_id_salt("cameras").selected_text(chosen).width(ui.available_width() - 8.0).truncate();
    let response = combo.show_ui(ui, |ui| {
        for named in cameras.iter() {
            let item = ui.selectable_label(cx.model.document.camera == named.camera, &named.name);
            if cx.dump.note(&format!("camera {}", named.name), "", item).clicked() {
                cx.model.document.camera = named.camera;
            }
        }
    });
    let response = response
        .response
        .explained("Looks through one of the cameras that the scene's file has")
        .accessible_name("The file's cameras");
    cx.dump.note("cameras", chosen, response);
}

fn field_of_view(cx: &mut UiContext, camera: &mut Camera, ui: &mut Ui) -> Option<String> {
    let (least, most) = Camera::FIELD_OF_VIEW.into_inner();
    let (least, most) = (f64::from(least), f64::from(most));
    let row = NumberRow {
        name: "field of view",
        label: "Field of view",
        hover: "The vertical angle of view in degrees; of an area narrower than high the horizontal one",
        scale: Scale::Steps { range: 5.0..=120.0, step: 0.1 },
        bounds: least..=most,
        unit: "°",
        aside: String::new(),
        resets: true,
        tint: palette(ui).slider(None),
    };
    let mut degrees = f64::from(camera.fov_y);
    let told = row.show(&mut degrees, ui, cx.dump);
    if told.changed || told.reset {
        camera.fov_y = if told.reset { cx.model.document.scene.camera.fov_y } else { degrees as f32 };
    }
    told.fault
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
            let button = button.accessible_name(format!("Resolution: {}", resolution.name()));
            if cx.dump.note(&format!("resolution {}", resolution.name()), chosen, button).clicked() {
                cx.model.session.resolution = resolution;
            }
        }
    });
}

fn point(name: &str, point: &mut Vec3, step: f64, ui: &mut Ui, dump: &mut Dump) -> Option<String> {
    let dim = palette(ui).dim;
    ui.label(egui::RichText::new(format!("{name} x, y, z")).color(dim));
    let mut fault = None;
    ui.horizontal_wrapped(|ui| {
        for (axis, value) in ["x", "y", "z"].into_iter().zip(point.as_mut()) {
            let row = NumberRow {
                name: &format!("{} {axis}", name.to_lowercase()),
                label: &format!("{name} {axis}"),
                hover: "",
                scale: Scale::Steps { range: 0.0..=1.0, step },
                bounds: -1e12..=1e12,
                unit: "",
                aside: String::new(),
                resets: false,
                tint: dim,
            };
            let mut number = f64::from(*value);
            let told = row.show_bare(&mut number, ui, dump);
            if told.changed {
                *value = number as f32;
            }
            fault = fault.take().or(told.fault);
        }
    });
    fault
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
