//! What pictures are compared with.

use super::Noise;
use compare::{CompareError, Errors, PixelRect, errors, errors_within};
use film::{Image, Vec3};
use reference::Reference;
use std::sync::Arc;

/// A reference as it is held against one picture after the other.
#[derive(Debug, Clone)]
pub struct ReferenceImage {
    /// Radiance of the reference.
    pub image: Image,
    /// Standard errors of its pixels; `None` of a picture from elsewhere that does not tell.
    pub standard_errors: Option<Arc<[Vec3]>>,
    /// Its own mean squared error, in radiance squared; `None` of a picture from elsewhere that does not tell.
    pub noise: Option<f64>,
}

impl ReferenceImage {
    /// Works the noise out once, for all pictures to come.
    pub fn of(reference: &Reference) -> Self {
        let mut image = reference.image.clone();
        image.layers.clear();
        let standard_errors = reference.standard_errors().map(Arc::from);
        ReferenceImage { image, standard_errors, noise: reference.mean_squared_error() }
    }

    /// What is known of the noise of its pixels.
    pub fn noise_of_pixels(&self) -> Noise {
        self.standard_errors.clone().map_or(Noise::None, Noise::StandardErrors)
    }

    /// How far a picture of the same pixels is from it.
    ///
    /// # Errors
    /// [`CompareError::Sizes`] if it is of another size.
    pub fn errors(&self, image: &Image) -> Result<Errors, CompareError> {
        let errors = errors(image, &self.image)?;
        Ok(self.noise.map_or(errors, |noise| errors.with_reference_noise(noise)))
    }
    /// How far a picture of the same pixels is from it in a rectangle, whose noise alone counts.
    ///
    /// # Errors
    /// [`CompareError::Sizes`] if it is of another size.
    pub fn errors_within(&self, image: &Image, rect: &PixelRect) -> Result<Errors, CompareError> {
        let errors = errors_within(image, &self.image, rect)?;
        Ok(self.noise_within(rect).map_or(errors, |noise| errors.with_reference_noise(noise)))
    }

    /// Mean squared error of its own in a rectangle.
    fn noise_within(&self, rect: &PixelRect) -> Option<f64> {
        let errors = rect.of(self.standard_errors.as_deref()?, self.image.width());
        let squares = errors.flat_map(|error| error.to_array()).map(|error| f64::from(error).powi(2));
        let (sum, count) = squares.fold((0.0, 0u32), |(sum, count), square| (sum + square, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_a_rectangle_its_noise_is_that_of_the_pixels_there() {
        let errors = [0.5, 0.1, 0.2, 0.5].map(Vec3::splat);
        let image = Image::new(4, 1, [Vec3::ONE; 4]).unwrap();
        let reference =
            ReferenceImage { image: image.clone(), standard_errors: Some(errors.into()), noise: Some(0.1375) };
        let rect = PixelRect { start: (1, 0), end: (3, 1) };
        let noise = |errors: Result<Errors, _>| errors.unwrap().reference_noise.unwrap();
        assert!((noise(reference.errors_within(&image, &rect)) - 0.025).abs() < 1e-7);
        let whole = PixelRect { start: (0, 0), end: (4, 1) };
        assert!((noise(reference.errors_within(&image, &whole)) - noise(reference.errors(&image))).abs() < 1e-7);
    }
}
