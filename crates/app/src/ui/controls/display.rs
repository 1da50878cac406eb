//! How both are shown, and the course of rendering.

use crate::ui::UiContext;
use crate::ui::widgets::Stepped;
use egui::Ui;

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let slider = Stepped {
        name: "exposure",
        label: "Exposure",
        hover: "Stops added before display: each doubles the light",
        range: -5.0..=5.0,
        step: 0.1,
        suffix: " EV",
    };
    slider.show(&mut cx.model.session.display.exposure, ui, cx.dump);
    ui.horizontal_wrapped(|ui| {
        let pause =
            ui.selectable_label(cx.model.state.paused, "Pause").on_hover_text("Hold path tracing where it is (P)");
        if cx.dump.note("pause", cx.model.state.paused, pause).clicked() {
            cx.model.state.paused = !cx.model.state.paused;
        }
        let restart = ui.button("Restart").on_hover_text("Path trace again from the first sample (R)");
        if cx.dump.note("restart", "", restart).clicked() {
            cx.model.state.restarts += 1;
        }
    });
}
