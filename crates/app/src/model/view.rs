//! Which picture is shown, and how two share the window.

use super::PaneId;

/// Which picture is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// This pane alone, in all of the middle.
    Pane(PaneId),
    /// Both, under a line that the mouse drags.
    Wipe,
    /// Both whole, A left and B right.
    SideBySide,
    /// Where the errors are, and how large.
    ErrorMap,
}

/// How the wipe's line stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// A left, B right.
    Vertical,
    /// A above, B below.
    Horizontal,
}

impl View {
    /// All, in the order of their keys 1 to 5.
    pub const ALL: [View; 5] =
        [View::Pane(PaneId::A), View::Pane(PaneId::B), View::Wipe, View::SideBySide, View::ErrorMap];

    /// The name on its button.
    pub fn name(self) -> &'static str {
        match self {
            View::Pane(pane) => pane.name(),
            View::Wipe => "Wipe",
            View::SideBySide => "Side by side",
            View::ErrorMap => "Error map",
        }
    }

    /// On the command line and in a session's file.
    pub fn word(self) -> &'static str {
        match self {
            View::Pane(PaneId::A) => "a",
            View::Pane(_) => "b",
            View::Wipe => "wipe",
            View::SideBySide => "side",
            View::ErrorMap => "map",
        }
    }
}

impl Line {
    /// Turned by a right angle.
    pub fn turned(self) -> Self {
        match self {
            Line::Vertical => Line::Horizontal,
            Line::Horizontal => Line::Vertical,
        }
    }

    /// The name in words.
    pub fn name(self) -> &'static str {
        match self {
            Line::Vertical => "vertical",
            Line::Horizontal => "horizontal",
        }
    }
}
