//! What the window is opened with.

use super::{Setup, Slide, Theme};
use std::path::PathBuf;
use technique::DeviceChoice;

/// What `visavis [SCENE]` was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewArgs {
    /// A built-in name, a scene's file, a session or a picture of this program.
    pub scene: String,
    /// What is shown of it before what is set beside it.
    pub slide: Option<&'static Slide>,
    /// What is set beside it.
    pub setup: Setup,
    /// Where to write the names, rectangles and states of the widgets, each frame, for tests.
    pub ui_dump: Option<PathBuf>,
    /// How the window looks at first; `None` as the session says, or as usual.
    pub theme: Option<Theme>,
    /// Where rays are traced at first, in both panes; `None` as the session says, or as usual.
    pub device: Option<DeviceChoice>,
    /// The workspace to begin with, and all others to choose from; `None` for the usual one alone.
    pub workspace: Option<String>,
    /// Whether to print at the end what frames cost the UI thread.
    pub frame_stats: bool,
}
