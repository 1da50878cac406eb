//! Error metrics between two pictures.

use crate::PixelRect;
use film::{Film, Image, Pixel, Vec3};

/// Why pictures cannot be compared.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum CompareError {
    /// They do not have the same pixels.
    #[error("the pictures differ in size: {0}x{1} against {2}x{3}; render both at one --size")]
    Sizes(u32, u32, u32, u32),
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
    /// [`Errors::mae`] as a share of the reference's mean, what a picture is off on average; 0 if that is black.
    pub relative_mae: f64,
    /// Mean of `a - r`, in radiance: positive where the film is too bright. Noise averages out of it. Of one noisy
    /// picture it is a mean difference; a bias only in the mean of many.
    pub bias: f64,
    /// [`Errors::bias`] as a share of the reference's mean; 0 if that is black.
    pub relative_bias: f64,
    /// Pixels with a channel that is not finite in either, left out of every mean. Anything but 0 means that something
    /// is broken.
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
            relative_mae: mean(|e| e.relative_mae),
            bias: mean(|e| e.bias),
            relative_bias: mean(|e| e.relative_bias),
            nonfinite: all.iter().map(|e| e.nonfinite).sum(),
            reference_noise: first.reference_noise,
        })
    }
}

/// Measures `image` against `reference`.
///
/// # Errors
/// [`CompareError::Sizes`] if they do not have the same pixels.
pub fn errors(image: &Image, reference: &Image) -> Result<Errors, CompareError> {
    same_size(image.size(), reference.size())?;
    Ok(errors_of(image.radiances().iter().zip(reference.radiances())))
}

/// Measures the pixels of `image` in a rectangle against those of `reference` there.
///
/// # Errors
/// [`CompareError::Sizes`] if they do not have the same pixels.
pub fn errors_within(image: &Image, reference: &Image, rect: &PixelRect) -> Result<Errors, CompareError> {
    same_size(image.size(), reference.size())?;
    let [image, reference] = [image, reference].map(|image| rect.of(image.radiances(), image.width()));
    Ok(errors_of(image.zip(reference)))
}

fn errors_of<'a>(pairs: impl Iterator<Item = (&'a Vec3, &'a Vec3)>) -> Errors {
    let mut sum = Errors::default();
    let (mut reference_sum, mut values) = (0.0, 0u64);
    for (pixel, reference) in pairs {
        if !pixel.is_finite() || !reference.is_finite() {
            sum.nonfinite += 1;
            continue;
        }
        for (value, reference) in pixel.to_array().into_iter().zip(reference.to_array()) {
            let (value, reference) = (f64::from(value), f64::from(reference));
            let difference = value - reference;
            sum.rmse += difference * difference;
            sum.rel_mse += difference * difference / (reference * reference + REL_MSE_FLOOR);
            sum.mae += difference.abs();
            sum.bias += difference;
            reference_sum += reference;
            values += 1;
        }
    }
    let share_of_the_reference = |sum: f64| if reference_sum > 0.0 { sum / reference_sum } else { 0.0 };
    let values = values.max(1) as f64;
    Errors {
        rmse: (sum.rmse / values).sqrt(),
        rel_mse: sum.rel_mse / values,
        mae: sum.mae / values,
        // of black there is no share
        relative_mae: if reference_sum > 0.0 || sum.mae == 0.0 { share_of_the_reference(sum.mae) } else { f64::NAN },
        bias: sum.bias / values,
        relative_bias: share_of_the_reference(sum.bias),
        nonfinite: sum.nonfinite,
        reference_noise: None,
    }
}

/// Mean over pixels and channels of the squared standard error of a film's pixels, in radiance squared: what its noise
/// adds to a mean squared error against it. As little to be trusted as [`Film::standard_error`].
pub fn mean_squared_standard_error(film: &Film) -> f64 {
    let sum: f64 = film.pixels().iter().flat_map(|pixel| pixel.variance_of_mean()).sum();
    sum / (3 * film.pixels().len()).max(1) as f64
}

/// Pixels between two that [`is_visibly_noisy`] looks at: a prime, so that they lie in no column.
const NOISE_STRIDE: usize = 7;
/// A standard error that is seen as grain: this share of what the pixel shows, which is never darker than this radiance
/// to an eye beside bright ones.
const VISIBLE_NOISE: (f64, f64) = (0.1, 0.1);
/// Pixels with such grain, as a share of all, from which on it is worth a word.
const NOISY_PIXELS: f64 = 0.004;

/// Whether a film looks noisy somewhere: in more than 4 of 1000 pixels one channel's standard error, from the samples'
/// spread, is more than a tenth of its value. An upper bound where samples are not independent of each other. One sample
/// has no spread and is never less noisy than more of them: a film of one is taken for noisy.
pub fn is_visibly_noisy(film: &Film) -> bool {
    let (share, least) = VISIBLE_NOISE;
    let is_noisy = |pixel: &&Pixel| {
        let errors = pixel.variance_of_mean().map(f64::sqrt);
        errors.into_iter().zip(pixel.mean()).any(|(error, mean)| error > share * mean.max(least))
    };
    let noisy = film.pixels().iter().step_by(NOISE_STRIDE).filter(is_noisy).count();
    film.samples_per_pixel() == 1 || (noisy * NOISE_STRIDE) as f64 > NOISY_PIXELS * film.pixels().len() as f64
}

pub(crate) fn same_size(picture: (u32, u32), reference: (u32, u32)) -> Result<(), CompareError> {
    if picture != reference {
        return Err(CompareError::Sizes(picture.0, picture.1, reference.0, reference.1));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(radiances: &[Vec3]) -> Image {
        Image::new(radiances.len() as u32, 1, radiances).unwrap()
    }

    fn greys(values: [f32; 2]) -> Image {
        row(&values.map(Vec3::splat))
    }

    #[test]
    fn a_picture_equals_itself() {
        let f = greys([0.3, 7.0]);
        assert_eq!(errors(&f, &f).unwrap(), Errors::default());
    }

    #[test]
    fn known_differences_give_their_closed_forms() {
        let e = errors(&greys([1.5, 0.0]), &greys([1.0, 1.0])).unwrap();
        assert!((e.rmse - (1.25f64 / 2.0).sqrt()).abs() < 1e-12);
        assert!((e.rel_mse - 1.25 / 2.0 / 1.01).abs() < 1e-12);
        assert!((e.mae - 0.75).abs() < 1e-12);
        let dim = errors(&greys([0.75, 0.0]), &greys([0.5, 0.5])).unwrap();
        assert!((dim.mae - 0.375).abs() < 1e-12 && (dim.relative_mae - 0.75).abs() < 1e-12, "a share has no unit");
        assert!((e.bias + 0.25).abs() < 1e-12 && (e.relative_bias + 0.25).abs() < 1e-12);
    }

    #[test]
    fn in_a_rectangle_they_are_those_of_the_pictures_cut_to_it() {
        let image = |scale: f32| Image::new(4, 3, (0..12).map(|i| Vec3::splat(scale * i as f32)).collect::<Vec<_>>());
        let cut = |scale: f32| row(&[5, 6, 9, 10].map(|i| Vec3::splat(scale * i as f32)));
        let rect = PixelRect { start: (1, 1), end: (3, 3) };
        let within = errors_within(&image(1.5).unwrap(), &image(1.0).unwrap(), &rect).unwrap();
        assert_eq!(within, errors(&cut(1.5), &cut(1.0)).unwrap());
        assert!(within.rmse > 0.0);
    }

    #[test]
    fn sizes_must_agree() {
        let black = |width, height| Film::new(width, height).image();
        assert_eq!(errors(&black(2, 1), &black(1, 2)), Err(CompareError::Sizes(2, 1, 1, 2)));
    }

    #[test]
    fn pixels_that_are_not_finite_are_counted_and_in_no_mean() {
        let reference = [Vec3::ONE, Vec3::ONE, Vec3::new(1.0, 1.0, f32::INFINITY), Vec3::ONE];
        let picture = [Vec3::splat(1.5), Vec3::new(9.0, f32::NAN, 9.0), Vec3::ONE, Vec3::splat(0.5)];
        let e = errors(&row(&picture), &row(&reference)).unwrap();
        assert_eq!((e.nonfinite, e.rmse, e.mae, e.bias), (2, 0.5, 0.5, 0.0));
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
    fn noise_is_seen_where_enough_pixels_have_more_than_a_tenth_of_their_value() {
        // a share of pixels are coins of 0 or 1, whose standard error after n samples is .5 / sqrt(n - 1); the rest is .5
        let noisy = |samples: u32, coins: usize| {
            let mut film = Film::new(1000, 7);
            for (at, pixel) in film.pixels_mut().iter_mut().enumerate() {
                let coin = at < 7 * coins;
                (0..samples).for_each(|i| pixel.add(Vec3::splat(if coin { (i % 2) as f32 } else { 0.5 })));
            }
            is_visibly_noisy(&film)
        };
        assert!(noisy(64, 5) && !noisy(64, 3), "5 and 3 of 1000");
        assert!(!noisy(128, 1000), "a standard error of .044");
        assert!(noisy(1, 0), "one sample tells no spread");
    }

    #[test]
    fn the_mean_of_several_is_that_of_their_squares_for_the_rmse() {
        let of = |rmse, bias| Errors { rmse, bias, nonfinite: 1, ..Errors::default() };
        let e = Errors::mean(&[of(3.0, 1.0), of(4.0, -1.0)]).unwrap();
        assert!((e.rmse - 12.5f64.sqrt()).abs() < 1e-12 && e.bias == 0.0 && e.nonfinite == 2);
        assert_eq!(Errors::mean(&[]), None);
    }
}
