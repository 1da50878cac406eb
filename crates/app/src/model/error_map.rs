//! Maps of errors: what they are of, and as they are drawn.

use crate::ruler::{HeatMap, Pair};
use compare::ErrorMetric;
use film::DisplayTransform;
use scene::Vec3;
use std::sync::Arc;

/// Two pictures of one size and what to draw of them.
#[derive(Debug, Clone)]
pub struct ErrorMapJob {
    /// What they are called.
    pub names: [&'static str; 2],
    /// Pixels in a row of both.
    pub width: u32,
    /// Linear radiances, rows from the top; the first is judged by the second.
    pub radiances: [Arc<[Vec3]>; 2],
    /// How FLIP sees them.
    pub display: DisplayTransform,
    /// What to map.
    pub map: ErrorMetric,
    /// Where the scale ends; `None` to fit it.
    pub held: Option<f32>,
}

/// A map that is drawn.
#[derive(Debug)]
pub struct ErrorMap {
    /// What it is of.
    pub map_job: ErrorMapJob,
    /// The numbers and their colours.
    pub map: HeatMap,
    /// Its bytes, four a pixel, without the bar.
    pub rgba: Vec<u8>,
}

impl ErrorMapJob {
    /// The two pictures.
    pub fn pair(&self) -> Pair<'_> {
        let [film, reference] = &self.radiances;
        Pair { names: self.names, width: self.width, radiances: [film, reference], display: self.display }
    }
}
