//! The filters' shaders: every file under `shaders/denoise/`. A new one is one line of [`SOURCES`].

use super::unet;
use gpu::named_values;
use gpu::wgsl::{self, Composed, Source, WgslError};

/// Every file but for that of halves, one line each.
pub const SOURCES: &[Source<'static>] = gpu::wgsl_sources![
    "denoise/a_trous/finish.wgsl",
    "denoise/a_trous/pass.wgsl",
    "denoise/a_trous/picture.wgsl",
    "denoise/a_trous/prepare.wgsl",
    "denoise/unet/convolution.wgsl",
    "denoise/unet/input.wgsl",
    "denoise/unet/layer.wgsl",
    "denoise/unet/number.wgsl",
    "denoise/unet/output.wgsl",
    "denoise/unet/transfer.wgsl",
];

/// [`SOURCES`], and what they may import from beyond `shaders/denoise/`.
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
    [crate::a_trous::shared_constants(), constants_of_the_network()].concat()
}

fn constants_of_the_network() -> Vec<(&'static str, f64)> {
    use crate::convolution::{TAPS, TAPS_OF_DOUBLED};
    use crate::transfer::*;
    use unet::weights::{BLOCKS_OF_A_GROUP, TILE};
    named_values![
        BLOCKS_OF_A_GROUP,
        PU_A,
        PU_B,
        PU_C,
        PU_D,
        PU_E,
        PU_F,
        PU_G,
        PU_X0,
        PU_X1,
        PU_Y0,
        PU_Y1,
        TAPS,
        TAPS_OF_DOUBLED,
        TILE,
    ]
}

/// Names of the overrides that pipelines are compiled with.
pub fn override_names() -> Vec<&'static str> {
    unet::ONE_BLOCK.map(|(name, _)| name).to_vec()
}
