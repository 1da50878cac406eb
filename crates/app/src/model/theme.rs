//! How the window looks: dark or light for a desk, bright with large type for a projector.

/// The colours and type sizes of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Theme {
    /// Light type on dark grey: the picture is the brightest thing.
    #[default]
    Dark,
    /// The same in dark on light, for a bright room.
    Light,
    /// Black on white, all type heavy and as large as the window is high: the last row of seats reads it.
    Projector,
}

impl Theme {
    /// All, the default first.
    pub const ALL: [Theme; 3] = [Theme::Dark, Theme::Light, Theme::Projector];

    /// The name in the menu and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Theme::Dark => "dark",
            Theme::Light => "light",
            Theme::Projector => "projector",
        }
    }

    /// The theme of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|theme| theme.name() == name)
    }
}
