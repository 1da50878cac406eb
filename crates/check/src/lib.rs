//! Hard cases: scenes, formulas and samplers whose right answer is known in closed form, run against every technique
//! and estimator that can resolve them.
//!
//! [`CASES`] lists them with their claims; a [`Runner`] runs some of them, on the processor or on a graphics device, and hands
//! out [`Row`]s: what was expected, what was measured, how far apart they may be, and the verdict. [`Case::view`] is a scene
//! that shows what a case is about. A Monte Carlo row passes if its mean over 32 independently seeded pictures
//! lies within four standard errors of the expected value *and* that standard error is small enough to notice a fault;
//! both are in the row.
//!
//! The processor needs neither a GPU nor a window. A device runs what it renders.

mod area_lights;
mod case;
mod caustics;
mod dielectrics;
mod energy;
mod estimators;
mod fake;
mod hard;
mod leaks;
mod measure;
mod meshes;
mod offsets;
mod on_gpu;
mod robustness;
mod row;
mod runner;
mod samplers;
mod sums;
mod surfaces;
mod view;
mod warps;

pub use case::{CASES, Case};
pub use measure::Trial;
pub use on_gpu::DeviceFault;
pub use row::{Relation, Row, Verdict};
pub use runner::{Effort, Machine, Runner};
pub use view::{CaseView, Mark};
