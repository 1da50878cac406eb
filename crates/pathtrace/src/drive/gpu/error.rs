//! Why the device gives no picture. Each is a reason for the processor to take over.

/// What can go wrong on the way from a scene to a picture.
#[derive(Debug, thiserror::Error)]
pub enum GpuTraceError {
    /// The device failed, or was asked for too much.
    #[error(transparent)]
    Gpu(#[from] gpu::GpuError),
    /// The acceleration structure does not fit into a thread's stack.
    #[error("the scene's shapes nest {depth} deep, and a graphics device follows {limit}: render it on the CPU")]
    TooDeep {
        /// Levels of the tree.
        depth: usize,
        /// Most levels.
        limit: usize,
    },
    /// More than an index can say.
    #[error("the scene has too many {what} for a graphics device: render it on the CPU")]
    TooMany {
        /// What there is too much of: "triangles".
        what: &'static str,
    },
    /// Large meshes that do not fit into one buffer.
    #[error(
        "the large meshes and their trees need {needs} MiB, and {adapter} takes at most {limit} MiB at once: use smaller meshes, or render on the CPU"
    )]
    Meshes {
        /// What they need, at least.
        needs: u64,
        /// The most that the device takes.
        limit: u64,
        /// The adapter's name and interface.
        adapter: String,
    },
    /// A device without compute shaders, or with too few bindings.
    #[error("{adapter} can't path trace: it has {has} {what}, and {needs} are needed; render on the CPU")]
    Unable {
        /// The adapter's name and interface.
        adapter: String,
        /// Of what there is too little.
        what: &'static str,
        /// How many there are.
        has: u32,
        /// How many it takes.
        needs: u32,
    },
    /// More photons at surfaces than a map on the device can hold.
    #[error(
        "a pass leaves {found} photons at surfaces, and {adapter} has room for {limit}: ask for fewer photons, or render on the CPU"
    )]
    Photons {
        /// How many there are.
        found: u32,
        /// The most photons that fit into one binding.
        limit: u32,
        /// The adapter's name and interface.
        adapter: String,
    },
    /// What no device can follow.
    #[error("{0}: render it on the CPU")]
    ForTheProcessor(&'static str),
    /// The film does not fit into memory.
    #[error("not enough memory for {width} x {height} pixels: ask for a smaller picture")]
    Memory {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The device does not come back from its work.
    #[error("the graphics device does not answer: {0}")]
    Hangs(String),
}

impl From<gpu::wgsl::WgslError> for GpuTraceError {
    fn from(fault: gpu::wgsl::WgslError) -> Self {
        GpuTraceError::Gpu(fault.into())
    }
}
