//! The ruler: how far a film is from a reference, in linear radiance and never after the display transform; and what is
//! made of such numbers, a table and a plot of speed against error.

mod metrics;
mod plot;
mod table;

pub use metrics::{CompareError, Errors, errors, errors_of_radiances};
pub use plot::{LogLogPlot, Series};
pub use table::{BenchRow, csv};
