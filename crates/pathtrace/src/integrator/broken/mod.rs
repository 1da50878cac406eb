//! Bugs that students make in their path tracers, each a switch. A bug is a row of [`ROWS`]; what it does stands in
//! `wrong.rs`, and `walk.rs` is the plain path tracer that it is made in. Without a bug nothing of this runs: pictures are
//! then traced by [`super::path`], which knows nothing of it.

mod bug;
mod hidden;
mod rows;
pub(crate) mod walk;
pub(crate) mod wrong;

pub(crate) use bug::shader_numbers;
pub use bug::{Bug, Bugs};
pub use rows::{ROWS, Row};
