//! The shaders that belong to no renderer: what the rasteriser and the path tracer share, and films.

/// One line a file, in the order of their paths. in the order of their paths.
pub const SOURCES: &[crate::wgsl::Source<'static>] =
    crate::wgsl_sources!["film/resolve.wgsl", "shared/checkerboard.wgsl",];
