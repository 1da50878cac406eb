//! What the window shows: [`Viewer`] holds all that the user can change, and draws itself into egui. It knows no window,
//! no GPU and no thread: it is told what there is to show ([`Pane`]) and says what it wants ([`Request`]).

mod controls;
mod dump;
mod picture;
mod top_bar;
mod viewer;

pub use dump::{Dump, Widget};
pub use viewer::{Request, Revisions, View, Viewer};

use compare::Errors;

/// What there is to show of one side.
#[derive(Debug, Clone, Default)]
pub struct Pane {
    /// The picture, at the size of the picture area or smaller.
    pub texture: Option<egui::TextureId>,
    /// Name of technique and settings of that picture.
    pub label: String,
    /// Samples per pixel, where the technique samples.
    pub spp: Option<u32>,
    /// Seconds of rendering.
    pub seconds: f64,
    /// Whether the picture is a rough first one.
    pub rough: bool,
    /// Distance from the other side.
    pub errors: Option<Errors>,
    /// Why there is no picture.
    pub fault: Option<String>,
}
