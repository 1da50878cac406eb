//! The plots of a part: error against samples, error against seconds, and the tutorial's "Biased vs. Unbiased".

use crate::line::{self, Line};
use crate::plan::Part;
use crate::summary::{Curve, PartSummary, Point, slope_words};
use compare::{LogLogPlot, PlotPoint, Range, Series, Stroke};
use pathtrace::{Estimator, Integrator, SamplerKind};
use raster::Fake;
use technique::{Denoiser, FakeSettings, Technique};

/// A plot with its name and what to see in it.
pub struct Plot {
    /// Of its file, without extension.
    pub name: String,
    /// The SVG document.
    pub svg: String,
    /// Under it, for people.
    pub caption: String,
}

/// All plots of a part.
pub fn of(summary: &PartSummary) -> Vec<Plot> {
    let mut plots = vec![against_samples(summary), against_seconds(summary)];
    if summary.part.teaches_bias() {
        plots.push(lesson(summary));
    }
    plots
}

/// Whether a line stands in the plots against samples and time.
fn drawn(curve: &&Curve) -> bool {
    !curve.line.is_of_the_lesson() && !curve.line.is_a_variant()
}

fn against_samples(summary: &PartSummary) -> Plot {
    let part = &summary.part;
    let curves = summary.curves.iter().filter(drawn);
    let series = curves.map(|curve| series(curve, with_slope(curve), |p| (f64::from(p.spp), p.rmse))).collect();
    let plot = LogLogPlot {
        title: &format!("{}: error against samples", heading(part)),
        x_label: "samples per pixel",
        y_label: "RMSE, radiance",
        x_ticks: ticks(part),
        series,
    };
    Plot {
        name: format!("{}-samples", part.name),
        svg: plot.svg(),
        caption: format!(
            "Beside each name the slope of its line: errors of independent numbers fall like samples to the power of \u{2212}0.50, those of Sobol points faster. \
             {MARKS} Dotted: techniques without noise to lose, level at any number of samples."
        ),
    }
}

fn against_seconds(summary: &PartSummary) -> Plot {
    let part = &summary.part;
    let curves = summary.curves.iter().filter(drawn);
    let mut lines: Vec<Series> = curves
        .map(|curve| {
            let time = if curve.line.converges() {
                String::new()
            } else {
                curve.last().map(|p| format!(", {}", duration(p.seconds.median))).unwrap_or_default()
            };
            let mut series = series(curve, curve.line.title() + &time, |p| (0.0, p.rel_mse));
            for (drawn, point) in series.points.iter_mut().zip(&curve.points) {
                drawn.x = point.seconds;
            }
            series
        })
        .collect();
    lines.extend(summary.peers.iter().enumerate().map(|(i, peer)| {
        Series {
            name: peer.name.clone(),
            points: peer
                .rows
                .iter()
                .map(|row| PlotPoint { x: Range::exactly(row.seconds), y: Range::exactly(row.rel_mse), hollow: false })
                .collect(),
            colour: FIRST_FREE_COLOUR + i,
            stroke: Stroke::Solid,
        }
    }));
    let plot = LogLogPlot {
        title: &format!("{}: error against time", heading(part)),
        x_label: "seconds",
        y_label: "relMSE",
        x_ticks: Vec::new(),
        series: lines,
    };
    Plot {
        name: format!("{}-seconds", part.name),
        svg: plot.svg(),
        caption: format!(
            "Lower and further left is better. relMSE: mean of (a \u{2212} r)\u{b2} / (r\u{b2} + 0.01). {MARKS} Diamonds: what \
             costs this much and stays as wrong as it is."
        ),
    }
}

fn lesson(summary: &PartSummary) -> Plot {
    let part = &summary.part;
    let independent = line::path(Estimator::LIGHT, SamplerKind::Independent);
    let taught = |curve: &&Curve| {
        !curve.line.is_a_variant() && (curve.line.is_of_the_lesson() || curve.line.technique == independent)
    };
    let named = |curve: &Curve| {
        let name = if curve.line.technique == independent { "roulette, throughput".into() } else { curve.line.title() };
        let end = match curve.line.is_bounded() {
            true => curve.last_slope.map(|s| format!(", ends {s:.2}").replace('-', "\u{2212}")),
            false => curve.relative_slope.map(|fit| format!(", {}", slope_words(&fit))),
        };
        name + &end.unwrap_or_default()
    };
    let mut lines = Vec::new();
    for (i, curve) in summary.curves.iter().filter(taught).enumerate() {
        let mut line = series(curve, named(curve), |p| (f64::from(p.spp), p.rel_mse.map(f64::sqrt)));
        line.stroke = if curve.line.is_bounded() { Stroke::Dashed } else { Stroke::Solid };
        line.colour = i;
        lines.push(line);
    }
    let plot = LogLogPlot {
        title: &format!("{}: biased against unbiased", heading(part)),
        x_label: "samples per pixel (light sampled, independent numbers)",
        y_label: "relative RMSE (root of the relMSE)",
        x_ticks: ticks(part),
        series: lines,
    };
    Plot {
        name: format!("{}-bias", part.name),
        svg: plot.svg(),
        caption: format!(
            "Beside each name its slope, or for the biased that between the last two points. Dashed: paths of so many bounces at most lose the light of longer ones; once their noise is gone, their bias \
             stays. Solid: Russian roulette ends paths by chance and loses nothing on average. {MARKS}"
        ),
    }
}

const MARKS: &str =
    "Marks are medians over seeds, bars their range; hollow marks are within the reference's own noise.";

fn heading(part: &Part) -> String {
    format!("{}, {} \u{d7} {}", part.title(), part.width, part.height)
}

fn ticks(part: &Part) -> Vec<f64> {
    part.ladder().into_iter().map(f64::from).collect()
}

fn with_slope(curve: &Curve) -> String {
    let slope = curve.slope.map(|fit| format!("  {}", slope_words(&fit)));
    curve.line.title() + &slope.unwrap_or_default()
}

/// A curve as a line of a plot: colour by technique and estimator, stroke by sampler.
fn series(curve: &Curve, name: String, of: impl Fn(&Point) -> (f64, Range)) -> Series {
    let (colour, stroke) = (colour(&curve.line.technique), stroke(&curve.line));
    let mut points: Vec<PlotPoint> = Vec::new();
    for point in &curve.points {
        let (x, y) = of(point);
        points.push(PlotPoint { x: Range::exactly(x), y, hollow: point.below_reference_noise });
    }
    Series { name, points, colour, stroke }
}

/// Colours that [`colour`] does not use begin here: for peers.
const FIRST_FREE_COLOUR: usize = 14;

fn colour(technique: &Technique) -> usize {
    match technique.denoise().denoiser {
        Denoiser::Off => {}
        Denoiser::Unet | Denoiser::UnetBase => return 12,
        Denoiser::ATrous => return 13,
    }
    let integrator = match technique {
        Technique::Traced(traced) => traced.integrator,
        Technique::Fake(FakeSettings { fake: Fake::Fair, .. }) => return 4,
        Technique::Fake(_) => return 6,
    };
    match integrator {
        Integrator::Path(_) if *technique == line::unconnected() => 11,
        Integrator::Path(path) => match Estimator::ALL.iter().position(|e| *e == path.estimator) {
            Some(place @ ..4) => place,
            // after those of other techniques
            Some(_) => 7,
            None => 0,
        },
        Integrator::Metropolis(_) => 8,
        Integrator::Photon(_) => 9,
        Integrator::LightTracing(_) => 10,
        Integrator::Whitted(_) | Integrator::Normals(_) => 5,
    }
}

fn stroke(line: &Line) -> Stroke {
    match line.sampler() {
        _ if !line.converges() => Stroke::Level,
        sampler if sampler == SamplerKind::Sobol.name() => Stroke::Solid,
        _ => Stroke::Dashed,
    }
}

/// A time for people: "4.2 ms", "1.3 s".
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.0} µs", s * 1e6),
        s if s < 0.01 => format!("{:.1} ms", s * 1e3),
        s if s < 1.0 => format!("{:.0} ms", s * 1e3),
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 600.0 => format!("{s:.0} s"),
        s => format!("{:.0} min", s / 60.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::full_parts;

    #[test]
    fn lines_of_a_plot_are_told_apart_by_colour_or_stroke() {
        for (part, lines) in full_parts() {
            let plotted = lines.iter().filter(|line| !line.is_of_the_lesson() && !line.is_a_variant());
            let look = |line: &Line| (colour(&line.technique), format!("{:?}", stroke(line)));
            let mut looks: Vec<_> = plotted.map(look).collect();
            assert!(looks.iter().all(|(colour, _)| *colour < FIRST_FREE_COLOUR), "{}: {looks:?}", part.name);
            let count = looks.len();
            looks.sort();
            looks.dedup();
            assert_eq!(looks.len(), count, "{}: {looks:?}", part.name);
        }
    }
}
