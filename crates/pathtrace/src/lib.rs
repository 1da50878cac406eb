//! The truth, and Whitted's step towards it: light transport by rays, on the CPU.
//!
//! A [`Tracer`] is a scene made ready for rays: its shapes ([`intersect`]), the list of what shines ([`light`]) and the
//! materials. [`Tracer::render`] adds samples to a [`film::Film`]. It is one loop over [`simd`]'s lane types: a lane
//! owns a pixel, and each turn of the loop in [`drive::lanes`] is one segment of the path in every lane, see
//! [`integrator::path`], without recursion or allocation; a lane whose path ended starts its next one at once. One lane
//! is a plain scalar tracer, 16 are AVX-512, and all give the same picture bit for bit. An [`Integrator`] says what is
//! followed: these paths, or the trees of rays of [`integrator::whitted`].
//!
//! Random numbers are a pure function of (pixel, sample, dimension, seed), see [`sampling::sampler`]: a picture does
//! not depend on the number of threads either.

pub mod bsdf;
pub mod caster;
pub mod drive;
pub mod features;
mod gpu_tracer;
pub mod integrator;
pub mod intersect;
pub mod light;
mod objects;
pub mod prepared;
mod probe;
mod replicates;
pub mod sampling;
pub mod shaders;
mod stats;
mod tracer;
pub mod twins;
mod vectors;

pub use caster::cone::shapes_with_cones;
pub use features::{FeatureFilm, FeaturePass};
pub use integrator::Integrator;
pub use integrator::broken::{Bug, Bugs, Row as BugRow};
pub use integrator::first_vertex::{FirstVertex, LeftOut, Met, Term, Terms};
pub use integrator::light_paths::{LightPaths, LightPathsError, Named as NamedLightPaths};
pub use integrator::metropolis::MetropolisSettings;
pub use integrator::normals::{NormalsSettings, Space};
pub use integrator::photon::{
    DirectLight, LightTracingSettings, MOST_PHOTONS, PhotonSettings, USUAL_PHOTONS, sees_little, usual_radius,
};
pub use integrator::settings::{ConesAt, Directions, Estimator, LightSampling, PathSettings, Roulette, SettingsError};
pub use integrator::whitted::{GlassShadows, WhittedSettings};
pub use objects::{MOST_ALONG, MetShape, NO_SHAPE};
pub use probe::ProbedPixel;
pub use replicates::{FEWEST_REPLICATES, estimate_with_replicates};
pub use sampling::sampler::SamplerKind;
pub use simd::Lanes;
pub use stats::{ChainStats, Stats};
pub use tracer::Tracer;

/// Tracing on a graphics device.
pub mod gpu {
    pub use crate::drive::gpu::*;
    pub use crate::gpu_tracer::GpuTracer;
}
