//! From paths to a film: progressive, parallel over chunks of pixels, cancelled at once.

use crate::geometry::{Accel, Ray};
use crate::light::{Lights, SunDisc};
use crate::path::{self, World};
use crate::rng::Sampler;
use crate::settings::PathSettings;
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
}

/// What a call of [`Tracer::render`] did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stats {
    /// Samples taken, one path each.
    pub samples: u64,
    /// Rays traced, shadow rays included.
    pub rays: u64,
    /// Paths cut at [`PathSettings::HARD_CAP`]; their remaining light is missing.
    pub cut_paths: u64,
}

/// Pixels that one thread takes at a time: few, so that small pictures keep all threads busy.
const CHUNK: usize = 64;

impl Tracer {
    /// Builds the acceleration structure and the list of lights.
    pub fn new(scene: &Scene) -> Self {
        Tracer {
            accel: Accel::new(scene),
            materials: scene.materials.clone(),
            lights: Lights::new(scene),
            sky: scene.sky,
            sun_disc: scene.sun.as_ref().and_then(SunDisc::new),
        }
    }

    /// Triangles and spheres in the scene.
    pub fn primitives(&self) -> usize {
        self.accel.len()
    }

    /// Adds `samples` to every pixel of `film`, on the current rayon pool. Sample numbers go on from what each pixel
    /// has, so that many small calls give the same picture as a large one. `stop` is asked before every sample; once it
    /// says so the call returns, and pixels hold whole samples, but not all equally many.
    pub fn render(
        &self,
        film: &mut Film,
        camera: &Camera,
        settings: &PathSettings,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Stats {
        let (width, height) = (film.width(), film.height());
        let frame = camera.frame(width as f32 / height as f32);
        let size = Vec2::new(width as f32, height as f32);
        let world = World {
            accel: &self.accel,
            materials: &self.materials,
            lights: &self.lights,
            sky: self.sky,
            sun_disc: self.sun_disc,
        };
        let chunks = film.pixels_mut().par_chunks_mut(CHUNK).enumerate();
        let (stats, nonfinite) = chunks
            .map(|(chunk, pixels)| {
                let mut tally = (Stats::default(), 0);
                for (offset, pixel) in pixels.iter_mut().enumerate() {
                    let index = (chunk * CHUNK + offset) as u32;
                    let corner = Vec2::new((index % width) as f32, (index / width) as f32);
                    for _ in 0..samples {
                        if stop() {
                            return tally;
                        }
                        let sampler = Sampler { pixel: index, sample: pixel.samples, seed: settings.seed };
                        let [jitter_x, jitter_y, _, _] = sampler.unit4(0);
                        let ray = Ray::new(frame.eye, frame.direction((corner + Vec2::new(jitter_x, jitter_y)) / size));
                        record(path::trace(&world, ray, settings, &sampler), pixel, &mut tally);
                    }
                }
                tally
            })
            .reduce(|| (Stats::default(), 0), |a, b| (a.0.plus(b.0), a.1 + b.1));
        film.nonfinite += nonfinite;
        stats
    }
}

fn record(outcome: path::Outcome, pixel: &mut Pixel, (stats, nonfinite): &mut (Stats, u64)) {
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
