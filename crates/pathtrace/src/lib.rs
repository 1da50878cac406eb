//! The truth, and Whitted's step towards it: light transport by rays, on the CPU.
//!
//! A [`Tracer`] is a scene made ready for rays: its shapes ([`geometry`]), the list of what shines ([`light`]) and the
//! materials. [`Tracer::render`] adds samples to a [`scene::Film`]. It is one loop over [`simd`]'s lane types: a lane owns a
//! pixel, and each turn of the loop in [`crew`] is one segment of the path in every lane, see [`path`], without recursion
//! or allocation; a lane whose path ended starts its next one at once. One lane is a plain scalar tracer, 16 are AVX-512,
//! and all give the same picture bit for bit. [`Tracer::render_whitted`] does the same for the trees of rays of
//! [`whitted`].
//!
//! Random numbers are a pure function of (pixel, sample, dimension, seed), see [`sampler`]: a picture does not depend on
//! the number of threads either.

pub mod bsdf;
pub mod crew;
mod forks;
pub mod geometry;
pub mod gpu;
pub mod light;
mod materials;
pub mod path;
mod path_state;
mod render;
mod replicates;
pub mod rng;
mod roulette;
pub mod sampler;
pub mod sampling;
mod settings;
pub mod sobol;
mod vectors;
pub mod warp;
pub mod whitted;
pub mod world;

pub use render::{Stats, Tracer};
pub use replicates::{FEWEST_REPLICATES, estimate_with_replicates};
pub use settings::{Directions, Estimator, LightSearch, PathSettings, Roulette, SamplerKind, SettingsError};
pub use simd::Lanes;
pub use whitted::{GlassShadows, WhittedSettings};
