//! Photon mapping: light walks from its sources and leaves photons at diffuse surfaces, where paths from the camera gather
//! those nearby. Jensen, "Global Illumination using Photon Maps" (1996).
//!
//! Progressive after Knaus and Zwicker, "Progressive Photon Mapping: A Probabilistic Approach" (2011): one sample of each
//! pixel is a pass with photons and a map of its own, and passes know nothing of each other but their number, from which comes the
//! radius. It shrinks so that both the noise and the bias of the passes' mean vanish.

mod eye;
mod map;
mod pinhole;
mod walk;

pub use map::{Photon, PhotonMap};

use crate::drive::lanes::{FilmJob, FilmPass};
use crate::integrator::settings::SettingsError;
use crate::sampling::sampler::SamplerKind;
use crate::stats::Stats;
use eye::Plan;
use film::Film;
use pinhole::Pinhole;
use scene::{Scene, Vec3};
use walk::{PhotonPass, Purpose, Splat};

/// How light that comes to a diffuse surface from a light directly is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DirectLight {
    /// By sampling the lights, as the path tracer does: sharp shadows, and photons for the rest.
    #[default]
    Sampled,
    /// By photons, as all other light.
    Photons,
}

impl DirectLight {
    /// All, the default first.
    pub const ALL: [Self; 2] = [Self::Sampled, Self::Photons];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sampled => "sampled",
            Self::Photons => "photons",
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|direct| direct.name() == name)
    }
}

/// The settings of one picture by photon mapping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhotonSettings {
    /// Photons that leave the lights in each pass, 1 to [`MOST_PHOTONS`].
    pub photons: u32,
    /// Of the discs in which the first pass gathers, in the scene's unit; `None` for [`usual_radius`].
    pub radius: Option<f32>,
    /// How much of the photons in a disc the next pass keeps, in (0, 1): larger shrinks the radius more slowly.
    pub alpha: f32,
    /// How light is found that comes directly from a light.
    pub direct: DirectLight,
    /// Whether the photons of the first pass are shown, a point each, instead of the light.
    pub points: bool,
    /// Where random numbers come from.
    pub sampler: SamplerKind,
    /// Selects one of 2^32 independent pictures.
    pub seed: u32,
}

/// The settings of one picture by light tracing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightTracingSettings {
    /// Photons that leave the lights for each sample of all pixels, 1 to [`MOST_PHOTONS`].
    pub photons: u32,
    /// Where random numbers come from.
    pub sampler: SamplerKind,
    /// Selects one of 2^32 independent pictures.
    pub seed: u32,
}

/// Most photons of a pass: a map has some tens of bytes for every surface that each of them comes to.
pub const MOST_PHOTONS: u32 = 1 << 22;

/// Photons of a pass if nobody says otherwise: a power of two, whose Sobol points fill every interval alike.
pub const USUAL_PHOTONS: u32 = 1 << 17;

impl Default for PhotonSettings {
    fn default() -> Self {
        PhotonSettings {
            photons: USUAL_PHOTONS,
            radius: None,
            alpha: 2.0 / 3.0,
            direct: DirectLight::Sampled,
            points: false,
            sampler: SamplerKind::default(),
            seed: 1,
        }
    }
}

impl Default for LightTracingSettings {
    fn default() -> Self {
        LightTracingSettings { photons: USUAL_PHOTONS, sampler: SamplerKind::default(), seed: 1 }
    }
}

/// The radius of a scene's first pass if nobody says otherwise: this share of the root of its bounds' surface, so that some tens of
/// photons lie in a disc where they lie as everywhere.
const SHARE_OF_BOUNDS: f32 = 1.0 / 128.0;

/// The first radius where none is set: see [`PhotonSettings::radius`].
pub fn usual_radius(scene: &Scene) -> f32 {
    let (lo, hi) = scene.bounds();
    let Vec3 { x, y, z } = hi - lo;
    let surface = 2.0 * (x * y + y * z + z * x);
    (SHARE_OF_BOUNDS * surface.sqrt()).clamp(f32::MIN_POSITIVE.sqrt(), f32::MAX.sqrt())
}

/// The radius of a pass, counted from 0, whose first one is given: equation 15 of Knaus and Zwicker.
pub fn radius_of_pass(first: f32, alpha: f32, pass: u32) -> f32 {
    let shrink = |squared: f64, i: u32| squared * (f64::from(i) + f64::from(alpha)) / (f64::from(i) + 1.0);
    (f64::from(first).powi(2) * (1..=pass).fold(1.0, shrink)).sqrt() as f32
}

impl PhotonSettings {
    /// Whether these settings mean something.
    ///
    /// # Errors
    /// What is wrong, as a line for the user.
    pub fn check(&self) -> Result<(), SettingsError> {
        check_photons(self.photons)?;
        if !(self.alpha > 0.0 && self.alpha < 1.0) {
            return Err(SettingsError::Alpha(self.alpha));
        }
        let radius = self.radius.filter(|radius| !(*radius > 0.0 && radius.is_finite()));
        radius.map_or(Ok(()), |radius| Err(SettingsError::Radius(radius)))
    }

    pub(super) fn fill(&self, film: &mut Film, job: &FilmJob) -> Stats {
        let direct = self.direct == DirectLight::Photons;
        if self.points {
            let purpose = Purpose::Marks(Pinhole::new(&job.pass));
            let pass = PhotonPass { number: 0, photons: self.photons, purpose, direct };
            let Some(traces) = pass.trace(job) else { return Stats::default() };
            let marks = marks_of_pixels(film, &traces.splats);
            return traces.stats.plus(job.fill(film, &Plan::Marks(&marks)));
        }
        each_pass(film, job, |film, job, number| {
            let traces = PhotonPass { number, photons: self.photons, purpose: Purpose::Map, direct }.trace(job)?;
            let first = self.radius.unwrap_or(job.scene.photon_radius);
            let map = PhotonMap::new(&traces.photons, radius_of_pass(first, self.alpha, number));
            Some(traces.stats.plus(job.fill(film, &Plan::Map(&map, direct))))
        })
    }
}

impl LightTracingSettings {
    /// Whether these settings mean something.
    ///
    /// # Errors
    /// What is wrong, as a line for the user.
    pub fn check(&self) -> Result<(), SettingsError> {
        check_photons(self.photons)
    }

    /// Dutré, Lafortune and Willems, "Monte Carlo light tracing with direct computation of pixel intensities" (1993).
    pub(super) fn fill(&self, film: &mut Film, job: &FilmJob) -> Stats {
        each_pass(film, job, |film, job, number| {
            let purpose = Purpose::Splats(Pinhole::new(&job.pass));
            let traces = PhotonPass { number, photons: self.photons, purpose, direct: true }.trace(job)?;
            let mut radiance = vec![Vec3::ZERO; film.pixels().len()];
            traces.splats.iter().for_each(|splat| radiance[splat.pixel as usize] += splat.radiance);
            Some(traces.stats.plus(job.fill(film, &Plan::Splats(&radiance))))
        })
    }
}

fn check_photons(photons: u32) -> Result<(), SettingsError> {
    if (1..=MOST_PHOTONS).contains(&photons) { Ok(()) } else { Err(SettingsError::Photons(photons)) }
}

/// Gives each pixel one sample of each pass that it lacks. A pass that is stopped is made again by the next call, as far as pixels lack
/// it: the same photons, for they are a function of its number.
fn each_pass(film: &mut Film, job: &FilmJob, pass: impl Fn(&mut Film, &FilmJob, u32) -> Option<Stats>) -> Stats {
    let mut stats = Stats::default();
    for number in film.samples_per_pixel()..job.pass.until {
        let job = FilmJob { pass: FilmPass { until: number + 1, ..job.pass }, ..*job };
        let Some(of_pass) = pass(film, &job, number) else { break };
        stats = stats.plus(of_pass);
        if (job.stop)() {
            break;
        }
    }
    stats
}

/// A point for the last photon at each pixel.
fn marks_of_pixels(film: &Film, splats: &[Splat]) -> Vec<Vec3> {
    let mut marks = vec![Vec3::ZERO; film.pixels().len()];
    splats.iter().for_each(|splat| marks[splat.pixel as usize] = splat.radiance);
    marks
}

#[cfg(test)]
mod tests;
