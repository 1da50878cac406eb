//! What the window shows: draws a [`Model`] and what there is to show of it ([`ViewModel`]) into egui, changes the
//! model as the user wants, and asks the window for what only that can do ([`UiCommand`]). It knows no window, no GPU
//! and no thread.

mod controls;
mod drop;
mod dump;
mod export_menu;
mod help;
mod keys;
mod overlay;
mod pressed;
mod scene_menu;
mod slides_menu;
mod theme;
mod top_bar;
mod waiting;
mod widgets;
mod workspace;
mod workspaces;

pub use dump::{Dump, Widget};
pub use waiting::show_waiting;
pub use workspace::{Icon, Workspace};
pub use workspaces::Workspaces;

use self::widgets::Explained;
use crate::model::{ExportRequest, FileWish, Model, Panes, ViewModel};
use egui::{TextureId, Ui};
use std::collections::HashMap;
use std::path::PathBuf;

/// What only the window around can do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UiCommand {
    /// Write a picture to a file or the clipboard.
    Export(ExportRequest),
    /// Read and open a scene, by name or file, or what a picture shows.
    Open(String),
    /// Give up the scene that is being read.
    StopLoading,
    /// Read the scene's file again.
    ReadAgain,
    /// Let the user choose a file in a dialogue of the system's.
    Choose(FileWish),
    /// Draw small pictures of these built-in scenes, and no others.
    DrawThumbnails(Vec<&'static str>),
    /// Read a reference from a file.
    LoadReference(PathBuf),
    /// Fill the screen with the window, or give it back its frame.
    FullScreen,
    /// Ends the program after this frame.
    Quit,
}

/// The pixels of what there is to show, as egui knows them.
#[derive(Debug, Default)]
pub struct Textures {
    /// The panes' pictures, at the size of the picture area or smaller.
    pub panes: Panes<TextureId>,
    /// The map of errors.
    pub map: Option<TextureId>,
    /// The outline of the part of the scene that is in hand, over the whole picture: white within it, dark around it, clear
    /// elsewhere. Of the view of [`ViewModel::objects`].
    pub outline: Option<TextureId>,
    /// The tiles of a sweep, in their order.
    pub tiles: Vec<Option<TextureId>>,
    /// The pictures of a ladder.
    pub ladder: LadderTextures,
    /// Rays through the statue, in the order of the structures.
    pub trees: [Option<TextureId>; 3],
    /// Small pictures of built-in scenes, by their names.
    pub thumbnails: HashMap<&'static str, TextureId>,
}

/// The pictures of a ladder, as egui knows them.
#[derive(Debug, Default)]
pub struct LadderTextures {
    /// Those of its rungs, by [`Rung::place`](crate::model::Rung::place).
    pub rungs: Vec<Option<TextureId>>,
    /// The reference that all are measured by.
    pub reference: Option<TextureId>,
    /// The map of one rung's errors.
    pub map: Option<TextureId>,
}

/// What everything that is drawn in one frame reads, changes and asks for.
pub struct UiContext<'a> {
    /// All that the user can change.
    pub model: &'a mut Model,
    /// What there is to show.
    pub shown: &'a ViewModel,
    /// Textures of the pictures in it, by pane.
    pub textures: &'a Textures,
    /// The widgets drawn so far, for tests.
    pub dump: &'a mut Dump,
    /// What the window is asked for.
    pub commands: &'a mut Vec<UiCommand>,
}

/// Notches of the wheel that come as soon as this after each other, in seconds, are one step of undo.
const ONE_SCROLL: f32 = 0.5;

/// Draws the bar, the panel and the workspace for one frame.
pub fn show(workspaces: &mut Workspaces, cx: &mut UiContext, ui: &mut Ui) {
    if theme::apply(cx.model.state.theme, ui.ctx()) {
        // fonts and style are there from the next pass on, which is of the same frame
        ui.ctx().request_discard("another theme");
        ui.ctx().request_repaint();
        return;
    }
    workspaces.follow(cx.model);
    keys::listen(workspaces, cx, ui.ctx());
    workspaces.follow(cx.model);
    top_bar::show(workspaces, cx, ui);
    workspaces.rail(cx, ui);
    workspaces.open_mut().ui(cx, ui);
    help::show(workspaces.open(), cx, ui);
    drop::show(cx, ui.ctx());
    let scrolling = ui.input(|i| i.time_since_last_scroll()) < ONE_SCROLL;
    let busy = scrolling || ui.input(|i| i.pointer.any_down()) || ui.ctx().text_edit_focused();
    cx.model.settle(busy);
}

/// A button that asks for a file in a dialogue of the system's, of which there is one at a time. Returns whether it was
/// clicked.
fn dialogue_button(name: &str, label: &str, wish: FileWish, cx: &mut UiContext, ui: &mut Ui) -> bool {
    let button = ui.add_enabled(!cx.model.state.choosing_file, widgets::framed("Choose ...", ui));
    let clicked = cx.dump.note(name, "", button.explained(label).accessible_name(label)).clicked();
    if clicked {
        cx.model.state.choosing_file = true;
        cx.commands.push(UiCommand::Choose(wish));
    }
    clicked
}
