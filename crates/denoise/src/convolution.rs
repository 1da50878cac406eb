//! Convolutions of 3 x 3 with a bias and without what is negative (ReLU), over blocks of channels. A lane is an output
//! channel: a tile of neighbouring pixels and two vectors of outputs stay in registers while one input channel after the
//! other is added to all of them, so that each weight that is fetched serves a row of pixels and each input two vectors.
//! Input channels come from one or two layers; one that was halved before is read as if each of its pixels stood for four
//! (nearest upsampling), with the kernel's weights summed where they meet the same one: 4 products instead of 9.
//!
//! Sums are fused where lanes can: another width rounds otherwise, and a picture differs in its last bits. On
//! the device: `shaders/denoise/unet/convolution.wgsl`, layer.wgsl.

use crate::Stop;
use crate::planes::{BLOCK, Pixel, Planes, Shape, strips};
use crate::tza::Tensor;
use rayon::prelude::*;
use simd::{Float, Kernel, Lanes};
use std::array::from_fn;

/// Pixels of a tile: with two vectors of outputs they fill the 32 registers of AVX-512, or the 16 of others.
const WIDE_TILE: usize = 12;
const TILE: usize = 6;

/// Rows of a strip, the work of one thread at a time.
const STRIP: usize = 4;

/// Places of a kernel.
pub const TAPS: usize = 9;
/// Sums of them where a layer is doubled.
pub const TAPS_OF_DOUBLED: usize = 16;

/// What becomes of the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Then {
    /// Each value is stored as it is.
    Keep,
    /// Of each 2 x 2 pixels the largest is stored.
    Pool,
}

/// Channels of a layer that a convolution reads.
#[derive(Debug, Clone, Copy)]
pub struct Channels {
    /// How many there are, without those that pad a block.
    pub count: usize,
    /// Whether each pixel stands for four.
    pub doubled: bool,
}

/// Weights in the order in which a tile needs them: for each block of outputs, for each block of inputs, row and column
/// of the kernel and input channel, the weights of the outputs side by side. Channels that pad a block have zeros.
#[derive(Debug)]
pub struct Convolution {
    /// How many channels it gives.
    pub outputs: usize,
    inputs: Vec<Channels>,
    bias: Vec<Pixel>,
    weights: Vec<Vec<Pixel>>,
}

impl Convolution {
    /// Of a kernel whose inputs are the channels of these layers, one behind the other. `None` if the tensors are no
    /// kernel of 3 x 3 of so many channels and its bias.
    pub fn new(kernel: &Tensor, bias: &Tensor, inputs: &[Channels]) -> Option<Self> {
        let [outputs, of_kernel, 3, 3] = *kernel.dimensions else { return None };
        if of_kernel != inputs.iter().map(|input| input.count).sum::<usize>() || bias.dimensions != [outputs] {
            return None;
        }
        let weight = |output: usize, Taps { input, places }: &Taps| {
            let of = |place: &usize| kernel.values[(output * of_kernel + input) * 9 + place];
            if output < outputs { places.iter().map(of).sum() } else { 0.0 }
        };
        let order = order(inputs);
        let blocks = (0..outputs.div_ceil(BLOCK)).map(|block| block * BLOCK);
        let of_block = |first: usize| order.iter().map(|taps| from_fn(|lane| weight(first + lane, taps))).collect();
        let bias_of_block = |first: usize| from_fn(|lane| bias.values.get(first + lane).copied().unwrap_or(0.0));
        let (weights, bias) = (blocks.clone().map(of_block).collect(), blocks.map(bias_of_block).collect());
        Some(Convolution { outputs, inputs: inputs.to_vec(), bias, weights })
    }

    /// The channels that it reads, place by place.
    pub fn inputs(&self) -> &[Channels] {
        &self.inputs
    }

    /// What an output begins with; 0 of one that pads a block.
    pub fn bias(&self, output: usize) -> f32 {
        self.bias.get(output / BLOCK).map_or(0.0, |block| block[output % BLOCK])
    }

    /// The weight of an input channel of one of the layers, at a tap: a place of the kernel, or of a layer that is doubled
    /// a sum of those that come to lie on one pixel, for row and column even or odd. 0 of channels that pad a block.
    pub fn weight(&self, layer: usize, channel: usize, tap: usize, output: usize) -> f32 {
        let Channels { count, doubled } = self.inputs[layer];
        let (Some(weights), true) = (self.weights.get(output / BLOCK), channel < count) else { return 0.0 };
        let before: usize = self.inputs[..layer].iter().map(|input| input.count * taps(input.doubled)).sum();
        let first = channel / BLOCK * BLOCK;
        let block = BLOCK.min(count - first);
        weights[before + first * taps(doubled) + tap * block + channel - first][output % BLOCK]
    }

    /// Multiplications and additions for each pixel, those of channels that pad a block included.
    pub fn operations(&self) -> usize {
        let of = |input: &Channels| input.count * if input.doubled { 4 } else { 9 };
        2 * BLOCK * self.weights.len() * self.inputs.iter().map(of).sum::<usize>()
    }

    /// Fills `output`, which has its shape. Stops early if `stop` says so, and then leaves it as it is.
    pub fn run(&self, inputs: &[&Planes], then: Then, output: &mut Planes, lanes: Lanes, stop: Stop) {
        let shape = output.shape;
        let tasks = self.tasks(output, lanes);
        tasks.into_par_iter().for_each(|(block, first_row, planes)| {
            if !stop() {
                lanes.run(Strip { layer: self, inputs, then, shape, block, first_row, planes });
            }
        });
    }

    /// Strips of the output, of as many blocks as two vectors fill: the first block, the first row, and its rows.
    fn tasks<'p>(&self, output: &'p mut Planes, lanes: Lanes) -> Vec<(usize, usize, Vec<&'p mut [Pixel]>)> {
        let shape = output.shape;
        let together = (2 * lanes.count()).div_ceil(BLOCK);
        let mut tasks = Vec::new();
        for (block, plane) in output.planes_mut().enumerate() {
            let strips = strips(plane, shape, STRIP);
            if block % together == 0 {
                tasks.push(Vec::new());
            }
            let of_group: &mut Vec<(usize, usize, Vec<&mut [Pixel]>)> = match tasks.last_mut() {
                Some(of_group) => of_group,
                None => continue,
            };
            for (index, rows) in strips.enumerate() {
                match of_group.get_mut(index) {
                    Some((_, _, planes)) => planes.push(rows),
                    None => of_group.push((block, index * STRIP, vec![rows])),
                }
            }
        }
        tasks.into_iter().flatten().collect()
    }
}

/// An input channel and the places of the kernel that meet the same pixel of it: one, or of a layer that is doubled those
/// that come to lie on one of its pixels.
struct Taps {
    input: usize,
    places: Vec<usize>,
}

/// Rows, or columns, of the kernel that come to lie on the first and on the second pixel of a doubled layer, at an even
/// and at an odd row.
const DOUBLED: [[&[usize]; 2]; 2] = [[&[0], &[1, 2]], [&[0, 1], &[2]]];

/// What comes one after the other.
fn order(inputs: &[Channels]) -> Vec<Taps> {
    let mut order = Vec::new();
    let mut first = 0;
    for &Channels { count, doubled } in inputs {
        for block in (first..first + count).step_by(BLOCK) {
            let block = block..(block + BLOCK).min(first + count);
            let places = if doubled { places_of_doubled() } else { (0..9).map(|place| vec![place]).collect() };
            order.extend(
                places
                    .into_iter()
                    .flat_map(|places| block.clone().map(move |input| Taps { input, places: places.clone() })),
            );
        }
        first += count;
    }
    order
}

/// How many weights an input channel has for each output.
pub const fn taps(doubled: bool) -> usize {
    if doubled { TAPS_OF_DOUBLED } else { TAPS }
}

/// For even and odd rows, each of the two rows that they see, the left and the right column, even and odd columns.
fn places_of_doubled() -> Vec<Vec<usize>> {
    let mut order = Vec::new();
    for rows in DOUBLED.iter().flatten() {
        for side in 0..2 {
            for of_parity in DOUBLED {
                let columns = of_parity[side];
                order.push(rows.iter().flat_map(|row| columns.iter().map(move |column| 3 * row + column)).collect());
            }
        }
    }
    order
}

/// Some rows of some blocks of a layer's output.
struct Strip<'a, 'p> {
    layer: &'a Convolution,
    inputs: &'a [&'a Planes],
    then: Then,
    shape: Shape,
    block: usize,
    first_row: usize,
    planes: Vec<&'p mut [Pixel]>,
}

impl Kernel for Strip<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Float>(mut self) {
        let two_vectors = self.planes.len() * BLOCK >= 2 * F::LANES;
        match (F::LANES == BLOCK, two_vectors) {
            (true, true) => self.fill::<F, WIDE_TILE, 2>(),
            (true, false) => self.fill::<F, WIDE_TILE, 1>(),
            (false, _) => self.fill::<F, TILE, 2>(),
        }
    }
}

impl Strip<'_, '_> {
    #[inline(always)]
    fn fill<F: Float, const P: usize, const V: usize>(&mut self) {
        let rows = self.planes[0].len() / self.shape.stride();
        for row in 0..rows {
            for channel in (0..self.planes.len() * BLOCK).step_by(V * F::LANES) {
                match self.then {
                    Then::Keep => self.keep::<F, P, V>(row, channel),
                    Then::Pool => self.pool::<F, P, V>(row, channel),
                }
            }
        }
    }

    #[inline(always)]
    fn keep<F: Float, const P: usize, const V: usize>(&mut self, row: usize, channel: usize) {
        let zero = F::splat(0.0);
        for x in (0..self.shape.width).step_by(P) {
            let tile = self.tile::<F, P, V>(x, self.first_row + row, channel);
            for (v, sums) in tile.iter().enumerate() {
                for (p, sum) in sums.iter().enumerate().take(self.shape.width - x) {
                    self.store(sum.max(zero), x + p, row, channel + v * F::LANES);
                }
            }
        }
    }

    /// Tiles are even, so that pixels that are pooled are in one. ReLU of the largest is the largest after ReLU.
    #[inline(always)]
    fn pool<F: Float, const P: usize, const V: usize>(&mut self, row: usize, channel: usize) {
        let zero = F::splat(0.0);
        for x in (0..2 * self.shape.width).step_by(P) {
            let y = 2 * (self.first_row + row);
            let above = self.tile::<F, P, V>(x, y, channel);
            let below = self.tile::<F, P, V>(x, y + 1, channel);
            for (v, (above, below)) in above.iter().zip(&below).enumerate() {
                for p in 0..(P / 2).min(self.shape.width - x / 2) {
                    let [above, below] = [above, below].map(|row| row[2 * p].max(row[2 * p + 1]));
                    self.store(above.max(below).max(zero), x / 2 + p, row, channel + v * F::LANES);
                }
            }
        }
    }

    #[inline(always)]
    fn store<F: Float>(&mut self, value: F, x: usize, row: usize, channel: usize) {
        let pixel = &mut self.planes[channel / BLOCK][row * self.shape.stride() + x + 1];
        value.store(&mut pixel[channel % BLOCK..]);
    }

    /// `P` pixels from column `x`, of `V` vectors of outputs from a channel of this strip's blocks.
    #[inline(always)]
    fn tile<F: Float, const P: usize, const V: usize>(&self, x: usize, y: usize, channel: usize) -> [[F; P]; V] {
        let mut sums = [[F::splat(0.0); P]; V];
        let mut weights = [Weights { lane: 0, rest: &[] }; V];
        for (v, (sums, weights)) in sums.iter_mut().zip(&mut weights).enumerate() {
            let channel = self.block * BLOCK + channel + v * F::LANES;
            let (block, lane) = (channel / BLOCK, channel % BLOCK);
            *sums = [F::load(&self.layer.bias[block][lane..]); P];
            *weights = Weights { lane, rest: &self.layer.weights[block] };
        }
        for (input, &Channels { count, doubled }) in self.inputs.iter().zip(&self.layer.inputs) {
            for block in 0..count.div_ceil(BLOCK) {
                let (plane, stride) = (input.starting_at(block), input.shape.stride());
                let used = BLOCK.min(count - block * BLOCK);
                if doubled {
                    add_doubled::<F, P, V>(&mut sums, (plane, stride), (x, y), &mut weights, used);
                } else {
                    add::<F, P, V>(&mut sums, (plane, stride), (x, y), &mut weights, used);
                }
            }
        }
        sums
    }
}

/// Weights that are still to come, of a vector of outputs that begins at a lane of its block.
#[derive(Clone, Copy)]
struct Weights<'a> {
    lane: usize,
    rest: &'a [Pixel],
}

/// Adds what the kernel makes of a block of inputs. Rows and columns count from those of the border.
#[inline(always)]
fn add<F: Float, const P: usize, const V: usize>(
    sums: &mut [[F; P]; V],
    (plane, stride): (&[Pixel], usize),
    (x, y): (usize, usize),
    weights: &mut [Weights; V],
    used: usize,
) {
    for y in y..y + 3 {
        let row = &plane[y * stride + x..][..P + 2];
        add_column::<F, P, V, 0>(sums, row, weights, used);
        add_column::<F, P, V, 1>(sums, row, weights, used);
        add_column::<F, P, V, 2>(sums, row, weights, used);
    }
}

/// One place of the kernel: the column is a constant, so that the pixels' places are.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "it goes over weights and pixels alike")]
fn add_column<F: Float, const P: usize, const V: usize, const COLUMN: usize>(
    sums: &mut [[F; P]; V],
    row: &[Pixel],
    weights: &mut [Weights; V],
    used: usize,
) {
    let row = &row[..P + 2];
    let these = next(weights, used);
    for input in 0..used {
        let weight = loaded::<F, V>(&these, weights, input);
        for p in 0..P {
            let value = F::splat(row[p + COLUMN][input]);
            for (sums, weight) in sums.iter_mut().zip(weight) {
                sums[p] = value.mul_add(weight, sums[p]);
            }
        }
    }
}

/// As [`add`], of a layer whose pixels stand for four: of the nine that the kernel covers no more than four differ, and
/// which of its weights they share depends on row and column being even or odd. `x` is even.
#[inline(always)]
fn add_doubled<F: Float, const P: usize, const V: usize>(
    sums: &mut [[F; P]; V],
    (plane, stride): (&[Pixel], usize),
    (x, y): (usize, usize),
    weights: &mut [Weights; V],
    used: usize,
) {
    let of_a_parity = 8 * used;
    next(weights, of_a_parity * (y % 2));
    for y in [y.div_ceil(2), y.div_ceil(2) + 1] {
        let row = &plane[y * stride + x / 2..][..P / 2 + 2];
        add_side::<F, P, V, 0>(sums, row, weights, used);
        add_side::<F, P, V, 1>(sums, row, weights, used);
    }
    next(weights, of_a_parity * (1 - y % 2));
}

/// The left or the right one of the two pixels that each pixel sees in a row.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "it goes over weights and pixels alike")]
fn add_side<F: Float, const P: usize, const V: usize, const SIDE: usize>(
    sums: &mut [[F; P]; V],
    row: &[Pixel],
    weights: &mut [Weights; V],
    used: usize,
) {
    let row = &row[..P / 2 + 2];
    let (of_even, of_odd) = (next(weights, used), next(weights, used));
    for input in 0..used {
        let (of_even, of_odd) = (loaded::<F, V>(&of_even, weights, input), loaded::<F, V>(&of_odd, weights, input));
        for p in 0..P {
            let value = F::splat(row[p.div_ceil(2) + SIDE][input]);
            for (sums, weight) in sums.iter_mut().zip(if p % 2 == 0 { of_even } else { of_odd }) {
                sums[p] = value.mul_add(weight, sums[p]);
            }
        }
    }
}

/// The next `count` weights of each vector.
#[inline(always)]
fn next<'a, const V: usize>(weights: &mut [Weights<'a>; V], count: usize) -> [&'a [Pixel]; V] {
    let mut these: [&[Pixel]; V] = [&[]; V];
    for (these, weights) in these.iter_mut().zip(weights) {
        (*these, weights.rest) = weights.rest.split_at(count);
    }
    these
}

/// Those of an input channel.
#[inline(always)]
fn loaded<F: Float, const V: usize>(these: &[&[Pixel]; V], weights: &[Weights; V], input: usize) -> [F; V] {
    let mut loaded = [F::splat(0.0); V];
    for (loaded, (these, Weights { lane, .. })) in loaded.iter_mut().zip(these.iter().zip(weights)) {
        *loaded = F::load(&these[input][*lane..]);
    }
    loaded
}
