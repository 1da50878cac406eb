//! The ladder: from the fake as taught to the truth, one repaired defect a rung, each with the error that is left and what it
//! costs. The last rungs are Whitted's trees and path tracing. What rungs are is told by `model::ladder`.

mod chart;
mod climb;
mod make;
mod save;
mod table;

pub use chart::chart;
pub use climb::Climber;
pub use make::{Made, Reached, RungMaker};
pub use save::save;
pub use table::{csv, json, numbered, text};

/// Samples per pixel of the last two rungs, unless something else is said.
pub const SPP: u32 = 64;
