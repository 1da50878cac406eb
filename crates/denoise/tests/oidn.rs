//! The networks against Open Image Denoise's own pictures: see `data/README.md`.

#![allow(clippy::unwrap_used)]

use denoise::gpu::unet::{GpuUnet, Numbers};
use denoise::{DenoiseError, Features, Network};
use film::{Image, Vec3};
use gpu::Gpu;
use simd::Lanes;

/// What that program was given and what it made of it.
struct Case {
    color: Image,
    albedo: Vec<Vec3>,
    normal: Vec<Vec3>,
    small: Vec<Vec3>,
    base: Vec<Vec3>,
}

impl Case {
    fn read(bytes: &[u8]) -> Self {
        let (header, bytes) = bytes.split_at(8);
        let [width, height] = [0, 4].map(|at| u32::from_le_bytes(header[at..at + 4].try_into().unwrap()));
        let count = 3 * (width * height) as usize;
        let (color, bytes) = bytes.split_at(4 * count);
        let (albedo, bytes) = bytes.split_at(count);
        let (normal, bytes) = bytes.split_at(count);
        let (small, base) = bytes.split_at(4 * count);
        Case {
            color: Image::new(width, height, singles(color)).unwrap(),
            albedo: vectors(albedo.iter().map(|byte| f32::from(*byte) / 255.0)),
            normal: vectors(normal.iter().map(|byte| f32::from(byte.cast_signed()) / 127.0)),
            small: singles(small),
            base: singles(base),
        }
    }

    fn features(&self) -> Features<'_> {
        Features { albedo: &self.albedo, normal: &self.normal }
    }

    fn denoised(&self, network: &Network, lanes: Lanes) -> Image {
        network.denoise_on(lanes, &self.color, self.features(), denoise::MOST_PIXELS, &|| false).unwrap()
    }
}

fn singles(bytes: &[u8]) -> Vec<Vec3> {
    vectors(bytes.chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())))
}

fn vectors(numbers: impl Iterator<Item = f32>) -> Vec<Vec3> {
    numbers.collect::<Vec<_>>().chunks_exact(3).map(Vec3::from_slice).collect()
}

/// L2 distance over the length of what is expected.
fn distance(picture: &[Vec3], expected: &[Vec3]) -> f64 {
    let square = |v: Vec3| v.as_dvec3().length_squared();
    let apart: f64 = picture.iter().zip(expected).map(|(a, b)| square(*a - *b)).sum();
    (apart / expected.iter().map(|v| square(*v)).sum::<f64>()).sqrt()
}

const CASES: [(&str, &[u8]); 6] = [
    ("cornell", include_bytes!("data/cornell.bin")),
    ("whitted", include_bytes!("data/whitted.bin")),
    ("phong", include_bytes!("data/phong.bin")),
    ("7x3", include_bytes!("data/7x3.bin")),
    ("1x1", include_bytes!("data/1x1.bin")),
    ("nan", include_bytes!("data/nan.bin")),
];

/// Both sum in f32, in another order: they differ by roundings, which 16 layers and an exponential carry on.
const ROUNDING: f64 = 1e-5;

#[test]
fn the_networks_make_the_pictures_of_open_image_denoise() {
    let [small, base] = [Network::small().unwrap(), Network::base().unwrap()];
    for (name, bytes) in CASES {
        let case = Case::read(bytes);
        for (network, expected) in [(&small, &case.small), (&base, &case.base)] {
            for lanes in Lanes::available() {
                let picture = case.denoised(network, lanes);
                let distance = distance(picture.radiances(), expected);
                println!("{name} {} {}: {distance:.1e}", network.name(), lanes.name());
                assert!(distance < ROUNDING, "{name} {} {}: {distance:.1e}", network.name(), lanes.name());
            }
        }
    }
}

/// Halves have 11 bits, and of what the network says last the transfer's inverse multiplies relative errors by 16.
const ROUNDING_OF_HALVES: f64 = 4e-3;

#[test]
fn devices_make_the_pictures_of_open_image_denoise() {
    let networks = [Network::small().unwrap(), Network::base().unwrap()];
    let devices = Gpu::each().unwrap_or_else(|why| {
        println!("left out: {why}");
        Vec::new()
    });
    for gpu in devices {
        for numbers in Numbers::available(&gpu) {
            let unets = networks.each_ref().map(|network| GpuUnet::with_numbers(&gpu, network, numbers).unwrap());
            let tolerance = if numbers == Numbers::Half { ROUNDING_OF_HALVES } else { ROUNDING };
            for (name, bytes) in CASES {
                let case = Case::read(bytes);
                for (unet, expected) in unets.iter().zip([&case.small, &case.base]) {
                    let picture = unet.denoise(&case.color, case.features(), &|| false).unwrap();
                    let distance = distance(picture.radiances(), expected);
                    println!("{name} {numbers:?} {}: {distance:.1e}", gpu.describe());
                    assert!(distance < tolerance, "{name} {numbers:?} {}: {distance:.1e}", gpu.describe());
                }
            }
        }
    }
}

#[test]
fn tiles_make_the_picture_of_the_whole_to_the_bit() {
    // larger than what a pixel sees, so that tiles have something to leave out
    let (color, features) = noise(300, 150);
    let [albedo, normal] = &features;
    let network = Network::small().unwrap();
    let in_tiles = |most| {
        let features = Features { albedo: albedo.radiances(), normal: normal.radiances() };
        network.denoise_on(Lanes::best(), &color, features, most, &|| false).unwrap()
    };
    let whole = in_tiles(denoise::MOST_PIXELS);
    assert_eq!(in_tiles(224 * 160), whole);
    assert_eq!(in_tiles(208 * 160), whole);
}

/// A picture of noise with noise for features.
fn noise(width: u32, height: u32) -> (Image, [Image; 2]) {
    let number =
        |seed: u32, i: u32| (i.wrapping_mul(0x9e37_79b9) ^ seed).wrapping_mul(0x85eb_ca6b) as f32 / 4_294_967_296.0;
    let image = |seed| {
        let pixels = (0..width * height).map(|i| Vec3::from_array([0, 1, 2].map(|c| number(seed, 3 * i + c))));
        Image::new(width, height, pixels.collect::<Vec<_>>()).unwrap()
    };
    (image(1), [image(2), image(3)])
}

/// A firefly without end would make that program's whole picture infinite; here it is a black pixel.
#[test]
fn what_is_not_finite_counts_as_black() {
    let network = Network::small().unwrap();
    let case = Case::read(CASES[0].1);
    let with = |value: f32| {
        let mut color = case.color.radiances().to_vec();
        color[100] = Vec3::splat(value);
        let color = Image::new(case.color.width(), case.color.height(), color).unwrap();
        network.denoise(&color, case.features(), &|| false).unwrap()
    };
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0] {
        assert_eq!(with(value), with(0.0), "{value}");
    }
    assert!(with(f32::MAX).radiances().iter().all(|pixel| pixel.is_finite()));
}

#[test]
fn black_stays_black_and_one_colour_stays_finite() {
    let network = Network::small().unwrap();
    let of = |value: Vec3, (width, height): (u32, u32)| {
        let pixels = vec![value; (width * height) as usize];
        let features = Features { albedo: &pixels, normal: &pixels };
        let color = Image::new(width, height, pixels.clone()).unwrap();
        network.denoise(&color, features, &|| false).unwrap()
    };
    // the network's own answer to black: Open Image Denoise gives .00014 at most
    let black = of(Vec3::ZERO, (32, 24));
    assert!(black.radiances().iter().all(|pixel| pixel.max_element() < 2e-4));
    for size in [(1, 1), (1, 40), (33, 2)] {
        let picture = of(Vec3::splat(0.5), size);
        assert_eq!(picture.size(), size);
        assert!(picture.radiances().iter().all(|pixel| pixel.is_finite()), "{size:?}");
    }
}

#[test]
fn it_stops_when_asked_and_refuses_features_of_another_size() {
    let network = Network::small().unwrap();
    let case = Case::read(CASES[0].1);
    assert_eq!(network.denoise(&case.color, case.features(), &|| true), Err(DenoiseError::Stopped));
    let short = Features { albedo: &case.albedo[1..], ..case.features() };
    assert_eq!(network.denoise(&case.color, short, &|| false), Err(DenoiseError::Size));
}
