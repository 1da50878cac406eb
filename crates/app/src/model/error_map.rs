//! Maps of errors: what they are of, and as they are drawn.

use super::Region;
use crate::ruler::{HeatMap, Pair};
use compare::ErrorMetric;

/// Two pictures of one size and what to draw of them.
#[derive(Debug, Clone)]
pub struct ErrorMapJob {
    /// The pictures; the first is judged by the second.
    pub pair: Pair,
    /// The metric that the map shows at each pixel.
    pub map: ErrorMetric,
    /// Where the scale ends; `None` to fit it.
    pub held: Option<f32>,
    /// The part whose mean is told; `None` for all.
    pub region: Option<Region>,
}

/// A map that is drawn.
#[derive(Debug)]
pub struct ErrorMap {
    /// What it is of.
    pub map_job: ErrorMapJob,
    /// The numbers and their colours.
    pub map: HeatMap,
    /// Mean of its finite numbers in the region, or in all of it.
    pub mean: f64,
    /// How many are not finite there.
    pub nonfinite: u64,
    /// Its bytes, four a pixel, without the bar.
    pub rgba: Vec<u8>,
}
