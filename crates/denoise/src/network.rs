//! The U-Net of Open Image Denoise: an encoder of five levels, each half as wide as the one before, and a decoder back to
//! the first, which at each level reads what the encoder left there. The graph is a table; names are those of the weights.

use crate::Stop;
use crate::convolution::{Channels, Convolution, Then};
use crate::planes::{Planes, Shape};
use crate::tza::{self, Tensor, TzaError};
use simd::Lanes;

/// Channels of the input: colour, albedo and normal.
pub const INPUTS: usize = 9;
/// Channels of the output.
const OUTPUTS: usize = 3;
/// Sides of the input are multiples of this: of four halvings.
pub const ALIGNMENT: usize = 16;

/// Where values lie between layers: the input and what the decoder comes back to have places of their own, all else one
/// of two, from the one to the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    Input,
    Pool1,
    Pool2,
    Pool3,
    Ping,
    Pong,
}

pub(crate) const PLACES: usize = 6;

/// A row of the table.
pub(crate) struct Layer {
    pub name: &'static str,
    /// What it reads, and whether each pixel of that stands for four.
    pub reads: &'static [(Place, bool)],
    pub then: Then,
    pub writes: Place,
}

const fn layer(name: &'static str, reads: &'static [(Place, bool)], then: Then, writes: Place) -> Layer {
    Layer { name, reads, then, writes }
}

pub(crate) const GRAPH: [Layer; 16] = {
    use Place::{Input, Ping, Pong, Pool1, Pool2, Pool3};
    use Then::{Keep, Pool};
    [
        layer("enc_conv0", &[(Input, false)], Keep, Ping),
        layer("enc_conv1", &[(Ping, false)], Pool, Pool1),
        layer("enc_conv2", &[(Pool1, false)], Pool, Pool2),
        layer("enc_conv3", &[(Pool2, false)], Pool, Pool3),
        layer("enc_conv4", &[(Pool3, false)], Pool, Ping),
        layer("enc_conv5a", &[(Ping, false)], Keep, Pong),
        layer("enc_conv5b", &[(Pong, false)], Keep, Ping),
        layer("dec_conv4a", &[(Ping, true), (Pool3, false)], Keep, Pong),
        layer("dec_conv4b", &[(Pong, false)], Keep, Ping),
        layer("dec_conv3a", &[(Ping, true), (Pool2, false)], Keep, Pong),
        layer("dec_conv3b", &[(Pong, false)], Keep, Ping),
        layer("dec_conv2a", &[(Ping, true), (Pool1, false)], Keep, Pong),
        layer("dec_conv2b", &[(Pong, false)], Keep, Ping),
        layer("dec_conv1a", &[(Ping, true), (Input, false)], Keep, Pong),
        layer("dec_conv1b", &[(Pong, false)], Keep, Ping),
        layer("dec_conv0", &[(Ping, false)], Keep, Pong),
    ]
};

/// Where the last layer writes.
const OUTPUT: Place = Place::Pong;

/// Why weights make no network.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WeightsError {
    /// They cannot be read.
    #[error(transparent)]
    Archive(#[from] TzaError),
    /// A tensor is missing, or has other sides than its place in the network asks for.
    #[error("the weights are of another network: {0} is missing or has other sides")]
    OtherNetwork(String),
}

/// A network with its weights.
#[derive(Debug)]
pub struct Network {
    name: &'static str,
    hash: u128,
    pub(crate) layers: Vec<Convolution>,
}

impl Network {
    /// The small one: 320 035 weights. What Open Image Denoise takes where it is to be fast.
    ///
    /// # Errors
    /// None with the weights of this program.
    pub fn small() -> Result<Self, WeightsError> {
        let tza = include_bytes!("../../../assets/weights/rt_hdr_alb_nrm_small.tza");
        Self::from_tza("rt_hdr_alb_nrm_small", tza)
    }

    /// The larger one: 919 811 weights.
    ///
    /// # Errors
    /// None with the weights of this program.
    pub fn base() -> Result<Self, WeightsError> {
        Self::from_tza("rt_hdr_alb_nrm", include_bytes!("../../../assets/weights/rt_hdr_alb_nrm.tza"))
    }

    /// Of weights for HDR colour, albedo and normal, as they lie in an archive.
    ///
    /// # Errors
    /// [`WeightsError`], in one line.
    pub fn from_tza(name: &'static str, bytes: &[u8]) -> Result<Self, WeightsError> {
        let tensors = tza::read(bytes)?;
        let mut channels = [0; PLACES];
        channels[Place::Input as usize] = INPUTS;
        let mut layers = Vec::new();
        for layer in &GRAPH {
            let read = |&(place, doubled): &(Place, bool)| Channels { count: channels[place as usize], doubled };
            let inputs: Vec<Channels> = layer.reads.iter().map(read).collect();
            let convolution = convolution(&tensors, layer.name, &inputs)?;
            channels[layer.writes as usize] = convolution.outputs;
            layers.push(convolution);
        }
        if channels[OUTPUT as usize] != OUTPUTS {
            return Err(WeightsError::OtherNetwork("dec_conv0.weight".into()));
        }
        let mut half = [0; 16];
        half.copy_from_slice(&blake3::hash(bytes).as_bytes()[..16]);
        Ok(Network { name, hash: u128::from_be_bytes(half), layers })
    }

    /// As its makers call the weights.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The first half of blake3 of the weights' archive, in hexadecimal, for records.
    pub fn hash(&self) -> String {
        format!("{:032x}", self.hash)
    }

    /// Floating-point operations for each pixel, those of channels that pad a block included.
    pub fn operations_per_pixel(&self) -> f64 {
        let (_, levels) = self.shapes(Shape { channels: INPUTS, width: ALIGNMENT, height: ALIGNMENT });
        let pixels = levels.iter().map(|shape| (shape.width * shape.height) as f64);
        let sums = self.layers.iter().zip(pixels).map(|(layer, pixels)| layer.operations() as f64 * pixels);
        sums.sum::<f64>() / (ALIGNMENT * ALIGNMENT) as f64
    }

    /// The largest that each place has to hold, in pixels, and over how many pixels each layer goes.
    fn shapes(&self, input: Shape) -> ([usize; PLACES], Vec<Shape>) {
        let mut at = [Shape::default(); PLACES];
        at[Place::Input as usize] = input;
        let mut most = [0; PLACES];
        most[Place::Input as usize] = input.pixels();
        let mut over = Vec::new();
        for (layer, convolution) in GRAPH.iter().zip(&self.layers) {
            let read = read_shape(layer, &at);
            let written = written_shape(layer, read, convolution.outputs);
            over.push(read);
            at[layer.writes as usize] = written;
            most[layer.writes as usize] = most[layer.writes as usize].max(written.pixels());
        }
        (most, over)
    }

    /// Memory for inputs of this size and of any smaller one; `None` if there is not so much.
    pub(crate) fn memory(&self, width: usize, height: usize) -> Option<Memory> {
        let (pixels, _) = self.shapes(Shape { channels: INPUTS, width, height });
        let planes = pixels.into_iter().map(Planes::with_room_for).collect::<Option<Vec<_>>>()?;
        Some(Memory { planes })
    }

    /// Bytes of that memory.
    pub(crate) fn memory_size(&self, width: usize, height: usize) -> usize {
        let (pixels, _) = self.shapes(Shape { channels: INPUTS, width, height });
        pixels.into_iter().sum::<usize>() * size_of::<crate::planes::Pixel>()
    }

    /// What the network says to the input that lies in `memory`. `None` if `stop` said so before it was done.
    pub(crate) fn run<'m>(&self, memory: &'m mut Memory, lanes: Lanes, stop: Stop) -> Option<&'m Planes> {
        for (layer, convolution) in GRAPH.iter().zip(&self.layers) {
            Self::step(layer, convolution, memory, lanes, stop);
            if stop() {
                return None;
            }
        }
        Some(memory.at(OUTPUT))
    }

    fn step(layer: &Layer, convolution: &Convolution, memory: &mut Memory, lanes: Lanes, stop: Stop) {
        let shape = written_shape(layer, read_shape(layer, &memory.shapes()), convolution.outputs);
        // a layer never reads where it writes
        let mut output = std::mem::take(memory.at(layer.writes));
        output.reshape(shape);
        let inputs: Vec<&Planes> = layer.reads.iter().map(|(place, _)| &memory.planes[*place as usize]).collect();
        convolution.run(&inputs, layer.then, &mut output, lanes, stop);
        *memory.at(layer.writes) = output;
    }
}

fn convolution(tensors: &[Tensor], name: &str, inputs: &[Channels]) -> Result<Convolution, WeightsError> {
    let named = |part: &str| {
        let name = format!("{name}.{part}");
        tensors.iter().find(|tensor| tensor.name == name).ok_or(WeightsError::OtherNetwork(name))
    };
    let (weight, bias) = (named("weight")?, named("bias")?);
    Convolution::new(weight, bias, inputs).ok_or_else(|| WeightsError::OtherNetwork(weight.name.clone()))
}

/// Over how many pixels a layer goes.
pub(crate) fn read_shape(layer: &Layer, at: &[Shape; PLACES]) -> Shape {
    let (place, doubled) = layer.reads[0];
    let shape = at[place as usize];
    let factor = if doubled { 2 } else { 1 };
    Shape { width: factor * shape.width, height: factor * shape.height, ..shape }
}

pub(crate) fn written_shape(layer: &Layer, read: Shape, channels: usize) -> Shape {
    let divisor = if layer.then == Then::Pool { 2 } else { 1 };
    Shape { channels, width: read.width / divisor, height: read.height / divisor }
}

/// Values between layers, one place for each that is held at once.
#[derive(Debug)]
pub(crate) struct Memory {
    planes: Vec<Planes>,
}

impl Memory {
    /// The network's input, to be filled.
    pub fn input(&mut self, width: usize, height: usize) -> &mut Planes {
        let input = self.at(Place::Input);
        input.reshape(Shape { channels: INPUTS, width, height });
        input
    }

    fn at(&mut self, place: Place) -> &mut Planes {
        &mut self.planes[place as usize]
    }

    fn shapes(&self) -> [Shape; PLACES] {
        std::array::from_fn(|place| self.planes[place].shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_networks_fit_the_graph_and_are_told_apart() {
        let [small, base] = [Network::small().unwrap(), Network::base().unwrap()];
        let weights = |network: &Network| network.layers.iter().map(|layer| layer.operations()).sum::<usize>();
        assert!(weights(&base) > weights(&small));
        assert_ne!(small.hash(), base.hash());
        assert_eq!(small.hash().len(), 32);
    }

    #[test]
    fn weights_of_another_network_are_refused_by_name() {
        assert_eq!(Network::from_tza("", b"no").unwrap_err(), WeightsError::Archive(TzaError::NoArchive));
        let empty = [&[0xd7, 0x41, 2, 0][..], &12_u64.to_le_bytes(), &0_u32.to_le_bytes()].concat();
        let line = Network::from_tza("", &empty).unwrap_err().to_string();
        assert_eq!(line, "the weights are of another network: enc_conv0.weight is missing or has other sides");
    }

    /// A convolution as its definition says, in f64: what lies outside is 0.
    fn defined(tensors: &[Tensor], layer: &Layer, read: &[Planes], shape: Shape) -> Vec<f64> {
        let named = |part: &str| tensors.iter().find(|t| t.name == format!("{}.{part}", layer.name)).unwrap();
        let (kernel, bias) = (named("weight"), named("bias"));
        let source = |x: usize, y: usize| {
            let of = |&(place, doubled): &(Place, bool)| {
                let (planes, factor) = (&read[place as usize], if doubled { 2 } else { 1 });
                let inside = (1..=shape.width).contains(&x) && (1..=shape.height).contains(&y);
                let at = |channel: usize| {
                    let (column, row) = ((x - 1) / factor + 1, (y - 1) / factor + 1);
                    planes.starting_at(channel / 16)[row * planes.shape.stride() + column][channel % 16]
                };
                (0..planes.shape.channels).map(move |c| if inside { f64::from(at(c)) } else { 0.0 }).collect::<Vec<_>>()
            };
            layer.reads.iter().flat_map(of).collect::<Vec<f64>>()
        };
        let sources: Vec<Vec<f64>> =
            (0..shape.height + 2).flat_map(|y| (0..shape.width + 2).map(move |x| source(x, y))).collect();
        let inputs = kernel.dimensions[1];
        let value = |output: usize, x: usize, y: usize| {
            let term = |i: usize, place: usize| {
                let pixel = &sources[(y + place / 3) * shape.stride() + x + place % 3];
                f64::from(kernel.values[(output * inputs + i) * 9 + place]) * pixel[i]
            };
            let sum: f64 = (0..inputs).flat_map(|i| (0..9).map(move |place| term(i, place))).sum();
            (sum + f64::from(bias.values[output])).max(0.0)
        };
        let pooled = |output: usize, x: usize, y: usize| {
            [(0, 0), (1, 0), (0, 1), (1, 1)]
                .map(|(i, j)| value(output, 2 * x + i, 2 * y + j))
                .into_iter()
                .fold(0.0, f64::max)
        };
        let written = written_shape(layer, shape, kernel.dimensions[0]);
        let of = |output| {
            let at = move |x, y| if layer.then == Then::Pool { pooled(output, x, y) } else { value(output, x, y) };
            (0..written.height).flat_map(move |y| (0..written.width).map(move |x| at(x, y)))
        };
        (0..written.channels).flat_map(of).collect()
    }

    /// Each layer, given what the ones before it made: inputs of up to 96 channels, one and a half tiles wide.
    #[test]
    fn every_layer_is_the_convolution_that_its_weights_say() {
        let bytes = include_bytes!("../../../assets/weights/rt_hdr_alb_nrm_small.tza");
        let (network, tensors) = (Network::small().unwrap(), tza::read(bytes).unwrap());
        for lanes in Lanes::available() {
            let mut memory = network.memory(32, 16).unwrap();
            for (i, pixel) in memory.input(32, 16).planes_mut().next().unwrap().iter_mut().enumerate() {
                *pixel = std::array::from_fn(|c| ((i * 37 + c * 101) % 64) as f32 / 64.0);
            }
            memory.input(32, 16);
            for (layer, convolution) in GRAPH.iter().zip(&network.layers) {
                let shape = read_shape(layer, &memory.shapes());
                let expected = defined(&tensors, layer, &memory.planes, shape);
                Network::step(layer, convolution, &mut memory, lanes, &|| false);
                let output = memory.at(layer.writes);
                let pixels = |c: usize| {
                    output.rows(c / 16).flat_map(move |row| row[1..row.len() - 1].iter().map(move |p| p[c % 16]))
                };
                let got: Vec<f64> = (0..output.shape.channels).flat_map(pixels).map(f64::from).collect();
                assert_eq!(got.len(), expected.len(), "{}", layer.name);
                let most = expected.iter().fold(1.0, |most: f64, value| most.max(*value));
                for (got, expected) in got.iter().zip(&expected) {
                    // up to 864 products, each rounded
                    assert!((got - expected).abs() < 1e-5 * most, "{} {}: {got} {expected}", layer.name, lanes.name());
                }
            }
        }
    }

    #[test]
    fn memory_is_what_is_stated() {
        let mib = |network: Network| network.memory_size(1024, 1024) >> 20;
        assert_eq!([mib(Network::small().unwrap()), mib(Network::base().unwrap())], [363, 498]);
    }
}
