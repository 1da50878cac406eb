//! Error metrics between two films.

use film::{Film, Vec3};

/// Why two films cannot be compared.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum CompareError {
    /// They do not have the same pixels.
    #[error("the pictures differ in size: {0}x{1} against {2}x{3}; render both at one --size")]
    Sizes(u32, u32, u32, u32),
    /// Bare pixels that are not whole rows of one picture each.
    #[error("{film} and {reference} pixels are not two pictures of rows of {width}")]
    Pixels {
        /// Pixels of the one.
        film: usize,
        /// Pixels of the other.
        reference: usize,
        /// Pixels a row.
        width: u32,
    },
    /// Noise cannot be told from bias by fewer than two films.
    #[error("{0} films do not show noise: it takes two or more of independent seeds")]
    Films(usize),
}

/// What is added to the squared reference in [`Errors::rel_mse`], in radiance squared.
pub const REL_MSE_FLOOR: f64 = 0.01;

/// How far a film is from a reference; means over all pixels that are finite in both, and the three channels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// Root of the mean squared difference, in radiance. A bright area light's edge dominates it.
    pub rmse: f64,
    /// Mean of `(a - r)^2 / (r^2 + 0.01)`: relative, with a floor that keeps black pixels from dominating. Not trimmed.
    pub rel_mse: f64,
    /// Mean absolute difference, in radiance.
    pub mae: f64,
    /// Mean of `a - r`, in radiance: positive where the film is too bright. Noise averages out of it.
    pub bias: f64,
    /// [`Errors::bias`] as a share of the reference's mean; 0 if that is black.
    pub relative_bias: f64,
    /// Pixels with a channel that is not finite in either, left out of every mean; and samples that the films
    /// themselves had left out. Anything but 0 means that something is broken.
    pub nonfinite: u64,
    /// The reference's own mean squared error, in radiance squared, if [`Errors::with_reference_noise`] told it.
    pub reference_noise: Option<f64>,
}

impl Errors {
    /// With the mean squared standard error of the reference's pixels, such as [`mean_squared_standard_error`]; 0 for
    /// an exact one.
    pub fn with_reference_noise(self, mean_squared_standard_error: f64) -> Self {
        Errors { reference_noise: Some(mean_squared_standard_error), ..self }
    }

    /// Whether what is left of the mean squared error without the reference's own is smaller than the reference's own:
    /// the figures then say nothing about the film. False where the reference's noise is not known.
    pub fn below_reference_noise(&self) -> bool {
        self.reference_noise.is_some_and(|noise| self.rmse * self.rmse - noise < noise)
    }

    /// The errors of several films against one reference as one: means, the root of the mean square for the RMSE, the
    /// sum of what is not finite. `None` of no films.
    pub fn mean(all: &[Errors]) -> Option<Errors> {
        let first = all.first()?;
        let mean = |of: fn(&Errors) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
        Some(Errors {
            rmse: mean(|e| e.rmse * e.rmse).sqrt(),
            rel_mse: mean(|e| e.rel_mse),
            mae: mean(|e| e.mae),
            bias: mean(|e| e.bias),
            relative_bias: mean(|e| e.relative_bias),
            nonfinite: all.iter().map(|e| e.nonfinite).sum(),
            reference_noise: first.reference_noise,
        })
    }
}

/// Measures `film` against `reference`.
///
/// # Errors
/// [`CompareError::Sizes`] if they do not have the same pixels.
pub fn errors(film: &Film, reference: &Film) -> Result<Errors, CompareError> {
    same_size(film, reference)?;
    let pairs = film.pixels().iter().zip(reference.pixels());
    let found = errors_of(pairs.map(|(pixel, reference)| (pixel.mean(), reference.mean())));
    Ok(Errors { nonfinite: found.nonfinite + film.nonfinite + reference.nonfinite, ..found })
}

/// The same over bare radiances, pixel by pixel in one order; pixels that only one of them has are left out.
pub fn errors_of_radiances(film: &[Vec3], reference: &[Vec3]) -> Errors {
    let wide = |radiance: &Vec3| radiance.to_array().map(f64::from);
    errors_of(film.iter().zip(reference).map(|(pixel, reference)| (wide(pixel), wide(reference))))
}

/// Mean over pixels and channels of the squared standard error of a film's pixels, in radiance squared: what its noise
/// adds to a mean squared error against it. As little to be trusted as [`Film::standard_error`].
pub fn mean_squared_standard_error(film: &Film) -> f64 {
    let sum: f64 = film.pixels().iter().flat_map(|pixel| pixel.variance_of_mean()).sum();
    sum / (3 * film.pixels().len()).max(1) as f64
}

pub(crate) fn same_size(film: &Film, reference: &Film) -> Result<(), CompareError> {
    if (film.width(), film.height()) != (reference.width(), reference.height()) {
        return Err(CompareError::Sizes(film.width(), film.height(), reference.width(), reference.height()));
    }
    Ok(())
}

pub(crate) fn same_pixels(film: &[Vec3], reference: &[Vec3], width: u32) -> Result<(), CompareError> {
    let whole_rows = film.is_empty() || film.len().checked_rem(width as usize) == Some(0);
    if film.len() != reference.len() || !whole_rows {
        return Err(CompareError::Pixels { film: film.len(), reference: reference.len(), width });
    }
    Ok(())
}

fn errors_of(pairs: impl Iterator<Item = ([f64; 3], [f64; 3])>) -> Errors {
    let mut sum = Errors::default();
    let (mut reference_sum, mut values) = (0.0, 0u64);
    for (pixel, reference) in pairs {
        if !pixel.iter().chain(&reference).all(|v| v.is_finite()) {
            sum.nonfinite += 1;
            continue;
        }
        for (value, reference) in pixel.into_iter().zip(reference) {
            let difference = value - reference;
            sum.rmse += difference * difference;
            sum.rel_mse += difference * difference / (reference * reference + REL_MSE_FLOOR);
            sum.mae += difference.abs();
            sum.bias += difference;
            reference_sum += reference;
            values += 1;
        }
    }
    let values = values.max(1) as f64;
    Errors {
        rmse: (sum.rmse / values).sqrt(),
        rel_mse: sum.rel_mse / values,
        mae: sum.mae / values,
        bias: sum.bias / values,
        relative_bias: if reference_sum > 0.0 { sum.bias / reference_sum } else { 0.0 },
        nonfinite: sum.nonfinite,
        reference_noise: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(values: [f32; 2]) -> Film {
        Film::from_radiances(2, 1, values.map(Vec3::splat)).unwrap()
    }

    #[test]
    fn a_film_equals_itself() {
        let f = film([0.3, 7.0]);
        assert_eq!(errors(&f, &f).unwrap(), Errors::default());
    }

    #[test]
    fn known_differences_give_their_closed_forms() {
        let e = errors(&film([1.5, 0.0]), &film([1.0, 1.0])).unwrap();
        assert!((e.rmse - (1.25f64 / 2.0).sqrt()).abs() < 1e-12);
        assert!((e.rel_mse - 1.25 / 2.0 / 1.01).abs() < 1e-12);
        assert!((e.mae - 0.75).abs() < 1e-12);
        assert!((e.bias + 0.25).abs() < 1e-12 && (e.relative_bias + 0.25).abs() < 1e-12);
    }

    #[test]
    fn sizes_must_agree() {
        assert_eq!(errors(&Film::new(2, 1), &Film::new(1, 2)), Err(CompareError::Sizes(2, 1, 1, 2)));
    }

    #[test]
    fn pixels_that_are_not_finite_are_counted_and_in_no_mean() {
        let reference = [Vec3::ONE, Vec3::ONE, Vec3::new(1.0, 1.0, f32::INFINITY), Vec3::ONE];
        let picture = [Vec3::splat(1.5), Vec3::new(9.0, f32::NAN, 9.0), Vec3::ONE, Vec3::splat(0.5)];
        let e = errors_of_radiances(&picture, &reference);
        assert_eq!((e.nonfinite, e.rmse, e.mae, e.bias), (2, 0.5, 0.5, 0.0));
        let broken = Film::from_radiances(2, 1, [Vec3::NAN, Vec3::ONE]).unwrap();
        assert_eq!(errors(&film([0.0, 1.0]), &broken).unwrap().nonfinite, 1);
    }

    #[test]
    fn an_error_is_flagged_when_the_references_own_covers_it() {
        let mse = |mse: f64| Errors { rmse: mse.sqrt(), ..Errors::default() };
        assert!(!mse(1e-9).below_reference_noise());
        assert!(mse(0.019).with_reference_noise(0.01).below_reference_noise());
        assert!(!mse(0.021).with_reference_noise(0.01).below_reference_noise());
        assert!(!mse(1e-9).with_reference_noise(0.0).below_reference_noise());
    }

    #[test]
    fn a_coins_squared_standard_error_is_what_binomials_say() {
        let mut film = Film::new(2, 1);
        for pixel in film.pixels_mut() {
            (0..100).for_each(|i| pixel.add(Vec3::splat((i % 2) as f32)));
        }
        assert!((mean_squared_standard_error(&film) - 0.25 / 99.0).abs() < 1e-12);
    }

    #[test]
    fn the_mean_of_several_is_that_of_their_squares_for_the_rmse() {
        let of = |rmse, bias| Errors { rmse, bias, nonfinite: 1, ..Errors::default() };
        let e = Errors::mean(&[of(3.0, 1.0), of(4.0, -1.0)]).unwrap();
        assert!((e.rmse - 12.5f64.sqrt()).abs() < 1e-12 && e.bias == 0.0 && e.nonfinite == 2);
        assert_eq!(Errors::mean(&[]), None);
    }
}
