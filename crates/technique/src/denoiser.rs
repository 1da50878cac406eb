//! What a traced picture goes through between film and display.

use crate::{Accumulation, DeviceFilters, Filters, Renderer, Reused};
use denoise::a_trous::{Guide, a_trous};
use denoise::trust::{Parts, Trusted, trust};
use denoise::{DenoiseError, Network, Stop, WeightsError, check_memory};
use film::colour::{luminance, srgb_decode};
use film::{Features, Film, Image, LayerValues, Vec3};
use std::sync::{Arc, LazyLock};
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

    /// What its network is called among those of Open Image Denoise; `None` if it is none.
    pub fn network_name(self) -> Option<&'static str> {
        self.network()?.as_ref().ok().map(Network::name)
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

    /// What it makes of means of samples, by `filters`; what is the processor's runs on the current rayon pool. `variance` is that of the means' luminance, where it is
    /// known.
    ///
    /// # Errors
    /// [`DenoiseError`] if `stop` said so, or if there is not enough memory.
    pub fn apply(
        self,
        image: &Image,
        features: &Features,
        variance: Option<&[f32]>,
        filters: &Filters,
        stop: Stop,
    ) -> Result<Image, DenoiseError> {
        let guides = denoise::Features { albedo: &features.albedo, normal: &features.normal };
        match self.network() {
            Some(network) => {
                let network = network.as_ref().map_err(Clone::clone)?;
                filters.run(
                    |device| device.unet(network)?.denoise(image, guides, stop),
                    || network.denoise(image, guides, stop),
                )
            }
            None if self == Self::ATrous => {
                let guide = Guide { features: guides, depth: &features.depth, variance };
                filters.run(|device| device.a_trous()?.apply(image, guide, stop), || a_trous(image, guide, stop))
            }
            None => Ok(image.clone()),
        }
    }
}

/// A denoiser, how far to go back from it to the samples, and what earlier views give it to begin with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DenoiseSettings {
    /// The filter that the picture goes through.
    pub denoiser: Denoiser,
    /// Which share of the way to the samples that [`mod@denoise::trust`] tells is gone, in [0, 1]; at 0 it is not asked, and the
    /// filter has all samples at once.
    pub trust: f32,
    /// Whether that share is shown, pixel by pixel, in place of the picture.
    pub shows_trust: bool,
    /// As how many samples of a pixel earlier views count at most, while the camera moves; at 0 none do.
    pub history: u32,
}

impl DenoiseSettings {
    /// The picture as it is rendered.
    pub const OFF: Self = DenoiseSettings { denoiser: Denoiser::Off, trust: 0.0, shows_trust: false, history: 0 };

    /// Whether samples are trusted beside a filter.
    pub fn trusts(&self) -> bool {
        self.is_on() && self.trust > 0.0
    }

    /// Whether [`mod@denoise::trust`]'s weight is what is shown: where none is asked for it is the picture.
    pub fn shows_the_weight(&self) -> bool {
        self.shows_trust && self.trusts()
    }

    /// Whether there is a filter.
    pub fn is_on(&self) -> bool {
        self.denoiser != Denoiser::Off
    }

    /// Whether it asks what pixels show beside their light.
    pub fn wants_features(&self) -> bool {
        self.is_on() || self.history > 0
    }

    /// What becomes of a film, of which an `earlier` state is there to judge the filter by, as [`Denoiser::apply`] does it; or how far
    /// its samples are trusted.
    ///
    /// # Errors
    /// As [`Denoiser::apply`].
    pub fn apply(
        &self,
        film: &Film,
        earlier: Option<&Film>,
        features: &Features,
        filters: &Filters,
        stop: Stop,
    ) -> Result<Image, DenoiseError> {
        let image = self.filtered(film, earlier, features, filters, stop)?;
        Ok(if self.shows_the_weight() { weight_of(&image) } else { image })
    }

    fn filtered(
        &self,
        film: &Film,
        earlier: Option<&Film>,
        features: &Features,
        filters: &Filters,
        stop: Stop,
    ) -> Result<Image, DenoiseError> {
        let of_lists = if self.trusts() { MEMORY_OF_PARTS } else { MEMORY };
        check_memory(of_lists * film.pixels().len())?;
        let parts = earlier.filter(|_| self.trusts()).and_then(|earlier| Some((earlier, film.since(earlier)?)));
        let Some((earlier, (later, later_samples))) = parts else {
            let variance = variances(film).map(luminance_variance);
            let variance: Option<Vec<f32>> = (film.samples_per_pixel() > 1).then(|| variance.collect());
            return self.denoiser.apply(&film.image(), features, variance.as_deref(), filters, stop);
        };
        let (first, samples) = (earlier.image(), [earlier.samples_per_pixel(), later_samples]);
        let variance: Vec<Vec3> = variances(film).collect();
        let denoised = |image: &Image, samples: u32| {
            let share = samples as f32 / film.samples_per_pixel().max(1) as f32;
            let of_part: Vec<f32> = variance.iter().map(|v| luminance_variance(*v) / share).collect();
            self.denoiser.apply(image, features, Some(&of_part), filters, stop)
        };
        let denoised = [denoised(&first, samples[0])?, denoised(&later, samples[1])?];
        let parts = Parts { noisy: [&first, &later], denoised: [&denoised[0], &denoised[1]], samples };
        let Trusted { image, weight } = trust(parts, self.trust)?;
        Ok(image.with_layer(TRUST, LayerValues::Numbers(weight.into())))
    }
}

/// Bytes for each pixel beside what a filter takes by itself: the film as a picture, and its variance.
const MEMORY: usize = size_of::<Vec3>() + size_of::<f32>();

/// The same of two parts, what is made of each, and the variance of colours.
const MEMORY_OF_PARTS: usize = 5 * size_of::<Vec3>() + size_of::<f32>();

/// The layer that tells how far each pixel's samples are trusted, from 0 to 1.
pub const TRUST: &str = "trust";

/// The layer of a denoised picture that is what it was before.
pub const NOISY: &str = "noisy";

/// How far samples are trusted, as a picture in even steps of grey; nowhere if that was not asked.
pub(crate) fn weight_of(image: &Image) -> Image {
    let Some(LayerValues::Numbers(weight)) =
        image.layers.iter().find(|layer| layer.name == TRUST).map(|layer| &layer.values)
    else {
        return image.map(|_| Vec3::ZERO);
    };
    let mut weights = weight.iter();
    let mut grey = image.map(|_| Vec3::splat(srgb_decode(weights.next().copied().unwrap_or_default())));
    grey.layers.clone_from(&image.layers);
    grey
}

/// Variances of a film's means.
pub(crate) fn variances(film: &Film) -> impl Iterator<Item = Vec3> {
    film.pixels().iter().map(|pixel| Vec3::from_array(pixel.variance_of_mean().map(|v| v as f32)))
}

/// The variance of a luminance whose colours vary together, as those of light through one path do.
pub(crate) fn luminance_variance(of_colours: Vec3) -> f32 {
    luminance(Vec3::from_array(of_colours.to_array().map(f32::sqrt))).powi(2)
}

/// A film as a denoiser leaves it.
#[derive(Debug, Clone)]
pub struct Denoised {
    /// Linear radiance, with a bias; with a layer [`TRUST`] where samples were trusted.
    pub image: Image,
    /// Seconds that the filter took.
    pub seconds: f64,
    /// What has filtered: an adapter's name, or how many threads.
    pub made_by: String,
    /// Why the graphics device has not, where it should: one line.
    pub refused: Option<Arc<str>>,
}

impl Renderer {
    /// What becomes of a film as it was last read, or of what it was put together to with earlier views; `None` without a denoiser, or while there are no features.
    pub(crate) fn denoised(
        &self,
        accumulation: &Accumulation,
        reused: Option<&Reused>,
        settings: DenoiseSettings,
        stop: Stop,
    ) -> Option<Result<Denoised, DenoiseError>> {
        if !settings.is_on() {
            self.device_filters().into_iter().for_each(DeviceFilters::rest);
            return None;
        }
        if let Some(fault) = &accumulation.features_fault {
            return Some(Err(fault.clone()));
        }
        let (_, features) = accumulation.features.as_ref()?;
        let (film, earlier) = (accumulation.film(), accumulation.earlier_part());
        let device = self.device_filters();
        let apply = || {
            let (start, filters) = (Instant::now(), Filters::first_on(device));
            let image = match reused {
                Some(reused) => reused.denoised(film, settings, features, &filters, stop)?,
                None => settings.apply(film, earlier, features, &filters, stop)?,
            };
            let (made_by, refused) = (filters.made_by(), filters.refusal().cloned());
            Ok(Denoised { image, seconds: start.elapsed().as_secs_f64(), made_by, refused })
        };
        Some(self.threads.turn_unless(stop, self.rank, apply).unwrap_or(Err(DenoiseError::Stopped)))
    }
}
