//! What drives an integrator over a film: [`lanes`] on the processor, [`gpu`] in dispatches.

pub mod gpu;
pub mod lanes;
