//! What pictures are compared with.

use compare::{CompareError, Errors, errors};
use film::Image;
use reference::Reference;

/// A reference as it is held against one picture after the other.
#[derive(Debug, Clone)]
pub struct ReferenceImage {
    /// Radiance of the reference, with the layer of its standard errors.
    pub image: Image,
    /// Its own mean squared error, in radiance squared; `None` of a picture from elsewhere that does not tell.
    pub noise: Option<f64>,
}

impl ReferenceImage {
    /// Works the noise out once, for all pictures to come.
    pub fn of(reference: &Reference) -> Self {
        let mut image = reference.image.clone();
        // the noise is all that is asked of the standard errors
        image.layers.clear();
        ReferenceImage { image, noise: reference.mean_squared_error() }
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
