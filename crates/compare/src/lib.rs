//! The ruler: how far a film is from a reference, in linear radiance and never after the display transform, but for
//! FLIP, which asks what people see; per pixel as maps and in colour; and what is made of such numbers, fits and plots
//! of speed against error.

mod colour_map;
mod colour_scale;
mod error_metric;
mod fits;
pub mod flip;
mod histogram;
mod metrics;
mod noise;
mod pixel_rect;
mod plot;

pub use colour_map::{ColourMap, HATCH, WITHIN_NOISE, hatched};
pub use colour_scale::{ColourScale, Tick};
pub use error_metric::{ErrorMetric, finite_mean};
pub use fits::{ErrorSplit, Fit, efficiency, fit, split_error};
pub use histogram::Histogram;
pub use metrics::{
    CompareError, Errors, REL_MSE_FLOOR, errors, errors_within, is_visibly_noisy, mean_squared_standard_error,
};
pub use noise::{SIGNIFICANT, variance_by_parts, within_noise};
pub use pixel_rect::PixelRect;
pub use plot::{COLOURS, LogLogPlot, PlotPoint, Range, Series, Stroke, escaped, log_ticks, tick_text};
