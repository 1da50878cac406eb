//! Edge-avoiding a-trous wavelets: a small kernel whose taps move apart from level to level, and count as little as what
//! they see differs. The spatial half of spatiotemporal variance-guided filtering (Schied et al., "Spatiotemporal
//! Variance-Guided Filtering", 2017), equations 1 to 5: on light without the surfaces' albedo, guided by normals, by depth
//! against its slope, and by luminance against its own variance. What has no variance stays as it is.
//!
//! Twins: `shaders/denoise/a_trous/prepare.wgsl`, `finish.wgsl`.

mod pass;
mod picture;

use crate::transfer::sanitized;
use crate::{DenoiseError, Features, Stop, check_memory};
use film::colour::luminance;
use film::{Image, Vec3};
use pass::{Filter, Moments};
use picture::{Guides, Light};
use rayon::prelude::*;
use simd::Lanes;

/// Levels; the taps of the last are 2 and 4 times 8 pixels apart.
pub(crate) const LEVELS: u32 = 5;

/// Light is divided by this albedo at least: a channel that a surface nearly swallows must not count a hundred times what its
/// neighbours have, and one that is divided by 1 instead would be of another unit than theirs.
const LEAST_ALBEDO: f32 = 0.05;

/// Light above this counts as this much: squares of it are still finite.
const MOST_LIGHT: f32 = 1e15;

/// What else is known of each pixel.
#[derive(Debug, Clone, Copy)]
pub struct Guide<'a> {
    /// Albedo and normal, each of as many pixels as the picture.
    pub features: Features<'a>,
    /// How far away the surface is; any number where nothing is hit.
    pub depth: &'a [f32],
    /// The variance of the pixel's luminance (of the mean, not of a sample). `None` takes it from the neighbours.
    pub variance: Option<&'a [f32]>,
}

impl Guide<'_> {
    pub(crate) fn check(&self, color: &Image) -> Result<(), DenoiseError> {
        let fits = |numbers: &[f32]| numbers.len() == color.radiances().len();
        self.features.check(color)?;
        if fits(self.depth) && self.variance.is_none_or(fits) { Ok(()) } else { Err(DenoiseError::Size) }
    }
}

/// The picture with its noise spread over what looks alike. What is not finite counts as 0.
///
/// # Errors
/// [`DenoiseError`] if a layer is of another size, if there is not enough memory, or if `stop` said so.
pub fn a_trous(color: &Image, guide: Guide, stop: Stop) -> Result<Image, DenoiseError> {
    a_trous_on(Lanes::best(), color, guide, stop)
}

/// As [`a_trous`], on these lanes.
///
/// # Errors
/// As [`a_trous`].
pub fn a_trous_on(lanes: Lanes, color: &Image, guide: Guide, stop: Stop) -> Result<Image, DenoiseError> {
    guide.check(color)?;
    let size = [color.width() as usize, color.height() as usize];
    check_memory(memory(size))?;
    let albedo: Vec<Vec3> = guide.features.albedo.iter().map(|albedo| divisor(*albedo)).collect();
    let guides = Guides::new(size, guide.features, guide.depth);
    let mut light = Light::new(size, |pixel| {
        let variance = guide.variance.map_or(0.0, |variance| variance[pixel]);
        let light = (sanitized(color.radiances()[pixel]) / albedo[pixel]).min(Vec3::splat(MOST_LIGHT));
        let variance = variance / luminance(albedo[pixel]).powi(2);
        (light, if variance.is_finite() { variance.max(0.0) } else { 0.0 })
    });
    let mut next = light.clone();
    if guide.variance.is_none() {
        on_rows(&light, &mut next, stop, |rows| lanes.run(Moments { guides: &guides, light: &light, rows }))?;
        std::mem::swap(&mut light, &mut next);
    }
    for level in 0..LEVELS {
        let step = 1 << level;
        light.repeat_the_edges();
        on_rows(&light, &mut next, stop, |rows| lanes.run(Filter { guides: &guides, light: &light, step, rows }))?;
        std::mem::swap(&mut light, &mut next);
    }
    let denoised: Vec<Vec3> = light.pixels().zip(&albedo).map(|(light, albedo)| light * *albedo).collect();
    Image::new(color.width(), color.height(), denoised).ok_or(DenoiseError::Size)
}

/// Bytes that it takes beside its input: guides, light of two levels, divisors, and what comes out.
fn memory([width, height]: [usize; 2]) -> usize {
    let of_pixels = 2 * size_of::<Vec3>() * width * height;
    of_pixels + Guides::memory([width, height]) + 2 * Light::memory([width, height])
}

/// Constants that stand on both sides under one name. A test holds each against what the shaders say.
pub(crate) fn shared_constants() -> Vec<(&'static str, f64)> {
    [gpu::named_values![LEAST_ALBEDO, MOST_LIGHT], pass::shared_constants()].concat()
}

/// What light is divided by.
fn divisor(albedo: Vec3) -> Vec3 {
    sanitized(albedo).max(Vec3::splat(LEAST_ALBEDO))
}

/// A row of what comes out, and which.
struct Rows<'a> {
    y: usize,
    row: &'a mut [f32],
}

fn on_rows(light: &Light, next: &mut Light, stop: Stop, fill: impl Fn(Rows) + Sync) -> Result<(), DenoiseError> {
    next.rows_mut(light.row_length()).enumerate().for_each(|(y, row)| {
        if !stop() {
            fill(Rows { y, row });
        }
    });
    if stop() { Err(DenoiseError::Stopped) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (45, 32);
    const PIXELS: usize = (SIZE.0 * SIZE.1) as usize;

    /// Two walls that meet in the middle of the picture, and what is seen on them.
    struct Corner {
        albedo: Vec<Vec3>,
        normal: Vec<Vec3>,
        depth: Vec<f32>,
    }

    fn is_left(pixel: usize) -> bool {
        pixel % SIZE.0 as usize <= 20
    }

    impl Corner {
        fn new() -> Self {
            let normal = |pixel| if is_left(pixel) { Vec3::X } else { Vec3::Z };
            Corner {
                albedo: vec![Vec3::splat(0.5); PIXELS],
                normal: (0..PIXELS).map(normal).collect(),
                depth: (0..PIXELS).map(|pixel| 4.0 + 0.1 * (pixel % SIZE.0 as usize) as f32).collect(),
            }
        }

        fn filtered(&self, color: &Image, variance: Option<&[f32]>, lanes: Lanes) -> Image {
            let features = Features { albedo: &self.albedo, normal: &self.normal };
            a_trous_on(lanes, color, Guide { features, depth: &self.depth, variance }, &|| false).unwrap()
        }
    }

    fn image(of: impl Fn(usize) -> f32) -> Image {
        Image::new(SIZE.0, SIZE.1, (0..PIXELS).map(|pixel| Vec3::splat(of(pixel))).collect::<Vec<_>>()).unwrap()
    }

    /// Uniform in [-.5, .5): its variance is 1/12.
    fn noise(pixel: usize) -> f32 {
        (pixel as u32 ^ 0x5bd1).wrapping_mul(0x9e37_79b9).rotate_left(13).wrapping_mul(0x85eb_ca6b) as f32
            / 4_294_967_296.0
            - 0.5
    }

    fn variance(picture: &Image, mean: impl Fn(usize) -> f32) -> f32 {
        let squares = picture.radiances().iter().enumerate().map(|(pixel, value)| (value.x - mean(pixel)).powi(2));
        squares.sum::<f32>() / PIXELS as f32
    }

    #[test]
    fn noise_is_spread_and_the_edge_of_two_surfaces_is_not() {
        let wall = |pixel| if is_left(pixel) { 1.0 } else { 2.0 };
        let noisy = image(|pixel| wall(pixel) + noise(pixel));
        let known = vec![1.0 / 12.0; PIXELS];
        for variance_of in [Some(&known[..]), None] {
            let filtered = Corner::new().filtered(&noisy, variance_of, Lanes::best());
            let left = variance(&filtered, wall) / variance(&noisy, wall);
            assert!(left < 0.02, "{left} of the variance is left");
        }
    }

    /// Light changes where the surface does not: without variance that is no noise.
    #[test]
    fn what_has_no_variance_stays_as_it_is() {
        let picture = image(|pixel| 1.0 + noise(pixel));
        let filtered = Corner::new().filtered(&picture, Some(&[0.0; PIXELS]), Lanes::best());
        for (got, expected) in filtered.radiances().iter().zip(picture.radiances()) {
            assert!((*got - *expected).abs().max_element() < 1e-5, "{got} {expected}");
        }
    }

    /// Every second column is red and shows a little blue that is no light of its own, the others are white; a lamp's column is in
    /// the ceiling. All have one normal and one depth, and variance enough to be mixed.
    #[test]
    fn neighbours_of_another_albedo_lend_no_light() {
        let column = |pixel: usize| pixel % SIZE.0 as usize;
        let is_lamp = |pixel: usize| column(pixel) == 30;
        let surface = |pixel: usize| match column(pixel) % 2 {
            _ if is_lamp(pixel) => (Vec3::ONE, Vec3::splat(10.0)),
            0 => (Vec3::X, Vec3::new(1.0, 0.0, 0.04)),
            _ => (Vec3::splat(0.7), Vec3::splat(0.1)),
        };
        let albedo = (0..PIXELS).map(|pixel| surface(pixel).0).collect();
        let corner = Corner { albedo, normal: vec![Vec3::Z; PIXELS], depth: vec![4.0; PIXELS] };
        let picture: Vec<Vec3> = (0..PIXELS).map(|pixel| surface(pixel).1).collect();
        let picture = Image::new(SIZE.0, SIZE.1, picture).unwrap();
        let filtered = corner.filtered(&picture, Some(&[100.0; PIXELS]), Lanes::best());
        for (pixel, (got, expected)) in filtered.radiances().iter().zip(picture.radiances()).enumerate() {
            assert!(
                (*got - *expected).abs().max_element() < 0.01 * expected.max_element(),
                "{pixel}: {got} {expected}"
            );
        }
    }

    #[test]
    fn one_pixel_of_any_value_leaves_the_others_finite() {
        for value in [f32::MAX, 1e20, f32::INFINITY, f32::NAN] {
            let picture = image(|pixel| if pixel == 100 { value } else { 1.0 });
            let filtered = Corner::new().filtered(&picture, None, Lanes::best());
            assert!(filtered.radiances().iter().all(|pixel| pixel.is_finite()), "{value}");
        }
    }

    #[test]
    fn texture_is_no_noise() {
        let texture = |pixel| 0.5 + 0.4 * noise(pixel);
        let corner = Corner { albedo: (0..PIXELS).map(|pixel| Vec3::splat(texture(pixel))).collect(), ..Corner::new() };
        let picture = image(|pixel| 3.0 * texture(pixel));
        let filtered = corner.filtered(&picture, Some(&[1.0; PIXELS]), Lanes::best());
        for (got, expected) in filtered.radiances().iter().zip(picture.radiances()) {
            assert!((*got - *expected).abs().max_element() < 1e-5 * expected.x, "{got} {expected}");
        }
    }

    #[test]
    fn lanes_agree_and_what_is_not_finite_counts_as_black() {
        let mut corner = Corner::new();
        corner.normal[70] = Vec3::ZERO;
        corner.normal[71] = Vec3::NAN;
        corner.depth[99] = f32::INFINITY;
        let strange = |pixel| [f32::NAN, f32::INFINITY, -1.0].get(pixel / 200).copied().filter(|_| pixel % 200 == 7);
        let noisy = image(|pixel| strange(pixel).unwrap_or(1.0 + noise(pixel)));
        let black = image(|pixel| strange(pixel).map_or(1.0 + noise(pixel), |_| 0.0));
        let expected = corner.filtered(&black, None, Lanes::Scalar);
        assert!(expected.radiances().iter().all(|pixel| pixel.is_finite() && pixel.x >= 0.0));
        for lanes in Lanes::available() {
            let got = corner.filtered(&noisy, None, lanes);
            assert!(got.radiances().iter().all(|pixel| pixel.is_finite()), "{}", lanes.name());
            let most = got.radiances().iter().zip(expected.radiances()).map(|(a, b)| (*a - *b).abs().max_element());
            assert!(most.fold(0.0, f32::max) < 1e-5, "{}", lanes.name());
        }
    }

    #[test]
    fn it_stops_when_asked_and_refuses_layers_of_another_size() {
        let corner = Corner::new();
        let features = Features { albedo: &corner.albedo, normal: &corner.normal };
        let picture = image(noise);
        let guide = Guide { features, depth: &corner.depth, variance: None };
        assert_eq!(a_trous(&picture, guide, &|| true), Err(DenoiseError::Stopped));
        assert_eq!(a_trous(&picture, Guide { depth: &[1.0], ..guide }, &|| false), Err(DenoiseError::Size));
        assert_eq!(a_trous(&picture, Guide { variance: Some(&[1.0]), ..guide }, &|| false), Err(DenoiseError::Size));
    }
}
