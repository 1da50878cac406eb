//! Errors pixel by pixel, as numbers: what a difference image colours.

use crate::flip::{PIXELS_PER_DEGREE, flip};
use crate::metrics::same_size;
use crate::{CompareError, Errors};
use film::{DisplayTransform, Image, Vec3};

/// What a map says of each pixel of a picture `a` against a reference `r`; d is `a - r` in radiance, and the three
/// channels are averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ErrorMetric {
    /// d: positive where the film is too bright. Its mean is [`Errors::bias`].
    Signed,
    /// |d|. Its mean is [`Errors::mae`].
    #[default]
    Absolute,
    /// `|d| / (|r| + 0.01)`.
    Relative,
    /// `d^2 / (r^2 + 0.01)`. Its mean is [`Errors::rel_mse`].
    SquaredRelative,
    /// FLIP in [0, 1], of the bytes that a display transform shows.
    Flip,
}

/// Keeps black references from dividing by nothing.
const FLOOR: f32 = 0.01;

impl ErrorMetric {
    /// All, in the order in which they are offered.
    pub const ALL: [ErrorMetric; 5] = [
        ErrorMetric::Signed,
        ErrorMetric::Absolute,
        ErrorMetric::Relative,
        ErrorMetric::SquaredRelative,
        ErrorMetric::Flip,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            ErrorMetric::Signed => "signed",
            ErrorMetric::Absolute => "absolute",
            ErrorMetric::Relative => "relative",
            ErrorMetric::SquaredRelative => "squared-relative",
            ErrorMetric::Flip => "flip",
        }
    }

    /// The map of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|map| map.name() == name)
    }

    /// What it shows, with its sign, for a label.
    pub fn label(self) -> &'static str {
        match self {
            ErrorMetric::Signed => "A - reference",
            ErrorMetric::Absolute => "|A - reference|",
            ErrorMetric::Relative => "|A - reference| / (reference + 0.01)",
            ErrorMetric::SquaredRelative => "(A - reference)\u{b2} / (reference\u{b2} + 0.01)",
            ErrorMetric::Flip => "FLIP",
        }
    }

    /// The same of pictures by their names: "A - B".
    pub fn label_of(self, film: &str, reference: &str) -> String {
        let label = self.label().replace("reference", "\0").replace('A', film);
        label.replace('\0', reference)
    }

    /// The map of a picture against a reference, rows from the top; NaN where either is not finite. `display` matters
    /// to [`ErrorMetric::Flip`] alone.
    ///
    /// # Errors
    /// [`CompareError::Sizes`] if they do not have the same pixels.
    pub fn of(self, image: &Image, reference: &Image, display: &DisplayTransform) -> Result<Vec<f32>, CompareError> {
        same_size(image.size(), reference.size())?;
        let pairs = image.radiances().iter().zip(reference.radiances());
        let finite = |a: &Vec3, r: &Vec3| a.is_finite() && r.is_finite();
        if self == ErrorMetric::Flip {
            let shown = [image, reference].map(|image| display.code_values_of(image));
            let mut values = flip(&shown[0], &shown[1], PIXELS_PER_DEGREE)?;
            for (value, (a, r)) in values.iter_mut().zip(pairs) {
                if !finite(a, r) {
                    *value = f32::NAN;
                }
            }
            return Ok(values);
        }
        Ok(pairs.map(|(a, r)| if finite(a, r) { self.of_pixel(*a, *r) } else { f32::NAN }).collect())
    }

    fn of_pixel(self, a: Vec3, r: Vec3) -> f32 {
        let d = a - r;
        let channels = match self {
            ErrorMetric::Signed => d,
            ErrorMetric::Absolute | ErrorMetric::Flip => d.abs(),
            ErrorMetric::Relative => d.abs() / (r.abs() + FLOOR),
            ErrorMetric::SquaredRelative => d * d / (r * r + FLOOR),
        };
        channels.element_sum() / 3.0
    }

    /// The figure that is this map's mean; `None` of those that have none in [`Errors`].
    pub fn mean_in(self, errors: &Errors) -> Option<f64> {
        match self {
            ErrorMetric::Signed => Some(errors.bias),
            ErrorMetric::Absolute => Some(errors.mae),
            ErrorMetric::SquaredRelative => Some(errors.rel_mse),
            ErrorMetric::Relative | ErrorMetric::Flip => None,
        }
    }
}

/// Mean of a map's finite values, and how many are not finite; (0, n) where none is.
pub fn finite_mean(values: &[f32]) -> (f64, u64) {
    let finite = values.iter().filter(|v| v.is_finite());
    let (sum, count) = finite.fold((0.0, 0u64), |(sum, count), v| (sum + f64::from(*v), count + 1));
    (sum / count.max(1) as f64, values.len() as u64 - count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::errors;
    use film::Film;

    const REFERENCE: [Vec3; 4] = [Vec3::ZERO, Vec3::ONE, Vec3::new(0.0, 1.0, 2.0), Vec3::ONE];
    const FILM: [Vec3; 4] = [Vec3::splat(0.5), Vec3::splat(0.25), Vec3::new(0.0, 1.0, 5.0), Vec3::ONE];

    fn image(radiances: [Vec3; 4]) -> Image {
        Image::new(2, 2, radiances).unwrap()
    }

    fn map(map: ErrorMetric, film: [Vec3; 4]) -> Vec<f32> {
        map.of(&image(film), &image(REFERENCE), &DisplayTransform::default()).unwrap()
    }

    #[test]
    fn known_differences_give_their_closed_forms() {
        let near = |measured: Vec<f32>, expected: [f32; 4]| {
            assert!(measured.iter().zip(expected).all(|(m, e)| (m - e).abs() < 1e-5), "{measured:?} {expected:?}");
        };
        near(map(ErrorMetric::Signed, FILM), [0.5, -0.75, 1.0, 0.0]);
        near(map(ErrorMetric::Absolute, FILM), [0.5, 0.75, 1.0, 0.0]);
        near(map(ErrorMetric::Relative, FILM), [50.0, 0.75 / 1.01, 3.0 / 2.01 / 3.0, 0.0]);
        near(map(ErrorMetric::SquaredRelative, FILM), [25.0, 0.5625 / 1.01, 9.0 / 4.01 / 3.0, 0.0]);
    }

    #[test]
    fn the_mean_of_a_map_is_its_figure() {
        let errors = errors(&image(FILM), &image(REFERENCE)).unwrap();
        let figures = ErrorMetric::ALL.map(|m| m.mean_in(&errors).map(|e| (finite_mean(&map(m, FILM)).0, e)));
        assert_eq!(figures.iter().flatten().count(), 3);
        assert!(figures.iter().flatten().all(|(mean, figure)| (mean - figure).abs() < 1e-6), "{figures:?}");
    }

    #[test]
    fn what_is_not_finite_is_nan_in_every_map_and_in_no_mean() {
        let mut broken = FILM;
        broken[1].z = f32::NEG_INFINITY;
        for kind in ErrorMetric::ALL {
            let values = map(kind, broken);
            assert!(values[1].is_nan() && values.iter().filter(|v| v.is_nan()).count() == 1, "{kind:?}");
            let (mean, nonfinite) = finite_mean(&values);
            assert!(mean.is_finite() && nonfinite == 1);
        }
    }

    #[test]
    fn flip_sees_what_the_exposure_shows() {
        let flip = |exposure| {
            let display = DisplayTransform { exposure };
            finite_mean(&ErrorMetric::Flip.of(&image(FILM), &image(REFERENCE), &display).unwrap()).0
        };
        assert!(flip(0.0) > 0.1 && flip(-20.0) == 0.0);
    }

    #[test]
    fn labels_name_the_pictures() {
        assert_eq!(ErrorMetric::Signed.label_of("B", "A"), "B - A");
        assert_eq!(ErrorMetric::Relative.label_of("B", "reference"), "|B - reference| / (reference + 0.01)");
        assert!(ErrorMetric::ALL.iter().all(|map| map.label_of("A", "reference") == map.label()));
    }

    #[test]
    fn pictures_must_be_of_one_size() {
        let black = |width, height| Film::new(width, height).image();
        let of = |w, h| ErrorMetric::Absolute.of(&black(w, h), &black(2, 2), &DisplayTransform::default());
        assert_eq!(of(4, 1), Err(CompareError::Sizes(4, 1, 2, 2)));
        assert_eq!(of(2, 2), Ok(vec![0.0; 4]));
    }
}
