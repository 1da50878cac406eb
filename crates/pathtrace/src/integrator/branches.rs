//! Rays of a tree on their way or waiting, in each lane.
//!
//! Twin: `shaders/pathtrace/integrator/whitted.wgsl`.

use crate::integrator::whitted::WhittedSettings;
use crate::intersect::{Rays, SurfacePoints};
use simd::{Float, Mask, Vector, Word};

/// A ray on its way, or waiting, in each lane.
#[derive(Clone, Copy)]
pub struct Branches<F: Float> {
    pub rays: Rays<F>,
    /// What radiance met now is worth at the camera.
    pub weight: Vector<F>,
    /// Specular scatterings so far.
    pub depth: F::U,
    /// The row behind the last vertex, where not all light counts.
    pub light_path: F::U,
}

impl<F: Float> Branches<F> {
    /// As they leave the camera.
    #[inline(always)]
    pub fn leaving_camera(rays: &Rays<F>) -> Self {
        let none = F::U::splat(0);
        Branches { rays: *rays, weight: Vector::along_all(F::splat(1.0)), depth: none, light_path: none }
    }

    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Branches {
            rays: Rays::select(mask, yes.rays, no.rays),
            weight: Vector::select(mask, yes.weight, no.weight),
            depth: F::U::select(mask, yes.depth, no.depth),
            light_path: F::U::select(mask, yes.light_path, no.light_path),
        }
    }

    /// The branch that leaves a surface in the unit direction `wi`.
    #[inline(always)]
    pub fn leave(&self, from: &SurfacePoints<F>, wi: Vector<F>, weight: Vector<F>) -> Self {
        let depth = self.depth.wrapping_add(F::U::splat(1));
        Branches { rays: Rays::new(from.leaving_towards(wi), wi), weight, depth, light_path: self.light_path }
    }
}

/// Reflected branches that wait, deepest last, in each lane: at most one for each level.
pub struct Waiting<F: Float> {
    pub branches: Vec<Branches<F>>,
    pub count: F::U,
}

impl<F: Float> Waiting<F> {
    #[inline(always)]
    pub fn push(&mut self, here: F::M, branch: &Branches<F>) {
        for depth in 0..(self.branches.len() + 1).min(WhittedSettings::MOST_DEPTH as usize) {
            let at = here & self.count.eq(F::U::splat(depth as u32));
            if at.any() {
                if depth == self.branches.len() {
                    self.branches.push(*branch);
                }
                self.branches[depth] = Branches::select(at, *branch, self.branches[depth]);
            }
        }
        self.count = F::U::select(here, self.count.wrapping_add(F::U::splat(1)), self.count);
    }

    /// Takes the deepest where `here` says so and one waits, and says where.
    #[inline(always)]
    pub fn pop(&mut self, here: F::M, branch: &mut Branches<F>) -> F::M {
        let mut found = F::M::splat(false);
        for (depth, waiting) in (0..).zip(&self.branches) {
            let at = here & self.count.eq(F::U::splat(depth + 1));
            if at.any() {
                *branch = Branches::select(at, *waiting, *branch);
                found = found | at;
            }
        }
        self.count = F::U::select(found, self.count.wrapping_sub(F::U::splat(1)), self.count);
        found
    }
}
