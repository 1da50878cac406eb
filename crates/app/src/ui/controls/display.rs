//! How both are shown, and the course of rendering.

use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, NumberRow, Scale};
use egui::Ui;

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let mut stops = f64::from(cx.model.session.display.exposure);
    let row = NumberRow {
        name: "exposure",
        label: "Exposure",
        hover: "Stops added before display: each doubles the light",
        scale: Scale::Steps { range: -5.0..=5.0, step: 0.1 },
        bounds: -20.0..=20.0,
        unit: " EV",
        aside: String::new(),
        resets: true,
        tint: palette(ui).slider(None),
    };
    let told = row.show(&mut stops, ui, cx.dump);
    if told.changed || told.reset {
        cx.model.session.display.exposure = if told.reset { 0.0 } else { stops as f32 };
    }
    if let Some(fault) = told.fault {
        cx.model.say(Err(fault));
    }
    ui.horizontal_wrapped(|ui| {
        let pause = ui.selectable_label(cx.model.state.paused, "Pause").explained("Hold path tracing where it is (P)");
        if cx.dump.note("pause", cx.model.state.paused, pause).clicked() {
            cx.model.state.paused = !cx.model.state.paused;
        }
        let restart = ui.button("Restart").explained("Path trace again from the first sample (R)");
        if cx.dump.note("restart", "", restart).clicked() {
            cx.model.state.restarts += 1;
        }
    });
}
