//! What is compared with what, and which map of the errors is looked at. Not part of undo: changing it loses nothing.

use crate::engine::Side;
use crate::engine::post_process::MapWish;
use crate::ruler::Against;
use compare::ErrorMetric;

/// How errors are measured and drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonSettings {
    /// With what both sides are compared.
    pub against: Against,
    /// Whose errors the map shows; against each other always A's.
    pub of: Side,
    /// Which errors it shows.
    pub map: ErrorMetric,
    /// Where the scale of each map ends, in the order of [`ErrorMetric::ALL`]; `None` fits it to every picture.
    pub held: [Option<f32>; ErrorMetric::ALL.len()],
    /// A reference to load, as typed.
    pub file_name: String,
}

impl Default for ComparisonSettings {
    fn default() -> Self {
        ComparisonSettings {
            against: Against::EachOther,
            of: Side::A,
            map: ErrorMetric::default(),
            held: [None; ErrorMetric::ALL.len()],
            file_name: String::new(),
        }
    }
}

impl ComparisonSettings {
    /// Whose errors are mapped.
    pub fn side(&self) -> Side {
        if self.against == Against::Reference { self.of } else { Side::A }
    }

    /// Where the scale of the chosen map ends, to be held or fitted. FLIP's is always from 0 to 1.
    pub fn held_mut(&mut self) -> Option<&mut Option<f32>> {
        (self.map != ErrorMetric::Flip).then(|| &mut self.held[self.map as usize])
    }

    /// The map to draw.
    pub fn wish(&self) -> MapWish {
        MapWish { of: self.side(), map: self.map, held: self.held[self.map as usize] }
    }
}
