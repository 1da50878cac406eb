//! A log-log plot as an SVG text: error against cost, one line a technique, straight where error falls as a power. Made
//! to be read from the back of a lecture hall: large type, lines named beside their ends, error bars.

mod axis;
mod labels;

pub use axis::{log_ticks, number as tick_text};

use axis::Axis;
use std::fmt::Write;

/// Lines over logarithmic axes.
#[derive(Debug, Clone)]
pub struct LogLogPlot<'a> {
    /// Above the plot.
    pub title: &'a str,
    /// Under the horizontal axis, with its unit.
    pub x_label: &'a str,
    /// Beside the vertical axis, with its unit.
    pub y_label: &'a str,
    /// Marks of the horizontal axis; none for round numbers.
    pub x_ticks: Vec<f64>,
    /// The lines.
    pub series: Vec<Series>,
}

/// One line of a plot.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name at the line's end.
    pub name: String,
    /// In the order in which they are joined.
    pub points: Vec<PlotPoint>,
    /// Number of its colour, any: there are [`COLOURS`].
    pub colour: usize,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// Points joined by a solid line.
    Solid,
    /// Points joined by a dashed line.
    Dashed,
    /// A level that holds at any cost, such as a method without noise: dotted across the plot at its last point's y.
    Level,
}

/// What was measured once or several times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Least of all.
    pub low: f64,
    /// The one in the middle.
    pub median: f64,
    /// Largest of all.
    pub high: f64,
}

/// A point of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlotPoint {
    /// Along the horizontal axis. Points whose median is not > 0 in x or y are left out; a level needs y alone.
    pub x: Range,
    /// Along the vertical axis.
    pub y: Range,
    /// Drawn hollow: it says less than it seems to.
    pub hollow: bool,
}

/// Okabe and Ito's colours that stand out from white, told apart by the colour-blind too, and a few more.
pub const COLOURS: [&str; 16] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#8a6d00", "#6b6b6b", "#7b3fa0", "#a00000", "#2f9fe0",
    "#6aa500", "#5d3a1a", "#e0218a", "#0e6f6f", "#5566cc", "#c08a2a",
];

const WIDTH: f64 = 1280.0;
const HEIGHT: f64 = 720.0;
const LEFT: f64 = 118.0;
const RIGHT: f64 = 490.0;
const TOP: f64 = 64.0;
const BOTTOM: f64 = 88.0;
const TYPE: f64 = 20.0;

impl Range {
    /// Of one value.
    pub fn exactly(value: f64) -> Self {
        Range { low: value, median: value, high: value }
    }

    /// Of several values; `None` of none. Of an even number, the median is the mean of the middle two.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let (low, high) = (*values.first()?, *values.last()?);
        let middle = values.len() / 2;
        let median = if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) };
        Some(Range { low, median, high })
    }

    /// With every value changed by a monotonic function.
    pub fn map(self, of: impl Fn(f64) -> f64) -> Self {
        Range { low: of(self.low), median: of(self.median), high: of(self.high) }
    }
}

fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

/// The plot's area in the picture.
struct Frame {
    x: Axis,
    y: Axis,
}

impl Frame {
    const RIGHT: f64 = WIDTH - RIGHT;
    const BOTTOM: f64 = HEIGHT - BOTTOM;

    fn x(&self, value: f64) -> f64 {
        LEFT + (Self::RIGHT - LEFT) * self.x.at(value)
    }

    fn y(&self, value: f64) -> f64 {
        Self::BOTTOM - (Self::BOTTOM - TOP) * self.y.at(value)
    }
}

impl LogLogPlot<'_> {
    /// The plot as a whole SVG document, on white.
    pub fn svg(&self) -> String {
        let series: Vec<(&Series, Vec<PlotPoint>)> = self.series.iter().map(|s| (s, s.drawable())).collect();
        let ranges = |of: fn(&PlotPoint) -> Range| series.iter().flat_map(|(_, points)| points).map(of);
        let frame = Frame { x: Axis::around(ranges(|p| p.x)), y: Axis::around(ranges(|p| p.y)) };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
             font-family=\"sans-serif\" font-size=\"{TYPE}\" fill=\"#1a1a1a\">\n<title>{}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
            escaped(self.title)
        );
        self.axes(&mut svg, &frame);
        // levels lie under what moves
        let levels = |level: bool| series.iter().filter(move |(s, _)| (s.stroke == Stroke::Level) == level);
        for (series, points) in levels(true).chain(levels(false)) {
            curve(&mut svg, &frame, series, points);
        }
        let named = series.iter().filter_map(|(s, points)| Some((*s, frame.y(points.last()?.y.median))));
        labels::draw(&mut svg, named.collect());
        svg + "</svg>\n"
    }

    fn axes(&self, svg: &mut String, frame: &Frame) {
        let (right, bottom) = (Frame::RIGHT, Frame::BOTTOM);
        text(svg, (LEFT, TOP - 26.0), "start", "font-size=\"26\" font-weight=\"bold\"", self.title);
        let x_ticks = if self.x_ticks.is_empty() { frame.x.ticks() } else { self.x_ticks.clone() };
        for tick in x_ticks.into_iter().filter(|tick| frame.x.holds(*tick)) {
            let at = frame.x(tick);
            line(svg, (at, TOP), (at, bottom), "#d8d8d8", "");
            text(svg, (at, bottom + 28.0), "middle", "", &axis::number(tick));
        }
        for tick in frame.y.ticks() {
            let at = frame.y(tick);
            line(svg, (LEFT, at), (right, at), "#d8d8d8", "");
            text(svg, (LEFT - 10.0, at + 7.0), "end", "", &axis::number(tick));
        }
        line(svg, (LEFT, bottom), (right, bottom), "#1a1a1a", "");
        line(svg, (LEFT, TOP), (LEFT, bottom), "#1a1a1a", "");
        text(svg, (0.5 * (LEFT + right), HEIGHT - 20.0), "middle", "", self.x_label);
        let turned = format!("transform=\"translate(30 {}) rotate(-90)\"", 0.5 * (TOP + bottom));
        text(svg, (0.0, 0.0), "middle", &turned, self.y_label);
    }
}

fn curve(svg: &mut String, frame: &Frame, series: &Series, points: &[PlotPoint]) {
    let Some(last) = points.last() else { return };
    let colour = series.colour();
    if series.stroke == Stroke::Level {
        let y = frame.y(last.y.median);
        line(svg, (LEFT, y), (Frame::RIGHT, y), colour, series.stroke.style());
    } else {
        let path: Vec<_> =
            points.iter().map(|p| format!("{:.1},{:.1}", frame.x(p.x.median), frame.y(p.y.median))).collect();
        let (path, style) = (path.join(" "), series.stroke.style());
        let _ = writeln!(svg, "<polyline points=\"{path}\" fill=\"none\" stroke=\"{colour}\" {style}/>");
    }
    for point in points.iter().filter(|point| positive(point.x.median)) {
        let (x, y) = (point.x.map(|v| frame.x(frame.x.clamped(v))), point.y.map(|v| frame.y(frame.y.clamped(v))));
        // a bar within the mark's own size would not be seen
        if (x.high - x.low).abs() > 10.0 {
            line(svg, (x.low, y.median), (x.high, y.median), colour, "stroke-width=\"2\"");
        }
        if (y.high - y.low).abs() > 10.0 {
            line(svg, (x.median, y.low), (x.median, y.high), colour, "stroke-width=\"2\"");
        }
        let fill = if point.hollow { "white" } else { colour };
        mark(svg, series.stroke, (x.median, y.median), colour, fill);
    }
}

/// A circle on a solid line, a square on a dashed one, a diamond on a level.
fn mark(svg: &mut String, stroke: Stroke, (x, y): (f64, f64), colour: &str, fill: &str) {
    let style = format!("fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"2.5\"");
    let _ = match stroke {
        Stroke::Solid => writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" {style}/>"),
        Stroke::Dashed => {
            let corner = (x - 4.5, y - 4.5);
            writeln!(svg, "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"9\" height=\"9\" {style}/>", corner.0, corner.1)
        }
        Stroke::Level => writeln!(svg, "<path d=\"M{x:.1} {:.1}l7 7l-7 7l-7 -7z\" {style}/>", y - 7.0),
    };
}

impl Series {
    fn drawable(&self) -> Vec<PlotPoint> {
        let holds = |p: &&PlotPoint| positive(p.y.median) && (positive(p.x.median) || self.stroke == Stroke::Level);
        self.points.iter().filter(holds).copied().collect()
    }

    fn colour(&self) -> &'static str {
        COLOURS[self.colour % COLOURS.len()]
    }
}

impl Stroke {
    fn style(self) -> &'static str {
        match self {
            Stroke::Solid => "stroke-width=\"3\"",
            Stroke::Dashed => "stroke-width=\"2.5\" stroke-dasharray=\"11 6\"",
            Stroke::Level => "stroke-width=\"2.5\" stroke-dasharray=\"3 6\"",
        }
    }
}

fn line(svg: &mut String, from: (f64, f64), to: (f64, f64), colour: &str, style: &str) {
    let _ = writeln!(
        svg,
        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{colour}\" {style}/>",
        from.0, from.1, to.0, to.1
    );
}

fn text(svg: &mut String, at: (f64, f64), anchor: &str, style: &str, content: &str) {
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" {style}>{}</text>",
        at.0,
        at.1,
        escaped(content)
    );
}

/// Text as XML and HTML keep it, in attributes too; control characters, which XML cannot hold, become spaces.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            c if c.is_control() => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(series: Vec<Series>) -> String {
        LogLogPlot { title: "t", x_label: "x", y_label: "y", x_ticks: Vec::new(), series }.svg()
    }

    fn series(name: &str, points: &[(f64, f64)], stroke: Stroke) -> Series {
        let point = |&(x, y): &(f64, f64)| PlotPoint { x: Range::exactly(x), y: Range::exactly(y), hollow: false };
        Series { name: name.into(), points: points.iter().map(point).collect(), colour: 0, stroke }
    }

    fn numbers(svg: &str, attribute: &str) -> Vec<f64> {
        let values = svg.split(attribute).skip(1).map(|rest| rest.split('"').next().unwrap());
        values.map(|value| value.parse().unwrap()).collect()
    }

    #[test]
    fn a_power_law_is_a_straight_line_and_bad_points_are_left_out() {
        let law = [(1.0, 1.0), (10.0, 0.1), (0.0, 1.0), (100.0, 0.01), (5.0, f64::NAN)];
        let svg = plot(vec![series("a<b", &law, Stroke::Solid)]);
        let (x, y) = (numbers(&svg, "cx=\""), numbers(&svg, "cy=\""));
        // the fourth is beside the name
        assert_eq!(x.len(), 4);
        assert!((x[1] - 0.5 * (x[0] + x[2])).abs() < 0.2 && (y[1] - 0.5 * (y[0] + y[2])).abs() < 0.2);
        assert!(svg.contains("a&lt;b") && !svg.contains("NaN"));
    }

    #[test]
    fn hollow_points_are_white_and_ranges_are_bars() {
        let mut one = series("one", &[(1.0, 1.0), (10.0, 0.1)], Stroke::Solid);
        let plain = plot(vec![one.clone()]).matches("stroke-width=\"2\"/>").count();
        one.points[0].hollow = true;
        one.points[1].y = Range { low: 0.05, median: 0.1, high: 0.2 };
        let svg = plot(vec![one]);
        assert_eq!(svg.matches("<circle").count() - svg.matches("r=\"5\" fill=\"#0072b2\"").count(), 1);
        assert_eq!(svg.matches("stroke-width=\"2\"/>").count(), plain + 1);
    }

    #[test]
    fn a_plot_of_nothing_is_a_plot() {
        assert!(plot(Vec::new()).ends_with("</svg>\n"));
        assert!(!plot(vec![series("none", &[(1.0, f64::NAN)], Stroke::Level)]).contains("NaN"));
    }

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(Range::of([3.0, 1.0, 2.0]), Some(Range { low: 1.0, median: 2.0, high: 3.0 }));
        assert_eq!(Range::of([4.0, 1.0]).map(|r| r.median), Some(2.5));
        assert_eq!(Range::of([]), None);
    }

    #[test]
    fn what_comes_from_outside_cannot_leave_its_place() {
        assert_eq!(escaped("<a href='x' b=\"y\">&\u{7}\n"), "&lt;a href=&#39;x&#39; b=&quot;y&quot;&gt;&amp;  ");
    }
}
