//! Error metrics between two films.

use scene::{Film, Vec3};

/// Why two films cannot be compared.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum CompareError {
    /// They do not have the same pixels.
    #[error("the pictures differ in size: {0}x{1} against {2}x{3}; render both at one --size")]
    Sizes(u32, u32, u32, u32),
}

/// How far a film is from a reference; means over all pixels and the three channels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// Root of the mean squared difference, in radiance. A bright lamp's edge dominates it.
    pub rmse: f64,
    /// Mean of `(a - r)^2 / (r^2 + 0.01)`: relative, with a floor that keeps black pixels from dominating.
    pub rel_mse: f64,
    /// Mean absolute difference, in radiance.
    pub mae: f64,
    /// Mean of `a - r`, in radiance: positive where the film is too bright. Noise averages out of it.
    pub bias: f64,
    /// [`Errors::bias`] as a share of the reference's mean; 0 if that is black.
    pub relative_bias: f64,
}

/// Measures `film` against `reference`.
///
/// # Errors
/// [`CompareError::Sizes`] if they do not have the same pixels.
pub fn errors(film: &Film, reference: &Film) -> Result<Errors, CompareError> {
    if (film.width(), film.height()) != (reference.width(), reference.height()) {
        return Err(CompareError::Sizes(film.width(), film.height(), reference.width(), reference.height()));
    }
    let pairs = film.pixels().iter().zip(reference.pixels());
    Ok(errors_of(pairs.map(|(pixel, reference)| (pixel.mean(), reference.mean()))))
}

/// The same over bare radiances, pixel by pixel in one order; pixels that only one of them has are left out.
pub fn errors_of_radiances(film: &[Vec3], reference: &[Vec3]) -> Errors {
    let wide = |radiance: &Vec3| radiance.to_array().map(f64::from);
    errors_of(film.iter().zip(reference).map(|(pixel, reference)| (wide(pixel), wide(reference))))
}

fn errors_of(pairs: impl Iterator<Item = ([f64; 3], [f64; 3])>) -> Errors {
    let mut sum = Errors::default();
    let (mut reference_sum, mut values) = (0.0, 0u64);
    for (pixel, reference) in pairs {
        for (value, reference) in pixel.into_iter().zip(reference) {
            let difference = value - reference;
            sum.rmse += difference * difference;
            sum.rel_mse += difference * difference / (reference * reference + 0.01);
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
}
