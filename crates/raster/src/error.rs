//! What can go wrong with the fake.

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RasterError {
    /// The camera can't see; the reason names what to change.
    #[error("the camera sees nothing: {0}")]
    Camera(&'static str),
    /// The device failed, or was asked for too much.
    #[error(transparent)]
    Gpu(#[from] gpu::GpuError),
    /// Fewer pixels came back than were drawn.
    #[error("the picture came back incomplete from the graphics device: render it again")]
    Incomplete,
}

impl From<gpu::wgsl::WgslError> for RasterError {
    fn from(fault: gpu::wgsl::WgslError) -> Self {
        RasterError::Gpu(fault.into())
    }
}
