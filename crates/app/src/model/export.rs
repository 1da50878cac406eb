//! What the user wants of a picture beside seeing it.

use super::PaneId;
use std::path::PathBuf;

/// Which of the pictures on screen is exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExportSubject {
    /// The picture area as it is on the screen: both panes, line and labels.
    #[default]
    AsSeen,
    /// One pane, whole and without labels.
    Pane(PaneId),
    /// The map of errors, with its colour bar and without labels.
    ErrorMap,
    /// How errors have fallen.
    Plot(PlotFile),
    /// All tiles of a sweep with their captions.
    Sweep(SweepFile),
    /// All rungs of a ladder: a folder of pictures, a table and a chart.
    Ladder,
    /// The samples of the pixel that is looked into.
    Samples,
    /// No picture, but what makes all of them again.
    Session,
    /// What is changed in the scene, as a scene's file of its own.
    Scene,
    /// Pictures, settings, errors, times and plots as one page.
    Report,
    /// Pictures with large labels, to be shown to a class.
    Slide(SlideSize),
}

/// How large a slide is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SlideSize {
    /// 1920 x 1080 pixels.
    #[default]
    FullHd,
    /// 3840 x 2160 pixels.
    Uhd,
}

impl SlideSize {
    /// Both, the default first.
    pub const ALL: [SlideSize; 2] = [SlideSize::FullHd, SlideSize::Uhd];

    /// Width and height in pixels.
    pub fn pixels(self) -> (u32, u32) {
        match self {
            SlideSize::FullHd => (1920, 1080),
            SlideSize::Uhd => (3840, 2160),
        }
    }

    /// On the command line and on its button: "1920x1080".
    pub fn name(self) -> &'static str {
        match self {
            SlideSize::FullHd => "1920x1080",
            SlideSize::Uhd => "3840x2160",
        }
    }

    /// The size of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|size| size.name() == name)
    }
}

/// What the plot of errors is kept as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlotFile {
    /// Its numbers, a row a moment.
    Csv,
    /// A picture of lines.
    Svg,
}

impl PlotFile {
    /// The name on its button.
    pub fn name(self) -> &'static str {
        match self {
            PlotFile::Csv => "CSV",
            PlotFile::Svg => "SVG",
        }
    }
}

/// What a sweep is kept as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SweepFile {
    /// One picture of all tiles, with their captions.
    Picture,
    /// The captions, a row a tile.
    Table,
}

impl SweepFile {
    /// The name on its button.
    pub fn name(self) -> &'static str {
        match self {
            SweepFile::Picture => "PNG",
            SweepFile::Table => "CSV",
        }
    }
}

/// Where an export goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Destination {
    /// A file; if there is one already, another name beside it.
    File(PathBuf),
    /// The clipboard, as a picture of 8 bits.
    Clipboard,
}

/// A picture to write to a file or the clipboard.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportRequest {
    /// Which of the pictures on screen.
    pub subject: ExportSubject,
    /// The file or the clipboard.
    pub to: Destination,
}

/// What is typed and chosen in the export menu.
#[derive(Debug, Clone, Default)]
pub struct ExportMenu {
    /// What is exported next.
    pub subject: ExportSubject,
    /// The file as typed; the proposal while it is empty.
    pub file: String,
    /// Whether a pane is kept as linear radiance.
    pub exr: bool,
    /// How large the next slide is.
    pub slide: SlideSize,
}
