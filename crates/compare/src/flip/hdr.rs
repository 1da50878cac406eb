//! HDR-FLIP: the largest FLIP over a sweep of exposures, so that an error in an area light counts as one in a shadow
//! does. Andersson et al. 2021, sections 4 and 5, with the ACES curve as Narkowicz fitted it.

use super::{Evaluator, finite_or_black, mark_nonfinite};
use crate::{CompareError, metrics::same_size};
use film::colour::{luminance, srgb_encode};
use film::{Image, Vec3};

/// What [`hdr_flip`] found.
#[derive(Debug, Clone, PartialEq)]
pub struct HdrFlip {
    /// The largest FLIP over the exposures, in [0, 1], one a pixel; NaN where a picture is not finite.
    pub values: Vec<f32>,
    /// The exposure, in stops, at which each pixel's is largest; the first where all are 0.
    pub worst_exposures: Vec<f32>,
    /// The exposures of the sweep, in stops, ascending.
    pub exposures: Vec<f32>,
}

/// The ACES curve `(a x^2 + b x) / (c x^2 + d x + e)`, with the fit's pre-exposure of 0.6 taken out.
const ACES: [f32; 5] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];
/// The sweep begins where the reference's brightest pixel is shown at this value, and ends where its median is.
const ANCHOR: f32 = 0.85;
/// Far beyond where the curve is white: squares of larger values would overflow.
const WHITE: f32 = 1e6;

/// HDR-FLIP of two pictures in linear radiance; the sweep of exposures follows from the reference. Otherwise as
/// [`super::flip`].
///
/// # Errors
/// [`CompareError::Sizes`] if they do not have the same pixels.
pub fn hdr_flip(picture: &Image, reference: &Image, pixels_per_degree: f32) -> Result<HdrFlip, CompareError> {
    same_size(picture.size(), reference.size())?;
    let (count, exposures) = (picture.radiances().len(), exposures(reference.radiances()));
    let mut worst =
        HdrFlip { values: vec![0.0; count], worst_exposures: vec![exposures[0]; count], exposures: exposures.clone() };
    if count == 0 {
        return Ok(worst);
    }
    let evaluator = Evaluator::new(picture.width() as usize, pixels_per_degree);
    let (a, b) = (finite_or_black(picture), finite_or_black(reference));
    for exposure in exposures {
        let values = evaluator.flip(&shown(&a, exposure), &shown(&b, exposure));
        for ((most, at), value) in worst.values.iter_mut().zip(&mut worst.worst_exposures).zip(values) {
            if value > *most {
                (*most, *at) = (value, exposure);
            }
        }
    }
    mark_nonfinite(&mut worst.values, picture, reference);
    Ok(worst)
}

/// sRGB code values of linear radiance under an exposure and the curve.
fn shown(picture: &[Vec3], exposure: f32) -> Vec<Vec3> {
    let [a, b, c, d, e] = ACES;
    let curve = |x: f32| {
        let x = x.clamp(-WHITE, WHITE);
        srgb_encode((a * x * x + b * x) / (c * x * x + d * x + e))
    };
    let scale = exposure.exp2();
    picture.iter().map(|p| Vec3::from_array((*p * scale).to_array().map(curve))).collect()
}

/// The sweep for a reference, at least one exposure: one a stop, evenly spread between its ends. A reference without
/// light is shown as it is.
fn exposures(reference: &[Vec3]) -> Vec<f32> {
    let mut luminances: Vec<f32> = reference.iter().filter(|p| p.is_finite()).map(|p| luminance(*p)).collect();
    luminances.sort_by(f32::total_cmp);
    let brightest = luminances.last().copied().unwrap_or(0.0);
    if !(brightest > 0.0) {
        return vec![0.0];
    }
    // the floor is for a picture of which more than half is black
    let median = luminances[luminances.len() / 2].max(f32::EPSILON.min(brightest));
    let anchor = exposed_to(ANCHOR);
    let (start, stop) = ((anchor / brightest).log2(), (anchor / median).log2());
    let count = (stop - start).ceil().max(2.0) as usize;
    (0..count).map(|i| start + i as f32 * (stop - start) / (count - 1) as f32).collect()
}

/// The light that the curve shows at `value`, in (0, 1).
fn exposed_to(value: f32) -> f32 {
    let [a, b, c, d, e] = ACES;
    let (a, b, c) = (a - value * c, b - value * d, -value * e);
    let root = (b * b - 4.0 * a * c).sqrt();
    ((-b + root) / (2.0 * a)).max((-b - root) / (2.0 * a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flip::PIXELS_PER_DEGREE;

    #[test]
    fn the_sweep_shows_the_brightest_first_and_the_median_last() {
        let reference: Vec<Vec3> = (0..9).map(|i| Vec3::splat((i as f32 - 4.0).exp2())).collect();
        let sweep = exposures(&reference);
        let luminance_at = |exposure: f32| exposure.exp2();
        assert!((luminance_at(sweep[0]) * 16.0 - exposed_to(ANCHOR)).abs() < 1e-4);
        assert!((luminance_at(sweep[sweep.len() - 1]) - exposed_to(ANCHOR)).abs() < 1e-4);
        assert_eq!(sweep.len(), 4);
        let [a, b, c, d, e] = ACES;
        let x = exposed_to(ANCHOR);
        assert!(((a * x * x + b * x) / (c * x * x + d * x + e) - ANCHOR).abs() < 1e-5);
    }

    #[test]
    fn a_mostly_black_reference_is_swept_down_to_a_floor() {
        let mut reference = vec![Vec3::ZERO; 8];
        reference[3] = Vec3::ONE;
        let sweep = exposures(&reference);
        // from 1 down to 2^-23
        assert_eq!(sweep.len(), 23);
        assert!((sweep[22] - sweep[0] - 23.0).abs() < 1e-4);
    }

    #[test]
    fn equal_pictures_do_not_differ_and_black_ones_can_be_measured() {
        for value in [0.0, 1e-20, 3.0, 1e30] {
            let same = Image::new(8, 6, vec![Vec3::splat(value); 48]).unwrap();
            let found = hdr_flip(&same, &same, PIXELS_PER_DEGREE).unwrap();
            assert!(found.values.iter().all(|v| *v == 0.0) && found.exposures.iter().all(|e| e.is_finite()), "{value}");
        }
    }
}
