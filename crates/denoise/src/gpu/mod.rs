//! Denoising on the graphics device.

pub mod unet;

use crate::DenoiseError;
use ::gpu::wgsl::Source;
use ::gpu::{GpuError, named_values, shared_shaders, wgsl_sources};

/// Every file under `shaders/denoise/` but for that of halves, one line each.
pub const SOURCES: &[Source<'static>] = wgsl_sources![
    "denoise/unet/convolution.wgsl",
    "denoise/unet/input.wgsl",
    "denoise/unet/layer.wgsl",
    "denoise/unet/number.wgsl",
    "denoise/unet/output.wgsl",
    "denoise/unet/transfer.wgsl",
];

/// [`SOURCES`], and what they import from beyond `shaders/denoise/`.
pub const LIBRARY: [&[Source<'static>]; 2] = [SOURCES, shared_shaders::SOURCES];

/// Constants that stand on both sides under one name. A test holds each against what the shaders say.
pub fn shared_constants() -> Vec<(&'static str, f64)> {
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

impl From<GpuError> for DenoiseError {
    fn from(why: GpuError) -> Self {
        DenoiseError::Device(why.to_string())
    }
}
