//! Photons on their way from the lights, one in each lane: as paths from the camera, but backwards, and what they leave
//! behind at each surface. A lane whose photon ended starts the next one in the same turn.
//!
//! Chunks of photons have one length, and what they leave is put into the order of photons: pictures depend on neither
//! threads nor lanes.

use super::map::Photon;
use super::pinhole::Pinhole;
use crate::bsdf::Interactions;
use crate::drive::lanes::{FilmJob, Stop};
use crate::integrator::PathSettings;
use crate::integrator::path_state::PathStates;
use crate::integrator::roulette::{SPARED_VERTICES, survivors};
use crate::integrator::settings::Roulette;
use crate::intersect::Rays;
use crate::intersect::aggregate::lanes_of;
use crate::intersect::shape_list::Scratch;
use crate::light::EmissionChoice;
use crate::prepared::PreparedScene;
use crate::sampling::sampler::{Sampler, SamplerKind};
use crate::stats::Stats;
use crate::vectors::{each_lane, of_lanes};
use rayon::prelude::*;
use scene::Vec3;
use simd::{Float, Kernel, MOST_LANES, Mask, Vector, Word};

/// Photons that one thread takes at a time.
const CHUNK: u32 = 4096;

/// Blocks of random numbers of photons begin here, behind all of a camera path's: two for the light, and one at each surface.
const FIRST_DIMENSION: u32 = 1 << 16;

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
pub struct PhotonPass {
    /// Which of the passes.
    pub number: u32,
    /// Photons that leave the lights.
    pub photons: u32,
    /// What they are for.
    pub purpose: Purpose,
    /// Whether light counts that comes from a light directly.
    pub direct: bool,
}

/// What photons have left behind, in their order.
#[derive(Debug, Default)]
pub struct Traces {
    /// Those that came to diffuse surfaces.
    pub photons: Vec<Photon>,
    /// What the picture's pixels receive through the pinhole.
    pub splats: Vec<Splat>,
    /// Rays and cut paths.
    pub stats: Stats,
}

impl PhotonPass {
    /// Traces the photons on the current pool; `None` where it was stopped.
    pub fn trace(&self, job: &FilmJob) -> Option<Traces> {
        let chunks = (0..self.photons).into_par_iter().step_by(CHUNK as usize);
        let chunk = |first: u32| {
            let end = first.saturating_add(CHUNK).min(self.photons);
            (!(job.stop)()).then(|| job.lanes.run(ChunkKernel { job, pass: self, first, end }))
        };
        let traced: Vec<Option<Traces>> = chunks.map(chunk).collect();
        if (job.stop)() {
            return None;
        }
        let mut all = Traces::default();
        for traces in traced {
            let traces = traces?;
            all.photons.extend(traces.photons);
            all.splats.extend(traces.splats);
            all.stats = all.stats.plus(traces.stats);
        }
        Some(all)
    }
}

/// Follows photons from the first to before the end in lanes of some kind.
struct ChunkKernel<'a> {
    job: &'a FilmJob<'a>,
    pass: &'a PhotonPass,
    first: u32,
    end: u32,
}

impl Kernel for ChunkKernel<'_> {
    type Output = Traces;

    #[inline(always)]
    fn run<F: Float>(self) -> Traces {
        let ChunkKernel { job, pass, first, end } = self;
        // a copy, which the compiler sees nobody else write to
        let pass = *pass;
        let mut walk = PhotonLanes::<F>::new(job.scene, &pass, job.pass.sampler);
        walk.follow(first, end, job.stop);
        walk.in_order()
    }
}

/// What was left behind, by whom and where on its way.
struct Left<T>(u32, u32, T);

/// Photons on their way.
struct PhotonLanes<'a, F: Float> {
    scene: &'a PreparedScene,
    pass: &'a PhotonPass,
    /// Where random numbers come from.
    sampler: (SamplerKind, u32),
    /// Which photon each lane follows.
    photon: [u32; MOST_LANES],
    path: PathStates<F>,
    /// Power at the light.
    power: Vector<F>,
    scratch: Scratch<F>,
    photons: Vec<Left<Photon>>,
    splats: Vec<Left<Splat>>,
    stats: Stats,
}

impl<'a, F: Float> PhotonLanes<'a, F> {
    #[inline(always)]
    fn new(scene: &'a PreparedScene, pass: &'a PhotonPass, sampler: (SamplerKind, u32)) -> Self {
        let zero = Vector::zero();
        PhotonLanes {
            scene,
            pass,
            sampler,
            photon: [0; MOST_LANES],
            path: PathStates::leaving_camera(&Rays::new(zero, Vector::splat([0.0, 0.0, 1.0]))),
            power: zero,
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
        let mut begun = 0;
        for lane in lanes_of(fresh) {
            while *next < end {
                let of_photon = Sampler { kind, pixel: self.pass.number, sample: *next, seed };
                self.photon[lane] = *next;
                *next += 1;
                if let Some(emitted) = self.scene.emitters.emit(&choice(&of_photon)) {
                    (origins[lane], directions[lane]) = (emitted.ray.origin, emitted.ray.direction);
                    powers[lane] = emitted.power / self.pass.photons as f32;
                    begun |= 1 << lane;
                    break;
                }
            }
        }
        let begun = F::M::from_bits(begun);
        let rays = Rays::new(of_lanes(&origins), of_lanes(&directions));
        self.path = PathStates::select(begun, PathStates::leaving_camera(&rays), self.path);
        self.power = Vector::select(begun, of_lanes(&powers), self.power);
        begun
    }

    /// One segment of the photons in the lanes `taken`; where they have come to their end.
    #[inline(always)]
    fn segment(&mut self, taken: F::M) -> F::M {
        self.stats.rays += u64::from(taken.count());
        let hit = self.scene.closest(&self.path.rays, taken, &mut self.scratch);
        let vertex = self.scene.interaction(&hit, -self.path.rays.direction);
        let scattering = taken & hit.met & !vertex.colour.is_zero();
        if !scattering.any() {
            return taken;
        }
        let first = self.path.vertices.eq(F::U::splat(0));
        let counts = scattering & !vertex.is_delta();
        self.leave(if self.pass.direct { counts } else { counts & !first }, &vertex);
        let (kind, seed) = self.sampler;
        let (pixel, sample) = (F::U::splat(self.pass.number), F::U::load(&self.photon));
        let dimension = self.path.vertices.wrapping_add(F::U::splat(FIRST_DIMENSION + 2));
        let u = Sampler { kind, pixel, sample, seed }.unit4(dimension);
        let sample = self.scene.materials.sample(scattering, &vertex, [u[0], u[1], u[3]]);
        let refracted = vertex.normal.dot(sample.wi).lt(F::splat(0.0));
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
        self.stats.cut_paths += u64::from((scattering & survives & at_limit).count());
        taken & !(scattering & survives & !at_limit)
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
                let seen = pinhole.connect(here, vertex, scene, &mut self.scratch);
                self.stats.rays += u64::from(here.count());
                let radiance = scene.materials.eval(vertex, seen.wi).times(power * seen.weight);
                self.splat(seen.seen, seen.pixel, radiance);
            }
            Purpose::Marks(pinhole) if diffuse.any() => {
                let seen = pinhole.connect(diffuse, vertex, self.scene, &mut self.scratch);
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
        let powers = each_lane(self.power * self.path.throughput);
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

    fn in_order(self) -> Traces {
        Traces { photons: in_order(self.photons), splats: in_order(self.splats), stats: self.stats }
    }
}

/// By photons, and along their ways.
fn in_order<T>(mut left: Vec<Left<T>>) -> Vec<T> {
    left.sort_unstable_by_key(|Left(photon, vertex, _)| (*photon, *vertex));
    left.into_iter().map(|Left(.., what)| what).collect()
}

/// The numbers that choose a photon at its light. Place and direction are one point of four dimensions.
fn choice(sampler: &Sampler) -> EmissionChoice {
    let [s, t, u, v] = sampler.unit4(FIRST_DIMENSION);
    let [light, aim, side, _] = sampler.unit4(FIRST_DIMENSION + 1);
    EmissionChoice { light, aim, side, place: [s, t], way: [u, v] }
}
