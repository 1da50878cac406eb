//! The shaders of the device's report: every file under `shaders/bench/`.

use super::peaks::STEPS;
use gpu::wgsl::{self, Composed, Source, WgslError};

/// One line a file.
pub const SOURCES: &[Source<'static>] = gpu::wgsl_sources!["bench/peaks.wgsl"];

/// [`SOURCES`], and what they may import from beyond `shaders/bench/`.
pub const LIBRARY: [&[Source<'static>]; 2] = [SOURCES, gpu::shared_shaders::SOURCES];

/// The shader at `root` under `shaders/`.
///
/// # Errors
/// [`WgslError`] with file, line and column.
pub fn compose(root: &str) -> Result<Composed, WgslError> {
    wgsl::compose(&LIBRARY, root)
}

/// Constants that stand on both sides under one name. A test holds each against what the shaders say.
pub fn shared_constants() -> Vec<(&'static str, f64)> {
    gpu::named_values![STEPS]
}

/// Names of the overrides that pipelines are compiled with: none.
pub fn override_names() -> Vec<&'static str> {
    Vec::new()
}
