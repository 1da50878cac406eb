//! A log-log plot as an SVG text: error against cost, one line a technique, straight where error falls as a power.

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
    /// The lines.
    pub series: Vec<Series>,
}

/// One line of a plot.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name at the line's end.
    pub name: String,
    /// Points (x, y), both > 0; others are left out.
    pub points: Vec<(f64, f64)>,
    /// A level that holds at any cost, such as a method without noise: drawn dashed across the plot at its y.
    pub level: bool,
}

const WIDTH: f64 = 790.0;
const HEIGHT: f64 = 480.0;
const LEFT: f64 = 80.0;
const RIGHT: f64 = 210.0;
const TOP: f64 = 50.0;
const BOTTOM: f64 = 60.0;
/// Okabe and Ito's colours, told apart by the colour-blind too.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#000000"];

/// A range of whole decades.
struct Axis {
    low: i32,
    high: i32,
}

impl Axis {
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values {
            (low, high) = (low.min(value.log10()), high.max(value.log10()));
        }
        if low > high {
            return Axis { low: 0, high: 1 };
        }
        let low = low.floor() as i32;
        Axis { low, high: (high.ceil() as i32).max(low + 1) }
    }

    fn at(&self, value: f64) -> f64 {
        (value.log10() - f64::from(self.low)) / f64::from(self.high - self.low)
    }
}

impl LogLogPlot<'_> {
    /// The plot as a whole SVG document, on white.
    pub fn svg(&self) -> String {
        let drawn = |s: &Series| s.points.iter().copied().filter(|(x, y)| *x > 0.0 && *y > 0.0).collect::<Vec<_>>();
        let series: Vec<_> = self.series.iter().map(|s| (s, drawn(s))).collect();
        let x_axis = Axis::around(series.iter().flat_map(|(_, p)| p).map(|p| p.0));
        let y_axis = Axis::around(series.iter().flat_map(|(_, p)| p).map(|p| p.1));
        let x = |value: f64| LEFT + (WIDTH - LEFT - RIGHT) * x_axis.at(value);
        let y = |value: f64| HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * y_axis.at(value);

        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
             font-family=\"sans-serif\" font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        text(&mut svg, (LEFT, TOP - 22.0), "start", "18", self.title);
        for decade in x_axis.low..=x_axis.high {
            let at = x(10f64.powi(decade));
            line(&mut svg, (at, TOP), (at, bottom), "#dddddd", "");
            text(&mut svg, (at, bottom + 20.0), "middle", "14", &power_of_ten(decade));
        }
        for decade in y_axis.low..=y_axis.high {
            let at = y(10f64.powi(decade));
            line(&mut svg, (LEFT, at), (right, at), "#dddddd", "");
            text(&mut svg, (LEFT - 8.0, at + 5.0), "end", "14", &power_of_ten(decade));
        }
        text(&mut svg, (0.5 * (LEFT + right), HEIGHT - 16.0), "middle", "14", self.x_label);
        let _ = writeln!(
            svg,
            "<text transform=\"translate(22 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            0.5 * (TOP + bottom),
            escaped(self.y_label)
        );
        let mut labels: Vec<(f64, &str, &str)> = Vec::new();
        for ((series, points), colour) in series.iter().zip(COLOURS.iter().cycle()) {
            let Some(&last) = points.last() else { continue };
            if series.level {
                line(
                    &mut svg,
                    (LEFT, y(last.1)),
                    (right, y(last.1)),
                    colour,
                    "stroke-dasharray=\"7 5\" stroke-width=\"2\"",
                );
            } else {
                let path: Vec<_> = points.iter().map(|p| format!("{:.1},{:.1}", x(p.0), y(p.1))).collect();
                let _ = writeln!(
                    svg,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
                    path.join(" ")
                );
                for p in points {
                    let _ = writeln!(
                        svg,
                        "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3.5\" fill=\"{colour}\"/>",
                        x(p.0),
                        y(p.1)
                    );
                }
            }
            labels.push((y(last.1) + 5.0, &series.name, colour));
        }
        labels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut free = f64::NEG_INFINITY;
        for (wish, name, colour) in labels {
            let label = wish.max(free);
            free = label + 17.0;
            let _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{label:.1}\" fill=\"{colour}\">{}</text>",
                right + 10.0,
                escaped(name)
            );
        }
        svg + "</svg>\n"
    }
}

fn power_of_ten(exponent: i32) -> String {
    match exponent {
        -3..=4 => format!("{}", 10f64.powi(exponent)),
        _ => format!("1e{exponent}"),
    }
}

fn line(svg: &mut String, from: (f64, f64), to: (f64, f64), colour: &str, style: &str) {
    let _ = writeln!(
        svg,
        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{colour}\" {style}/>",
        from.0, from.1, to.0, to.1
    );
}

fn text(svg: &mut String, at: (f64, f64), anchor: &str, size: &str, content: &str) {
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" font-size=\"{size}\">{}</text>",
        at.0,
        at.1,
        escaped(content)
    );
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_a_straight_line_and_bad_points_are_left_out() {
        let points = vec![(1.0, 1.0), (10.0, 0.1), (0.0, 1.0), (100.0, 0.01), (5.0, f64::NAN)];
        let series = vec![Series { name: "a<b".into(), points, level: false }];
        let svg = LogLogPlot { title: "t", x_label: "x", y_label: "y", series }.svg();
        let line = svg.split("polyline points=\"").nth(1).unwrap().split('"').next().unwrap();
        let p: Vec<(f64, f64)> = line
            .split(' ')
            .map(|p| p.split_once(',').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap())).unwrap())
            .collect();
        assert_eq!(p.len(), 3);
        assert!((p[1].0 - 0.5 * (p[0].0 + p[2].0)).abs() < 0.2 && (p[1].1 - 0.5 * (p[0].1 + p[2].1)).abs() < 0.2);
        assert!(svg.contains("a&lt;b") && !svg.contains("NaN"));
    }
}
