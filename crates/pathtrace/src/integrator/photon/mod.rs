//! Photon mapping: light walks from its sources and leaves photons at diffuse surfaces, where paths from the camera gather
//! those nearby. Jensen, "Global Illumination using Photon Maps" (1996).
//!
//! Progressive after Knaus and Zwicker, "Progressive Photon Mapping: A Probabilistic Approach" (2011): one sample of each
//! pixel is a pass with photons and a map of its own, and passes know nothing of each other but their number, from which comes the
//! radius. It shrinks so that both the noise and the bias of the passes' mean vanish.

mod eye;
mod map;
mod pinhole;
mod radius;
mod seen;
mod walk;

pub(crate) use map::{MOST_CELLS, ONE_SURFACE};
pub use map::{Photon, PhotonMap};
pub use radius::{radius_of_pass, sees_little, usual_radius};
pub(crate) use walk::FIRST_DIMENSION;

use crate::drive::gpu::{PipelineKey, flag, pipelines::Bound};
use crate::drive::lanes::{FilmJob, FilmPass, Stop};
use crate::integrator::settings::SettingsError;
use crate::light::Aim;
use crate::prepared::PreparedScene;
use crate::sampling::sampler::SamplerKind;
use crate::stats::Stats;
use eye::Plan;
use film::Film;
use pinhole::Pinhole;
use scene::Vec3;
use scene::camera::PictureFrame;
use std::sync::atomic::{AtomicBool, Ordering};
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
    /// Of the discs in which the first pass gathers, in the scene's unit; `None` for [`usual_radius`], which the scene's own
    /// camera tells, not one that has moved: pictures of a camera in motion are blurred alike.
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

/// Most photons of a pass.
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

    /// What gathers on the graphics device.
    ///
    /// # Errors
    /// Where photons are shown as points.
    pub(super) fn pipeline_key(&self) -> Result<PipelineKey, &'static str> {
        if self.points {
            return Err("photons are shown as points by the processor alone");
        }
        let constants = [("DIRECT_GATHERED", flag(self.direct == DirectLight::Photons))];
        let key = PipelineKey::new("pathtrace/integrator/photon/eye.wgsl", self.sampler, &constants);
        Ok(key.bound_to(Bound::FilmAndMap))
    }

    /// What of it a pass's cost depends on: not its number.
    pub(crate) fn effort(&self) -> Self {
        PhotonSettings { seed: 0, ..*self }
    }

    /// What traces photons there.
    pub(crate) fn walk_key(&self) -> PipelineKey {
        let constants = [("DIRECT_PHOTONS", flag(self.direct == DirectLight::Photons))];
        let key = PipelineKey::new("pathtrace/integrator/photon/walk.wgsl", self.sampler, &constants);
        key.bound_to(Bound::Photons)
    }

    pub(super) fn fill(&self, film: &mut Film, job: &FilmJob) -> Stats {
        let stop = remembered(job.stop);
        let job = &FilmJob { stop: &stop, ..*job };
        let direct = self.direct == DirectLight::Photons;
        let first = self.radius.unwrap_or(job.scene.photon_radius);
        let aim = job.aim(first);
        if self.points {
            let purpose = Purpose::Marks(Pinhole::new(&job.pass));
            let pass = PhotonPass { number: 0, photons: self.photons, purpose, direct, aim: &aim };
            let mut marks = vec![Vec3::ZERO; film.pixels().len()];
            // a point for the last photon at each pixel
            let mut mark = |splat: &Splat| marks[splat.pixel as usize] = splat.radiance;
            let Some(stats) = pass.trace(job, |traces| traces.splats.iter().for_each(&mut mark)) else {
                return Stats::default();
            };
            return stats.plus(job.fill(film, &Plan::Marks(&marks)));
        }
        each_pass(film, job, |film, job, number| {
            let pass = PhotonPass { number, photons: self.photons, purpose: Purpose::Map, direct, aim: &aim };
            let mut chunks = Vec::new();
            let stats = pass.trace(job, |traces| chunks.push(traces.photons))?;
            let map = PhotonMap::new(chunks, radius_of_pass(first, self.alpha, number), job.stop)?;
            Some(stats.plus(job.fill(film, &Plan::Map(&map, direct))))
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
        let stop = remembered(job.stop);
        let job = &FilmJob { stop: &stop, ..*job };
        let aim = job.aim(0.0);
        each_pass(film, job, |film, job, number| {
            let purpose = Purpose::Splats(Pinhole::new(&job.pass));
            let pass = PhotonPass { number, photons: self.photons, purpose, direct: true, aim: &aim };
            let mut radiance = vec![Vec3::ZERO; film.pixels().len()];
            let mut splat = |splat: &Splat| radiance[splat.pixel as usize] += splat.radiance;
            let stats = pass.trace(job, |traces| traces.splats.iter().for_each(&mut splat))?;
            Some(stats.plus(job.fill(film, &Plan::Splats(&radiance))))
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

/// Says to stop for good once `stop` has: what it says later may differ, and a pass that has lost photons to it must end.
fn remembered(stop: &Stop) -> impl Fn() -> bool + Sync {
    let said = AtomicBool::new(false);
    move || {
        said.load(Ordering::Relaxed)
            || (stop() && {
                said.store(true, Ordering::Relaxed);
                true
            })
    }
}

impl FilmJob<'_> {
    /// What photons of this picture are aimed at, which count within `reach` of what is seen.
    fn aim(&self, reach: f32) -> Aim {
        aim(self.scene, &self.pass.frame, reach)
    }
}

/// What photons are aimed at in a picture that shows this of a scene, if they count within `reach` of what is seen.
pub(crate) fn aim(scene: &PreparedScene, frame: &PictureFrame, reach: f32) -> Aim {
    scene.emitters.aim(&seen::spheres(scene, frame, reach))
}

#[cfg(test)]
pub(crate) mod tests;
