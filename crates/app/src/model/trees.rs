//! What a ray is tested against, with and without a tree: the settings of that workspace, what is to be traced for it, and
//! what is known of that.

use super::{LADDER, Model, TREES};
use pathtrace::intersect::counted::Structure;
use scene::{Camera, Vec3};

/// How the workspace is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TreesSettings {
    /// Of the statue: it has 8 x 4^level triangles.
    pub level: u32,
    /// What the pictures show.
    pub show: Counted,
    /// How many steps below the root the boxes lie that are drawn, if any are.
    pub boxes: Option<u32>,
    /// What is plotted over the number of triangles.
    pub plot: TreePlot,
}

impl TreesSettings {
    /// The finest statue: 33,554,432 triangles.
    pub const FINEST: u32 = 11;
}

impl Default for TreesSettings {
    fn default() -> Self {
        TreesSettings { level: 5, show: Counted::Boxes, boxes: None, plot: TreePlot::Seconds }
    }
}

/// What pictures of rays show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Counted {
    /// What the rays meet.
    Surface,
    /// How many boxes a ray is tested against.
    #[default]
    Boxes,
    /// How many triangles a ray is tested against.
    Triangles,
}

impl Counted {
    /// In the order of the choice.
    pub const ALL: [Counted; 3] = [Counted::Surface, Counted::Boxes, Counted::Triangles];

    /// As the choice and a session's file have it.
    pub fn name(self) -> &'static str {
        match self {
            Counted::Surface => "surface",
            Counted::Boxes => "boxes",
            Counted::Triangles => "triangles",
        }
    }
}

/// What is plotted over the number of triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TreePlot {
    /// Seconds that a million rays take.
    #[default]
    Seconds,
    /// Boxes and triangles that a ray is tested against.
    Tests,
}

impl TreePlot {
    /// In the order of the choice.
    pub const ALL: [TreePlot; 2] = [TreePlot::Seconds, TreePlot::Tests];

    /// As the choice and a session's file have it.
    pub fn name(self) -> &'static str {
        match self {
            TreePlot::Seconds => "time",
            TreePlot::Tests => "tests",
        }
    }

    /// What its axis says.
    pub fn label(self) -> &'static str {
        match self {
            TreePlot::Seconds => "s per million rays",
            TreePlot::Tests => "tests a ray",
        }
    }
}

/// What is to be traced for the workspace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WantedTrees {
    /// Of the statue, see [`TreesSettings::level`].
    pub level: u32,
    /// What pictures show, see [`TreesSettings::show`].
    pub show: Counted,
    /// Depth of the boxes that are drawn, see [`TreesSettings::boxes`].
    pub boxes: Option<u32>,
    /// Width and height of each picture in pixels.
    pub size: (u32, u32),
    /// How often the user began anew: what was measured before counts no more.
    pub restarts: u64,
}

/// What there is to show of one structure.
#[derive(Debug, Clone, PartialEq)]
pub struct TreeFacts {
    /// What it is of.
    pub structure: Structure,
    /// Why there is nothing of it: a line.
    pub fault: Option<String>,
    /// Seconds that it was built in; 0 for a list.
    pub build_seconds: f64,
    /// Bytes of its nodes for each triangle.
    pub bytes_a_triangle: f64,
    /// Steps to the deepest leaf.
    pub depth: u32,
    /// Rays of the picture, each through a pixel or a block of pixels.
    pub rays: u64,
    /// Seconds of all of them.
    pub seconds: f64,
    /// Seconds that the whole picture would take where blocks stand for pixels.
    pub whole_seconds: f64,
    /// Boxes that a ray was tested against, in the mean.
    pub boxes_a_ray: f64,
    /// Triangles that a ray was tested against, in the mean.
    pub triangles_a_ray: f64,
    /// Corners of the boxes that are to be drawn, and how many steps below the root they lie.
    pub boxes: (u32, Vec<(Vec3, Vec3)>),
}

/// A measurement for the plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TreePoint {
    /// The structure that rays went through.
    pub structure: Structure,
    /// Triangles of the statue.
    pub triangles: u64,
    /// Seconds for a million rays.
    pub seconds: f64,
    /// Boxes and triangles that a ray was tested against, in the mean.
    pub tests: f64,
}

impl TreePoint {
    /// What is plotted of it.
    pub fn value(&self, plot: TreePlot) -> f64 {
        match plot {
            TreePlot::Seconds => self.seconds,
            TreePlot::Tests => self.tests,
        }
    }
}

/// All that there is to show in the workspace.
#[derive(Debug, Clone, Default)]
pub struct TreesView {
    /// In the order of [`Structure::ALL`].
    pub facts: [Option<TreeFacts>; 3],
    /// The largest number that the colours stand for.
    pub most: f64,
    /// Measurements so far, coarse statues first.
    pub points: Vec<TreePoint>,
    /// What is being done, while something is.
    pub doing: Option<String>,
    /// Where the pictures are seen from.
    pub camera: Option<Camera>,
}

/// Triangles of the statue at a level.
pub fn statue_triangles(level: u32) -> u64 {
    8 << (2 * level.min(TreesSettings::FINEST))
}

/// A count with commas between thousands.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join(",")
}

/// Where a list's line goes on beyond what was measured: in proportion to the triangles, by the median of what one of them
/// took in the larger half of the measurements, up to the finest statue.
pub fn extrapolated(points: &[TreePoint], plot: TreePlot) -> Option<[(f64, f64); 2]> {
    let of_list: Vec<&TreePoint> = points.iter().filter(|point| point.structure == Structure::List).collect();
    let last = of_list.last()?;
    let mut rates: Vec<f64> = of_list[of_list.len() / 2..].iter().map(|p| p.value(plot) / p.triangles as f64).collect();
    rates.sort_by(f64::total_cmp);
    let (rate, measured) = (rates[rates.len() / 2], last.triangles as f64);
    let finest = statue_triangles(TreesSettings::FINEST) as f64;
    (measured < finest).then_some([(measured, rate * measured), (finest, rate * finest)])
}
impl Model {
    /// Left, top, right and bottom in points of what a picture as seen shows.
    pub fn seen_corners(&self) -> [f32; 4] {
        let several = self.session.is_in(TREES) || self.session.is_in(LADDER);
        if several { self.state.seen_corners } else { self.state.picture.corners }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_goes_on_in_proportion_to_the_triangles() {
        let point = |structure, triangles, seconds| TreePoint { structure, triangles, seconds, tests: 1.0 };
        // one that something else of the machine held up, and small ones that say little
        let list = [(8, 9.0), (32, 9.0), (128, 0.5), (512, 32.0), (2048, 8.0)];
        let mut points: Vec<_> = list.map(|(triangles, seconds)| point(Structure::List, triangles, seconds)).into();
        points.push(point(Structure::Eight, 8192, 0.1));
        let line = extrapolated(&points, TreePlot::Seconds);
        assert_eq!(line, Some([(2048.0, 8.0), (33_554_432.0, 8.0 * 16_384.0)]));
        points.clear();
        assert_eq!(extrapolated(&points, TreePlot::Seconds), None);
    }

    #[test]
    fn the_finest_statue_is_the_tutorials() {
        assert_eq!(statue_triangles(0), 8);
        assert_eq!(grouped(statue_triangles(TreesSettings::FINEST)), "33,554,432");
        assert_eq!(statue_triangles(TreesSettings::FINEST), 33_554_432);
    }
}
