//! Values of pixels as lanes read them: numbers of one kind side by side in a row, with a margin at both ends in which
//! nothing is like anything.
//!
//! Twins: `shaders/denoise/a_trous/picture.wgsl`, `prepare.wgsl`.

use crate::Features;
use crate::transfer::sanitized;
use film::Vec3;
use rayon::prelude::*;
use simd::MOST_LANES;

/// As far as the taps of the last level reach.
pub const MARGIN: usize = 32;

/// Kinds of numbers of what guides: the normal, whether nothing was hit, depth and its slopes, and the albedo.
pub const NORMAL: [usize; 3] = [0, 1, 2];
pub const MISS: usize = 3;
pub const DEPTH: usize = 4;
pub const SLOPES: [usize; 2] = [5, 6];
pub const ALBEDO: [usize; 3] = [7, 8, 9];
const GUIDES: usize = 10;

/// Kinds of numbers of light: red, green, blue, and the variance of the luminance.
pub const RGB: [usize; 3] = [0, 1, 2];
pub const VARIANCE: usize = 3;
const LIGHT: usize = 4;

/// Rows of `KINDS` numbers of each pixel.
#[derive(Debug, Clone)]
pub struct Table<const KINDS: usize> {
    pub width: usize,
    pub height: usize,
    stride: usize,
    values: Vec<f32>,
}

pub type Guides = Table<GUIDES>;
pub type Light = Table<LIGHT>;

/// Numbers of one kind in a row, with its margins.
fn stride(width: usize) -> usize {
    width.next_multiple_of(MOST_LANES) + 2 * MARGIN
}

impl<const KINDS: usize> Table<KINDS> {
    fn filled([width, height]: [usize; 2], of: impl Fn(usize) -> [f32; KINDS] + Sync) -> Self {
        let stride = stride(width);
        let mut values = vec![0.0; stride * KINDS * height];
        values.par_chunks_mut(stride * KINDS).enumerate().for_each(|(y, row)| {
            for x in 0..width {
                for (kind, value) in of(y * width + x).into_iter().enumerate() {
                    row[kind * stride + MARGIN + x] = value;
                }
            }
        });
        Table { width, height, stride, values }
    }

    /// Bytes that a table of this size takes.
    pub fn memory([width, height]: [usize; 2]) -> usize {
        size_of::<f32>() * stride(width) * KINDS * height
    }

    /// Numbers of one kind in a row, from the beginning of its margin.
    #[inline(always)]
    pub fn row(&self, y: usize, kind: usize) -> &[f32] {
        &self.values[(y * KINDS + kind) * self.stride..][..self.stride]
    }

    /// Numbers of all kinds of a row.
    pub fn row_length(&self) -> usize {
        self.stride * KINDS
    }

    /// Numbers of one kind from one row to the same of the next kind.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// All rows, to be filled.
    pub fn rows_mut(&mut self, length: usize) -> impl IndexedParallelIterator<Item = &mut [f32]> {
        self.values.par_chunks_mut(length)
    }
}

impl Guides {
    /// Depth and normals need not be finite; albedos above 1 guide as 1 does.
    pub fn new(size: [usize; 2], features: Features, depths: &[f32]) -> Self {
        let hit = |pixel: usize| features.normal[pixel].try_normalize();
        let depth = |pixel: usize| if hit(pixel).is_some() && depths[pixel].is_finite() { depths[pixel] } else { 0.0 };
        let width = size[0];
        Table::filled(size, |pixel| {
            let normal = hit(pixel).unwrap_or(Vec3::ZERO);
            let (x, y) = (pixel % width, pixel / width);
            let across = slope(depth, pixel, 1, x > 0, x + 1 < width);
            let down = slope(depth, pixel, width, y > 0, y + 1 < size[1]);
            let missed = f32::from(u8::from(hit(pixel).is_none()));
            let albedo = sanitized(features.albedo[pixel]).min(Vec3::ONE);
            let [r, g, b] = albedo.to_array();
            [normal.x, normal.y, normal.z, missed, depth(pixel), across, down, r, g, b]
        })
    }
}

/// The flatter of the slopes to both sides: the other may be that of an edge.
fn slope(depth: impl Fn(usize) -> f32, pixel: usize, step: usize, before: bool, behind: bool) -> f32 {
    let to = |other: usize| (depth(other) - depth(pixel)).abs();
    match (before, behind) {
        (true, true) => to(pixel - step).min(to(pixel + step)),
        (true, false) => to(pixel - step),
        (false, true) => to(pixel + step),
        (false, false) => 0.0,
    }
}

impl Light {
    /// Of what a pixel has, and its luminance' variance.
    pub fn new(size: [usize; 2], of: impl Fn(usize) -> (Vec3, f32) + Sync) -> Self {
        Table::filled(size, |pixel| {
            let (Vec3 { x, y, z }, variance) = of(pixel);
            [x, y, z, variance]
        })
    }

    /// Puts the variance of the first and the last pixel of each row beside them, for a mean over neighbours.
    pub fn repeat_the_edges(&mut self) {
        let (stride, width) = (self.stride, self.width);
        self.values.par_chunks_mut(stride * LIGHT).for_each(|row| {
            let variance = &mut row[VARIANCE * stride..];
            variance[MARGIN - 1] = variance[MARGIN];
            variance[MARGIN + width] = variance[MARGIN + width - 1];
        });
    }

    /// Red, green and blue of all pixels.
    pub fn pixels(&self) -> impl Iterator<Item = Vec3> {
        (0..self.height).flat_map(move |y| {
            let rgb = RGB.map(|kind| &self.row(y, kind)[MARGIN..]);
            (0..self.width).map(move |x| Vec3::from_array(rgb.map(|row| row[x])))
        })
    }
}
