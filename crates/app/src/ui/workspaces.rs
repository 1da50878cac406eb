//! The workspaces that there are, and the one that is open. A new one is a row of [`registry`].

use super::UiContext;
use super::theme::palette;
use super::widgets::{icon_and_word, icon_button};
use super::workspace::Workspace;
use super::workspace::cases::Cases;
use super::workspace::compare::Compare;
use super::workspace::empty::Empty;
use super::workspace::ladder::Ladder;
use super::workspace::sweep::Sweep;
use super::workspace::trees::Trees;
use crate::model::{EVERYBODYS, Model};
use egui::{Frame, Margin, Ui};

/// All that there are, in the order of bar and rail; the first one is the usual one. Those whose ids are among
/// [`EVERYBODYS`] are, and are kept in sessions.
fn registry() -> Vec<Box<dyn Workspace>> {
    vec![
        Box::<Compare>::default(),
        Box::new(Sweep),
        Box::new(Ladder),
        Box::new(Trees),
        Box::<Cases>::default(),
        Box::new(Empty),
    ]
}

/// The word that a session knows a workspace by; `None` if it is not everybody's.
fn everybodys(workspace: &dyn Workspace) -> Option<&'static str> {
    EVERYBODYS.into_iter().find(|known| *known == workspace.id())
}

/// Those that the window offers, and the one that is open.
pub struct Workspaces {
    /// Never empty.
    offered: Vec<Box<dyn Workspace>>,
    open: usize,
    /// What the session said last.
    followed: Option<&'static str>,
}

impl Default for Workspaces {
    fn default() -> Self {
        Workspaces::beginning_with(None)
    }
}

impl Workspaces {
    /// Everybody's workspaces, the one of this id open; all of them, with a rail, where it is none of those.
    pub fn beginning_with(id: Option<&str>) -> Self {
        let mut offered = registry();
        let asked = id.filter(|id| !EVERYBODYS.contains(id) && offered.iter().any(|workspace| workspace.id() == *id));
        if asked.is_none() {
            offered.retain(|workspace| everybodys(&**workspace).is_some());
        }
        let open = id.and_then(|id| offered.iter().position(|workspace| workspace.id() == id));
        Workspaces { offered, open: open.unwrap_or(0), followed: None }
    }

    /// The ids of all workspaces.
    pub fn names() -> Vec<&'static str> {
        registry().iter().map(|workspace| workspace.id()).collect()
    }

    /// Opens what the session says, once it says something else than before; at first unless another is open.
    pub fn follow(&mut self, model: &Model) {
        let said = model.session.workspace;
        let other_is_open = self.followed.is_none() && everybodys(self.open()).is_none();
        if self.followed.replace(said) != Some(said) && !other_is_open {
            let place = self.offered.iter().position(|workspace| workspace.id() == said);
            self.open = place.unwrap_or(self.open);
        }
    }

    /// The one that is open.
    pub fn open(&self) -> &dyn Workspace {
        &*self.offered[self.open]
    }

    /// The same to be drawn.
    pub fn open_mut(&mut self) -> &mut dyn Workspace {
        &mut *self.offered[self.open]
    }

    /// A button for each that is everybody's; that of the open one goes back to the usual one.
    pub fn buttons(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        for (index, workspace) in self.offered.iter().enumerate() {
            let Some(id) = everybodys(&**workspace) else { continue };
            let open = self.open == index;
            let words = (workspace.name(), workspace.about());
            let button = icon_button(workspace.icon(), words, (true, open), ui);
            if cx.dump.note(id, open, button).clicked() {
                cx.model.session.workspace = if open { EVERYBODYS[0] } else { id };
                // from one that no session knows, too
                self.followed = Some("");
                ui.ctx().request_repaint();
            }
        }
    }

    /// Icon and word of each at the left, where there are more than everybody's.
    pub fn rail(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        if self.offered.iter().all(|workspace| everybodys(&**workspace).is_some()) {
            return;
        }
        let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::same(4));
        egui::Panel::left("rail").resizable(false).frame(frame).show(ui, |ui| {
            for (index, workspace) in self.offered.iter().enumerate() {
                let (id, open) = (workspace.id(), self.open == index);
                let tab = icon_and_word(workspace.icon(), workspace.name(), open, ui);
                if cx.dump.note(&format!("workspace {id}"), open, tab).clicked() {
                    self.open = index;
                    cx.model.session.workspace = everybodys(&**workspace).unwrap_or(EVERYBODYS[0]);
                    self.followed = Some(cx.model.session.workspace);
                }
            }
        });
    }
}
