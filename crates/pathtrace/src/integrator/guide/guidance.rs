//! A guide beside paths, one in each lane: it bends the numbers for their directions, or learns from them.

use super::training::{Notes, Recorder, Turn};
use super::{Bent, Guide};
use crate::bsdf::Interactions;
use crate::vectors::each_lane;
use simd::{Float, Mask, Vector, Word};

/// What guides know of the vertices that paths are leaving.
pub struct Guidance<'a, F: Float> {
    guide: Option<&'a Guide>,
    recorder: Option<Recorder<'a>>,
    /// Where these vertices are diffuse, which guides know alone.
    here: F::M,
    cell: F::U,
    /// How many times as dense as without a guide the direction was drawn.
    ratio: F,
    /// The bin of the direction, while a guide learns.
    place: F::U,
}

impl<'a, F: Float> Guidance<'a, F> {
    /// By a guide, for one that learns, or by none.
    #[inline(always)]
    pub fn new(guide: Option<&'a Guide>, notes: Option<&'a Notes>) -> Self {
        let none = F::U::splat(0);
        let recorder = notes.map(Recorder::new);
        Guidance { guide, recorder, here: F::M::splat(false), cell: none, ratio: F::splat(1.0), place: none }
    }

    /// The numbers for the directions in which paths leave diffuse vertices `here`.
    #[inline(always)]
    pub fn bend(&mut self, here: F::M, at: &Interactions<F>, [a, b, c]: [F; 3]) -> [F; 3] {
        self.here = here;
        if let Some(recorder) = &self.recorder {
            self.place = recorder.notes().place(at.point.position, at.normal, [a, b]);
        }
        let Some(guide) = self.guide else { return [a, b, c] };
        self.cell = guide.cell(at.point.position, at.normal);
        let Bent { u, ratio } = guide.bend(self.cell, [a, b]);
        self.ratio = F::select(here, ratio, F::splat(1.0));
        [F::select(here, u[0], a), F::select(here, u[1], b), c]
    }

    /// How many times as dense as without a guide the directions were drawn; `None` without one.
    #[inline(always)]
    pub fn ratio(&self) -> Option<F> {
        self.guide.map(|_| self.ratio)
    }

    /// The density of directions `wi` from these vertices, which would be `pdf` without a guide.
    #[inline(always)]
    pub fn pdf(&self, at: &Interactions<F>, wi: Vector<F>, pdf: F) -> F {
        match self.guide {
            Some(guide) => F::select(self.here, pdf * guide.ratio(self.cell, at.normal, wi), pdf),
            None => pdf,
        }
    }

    /// A control variate: where roulette changes what paths carry, the difference brings home what the guide expects
    /// beyond the vertex. On average the difference is none.
    #[inline(always)]
    pub fn made_up_for(&self, alive: F::M, lost: Vector<F>) -> Vector<F> {
        let Some(guide) = self.guide else { return Vector::zero() };
        let expected = guide.radiance(self.cell) * self.ratio;
        Vector::select(alive & self.here, lost * expected, Vector::zero())
    }

    /// Whether a guide learns.
    #[inline(always)]
    pub fn learns(&self) -> bool {
        self.recorder.is_some()
    }

    /// Writes down how a turn went: which paths have scattered and which have ended, what all carried before and after
    /// roulette, and what they have brought home.
    #[inline(always)]
    pub fn note(
        &mut self,
        [scattered, ended]: [F::M; 2],
        carried: [Vector<F>; 2],
        home: Vector<F>,
        [pixel, sample]: [F::U; 2],
    ) {
        let Some(recorder) = &mut self.recorder else { return };
        recorder.note(&Turn {
            left: (scattered & self.here).bits(),
            ended: ended.bits(),
            place: Turn::numbers(self.place),
            radiance: each_lane(home),
            before: each_lane(carried[0]),
            after: each_lane(carried[1]),
            pixel: Turn::numbers(pixel),
            sample: Turn::numbers(sample),
        });
    }
}
