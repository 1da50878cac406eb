//! From paths to a film: progressive, parallel over chunks of pixels, cancelled at once.

use crate::bsdf::materials::Materials;
use crate::drive::lanes::{self, Chunk, Order, Tally};
use crate::integrator::path::{self, Plan};
use crate::integrator::settings::PathSettings;
use crate::integrator::whitted::{self, WhittedSettings};
use crate::intersect::Accel;
use crate::intersect::aggregate::Aggregate;
use crate::light::{Lights, SunDisc};
use crate::prepared::PreparedScene;
use film::Film;
use rayon::prelude::*;
use scene::{Camera, Scene, Vec3};
use simd::{Float, Kernel, Lanes};

/// A scene made ready for rays. Camera and settings come with each call, so that moving them costs no rebuild.
pub struct Tracer {
    scene: PreparedScene,
    ambient: f32,
    lanes: Lanes,
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

/// Pixels that one thread takes at a time: so many that its lanes are seldom idle at the end of them, but enough chunks
/// that small pictures keep all threads busy.
const CHUNK: std::ops::RangeInclusive<usize> = 64..=4096;

/// Chunks for each thread, where there are pixels enough.
const CHUNKS_PER_THREAD: usize = 8;

impl Tracer {
    /// Builds the acceleration structure and the list of lights.
    pub fn new(scene: &Scene) -> Self {
        let lights = Lights::new(scene);
        Tracer {
            scene: PreparedScene {
                aggregate: Aggregate::new(scene, lights.light_of_shape()),
                materials: Materials::new(&scene.materials),
                sky: if scene.environment.is_some() { Vec3::ZERO } else { scene.sky },
                sun_disc: scene.sun.as_ref().and_then(SunDisc::new),
                sun_pdf: lights.sun_pdf(),
                lights,
            },
            ambient: scene.fake.ambient,
            lanes: Lanes::best(),
        }
    }

    /// Traces in these lanes from now on. All give the same picture, bit for bit.
    pub fn with_lanes(self, lanes: Lanes) -> Self {
        Tracer { lanes, ..self }
    }

    /// Traces one ray at a time from now on, through the tree, also where the shapes are few: the same picture but for
    /// rounding, for measuring what meeting all shapes in all lanes saves.
    pub fn with_single_rays(mut self) -> Self {
        self.scene.aggregate.forget_shape_list();
        self
    }

    /// Forgets what the scene lacks, for measuring what knowing it saves: one ray at a time, and every kind of material
    /// is looked for. The same picture but for rounding.
    pub fn for_any_scene(mut self) -> Self {
        self.scene.materials.expect_everything();
        self.with_single_rays()
    }

    /// What it traces in.
    pub fn lanes(&self) -> Lanes {
        self.lanes
    }

    /// Triangles, spheres and disks in the scene.
    pub fn primitives(&self) -> usize {
        self.accel().len()
    }

    /// The shapes, ready for single rays.
    pub fn accel(&self) -> &Accel {
        self.scene.aggregate.accel()
    }

    /// The shapes, ready for rays in lanes.
    pub fn aggregate(&self) -> &Aggregate {
        &self.scene.aggregate
    }

    /// What is sampled as a light.
    pub fn lights(&self) -> &Lights {
        &self.scene.lights
    }

    /// Path traces `samples` more into every pixel of `film`, on the current rayon pool. Sample numbers go on from what
    /// each pixel has, so that many small calls give the same picture as a large one. `stop` is asked before every
    /// segment of a path; once it says so the call returns, and pixels hold whole samples, but not all equally many:
    /// the next call brings every pixel to `samples` more than the fewest.
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
        self.fill_with_paths(film, camera, settings, samples, stop)
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
        self.fill_with_trees(film, camera, settings, samples, stop)
    }

    /// Not generic: kernels are large, and compiled here once.
    fn fill_with_paths(
        &self,
        film: &mut Film,
        camera: &Camera,
        settings: &PathSettings,
        samples: u32,
        stop: &Stop,
    ) -> Stats {
        let (scene, plan) = (&self.scene, &Plan::new(settings));
        let order = Order::new(film, camera, samples, (settings.sampler, settings.seed));
        fill(film, |chunk| self.lanes.run(Paths { scene, plan, order, chunk, stop }))
    }

    /// As [`Tracer::fill_with_paths`].
    fn fill_with_trees(
        &self,
        film: &mut Film,
        camera: &Camera,
        settings: &WhittedSettings,
        samples: u32,
        stop: &Stop,
    ) -> Stats {
        let (scene, ambient) = (&self.scene, settings.ambient.unwrap_or(self.ambient));
        let order = Order::new(film, camera, samples, (settings.sampler, settings.seed));
        fill(film, |chunk| self.lanes.run(Trees { scene, settings, ambient, order, chunk, stop }))
    }
}

/// Says when to stop.
type Stop<'a> = dyn Fn() -> bool + Sync + 'a;

/// Fills a chunk with paths.
struct Paths<'a> {
    scene: &'a PreparedScene,
    plan: &'a Plan,
    order: Order,
    chunk: Chunk<'a>,
    stop: &'a Stop<'a>,
}

impl Kernel for Paths<'_> {
    type Output = Tally;

    #[inline(always)]
    fn run<F: Float>(self) -> Tally {
        lanes::fill::<F>(&self.order, self.chunk, path::PathLanes::new(self.scene, self.plan), self.stop)
    }
}

/// Fills a chunk with Whitted's trees.
struct Trees<'a> {
    scene: &'a PreparedScene,
    settings: &'a WhittedSettings,
    ambient: f32,
    order: Order,
    chunk: Chunk<'a>,
    stop: &'a Stop<'a>,
}

impl Kernel for Trees<'_> {
    type Output = Tally;

    #[inline(always)]
    fn run<F: Float>(self) -> Tally {
        let walk = whitted::WhittedLanes::new(self.scene, self.settings, self.ambient);
        lanes::fill::<F>(&self.order, self.chunk, walk, self.stop)
    }
}

/// Fills a film chunk by chunk.
fn fill(film: &mut Film, filler: impl Fn(Chunk) -> Tally + Sync) -> Stats {
    let chunks = rayon::current_num_threads() * CHUNKS_PER_THREAD;
    let length = film.pixels().len().div_ceil(chunks).clamp(*CHUNK.start(), *CHUNK.end());
    let (stats, nonfinite) = film
        .pixels_mut()
        .par_chunks_mut(length)
        .enumerate()
        .map(|(index, pixels)| filler(Chunk { first: (index * length) as u32, pixels }))
        .reduce(Tally::default, |a, b| (a.0.plus(b.0), a.1 + b.1));
    film.nonfinite += nonfinite;
    stats
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
