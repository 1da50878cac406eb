//! The lines between effects, to be drawn over a picture of any size.

use super::EffectMap;

/// How often each point of a line moves towards the middle of its neighbours: cells have corners, regions have none.
const ROUNDS: usize = 6;

/// Every how many points of a line are kept.
const STEP: usize = 2;

impl EffectMap {
    /// The lines between its effects, smoothed, as points in shares of the picture from its upper left corner. A line that is
    /// closed ends where it begins.
    pub fn outlines(&self) -> Vec<Vec<[f32; 2]>> {
        let (width, height) = (self.size.0 as f32, self.size.1 as f32);
        let lines = Borders::of(self).into_lines().into_iter().map(smooth);
        lines.map(|line| line.into_iter().map(|[x, y]| [x / width, y / height]).collect()).collect()
    }
}

/// Sides of cells that lie between two effects, by the corner where they begin.
struct Borders {
    /// Corners in a row.
    width: usize,
    /// Whether one goes right from each corner.
    right: Vec<bool>,
    /// Whether one goes down.
    down: Vec<bool>,
}

impl Borders {
    fn of(map: &EffectMap) -> Self {
        let (columns, rows) = (map.size.0 as usize, map.size.1 as usize);
        let width = columns + 1;
        let none = vec![false; width * (rows + 1)];
        let mut borders = Borders { width, right: none.clone(), down: none };
        for y in 0..rows {
            for x in 0..columns {
                let own = map.effects[y * columns + x];
                borders.down[y * width + x] = x > 0 && map.effects[y * columns + x - 1] != own;
                borders.right[y * width + x] = y > 0 && map.effects[(y - 1) * columns + x] != own;
            }
        }
        borders
    }

    /// The corners to which sides lead from one.
    fn next_to(&self, corner: usize) -> impl Iterator<Item = usize> + use<> {
        let right = self.right[corner].then_some(corner + 1);
        let down = self.down[corner].then_some(corner + self.width);
        let left = corner.checked_sub(1).filter(|left| self.right[*left]);
        let up = corner.checked_sub(self.width).filter(|up| self.down[*up]);
        [right, down, left, up].into_iter().flatten()
    }

    fn take(&mut self, from: usize, to: usize) {
        let (first, last) = (from.min(to), from.max(to));
        if last == first + 1 { self.right[first] = false } else { self.down[first] = false }
    }

    /// Chains of sides: first those that end where more or fewer than two meet, then closed ones.
    fn into_lines(mut self) -> Vec<Vec<[f32; 2]>> {
        let corners = 0..self.right.len();
        let ends: Vec<bool> = corners.clone().map(|corner| !matches!(self.next_to(corner).count(), 0 | 2)).collect();
        let mut lines = Vec::new();
        for begin in corners.clone().filter(|corner| ends[*corner]).chain(corners) {
            while let Some(first) = self.next_to(begin).next() {
                let mut line = vec![begin, first];
                self.take(begin, first);
                let mut at = first;
                while !ends[at]
                    && at != begin
                    && let Some(next) = self.next_to(at).next()
                {
                    self.take(at, next);
                    line.push(next);
                    at = next;
                }
                lines.push(line);
            }
        }
        let place = |corner: usize| [(corner % self.width) as f32, (corner / self.width) as f32];
        lines.into_iter().map(|line| line.into_iter().map(place).collect()).collect()
    }
}

/// The same line without steps; its ends stay, unless it is closed.
fn smooth(mut line: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    let closed = line.len() > 3 && line.first() == line.last();
    if closed {
        line.pop();
    }
    let count = line.len();
    for _ in 0..ROUNDS {
        let moved = |index: usize| {
            if !closed && (index == 0 || index + 1 == count) {
                return line[index];
            }
            let [before, after] = [line[(index + count - 1) % count], line[(index + 1) % count]];
            std::array::from_fn(|axis| 0.25 * (before[axis] + 2.0 * line[index][axis] + after[axis]))
        };
        line = (0..count).map(moved).collect();
    }
    let last = count - 1;
    let mut kept: Vec<[f32; 2]> = line
        .iter()
        .enumerate()
        .filter(|(index, _)| index % STEP == 0 || (!closed && *index == last))
        .map(|(_, p)| *p)
        .collect();
    kept.extend(kept.first().copied().filter(|_| closed));
    kept
}
