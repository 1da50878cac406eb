//! A part's table: a row for each line at its last rung, and for each peer.

use crate::plots::duration;
use crate::summary::{Curve, PartSummary, Point, slope_words};
use compare::{Range, escaped};

/// Columns, with units.
const COLUMNS: [&str; 11] = [
    "technique",
    "spp",
    "time",
    "RMSE, radiance",
    "relMSE",
    "FLIP",
    "slope of RMSE",
    "efficiency, 1 / (radiance² s)",
    "samples/s, rays/s",
    "relative bias",
    "not finite",
];

/// The table as HTML.
pub fn of(summary: &PartSummary) -> String {
    let mut html = String::from("<div class=\"wide\"><table>\n<tr>");
    COLUMNS.iter().for_each(|column| html += &format!("<th>{column}</th>"));
    html += "</tr>\n";
    for curve in &summary.curves {
        if let Some(point) = curve.last() {
            html += &row(curve, point);
        }
    }
    for peer in &summary.peers {
        if let Some(last) = peer.rows.last() {
            let cells = [last.spp.to_string(), duration(last.seconds), String::new(), format!("{:.2e}", last.rel_mse)];
            let rest = COLUMNS.len() - 1 - cells.len();
            html += &format!(
                "<tr><td>{} (peer)</td>{}<td colspan=\"{rest}\"></td></tr>\n",
                escaped(&peer.name),
                cells.map(cell).concat()
            );
        }
    }
    html + "</table></div>\n"
}

fn row(curve: &Curve, point: &Point) -> String {
    let speed = |per_second: f64| format!("{:.2} M", per_second / 1e6);
    let speeds = || format!("{}<small>{}</small>", speed(point.samples_per_second), speed(point.rays_per_second));
    let cut = if point.cut_paths > 0 { format!("<small>{} cut short</small>", point.cut_paths) } else { String::new() };
    let cells = [
        if point.spp == 0 { String::new() } else { point.spp.to_string() },
        with_range(point.seconds, duration),
        with_range(point.rmse, |v| format!("{v:.2e}")),
        with_range(point.rel_mse, |v| format!("{v:.2e}")),
        format!("{:.3}", point.flip.median),
        curve.slope.map(|fit| slope_words(&fit)).unwrap_or_default(),
        if curve.line.way.converges() { format!("{:.2e}", point.efficiency) } else { String::new() },
        if point.samples_per_second > 0.0 { speeds() } else { String::new() },
        escaped(&point.bias_words()),
        format!("{}{cut}", point.nonfinite),
    ];
    let class = if point.below_reference_noise { " class=\"below\"" } else { "" };
    format!("<tr{class}><td>{}</td>{}</tr>\n", escaped(&curve.line.title()), cells.map(cell).concat())
}

fn cell(content: String) -> String {
    format!("<td class=\"n\">{content}</td>")
}

fn with_range(range: Range, words: impl Fn(f64) -> String) -> String {
    if range.low == range.high {
        return words(range.median);
    }
    format!("{}<small>({}–{})</small>", words(range.median), words(range.low), words(range.high))
}
