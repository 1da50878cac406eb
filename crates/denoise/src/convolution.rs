//! Convolutions of 3 x 3 with a bias and without what is negative (ReLU), over blocks of channels. A lane is an output
//! channel: a tile of neighbouring pixels and two vectors of outputs stay in registers while one input channel after the
//! other is added to all of them, so that each weight that is fetched serves a row of pixels and each input two vectors.
//! Input channels come from one or two layers; one that was halved before is read as if each of its pixels were four.
//!
//! Sums are fused where lanes can: another width rounds otherwise, and a picture differs in its last bits.

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

/// A layer whose output a convolution reads.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    /// Its values.
    pub planes: &'a Planes,
    /// Whether each of its pixels stands for four (nearest upsampling).
    pub doubled: bool,
}

/// What becomes of the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Then {
    /// It is stored.
    Keep,
    /// Of each 2 x 2 pixels the largest is stored.
    Pool,
}

/// Weights in the order in which a tile needs them: for each block of outputs, for each block of inputs, row and column
/// of the kernel and input channel, the weights of the outputs side by side. Channels that pad a block have zeros.
#[derive(Debug)]
pub struct Convolution {
    /// How many channels it gives.
    pub outputs: usize,
    /// How many channels of each layer it reads.
    inputs: Vec<usize>,
    bias: Vec<Pixel>,
    weights: Vec<Vec<Pixel>>,
}

impl Convolution {
    /// Of a kernel whose inputs are the channels of these layers, one behind the other. `None` if the tensors are no
    /// kernel of 3 x 3 of so many channels and its bias.
    pub fn new(kernel: &Tensor, bias: &Tensor, inputs: &[usize]) -> Option<Self> {
        let [outputs, of_kernel, 3, 3] = *kernel.dimensions else { return None };
        if of_kernel != inputs.iter().sum::<usize>() || bias.dimensions != [outputs] {
            return None;
        }
        let weight = |output: usize, input: usize, place: usize| {
            if output < outputs { kernel.values[(output * of_kernel + input) * 9 + place] } else { 0.0 }
        };
        let order = order(inputs);
        let blocks = (0..outputs.div_ceil(BLOCK)).map(|block| block * BLOCK);
        let weights = blocks.clone().map(|first| {
            order.iter().map(|&(input, place)| from_fn(|lane| weight(first + lane, input, place))).collect()
        });
        let bias = blocks.clone().map(|first| from_fn(|lane| bias.values.get(first + lane).copied().unwrap_or(0.0)));
        Some(Convolution { outputs, inputs: inputs.to_vec(), bias: bias.collect(), weights: weights.collect() })
    }

    /// Multiplications and additions for each pixel, those of channels that pad a block included.
    pub fn operations(&self) -> usize {
        2 * BLOCK * self.weights.iter().map(Vec::len).sum::<usize>()
    }

    /// Fills `output`, which has its shape. Stops early if `stop` says so, and then leaves it as it is.
    pub fn run(&self, inputs: &[Input], then: Then, output: &mut Planes, lanes: Lanes, stop: Stop) {
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

/// Which input channel and which place of the kernel come one after the other.
fn order(inputs: &[usize]) -> Vec<(usize, usize)> {
    let mut order = Vec::new();
    let mut first = 0;
    for &channels in inputs {
        for block in (first..first + channels).step_by(BLOCK) {
            let block = block..(block + BLOCK).min(first + channels);
            order.extend((0..9).flat_map(|place| block.clone().map(move |input| (input, place))));
        }
        first += channels;
    }
    order
}

/// Some rows of some blocks of a layer's output.
struct Strip<'a, 'p> {
    layer: &'a Convolution,
    inputs: &'a [Input<'a>],
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
        for (input, &channels) in self.inputs.iter().zip(&self.layer.inputs) {
            let stride = input.planes.shape.stride();
            for block in 0..channels.div_ceil(BLOCK) {
                let plane = input.planes.starting_at(block);
                let used = BLOCK.min(channels - block * BLOCK);
                for y in y..y + 3 {
                    if input.doubled {
                        // rows and columns of the border included, and of what is doubled the border twice
                        let row = &plane[y.div_ceil(2) * stride + x / 2..][..P / 2 + 2];
                        add_row::<F, P, V, true>(&mut sums, row, &mut weights, used);
                    } else {
                        add_row::<F, P, V, false>(&mut sums, &plane[y * stride + x..][..P + 2], &mut weights, used);
                    }
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

/// Adds what a row of the kernel makes of a row of pixels, which begins one to the left of the tile.
#[inline(always)]
fn add_row<F: Float, const P: usize, const V: usize, const DOUBLED: bool>(
    sums: &mut [[F; P]; V],
    row: &[Pixel],
    weights: &mut [Weights; V],
    used: usize,
) {
    add_column::<F, P, V, DOUBLED, 0>(sums, row, weights, used);
    add_column::<F, P, V, DOUBLED, 1>(sums, row, weights, used);
    add_column::<F, P, V, DOUBLED, 2>(sums, row, weights, used);
}

/// One place of the kernel: the column is a constant, so that the pixels' places are.
#[inline(always)]
fn add_column<F: Float, const P: usize, const V: usize, const DOUBLED: bool, const COLUMN: usize>(
    sums: &mut [[F; P]; V],
    row: &[Pixel],
    weights: &mut [Weights; V],
    used: usize,
) {
    let row = &row[..if DOUBLED { P / 2 + 2 } else { P + 2 }];
    let mut these: [&[Pixel]; V] = [&[]; V];
    for (these, weights) in these.iter_mut().zip(weights.iter_mut()) {
        (*these, weights.rest) = weights.rest.split_at(used);
    }
    for input in 0..used {
        let mut of_input = [F::splat(0.0); V];
        for (weight, (these, Weights { lane, .. })) in of_input.iter_mut().zip(these.iter().zip(weights.iter())) {
            *weight = F::load(&these[input][*lane..]);
        }
        for p in 0..P {
            let place = if DOUBLED { (p + COLUMN).div_ceil(2) } else { p + COLUMN };
            let value = F::splat(row[place][input]);
            for (sums, weight) in sums.iter_mut().zip(of_input) {
                sums[p] = value.mul_add(weight, sums[p]);
            }
        }
    }
}
