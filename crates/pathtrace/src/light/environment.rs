//! A sky from a picture as a light: a texel is drawn by its luminance and solid angle, row first and then column, and a
//! direction uniformly within it (pbrt-v4, 12.5 and A.5.3). Piecewise constant in solid angle rather than in latitude:
//! no density has a pole.
//!
//! Twin: `shaders/pathtrace/light/environment.wgsl`.

use crate::sampling::warp::{angle_of_upper, sin_cos_2pi};
use crate::vectors::{VectorColumn, each_lane, glam_vector, lane_vector, of_lanes};
use film::colour;
use scene::environment::row_bounds;
use scene::{EnvironmentMap, Vec3};
use simd::{Column, Float, MOST_LANES, Vector, Word};
use std::f32::consts::TAU;

/// A map that can be sampled.
#[derive(Debug)]
pub struct Environment {
    width: u32,
    height: u32,
    /// By which the picture is turned about y, in turns.
    turn: f32,
    radiance: VectorColumn,
    /// Running sums of the columns' probabilities within each row, from 0 to 1: one more than there are columns.
    columns: Column,
    /// Of the rows' probabilities.
    rows: Column,
    /// Minus the height of the rows' bounds on the unit sphere.
    depths: Column,
    /// The probability that this light is chosen.
    probability: f32,
}

/// A sample of the map in each lane.
#[derive(Debug, Clone, Copy)]
pub struct EnvironmentSamples<F> {
    /// Unit direction towards the sky.
    pub wi: Vector<F>,
    /// Radiance that arrives from that direction.
    pub radiance: Vector<F>,
    /// Density per solid angle.
    pub pdf: F,
}

/// What all lanes have found.
#[derive(Default)]
struct Found {
    directions: [Vec3; MOST_LANES],
    radiances: [Vec3; MOST_LANES],
    pdfs: [f32; MOST_LANES],
}

impl Environment {
    /// Ready for sampling; `None` of a map that is black.
    pub fn new(map: &EnvironmentMap) -> Option<Self> {
        let (width, height) = map.image().size();
        let depths: Vec<f64> = row_bounds(height).collect();
        let luminances: Vec<f64> = map.radiances().map(|radiance| f64::from(colour::luminance(radiance))).collect();
        let bands = || luminances.chunks_exact(width as usize).zip(depths.windows(2));
        let whole = f64::from(width) * (depths[depths.len() - 1] - depths[0]);
        let mean = bands().map(|(row, depths)| row.iter().sum::<f64>() * (depths[1] - depths[0])).sum::<f64>() / whole;
        let (mut columns, mut rows) = (Vec::new(), Vec::new());
        for (row, depths) in bands() {
            let weights: Vec<f64> = row.iter().map(|&luminance| weight(luminance, mean)).collect();
            let sum = push_running_sums(&mut columns, &weights);
            rows.push(sum * (depths[1] - depths[0]));
        }
        let mut sums = Vec::new();
        let all = push_running_sums(&mut sums, &rows);
        (all > 0.0).then(|| Environment {
            width,
            height,
            turn: (f64::from(map.rotation()) / 360.0).rem_euclid(1.0) as f32,
            radiance: VectorColumn::new(map.radiances()),
            columns: Column::new(columns),
            rows: Column::new(sums),
            depths: Column::new(depths.iter().map(|&depth| depth as f32)),
            probability: 1.0,
        })
    }

    /// The same as one of several lights, chosen with this probability.
    pub fn chosen_with(self, probability: f32) -> Self {
        Environment { probability, ..self }
    }

    /// Width and height of the picture.
    pub(crate) fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    pub(crate) fn turn(&self) -> f32 {
        self.turn
    }

    pub(crate) fn probability(&self) -> f32 {
        self.probability
    }

    /// Of each row its upper bounds: running sum of the probabilities, and depth.
    pub(crate) fn upper_bounds_of_rows(&self) -> impl Iterator<Item = [f32; 2]> {
        let bounds = self.rows.values().iter().zip(self.depths.values());
        bounds.skip(1).take(self.height as usize).map(|(sum, depth)| [*sum, *depth])
    }

    /// Of each column of each row its upper bound.
    pub(crate) fn upper_bounds_of_columns(&self) -> impl Iterator<Item = f32> {
        let rows = self.columns.values().chunks_exact(self.width as usize + 1).take(self.height as usize);
        rows.flat_map(|row| row[1..].iter().copied())
    }

    /// A direction, from two numbers in [0, 1). The density is that of this light alone.
    #[inline(always)]
    pub fn sample<F: Float>(&self, u: [F; 2]) -> EnvironmentSamples<F> {
        let none = F::U::splat(0);
        let row = interval(&self.rows, none, self.height, u[1]);
        let first = self.first_of_row::<F>(row);
        let column = interval(&self.columns, first, self.width, u[0]);
        let (top, bottom) = bounds::<F>(&self.depths, row);
        let depth = top + (bottom - top) * share(&self.rows, row, u[1]);
        let across = column.to_float() + share(&self.columns, first.wrapping_add(column), u[0]);
        let turned = across / self.width as f32 + self.turn;
        let (sin, cos) = sin_cos_2pi(turned - turned.floor());
        let (one, zero) = (F::splat(1.0), F::splat(0.0));
        let ring = ((one - depth) * (one + depth)).max(zero).sqrt();
        let wi = Vector::new(-(ring * sin), -depth, ring * cos);
        EnvironmentSamples { wi, radiance: self.radiance_of(row, column), pdf: self.density(row, column) }
    }

    /// Radiance that rays of these unit directions find, and the density per solid angle with which sampling all lights
    /// draws them.
    #[inline(always)]
    pub fn look_up<F: Float>(&self, direction: Vector<F>) -> (Vector<F>, F) {
        let row = interval(&self.depths, F::U::splat(0), self.height, -direction.y);
        let turned = angle_of_upper(direction.x.abs(), direction.z) * (1.0 / TAU);
        let turned = F::select(direction.x.gt(F::splat(0.0)), F::splat(1.0) - turned, turned) - self.turn;
        let across = (turned - turned.floor()) * self.width as f32;
        let column = across.min(F::splat(self.width as f32 - 1.0)).to_word();
        (self.radiance_of(row, column), self.density::<F>(row, column) * self.probability)
    }

    /// [`Environment::sample`] in each lane. One after the other and out of line: it is mostly loads, and inline it would
    /// slow kernels down that never come here.
    #[inline(always)]
    pub fn sample_lanes<F: Float>(&self, u: [F; 2]) -> EnvironmentSamples<F> {
        let mut numbers = [[0.0; MOST_LANES]; 2];
        u[0].store(&mut numbers[0]);
        u[1].store(&mut numbers[1]);
        let found = self.sample_each(F::LANES, &numbers);
        let [wi, radiance] = [of_lanes(&found.directions), of_lanes(&found.radiances)];
        EnvironmentSamples { wi, radiance, pdf: F::load(&found.pdfs) }
    }

    /// [`Environment::look_up`] in each lane, as [`Environment::sample_lanes`].
    #[inline(always)]
    pub fn look_up_lanes<F: Float>(&self, direction: Vector<F>) -> (Vector<F>, F) {
        let found = self.look_up_each(F::LANES, each_lane(direction));
        (of_lanes(&found.radiances), F::load(&found.pdfs))
    }

    #[cold]
    #[inline(never)]
    fn sample_each(&self, lanes: usize, u: &[[f32; MOST_LANES]; 2]) -> Found {
        let mut found = Found::default();
        for (lane, (&u, &v)) in u[0].iter().zip(&u[1]).enumerate().take(lanes) {
            let sample = self.sample([u, v]);
            found.directions[lane] = glam_vector(sample.wi);
            found.radiances[lane] = glam_vector(sample.radiance);
            found.pdfs[lane] = sample.pdf;
        }
        found
    }

    #[cold]
    #[inline(never)]
    fn look_up_each(&self, lanes: usize, directions: [Vec3; MOST_LANES]) -> Found {
        let mut found = Found { directions, ..Found::default() };
        for (lane, &direction) in directions.iter().enumerate().take(lanes) {
            let (radiance, pdf) = self.look_up(lane_vector(direction));
            found.radiances[lane] = glam_vector(radiance);
            found.pdfs[lane] = pdf;
        }
        found
    }

    #[inline(always)]
    fn first_of_row<F: Float>(&self, row: F::U) -> F::U {
        row.wrapping_mul(F::U::splat(self.width + 1))
    }

    #[inline(always)]
    fn radiance_of<F: Float>(&self, row: F::U, column: F::U) -> Vector<F> {
        self.radiance.look_up(row.wrapping_mul(F::U::splat(self.width)).wrapping_add(column))
    }

    /// Density per solid angle in a texel: its probability over the solid angle.
    #[inline(always)]
    fn density<F: Float>(&self, row: F::U, column: F::U) -> F {
        let extent = |(low, high): (F, F)| high - low;
        let of_row = extent(bounds::<F>(&self.rows, row));
        let of_column = extent(bounds::<F>(&self.columns, self.first_of_row::<F>(row).wrapping_add(column)));
        let height = extent(bounds::<F>(&self.depths, row));
        of_row * of_column / (height * (TAU / self.width as f32))
    }
}

/// How often a texel is drawn for its solid angle: nine of ten by its luminance, the tenth to all alike that are not
/// black. Beside one that is a million times brighter the others would otherwise have probabilities that running sums in
/// f32 cannot hold, and would never be drawn.
fn weight(luminance: f64, mean: f64) -> f64 {
    if luminance > 0.0 { 0.9 * luminance + 0.1 * mean } else { 0.0 }
}

/// Appends the running sums of `values`, from 0 to 1, and returns what they add up to. Divided by exactly that: what is
/// 0 at the end is never drawn either.
fn push_running_sums(to: &mut Vec<f32>, values: &[f64]) -> f64 {
    let all: f64 = values.iter().sum();
    let mut sum = 0.0;
    to.push(0.0);
    to.extend(values.iter().map(|value| {
        sum += value;
        if all > 0.0 { (sum / all) as f32 } else { 0.0 }
    }));
    all
}

/// Which of `count` intervals, whose bounds stand in a column from `first` on, holds `u`: the first that ends above it,
/// by halving.
#[inline(always)]
fn interval<F: Float>(column: &Column, first: F::U, count: u32, u: F) -> F::U {
    let mut below = F::U::splat(0);
    let last = F::U::splat(count - 1);
    let mut step = count.next_power_of_two();
    while step > 0 {
        let next = below.wrapping_add(F::U::splat(step));
        let passed = !last.lt(next) & first.wrapping_add(next).look_up(column).le(u);
        below = F::U::select(passed, next, below);
        step /= 2;
    }
    below
}

/// Lower and upper bound of the interval that begins at a place of a column.
#[inline(always)]
fn bounds<F: Float>(column: &Column, place: F::U) -> (F, F) {
    (place.look_up(column), place.wrapping_add(F::U::splat(1)).look_up(column))
}

/// How far `u` is from the lower to the upper bound of its interval, from 0 to 1.
#[inline(always)]
fn share<F: Float>(column: &Column, place: F::U, u: F) -> F {
    let (low, high) = bounds::<F>(column, place);
    (u - low) / (high - low)
}

#[cfg(test)]
mod tests;
