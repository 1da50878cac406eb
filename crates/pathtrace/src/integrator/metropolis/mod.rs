//! Metropolis light transport in primary sample space: Kelemen, Szirmay-Kalos, Antal and Csonka, "A Simple and Robust
//! Mutation Strategy for the Metropolis Light Transport Algorithm" (Eurographics 2002), after Veach and Guibas 1997.
//!
//! A path is a function of the random numbers that it asks for. Chains walk through the space of these numbers and stay
//! where paths bring light, in proportion to its luminance: a small step from a path that found a caustic finds it again.
//! The path that a chain is at, and the one that it proposes, each add a colour of luminance 1 to their pixels, weighted
//! by the probability that the chain goes on from there (expected values).
//!
//! One sample of every pixel is one *run*: as many mutations as there are pixels, by chains that begin anew. Each run
//! draws candidates, and its chains start with some of them, chosen in proportion to their luminance; the light they
//! leave counts the candidates' mean luminance, the start-up scale. That is Veach's way to lose the start-up bias (thesis
//! of 1997, section 11.3.1): a run has the right mean however short its chains are. Runs are independent of each other,
//! so that a film goes on wherever it stopped. Within one, neighbouring pixels are not: chains are few and long.
//!
//! On the processor alone.

mod primary;
mod splats;
mod walk;

use crate::drive::lanes::FilmJob;
use crate::integrator::path_plan::Plan;
use crate::integrator::settings::{ConesAt, Directions, PathSettings, SettingsError};
use crate::sampling::rng::{pcg4d, unit_float};
use crate::sampling::sampler::Sampler;
use crate::stats::{ChainStats, Stats};
use film::Film;
use rayon::prelude::*;
use simd::Lanes;
use splats::Splats;
use walk::{ChainKernel, Chains, Tally, Walk};

/// Pixels for each candidate: with fewer candidates a run's brightness is noise, with more there is little time left for
/// its chains.
const PIXELS_PER_CANDIDATE: usize = 8;

/// Candidates that one thread takes at a time. Of chains it takes as many as there are lanes.
const CANDIDATES_AT_ONCE: usize = 512;

/// Runs beside each other: each takes half as much memory as the film.
const MOST_RUNS_AT_ONCE: u32 = 4;

/// Tells steps of chains from the numbers of candidates.
const STEPS_KEY: u32 = 0x3e7_0b05;

/// The settings of one picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MetropolisSettings {
    /// How paths walk, which do not branch. Its sampler draws candidates.
    pub path: PathSettings,
    /// Chains of each run, at least 1.
    pub chains: u32,
    /// Probability that a mutation draws all random numbers anew, from 0 to 1.
    pub large_step: f32,
    /// The most by which a small step moves a random number; it moves at least a sixteenth of it.
    pub mutation: f32,
}

impl Default for MetropolisSettings {
    fn default() -> Self {
        MetropolisSettings { path: PathSettings::default(), chains: 32, large_step: 0.3, mutation: 1.0 / 64.0 }
    }
}

impl MetropolisSettings {
    pub(super) fn check(&self) -> Result<(), SettingsError> {
        let estimator = self.path.estimator;
        if estimator.directions == Directions::Guided {
            return Err(SettingsError::GuidedChains(estimator.name()));
        }
        self.path.check()
    }

    /// Adds runs up to the wished number. One that is stopped is left out, and made again by the next call.
    pub(super) fn fill(&self, film: &mut Film, job: &FilmJob) -> Stats {
        let plan = Plan::new(&PathSettings { branches: 1, cones: ConesAt::Nothing, split_glass: false, ..self.path });
        let (mut next, until) = (film.samples_per_pixel(), job.pass.until);
        let at_once = self.runs_at_once(job.lanes).min(until - next);
        let mut splats: Vec<_> = (0..at_once).map(|_| Splats::new(film.pixels().len())).collect();
        let mut stats = Stats::default();
        while next < until {
            let run = |(splats, number)| Run { settings: self, job, plan: &plan, splats, number }.walk();
            let walked: Vec<_> = splats.par_iter().zip(next..until).map(run).collect();
            for ((tally, scale), splats) in walked.into_iter().zip(&mut splats) {
                if tally.stopped {
                    return stats;
                }
                splats.resolve(film, scale);
                film.nonfinite += tally.nonfinite;
                stats = stats.plus(tally.stats);
                next += 1;
            }
        }
        stats
    }

    /// Runs beside each other, where the chains of one are too few for all threads.
    fn runs_at_once(&self, lanes: Lanes) -> u32 {
        let parts = self.chains.div_ceil(lanes.count() as u32).max(1);
        (rayon::current_num_threads() as u32).div_ceil(parts).min(MOST_RUNS_AT_ONCE)
    }
}

/// One sample of every pixel.
struct Run<'a> {
    settings: &'a MetropolisSettings,
    job: &'a FilmJob<'a>,
    plan: &'a Plan<'a>,
    splats: &'a Splats,
    number: u32,
}

impl Run<'_> {
    /// Draws candidates and lets chains walk from some of them. Returns what one mutation's light counts.
    fn walk(&self) -> (Tally, f64) {
        let pixels = self.pixels();
        let candidates: Vec<Sampler> = (0..pixels.div_ceil(PIXELS_PER_CANDIDATE).max(self.chains()) as u32)
            .map(|number| self.candidate(number))
            .collect();
        let (drawn, luminances) = self.follow(&candidates, 0, CANDIDATES_AT_ONCE);
        let sum: f64 = luminances.iter().copied().map(f64::from).sum();
        let starts: Vec<Sampler> = self.chosen(&luminances, sum).into_iter().map(|number| candidates[number]).collect();
        let mutations = pixels.div_ceil(self.chains());
        let (walked, _) = self.follow(&starts, mutations as u32, self.job.lanes.count());
        let scale = sum / candidates.len() as f64;
        let mut tally = drawn.plus(walked);
        tally.stats.chains = ChainStats { runs: 1, scales: scale, ..tally.stats.chains };
        (tally, scale * pixels as f64 / (self.chains() * mutations) as f64)
    }

    fn pixels(&self) -> usize {
        let [width, height] = self.job.pass.size.map(|side| side as usize);
        width * height
    }

    fn chains(&self) -> usize {
        self.settings.chains.max(1) as usize
    }

    /// The random numbers of a candidate.
    fn candidate(&self, number: u32) -> Sampler {
        let PathSettings { sampler, seed, .. } = self.settings.path;
        Sampler { kind: sampler, pixel: self.number, sample: number, seed }
    }

    /// The candidate of each chain, in proportion to luminance, at even distances of the running sum; none where all is
    /// black.
    fn chosen(&self, luminances: &[f32], sum: f64) -> Vec<usize> {
        let [offset, ..] = pcg4d([self.number, 0, 0, self.settings.path.seed ^ STEPS_KEY]);
        let (count, offset) = (self.chains(), f64::from(unit_float(offset)));
        let (mut chosen, mut running) = (Vec::with_capacity(count), 0.0);
        for (number, luminance) in luminances.iter().enumerate() {
            running += f64::from(*luminance);
            while chosen.len() < count && (chosen.len() as f64 + offset) * sum < running * count as f64 {
                chosen.push(number);
            }
        }
        chosen
    }

    /// Chains from these starts to their ends, on the current pool, and the luminance that each began with.
    fn follow(&self, starts: &[Sampler], mutations: u32, at_once: usize) -> (Tally, Vec<f32>) {
        let Run { settings, job, plan, splats, number } = self;
        let walk = Walk {
            scene: job.scene,
            plan,
            frame: &job.pass.frame,
            size: job.pass.size,
            large_step: settings.large_step,
            mutation: settings.mutation,
            key: settings.path.seed ^ STEPS_KEY,
            splats,
            stop: job.stop,
        };
        let first = number.wrapping_mul(settings.chains);
        let mut luminances = vec![0.0; starts.len()];
        let tally = luminances
            .par_chunks_mut(at_once)
            .zip(starts.par_chunks(at_once))
            .enumerate()
            .map(|(index, (luminances, starts))| {
                let first = first.wrapping_add((index * at_once) as u32);
                let chains = Chains { first, starts, mutations, luminances };
                job.lanes.run(ChainKernel { walk: &walk, chains })
            })
            .reduce(Tally::default, Tally::plus);
        (tally, luminances)
    }
}
