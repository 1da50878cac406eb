//! Chains on lanes: each lane has a chain, whose proposals are paths; where one is complete the chain takes it or stays,
//! and the next begins in the same turn.

use super::primary::PrimaryPoints;
use super::splats::Splats;
use crate::drive::lanes::{LaneIntegrator, Stop, rays_through};
use crate::integrator::path::PathLanes;
use crate::integrator::path_plan::Plan;
use crate::intersect::Rays;
use crate::intersect::aggregate::lanes_of;
use crate::prepared::{Outcomes, PreparedScene};
use crate::sampling::rng::unit_float;
use crate::sampling::sampler::Sampler;
use crate::stats::{ChainStats, Stats};
use crate::vectors::each_lane;
use film::colour::luminance;
use scene::Vec3;
use scene::camera::PictureFrame;
use simd::{Float, Kernel, MOST_LANES, Mask, Word};

/// What all chains of a picture share.
pub struct Walk<'a> {
    /// The scene, made ready for rays.
    pub scene: &'a PreparedScene,
    /// How the paths of chains walk.
    pub plan: &'a Plan<'a>,
    /// What the camera sees.
    pub frame: &'a PictureFrame,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Probability that a mutation draws everything anew.
    pub large_step: f32,
    /// Length of the longest small step.
    pub mutation: f32,
    /// Chooses among all pictures' steps.
    pub key: u32,
    /// Where chains leave their light.
    pub splats: &'a Splats,
    /// Asked before every segment.
    pub stop: &'a Stop<'a>,
}

/// Chains for one thread.
pub struct Chains<'a> {
    /// The number of the first among all of a picture.
    pub first: u32,
    /// The candidate that each begins with.
    pub starts: &'a [Sampler],
    /// Mutations of each; none where candidates are only looked at.
    pub mutations: u32,
    /// The luminance that each begins with.
    pub luminances: &'a mut [f32],
}

/// What chains took, and whether they came to their ends.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally {
    /// Mutations, samples and rays.
    pub stats: Stats,
    /// Samples that were not finite.
    pub nonfinite: u64,
    /// Whether they were stopped before their ends.
    pub stopped: bool,
}

impl Tally {
    /// The sum of what two groups of chains took.
    pub fn plus(self, other: Tally) -> Tally {
        Tally {
            stats: self.stats.plus(other.stats),
            nonfinite: self.nonfinite + other.nonfinite,
            stopped: self.stopped || other.stopped,
        }
    }
}

/// Chains to their ends, in lanes of some kind.
pub struct ChainKernel<'a> {
    /// What these chains share with all others.
    pub walk: &'a Walk<'a>,
    /// What these chains have of their own.
    pub chains: Chains<'a>,
}

impl Kernel for ChainKernel<'_> {
    type Output = Tally;

    #[inline(always)]
    fn run<F: Float>(self) -> Tally {
        let mut paths = PathLanes::<F>::new(self.walk.scene, self.walk.plan);
        let mut driver = ChainDriver::<F>::new(self.walk, self.chains);
        while driver.points.active.any() && !(self.walk.stop)() {
            if driver.fresh.any() {
                let rays = driver.camera_rays();
                begin(&mut paths, driver.fresh, &rays, &driver.points);
            }
            let complete = paths.segment(driver.points.active, &driver.points);
            driver.fresh = complete;
            if complete.any() {
                driver.record(complete, outcomes(&paths, &driver.points));
            }
        }
        driver.tally.stats.rays += rays(&paths, &driver.points);
        driver.tally.stopped = driver.points.active.any();
        driver.tally
    }
}

/// Paths walk by any random numbers: these say that it is the points'.
#[inline(always)]
fn begin<F: Float, S>(paths: &mut impl LaneIntegrator<F, S>, here: F::M, rays: &Rays<F>, _: &S) {
    paths.begin(here, rays);
}

#[inline(always)]
fn outcomes<'a, F: Float, S>(paths: &'a impl LaneIntegrator<F, S>, _: &S) -> &'a Outcomes<F> {
    paths.outcomes()
}

#[inline(always)]
fn rays<F: Float, S>(paths: &impl LaneIntegrator<F, S>, _: &S) -> u64 {
    paths.rays()
}

/// What a path has brought to a pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Splat {
    pixel: u32,
    /// Of luminance 1, or black.
    colour: Vec3,
    luminance: f32,
}

impl Splat {
    fn new(pixel: u32, radiance: Vec3) -> Self {
        let luminance = luminance(radiance);
        let shines = radiance.is_finite() && luminance > 0.0 && luminance.is_finite();
        let black = Splat { pixel, ..Splat::default() };
        if shines { Splat { colour: radiance / luminance, luminance, ..black } } else { black }
    }
}

/// A chain on its way.
#[derive(Debug, Clone, Copy, Default)]
struct ChainState {
    /// Its place among those of the thread.
    place: usize,
    at: Splat,
    /// How often it has been there, expected values counted.
    weight: f64,
    /// Decides whether it takes the mutation that it has proposed.
    decision: f32,
}

struct ChainDriver<'a, F: Float> {
    walk: &'a Walk<'a>,
    own: Chains<'a>,
    /// The next chain that no lane has had.
    next: usize,
    points: PrimaryPoints<F>,
    chains: [ChainState; MOST_LANES],
    /// The pixel of each lane's path.
    pixel: [u32; MOST_LANES],
    /// Lanes that begin a path.
    fresh: F::M,
    tally: Tally,
}

impl<'a, F: Float> ChainDriver<'a, F> {
    #[inline(always)]
    fn new(walk: &'a Walk<'a>, own: Chains<'a>) -> Self {
        let mut driver = ChainDriver {
            walk,
            own,
            next: 0,
            points: PrimaryPoints::new(walk.key, walk.mutation),
            chains: [ChainState::default(); MOST_LANES],
            pixel: [0; MOST_LANES],
            fresh: F::M::splat(false),
            tally: Tally::default(),
        };
        let assigned = (0..F::LANES).filter(|&lane| driver.assign(lane)).fold(0, |bits, lane| bits | 1 << lane);
        driver.fresh = F::M::from_bits(assigned);
        driver.points.active = driver.fresh;
        driver
    }

    /// Gives a lane the next chain; false if there is none.
    fn assign(&mut self, lane: usize) -> bool {
        let Some(start) = self.own.starts.get(self.next) else { return false };
        self.chains[lane] = ChainState { place: self.next, ..ChainState::default() };
        self.points.start(lane, self.own.first.wrapping_add(self.next as u32), *start);
        self.next += 1;
        true
    }

    /// The rays through the places of the picture that the first two coordinates of fresh proposals choose.
    #[inline(always)]
    fn camera_rays(&mut self) -> Rays<F> {
        let [x, y, _, _] = self.points.words4(self.fresh, F::U::splat(0));
        let (x, y): (F, F) = (unit_float(x), unit_float(y));
        let [width, height] = self.walk.size;
        let (mut columns, mut rows) = ([0; MOST_LANES], [0; MOST_LANES]);
        (x * width as f32).to_word().store(&mut columns);
        (y * height as f32).to_word().store(&mut rows);
        for lane in lanes_of(self.fresh) {
            // a product may be rounded up
            self.pixel[lane] = rows[lane].min(height - 1) * width + columns[lane].min(width - 1);
        }
        rays_through(self.walk.frame, x * 2.0 - 1.0, F::splat(1.0) - y * 2.0)
    }

    /// Lets chains with complete paths take them or stay, and moves them on.
    #[inline(always)]
    fn record(&mut self, complete: F::M, outcomes: &Outcomes<F>) {
        let radiance = each_lane(outcomes.radiance);
        let finite = outcomes.radiance.is_finite().bits();
        self.tally.stats.samples += u64::from(complete.count());
        self.tally.stats.cut_paths += u64::from((complete & outcomes.cut).count());
        self.tally.nonfinite += u64::from((complete.bits() & !finite).count_ones());
        let mut left = 0;
        for lane in lanes_of(complete) {
            self.arrive(lane, Splat::new(self.pixel[lane], radiance[lane]));
            left |= u32::from(!self.go_on(lane)) << lane;
        }
        self.points.active = self.points.active & !F::M::from_bits(left);
        self.fresh = self.fresh & self.points.active;
    }

    /// A chain takes a proposal or stays; both leave their light by the probabilities of that.
    fn arrive(&mut self, lane: usize, proposed: Splat) {
        let chain = &mut self.chains[lane];
        if self.points.mutation(lane) == 0 {
            self.own.luminances[chain.place] = proposed.luminance;
            chain.at = proposed;
            return;
        }
        let acceptance = acceptance(chain.at.luminance, proposed.luminance);
        chain.weight += 1.0 - f64::from(acceptance);
        if chain.decision < acceptance {
            self.walk.splats.add(chain.at.pixel, chain.at.colour, chain.weight);
            (chain.at, chain.weight) = (proposed, f64::from(acceptance));
            self.points.accept(lane);
            self.tally.stats.chains.accepted += 1;
        } else {
            self.walk.splats.add(proposed.pixel, proposed.colour, f64::from(acceptance));
        }
    }

    /// The next mutation of a chain, or the next chain; false if there is none.
    fn go_on(&mut self, lane: usize) -> bool {
        if self.points.mutation(lane) < self.own.mutations {
            self.chains[lane].decision = self.points.mutate(lane, self.walk.large_step);
            return true;
        }
        let ChainState { at, weight, .. } = self.chains[lane];
        if self.own.mutations > 0 {
            self.walk.splats.add(at.pixel, at.colour, weight);
        }
        let mutations = u64::from(self.own.mutations);
        let chains = &mut self.tally.stats.chains;
        *chains = ChainStats { mutations: chains.mutations + mutations, ..*chains };
        self.assign(lane)
    }
}

/// The probability that a chain takes a proposal.
fn acceptance(from: f32, to: f32) -> f32 {
    if from > to { to / from } else { 1.0 }
}
