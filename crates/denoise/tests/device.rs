//! Filters on every graphics device of this computer against the processor's.

#![allow(clippy::unwrap_used)]

use denoise::a_trous::{Guide, a_trous};
use denoise::gpu::GpuATrous;
use denoise::{DenoiseError, Features};
use film::{Image, Vec3};
use gpu::Gpu;

/// Two rounded walls that meet in the middle of the picture under a strip of sky, with tiles on them.
struct Corner {
    size: (u32, u32),
    albedo: Vec<Vec3>,
    normal: Vec<Vec3>,
    depth: Vec<f32>,
    variance: Vec<f32>,
    color: Vec<Vec3>,
}

/// Uniform in [-.5, .5).
fn noise(number: u32) -> f32 {
    (number ^ 0x5bd1).wrapping_mul(0x9e37_79b9).rotate_left(13).wrapping_mul(0x85eb_ca6b) as f32 / 4_294_967_296.0 - 0.5
}

impl Corner {
    fn new(size: (u32, u32)) -> Self {
        let mut corner =
            Corner { size, albedo: vec![], normal: vec![], depth: vec![], variance: vec![], color: vec![] };
        for pixel in 0..size.0 * size.1 {
            let (x, y) = (pixel % size.0, pixel / size.0);
            let is_left = x < size.0 / 2;
            let is_sky = y * 8 < size.1;
            let tile = if (x / 5 + y / 7) % 2 == 0 { Vec3::new(0.8, 0.3, 0.02) } else { Vec3::splat(0.6) };
            let wall = if is_left { Vec3::X } else { Vec3::Z } + 0.01 * Vec3::Y * y as f32;
            let light = if is_left { 1.0 } else { 2.0 } + noise(pixel);
            corner.albedo.push(tile);
            corner.normal.push(if is_sky { Vec3::ZERO } else { wall.normalize() });
            corner.depth.push(if is_sky { f32::INFINITY } else { 4.0 + 0.1 * x as f32 });
            corner.variance.push(1.0 / 12.0);
            corner.color.push(tile * light);
        }
        corner
    }

    /// Numbers that renderers of any kind may leave behind, in everything; `strange` alone in colours.
    fn with_strange_numbers(mut self, strange: &[f32]) -> Self {
        let pixel = |row: usize, at: usize| (row * self.size.0 as usize) + 3 + 5 * at;
        for (at, value) in strange.iter().enumerate() {
            self.color[pixel(20, at)].y = *value;
        }
        for (at, value) in
            [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e20, f32::MAX, 1e-42].into_iter().enumerate()
        {
            let pixel = |row| pixel(row, at);
            self.normal[pixel(24)].x = value;
            self.depth[pixel(28)] = value;
            self.albedo[pixel(32)].z = value;
            self.variance[pixel(36)] = value;
        }
        self
    }

    fn image(&self) -> Image {
        Image::new(self.size.0, self.size.1, self.color.clone()).unwrap()
    }

    fn guide(&self, knows_variance: bool) -> Guide<'_> {
        let features = Features { albedo: &self.albedo, normal: &self.normal };
        Guide { features, depth: &self.depth, variance: knows_variance.then_some(&self.variance) }
    }
}

/// Normals and albedos come in sixteen bits a component, at most 3e-5 beside what they are: to the 128th power 4e-3 of a tap's
/// weight at worst, and mostly the same for all taps of a surface.
const ROUNDING: f32 = 1e-3;

/// The most that two pictures differ by, as a share of each pixel's greatest channel.
fn difference(a: &Image, b: &Image) -> f32 {
    let pairs = a.radiances().iter().zip(b.radiances());
    let shares = pairs.map(|(a, b)| (*a - *b).abs().max_element() / b.max_element().max(1e-6));
    shares.fold(0.0, |most, share| if share <= most { most } else { share })
}

fn filters() -> Vec<(String, GpuATrous)> {
    let devices = Gpu::each().unwrap();
    devices.iter().map(|gpu| (gpu.describe(), GpuATrous::new(gpu).unwrap())).collect()
}

#[test]
fn a_trous_is_the_processors_but_for_rounding_at_any_size() {
    for (device, filter) in filters() {
        for size in [(1, 1), (7, 3), (1, 40), (45, 32), (131, 77)] {
            let corner = Corner::new(size);
            for knows_variance in [true, false] {
                let (image, guide) = (corner.image(), corner.guide(knows_variance));
                let expected = a_trous(&image, guide, &|| false).unwrap();
                let got = filter.apply(&image, guide, &|| false).unwrap();
                let most = difference(&got, &expected);
                assert!(most < ROUNDING, "{device} {size:?}: {most}");
            }
        }
    }
}

#[test]
fn a_trous_takes_what_is_not_finite_as_the_processor_does() {
    for (device, filter) in filters() {
        let corner =
            Corner::new((64, 48)).with_strange_numbers(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e-42]);
        for knows_variance in [true, false] {
            let (image, guide) = (corner.image(), corner.guide(knows_variance));
            let expected = a_trous(&image, guide, &|| false).unwrap();
            let got = filter.apply(&image, guide, &|| false).unwrap();
            let most = difference(&got, &expected);
            assert!(most < ROUNDING, "{device}: {most}");
        }
    }
}

/// Next to them rounding decides what is left of a variance, so that they are held against nothing.
#[test]
fn light_beyond_all_measure_leaves_all_pixels_finite() {
    for (device, filter) in filters() {
        let corner = Corner::new((64, 48)).with_strange_numbers(&[f32::MAX, 1e20, 1e38]);
        for knows_variance in [true, false] {
            let got = filter.apply(&corner.image(), corner.guide(knows_variance), &|| false).unwrap();
            assert!(got.radiances().iter().all(|pixel| pixel.is_finite() && pixel.min_element() >= 0.0), "{device}");
        }
    }
}

#[test]
fn a_device_refuses_what_does_not_fit_and_stops_when_asked() {
    for (device, filter) in filters() {
        let corner = Corner::new((45, 32));
        let (image, guide) = (corner.image(), corner.guide(true));
        assert_eq!(filter.apply(&image, guide, &|| true), Err(DenoiseError::Stopped), "{device}");
        let fault = filter.apply(&image, Guide { depth: &[1.0], ..guide }, &|| false);
        assert_eq!(fault, Err(DenoiseError::Size), "{device}");
    }
}

#[test]
fn a_lost_device_says_so_in_one_line() {
    let gpu = Gpu::headless().unwrap();
    let filter = GpuATrous::new(&gpu).unwrap();
    gpu.device.destroy();
    gpu.remember("the graphics device was lost: a test asked for it".into());
    let corner = Corner::new((45, 32));
    let fault = filter.apply(&corner.image(), corner.guide(true), &|| false).unwrap_err();
    let DenoiseError::Device(line) = &fault else { panic!("{fault}") };
    assert_eq!(
        line,
        "a picture to denoise did not come back from the graphics device: the graphics device was lost: a test asked for it"
    );
}
