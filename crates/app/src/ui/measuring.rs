//! What is compared with what, and which map of the errors is looked at. Not part of undo: changing it loses nothing.

use crate::ruler::Against;
use crate::workers::Side;
use crate::workers::darkroom::MapWish;
use compare::ErrorMap;

/// How errors are measured and drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Measuring {
    /// With what both sides are compared.
    pub against: Against,
    /// Whose errors the map shows; against each other always A's.
    pub of: Side,
    /// Which errors it shows.
    pub map: ErrorMap,
    /// Where the scale of each map ends, in the order of [`ErrorMap::ALL`]; `None` fits it to every picture.
    pub held: [Option<f32>; ErrorMap::ALL.len()],
    /// A reference to load, as typed.
    pub file_name: String,
}

impl Default for Measuring {
    fn default() -> Self {
        Measuring {
            against: Against::EachOther,
            of: Side::A,
            map: ErrorMap::default(),
            held: [None; ErrorMap::ALL.len()],
            file_name: String::new(),
        }
    }
}

impl Measuring {
    /// Whose errors are mapped.
    pub fn side(&self) -> Side {
        if self.against == Against::Reference { self.of } else { Side::A }
    }

    /// Where the scale of the chosen map ends, to be held or fitted. FLIP's is always from 0 to 1.
    pub fn held_mut(&mut self) -> Option<&mut Option<f32>> {
        (self.map != ErrorMap::Flip).then(|| &mut self.held[self.map as usize])
    }

    /// The map to draw.
    pub fn wish(&self) -> MapWish {
        MapWish { of: self.side(), map: self.map, held: self.held[self.map as usize] }
    }
}
