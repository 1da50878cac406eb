//! The driver of lanes that fill a film: a lane owns a pixel, and starts its next sample, or its next pixel, in the
//! same turn in which the last one ended. There are no queues, and lanes stay busy up to the end of a chunk.
//!
//! Twins: `shaders/pathtrace/drive/pixels.wgsl`, where a thread has one pixel and its own loop, and, of the camera's rays,
//! `shaders/pathtrace/camera.wgsl`.

use crate::integrator::guide::guides::Guides;
use crate::intersect::Rays;
use crate::intersect::aggregate::lanes_of;
use crate::prepared::{Outcomes, PreparedScene};
use crate::sampling::sampler::Sampler;
use crate::sampling::sampler::SamplerKind;
use crate::stats::Stats;
use crate::vectors::{each_lane, in_all_lanes};
use film::Film;
use film::Pixel;
use rayon::prelude::*;
use scene::camera::PictureFrame;
use scene::stand_ins::FakeNumbers;
use scene::{Camera, Vec3};
use simd::{Float, Kernel, Lanes, MOST_LANES, Mask, Word};

/// Walks of rays, one in each lane, by random numbers from an `S`.
pub trait LaneIntegrator<F: Float, S = Sampler<<F as Float>::U>> {
    /// Starts along camera rays where `here` says so.
    fn begin(&mut self, here: F::M, rays: &Rays<F>);
    /// One segment in the lanes `taken`; where samples are complete.
    fn segment(&mut self, taken: F::M, sampler: &S) -> F::M;
    /// What the samples have brought home.
    fn outcomes(&self) -> &Outcomes<F>;
    /// Rays traced so far.
    fn rays(&self) -> u64;
}

/// An integrator's settings, read once, from which each chunk of a film takes its lanes.
pub trait LanePlan: Sync {
    /// The integrator's state in each lane.
    type LaneState<'a, F: Float>: LaneIntegrator<F>
    where
        Self: 'a;
    /// Lanes that follow nothing yet.
    fn lane_state<'a, F: Float>(&'a self, scene: &'a PreparedScene) -> Self::LaneState<'a, F>;
}

/// Says when to stop.
pub type Stop<'a> = dyn Fn() -> bool + Sync + 'a;

/// A film to be filled, and what with.
#[derive(Clone, Copy)]
pub struct FilmJob<'a> {
    /// Ready for rays.
    pub scene: &'a PreparedScene,
    /// What stands in for physics where an integrator leaves it out.
    pub stand_ins: &'a FakeNumbers,
    /// What earlier passes have learned of the scene.
    pub guides: &'a Guides,
    /// What the processor works in.
    pub lanes: Lanes,
    /// Which samples of what.
    pub pass: FilmPass,
    /// Asked before every segment.
    pub stop: &'a Stop<'a>,
}

/// Pixels that one thread takes at a time: so many that its lanes are seldom idle at the end of them, but enough chunks
/// that small pictures keep all threads busy.
const CHUNK: std::ops::RangeInclusive<usize> = 64..=4096;

/// Chunks for each thread, where there are pixels enough.
const CHUNKS_PER_THREAD: usize = 8;

impl FilmJob<'_> {
    /// Fills the film chunk by chunk, on the current rayon pool.
    pub fn fill(&self, film: &mut Film, plan: &impl LanePlan) -> Stats {
        self.fill_chunks(film, |chunk| self.lanes.run(ChunkKernel { job: self, plan, chunk }))
    }

    /// The same, one ray at a time whatever the processor has: compiled once, and not once for each kind of lanes.
    pub fn fill_one_by_one(&self, film: &mut Film, plan: &impl LanePlan) -> Stats {
        self.fill_chunks(film, |chunk| ChunkKernel { job: self, plan, chunk }.run::<f32>())
    }

    fn fill_chunks(&self, film: &mut Film, fill: impl Fn(Chunk) -> Tally + Sync) -> Stats {
        let chunks = rayon::current_num_threads() * CHUNKS_PER_THREAD;
        let length = film.pixels().len().div_ceil(chunks).clamp(*CHUNK.start(), *CHUNK.end());
        let (stats, nonfinite) = film
            .pixels_mut()
            .par_chunks_mut(length)
            .enumerate()
            .map(|(index, pixels)| fill(Chunk { first: (index * length) as u32, pixels }))
            .reduce(Tally::default, |a, b| (a.0.plus(b.0), a.1 + b.1));
        film.nonfinite += nonfinite;
        stats
    }
}

/// Fills a chunk in lanes of some kind.
struct ChunkKernel<'a, P> {
    job: &'a FilmJob<'a>,
    plan: &'a P,
    chunk: Chunk<'a>,
}

impl<P: LanePlan> Kernel for ChunkKernel<'_, P> {
    type Output = Tally;

    #[inline(always)]
    fn run<F: Float>(self) -> Tally {
        // a copy, which the compiler sees nobody else write to
        let pass = self.job.pass;
        fill::<F>(&pass, self.chunk, self.plan.lane_state(self.job.scene), self.job.stop)
    }
}

/// Which samples a film shall have, of what.
#[derive(Debug, Clone, Copy)]
pub struct FilmPass {
    /// What the camera sees.
    pub frame: PictureFrame,
    /// Width and height.
    pub size: [u32; 2],
    /// Samples that every pixel shall have.
    pub until: u32,
    /// Where random numbers come from.
    pub sampler: (SamplerKind, u32),
    /// Whose samples the film's places are, where they are not pixels of the picture: the pixel's column and row, and the
    /// number of the sample in the first place.
    pub probed: Option<([u32; 2], u32)>,
}

impl FilmPass {
    /// A pass of `samples` more than the film has anywhere.
    pub fn new(film: &Film, camera: &Camera, samples: u32, sampler: (SamplerKind, u32)) -> Self {
        let size = [film.width(), film.height()];
        let until = film.samples_per_pixel().saturating_add(samples);
        FilmPass { frame: camera.frame(size[0] as f32 / size[1] as f32), size, until, sampler, probed: None }
    }
}

/// Pixels in the order of the film.
pub struct Chunk<'a> {
    /// Index of the first.
    pub first: u32,
    /// The pixels.
    pub pixels: &'a mut [Pixel],
}

/// What a chunk took, and how many of its samples were not finite.
pub type Tally = (Stats, u64);

/// Fills a chunk of the film; `stop` leaves pixels with whole samples.
#[inline(always)]
fn fill<F: Float>(pass: &FilmPass, chunk: Chunk, mut integrator: impl LaneIntegrator<F>, stop: &Stop) -> Tally {
    let mut driver = LaneDriver::<F>::new(pass, chunk);
    while driver.taken.any() && !stop() {
        let sampler = driver.sampler(pass);
        integrator.begin(driver.fresh, &driver.camera_rays(pass, &sampler));
        let complete = integrator.segment(driver.taken, &sampler);
        driver.fresh = complete;
        if complete.any() {
            driver.record(pass, complete, integrator.outcomes());
        }
    }
    driver.tally.0.rays += integrator.rays();
    driver.tally
}

/// The rays through places of a picture, from -1 to 1 to the right and upwards.
#[inline(always)]
pub fn rays_through<F: Float>(frame: &PictureFrame, x: F, y: F) -> Rays<F> {
    let (right, up) = (in_all_lanes::<F>(frame.right), in_all_lanes::<F>(frame.up));
    let through = in_all_lanes::<F>(frame.forward) + right * x + up * y;
    Rays::new(in_all_lanes(frame.eye), through.normalize())
}

/// The rays through pixels of these columns and rows, each at its sample's place.
#[inline(always)]
pub fn camera_rays<F: Float>(
    frame: &PictureFrame,
    [width, height]: [u32; 2],
    [column, row]: [F; 2],
    sampler: &Sampler<F::U>,
) -> Rays<F> {
    let [jitter_x, jitter_y, _, _] = sampler.unit4(F::U::splat(0));
    let x = (column + jitter_x) / width as f32 * 2.0 - 1.0;
    let y = F::splat(1.0) - (row + jitter_y) / height as f32 * 2.0;
    rays_through(frame, x, y)
}

/// Which pixel and sample each lane has.
struct LaneDriver<'a, F: Float> {
    pixels: &'a mut [Pixel],
    first: u32,
    /// The next pixel that no lane has had, with its column and row.
    next: [u32; 3],
    /// Place of each lane's pixel in the chunk.
    place: [u32; MOST_LANES],
    /// Its index in the picture.
    pixel: [u32; MOST_LANES],
    sample: [u32; MOST_LANES],
    column: [f32; MOST_LANES],
    row: [f32; MOST_LANES],
    /// Lanes that have a pixel.
    taken: F::M,
    /// Lanes that begin a sample.
    fresh: F::M,
    tally: Tally,
}

impl<'a, F: Float> LaneDriver<'a, F> {
    #[inline(always)]
    fn new(pass: &FilmPass, chunk: Chunk<'a>) -> Self {
        let width = pass.size[0];
        let mut driver = LaneDriver {
            pixels: chunk.pixels,
            first: chunk.first,
            next: [0, chunk.first % width, chunk.first / width],
            place: [0; MOST_LANES],
            pixel: [0; MOST_LANES],
            sample: [0; MOST_LANES],
            column: [0.0; MOST_LANES],
            row: [0.0; MOST_LANES],
            taken: F::M::splat(false),
            fresh: F::M::splat(false),
            tally: Tally::default(),
        };
        let assigned = (0..F::LANES).filter(|&lane| driver.assign(pass, lane)).fold(0, |bits, lane| bits | 1 << lane);
        driver.taken = F::M::from_bits(assigned);
        driver.fresh = driver.taken;
        driver
    }

    /// Gives a lane the next pixel that wants samples; false if there is none.
    #[inline(always)]
    fn assign(&mut self, pass: &FilmPass, lane: usize) -> bool {
        loop {
            let [place, column, row] = self.next;
            let Some(pixel) = self.pixels.get(place as usize) else { return false };
            self.next = if column + 1 == pass.size[0] { [place + 1, 0, row + 1] } else { [place + 1, column + 1, row] };
            if pixel.samples < pass.until {
                let (sample, [column, row]) = match pass.probed {
                    Some((at, first)) => (first + self.first + place, at),
                    None => (pixel.samples, [column, row]),
                };
                (self.place[lane], self.sample[lane]) = (place, sample);
                self.pixel[lane] = row * pass.size[0] + column;
                (self.column[lane], self.row[lane]) = (column as f32, row as f32);
                return true;
            }
        }
    }

    #[inline(always)]
    fn sampler(&self, pass: &FilmPass) -> Sampler<F::U> {
        let (kind, seed) = pass.sampler;
        Sampler { kind, pixel: F::U::load(&self.pixel), sample: F::U::load(&self.sample), seed }
    }

    /// The rays through the lanes' pixels, each at its sample's place.
    #[inline(always)]
    fn camera_rays(&self, pass: &FilmPass, sampler: &Sampler<F::U>) -> Rays<F> {
        camera_rays(&pass.frame, pass.size, [F::load(&self.column), F::load(&self.row)], sampler)
    }

    /// Adds complete samples to their pixels, and moves lanes on.
    #[inline(always)]
    fn record(&mut self, pass: &FilmPass, complete: F::M, outcomes: &Outcomes<F>) {
        let radiance = each_lane(outcomes.radiance);
        let finite = outcomes.radiance.is_finite().bits();
        let (stats, nonfinite) = &mut self.tally;
        stats.samples += u64::from(complete.count());
        stats.cut_paths += u64::from((complete & outcomes.cut).count());
        *nonfinite += u64::from((complete.bits() & !finite).count_ones());
        let mut left = 0;
        for lane in lanes_of(complete) {
            let pixel = &mut self.pixels[self.place[lane] as usize];
            pixel.add(if finite >> lane & 1 != 0 { radiance[lane] } else { Vec3::ZERO });
            self.sample[lane] = pixel.samples;
            if pixel.samples >= pass.until && !self.assign(pass, lane) {
                left |= 1 << lane;
            }
        }
        if left != 0 {
            self.taken = self.taken & !F::M::from_bits(left);
        }
    }
}
