//! Points of primary sample space, one for the chain in each lane: the random numbers that a path asks for are a point's
//! coordinates, in blocks of four, and a mutation moves all of them a little, or draws all anew.
//!
//! Coordinates are 32-bit fractions: a step that wraps around stays on the torus, and is as likely there as back. Where a
//! chain stands is a pure function: its last large step, and the small steps since, each drawn by a hash. So only
//! coordinates that a path asks for are computed, whenever it does, and what was computed is kept up to date.

use crate::integrator::path_state::CONNECTION;
use crate::integrator::settings::PathSettings;
use crate::intersect::aggregate::lanes_of;
use crate::sampling::rng::{pcg4d, unit_float};
use crate::sampling::sampler::{RandomNumbers, Sampler, SamplerKind};
use simd::{Float, MOST_LANES, Mask, Word};
use std::cell::RefCell;

/// Blocks whose coordinates are kept: the camera's, two of each vertex that a path may have, and behind them one of each
/// for connections. What is not kept is computed from the last large step on, which takes as long as a chain stays there.
const KEPT_BLOCKS: usize = CONNECTION_BLOCKS + HARD_CAP + 2;
const CONNECTION_BLOCKS: usize = 2 * HARD_CAP + 3;
const HARD_CAP: usize = PathSettings::HARD_CAP as usize;

/// The block whose numbers decide on the mutation itself: none that a path asks for.
const DECISION: u32 = u32::MAX;

/// What a chain proposes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Proposal {
    /// The candidate with which it begins.
    Start,
    /// A point nearby, by Kelemen's small step.
    Small,
    /// A point anywhere, drawn independently of the last.
    Large,
}

/// Four coordinates as they were when last asked for.
#[derive(Clone, Copy)]
struct Block {
    words: [u32; 4],
    /// Small steps that are in them.
    steps: u32,
    /// The origin that they belong to.
    origin: u32,
}

/// Where a chain stands.
struct Point {
    /// All coordinates at its start or after its last large step.
    origin: Sampler,
    /// Tells origins apart: counts the large steps.
    origins: u32,
    /// The mutations that were small steps from there.
    steps: Vec<u32>,
    blocks: Vec<Block>,
}

impl Point {
    fn new() -> Self {
        let nowhere = Block { words: [0; 4], steps: 0, origin: 0 };
        Point {
            origin: Sampler::independent(0, 0, 0),
            origins: 0,
            steps: Vec::new(),
            blocks: vec![nowhere; KEPT_BLOCKS],
        }
    }

    fn move_to(&mut self, origin: Sampler) {
        self.origin = origin;
        self.origins = self.origins.wrapping_add(1);
        self.steps.clear();
    }

    /// Coordinates as far as they are known, and whether they were kept.
    #[inline(always)]
    fn block(&self, dimension: u32) -> (Block, bool) {
        match self.blocks.get(slot(dimension)) {
            Some(block) if block.origin == self.origins => (*block, true),
            _ => (Block { words: self.origin.words4(dimension), steps: 0, origin: self.origins }, false),
        }
    }

    #[inline(always)]
    fn keep(&mut self, dimension: u32, words: [u32; 4]) {
        let (steps, origin) = (self.steps.len() as u32, self.origins);
        if let Some(block) = self.blocks.get_mut(slot(dimension)) {
            *block = Block { words, steps, origin };
        }
    }
}

/// A chain's point in each lane, and the mutation that it proposes.
pub struct PrimaryPoints<F: Float> {
    /// Kept up to date where a path asks.
    points: RefCell<Vec<Point>>,
    /// Lanes whose paths ask for numbers now.
    pub active: F::M,
    chain: [u32; MOST_LANES],
    mutation: [u32; MOST_LANES],
    /// How many small steps each lane's point has taken, and the mutation that was the last of them.
    steps: [u32; MOST_LANES],
    last_step: [u32; MOST_LANES],
    /// Lanes whose proposals are small steps, and large ones.
    small: u32,
    large: u32,
    /// Chooses among the steps of all chains.
    key: u32,
    /// Length of the longest small step.
    size: f32,
}

impl<F: Float> PrimaryPoints<F> {
    /// Of lanes in which no chain has begun yet.
    pub fn new(key: u32, size: f32) -> Self {
        PrimaryPoints {
            points: RefCell::new((0..F::LANES).map(|_| Point::new()).collect()),
            active: F::M::splat(false),
            chain: [0; MOST_LANES],
            mutation: [0; MOST_LANES],
            steps: [0; MOST_LANES],
            last_step: [0; MOST_LANES],
            small: 0,
            large: 0,
            key,
            size,
        }
    }

    /// A chain begins in a lane, with this candidate.
    pub fn start(&mut self, lane: usize, chain: u32, candidate: Sampler) {
        (self.chain[lane], self.mutation[lane]) = (chain, 0);
        self.move_to(lane, candidate);
        self.propose(lane, Proposal::Start);
    }

    /// The number of a lane's mutation; 0 where its chain begins.
    pub fn mutation(&self, lane: usize) -> u32 {
        self.mutation[lane]
    }

    /// The next mutation of a lane's chain, a large step with this probability. Returns a number in [0, 1) to decide
    /// by whether it is taken.
    pub fn mutate(&mut self, lane: usize, large_step: f32) -> f32 {
        self.mutation[lane] += 1;
        let [size, taken, ..] = pcg4d([self.chain[lane], self.mutation[lane], DECISION, self.key]);
        let is_large = unit_float(size) < large_step;
        self.propose(lane, if is_large { Proposal::Large } else { Proposal::Small });
        unit_float(taken)
    }

    fn propose(&mut self, lane: usize, proposal: Proposal) {
        let bit = 1 << lane;
        self.small = if proposal == Proposal::Small { self.small | bit } else { self.small & !bit };
        self.large = if proposal == Proposal::Large { self.large | bit } else { self.large & !bit };
    }

    /// A lane's chain takes the mutation that it has proposed.
    pub fn accept(&mut self, lane: usize) {
        if self.large >> lane & 1 != 0 {
            self.move_to(lane, drawn(self.chain[lane], self.mutation[lane], self.key));
        } else {
            self.points.get_mut()[lane].steps.push(self.mutation[lane]);
            self.steps[lane] += 1;
            self.last_step[lane] = self.mutation[lane];
        }
    }

    fn move_to(&mut self, lane: usize, origin: Sampler) {
        self.points.get_mut()[lane].move_to(origin);
        self.steps[lane] = 0;
    }

    /// Four coordinates of the proposals in the lanes `here`.
    #[inline(always)]
    pub fn words4(&self, here: F::M, dimension: F::U) -> [F::U; 4] {
        let drawn = self.drawn(F::U::load(&self.mutation), dimension);
        let (small, large) = (F::M::from_bits(self.small), F::M::from_bits(self.large));
        let stays = here & !large;
        if !stays.any() {
            return drawn;
        }
        let at = self.up_to_date(stays, dimension);
        let moved = moved::<F>(at, small, drawn, self.size);
        select4::<F>(large, drawn, moved)
    }

    /// Four coordinates of the points in the lanes `here`. Steps add up in any order: the last one first, which is all
    /// that most coordinates lack.
    #[inline(always)]
    fn up_to_date(&self, here: F::M, dimension: F::U) -> [F::U; 4] {
        let mut points = self.points.borrow_mut();
        let mut dimensions = [0; MOST_LANES];
        dimension.store(&mut dimensions);
        let mut known = [[0; MOST_LANES]; 4];
        let (mut steps, mut all_kept) = ([0; MOST_LANES], true);
        for lane in lanes_of(here) {
            let (block, was_kept) = points[lane].block(dimensions[lane]);
            all_kept &= was_kept;
            steps[lane] = block.steps;
            for (known, word) in known.iter_mut().zip(block.words) {
                known[lane] = word;
            }
        }
        let mut words = load4::<F>(&known);
        let mut left = F::U::load(&self.steps).wrapping_sub(F::U::load(&steps));
        let mut behind = here & !left.eq(F::U::splat(0));
        if all_kept && !behind.any() {
            return words;
        }
        let mut mutation = self.last_step;
        while behind.any() {
            let drawn = self.drawn(F::U::load(&mutation), dimension);
            words = moved::<F>(words, behind, drawn, self.size);
            left = F::U::select(behind, left.wrapping_sub(F::U::splat(1)), left);
            behind = here & !left.eq(F::U::splat(0));
            for lane in lanes_of(behind) {
                mutation[lane] = points[lane].steps[steps[lane] as usize];
                steps[lane] += 1;
            }
        }
        store4::<F>(words, &mut known);
        for lane in lanes_of(here) {
            points[lane].keep(dimensions[lane], [known[0][lane], known[1][lane], known[2][lane], known[3][lane]]);
        }
        words
    }

    /// The words of the mutations of these numbers.
    #[inline(always)]
    fn drawn(&self, mutation: F::U, dimension: F::U) -> [F::U; 4] {
        pcg4d([F::U::load(&self.chain), mutation, dimension, F::U::splat(self.key)])
    }
}

impl<F: Float> RandomNumbers<F::U> for PrimaryPoints<F> {
    #[inline(always)]
    fn unit4(&self, dimension: F::U) -> [F; 4] {
        let [a, b, c, d] = self.words4(self.active, dimension);
        [unit_float(a), unit_float(b), unit_float(c), unit_float(d)]
    }
}

/// The place of a block among those that are kept.
#[inline(always)]
fn slot(dimension: u32) -> usize {
    let block = (dimension & !CONNECTION) as usize;
    if dimension == block as u32 { block } else { CONNECTION_BLOCKS + block / 2 }
}

/// Where a mutation that draws all coordinates anew leads: its blocks are the words by which a small step would go.
fn drawn(chain: u32, mutation: u32, key: u32) -> Sampler {
    Sampler { kind: SamplerKind::Independent, pixel: chain, sample: mutation, seed: key }
}

/// Coordinates a small step further, where `here` says so.
#[inline(always)]
fn moved<F: Float>(words: [F::U; 4], here: F::M, drawn: [F::U; 4], size: f32) -> [F::U; 4] {
    let [a, b, c, d] = drawn;
    let by = [small_step(a, size), small_step(b, size), small_step(c, size), small_step(d, size)];
    let further = [
        words[0].wrapping_add(by[0]),
        words[1].wrapping_add(by[1]),
        words[2].wrapping_add(by[2]),
        words[3].wrapping_add(by[3]),
    ];
    select4::<F>(here, further, words)
}

/// Kelemen's step from a random word, as a fraction of 2^32: as likely forth as back, its length `size` times 16^-r, r
/// uniform in [0, 1). The power of two is right to .2 %, which bends the lengths' density a little and nothing else.
#[inline(always)]
fn small_step<U: Word>(word: U, size: f32) -> U {
    let halvings = word.shr::<30>();
    let fraction = (word.shr::<8>() & U::splat(0x003f_ffff)).to_float() * (1.0 / 4_194_304.0);
    let power = fraction * (fraction * 0.1717 - 0.6717) + 1.0;
    let length = (power * (size * 4_294_967_296.0)).to_bits().wrapping_sub(halvings.shl::<23>());
    let length = length.float_from_bits().to_word();
    let forth = (word & U::splat(1)).eq(U::splat(1));
    U::select(forth, length, U::splat(0).wrapping_sub(length))
}

#[inline(always)]
fn select4<F: Float>(mask: F::M, yes: [F::U; 4], no: [F::U; 4]) -> [F::U; 4] {
    [
        F::U::select(mask, yes[0], no[0]),
        F::U::select(mask, yes[1], no[1]),
        F::U::select(mask, yes[2], no[2]),
        F::U::select(mask, yes[3], no[3]),
    ]
}

#[inline(always)]
fn load4<F: Float>(from: &[[u32; MOST_LANES]; 4]) -> [F::U; 4] {
    [F::U::load(&from[0]), F::U::load(&from[1]), F::U::load(&from[2]), F::U::load(&from[3])]
}

#[inline(always)]
fn store4<F: Float>(words: [F::U; 4], to: &mut [[u32; MOST_LANES]; 4]) {
    words[0].store(&mut to[0]);
    words[1].store(&mut to[1]);
    words[2].store(&mut to[2]);
    words[3].store(&mut to[3]);
}

#[cfg(test)]
#[path = "primary_tests.rs"]
mod tests;
