//! What can go wrong with the fake.

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RasterError {
    /// The camera can't see; the reason names what to change.
    #[error("the camera sees nothing: {0}")]
    Camera(&'static str),
    /// A knob is turned too far; the reason names it and its range.
    #[error("{0}")]
    Knob(String),
    /// The scene has no such map.
    #[error("this scene has no {map} to show: it has no {missing}")]
    NothingToShow {
        /// What was to be shown.
        map: &'static str,
        /// What would make one.
        missing: &'static str,
    },
    /// The film does not fit into memory.
    #[error("not enough memory for {width} x {height} pixels: ask for a smaller picture")]
    Memory {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
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
