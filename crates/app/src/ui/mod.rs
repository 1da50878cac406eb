//! What the window shows: [`Viewer`] holds all that the user can change, and draws itself into egui. It knows no window,
//! no GPU and no thread: it is told what there is to show ([`Pane`]) and says what it wants ([`Request`]).

mod controls;
mod dump;
mod export_menu;
mod help;
mod keys;
mod message;
mod picture;
mod settings;
mod theme;
mod top_bar;
mod view;
mod viewer;

pub use dump::{Dump, Widget};
pub use export_menu::What;
pub use message::Message;
pub use settings::{History, Settings};
pub use theme::Theme;
pub use view::{Line, View};
pub use viewer::{Request, Viewer};

use crate::technique::Provenance;
use compare::Errors;
use std::sync::Arc;

/// What there is to show of one side.
#[derive(Debug, Clone, Default)]
pub struct Pane {
    /// The picture, at the size of the picture area or smaller.
    pub texture: Option<egui::TextureId>,
    /// What that picture was made from.
    pub provenance: Option<Arc<Provenance>>,
    /// Samples per pixel, where the technique samples.
    pub spp: Option<u32>,
    /// Seconds of rendering.
    pub seconds: f64,
    /// Samples that were not finite and are left out.
    pub nonfinite: u64,
    /// Whether the picture is a rough first one.
    pub rough: bool,
    /// Whether more of it will come.
    pub unfinished: bool,
    /// Distance from the other side.
    pub errors: Option<Errors>,
    /// Why there is no picture.
    pub fault: Option<String>,
}
