//! An expression as a deterministic automaton that reads paths from the eye: the subset construction over its
//! positions, last letter first.
//!
//! Twin: `shaders/pathtrace/integrator/light_paths.wgsl`.

use super::expression::{D, E, Expression, G, L, LightPathsError, Positions, S};

/// States of an automaton, the dead one among them.
pub const MOST_STATES: usize = 32;

/// The state from which no path counts any more: its row is 0.
const DEAD: usize = 0;

/// The state of a path that leaves the eye.
pub const BEGINS: u32 = 1;

/// Set in the row of a state in which a light that is met, or sampled, counts.
pub const ACCEPTS: u32 = 1 << 31;

/// Surfaces in the order in which a row has what follows them, 8 bits each.
const SURFACES: [u8; 3] = [D, G, S];

/// A row for each state: the states that follow a diffuse, a glossy and a specular vertex, in its lowest three bytes,
/// and the bit [`ACCEPTS`] where what has been read is whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Automaton {
    /// The rows of all states; those that there are not are 0.
    pub rows: [u32; MOST_STATES],
}

impl Automaton {
    /// The automaton that accepts what an expression describes.
    ///
    /// # Errors
    /// If no path is like that, or it takes too many states.
    pub fn new(expression: &Expression) -> Result<Self, LightPathsError> {
        let begins = expression.step(expression.last, E);
        if !expression.lives(begins) {
            return Err(LightPathsError::Nothing);
        }
        // DEAD comes first
        let mut states = vec![0, begins];
        let mut rows = [0; MOST_STATES];
        let mut state = BEGINS as usize;
        while state < states.len() {
            rows[state] = expression.row(states[state], &mut states)?;
            state += 1;
        }
        Ok(Automaton { rows })
    }
}

impl Expression {
    /// Positions that may come next in a path read backwards, where these could and one letter came.
    fn step(&self, next: Positions, letter: u8) -> Positions {
        let taken = |(&letters, &before): (&u8, &Positions), at: usize| {
            if next >> at & 1 != 0 && letters & letter != 0 { before } else { 0 }
        };
        self.letters.iter().zip(&self.before).enumerate().fold(0, |set, (at, position)| set | taken(position, at))
    }

    /// Whether a light here is where a path of this expression begins.
    fn accepts(&self, next: Positions) -> bool {
        let begins = |(at, letters): (usize, &u8)| (next & self.first) >> at & 1 != 0 && letters & L != 0;
        self.letters.iter().enumerate().any(begins)
    }

    /// Whether any light could count from here on.
    fn lives(&self, next: Positions) -> bool {
        let (mut reached, mut before) = (next, 0);
        while reached != before {
            before = reached;
            reached |= SURFACES.iter().fold(0, |set, surface| set | self.step(reached, *surface));
        }
        self.accepts(reached)
    }

    /// The row of a state, with new states behind those that are known.
    fn row(&self, next: Positions, states: &mut Vec<Positions>) -> Result<u32, LightPathsError> {
        let mut row = if self.accepts(next) { ACCEPTS } else { 0 };
        for (place, surface) in SURFACES.into_iter().enumerate() {
            row |= (self.state_of(self.step(next, surface), states)? as u32) << (8 * place);
        }
        Ok(row)
    }

    fn state_of(&self, next: Positions, states: &mut Vec<Positions>) -> Result<usize, LightPathsError> {
        if !self.lives(next) {
            return Ok(DEAD);
        }
        if let Some(known) = states.iter().position(|state| *state == next) {
            return Ok(known);
        }
        if states.len() == MOST_STATES {
            return Err(LightPathsError::TooManyStates);
        }
        states.push(next);
        Ok(states.len() - 1)
    }
}
