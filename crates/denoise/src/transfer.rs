//! What the network sees of radiance: brought to one exposure, through a curve of equal steps for the eye, between 0
//! and 1. The numbers are those that the published networks were trained with (Open Image Denoise, `core/color.h`,
//! `core/autoexposure.h`). On the device: `shaders/denoise/unet/transfer.wgsl`.

use film::Vec3;
use rayon::prelude::*;

/// The luminance that a picture's mean is brought to.
const KEY: f32 = 0.18;
/// The side of the squares whose mean luminance counts as one, so that noise does not.
const BIN: usize = 16;
/// A square that is darker says nothing.
const DARKEST: f64 = 1e-8;

/// Factor that brings a picture of `width` columns to the exposure that the network knows: the mean of the logarithms
/// of its squares' luminance becomes [`KEY`]. 1 where all is black. What is not finite or negative counts as black.
pub fn exposure(radiances: &[Vec3], width: usize) -> f32 {
    let height = radiances.len() / width.max(1);
    let bins = [width.div_ceil(BIN), height.div_ceil(BIN)];
    let range = |bin: usize, bins: usize, side: usize| bin * side / bins..(bin + 1) * side / bins;
    let means = |row: usize| {
        let rows = range(row, bins[1], height);
        let of = move |column: usize| mean_luminance(radiances, width, range(column, bins[0], width), rows.clone());
        (0..bins[0]).map(of).collect::<Vec<f64>>()
    };
    let rows: Vec<Vec<f64>> = (0..bins[1]).into_par_iter().map(means).collect();
    // one after the other, so that no sum depends on the threads
    let (mut sum, mut count) = (0.0, 0.0);
    for mean in rows.into_iter().flatten().filter(|mean| *mean > DARKEST) {
        sum += mean.log2();
        count += 1.0;
    }
    if count > 0.0 { (f64::from(KEY) / (sum / count).exp2()) as f32 } else { 1.0 }
}

fn mean_luminance(
    radiances: &[Vec3],
    width: usize,
    columns: std::ops::Range<usize>,
    rows: std::ops::Range<usize>,
) -> f64 {
    let count = (columns.len() * rows.len()) as f64;
    let of_row = |row: usize| radiances[row * width..][columns.clone()].iter().map(|rgb| luminance(sanitized(*rgb)));
    rows.flat_map(of_row).sum::<f64>() / count
}

/// As the network's makers weigh the colours; in f64, in which no sum of finite f32 overflows.
fn luminance(rgb: Vec3) -> f64 {
    rgb.as_dvec3().dot(film::glam::dvec3(0.212_671, 0.715_160, 0.072_169))
}

/// Radiance without what a network cannot take: what is not finite becomes 0, as does what is negative.
pub fn sanitized(rgb: Vec3) -> Vec3 {
    Vec3::from_array(rgb.to_array().map(|value| if value.is_finite() { value.max(0.0) } else { 0.0 }))
}

// A fit to the PU2 curve (Aydin, Mantiuk and Seidel, "Extending Quality Metrics to Full Luminance Range Images", 2008),
// normalised at 100 cd/m^2: linear below `PU_Y0`, a power up to `PU_Y1`, then logarithmic.
pub const PU_A: f32 = 1.412_837_65e3;
pub const PU_B: f32 = 1.645_931_72;
pub const PU_C: f32 = 4.313_849_81e-1;
pub const PU_D: f32 = -2.941_396_09e-3;
pub const PU_E: f32 = 1.926_532_54e-1;
pub const PU_F: f32 = 6.260_260_94e-3;
pub const PU_G: f32 = 9.986_201_52e-1;
pub const PU_Y0: f32 = 1.579_457_60e-6;
pub const PU_Y1: f32 = 3.220_876_31e-2;
pub const PU_X0: f32 = 2.231_517_11e-3;
pub const PU_X1: f32 = 3.709_747_49e-1;

fn curve(y: f32) -> f32 {
    if y <= PU_Y0 {
        PU_A * y
    } else if y <= PU_Y1 {
        PU_B * y.powf(PU_C) + PU_D
    } else {
        PU_E * (y + PU_F).ln() + PU_G
    }
}

fn inverse_curve(x: f32) -> f32 {
    if x <= PU_X0 {
        x / PU_A
    } else if x <= PU_X1 {
        ((x - PU_D) / PU_B).powf(1.0 / PU_C)
    } else {
        ((x - PU_G) / PU_E).exp() - PU_F
    }
}

/// Radiance to what the network sees and back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transfer {
    /// The factor that brings radiance to the exposure that the network knows.
    pub exposure: f32,
    /// The curve at the largest number of half precision, which becomes 1.
    pub white: f32,
}

impl Transfer {
    /// With a factor for the exposure, as [`exposure`] finds it.
    pub fn new(exposure: f32) -> Self {
        Transfer { exposure, white: curve(65504.0) }
    }

    /// Radiance as the network sees it.
    pub fn forward(&self, radiance: Vec3) -> Vec3 {
        let seen = |value: f32| curve((value * self.exposure).min(f32::MAX)) / self.white;
        Vec3::from_array(sanitized(radiance).to_array().map(seen))
    }

    /// The radiance of what the network says, which may be negative or no number at all.
    pub fn inverse(&self, seen: Vec3) -> Vec3 {
        let radiance = |value: f32| (inverse_curve(value * self.white) / self.exposure).min(f32::MAX);
        Vec3::from_array(sanitized(seen).to_array().map(radiance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_has_no_step_where_its_pieces_meet() {
        for (y, x) in [(PU_Y0, PU_X0), (PU_Y1, PU_X1)] {
            let above = curve(f32::from_bits(y.to_bits() + 1));
            assert!((curve(y) - x).abs() < 1e-6 && (above - x).abs() < 1e-6, "{y}: {} {above} {x}", curve(y));
        }
    }

    /// The logarithm squeezes 7 of an f32's 24 bits out of bright values.
    #[test]
    fn radiance_comes_back() {
        let transfer = Transfer::new(0.7);
        for value in [0.0, 1e-7, 1e-5, 1e-3, 0.04, 0.18, 1.0, 37.0, 2e4, 1e9] {
            let back = transfer.inverse(transfer.forward(Vec3::splat(value))).x;
            assert!((back - value).abs() <= 3e-5 * value, "{value}: {back}");
        }
    }

    #[test]
    fn the_exposure_brings_the_log_mean_to_the_key() {
        let half = |index: usize| if index % 32 < 16 { 4.0 } else { 1.0 };
        let radiances: Vec<Vec3> = (0..32 * 16).map(|index| Vec3::splat(half(index))).collect();
        assert!((exposure(&radiances, 32) - KEY / 2.0).abs() < 1e-6);
    }

    #[test]
    fn what_is_not_finite_is_black_to_the_exposure_and_to_the_curve() {
        let mut radiances = vec![Vec3::ONE; 16 * 16];
        radiances[3] = Vec3::new(f32::NAN, f32::INFINITY, -1.0);
        let black = exposure(&radiances, 16) / KEY;
        assert!((black - 256.0 / 255.0).abs() < 1e-5, "{black}");
        assert_eq!(Transfer::new(1.0).forward(radiances[3]), Vec3::ZERO);
        assert_eq!(exposure(&[Vec3::ZERO; 5], 5), 1.0);
    }
}
