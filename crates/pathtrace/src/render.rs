//! From paths to a film: progressive, parallel over chunks of pixels, cancelled at once.

use crate::geometry::{Accel, Ray};
use crate::light::{Lights, SunDisc};
use crate::path::{self, Forks, Plan};
use crate::sampler::Sampler;
use crate::settings::{PathSettings, SamplerKind};
use crate::whitted::{self, Waiting, WhittedSettings};
use crate::world::{Outcome, World};
use rayon::prelude::*;
use scene::film::Pixel;
use scene::glam::Vec2;
use scene::{Camera, Film, Material, Scene, Vec3};

/// A scene made ready for rays. Camera and settings come with each call, so that moving them costs no rebuild.
pub struct Tracer {
    accel: Accel,
    materials: Vec<Material>,
    lights: Lights,
    sky: Vec3,
    sun_disc: Option<SunDisc>,
    ambient: f32,
}

/// What a call of [`Tracer::render`] did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stats {
    /// Samples taken, one camera ray each.
    pub samples: u64,
    /// Rays traced, shadow rays included.
    pub rays: u64,
    /// Samples that lost light to [`PathSettings::HARD_CAP`] or [`whitted::MOST_BRANCHES`].
    pub cut_paths: u64,
}

/// Pixels that one thread takes at a time: few, so that small pictures keep all threads busy.
const CHUNK: usize = 64;

impl Tracer {
    /// Builds the acceleration structure and the list of lights.
    pub fn new(scene: &Scene) -> Self {
        let lights = Lights::new(scene);
        Tracer {
            accel: Accel::new(scene, &lights),
            materials: scene.materials.clone(),
            lights,
            sky: scene.sky,
            sun_disc: scene.sun.as_ref().and_then(SunDisc::new),
            ambient: scene.fake.ambient,
        }
    }

    /// Triangles, spheres and disks in the scene.
    pub fn primitives(&self) -> usize {
        self.accel.len()
    }

    /// The shapes, ready for rays.
    pub fn accel(&self) -> &Accel {
        &self.accel
    }

    /// What is sampled as a light.
    pub fn lights(&self) -> &Lights {
        &self.lights
    }

    /// Path traces `samples` more into every pixel of `film`, on the current rayon pool. Sample numbers go on from what
    /// each pixel has, so that many small calls give the same picture as a large one. `stop` is asked before every sample;
    /// once it says so the call returns, and pixels hold whole samples, but not all equally many: the next call brings
    /// every pixel to `samples` more than the fewest.
    ///
    /// `settings` should pass [`PathSettings::check`], which says what becomes of them if they do not.
    pub fn render(
        &self,
        film: &mut Film,
        camera: &Camera,
        settings: &PathSettings,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Stats {
        let (world, plan) = (self.world(), Plan::new(settings));
        let trace = |ray, sampler: &Sampler, forks: &mut Forks| path::trace(&world, ray, &plan, sampler, forks);
        sample_film(film, camera, (settings.sampler, settings.seed), samples, stop, trace)
    }

    /// As [`Tracer::render`], by Whitted's method.
    pub fn render_whitted(
        &self,
        film: &mut Film,
        camera: &Camera,
        settings: &WhittedSettings,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Stats {
        let world = self.world();
        let trace = |ray, sampler: &Sampler, waiting: &mut Waiting| {
            whitted::trace(&world, ray, self.ambient, settings, sampler, waiting)
        };
        sample_film(film, camera, (settings.sampler, settings.seed), samples, stop, trace)
    }

    fn world(&self) -> World<'_> {
        World {
            accel: &self.accel,
            materials: &self.materials,
            lights: &self.lights,
            sky: self.sky,
            sun_disc: self.sun_disc,
            sun_pdf: self.lights.sun_pdf(),
        }
    }
}

/// Adds `samples` of `trace` to every pixel. `Scratch` is what a walk of rays keeps between samples.
fn sample_film<Scratch: Default>(
    film: &mut Film,
    camera: &Camera,
    (kind, seed): (SamplerKind, u32),
    samples: u32,
    stop: &(impl Fn() -> bool + Sync),
    trace: impl Fn(Ray, &Sampler, &mut Scratch) -> Outcome + Sync,
) -> Stats {
    let (width, height) = (film.width(), film.height());
    let frame = camera.frame(width as f32 / height as f32);
    let size = Vec2::new(width as f32, height as f32);
    let until = film.pixels().iter().map(|pixel| pixel.samples).min().unwrap_or(0).saturating_add(samples);
    let chunks = film.pixels_mut().par_chunks_mut(CHUNK).enumerate();
    let (stats, nonfinite) = chunks
        .map(|(chunk, pixels)| {
            let (mut tally, mut scratch) = ((Stats::default(), 0), Scratch::default());
            for (offset, pixel) in pixels.iter_mut().enumerate() {
                let index = (chunk * CHUNK + offset) as u32;
                let corner = Vec2::new((index % width) as f32, (index / width) as f32);
                while pixel.samples < until {
                    if stop() {
                        return tally;
                    }
                    let sampler = Sampler { kind, pixel: index, sample: pixel.samples, seed };
                    let [jitter_x, jitter_y, _, _] = sampler.unit4(0);
                    let ray = Ray::new(frame.eye, frame.direction((corner + Vec2::new(jitter_x, jitter_y)) / size));
                    record(trace(ray, &sampler, &mut scratch), pixel, &mut tally);
                }
            }
            tally
        })
        .reduce(|| (Stats::default(), 0), |a, b| (a.0.plus(b.0), a.1 + b.1));
    film.nonfinite += nonfinite;
    stats
}

fn record(outcome: Outcome, pixel: &mut Pixel, (stats, nonfinite): &mut (Stats, u64)) {
    let finite = outcome.radiance.is_finite();
    pixel.add(if finite { outcome.radiance } else { Vec3::ZERO });
    *nonfinite += u64::from(!finite);
    stats.samples += 1;
    stats.rays += u64::from(outcome.rays);
    stats.cut_paths += u64::from(outcome.cut);
}

impl Stats {
    /// Both together.
    pub fn plus(self, other: Stats) -> Stats {
        Stats {
            samples: self.samples + other.samples,
            rays: self.rays + other.rays,
            cut_paths: self.cut_paths + other.cut_paths,
        }
    }
}
