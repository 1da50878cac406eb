//! Workspaces: what the window is used for at a time. A workspace draws all that is below the bar and says what shall be
//! made for it; scene, session, engine and bar are everybody's.

pub(super) mod cases;
pub(super) mod compare;
pub(super) mod empty;
pub(super) mod ladder;
pub(super) mod sweep;
pub(super) mod trees;

use super::UiContext;
use super::pressed::{HelpLine, Keys};
pub use super::widgets::Icon;
use crate::model::{Model, Wanted};
use egui::Ui;

/// Something to use the window for.
pub trait Workspace {
    /// What it is called on the command line.
    fn id(&self) -> &'static str;

    /// What it is called on its tab.
    fn name(&self) -> &'static str;

    /// What stands above its name on the rail, and for it in the bar.
    fn icon(&self) -> Icon;

    /// What it is good for, with the key that opens it: what its button in the bar says under the mouse.
    fn about(&self) -> &'static str {
        self.name()
    }

    /// Draws its own buttons into the middle of the bar.
    fn bar(&mut self, _cx: &mut UiContext, _ui: &mut Ui) {}

    /// Hears the keys that nobody types with.
    fn keys(&mut self, _cx: &mut UiContext, _keys: &Keys) {}

    /// Hears Esc where it closes nothing that lies above.
    fn escape(&mut self, _cx: &mut UiContext) {}

    /// Draws what is below the bar.
    fn ui(&mut self, cx: &mut UiContext, ui: &mut Ui);

    /// The pictures that it shows, and what is to be known of them. It begins with [`Model::wanted`].
    fn wanted(&self, model: &Model) -> Wanted;

    /// What mouse and keys do in it.
    fn help(&self) -> Vec<HelpLine> {
        Vec::new()
    }
}
