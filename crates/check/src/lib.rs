//! Hard cases: scenes, formulas and samplers whose right answer is known in closed form, run against every technique
//! and estimator that can resolve them.
//!
//! [`CASES`] lists them; [`run`] runs some of them and hands out [`Row`]s: what was expected, what was measured, how
//! far apart they may be, and the verdict. A Monte Carlo row passes if its mean over 32 independently seeded pictures
//! lies within four standard errors of the expected value *and* that standard error is small enough to notice a fault;
//! both are in the row.
//!
//! [`run`] needs neither a GPU nor a window. [`run_on_gpu`] runs what a graphics device renders.

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
mod samplers;
mod sums;
mod surfaces;
mod warps;

pub use case::{CASES, Case, run};
pub use measure::{Effort, Trial};
pub use on_gpu::{DeviceFault, run_on_gpu};
pub use row::{Relation, Row, Verdict};
