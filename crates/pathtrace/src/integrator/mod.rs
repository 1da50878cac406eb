//! Light transport: [`path`], the tutorial's Monte Carlo path tracer, and [`whitted`], the step before it.

mod forks;
pub mod path;
mod path_state;
mod roulette;
pub mod settings;
pub mod whitted;
