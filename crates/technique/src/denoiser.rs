//! What a traced picture goes through between film and display.

use crate::{Accumulation, Renderer};
use denoise::{DenoiseError, Network, Stop, WeightsError};
use film::{Features, Film, Image};
use std::sync::LazyLock;
use std::time::Instant;

/// A filter that takes the noise out of a picture, and some of the truth: all but [`Denoiser::Off`] are biased.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Denoiser {
    /// The samples' mean as it is.
    #[default]
    Off,
    /// Wavelets with holes, guided by features and variance (Dammertz et al. 2010; Schied et al. 2017).
    ATrous,
    /// Open Image Denoise's small network.
    Unet,
    /// Its usual network, of three times as many weights.
    UnetBase,
}

impl Denoiser {
    /// All, the default first.
    pub const ALL: [Self; 4] = [Self::Off, Self::ATrous, Self::Unet, Self::UnetBase];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::ATrous => "atrous",
            Self::Unet => "unet",
            Self::UnetBase => "unet-base",
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|denoiser| denoiser.name() == name)
    }

    /// The weights that it goes by, as a hash in hexadecimal digits; `None` if it has none.
    pub fn weights(self) -> Option<String> {
        self.network()?.as_ref().ok().map(Network::hash)
    }

    fn network(self) -> Option<&'static Result<Network, WeightsError>> {
        static SMALL: LazyLock<Result<Network, WeightsError>> = LazyLock::new(Network::small);
        static BASE: LazyLock<Result<Network, WeightsError>> = LazyLock::new(Network::base);
        match self {
            Self::Off | Self::ATrous => None,
            Self::Unet => Some(&SMALL),
            Self::UnetBase => Some(&BASE),
        }
    }

    /// What it makes of a film, on the current rayon pool.
    ///
    /// # Errors
    /// [`DenoiseError`] if `stop` said so, or if there is not enough memory.
    pub fn apply(self, film: &Film, features: &Features, stop: Stop) -> Result<Image, DenoiseError> {
        let (image, guides) = (film.image(), denoise::Features { albedo: &features.albedo, normal: &features.normal });
        match self.network() {
            Some(network) => network.as_ref().map_err(Clone::clone)?.denoise(&image, guides, stop),
            None => Ok(image),
        }
    }
}

/// A film as a denoiser leaves it.
#[derive(Debug, Clone)]
pub struct Denoised {
    /// Linear radiance, with a bias.
    pub image: Image,
    /// Seconds that the filter took.
    pub seconds: f64,
}

impl Renderer {
    /// What a denoiser makes of a film as it was last read; `None` of [`Denoiser::Off`], or while there are no features.
    pub(crate) fn denoised(
        &self,
        accumulation: &Accumulation,
        denoiser: Denoiser,
        stop: Stop,
    ) -> Option<Result<Denoised, DenoiseError>> {
        let (_, features) = accumulation.features.as_ref().filter(|_| denoiser != Denoiser::Off)?;
        let film = accumulation.film();
        let apply = || {
            let start = Instant::now();
            let image = denoiser.apply(film, features, stop)?;
            Ok(Denoised { image, seconds: start.elapsed().as_secs_f64() })
        };
        Some(self.threads.turn_unless(stop, self.rank, apply).unwrap_or(Err(DenoiseError::Stopped)))
    }
}
