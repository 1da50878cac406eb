//! How both are shown, and the course of rendering.

use crate::ui::widgets::Stepped;
use crate::ui::{Dump, Viewer};
use egui::Ui;

pub fn show(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    let slider = Stepped {
        name: "exposure",
        label: "Exposure",
        hover: "Stops added before display: each doubles the light",
        range: -5.0..=5.0,
        step: 0.1,
        suffix: " EV",
    };
    slider.show(&mut viewer.settings.display.exposure, ui, dump);
    ui.horizontal_wrapped(|ui| {
        let pause = ui.selectable_label(viewer.paused, "Pause").on_hover_text("Hold path tracing where it is (P)");
        if dump.note("pause", viewer.paused, pause).clicked() {
            viewer.paused = !viewer.paused;
        }
        let restart = ui.button("Restart").on_hover_text("Path trace again from the first sample (R)");
        if dump.note("restart", "", restart).clicked() {
            viewer.restarts += 1;
        }
    });
}
