//! Hard cases: a list of what must be so, each with a scene that shows it, measured on the machine that is chosen, in numbers
//! beside what was expected.

mod list;
mod picture;
mod table;

use super::Workspace;
use crate::model::{COMPARE, Model, PaneId, PaneSource, Wanted, WantedPane};
use crate::ui::UiContext;
use crate::ui::pressed::{HelpLine, Keys};
use crate::ui::theme::palette;
use crate::ui::widgets::Icon;
use check::{CASES, CaseView};
use egui::{Frame, Key, Margin, Ui};
use film::DisplayTransform;
use scene::Scene;
use std::sync::Arc;
use technique::{SceneChanges, Shot};

/// The workspace of hard cases.
#[derive(Default)]
pub struct Cases {
    /// What is looked at, read once.
    looked_at: Option<LookedAt>,
}

/// A case's scene, ready to be rendered.
struct LookedAt {
    number: u32,
    scene: Arc<Scene>,
    view: CaseView,
}

impl Workspace for Cases {
    fn id(&self) -> &'static str {
        "cases"
    }

    fn name(&self) -> &'static str {
        "Cases"
    }

    fn icon(&self) -> Icon {
        Icon::Cases
    }

    fn about(&self) -> &'static str {
        "Cases whose right answers are known, measured here and looked at; again: back to the comparison"
    }

    fn keys(&mut self, cx: &mut UiContext, keys: &Keys) {
        let cases = &mut cx.model.state.cases;
        cases.step(keys.presses(Key::CloseBracket) as i64 - keys.presses(Key::OpenBracket) as i64);
        if keys.presses(Key::M) > 0 {
            cases.measure([cases.looked_at]);
        }
        if keys.presses(Key::A) > 0 {
            cases.measure(CASES.iter().map(|case| case.number));
        }
        if keys.presses(Key::O) > 0 {
            list::open(cx);
        }
    }

    fn escape(&mut self, cx: &mut UiContext) {
        if list::is_running(cx) {
            cx.model.state.cases.measure([]);
        } else {
            cx.model.session.workspace = COMPARE;
        }
    }

    fn ui(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        self.look(cx);
        list::show(cx, ui);
        let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::symmetric(10, 6));
        let (seen, room) = (ui.available_rect_before_wrap(), ui.available_height());
        // what is saved as it is seen: the picture and its rows
        cx.model.state.picture.corners = [seen.left(), seen.top(), seen.right(), seen.bottom()];
        let below = egui::Panel::bottom("rows of a case").resizable(true).default_size(0.4 * room).frame(frame);
        below.size_range(0.34 * room..=0.7 * room).show(ui, |ui| table::show(cx, ui));
        egui::CentralPanel::default().show(ui, |ui| picture::show(cx, self.looked_at.as_ref(), ui));
    }

    fn wanted(&self, model: &Model) -> Wanted {
        let (cases, mut wanted) = (&model.state.cases, model.wanted([]));
        wanted.cases.clone_from(&cases.run);
        let area = &cases.area;
        if let Some(LookedAt { scene, view, .. }) =
            self.looked_at.as_ref().filter(|_| area.size.0 > 0 && area.size.1 > 0)
        {
            let shot = Shot {
                source: view.source.into(),
                changes: SceneChanges::default(),
                scene: scene.clone(),
                camera: area.camera(&scene.camera),
                own_up: scene.camera.up,
                size: area.size,
            };
            let (own_camera, technique) = (scene.camera, cases.machine.tracing(view.technique));
            let (source, shrink) = (PaneSource::Made, area.shrink);
            wanted.panes.insert(PaneId::CASE, WantedPane { shot, own_camera, technique, source, shrink });
            wanted.display = DisplayTransform { exposure: view.exposure };
        }
        wanted
    }

    fn help(&self) -> Vec<HelpLine> {
        vec![
            ("[  ]", "the case before, the next one"),
            ("M  A", "measure this case, all cases"),
            ("O", "open its scene for the comparison; Ctrl+Z leads back"),
            ("Esc", "stop measuring, or back to the comparison"),
        ]
    }
}

impl Cases {
    /// Reads the scene of the case that is looked at, where that is another than before.
    fn look(&mut self, cx: &mut UiContext) {
        let case = cx.model.state.cases.case();
        if self.looked_at.as_ref().is_some_and(|known| known.number == case.number) {
            return;
        }
        let view = case.view();
        match view.scene(case) {
            Ok(scene) => self.looked_at = Some(LookedAt { number: case.number, scene: Arc::new(scene), view }),
            Err(fault) => {
                self.looked_at = None;
                cx.model.say(Err(fault.to_string()));
            }
        }
    }
}
