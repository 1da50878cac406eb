//! Vertices whose connections wait. In a turn few lanes are at vertices that connect, and what is done for one lane takes
//! as long as for all of them: so connections are made when one of them cannot wait any longer, for all that wait.
//!
//! What they bring is summed up by itself, and added when the sample is complete: else rounding would tell how long they
//! have waited, which depends on the other lanes.
//!
//! No twin: a thread of a device has one path.

use crate::bsdf::Interactions;
use crate::integrator::path::PathLanes;
use crate::integrator::path_state::PathStates;
use crate::sampling::sampler::RandomNumbers;
use simd::{Float, Mask, Vector, Word};

/// A vertex in each lane that is to be connected to a light.
#[derive(Clone, Copy)]
pub struct ConnectingVertices<F: Float> {
    /// Where there is one.
    pub here: F::M,
    pub at: Interactions<F>,
    /// What radiance found there is worth at the camera.
    pub throughput: Vector<F>,
    /// Vertices at which the path has scattered before.
    pub vertices: F::U,
    /// The block of its random numbers.
    pub dimension: F::U,
    /// Which light counts behind it.
    pub light_path: F::U,
}

/// Vertices that wait for their connections, and what others have found.
pub struct WaitingVertices<F: Float> {
    waiting: ConnectingVertices<F>,
    /// Those of this turn.
    arrived: ConnectingVertices<F>,
    /// What connections have brought home, of samples that are not complete.
    pub found: Vector<F>,
    /// Samples that would be complete but for their connections.
    lingering: F::M,
}

impl<F: Float> ConnectingVertices<F> {
    #[inline(always)]
    fn none() -> Self {
        let (here, at, zero) = (F::M::splat(false), Interactions::none(), F::U::splat(0));
        ConnectingVertices { here, at, throughput: Vector::zero(), vertices: zero, dimension: zero, light_path: zero }
    }

    /// These as well, where `mask` says so.
    #[inline(always)]
    fn take(&mut self, mask: F::M, others: &Self) {
        self.at = Interactions::select(mask, others.at, self.at);
        self.throughput = Vector::select(mask, others.throughput, self.throughput);
        self.vertices = F::U::select(mask, others.vertices, self.vertices);
        self.dimension = F::U::select(mask, others.dimension, self.dimension);
        self.light_path = F::U::select(mask, others.light_path, self.light_path);
        self.here = self.here | mask;
    }
}

impl<F: Float> WaitingVertices<F> {
    /// As before the first vertex: nothing waits.
    #[inline(always)]
    pub fn none() -> Self {
        let none = ConnectingVertices::none();
        WaitingVertices { waiting: none, arrived: none, found: Vector::zero(), lingering: F::M::splat(false) }
    }

    /// Samples that do nothing in this turn but wait for their connections.
    #[inline(always)]
    pub fn lingering(&self) -> F::M {
        self.lingering
    }

    /// Vertices of paths as they arrive there, to be connected to lights.
    #[inline(always)]
    pub fn arrive(&mut self, here: F::M, at: &Interactions<F>, path: &PathStates<F>) {
        let PathStates { throughput, vertices, light_path, .. } = *path;
        let dimension = path.connection_dimension();
        self.arrived = ConnectingVertices { here, at: *at, throughput, vertices, dimension, light_path };
    }
}

impl<F: Float> PathLanes<'_, F> {
    /// Ends a turn in which samples have become `complete`: makes the connections of all vertices that wait, if one of
    /// them cannot wait any longer. Says which samples are complete with theirs.
    #[inline(always)]
    pub(super) fn connect_waiting(&mut self, complete: F::M, sampler: &impl RandomNumbers<F::U>) -> F::M {
        let arrived = self.waiting.arrived;
        // the lane's last vertex still waits
        let crowded = self.waiting.waiting.here & arrived.here;
        self.waiting.waiting.take(arrived.here & !crowded, &arrived);
        let waiting = self.waiting.waiting;
        let urgent = crowded | (waiting.here & complete);
        if urgent.any() || (self.is_guided() && waiting.here.any()) {
            self.connect(&waiting, sampler.unit4(waiting.dimension));
            self.waiting.waiting.here = F::M::splat(false);
            self.waiting.waiting.take(crowded, &arrived);
        }
        self.waiting.arrived.here = F::M::splat(false);
        self.waiting.lingering = complete & self.waiting.waiting.here;
        let complete = complete & !self.waiting.lingering;
        let (radiance, found) = (self.outcome.radiance, self.waiting.found);
        self.outcome.radiance = Vector::select(complete, radiance + found, radiance);
        self.waiting.found = Vector::select(complete, Vector::zero(), found);
        complete
    }
}
