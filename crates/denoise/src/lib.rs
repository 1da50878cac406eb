//! Denoising: from a picture of few samples and what is known of its pixels to one without noise, at the price of a bias.
//! Two filters: the U-Net of Open Image Denoise ([`Network`]), and a-trous wavelets ([`mod@a_trous`]); [`mod@trust`], which
//! goes back from either to the samples as they become many; and [`mod@temporal`], which puts a picture together with what
//! earlier ones showed, before any of them. [`mod@gpu`] has what of it runs on graphics devices.
//!
//! The networks' weights are Open Image Denoise's, published under Apache-2.0 (`assets/weights`). On lanes sums
//! are fused where the machine can: pictures agree to rounding, not to the bit, between machines of other lanes.

pub mod a_trous;
mod convolution;
pub mod gpu;
mod network;
mod oidn;
mod planes;
pub mod temporal;
mod tiles;
mod transfer;
pub mod trust;
pub mod tza;

pub use network::{Network, WeightsError};
pub use tiles::MOST_PIXELS;

use film::{Image, Vec3};

/// Whether there is memory for so many bytes beside what is in use: asked once, before the many lists that a filter fills, each of
/// which would end the program.
///
/// # Errors
/// [`DenoiseError::Memory`] where there is not.
pub fn check_memory(bytes: usize) -> Result<(), DenoiseError> {
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| DenoiseError::Memory(bytes))
}

/// Asked now and then from any thread: whether to stop.
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// What is known of each pixel beside its colour: means over its samples of what the first surface has that is no mirror
/// and no glass.
#[derive(Debug, Clone, Copy)]
pub struct Features<'a> {
    /// The share of light that it throws back, in [0, 1]; where nothing is hit, the radiance up to 1.
    pub albedo: &'a [Vec3],
    /// Its normal, 0 where nothing is hit.
    pub normal: &'a [Vec3],
}

impl Features<'_> {
    fn check(&self, color: &Image) -> Result<(), DenoiseError> {
        let pixels = color.radiances().len();
        if self.albedo.len() == pixels && self.normal.len() == pixels { Ok(()) } else { Err(DenoiseError::Size) }
    }
}

/// Why there is no denoised picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DenoiseError {
    /// The layers of the picture are of several sizes.
    #[error("colour and features have not as many pixels as each other")]
    Size,
    /// The weights make no network.
    #[error(transparent)]
    Weights(#[from] WeightsError),
    /// Somebody asked for it to stop.
    #[error("stopped before the picture was denoised")]
    Stopped,
    /// There is not so much memory, in bytes.
    #[error("not enough memory to denoise: {:.1} GiB are needed", *.0 as f64 / f64::from(1 << 30))]
    Memory(usize),
    /// The graphics device did not do it, in its own words.
    #[error("{0}")]
    Device(String),
}

impl From<::gpu::GpuError> for DenoiseError {
    fn from(fault: ::gpu::GpuError) -> Self {
        DenoiseError::Device(fault.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_memory_than_there_can_be_is_refused_with_how_much_it_is() {
        assert_eq!(check_memory(1 << 20), Ok(()));
        let bytes = isize::MAX as usize;
        let fault = check_memory(bytes).expect_err("more than the addresses that there are");
        assert_eq!(fault.to_string(), "not enough memory to denoise: 8589934592.0 GiB are needed");
    }
}
