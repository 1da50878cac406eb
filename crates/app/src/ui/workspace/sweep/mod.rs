//! The second workspace: many pictures of one scene at once, a strip of one setting or a matrix of two.

mod controls;
mod tiles;

use super::Workspace;
use crate::model::{COMPARE, Model, PaneId, SWEEPS, Wanted, WantedSweep};
use crate::ui::pressed::{HelpLine, Keys};
use crate::ui::widgets::{Icon, choice};
use crate::ui::{UiContext, controls as common};
use egui::{Key, Ui};

/// The workspace of tiles.
pub struct Sweep;

/// The keys of the presets, in their order.
const PRESET_KEYS: [Key; SWEEPS.len()] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8];

impl Workspace for Sweep {
    fn id(&self) -> &'static str {
        "sweep"
    }

    fn name(&self) -> &'static str {
        "Sweep"
    }

    fn icon(&self) -> Icon {
        Icon::Sweep
    }

    fn about(&self) -> &'static str {
        "Many pictures at once, of one setting or two, each with its error; again: back to the comparison (S)"
    }

    /// Whose settings all tiles have.
    fn bar(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        let of = cx.model.session.sweep.of;
        let words =
            PANES.map(|pane| (format!("of {pane}"), "All tiles have its settings, but for what is varied", pane == of));
        if let Some(index) = choice(("sweep", "Sweep"), words, ui, cx.dump) {
            cx.model.session.sweep.of = PANES[index];
        }
    }

    fn keys(&mut self, cx: &mut UiContext, keys: &Keys) {
        for (key, preset) in PRESET_KEYS.into_iter().zip(SWEEPS) {
            if keys.presses(key) > 0 {
                cx.model.take_sweep(preset);
            }
        }
    }

    fn escape(&mut self, cx: &mut UiContext) {
        cx.model.session.workspace = COMPARE;
    }

    fn ui(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        cx.model.follow_the_sweep();
        common::panel(cx, ui, heads, cards);
        egui::CentralPanel::default().show(ui, |ui| tiles::show(cx, ui));
    }

    fn wanted(&self, model: &Model) -> Wanted {
        let area = &model.state.sweep.area;
        let there_is_room = area.size.0 > 0 && area.size.1 > 0;
        let plan = model.state.sweep.plan.clone().filter(|_| there_is_room);
        let sweep = plan.map(|plan| WantedSweep { shot: model.document.shot(area), plan });
        Wanted { sweep, ..model.wanted([]) }
    }

    fn help(&self) -> Vec<HelpLine> {
        vec![
            ("1 ... 8", "the sweeps that are ready: bounces, samples, estimators, ..."),
            ("click a tile, Enter", "A becomes it, in the comparison"),
            ("Shift+click, Shift+Enter", "B becomes it"),
            ("Esc", "back to the comparison"),
        ]
    }
}

/// The panes that can be varied.
const PANES: [PaneId; 2] = [PaneId::A, PaneId::B];

/// What all tiles are of.
fn heads(cx: &mut UiContext, ui: &mut Ui) {
    common::head(cx, cx.model.session.sweep.of, ui);
}

/// The controls beside the tiles.
fn cards(cx: &mut UiContext, ui: &mut Ui) {
    common::group(cx, ui, "Ready sweeps", true, controls::presets);
    common::group(cx, ui, "What is varied", true, controls::varied);
    common::group(cx, ui, "Errors", true, controls::errors);
    common::scene(cx, ui);
    common::pane(cx, cx.model.session.sweep.of, !common::is_low(ui), ui);
    common::display(cx, ui);
    common::camera(cx, ui);
}
