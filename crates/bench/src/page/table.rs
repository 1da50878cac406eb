//! A part's table: a row for each line at its last rung, and for each peer.

use crate::line::{USUAL, title};
use crate::plots::duration;
use crate::summary::{Curve, PartSummary, Point, slope_words};
use crate::variant::VARIANT_SPP;
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
    for curve in summary.curves.iter().filter(|curve| !curve.line.is_a_variant()) {
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

/// What lanes and specialisation save, as HTML: the same picture by other kernels.
pub fn of_variants(summary: &PartSummary) -> String {
    let usual = |curve: &Curve| curve.line.technique == USUAL && !curve.line.is_a_variant();
    let usual = summary.curves.iter().find(|curve| usual(curve));
    let usual = usual.and_then(|curve| curve.points.iter().find(|point| point.spp == VARIANT_SPP));
    let Some(usual) = usual else { return String::new() };
    let mut html = format!(
        "<h3>What lanes and specialisation save</h3>\n<table>\n<tr><th>{}, {VARIANT_SPP} spp</th><th>samples/s</th>\
         <th>time, times the usual</th></tr>\n",
        escaped(&title(&USUAL))
    );
    let mut row = |name: &str, point: &Point| {
        let cells = [
            format!("{:.2} M", point.samples_per_second / 1e6),
            format!("{:.2}", usual.samples_per_second / point.samples_per_second),
        ];
        html += &format!("<tr><td>{}</td>{}</tr>\n", escaped(name), cells.map(cell).concat());
    };
    row("the usual: widest lanes, what the scene lacks left out", usual);
    for curve in summary.curves.iter().filter(|curve| curve.line.is_a_variant()) {
        curve.last().into_iter().for_each(|point| row(curve.line.variant.name, point));
    }
    html + "</table>\n"
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
        if curve.line.converges() { format!("{:.2e}", point.efficiency) } else { String::new() },
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
