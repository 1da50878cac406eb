//! Glass that the camera sees, straight or by mirrors and glass, sends a path on both ways, as Whitted's trees do: one
//! part goes on, the other waits on a small stack in each lane.
//!
//! Fresnel's choice alone would send few paths into reflections inside glass, where the sun, hundreds of times as bright
//! as what is beside it, glints: one sample in a thousand, a thousand times as bright.
//!
//! Twin: `shaders/pathtrace/integrator/path.wgsl`.

use crate::bsdf::{Interactions, mirror};
use crate::integrator::forks::child;
use crate::integrator::path::PathLanes;
use crate::integrator::path_state::PathStates;
use crate::intersect::Rays;
use simd::{Float, Mask, Word};

/// Vertices of a path up to which glass splits it. Measured, both spheres of `whitted` under sun and sky without the
/// floor, 64 spp: relMSE 3.3e-3 at 0, 1.7e-3 at 1, 0.70e-3 at 2 and 0.62e-3 at 3, where what is left is edges; a sample
/// of the whole scene takes 1.16, 1.39 and 1.63 times as long.
pub(crate) const SPLITTING_VERTICES: u32 = 2;

/// The largest of the random numbers: glass refracts, unless all is reflected.
pub(crate) const ALWAYS_REFRACTED: f32 = 1.0 - 0.5 * f32::EPSILON;

/// Paths on their way that wait, the last one goes first.
pub struct Splits<F: Float> {
    waiting: Vec<PathStates<F>>,
    /// How many of them wait in each lane.
    count: F::U,
}

impl<F: Float> Default for Splits<F> {
    #[inline(always)]
    fn default() -> Self {
        Splits { waiting: Vec::new(), count: F::U::splat(0) }
    }
}

impl<F: Float> Splits<F> {
    /// Lets paths wait where `here` says so.
    #[inline(always)]
    pub fn push(&mut self, here: F::M, path: &PathStates<F>) {
        for depth in 0..=self.waiting.len() {
            let at = here & self.count.eq(F::U::splat(depth as u32));
            if !at.any() {
                continue;
            }
            if depth == self.waiting.len() {
                self.waiting.push(*path);
            }
            self.waiting[depth] = PathStates::select(at, *path, self.waiting[depth]);
        }
        self.count = F::U::select(here, self.count.wrapping_add(F::U::splat(1)), self.count);
    }

    /// Goes on with the last path that waits, where `here` says so and one does, and says where.
    #[inline(always)]
    pub fn next(&mut self, here: F::M, path: &mut PathStates<F>) -> F::M {
        let here = here & !self.count.eq(F::U::splat(0));
        if !here.any() {
            return here;
        }
        for (depth, waiting) in (0..).zip(&self.waiting) {
            let at = here & self.count.eq(F::U::splat(depth + 1));
            *path = PathStates::select(at, *waiting, *path);
        }
        self.count = F::U::select(here, self.count.wrapping_sub(F::U::splat(1)), self.count);
        here
    }
}

impl<F: Float> PathLanes<'_, F> {
    /// Whether there is glass that splits paths.
    #[inline(always)]
    pub(super) fn splits_glass(&self) -> bool {
        self.plan.splits && self.scene.materials.has().glass
    }

    /// Where glass that the camera sees is to split paths.
    #[inline(always)]
    pub(super) fn splitting(&self, here: F::M, at: &Interactions<F>) -> F::M {
        if !self.splits_glass() {
            return F::M::splat(false);
        }
        here & self.from_camera & at.kinds.glass() & self.path.vertices.lt(F::U::splat(SPLITTING_VERTICES))
    }

    /// Lets the part of paths that glass reflects wait where they go on by refraction.
    #[inline(always)]
    pub(super) fn split(&mut self, splitting: F::M, at: &Interactions<F>) {
        let refracted = splitting & at.normal.dot(self.path.rays.direction).lt(F::splat(0.0));
        if !refracted.any() {
            return;
        }
        let share = self.scene.materials.reflected_beside(at, self.path.rays.direction);
        let wi = mirror::reflected(at.wo, at.normal).normalize();
        let rays = Rays::new(at.point.leaving_towards(wi), wi);
        let path = self.path;
        let [first, second] = [child::<F>(path.branch, 2, F::U::splat(0)), child::<F>(path.branch, 2, F::U::splat(1))];
        let vertices = path.vertices.wrapping_add(F::U::splat(1));
        let waiting = PathStates { rays, throughput: path.throughput * share, branch: second, vertices, ..path };
        self.splits.push(refracted & share.gt(F::splat(0.0)), &waiting);
        let throughput = path.throughput * (F::splat(1.0) - share);
        self.path = PathStates::select(refracted, PathStates { throughput, branch: first, ..path }, path);
    }

    /// Goes on with parts of paths that wait where others have ended, and says where.
    #[inline(always)]
    pub(super) fn next_split(&mut self, ended: F::M) -> F::M {
        let waited = self.splits.next(ended, &mut self.path);
        self.from_camera = self.from_camera | waited;
        if self.connecting {
            self.chain.begin(waited);
        }
        waited
    }
}
