//! From what paths have found to a [`Guide`]: plain sums, in the order of the paths.

use super::cells::{CELLS, Cells};
use super::{Column, Guide};
use crate::integrator::roulette::STEPS;
use crate::vectors::VectorColumn;
use scene::Vec3;

/// Bins along the first number of the cosine warp, which tells how steep a direction is.
pub const ROWS: u32 = 8;
/// Bins along the second number, which goes once around.
pub const COLUMNS: u32 = 8;
/// Bins of each cell.
pub const BINS: u32 = ROWS * COLUMNS;

/// Share of the directions that stay cosine-weighted.
const UNGUIDED: f64 = 0.2;
/// Records that a bin, and a cell's mean, has beforehand: what a few paths say is not yet believed.
const BELIEF: f64 = 2.0;
/// How much a bin's neighbour counts for it: radiance is smoother than the histograms of few paths.
const NEIGHBOUR: f64 = 0.25;

/// What a path found beyond a vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// Cell of the vertex and bin of the direction: `cell * BINS + bin`.
    pub place: u32,
    /// The radiance from there; `None` where roulette ended the path.
    pub found: Option<f32>,
    /// The radiance divided by the probability of getting there, so 0 where roulette ended the path.
    pub expected: Vec3,
}

/// Sums of what all paths have found, bin by bin.
pub struct Histograms {
    /// Of each bin: squared radiance, and how often it was looked at.
    bins: Vec<[f64; 2]>,
    /// Of each cell: expected radiance, and how many there are.
    cells: Vec<[f64; 4]>,
}

impl Default for Histograms {
    fn default() -> Self {
        Histograms { bins: vec![[0.0; 2]; (CELLS * BINS) as usize], cells: vec![[0.0; 4]; CELLS as usize] }
    }
}

impl Histograms {
    /// Adds what was found; radiance that is not finite teaches nothing.
    pub fn add(&mut self, finding: &Finding) {
        let place = finding.place as usize;
        if !finding.expected.is_finite() || place >= self.bins.len() {
            return;
        }
        let cell = &mut self.cells[place / BINS as usize];
        for (sum, value) in cell.iter_mut().zip(finding.expected.extend(1.0).to_array()) {
            *sum += f64::from(value);
        }
        if let Some(found) = finding.found.filter(|found| found.is_finite()) {
            let [squares, count] = &mut self.bins[place];
            *squares += f64::from(found) * f64::from(found);
            *count += 1.0;
        }
    }

    /// What the lanes look up.
    pub fn guide(&self, cells: Cells) -> Guide {
        let mut ends = Ends::default();
        let unseen = Ends::default().with(&[1.0; BINS as usize]);
        for bins in self.bins.chunks(BINS as usize) {
            if bins.iter().all(|[_, count]| *count == 0.0) {
                ends.extend(&unseen);
            } else {
                ends = ends.with(&shares_of(bins));
            }
        }
        let radiance = VectorColumn::new(self.cells.iter().map(mean_of));
        Guide { cells, rows: Column::new(ends.rows), columns: Column::new(ends.columns), radiance }
    }
}

/// The ends of the intervals of cells' rows, and of the columns in each.
#[derive(Default)]
struct Ends {
    rows: Vec<f32>,
    columns: Vec<f32>,
}

impl Ends {
    /// And those of one more cell.
    fn with(mut self, shares: &[f64]) -> Self {
        let lines = shares.chunks(COLUMNS as usize);
        self.rows.extend(ends_of(lines.clone().map(|line| line.iter().sum())));
        lines.for_each(|line| self.columns.extend(ends_of(line.iter().copied())));
        self
    }

    fn extend(&mut self, other: &Self) {
        self.rows.extend_from_slice(&other.rows);
        self.columns.extend_from_slice(&other.columns);
    }
}

/// The mean, drawn a little to darkness where few paths have told it.
fn mean_of(&[r, g, b, count]: &[f64; 4]) -> Vec3 {
    Vec3::from_array([r, g, b].map(|sum| (sum / (count + BELIEF)) as f32))
}

/// The share of directions that each bin of a cell gets.
fn shares_of(bins: &[[f64; 2]]) -> Vec<f64> {
    let [squares, count] = bins.iter().fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
    let usual = if squares > 0.0 { squares / count } else { 1.0 };
    let sizes: Vec<f64> = (0..bins.len()).map(|bin| smoothed(bins, bin, usual).sqrt()).collect();
    let all: f64 = sizes.iter().sum();
    sizes.into_iter().map(|size| (1.0 - UNGUIDED) * size / all + UNGUIDED / f64::from(BINS)).collect()
}

/// The mean square of a bin and its neighbours; the columns go around.
fn smoothed(bins: &[[f64; 2]], bin: usize, usual: f64) -> f64 {
    let (row, column) = (bin as i32 / COLUMNS as i32, bin as i32 % COLUMNS as i32);
    let [mut squares, mut count] = [BELIEF * usual, BELIEF];
    for (down, right, weight) in
        [(0, 0, 1.0), (-1, 0, NEIGHBOUR), (1, 0, NEIGHBOUR), (0, -1, NEIGHBOUR), (0, 1, NEIGHBOUR)]
    {
        let (row, column) = (row + down, (column + right).rem_euclid(COLUMNS as i32));
        if (0..ROWS as i32).contains(&row) {
            let [of_bin, times] = bins[(row * COLUMNS as i32 + column) as usize];
            squares += weight * of_bin;
            count += weight * times;
        }
    }
    squares / count
}

/// The ends of intervals that are as wide as these shares and fill 0 to 1. They are multiples of what random numbers are
/// multiples of, so that intervals are met as often as they are wide.
fn ends_of(shares: impl Iterator<Item = f64> + Clone) -> impl Iterator<Item = f32> {
    let all: f64 = shares.clone().sum();
    shares.scan(0.0, move |before, share| {
        *before += share / all;
        Some(((*before * f64::from(STEPS)).round() / f64::from(STEPS)) as f32)
    })
}
