//! The rasteriser's shaders: every file under `shaders/raster/`. A new one is one line of [`SOURCES`].

use gpu::wgsl::{self, Composed, Source, WgslError};

/// One line a file.
pub const SOURCES: &[Source<'static>] = gpu::wgsl_sources![
    "raster/forward.wgsl",
    "raster/refraction.wgsl",
    "raster/shading.wgsl",
    "raster/shadow.wgsl",
    "raster/shadow_map.wgsl",
    "raster/view.wgsl",
];

/// [`SOURCES`], and what they import from beyond `shaders/raster/`.
pub const LIBRARY: [&[Source<'static>]; 2] = [SOURCES, gpu::shared_shaders::SOURCES];

/// The shader at `root` under `shaders/`.
///
/// # Errors
/// [`WgslError`] with file, line and column.
pub fn compose(root: &str) -> Result<Composed, WgslError> {
    wgsl::compose(&LIBRARY, root)
}
