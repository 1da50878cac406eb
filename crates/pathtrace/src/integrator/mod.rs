//! Light transport: [`path`], the tutorial's Monte Carlo path tracer, and [`whitted`], the step before it.

pub(crate) mod forks;
pub mod path;
pub(crate) mod path_state;
pub(crate) mod roulette;
pub mod settings;
pub mod whitted;
