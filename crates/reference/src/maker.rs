//! Making a reference, replicate by replicate, until it is good enough.

use crate::Reference;
use film::Film;
use pathtrace::{Estimator, FEWEST_REPLICATES, PathSettings};
use scene::{Camera, Vec3};
use technique::{Accumulation, Renderer, Shot};

/// Samples per pixel of each of a reference's independent pictures.
pub const SAMPLES_PER_REPLICATE: u32 = 64;

/// Replicate `i` has this seed plus `i`. Pictures that are compared must not share them: all else begins at 1.
const FIRST_SEED: u32 = 0x5eed_0000;

/// When a reference is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Its own relMSE is this or less.
    pub rel_mse: f64,
    /// Or it took this long, in seconds.
    pub seconds: f64,
}

impl Default for Goal {
    /// Noise that no picture of a few thousand samples comes near, or two minutes.
    fn default() -> Self {
        Goal { rel_mse: 1e-5, seconds: 120.0 }
    }
}

/// A reference in the making.
pub struct Maker<'a> {
    renderer: &'a mut Renderer,
    camera: Camera,
    film: Film,
    /// The replicate in hand.
    picture: Accumulation,
    seconds: f64,
}

impl<'a> Maker<'a> {
    /// Begins one, or goes on with one that is there. `renderer` has the shot's scene. `None` if there is no
    /// memory for it.
    pub fn new(renderer: &'a mut Renderer, shot: &Shot, begun: Option<&Reference>) -> Option<Self> {
        let begun = begun.filter(|r| r.image.size() == shot.size && r.replicates > 0);
        let film = match begun {
            Some(reference) => reference.film()?,
            None => Film::try_new(shot.size.0, shot.size.1)?,
        };
        let seconds = begun.map_or(0.0, |reference| reference.seconds);
        let picture = Accumulation::blank(shot.size)?;
        Some(Maker { renderer, camera: shot.camera, film, picture, seconds })
    }

    /// How references are traced: both ways to find light, weighted, so that no sample is unbounded; no limit of
    /// bounces.
    pub fn settings(seed: u32) -> PathSettings {
        PathSettings { estimator: Estimator::MIS, seed, ..PathSettings::default() }
    }

    /// Adds one replicate. False if `stop` said so meanwhile: the next call goes on with what was traced of it.
    pub fn step(&mut self, stop: &(impl Fn() -> bool + Sync)) -> bool {
        let integrator = Self::settings(FIRST_SEED.wrapping_add(self.replicates())).into();
        let Maker { renderer, camera, film, picture, seconds } = self;
        while picture.spp() < SAMPLES_PER_REPLICATE && !stop() {
            let missing = SAMPLES_PER_REPLICATE - picture.spp();
            let added = renderer.add(picture, camera, &integrator, missing, stop);
            // where a device has failed the processor makes what is missing then
            added.and_then(|()| renderer.resolve(picture)).unwrap_or_default();
        }
        if picture.spp() < SAMPLES_PER_REPLICATE {
            return false;
        }
        *seconds += picture.spent().as_secs_f64();
        film.nonfinite += picture.film().nonfinite;
        for (pixel, one) in film.pixels_mut().iter_mut().zip(picture.film().pixels()) {
            pixel.add(Vec3::from_array(one.mean().map(|v| v as f32)));
        }
        picture.clear();
        true
    }

    /// Replicates so far. Below [`FEWEST_REPLICATES`] their spread says too little.
    pub fn replicates(&self) -> u32 {
        self.film.samples_per_pixel()
    }

    /// Seconds spent so far, those of a reference that was gone on with included.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Whether there are enough replicates, and the goal is met.
    pub fn is_done(&self, goal: &Goal) -> bool {
        let enough = self.replicates() >= FEWEST_REPLICATES;
        enough && (self.seconds >= goal.seconds || self.reference().rel_mse().is_some_and(|own| own <= goal.rel_mse))
    }

    /// How far it is on its way to the goal, from 0 to 1, by what takes least time.
    pub fn progress(&self, goal: &Goal) -> f64 {
        let replicates = f64::from(self.replicates()) / f64::from(FEWEST_REPLICATES);
        let own = if self.replicates() < 2 { None } else { self.reference().rel_mse() };
        // noise falls like 1 / replicates
        let by_noise = own.filter(|own| *own > 0.0).map_or(0.0, |own| goal.rel_mse / own);
        replicates.min(by_noise.max(self.seconds / goal.seconds)).clamp(0.0, 1.0)
    }

    /// What there is so far.
    pub fn reference(&self) -> Reference {
        Reference::of_film(&self.film, self.seconds)
    }
}
