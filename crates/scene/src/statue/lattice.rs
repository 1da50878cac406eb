//! The triangles of a subdivided octahedron, as rings around its axis.
//!
//! Each edge is cut into `2^level` pieces. Ring 0 is the upper tip, ring `2 * 2^level` the lower one; the ring in `m`
//! steps from the nearer tip has `m` corners a quarter. Every corner has one number, on the seams of the eight sides too.

use rayon::prelude::*;

/// An octahedron whose edges are cut into so many pieces.
#[derive(Debug, Clone, Copy)]
pub struct Lattice {
    pieces: u32,
}

/// A corner of the lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// How far down it lies, from 1 at the upper tip to -1 at the lower one.
    pub height: f32,
    /// Where around the axis: the quarter's number, and from 0 to below 1 the place in it.
    pub turn: f32,
}

impl Lattice {
    /// With `8 * 4^level` triangles.
    pub fn new(level: u32) -> Self {
        Lattice { pieces: 1 << level }
    }

    /// How many corners it has.
    pub fn nodes(self) -> usize {
        let n = self.pieces as usize;
        2 + 4 * n * n
    }

    /// How many triangles it has.
    pub fn triangles(self) -> usize {
        let n = self.pieces as usize;
        8 * n * n
    }

    /// The numbers of its rings, the tips among them.
    pub fn rings(self) -> std::ops::RangeInclusive<u32> {
        0..=2 * self.pieces
    }

    /// Steps from the nearer tip, which are the ring's corners a quarter.
    fn quarter(self, ring: u32) -> u32 {
        ring.min(2 * self.pieces - ring)
    }

    /// How many corners a ring has.
    pub fn ring_length(self, ring: u32) -> usize {
        (4 * self.quarter(ring) as usize).max(1)
    }

    /// The number of the first corner of a ring.
    fn first(self, ring: u32) -> u32 {
        // 1 + 4 * (1 + .. + (m - 1)), counted from either tip
        let before = |m: u32| if m == 0 { 0 } else { 1 + 2 * m * (m - 1) };
        if ring <= self.pieces { before(ring) } else { self.nodes() as u32 - before(2 * self.pieces - ring + 1) }
    }

    /// The corners of a ring, counter-clockwise seen from above.
    pub fn ring(self, ring: u32) -> impl Iterator<Item = Node> {
        let m = self.quarter(ring).max(1);
        let height = 1.0 - ring as f32 / self.pieces as f32;
        (0..self.ring_length(ring) as u32)
            .map(move |i| Node { height, turn: (i / m) as f32 + (i % m) as f32 / m as f32 })
    }

    /// Three corners of each triangle, counter-clockwise seen from outside, from the upper tip downwards.
    pub fn all_triangles(self) -> Vec<[u32; 3]> {
        let mut triangles = vec![[0; 3]; self.triangles()];
        let (mut rest, mut bands) = (&mut triangles[..], Vec::new());
        for band in 0..2 * self.pieces {
            let (of_band, after) = rest.split_at_mut(4 * self.widths(band).into_iter().sum::<u32>() as usize);
            bands.push((band, of_band));
            rest = after;
        }
        bands.into_par_iter().for_each(|(band, to)| self.fill_band(band, to));
        triangles
    }

    /// Corners a quarter of the rings above and below a band.
    fn widths(self, band: u32) -> [u32; 2] {
        [self.quarter(band), self.quarter(band + 1)]
    }

    fn fill_band(self, band: u32, to: &mut [[u32; 3]]) {
        let [above, below] = self.widths(band);
        let corner = |ring: u32, quarter: u32, i: u32| {
            let length = self.ring_length(ring) as u32;
            self.first(ring) + (quarter * self.quarter(ring) + i) % length
        };
        let mut to = to.iter_mut();
        let mut put = |triangle| to.next().into_iter().for_each(|place| *place = triangle);
        for quarter in 0..4 {
            let (up, down) = (|i| corner(band, quarter, i), |i| corner(band + 1, quarter, i));
            for i in 0..above.max(below) {
                if above < below {
                    put([up(i), down(i), down(i + 1)]);
                    (i < above).then(|| put([up(i), down(i + 1), up(i + 1)]));
                } else {
                    put([up(i), down(i), up(i + 1)]);
                    (i < below).then(|| put([up(i + 1), down(i), down(i + 1)]));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    #[test]
    fn each_edge_has_a_triangle_on_either_side() {
        for level in 0..5 {
            let lattice = Lattice::new(level);
            let triangles = lattice.all_triangles();
            assert_eq!(triangles.len(), 8 << (2 * level));
            let mut edges = HashMap::new();
            for [a, b, c] in triangles {
                [(a, b), (b, c), (c, a)].into_iter().for_each(|edge| *edges.entry(edge).or_insert(0) += 1);
            }
            assert!(edges.iter().all(|((a, b), count)| *count == 1 && edges.contains_key(&(*b, *a))), "level {level}");
            assert_eq!(edges.keys().map(|(a, _)| a).max(), Some(&(lattice.nodes() as u32 - 1)));
        }
    }

    #[test]
    fn rings_follow_one_another() {
        let lattice = Lattice::new(3);
        let mut next = 0;
        for ring in lattice.rings() {
            assert_eq!(lattice.first(ring), next);
            assert_eq!(lattice.ring(ring).count(), lattice.ring_length(ring));
            next += lattice.ring_length(ring) as u32;
        }
        assert_eq!(next as usize, lattice.nodes());
    }
}
