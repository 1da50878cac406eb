//! Vertices that wait for their other branches ("When N>1: Distributed ray tracing"), a small stack in each lane.
//!
//! Twin: `shaders/pathtrace/integrator/path.wgsl`.

use crate::integrator::path_state::{DiffuseVertices, PathStates};
use simd::{Float, Mask, Word};

/// Vertices that can wait for more branches at a time: two to this power is [`crate::integrator::path_plan::MOST_BRANCHES`].
pub const MOST_FORKS: usize = 16;

/// A vertex that more branches will leave, in each lane.
#[derive(Clone, Copy)]
struct Fork<F: Float> {
    vertex: DiffuseVertices<F>,
    /// As it arrived.
    path: PathStates<F>,
    /// Branches to come.
    left: F::U,
}

/// Vertices that wait for their other branches, deepest last.
pub struct Forks<F: Float> {
    waiting: Vec<Fork<F>>,
    /// How many of them wait in each lane.
    count: F::U,
}

impl<F: Float> Default for Forks<F> {
    #[inline(always)]
    fn default() -> Self {
        Forks { waiting: Vec::new(), count: F::U::splat(0) }
    }
}

impl<F: Float> Forks<F> {
    /// Lets vertices wait where `here` says so.
    #[inline(always)]
    pub fn push(&mut self, here: F::M, vertex: &DiffuseVertices<F>, path: &PathStates<F>, left: u32) {
        let fork = Fork { vertex: *vertex, path: *path, left: F::U::splat(left) };
        for depth in 0..(self.waiting.len() + 1).min(MOST_FORKS) {
            let at = here & self.count.eq(F::U::splat(depth as u32));
            if !at.any() {
                continue;
            }
            if depth == self.waiting.len() {
                self.waiting.push(fork);
            }
            self.waiting[depth] = Fork::select(at, fork, self.waiting[depth]);
        }
        self.count = F::U::select(here, self.count.wrapping_add(F::U::splat(1)), self.count);
    }

    /// Goes back to the deepest vertex that waits, where `here` says so and one does, and says where: vertex and path
    /// are then those with which its next branch begins.
    #[inline(always)]
    pub fn next(
        &mut self,
        here: F::M,
        branches: u32,
        vertex: &mut DiffuseVertices<F>,
        path: &mut PathStates<F>,
    ) -> F::M {
        let one = F::U::splat(1);
        let (count, mut found) = (self.count, F::M::splat(false));
        for (depth, fork) in (0..).zip(&mut self.waiting) {
            let at = here & count.eq(F::U::splat(depth + 1));
            if !at.any() {
                continue;
            }
            found = found | at;
            *vertex = DiffuseVertices::select(at, fork.vertex, *vertex);
            let branch = child::<F>(fork.path.branch, branches, F::U::splat(branches).wrapping_sub(fork.left));
            *path = PathStates::select(at, fork.path.numbered(branch), *path);
            self.count = F::U::select(at & fork.left.eq(one), self.count.wrapping_sub(one), self.count);
            fork.left = F::U::select(at, fork.left.wrapping_sub(one), fork.left);
        }
        found
    }
}

impl<F: Float> Fork<F> {
    #[inline(always)]
    fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Fork {
            vertex: DiffuseVertices::select(mask, yes.vertex, no.vertex),
            path: PathStates::select(mask, yes.path, no.path),
            left: F::U::select(mask, yes.left, no.left),
        }
    }
}

/// Number of a path's branch `index` in a tree where each has `branches`.
#[inline(always)]
pub fn child<F: Float>(parent: F::U, branches: u32, index: F::U) -> F::U {
    parent.wrapping_mul(F::U::splat(branches)).wrapping_add(index).wrapping_add(F::U::splat(1))
}
