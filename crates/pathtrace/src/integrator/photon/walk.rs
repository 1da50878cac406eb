//! Photons on their way from the lights, one in each lane: as paths from the camera, but backwards, and what they leave
//! behind at each surface. A lane whose photon ended starts the next one in the same turn.
//!
//! Chunks of photons have one length, and what they leave is put into the order of photons: pictures depend on neither
//! threads nor lanes.
//!
//! Twin: `shaders/pathtrace/integrator/photon/walk.wgsl`.

use super::map::Photon;
use super::pinhole::Pinhole;
use crate::bsdf::{Interactions, shading};
use crate::drive::lanes::{FilmJob, Stop};
use crate::integrator::PathSettings;
use crate::integrator::path_state::PathStates;
use crate::integrator::roulette::{SPARED_VERTICES, survivors};
use crate::integrator::settings::Roulette;
use crate::intersect::Rays;
use crate::intersect::aggregate::lanes_of;
use crate::intersect::coincident::NO_GROUP;
use crate::intersect::shape_list::Scratch;
use crate::light::{Aim, EmissionChoice};
use crate::prepared::PreparedScene;
use crate::sampling::rng::{pcg4d, unit_float};
use crate::sampling::sampler::{Sampler, SamplerKind};
use crate::stats::Stats;
use crate::vectors::{each_lane, of_lanes};
use rayon::prelude::*;
use scene::Vec3;
use simd::{Float, Kernel, MOST_LANES, Mask, Vector, Word};

/// Photons that one thread takes at a time.
const CHUNK: u32 = 4096;

/// Photons that tell how much a pass will leave.
const FEW: u32 = 256;

/// Photons that a map holds, as far as the first few photons are like the others: 36 bytes each, and as much again and the number of a bucket while it is
/// sorted, which is 1.4 GB with the buckets. In a bright closed room each photon comes to many surfaces. Of a pass that would
/// leave more, each is kept with a probability, and its power is over it: that is unbiased, with more noise.
const MOST_LEFT: f64 = (1 << 24) as f64;

/// Traces of several chunks that wait for each other.
const MOST_AT_ONCE: f64 = (1 << 22) as f64;

/// Tells the numbers that choose which photons are kept from those of their walks.
const KEPT_KEY: u32 = 0x9407_0b17;

/// Blocks of random numbers of photons begin here, behind all of a camera path's: two for the light, and one at each surface.
pub(crate) const FIRST_DIMENSION: u32 = 1 << 16;

/// Light at a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Splat {
    /// Index of the pixel, row by row from the top.
    pub pixel: u32,
    /// Radiance, or the colour of a mark.
    pub radiance: Vec3,
}

/// What becomes of photons at surfaces.
#[derive(Debug, Clone, Copy)]
pub enum Purpose {
    /// Those at diffuse surfaces are kept.
    Map,
    /// What surfaces send on to a camera is kept, rough metal's too.
    Splats(Pinhole),
    /// Diffuse surfaces' photons are marks in a camera's picture.
    Marks(Pinhole),
}

/// What a pass of photons does.
#[derive(Debug, Clone, Copy)]
pub struct PhotonPass<'a> {
    /// Which of the passes.
    pub number: u32,
    /// Photons that leave the lights.
    pub photons: u32,
    /// What they are for.
    pub purpose: Purpose,
    /// Whether light counts that comes from a light directly.
    pub direct: bool,
    /// What they are aimed at.
    pub aim: &'a Aim,
}

/// What a chunk of photons has left behind, in their order.
#[derive(Debug, Default)]
pub struct Traces {
    /// Those that came to diffuse surfaces.
    pub photons: Vec<Photon>,
    /// What the picture's pixels receive through the pinhole.
    pub splats: Vec<Splat>,
    /// Rays, and photons that were cut short.
    pub stats: Stats,
}

impl PhotonPass<'_> {
    /// Traces the photons on the current pool, and gives what chunks of them have left, in their order; `None` where it
    /// was stopped.
    pub fn trace(&self, job: &FilmJob, mut take: impl FnMut(Traces)) -> Option<Stats> {
        let of_each = self.left_by_each(job);
        let kept = share_kept(of_each * f64::from(self.photons));
        let chunks_at_once = (MOST_AT_ONCE / (of_each * f64::from(CHUNK))).clamp(1.0, 1024.0) as u32;
        let mut stats = Stats { photons: u64::from(self.photons), ..Stats::default() };
        for first in (0..self.photons).step_by((CHUNK * chunks_at_once) as usize) {
            let end = first.saturating_add(CHUNK * chunks_at_once).min(self.photons);
            for traces in self.chunks(job, (first, end), kept)? {
                stats = stats.plus(traces.stats);
                take(traces);
            }
        }
        Some(stats)
    }

    /// How many traces each photon leaves, as the first few of them tell; their own are left once more by the pass.
    pub(super) fn left_by_each(&self, job: &FilmJob) -> f64 {
        let first = self.photons.min(FEW);
        let traces = job.lanes.run(ChunkKernel { job, pass: self, first: 0, end: first, kept: 1.0 });
        let left = traces.photons.len() + traces.splats.len();
        left.max(1) as f64 / f64::from(first)
    }

    /// What chunks of the photons from the first to before the end have left; of a map's photons the share that is kept.
    pub(super) fn chunks(&self, job: &FilmJob, (first, end): (u32, u32), kept: f32) -> Option<Vec<Traces>> {
        let chunk = |first: u32| {
            let end = first.saturating_add(CHUNK).min(end);
            (!(job.stop)()).then(|| job.lanes.run(ChunkKernel { job, pass: self, first, end, kept }))
        };
        let traced: Option<Vec<Traces>> = (first..end).into_par_iter().step_by(CHUNK as usize).map(chunk).collect();
        traced.filter(|_| !(job.stop)())
    }
}

/// The share of so many photons that a map keeps.
pub(super) fn share_kept(photons: f64) -> f32 {
    (MOST_LEFT / photons).min(1.0) as f32
}

/// Follows photons from the first to before the end in lanes of some kind.
struct ChunkKernel<'a> {
    job: &'a FilmJob<'a>,
    pass: &'a PhotonPass<'a>,
    first: u32,
    end: u32,
    /// The share of photons that a map keeps.
    kept: f32,
}

impl Kernel for ChunkKernel<'_> {
    type Output = Traces;

    #[inline(always)]
    fn run<F: Float>(self) -> Traces {
        let ChunkKernel { job, pass, first, end, kept } = self;
        // a copy, which the compiler sees nobody else write to
        let pass = *pass;
        let mut walk = PhotonLanes::<F>::new(job.scene, &pass, job.pass.sampler);
        walk.follow(first, end, job.stop);
        walk.in_order(kept)
    }
}

/// What was left behind, by whom and where on its way.
struct Left<T>(u32, u32, T);

/// Photons on their way.
struct PhotonLanes<'a, F: Float> {
    scene: &'a PreparedScene,
    pass: &'a PhotonPass<'a>,
    /// Where random numbers come from.
    sampler: (SamplerKind, u32),
    /// Which photon each lane follows.
    photon: [u32; MOST_LANES],
    path: PathStates<F>,
    /// Power at the light.
    power: Vector<F>,
    /// Index into the list of lights of the one that each has left.
    light: F::U,
    scratch: Scratch<F>,
    photons: Vec<Left<Photon>>,
    splats: Vec<Left<Splat>>,
    stats: Stats,
}

impl<'a, F: Float> PhotonLanes<'a, F> {
    #[inline(always)]
    fn new(scene: &'a PreparedScene, pass: &'a PhotonPass<'a>, sampler: (SamplerKind, u32)) -> Self {
        let zero = Vector::zero();
        PhotonLanes {
            scene,
            pass,
            sampler,
            photon: [0; MOST_LANES],
            path: PathStates::leaving_camera(&Rays::new(zero, Vector::splat([0.0, 0.0, 1.0]))),
            power: zero,
            light: F::U::splat(0),
            scratch: Scratch::new(scene.aggregate.shape_list()),
            photons: Vec::new(),
            splats: Vec::new(),
            stats: Stats::default(),
        }
    }

    /// Follows the photons from `first` to before `end`, unless `stop` says so.
    #[inline(always)]
    fn follow(&mut self, first: u32, end: u32, stop: &Stop) {
        let mut next = first;
        let (mut taken, mut fresh) = (F::M::splat(false), F::M::from_bits(u32::MAX));
        loop {
            let begun = self.begin(fresh, &mut next, end);
            taken = (taken & !fresh) | begun;
            if !taken.any() || stop() {
                break;
            }
            fresh = !taken | self.segment(taken);
        }
    }

    /// Starts the next photons in the lanes `fresh`; where there were any left.
    #[inline(always)]
    fn begin(&mut self, fresh: F::M, next: &mut u32, end: u32) -> F::M {
        if *next >= end || !fresh.any() {
            return F::M::splat(false);
        }
        let (kind, seed) = self.sampler;
        let [mut origins, mut directions, mut powers] = [[Vec3::ZERO; MOST_LANES]; 3];
        let (mut begun, mut lights) = (0, [0; MOST_LANES]);
        for lane in lanes_of(fresh) {
            while *next < end {
                let of_photon = Sampler { kind, pixel: self.pass.number, sample: *next, seed };
                self.photon[lane] = *next;
                *next += 1;
                if let Some(emitted) = self.scene.emitters.emit(self.pass.aim, &choice(&of_photon)) {
                    (origins[lane], directions[lane]) = (emitted.ray.origin, emitted.ray.direction);
                    powers[lane] = emitted.power / self.pass.photons as f32;
                    lights[lane] = emitted.light;
                    begun |= 1 << lane;
                    break;
                }
            }
        }
        let begun = F::M::from_bits(begun);
        let rays = Rays::new(of_lanes(&origins), of_lanes(&directions));
        self.path = PathStates::select(begun, PathStates::leaving_camera(&rays), self.path);
        self.power = Vector::select(begun, of_lanes(&powers), self.power);
        self.light = F::U::select(begun, F::U::load(&lights), self.light);
        begun
    }

    /// One segment of the photons in the lanes `taken`; where they have come to their end.
    #[inline(always)]
    fn segment(&mut self, taken: F::M) -> F::M {
        self.stats.rays += u64::from(taken.count());
        let hit = self.scene.closest(&self.path.rays, taken, &mut self.scratch);
        let vertex = self.scene.interaction(&hit, -self.path.rays.direction);
        let first = self.path.vertices.eq(F::U::splat(0));
        let scattering = taken & hit.met & vertex.scatters();
        let scattering = scattering & !self.have_left_another_light(scattering & first, &vertex);
        if !scattering.any() {
            return taken;
        }
        let counts = scattering & !vertex.is_delta();
        self.leave(if self.pass.direct { counts } else { counts & !first }, &vertex);
        let (kind, seed) = self.sampler;
        let (pixel, sample) = (F::U::splat(self.pass.number), F::U::load(&self.photon));
        let dimension = self.path.vertices.wrapping_add(F::U::splat(FIRST_DIMENSION + 2));
        let u = Sampler { kind, pixel, sample, seed }.unit4(dimension);
        let sample = self.scene.materials.sample_adjoint(scattering, &vertex, [u[0], u[1], u[3]]);
        let refracted = vertex.kinds.glass() & vertex.normal.dot(sample.wi).lt(F::splat(0.0));
        let spared = vertex.is_delta() & self.path.vertices.lt(F::U::splat(SPARED_VERTICES));
        let throughput = self.path.throughput * sample.weight;
        let (survives, throughput) =
            survivors(throughput, throughput, F::splat(1.0), spared, Roulette::THROUGHPUT, u[2]);
        if self.scene.materials.has().glass {
            self.power = self.power * F::select(scattering & refracted, self.basic(&vertex), F::splat(1.0));
        }
        let vertices = self.path.vertices.wrapping_add(F::U::splat(1));
        let rays = Rays::new(vertex.point.leaving_towards(sample.wi), sample.wi);
        self.path = PathStates { rays, throughput, vertices, from: vertex.point.position, ..self.path };
        let at_limit = vertices.eq(F::U::splat(PathSettings::HARD_CAP));
        self.stats.cut_photons += u64::from((scattering & survives & at_limit).count());
        taken & !(scattering & survives & !at_limit)
    }

    /// Where photons that have met their first surface come from where another light is, which coincides with theirs.
    #[inline(always)]
    fn have_left_another_light(&mut self, met: F::M, vertex: &Interactions<F>) -> F::M {
        let groups = self.scene.aggregate.accel().groups();
        if !groups.any() {
            return F::M::splat(false);
        }
        let shared = met & !groups.of_light(self.light).eq(F::U::splat(NO_GROUP));
        if !shared.any() {
            return shared;
        }
        self.stats.rays += u64::from(shared.count());
        let left = (self.path.rays.origin, self.path.rays.direction, self.light);
        self.scene.is_another_light_there(left, &vertex.point, shared, &mut self.scratch)
    }

    /// What refraction does to power over the square of the index. Camera paths do not scale radiance by it, and what
    /// they meet within glass is to be the same.
    #[inline(always)]
    fn basic(&self, vertex: &Interactions<F>) -> F {
        let ior = self.scene.materials.ior::<F>(vertex.material);
        let entering = vertex.point.normal.dot(vertex.wo).ge(F::splat(0.0));
        let squared = ior * ior;
        F::select(entering, F::splat(1.0) / squared, squared)
    }

    /// Keeps photons that have arrived `here`, for whatever they are.
    #[inline(always)]
    fn leave(&mut self, here: F::M, vertex: &Interactions<F>) {
        let diffuse = here & vertex.is_diffuse();
        match &self.pass.purpose {
            Purpose::Map if diffuse.any() => self.keep(diffuse, vertex),
            Purpose::Splats(pinhole) if here.any() => {
                let (power, scene) = (self.power * self.path.throughput, self.scene);
                let seen = pinhole.connect(here, &scene.materials.as_left(vertex), scene, &mut self.scratch);
                self.stats.rays += u64::from(here.count());
                let radiance = scene.materials.eval_adjoint(vertex, seen.wi).times(power * seen.weight);
                self.splat(seen.seen, seen.pixel, radiance);
            }
            Purpose::Marks(pinhole) if diffuse.any() => {
                let left = self.scene.materials.as_left(vertex);
                let seen = pinhole.connect(diffuse, &left, self.scene, &mut self.scratch);
                self.stats.rays += u64::from(diffuse.count());
                let power = self.power * self.path.throughput;
                self.splat(seen.seen, seen.pixel, power * (F::splat(1.0) / power.max_element()));
            }
            _ => {}
        }
    }

    #[inline(always)]
    fn keep(&mut self, here: F::M, vertex: &Interactions<F>) {
        let (positions, normals) = (each_lane(vertex.point.position), each_lane(vertex.normal));
        let mut power = self.power * self.path.throughput;
        if self.scene.materials.has().shading_normals {
            power = power * shading::of_arriving(vertex);
        }
        let powers = each_lane(power);
        let mut vertices = [0; MOST_LANES];
        self.path.vertices.store(&mut vertices);
        for lane in lanes_of(here) {
            let photon = Photon { position: positions[lane], normal: normals[lane], power: powers[lane] };
            self.photons.push(Left(self.photon[lane], vertices[lane], photon));
        }
    }

    #[inline(always)]
    fn splat(&mut self, here: F::M, pixel: F::U, radiance: Vector<F>) {
        let radiances = each_lane(radiance);
        let [mut pixels, mut vertices] = [[0; MOST_LANES]; 2];
        pixel.store(&mut pixels);
        self.path.vertices.store(&mut vertices);
        for lane in lanes_of(here) {
            let splat = Splat { pixel: pixels[lane], radiance: radiances[lane] };
            self.splats.push(Left(self.photon[lane], vertices[lane], splat));
        }
    }

    /// What was left, and of photons the share that is kept.
    fn in_order(mut self, kept: f32) -> Traces {
        if kept < 1.0 {
            let (number, key) = (self.pass.number, self.sampler.1 ^ KEPT_KEY);
            self.photons.retain_mut(|Left(photon, vertex, left)| {
                left.power /= kept;
                let [u, ..] = pcg4d([*photon, *vertex, number, key]);
                unit_float(u) < kept
            });
        }
        Traces { photons: in_order(self.photons), splats: in_order(self.splats), stats: self.stats }
    }
}

/// By photons, and along their ways.
fn in_order<T>(mut left: Vec<Left<T>>) -> Vec<T> {
    left.sort_unstable_by_key(|Left(photon, vertex, _)| (*photon, *vertex));
    // not in place: what waits shall take no more than it needs
    let mut ordered = Vec::with_capacity(left.len());
    ordered.extend(left.into_iter().map(|Left(.., what)| what));
    ordered
}

/// The numbers that choose a photon at its light. Place and direction are one point of four dimensions.
fn choice(sampler: &Sampler) -> EmissionChoice {
    let [s, t, u, v] = sampler.unit4(FIRST_DIMENSION);
    let [light, aim, side, _] = sampler.unit4(FIRST_DIMENSION + 1);
    EmissionChoice { light, aim, side, place: [s, t], way: [u, v] }
}
