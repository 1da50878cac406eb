//! What pictures are compared with.

use super::Noise;
use compare::{CompareError, Errors, errors};
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
}
