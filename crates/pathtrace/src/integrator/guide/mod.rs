//! A guide: where indirect light comes from, learned from some paths before the picture's own.
//!
//! Each cell of the surfaces ([`cells`]) has a histogram over the unit square that the cosine warp takes: bins of equal
//! share of a diffuse surface's view. A direction is drawn by bending the two random numbers of the warp, row first and
//! then column, so that samples which keep apart still do. Bins weigh as the root mean square of the radiance that came
//! from there (Vorba et al., "Path Guiding in Production", SIGGRAPH courses 2019, on why not the mean), and a fifth of all
//! directions stays cosine-weighted, so that nothing is lost and no weight exceeds five.
//!
//! The mean radiance of a cell is kept too: what roulette takes away is known on average, and added back.
//!
//! On the processor alone; no twin.

pub mod cells;
pub mod guidance;
pub mod guides;
pub mod histogram;
pub mod training;

use crate::integrator::roulette::STEPS;
use crate::sampling::warp::{angle_of_upper, orthonormal_basis};
use crate::vectors::VectorColumn;
use cells::Cells;
use histogram::{BINS, COLUMNS, ROWS};
use simd::{Column, Float, Vector, Word};
use std::f32::consts::{FRAC_1_PI, TAU};

/// What was learned, as lanes look it up.
#[derive(Debug)]
pub struct Guide {
    cells: Cells,
    /// Of each row of each cell: the share of this row and of those before.
    rows: Column,
    /// Of each column of each row: the share in its row of this column and of those before.
    columns: Column,
    /// Mean indirect radiance that a cell sees, weighted by the cosine.
    radiance: VectorColumn,
}

/// How a guide bends a cell's random numbers.
#[derive(Debug, Clone, Copy)]
pub struct Bent<F> {
    /// The numbers for the cosine warp.
    pub u: [F; 2],
    /// How many times as dense as without a guide.
    pub ratio: F,
}

impl Guide {
    /// The cell of a surface's point, by its normal on the side that the path came from.
    #[inline(always)]
    pub fn cell<F: Float>(&self, position: Vector<F>, normal: Vector<F>) -> F::U {
        self.cells.of(position, normal)
    }

    /// Mean indirect radiance in a cell.
    #[inline(always)]
    pub fn radiance<F: Float>(&self, cell: F::U) -> Vector<F> {
        self.radiance.look_up(cell)
    }

    /// Bends two uniform numbers towards where light comes from.
    #[inline(always)]
    pub fn bend<F: Float>(&self, cell: F::U, u: [F; 2]) -> Bent<F> {
        let (row, y, row_ratio) = find::<F, ROWS>(&self.rows, cell.wrapping_mul(F::U::splat(ROWS)), u[0]);
        let line = cell.wrapping_mul(F::U::splat(ROWS)).wrapping_add(row);
        let (_, x, column_ratio) = find::<F, COLUMNS>(&self.columns, line.wrapping_mul(F::U::splat(COLUMNS)), u[1]);
        Bent { u: [y, x], ratio: row_ratio * column_ratio }
    }

    /// How many times as dense as without a guide directions are drawn around the unit vector `wi`.
    #[inline(always)]
    pub fn ratio<F: Float>(&self, cell: F::U, normal: Vector<F>, wi: Vector<F>) -> F {
        let [y, x] = unwarped(normal, wi);
        let row = bin::<F, ROWS>(y);
        let line = cell.wrapping_mul(F::U::splat(ROWS)).wrapping_add(row);
        let place = line.wrapping_mul(F::U::splat(COLUMNS)).wrapping_add(bin::<F, COLUMNS>(x));
        let of_row: F = share(&self.rows, line, row);
        let of_column: F = share(&self.columns, place, bin::<F, COLUMNS>(x));
        of_row * of_column * BINS as f32
    }
}

/// The interval of eight that `u` falls into, by the intervals' ends from `base` on; where in the eight `u` comes to lie
/// when all become equally wide; and how many times as wide as an eighth the interval is.
#[inline(always)]
fn find<F: Float, const N: u32>(ends: &Column, base: F::U, u: F) -> (F::U, F, F) {
    const { assert!(N == 8, "three questions") };
    let (mut lower, mut upper) = (F::splat(0.0), F::splat(1.0));
    let mut found = F::U::splat(0);
    for half in [4, 2, 1] {
        let middle = base.wrapping_add(found).wrapping_add(F::U::splat(half - 1)).look_up(ends);
        let above = u.ge(middle);
        lower = F::select(above, middle, lower);
        upper = F::select(above, upper, middle);
        found = F::U::select(above, found.wrapping_add(F::U::splat(half)), found);
    }
    let width = upper - lower;
    // rounding may reach the end of the interval, and of all
    let inside = ((u - lower) / width).min(F::splat(1.0 - 1.0 / STEPS));
    let eighth = 1.0 / N as f32;
    (found, ((found.to_float() + inside) * eighth).min(F::splat(1.0 - 1.0 / STEPS)), width * N as f32)
}

/// The share of the interval at a place whose number among those of its list is `number`.
#[inline(always)]
fn share<F: Float>(ends: &Column, place: F::U, number: F::U) -> F {
    let before = place.wrapping_sub(F::U::splat(1)).look_up(ends);
    let first = number.eq(F::U::splat(0));
    place.look_up(ends) - F::select(first, F::splat(0.0), before)
}

/// Which of `N` intervals of the same width a number from 0 to 1 falls into.
#[inline(always)]
fn bin<F: Float, const N: u32>(u: F) -> F::U {
    (u * N as f32).clamp(F::splat(0.0), F::splat(N as f32 - 1.0)).floor().to_word()
}

/// The numbers from which [`cosine_hemisphere`](crate::sampling::warp::cosine_hemisphere) makes `wi` around `normal`.
#[inline(always)]
fn unwarped<F: Float>(normal: Vector<F>, wi: Vector<F>) -> [F; 2] {
    let (s, t) = orthonormal_basis(normal);
    let (x, y, z) = (wi.dot(s), wi.dot(t), wi.dot(normal));
    let upper = angle_of_upper(y.abs(), x);
    let angle = F::select(y.lt(F::splat(0.0)), F::splat(TAU) - upper, upper);
    [F::splat(1.0) - z * z, angle * (0.5 * FRAC_1_PI)]
}

#[cfg(test)]
mod tests;
