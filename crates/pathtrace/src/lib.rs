//! The truth, and Whitted's step towards it: light transport by rays, on the CPU.
//!
//! A [`Tracer`] is a scene made ready for rays: its shapes in a BVH ([`geometry`]) and the list of what shines ([`light`]).
//! [`Tracer::render`] adds samples to a [`scene::Film`]; each sample is one walk of [`path`], one segment an iteration,
//! without recursion or allocation, so that the same loop can become SIMD lanes or GPU threads.
//! [`Tracer::render_whitted`] does the same for the trees of rays of [`whitted`].
//!
//! Random numbers are a pure function of (pixel, sample, dimension, seed), see [`sampler`]: a picture does not depend on
//! the number of threads.

pub mod bsdf;
pub mod geometry;
pub mod light;
pub mod path;
mod render;
mod replicates;
pub mod rng;
pub mod sampler;
pub mod sampling;
mod settings;
pub mod sobol;
pub mod whitted;
pub mod world;

pub use render::{Stats, Tracer};
pub use replicates::{FEWEST_REPLICATES, estimate_with_replicates};
pub use settings::{Directions, Estimator, LightSearch, PathSettings, Roulette, SamplerKind, SettingsError};
pub use whitted::{GlassShadows, WhittedSettings};
