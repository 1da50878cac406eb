//! What is compared with what, and which map of the errors is looked at. Not part of undo: changing it loses nothing.

use super::PaneId;
use super::Region;
use super::session::other;
use compare::ErrorMetric;

/// What the user compares with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CompareWith {
    /// Each pane with the other.
    #[default]
    EachOther,
    /// Each with the reference of what it shows.
    Reference,
}

impl CompareWith {
    /// Both, the default first.
    pub const ALL: [CompareWith; 2] = [CompareWith::EachOther, CompareWith::Reference];

    /// The name on its button.
    pub fn name(self) -> &'static str {
        match self {
            CompareWith::EachOther => "each other",
            CompareWith::Reference => "reference",
        }
    }

    /// On the command line and in a session's file.
    pub fn word(self) -> &'static str {
        match self {
            CompareWith::EachOther => "other",
            CompareWith::Reference => "reference",
        }
    }
}

/// What judges a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Against {
    /// The picture of another pane.
    Pane(PaneId),
    /// The reference of what it shows.
    Reference,
}

impl Against {
    /// As labels and errors call it: "B", "reference".
    pub fn name(self) -> &'static str {
        match self {
            Against::Pane(pane) => pane.name(),
            Against::Reference => "reference",
        }
    }
}

/// A picture and what judges it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Whose errors are measured.
    pub of: PaneId,
    /// What it is held against.
    pub against: Against,
    /// The part of both that counts; `None` for all.
    pub region: Option<Region>,
}

/// A map of errors to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapWish {
    /// Whose errors, and by what they are measured.
    pub comparison: Comparison,
    /// The errors that its colours show.
    pub metric: ErrorMetric,
    /// Where its scale ends; `None` to fit it.
    pub held: Option<f32>,
}

/// How errors are measured and drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonSettings {
    /// With what both panes are compared.
    pub with: CompareWith,
    /// Whose errors the map shows; against each other always A's.
    pub of: PaneId,
    /// Which errors it shows.
    pub metric: ErrorMetric,
    /// Where the scale of each map ends, in the order of [`ErrorMetric::ALL`]; `None` fits it to every picture.
    pub held: [Option<f32>; ErrorMetric::ALL.len()],
    /// The part of the pictures that figures speak of; `None` for the whole.
    pub region: Option<Region>,
    /// Whether the map names the effects of light that make its parts.
    pub effects: bool,
}

impl Default for ComparisonSettings {
    fn default() -> Self {
        ComparisonSettings {
            with: CompareWith::EachOther,
            of: PaneId::A,
            metric: ErrorMetric::Signed,
            held: [None; ErrorMetric::ALL.len()],
            region: None,
            effects: false,
        }
    }
}

impl ComparisonSettings {
    /// What judges a pane.
    pub fn comparison(&self, of: PaneId) -> Comparison {
        let against = match self.with {
            CompareWith::EachOther => Against::Pane(other(of)),
            CompareWith::Reference => Against::Reference,
        };
        Comparison { of, against, region: self.region }
    }

    /// The comparison whose errors are mapped.
    pub fn mapped(&self) -> Comparison {
        self.comparison(if self.with == CompareWith::Reference { self.of } else { PaneId::A })
    }

    /// Where the scale of the chosen map ends, to be held or fitted. FLIP's is always from 0 to 1.
    pub fn held_mut(&mut self) -> Option<&mut Option<f32>> {
        (self.metric != ErrorMetric::Flip).then(|| &mut self.held[self.metric as usize])
    }

    /// The map to draw.
    pub fn map(&self) -> MapWish {
        MapWish { comparison: self.mapped(), metric: self.metric, held: self.held[self.metric as usize] }
    }
}
