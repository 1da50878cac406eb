//! Where labels stand: inside the largest part of each effect, as far from its border as words of one line ask for.

use super::smoothing::parts;
use super::{Effect, EffectMap};

/// A label is so many times as wide as it is high: what is beside it has to be so much farther away.
const WIDER_THAN_HIGH: f32 = 5.0;

/// Places that are offered for each label, the best first.
const PLACES: usize = 4;

/// How much room, in heights of a cell, a place has to have more than another for each cell that it is farther from the middle.
const PER_CELL: f32 = 0.02;

/// Where the label of an effect may stand.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelPlaces {
    /// The effect that the label names.
    pub effect: Effect,
    /// Middles of the label, in shares of the picture from its upper left corner, the one with most room first.
    pub at: Vec<[f32; 2]>,
}

impl EffectMap {
    /// Of each effect that is there the places for its label, in its largest part.
    pub fn label_places(&self) -> Vec<LabelPlaces> {
        let parts = parts(self);
        let largest =
            |effect: Effect| parts.iter().filter(|part| self.effects[part[0]] == effect).max_by_key(|part| part.len());
        let places = |effect: Effect| Some(LabelPlaces { effect, at: self.places_in(largest(effect)?) });
        Effect::ALL.into_iter().filter_map(places).collect()
    }

    /// The cells of a part with most room about them, each outside the room of those before.
    fn places_in(&self, part: &[usize]) -> Vec<[f32; 2]> {
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        let mut room = rooms(part, (width, height));
        let place = |cell: usize| [(cell % width) as f32, (cell / width) as f32];
        let middle = [0, 1].map(|axis| part.iter().map(|cell| place(*cell)[axis]).sum::<f32>() / part.len() as f32);
        // of places with as much room the one in the middle
        let worth = |room: f32, cell: usize| {
            let [x, y] = place(cell);
            room - PER_CELL * (x - middle[0]).hypot(y - middle[1])
        };
        let mut places = Vec::new();
        while places.len() < PLACES {
            let free = part.iter().copied().filter(|cell| room[*cell] > 0.0);
            let best = free.max_by(|a, b| worth(room[*a], *a).total_cmp(&worth(room[*b], *b)));
            let Some(best) = best else { break };
            let ([x, y], near) = (place(best), room[best].max(3.0));
            places.push([(x + 0.5) / width as f32, (y + 0.5) / height as f32]);
            for cell in part {
                let [u, v] = place(*cell);
                let off = [(u - x).abs() / WIDER_THAN_HIGH, (v - y).abs()];
                if off[0].max(off[1]) < near {
                    room[*cell] = 0.0;
                }
            }
        }
        places
    }
}

/// For each cell of a part how far the next one is that is none, or the picture's edge, in heights of a cell: by two passes over
/// it (Rosenfeld and Pfaltz 1966). 0 for all other cells.
fn rooms(part: &[usize], (width, height): (usize, usize)) -> Vec<f32> {
    let mut room = vec![0.0; width * height];
    part.iter().for_each(|cell| room[*cell] = f32::INFINITY);
    let mut cells: Vec<usize> = part.to_vec();
    cells.sort_unstable();
    let step = |room: &mut [f32], cell: usize, sides: [Option<usize>; 2]| {
        let [along, across] = sides.map(|side| side.map_or(0.0, |side| room[side]));
        room[cell] = room[cell].min(along + 1.0 / WIDER_THAN_HIGH).min(across + 1.0);
    };
    for &cell in &cells {
        step(&mut room, cell, [(cell % width > 0).then(|| cell - 1), cell.checked_sub(width)]);
    }
    for &cell in cells.iter().rev() {
        let below = Some(cell + width).filter(|below| *below < width * height);
        step(&mut room, cell, [((cell + 1) % width > 0).then_some(cell + 1), below]);
    }
    room
}
