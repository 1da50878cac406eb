//! What pictures are compared with.

use compare::{Errors, errors_of_radiances};
use reference::Reference;
use scene::Vec3;
use std::sync::Arc;

/// A reference as it is held against one picture after the other.
#[derive(Debug, Clone)]
pub struct ReferenceImage {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Linear radiance, rows from the top.
    pub radiances: Arc<[Vec3]>,
    /// Its own mean squared error, in radiance squared; `None` of a picture from elsewhere that does not tell.
    pub noise: Option<f64>,
}

impl ReferenceImage {
    /// Works the noise out once, for all pictures to come.
    pub fn of(reference: &Reference) -> Self {
        ReferenceImage {
            size: (reference.width, reference.height),
            radiances: reference.radiances.as_slice().into(),
            noise: reference.mean_squared_error(),
        }
    }

    /// How far a picture of the same pixels is from it.
    pub fn errors(&self, radiances: &[Vec3]) -> Errors {
        let errors = errors_of_radiances(radiances, &self.radiances);
        self.noise.map_or(errors, |noise| errors.with_reference_noise(noise))
    }
}
