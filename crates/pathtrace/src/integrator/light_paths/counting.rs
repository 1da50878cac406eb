//! Paths read a vertex at a time, in each lane: what a lane keeps is the row of its state.
//!
//! Twin: `shaders/pathtrace/integrator/light_paths.wgsl`.

use super::{ACCEPTS, Automaton, BEGINS, LightPaths};
use crate::bsdf::Interactions;
use simd::{Float, Mask, Word, WordColumn};

/// An automaton as lanes look it up.
#[derive(Debug, Clone)]
pub struct CountedPaths {
    rows: WordColumn,
    begins: u32,
}

/// Where a path scatters: at surfaces that are neither are diffuse.
#[derive(Clone, Copy)]
pub struct Scattering<M> {
    /// In which lanes it is at rough metal or metallic-roughness.
    pub glossy: M,
    /// In which lanes it is at a mirror or glass.
    pub specular: M,
}

impl<M> Scattering<M> {
    /// At surfaces as they are met.
    #[inline(always)]
    pub fn at<F: Float<M = M>>(at: &Interactions<F>) -> Self {
        Scattering { glossy: at.kinds.glossy(), specular: at.is_delta() }
    }
}

impl CountedPaths {
    /// What tells which paths count; `None` where all do.
    pub fn of(paths: &LightPaths) -> Option<Self> {
        let Automaton { rows } = paths.automaton()?;
        Some(CountedPaths { begins: rows[BEGINS as usize], rows: WordColumn::new(rows) })
    }

    /// The row of paths that leave the eye.
    #[inline(always)]
    pub fn begin<U: Word>(&self) -> U {
        U::splat(self.begins)
    }

    /// The row behind a vertex; 0 where no light counts any more.
    #[inline(always)]
    pub fn after<U: Word>(&self, row: U, at: Scattering<U::M>) -> U {
        let next = U::select(at.specular, row.shr::<16>(), U::select(at.glossy, row.shr::<8>(), row));
        (next & U::splat(0xff)).look_up_word(&self.rows)
    }

    /// The row behind a mirror or glass.
    #[inline(always)]
    pub fn after_specular<U: Word>(&self, row: U) -> U {
        self.after(row, Scattering { glossy: U::M::splat(false), specular: U::M::splat(true) })
    }

    /// The row behind a diffuse vertex.
    #[inline(always)]
    pub fn after_diffuse<U: Word>(&self, row: U) -> U {
        self.after(row, Scattering { glossy: U::M::splat(false), specular: U::M::splat(false) })
    }
}

/// Where light that is found now counts.
#[inline(always)]
pub fn counts<U: Word>(row: U) -> U::M {
    !(row & U::splat(ACCEPTS)).eq(U::splat(0))
}
