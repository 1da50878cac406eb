//! Weights in the order in which workgroups read them, and what each layer tells its workgroups.

use crate::convolution::{Channels, Convolution, Then, taps};
use crate::network::{GRAPH, INPUTS, Network, PLACES, Place, read_shape, written_shape};
use crate::planes::Shape;

/// The side of the square of pixels that a workgroup makes ...
pub const TILE: usize = 16;
/// ... and of how many blocks of channels.
pub const BLOCKS_OF_A_GROUP: usize = 4;
/// Channels of a block.
const BLOCK: usize = 4;

/// A layer as the shader knows it.
#[derive(Debug, Clone, Copy, bytemuck::NoUninit)]
#[repr(C)]
pub struct Layer {
    /// Columns and rows that it goes over.
    pub size: [u32; 2],
    /// Blocks that it gives, ...
    pub outputs: u32,
    /// ... that it reads of a layer half as wide, ...
    pub doubled: u32,
    /// ... and of one as wide.
    pub plain: u32,
    /// 1 where of each 2 x 2 pixels the largest is stored.
    pub pools: u32,
    /// Where its kernels begin, ...
    pub kernels: u32,
    /// ... and its biases.
    pub biases: u32,
    /// The first row of tiles that a dispatch goes over, ...
    pub first: u32,
    /// ... and how many rows.
    pub rows: u32,
}

impl Layer {
    /// The same over all rows of tiles.
    pub fn whole(self) -> Self {
        Layer { first: 0, rows: self.size[1].div_ceil(TILE as u32), ..self }
    }

    /// Parts of at most so many operations, a row of tiles at least.
    pub fn slices(self, most_operations: f64) -> impl Iterator<Item = Layer> {
        let Layer { size: [columns, _], rows, .. } = self.whole();
        let of_row = self.operations() * f64::from(columns.next_multiple_of(TILE as u32)) * TILE as f64;
        let most = ((most_operations / of_row) as u32).max(1);
        (0..rows).step_by(most as usize).map(move |first| Layer { first, rows: most.min(rows - first), ..self })
    }

    /// Groups of blocks, the last one padded.
    pub fn groups(&self) -> u32 {
        self.outputs.div_ceil(BLOCKS_OF_A_GROUP as u32)
    }

    /// Multiplications and additions for each pixel, those of channels that pad a block included.
    pub fn operations(&self) -> f64 {
        let inputs = 4 * self.doubled + 9 * self.plain;
        f64::from(2 * inputs * self.outputs) * (BLOCK * BLOCK) as f64
    }
}

/// The layers of a network, over no pixels so far, and kernels and biases of all of them, one after the other.
pub fn packed(network: &Network) -> (Vec<Layer>, Vec<[f32; BLOCK]>) {
    let mut weights = Vec::new();
    let layers = GRAPH.iter().zip(&network.layers).map(|(row, convolution)| {
        let blocks = |doubled| {
            let of = convolution.inputs().iter().filter(|input| input.doubled == doubled);
            of.map(|input| input.count.div_ceil(BLOCK)).sum::<usize>() as u32
        };
        let mut layer = Layer {
            size: [0, 0],
            outputs: convolution.outputs.div_ceil(BLOCK) as u32,
            doubled: blocks(true),
            plain: blocks(false),
            pools: u32::from(row.then == Then::Pool),
            kernels: weights.len() as u32,
            biases: 0,
            first: 0,
            rows: 0,
        };
        for group in 0..layer.groups() as usize {
            add_kernels(convolution, group, &mut weights);
        }
        layer.biases = weights.len() as u32;
        let of_all = 0..layer.groups() as usize * BLOCKS_OF_A_GROUP;
        weights.extend(of_all.map(|block| four(|lane| convolution.bias(block * BLOCK + lane))));
        layer
    });
    (layers.collect(), weights)
}

/// For each block of inputs, each block of a group's outputs, each tap and each input channel: a block of weights.
fn add_kernels(convolution: &Convolution, group: usize, weights: &mut Vec<[f32; BLOCK]>) {
    for (read, &Channels { count, doubled }) in convolution.inputs().iter().enumerate() {
        for input in (0..count.next_multiple_of(BLOCK)).step_by(BLOCK) {
            for output in (0..BLOCKS_OF_A_GROUP).map(|block| (group * BLOCKS_OF_A_GROUP + block) * BLOCK) {
                for (tap, channel) in (0..taps(doubled)).flat_map(|tap| (0..BLOCK).map(move |i| (tap, input + i))) {
                    weights.push(four(|lane| convolution.weight(read, channel, tap, output + lane)));
                }
            }
        }
    }
}

fn four(value: impl Fn(usize) -> f32) -> [f32; BLOCK] {
    std::array::from_fn(value)
}

/// Blocks of values that each place has to hold for an input of this size, and the layers with their sizes.
pub fn sized(layers: &[Layer], [width, height]: [usize; 2]) -> ([u64; PLACES], Vec<Layer>) {
    let mut at = [Shape::default(); PLACES];
    let mut most = [0; PLACES];
    let mut hold = |at: &mut [Shape; PLACES], place: Place, shape: Shape| {
        at[place as usize] = shape;
        let blocks = shape.channels.div_ceil(BLOCK) * shape.width * shape.height;
        most[place as usize] = most[place as usize].max(blocks as u64);
    };
    hold(&mut at, Place::Input, Shape { channels: INPUTS, width, height });
    let sized = GRAPH.iter().zip(layers).map(|(row, layer)| {
        let read = read_shape(row, &at);
        hold(&mut at, row.writes, written_shape(row, read, layer.outputs as usize * BLOCK));
        Layer { size: [read.width as u32, read.height as u32], ..*layer }
    });
    let sized = sized.collect();
    (most, sized)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_all_rows_of_tiles_once_and_none_has_more_than_it_may() {
        let network = Network::small().unwrap();
        let (layers, _) = packed(&network);
        let (_, layers) = sized(&layers, [1920, 1088]);
        for layer in layers {
            for most in [1e3, 1e9, 8e9, 1e12] {
                let slices: Vec<Layer> = layer.slices(most).collect();
                let mut next = 0;
                for slice in &slices {
                    assert_eq!(slice.first, next);
                    next += slice.rows;
                    let operations = layer.operations() * f64::from(layer.size[0] * slice.rows * TILE as u32);
                    assert!(slice.rows == 1 || operations <= most, "{operations} of {most}");
                }
                assert_eq!(next, layer.whole().rows);
            }
        }
    }
}
