use super::*;
use crate::convolution::Then;
use crate::network::GRAPH;
use crate::tza::{self, Tensor, from_half};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{MutexGuard, OnceLock};

/// The small network on every device, with every kind of numbers that it has: compiled once for all tests. For one test
/// at a time: wgpu panics where a context of OpenGL is busy for seconds, as it is while a software device compiles.
fn everywhere() -> MutexGuard<'static, Vec<GpuUnet>> {
    static ALL: OnceLock<Mutex<Vec<GpuUnet>>> = OnceLock::new();
    let all = ALL.get_or_init(|| Mutex::new(on_each_device(&Network::small().unwrap())));
    all.lock().unwrap_or_else(PoisonError::into_inner)
}

fn on_each_device(network: &Network) -> Vec<GpuUnet> {
    let devices = Gpu::each().unwrap_or_else(|why| {
        println!("left out: {why}");
        Vec::new()
    });
    let with_numbers = |gpu: &Gpu| {
        let unet = |numbers| GpuUnet::with_numbers(gpu, network, numbers).unwrap();
        Numbers::available(gpu).map(unet).collect::<Vec<_>>()
    };
    devices.iter().flat_map(with_numbers).collect()
}

fn described(unet: &GpuUnet) -> String {
    format!("{} {:?}", unet.gpu.describe(), unet.numbers)
}

/// Numbers in [0, 1), of which halves hold each exactly.
fn number(seed: usize, index: usize) -> f32 {
    let mixed = ((index as u32).wrapping_mul(0x9e37_79b9) ^ seed as u32).wrapping_mul(0x85eb_ca6b);
    (mixed >> 22) as f32 / 1024.0
}

/// A picture with features.
struct Case {
    color: Image,
    albedo: Vec<Vec3>,
    normal: Vec<Vec3>,
}

impl Case {
    /// Some light, in squares, under noise; a few pixels are much brighter.
    fn noisy(width: u32, height: u32) -> Self {
        let vector = |seed: usize, i: usize| Vec3::from_array([0, 1, 2].map(|c| number(seed, 3 * i + c)));
        let count = (width * height) as usize;
        let bright = |i: usize| if i % 97 == 13 { 40.0 } else { 0.5 + (i / 8 % 3) as f32 };
        let color: Vec<Vec3> = (0..count).map(|i| bright(i) * vector(1, i)).collect();
        Case {
            color: Image::new(width, height, color).unwrap(),
            albedo: (0..count).map(|i| vector(2, i / 4)).collect(),
            normal: (0..count).map(|i| 2.0 * vector(3, i / 4) - 1.0).collect(),
        }
    }

    fn one_colour(value: Vec3, (width, height): (u32, u32)) -> Self {
        let pixels = vec![value; (width * height) as usize];
        let color = Image::new(width, height, pixels.clone()).unwrap();
        Case { color, albedo: pixels.clone(), normal: pixels }
    }

    fn features(&self) -> Features<'_> {
        Features { albedo: &self.albedo, normal: &self.normal }
    }

    fn denoised(&self, unet: &GpuUnet) -> Image {
        unet.denoise(&self.color, self.features(), &|| false).unwrap()
    }
}

/// L2 distance over the length of what is expected.
fn distance(picture: &Image, expected: &Image) -> f64 {
    let square = |v: Vec3| v.as_dvec3().length_squared();
    let apart: f64 = picture.radiances().iter().zip(expected.radiances()).map(|(a, b)| square(*a - *b)).sum();
    (apart / expected.radiances().iter().map(|v| square(*v)).sum::<f64>()).sqrt()
}

/// What a picture may differ by from the processor's. Sums are in another order, in f32. Halves have 11 bits, and of what
/// the network says last the transfer's inverse multiplies relative errors by 16 (`PU_E` into its white).
fn tolerance(numbers: Numbers) -> f64 {
    match numbers {
        Numbers::Half => 4e-3,
        Numbers::Single => 1e-5,
    }
}

#[test]
fn every_device_makes_the_picture_of_the_processor() {
    let networks = [Network::small().unwrap(), Network::base().unwrap()];
    let (of_small, of_base) = (everywhere(), on_each_device(&networks[1]));
    for (network, devices) in networks.iter().zip([&of_small[..], &of_base[..]]) {
        for (width, height) in [(64, 48), (33, 17), (7, 3), (1, 1)] {
            let case = Case::noisy(width, height);
            let expected = network.denoise(&case.color, case.features(), &|| false).unwrap();
            for unet in devices {
                let distance = distance(&case.denoised(unet), &expected);
                let what = format!("{width} x {height} {} {}", network.name(), described(unet));
                println!("{what}: {distance:.1e}");
                assert!(distance < tolerance(unet.numbers), "{what}: {distance:.1e}");
            }
        }
    }
}

/// Values of a place: channels, each with its rows.
struct Values {
    size: [usize; 2],
    channels: Vec<Vec<f32>>,
}

impl Values {
    fn random(size: [usize; 2], channels: usize) -> Self {
        let channel = |c: usize| (0..size[0] * size[1]).map(|i| number(c, i)).collect();
        Values { size, channels: (0..channels).map(channel).collect() }
    }

    /// As the device holds them, in blocks of four channels.
    fn buffer(&self, gpu: &Gpu, numbers: Numbers) -> Buffer {
        let channel = |c: usize, i: usize| self.channels.get(c).map_or(0.0, |channel| channel[i]);
        let pixel = |block: usize| {
            (0..self.size[0] * self.size[1]).map(move |i| [0, 1, 2, 3].map(|c| channel(4 * block + c, i)))
        };
        let values: Vec<f32> = (0..self.channels.len().div_ceil(4)).flat_map(pixel).flatten().collect();
        match numbers {
            Numbers::Half => {
                gpu.buffer("values", &values.into_iter().map(to_half).collect::<Vec<_>>(), BufferUsages::STORAGE)
            }
            Numbers::Single => gpu.buffer("values", &values, BufferUsages::STORAGE),
        }
        .unwrap()
    }

    fn read(unet: &GpuUnet, buffer: &Buffer, size: [usize; 2], channels: usize) -> Self {
        let bytes = unet.gpu.read_buffer("values", buffer).unwrap();
        let values: Vec<f32> = match unet.numbers {
            Numbers::Half => bytemuck::pod_collect_to_vec::<u8, u16>(&bytes).into_iter().map(from_half).collect(),
            Numbers::Single => bytemuck::pod_collect_to_vec(&bytes),
        };
        let pixels = size[0] * size[1];
        let channel = |c: usize| (0..pixels).map(|i| values[(c / 4 * pixels + i) * 4 + c % 4]).collect();
        Values { size, channels: (0..channels).map(channel).collect() }
    }

    /// A pixel's channel; 0 outside.
    fn at(&self, channel: usize, x: isize, y: isize) -> f64 {
        let inside = (0..self.size[0] as isize).contains(&x) && (0..self.size[1] as isize).contains(&y);
        if inside { f64::from(self.channels[channel][y as usize * self.size[0] + x as usize]) } else { 0.0 }
    }
}

/// The half that is this number in [0, 1), which it holds exactly.
fn to_half(value: f32) -> u16 {
    let bits = value.to_bits();
    if bits == 0 { 0 } else { (((bits >> 23) - 112) << 10 | (bits >> 13 & 1023)) as u16 }
}

/// A convolution with ReLU as its definition says.
fn defined(kernel: &Tensor, bias: &Tensor, reads: &[(&Values, bool)], size: [usize; 2]) -> Values {
    let whole = |&(values, doubled): &(&Values, bool)| {
        let factor = if doubled { 2 } else { 1 };
        let at =
            move |c: usize, i: usize| values.at(c, (i % size[0] / factor) as isize, (i / size[0] / factor) as isize);
        let channel = move |c: usize| (0..size[0] * size[1]).map(move |i| at(c, i) as f32).collect();
        (0..values.channels.len()).map(channel).collect::<Vec<Vec<f32>>>()
    };
    let input = Values { size, channels: reads.iter().flat_map(whole).collect() };
    let term = |output: usize, c: usize, place: usize, i: usize| {
        let [x, y] = [i % size[0] + place % 3, i / size[0] + place / 3].map(|side| side as isize - 1);
        f64::from(kernel.values[(output * input.channels.len() + c) * 9 + place]) * input.at(c, x, y)
    };
    let value = |output: usize, i: usize| {
        let terms = (0..input.channels.len()).flat_map(|c| (0..9).map(move |place| term(output, c, place, i)));
        (terms.sum::<f64>() + f64::from(bias.values[output])).max(0.0) as f32
    };
    let channel = |output: usize| (0..size[0] * size[1]).map(|i| value(output, i)).collect();
    Values { size, channels: (0..bias.values.len()).map(channel).collect() }
}

/// Of each 2 x 2 pixels the largest.
fn pooled(values: &Values) -> Values {
    let size = values.size.map(|side| side / 2);
    let of = |channel: &Vec<f32>| {
        let largest = |i: usize| {
            let first = 2 * (i / size[0]) * values.size[0] + 2 * (i % size[0]);
            [0, 1, values.size[0], values.size[0] + 1].map(|next| channel[first + next]).into_iter().fold(0.0, f32::max)
        };
        (0..size[0] * size[1]).map(largest).collect()
    };
    Values { size, channels: values.channels.iter().map(of).collect() }
}

/// One tile and a bit more, so that no side is a multiple of a workgroup's.
const SIZE: [usize; 2] = [22, 18];

/// A layer on the device, given these values.
fn convolved(unet: &GpuUnet, index: usize, reads: &[Values], channels: usize) -> Values {
    let pools = GRAPH[index].then == Then::Pool;
    let size = if pools { SIZE.map(|side| side / 2) } else { SIZE };
    let layer = Layer { size: SIZE.map(|side| side as u32), ..unet.layers[index] }.whole();
    let params = unet.gpu.buffer("a layer", &[layer], BufferUsages::UNIFORM).unwrap();
    let inputs: Vec<Buffer> = reads.iter().map(|values| values.buffer(&unet.gpu, unet.numbers)).collect();
    let bytes = (channels.div_ceil(4) * size[0] * size[1]) as u64 * unet.numbers.block();
    let written = storage(&unet.gpu, bytes).unwrap();
    let mut queue = Queue { gpu: &unet.gpu, before: None, stop: &|| false };
    let bound =
        [&params, &inputs[0], &inputs[inputs.len() - 1], &unet.weights, &written].map(Buffer::as_entire_binding);
    queue.submit(&unet.shaders.layer, items(&layer), || unet.shaders.layer.bind(&unet.gpu, &bound)).unwrap();
    Values::read(unet, &written, size, channels)
}

/// The last layer's values are seen in pictures only.
#[test]
fn every_layer_is_the_convolution_that_its_weights_say() {
    let tensors = tza::read(include_bytes!("../../../../../assets/weights/rt_hdr_alb_nrm_small.tza")).unwrap();
    let network = Network::small().unwrap();
    for (index, (row, convolution)) in GRAPH.iter().zip(&network.layers).enumerate().take(GRAPH.len() - 1) {
        let [kernel, bias] = ["weight", "bias"]
            .map(|part| tensors.iter().find(|tensor| tensor.name == format!("{}.{part}", row.name)).unwrap());
        let reads: Vec<Values> = convolution
            .inputs()
            .iter()
            .map(|input| Values::random(SIZE.map(|side| if input.doubled { side / 2 } else { side }), input.count))
            .collect();
        let with_factors: Vec<_> = reads.iter().zip(convolution.inputs().iter().map(|input| input.doubled)).collect();
        let whole = defined(kernel, bias, &with_factors, SIZE);
        let expected = if row.then == Then::Pool { pooled(&whole) } else { whole };
        for unet in everywhere().iter() {
            let got = convolved(unet, index, &reads, expected.channels.len());
            assert_eq!(got.size, expected.size);
            let most = expected.channels.iter().flatten().fold(1.0, |most: f32, value| most.max(*value));
            // up to 864 products, each rounded; halves are rounded once
            let tolerance = if unet.numbers == Numbers::Half { 2.0_f32.powi(-11) } else { 1e-5 };
            for (c, (got, expected)) in got.channels.iter().zip(&expected.channels).enumerate() {
                for (i, (got, expected)) in got.iter().zip(expected).enumerate() {
                    let apart = (got - expected).abs();
                    assert!(apart < tolerance * most, "{} {}: {c} {i}: {got} {expected}", row.name, described(unet));
                }
            }
        }
    }
}

#[test]
fn tiles_make_the_picture_of_the_whole_to_the_bit() {
    // longer than what a pixel sees, so that tiles have something to leave out
    for (width, height) in [(250, 13), (13, 250)] {
        let case = Case::noisy(width, height);
        for unet in everywhere().iter() {
            let tiled = unet.denoise_in_tiles(&case.color, case.features(), 224 * 16, &|| false).unwrap();
            assert!(tiled == case.denoised(unet), "{width} x {height} {}", described(unet));
        }
    }
}

#[test]
fn layers_in_slices_make_the_picture_of_the_whole_to_the_bit() {
    let case = Case::noisy(40, 70);
    for unet in everywhere().iter() {
        let mut sliced = GpuUnet::with_numbers(&unet.gpu, &Network::small().unwrap(), unet.numbers).unwrap();
        sliced.most_operations = 1e6;
        assert!(sliced.places([48, 80]).unwrap().slices.len() > 2 * GRAPH.len());
        let whole = GpuUnet::with_numbers(&unet.gpu, &Network::small().unwrap(), unet.numbers).unwrap();
        assert!(case.denoised(&sliced) == case.denoised(&whole), "{}", described(unet));
    }
}

#[test]
fn memory_is_kept_from_picture_to_picture_and_changes_none() {
    let [case, other] = [Case::noisy(40, 30), Case::noisy(16, 16)];
    for unet in everywhere().iter() {
        let first = case.denoised(unet);
        assert!(first == case.denoised(unet), "{}", described(unet));
        other.denoised(unet);
        assert!(first == case.denoised(unet), "{}", described(unet));
    }
}

#[test]
fn what_is_not_finite_counts_as_black_and_features_as_what_they_are_next_to() {
    for unet in everywhere().iter() {
        let with = |color: f32, feature: f32| {
            let mut case = Case::noisy(20, 20);
            let mut colors = case.color.radiances().to_vec();
            colors[100] = Vec3::splat(color);
            case.color = Image::new(20, 20, colors).unwrap();
            (case.albedo[90], case.normal[90]) = (Vec3::splat(feature), Vec3::splat(feature));
            case.denoised(unet)
        };
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0] {
            assert!(with(value, 0.0) == with(0.0, 0.0), "{value} {}", described(unet));
        }
        assert!(with(0.0, f32::NAN) == with(0.0, 0.0), "{}", described(unet));
        assert!(with(0.0, f32::INFINITY) == with(0.0, 1.0), "{}", described(unet));
        assert!(with(0.0, f32::NEG_INFINITY) == with(0.0, -1.0), "{}", described(unet));
        assert!(with(f32::MAX, 0.0).radiances().iter().all(|pixel| pixel.is_finite()), "{}", described(unet));
    }
}

#[test]
fn black_stays_black_and_one_colour_is_the_processors() {
    let network = Network::small().unwrap();
    for unet in everywhere().iter() {
        // the network's own answer to black: Open Image Denoise gives .00014 at most
        let black = Case::one_colour(Vec3::ZERO, (32, 24)).denoised(unet);
        assert!(black.radiances().iter().all(|pixel| pixel.max_element() < 2e-4), "{}", described(unet));
        for size in [(1, 1), (1, 40), (33, 2)] {
            let case = Case::one_colour(Vec3::splat(0.5), size);
            let expected = network.denoise(&case.color, case.features(), &|| false).unwrap();
            let distance = distance(&case.denoised(unet), &expected);
            assert!(distance < tolerance(unet.numbers), "{size:?} {}: {distance:.1e}", described(unet));
        }
    }
}

#[test]
fn it_stops_between_layers_and_goes_on_with_the_next_picture() {
    let case = Case::noisy(16, 16);
    for unet in everywhere().iter() {
        let asked = AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) == 5;
        assert_eq!(unet.denoise(&case.color, case.features(), &stop), Err(DenoiseError::Stopped));
        assert_eq!(asked.into_inner(), 6);
        assert!(case.denoised(unet).radiances().iter().any(|pixel| *pixel != Vec3::ZERO));
        let short = Features { albedo: &case.albedo[1..], ..case.features() };
        assert_eq!(unet.denoise(&case.color, short, &|| false), Err(DenoiseError::Size));
    }
}

#[test]
fn a_device_that_is_lost_is_told_in_one_line() {
    for gpu in Gpu::each().unwrap_or_default() {
        let unet = GpuUnet::new(&gpu, &Network::small().unwrap()).unwrap();
        gpu.device.destroy();
        gpu.remember("the graphics device was lost: a test asked for it".into());
        let case = Case::noisy(16, 16);
        let line = unet.denoise(&case.color, case.features(), &|| false).unwrap_err().to_string();
        assert!(!line.contains('\n') && line.contains("device"), "{line}");
    }
}

#[test]
fn a_film_of_1920_x_1080_is_one_tile_and_limits_of_the_device_make_more() {
    let most = |network: Network, numbers: Numbers, largest: u64| {
        most_pixels(&packed(&network).0, numbers.block(), MOST_BYTES, largest)
    };
    for network in [Network::small, Network::base] {
        for numbers in [Numbers::Half, Numbers::Single] {
            assert!(most(network().unwrap(), numbers, u64::MAX) >= 1920 * 1088);
        }
    }
    // what every device takes: 128 MiB, of 64 channels of a pixel
    assert_eq!(most(Network::base().unwrap(), Numbers::Single, 1 << 27), 1 << 19);
}
