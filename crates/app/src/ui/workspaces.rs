//! The workspaces that there are, and the one that is open. A new one is a row of [`registry`].

use super::UiContext;
use super::theme::palette;
use super::widgets::icon_and_word;
use super::workspace::Workspace;
use super::workspace::cases::Cases;
use super::workspace::compare::Compare;
use super::workspace::empty::Empty;
use super::workspace::sweep::Sweep;
use super::workspace::trees::Trees;
use crate::model::Model;
use egui::{Frame, Margin, Ui};

/// All that there are, in the order of the rail; the first one is the usual one. The first three are everybody's, to choose
/// from in the bar.
fn registry() -> Vec<Box<dyn Workspace>> {
    vec![Box::<Compare>::default(), Box::new(Sweep), Box::new(Trees), Box::new(Empty), Box::<Cases>::default()]
}

/// How many everybody has.
const USUAL: usize = 3;

/// Those that the window offers, and the one that is open.
pub struct Workspaces {
    /// Never empty.
    offered: Vec<Box<dyn Workspace>>,
    open: usize,
}

impl Default for Workspaces {
    fn default() -> Self {
        Workspaces::beginning_with(None)
    }
}

impl Workspaces {
    /// The usual workspaces, the one of this id open; all of them, with a rail, where it is none of those.
    pub fn beginning_with(id: Option<&str>) -> Self {
        let mut offered = registry();
        let place = id.and_then(|id| offered.iter().position(|workspace| workspace.id() == id));
        let open = place.unwrap_or(0);
        if open < USUAL {
            offered.truncate(USUAL);
        }
        Workspaces { offered, open }
    }

    /// The ids of all workspaces.
    pub fn names() -> Vec<&'static str> {
        registry().iter().map(|workspace| workspace.id()).collect()
    }

    /// Opens the one that is wished, or that of the usual ones which the session says, unless another is open.
    pub fn follow(&mut self, model: &mut Model) {
        if let Some(wished) = model.state.wished_workspace.take() {
            let place = |offered: &[Box<dyn Workspace>]| offered.iter().position(|workspace| workspace.id() == wished);
            if place(&self.offered).is_none() {
                self.offered = registry();
            }
            self.open = place(&self.offered).unwrap_or(self.open);
        }
        if self.open < USUAL {
            let session = &model.session;
            self.open = if session.trees.open { 2 } else { usize::from(session.sweep.open) };
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

    /// Icon and word of each at the left, where there is more than one to choose from.
    pub fn rail(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        if self.offered.len() == USUAL {
            return;
        }
        let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::same(4));
        egui::Panel::left("rail").resizable(false).frame(frame).show(ui, |ui| {
            for (index, workspace) in self.offered.iter().enumerate() {
                let (id, open) = (workspace.id(), self.open == index);
                let tab = icon_and_word(workspace.icon(), workspace.name(), open, ui);
                if cx.dump.note(&format!("workspace {id}"), open, tab).clicked() {
                    self.open = index;
                    (cx.model.session.sweep.open, cx.model.session.trees.open) = (index == 1, index == 2);
                }
            }
        });
    }
}
