//! The workspaces that there are, and the one that is open. A new one is a row of [`registry`].

use super::UiContext;
use super::theme::palette;
use super::widgets::icon_and_word;
use super::workspace::Workspace;
use super::workspace::compare::Compare;
use super::workspace::empty::Empty;
use egui::{Frame, Margin, Ui};

/// All that there are, in the order of the rail; the first one is the usual one.
fn registry() -> Vec<Box<dyn Workspace>> {
    vec![Box::new(Compare), Box::new(Empty)]
}

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
    /// All workspaces, that of this id open; `None` for the usual one alone.
    pub fn beginning_with(id: Option<&str>) -> Self {
        let mut offered = registry();
        let Some(id) = id else {
            offered.truncate(1);
            return Workspaces { offered, open: 0 };
        };
        let open = offered.iter().position(|workspace| workspace.id() == id).unwrap_or(0);
        Workspaces { offered, open }
    }

    /// The ids of all workspaces.
    pub fn names() -> Vec<&'static str> {
        registry().iter().map(|workspace| workspace.id()).collect()
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
        if self.offered.len() == 1 {
            return;
        }
        let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::same(4));
        egui::Panel::left("rail").resizable(false).frame(frame).show(ui, |ui| {
            for (index, workspace) in self.offered.iter().enumerate() {
                let (id, open) = (workspace.id(), self.open == index);
                let tab = icon_and_word(workspace.icon(), workspace.name(), open, ui);
                if cx.dump.note(&format!("workspace {id}"), open, tab).clicked() {
                    self.open = index;
                }
            }
        });
    }
}
