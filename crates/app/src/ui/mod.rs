//! What the window shows: [`Viewer`] holds all that the user can change, and draws itself into egui. It knows no
//! window, no GPU and no thread: it is told what there is to show ([`ViewModel`]) and says what it wants
//! ([`UiCommand`]).

mod comparison;
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
mod widgets;

pub use comparison::ComparisonSettings;
pub use dump::{Dump, Widget};
pub use export_menu::What;
pub use message::Message;
pub use settings::{History, Resolution, Settings};
pub use view::{Line, View};
pub use viewer::{UiCommand, Viewer};

use crate::engine::error_map::ErrorMap;
use crate::engine::reference::Progress;
use crate::ruler::Against;
use crate::technique::Provenance;
use compare::Errors;
use std::sync::Arc;

/// All that there is to show.
#[derive(Debug, Clone, Default)]
pub struct ViewModel {
    /// Both sides.
    pub panes: [Pane; 2],
    /// Where the errors are, while that is looked at.
    pub map: Option<MapPane>,
    /// How far the reference has come, while it is asked for.
    pub reference: Option<Progress>,
}

/// A map of errors as it is shown.
#[derive(Debug, Clone)]
pub struct MapPane {
    /// Its colours.
    pub texture: egui::TextureId,
    /// Its numbers, and what they are of.
    pub drawn: Arc<ErrorMap>,
}

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
    /// How many pixels of the picture area one of its pixels takes, along a side.
    pub shrink: u32,
    /// Whether more of it will come.
    pub unfinished: bool,
    /// Distance from what it is compared with.
    pub errors: Option<Errors>,
    /// What that is.
    pub against: Against,
    /// What made it.
    pub adapter: Option<Arc<str>>,
    /// Why there is no picture.
    pub fault: Option<String>,
    /// Why it was not made where it should be.
    pub refused: Option<Arc<str>>,
}
