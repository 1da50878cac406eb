//! FLIP: how much of a difference people see when two pictures alternate on one screen, 0 (none) to 1 per pixel.
//! Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"; for radiance beyond a screen's range
//! Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images". Unlike the other metrics it reads
//! what is shown, so it is taken after a display transform; the film itself stays linear.

mod colour;
mod filter;
mod hdr;

pub use hdr::{HdrFlip, hdr_flip};

use crate::{CompareError, metrics::same_size};
use film::{Image, Vec3};
use filter::{Features, Sensitivity, along_columns, along_rows};
use rayon::prelude::*;

/// Pixels in a degree of visual angle that FLIP assumes unless told: a screen 0.7 m wide of 3840 pixels, seen from 0.7
/// m.
pub const PIXELS_PER_DEGREE: f32 = 67.020_64;

/// Exponent of the colour difference.
const Q_C: f32 = 0.7;
/// Share of the largest colour difference that is mapped to [`P_T`].
const P_C: f32 = 0.4;
/// What [`P_C`] of the largest colour difference is mapped to.
const P_T: f32 = 0.95;
/// Exponent of the feature difference.
const Q_F: f32 = 0.5;

/// FLIP of two pictures as a screen shows them, with sRGB code values in [0, 1] for radiance, as
/// [`film::DisplayTransform::code_values_of`] makes them; one value in [0, 1] a pixel, rows from the top. A pixel that is not finite in either picture is NaN, and black
/// to its neighbours.
///
/// `pixels_per_degree` of visual angle, > 0: [`PIXELS_PER_DEGREE`] where nothing better is known.
///
/// # Errors
/// [`CompareError::Sizes`] if they do not have the same pixels.
pub fn flip(picture: &Image, reference: &Image, pixels_per_degree: f32) -> Result<Vec<f32>, CompareError> {
    same_size(picture.size(), reference.size())?;
    if picture.radiances().is_empty() {
        return Ok(Vec::new());
    }
    let evaluator = Evaluator::new(picture.width() as usize, pixels_per_degree);
    let mut values = evaluator.flip(&finite_or_black(picture), &finite_or_black(reference));
    mark_nonfinite(&mut values, picture, reference);
    Ok(values)
}

fn finite_or_black(picture: &Image) -> Vec<Vec3> {
    picture.radiances().iter().map(|p| if p.is_finite() { *p } else { Vec3::ZERO }).collect()
}

fn mark_nonfinite(values: &mut [f32], picture: &Image, reference: &Image) {
    for ((value, a), b) in values.iter_mut().zip(picture.radiances()).zip(reference.radiances()) {
        if !a.is_finite() || !b.is_finite() {
            *value = f32::NAN;
        }
    }
}

/// One picture on its way: what its pixels look like, and where it has edges and points.
struct Seen {
    lab: Vec<[f32; 3]>,
    edges: Vec<f32>,
    points: Vec<f32>,
}

/// The filters for one width and viewing distance.
struct Evaluator {
    width: usize,
    sensitivity: Sensitivity,
    features: Features,
    largest_difference: f32,
}

impl Evaluator {
    fn new(width: usize, pixels_per_degree: f32) -> Self {
        let lab = |rgb| colour::hunt_adjusted_lab(rgb);
        Evaluator {
            width,
            sensitivity: Sensitivity::new(pixels_per_degree),
            features: Features::new(pixels_per_degree),
            // green against blue is the largest difference of two sRGB colours under this distance
            largest_difference: colour::hyab(lab([0.0, 1.0, 0.0]), lab([0.0, 0.0, 1.0])).powf(Q_C),
        }
    }

    /// Both pictures finite, of whole rows, not empty.
    fn flip(&self, picture: &[Vec3], reference: &[Vec3]) -> Vec<f32> {
        let (picture, reference) = (self.seen(picture), self.seen(reference));
        (0..picture.lab.len())
            .into_par_iter()
            .map(|i| {
                let colour = self.colour_difference(colour::hyab(picture.lab[i], reference.lab[i]));
                let edge = (picture.edges[i] - reference.edges[i]).abs();
                let point = (picture.points[i] - reference.points[i]).abs();
                let feature = (edge.max(point) / std::f32::consts::SQRT_2).powf(Q_F);
                colour.powf(1.0 - feature)
            })
            .collect()
    }

    /// A HyAB distance to [0, 1]: the large ones, which hardly differ to the eye, are pushed together.
    fn colour_difference(&self, distance: f32) -> f32 {
        let (difference, most) = (distance.powf(Q_C), self.largest_difference);
        let knee = P_C * most;
        if difference < knee {
            difference * P_T / knee
        } else {
            P_T + (difference - knee) / (most - knee) * (1.0 - P_T)
        }
    }

    fn seen(&self, picture: &[Vec3]) -> Seen {
        let ycxcz: Vec<_> = picture.par_iter().map(|p| colour::ycxcz_from_srgb(p.to_array())).collect();
        let channel = |c: usize| ycxcz.iter().map(|p| p[c]).collect::<Vec<f32>>();
        let filtered = |plane: &[f32], in_rows: &[f32], in_columns: &[f32]| {
            along_columns(&along_rows(plane, self.width, in_rows), self.width, in_columns)
        };

        let (y, s) = (channel(0), &self.sensitivity);
        let soft_y = filtered(&y, &s.achromatic, &s.achromatic);
        let soft_cx = filtered(&channel(1), &s.red_green, &s.red_green);
        let cz = channel(2);
        let soft_cz = s.blue_yellow.each_ref().map(|kernel| filtered(&cz, kernel, kernel));
        let lab = |i: usize| {
            let soft = [soft_y[i], soft_cx[i], soft_cz[0][i] + soft_cz[1][i]];
            colour::hunt_adjusted_lab(colour::rgb_from_ycxcz(soft))
        };

        let luminance: Vec<f32> = y.iter().map(|y| (y + 16.0) / 116.0).collect();
        let f = &self.features;
        let strength = |derivative: &[f32]| -> Vec<f32> {
            let across = filtered(&luminance, derivative, &f.gaussian);
            let down = filtered(&luminance, &f.gaussian, derivative);
            across.into_iter().zip(down).map(|(across, down)| across.hypot(down)).collect()
        };
        Seen {
            lab: (0..y.len()).into_par_iter().map(lab).collect(),
            edges: strength(&f.edge),
            points: strength(&f.point),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (12, 9);

    fn constant(rgb: [f32; 3]) -> Image {
        of_pixels(|_| Vec3::from_array(rgb))
    }

    fn of_pixels(of: impl Fn(u32) -> Vec3) -> Image {
        Image::new(SIZE.0, SIZE.1, (0..SIZE.0 * SIZE.1).map(of).collect::<Vec<_>>()).unwrap()
    }

    fn all_near(values: &[f32], expected: f32) {
        assert!(values.iter().all(|v| (v - expected).abs() < 1e-4), "{values:?}");
    }

    #[test]
    fn a_picture_does_not_differ_from_itself() {
        let gradient = of_pixels(|i| Vec3::splat(i as f32 / 108.0));
        assert!(flip(&gradient, &gradient, PIXELS_PER_DEGREE).unwrap().iter().all(|v| *v == 0.0));
    }

    #[test]
    fn green_against_blue_is_all_there_is() {
        let values = flip(&constant([0.0, 1.0, 0.0]), &constant([0.0, 0.0, 1.0]), PIXELS_PER_DEGREE);
        all_near(&values.unwrap(), 1.0);
    }

    #[test]
    fn constant_greys_differ_by_their_lightness_alone() {
        // black to white is 100 in lightness; no feature, no chroma
        let lab = |rgb| colour::hunt_adjusted_lab(rgb);
        let most = colour::hyab(lab([0.0, 1.0, 0.0]), lab([0.0, 0.0, 1.0])).powf(0.7);
        let knee = 0.4 * most;
        let expected = 0.95 + 0.05 * (100f32.powf(0.7) - knee) / (most - knee);
        let white = flip(&constant([1.0; 3]), &constant([0.0; 3]), PIXELS_PER_DEGREE).unwrap();
        all_near(&white, expected);
    }

    #[test]
    fn pixels_that_are_not_finite_are_marked_and_do_not_spread() {
        let whole = constant([0.0; 3]);
        let broken = of_pixels(|i| if i == 40 { Vec3::new(0.0, f32::INFINITY, 0.0) } else { Vec3::ZERO });
        let values = flip(&broken, &whole, PIXELS_PER_DEGREE).unwrap();
        assert_eq!(values.iter().filter(|v| v.is_nan()).count(), 1);
        assert!(values[40].is_nan());
        assert!(values.iter().filter(|v| !v.is_nan()).all(|v| *v == 0.0));
    }

    #[test]
    fn pictures_of_one_size_are_asked_for() {
        let black = |width, height| film::Film::new(width, height).image();
        let refused = flip(&black(12, 8), &black(12, 9), PIXELS_PER_DEGREE);
        assert_eq!(refused, Err(CompareError::Sizes(12, 8, 12, 9)));
        assert!(flip(&black(9, 12), &black(12, 9), PIXELS_PER_DEGREE).is_err());
        assert!(flip(&black(12, 0), &black(12, 0), PIXELS_PER_DEGREE).unwrap().is_empty());
    }
}
