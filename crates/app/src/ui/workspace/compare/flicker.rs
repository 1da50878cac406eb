//! A and B by turns at one place, where eyes see best what differs.

use crate::model::PaneId;
use crate::ui::UiContext;
use egui::Ui;
use std::time::Duration;

/// Seconds that each is shown: both come twice a second. More than three flashes a second can cause seizures (WCAG 2.3.1).
const TURN: f64 = 0.25;

/// Chooses whose turn it is.
pub fn turn(cx: &mut UiContext, ui: &Ui) {
    if cx.model.state.flicker.is_none() || cx.model.state.posing {
        return;
    }
    let turns = ui.input(|i| i.time) / TURN;
    let pane = if (turns as u64).is_multiple_of(2) { PaneId::A } else { PaneId::B };
    cx.model.state.flicker = Some(pane);
    ui.ctx().request_repaint_after(Duration::from_secs_f64((turns.ceil() - turns).max(0.02) * TURN));
}

/// Begins it, or goes back to the view that was chosen.
pub fn toggle(cx: &mut UiContext) {
    let flicker = &mut cx.model.state.flicker;
    *flicker = if flicker.is_some() { None } else { Some(PaneId::A) };
}
