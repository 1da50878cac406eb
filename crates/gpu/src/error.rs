//! What can go wrong with a device, each in one line for the user.

/// Why the device did not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// Nothing answers.
    #[error(
        "no graphics adapter was found: install a GPU driver, or a software one (Debian, Ubuntu: apt install mesa-vulkan-drivers)"
    )]
    NoAdapter,
    /// Something may answer, but none of it can present.
    #[error(
        "no graphics adapter can draw in this window: install a GPU driver, or a software one (Debian, Ubuntu: apt install mesa-vulkan-drivers)"
    )]
    NoAdapterForWindow,
    /// It was there before.
    #[error("there is no graphics adapter {0:?}: visavis info lists those there are")]
    NoSuchAdapter(String),
    /// The adapter gives no device.
    #[error("{adapter} gives no device ({why}): update its driver, or choose another with WGPU_BACKEND=vulkan or gl")]
    Device {
        /// Name and interface.
        adapter: String,
        /// What it said.
        why: String,
    },
    /// A picture without pixels.
    #[error("{what} of {width} x {height} has no pixels: ask for at least 1 x 1")]
    Empty {
        /// What was to be made.
        what: String,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// A picture beyond the device's limit.
    #[error("{what} of {width} x {height} is too large for {adapter}: at most {limit} pixels a side")]
    TooLarge {
        /// What was to be made.
        what: String,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Most pixels along a side.
        limit: u32,
        /// Name and interface.
        adapter: String,
    },
    /// A buffer beyond the device's limit.
    #[error("{what} needs {bytes} bytes, and the graphics device takes at most {limit} at once: use a smaller one")]
    TooManyBytes {
        /// What was to be made.
        what: String,
        /// Its size.
        bytes: u64,
        /// Most bytes of one buffer.
        limit: u64,
    },
    /// The device objected.
    #[error("the graphics device refused {what}: {why}")]
    Refused {
        /// What was to be done.
        what: String,
        /// The objection.
        why: String,
    },
    /// Results did not come back.
    #[error("{what} did not come back from the graphics device: {why}")]
    Lost {
        /// What was to be read.
        what: String,
        /// What is known.
        why: String,
    },
    /// A shader is wrong.
    #[error(transparent)]
    Shader(#[from] crate::wgsl::WgslError),
}

/// A message on one line, with what caused it.
pub(crate) fn one_line(message: &impl ToString) -> String {
    message.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
