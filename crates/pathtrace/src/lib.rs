//! The truth: light transport solved by Monte Carlo, on the CPU.
//!
//! A [`Tracer`] is a scene made ready for rays: triangles and spheres in a BVH ([`geometry`]) and the list of what shines
//! ([`light`]). [`Tracer::render`] adds samples to a [`scene::Film`]; each sample is one walk of [`path`], one segment an
//! iteration, without recursion or allocation, so that the same loop can become SIMD lanes or GPU threads.
//!
//! Random numbers are a pure function of (pixel, sample, dimension, seed), see [`rng`]: a picture does not depend on the
//! number of threads.

pub mod bsdf;
pub mod geometry;
pub mod light;
pub mod path;
mod render;
pub mod rng;
pub mod sampling;
mod settings;

pub use render::{Stats, Tracer};
pub use settings::{Estimator, PathSettings, Roulette};
