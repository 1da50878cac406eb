//! What several measurements say together: a power law through points, what an error is worth per second, and an
//! error's split into bias and noise.

use crate::CompareError;
use crate::metrics::same_size;
use film::Film;

/// A power law `y = 10^intercept x^slope`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Exponent: -1 of a mean squared error against samples is what Monte Carlo promises.
    pub slope: f64,
    /// Standard error of the slope, from the residuals.
    pub slope_error: f64,
    /// log10 of y at x = 1.
    pub intercept: f64,
}

impl Fit {
    /// The law's y at `x` > 0.
    pub fn at(&self, x: f64) -> f64 {
        10f64.powf(self.intercept + self.slope * x.log10())
    }
}

/// Ordinary least squares over log10 x and log10 y. Points (x, y) that are not positive and finite are left out; `None`
/// below three that are, where residuals say nothing, and where all x are the same.
pub fn fit(points: &[(f64, f64)]) -> Option<Fit> {
    let usable = |v: f64| v > 0.0 && v.is_finite();
    let logs: Vec<(f64, f64)> =
        points.iter().filter(|(x, y)| usable(*x) && usable(*y)).map(|(x, y)| (x.log10(), y.log10())).collect();
    if logs.len() < 3 {
        return None;
    }
    let n = logs.len() as f64;
    let (x_mean, y_mean) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    let sxx: f64 = logs.iter().map(|(x, _)| (x - x_mean).powi(2)).sum();
    let sxy: f64 = logs.iter().map(|(x, y)| (x - x_mean) * (y - y_mean)).sum();
    let slope = sxy / sxx;
    let intercept = y_mean - slope * x_mean;
    let residuals: f64 = logs.iter().map(|(x, y)| (y - intercept - slope * x).powi(2)).sum();
    let slope_error = (residuals / (n - 2.0) / sxx).sqrt();
    (sxx > 1e-20).then_some(Fit { slope, slope_error, intercept })
}

/// Monte Carlo efficiency `1 / (mse * seconds)`: for one estimator the same at any number of samples, so that two can
/// be compared. Infinite where there is no error.
pub fn efficiency(mse: f64, seconds: f64) -> f64 {
    1.0 / (mse * seconds)
}

/// A mean squared error as `bias^2 + variance`; means over pixels and channels, in radiance squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSplit {
    /// Mean squared error of one film against the reference as it is, noise of the reference included.
    pub mse: f64,
    /// What differs from seed to seed in one film. Unbiased.
    pub variance: f64,
    /// What all seeds have in common against the truth. Unbiased, hence below 0 by chance where there is no bias.
    pub bias_squared: f64,
    /// Standard error of [`ErrorSplit::bias_squared`], from its spread over pixels as if they were independent.
    pub bias_squared_error: f64,
    /// The reference's own mean squared error, as it was given.
    pub reference_noise: f64,
    /// Pixels left out: not finite in the reference or in a film.
    pub nonfinite: u64,
}

/// Splits the error of films that differ in nothing but independent seeds. With mean m and sample variance s^2 over K
/// films, `(m - r)^2` exceeds `bias^2` by `s^2 / K` and by the variance of the reference r: both are taken away.
///
/// `reference_noise` is the reference's own mean squared error, such as [`crate::mean_squared_standard_error`]; 0 for
/// an exact one. The reference must not share its seeds with the films.
///
/// # Errors
/// [`CompareError::Films`] of fewer than two films, [`CompareError::Sizes`] if one does not have the reference's
/// pixels.
pub fn split_error(films: &[&Film], reference: &Film, reference_noise: f64) -> Result<ErrorSplit, CompareError> {
    if films.len() < 2 {
        return Err(CompareError::Films(films.len()));
    }
    let size = |film: &Film| (film.width(), film.height());
    films.iter().try_for_each(|film| same_size(size(film), size(reference)))?;
    let k = films.len() as f64;
    let (mut mse, mut variance, mut bias, mut bias_of_squares) = (0.0, 0.0, 0.0, 0.0);
    let (mut pixels, mut nonfinite) = (0u64, 0);
    for (i, truth) in reference.pixels().iter().enumerate() {
        let truth = truth.mean();
        let values: Vec<[f64; 3]> = films.iter().map(|film| film.pixels()[i].mean()).collect();
        if !values.iter().flatten().chain(&truth).all(|v| v.is_finite()) {
            nonfinite += 1;
            continue;
        }
        pixels += 1;
        let mut of_pixel = 0.0;
        for (c, truth) in truth.into_iter().enumerate() {
            let mean = values.iter().map(|v| v[c]).sum::<f64>() / k;
            let s2 = values.iter().map(|v| (v[c] - mean).powi(2)).sum::<f64>() / (k - 1.0);
            mse += values.iter().map(|v| (v[c] - truth).powi(2)).sum::<f64>() / k / 3.0;
            variance += s2 / 3.0;
            of_pixel += ((mean - truth).powi(2) - s2 / k) / 3.0;
        }
        bias += of_pixel;
        bias_of_squares += of_pixel * of_pixel;
    }
    let n = pixels.max(1) as f64;
    let spread = (bias_of_squares / n - (bias / n).powi(2)).max(0.0);
    Ok(ErrorSplit {
        mse: mse / n,
        variance: variance / n,
        bias_squared: bias / n - reference_noise,
        bias_squared_error: (spread / (n - 1.0).max(1.0)).sqrt(),
        reference_noise,
        nonfinite,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mean_squared_standard_error;
    use film::Vec3;

    #[test]
    fn a_power_law_is_found_exactly() {
        let law: Vec<(f64, f64)> = (0..6).map(|i| (2f64.powi(i), 3.0 * 2f64.powi(i).powf(-0.5))).collect();
        let f = fit(&law).unwrap();
        assert!((f.slope + 0.5).abs() < 1e-12 && (f.intercept - 3f64.log10()).abs() < 1e-12 && f.slope_error < 1e-7);
        assert!((f.at(100.0) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn residuals_give_the_textbook_error() {
        // logs (0, 0), (1, 1), (2, 0), (3, 1): slope 1/5, residual sum 4/5, error sqrt((4/5) / 2 / 5)
        let f = fit(&[(1.0, 1.0), (10.0, 10.0), (100.0, 1.0), (1000.0, 10.0)]).unwrap();
        assert!((f.slope - 0.2).abs() < 1e-12 && (f.slope_error - 0.08f64.sqrt()).abs() < 1e-12, "{f:?}");
        assert!((f.intercept - 0.2).abs() < 1e-12);
    }

    #[test]
    fn unusable_points_are_left_out_and_too_few_give_nothing() {
        let bad = [(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)];
        assert_eq!(fit(&[&bad[..], &[(1.0, 1.0), (2.0, 2.0)]].concat()), None);
        assert_eq!(fit(&[(2.0, 1.0), (2.0, 2.0), (2.0, 3.0)]), None);
        assert!(fit(&[&bad[..], &[(1.0, 1.0), (2.0, 2.0), (4.0, 4.0)]].concat()).is_some());
    }

    #[test]
    fn efficiency_is_the_same_at_twice_the_samples() {
        assert_eq!(efficiency(0.02, 3.0), efficiency(0.01, 6.0));
        assert_eq!(efficiency(0.0, 1.0), f64::INFINITY);
    }

    /// Numbers of mean 0 and variance 1: sums of twelve uniform ones.
    struct Noise(u64);

    impl Noise {
        fn next(&mut self) -> f64 {
            let mut uniform = || {
                // splitmix64
                self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
            };
            (0..12).map(|_| uniform()).sum::<f64>() - 6.0
        }
    }

    const SIZE: u32 = 64;
    const TRUTH: f64 = 10.0;

    /// A film of samples of deviation 0.8 about the truth and a bias.
    fn film(noise: &mut Noise, bias: f64, samples: u32) -> Film {
        let mut film = Film::new(SIZE, SIZE);
        for pixel in film.pixels_mut() {
            for _ in 0..samples {
                let value = |noise: &mut Noise| (TRUTH + bias + 0.8 * noise.next()) as f32;
                pixel.add(Vec3::new(value(noise), value(noise), value(noise)));
            }
        }
        film
    }

    #[test]
    fn bias_and_noise_are_told_apart_under_a_noisy_reference() {
        let mut noise = Noise(7);
        for bias in [0.0, 0.3, -0.3] {
            let films: Vec<Film> = (0..4).map(|_| film(&mut noise, bias, 4)).collect();
            let reference = film(&mut noise, 0.0, 8);
            let own = mean_squared_standard_error(&reference);
            assert!((own - 0.08).abs() < 0.002, "{own}");
            let split = split_error(&films.iter().collect::<Vec<_>>(), &reference, own).unwrap();
            // sigma^2 = 0.64 / 4; 12288 values: its standard error is below 0.0013, and that of bias^2 below 0.003
            assert!((split.variance - 0.16).abs() < 0.006, "{split:?}");
            assert!(split.bias_squared_error < 0.004, "{split:?}");
            assert!((split.bias_squared - bias * bias).abs() < 4.0 * split.bias_squared_error, "{bias} {split:?}");
            let sum = split.bias_squared + split.variance + split.reference_noise;
            assert!((split.mse - sum).abs() < 1e-9, "{split:?}");
        }
    }

    #[test]
    fn an_exact_bias_is_found_exactly() {
        let of = |value: f32| Film::from_radiances(2, 1, [Vec3::splat(value); 2]).unwrap();
        let (low, high) = (of(1.25), of(1.75));
        let split = split_error(&[&low, &high], &of(1.0), 0.0).unwrap();
        // m = 1.5, s^2 = 0.125: bias^2 = 0.25 - 0.0625
        let near = |measured: f64, expected: f64| (measured - expected).abs() < 1e-12;
        assert!(
            near(split.mse, 0.3125) && near(split.variance, 0.125) && near(split.bias_squared, 0.1875),
            "{split:?}"
        );
        assert!(near(split.bias_squared_error, 0.0));
    }

    #[test]
    fn one_film_or_another_size_is_refused() {
        let (a, b) = (Film::new(2, 1), Film::new(1, 2));
        assert_eq!(split_error(&[&a], &a, 0.0), Err(CompareError::Films(1)));
        assert_eq!(split_error(&[&a, &b], &a, 0.0), Err(CompareError::Sizes(1, 2, 2, 1)));
    }
}
