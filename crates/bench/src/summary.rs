//! What measurements say together: a curve for each line, with medians and ranges over seeds, slopes, speed, what it is
//! worth per second, and whether it is biased.

use crate::line::Line;
use crate::measure::{Bias, Measurement, Picture, SIGMAS};
use crate::peer::PeerRow;
use crate::plan::Part;
use crate::references::Worth;
use compare::{Errors, Fit, Range, efficiency, fit};

/// All that is known about a part.
pub struct PartSummary {
    /// The part.
    pub part: Part,
    /// What it was measured by.
    pub worth: Worth,
    /// A curve for each line that was measured.
    pub curves: Vec<Curve>,
    /// What other programs' users have measured.
    pub peers: Vec<PeerCurve>,
}

/// One line over its ladder.
pub struct Curve {
    /// The line.
    pub line: Line,
    /// Ascending in samples; at least one.
    pub points: Vec<Point>,
    /// Of the RMSE against samples per pixel, noise of the reference taken away, over all seeds; `None` of levels, and
    /// where too little stands clear of the reference's noise.
    pub slope: Option<Fit>,
    /// The same of the root of the relMSE: less at the mercy of the few pixels at a bright area light's edge.
    pub relative_slope: Option<Fit>,
    /// That between the last two rungs, from medians: near 0 where only a bias is left.
    pub last_slope: Option<f64>,
}

/// One measurement, over its seeds.
#[derive(Debug, Clone)]
pub struct Point {
    /// Samples per pixel; 0 of the fake.
    pub spp: u32,
    /// Wall-clock seconds.
    pub seconds: Range,
    /// In radiance.
    pub rmse: Range,
    /// Mean of (a - r)^2 / (r^2 + 0.01).
    pub rel_mse: Range,
    /// In radiance.
    pub mae: Range,
    /// In radiance, signed.
    pub bias: Range,
    /// In [0, 1].
    pub flip: Range,
    /// Whether all seeds together are biased.
    pub bias_test: Option<Bias>,
    /// Whether RMSE or relMSE is so small that the reference's own noise covers it.
    pub below_reference_noise: bool,
    /// `1 / (mse * seconds)`, of the medians.
    pub efficiency: f64,
    /// Samples (paths) a second, median; 0 of the fake.
    pub samples_per_second: f64,
    /// Rays a second, median; 0 of the fake.
    pub rays_per_second: f64,
    /// Samples that were not finite, of all seeds.
    pub nonfinite: u64,
    /// Samples that were cut short, of all seeds.
    pub cut_paths: u64,
    /// The largest share of a single sample in a picture's sum of squares.
    pub tail_weight: f64,
}

/// One line of a peer's table.
pub struct PeerCurve {
    /// The peer's name.
    pub name: String,
    /// Its rows of this part, ascending in samples.
    pub rows: Vec<PeerRow>,
}

impl PartSummary {
    /// Of the part's lines, of which some may be missing.
    pub fn new(part: &Part, worth: Worth, lines: &[Line], measurements: &[Measurement], peers: &[PeerRow]) -> Self {
        let curve = |line: &Line| {
            let name = line.name();
            let mut own: Vec<&Measurement> =
                measurements.iter().filter(|m| m.part == part.name && m.line == name).collect();
            own.sort_by_key(|m| m.spp);
            (!own.is_empty()).then(|| Curve::new(*line, &own))
        };
        let mut peers_here: Vec<PeerCurve> = Vec::new();
        for row in peers.iter().filter(|row| row.part == part.name) {
            match peers_here.iter_mut().find(|curve| curve.name == row.name) {
                Some(curve) => curve.rows.push(row.clone()),
                None => peers_here.push(PeerCurve { name: row.name.clone(), rows: vec![row.clone()] }),
            }
        }
        peers_here.iter_mut().for_each(|curve| curve.rows.sort_by_key(|row| row.spp));
        PartSummary { part: part.clone(), worth, curves: lines.iter().filter_map(curve).collect(), peers: peers_here }
    }

    /// The curve of that name.
    pub fn curve(&self, name: &str) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.line.name() == name)
    }
}

impl Curve {
    /// Of one line's measurements, ascending in samples.
    pub fn new(line: Line, measurements: &[&Measurement]) -> Self {
        let points: Vec<Point> = measurements.iter().filter_map(|m| Point::of(m)).collect();
        let clear = |m: &&&Measurement| Point::of(m).is_some_and(|point| !point.below_reference_noise);
        let law = |error: fn(&Picture, &Worth) -> f64| {
            let of_seeds = |m: &&Measurement| {
                let (spp, worth) = (f64::from(m.spp), m.reference);
                m.pictures.iter().map(move |p| (spp, error(p, &worth))).collect::<Vec<_>>()
            };
            let points: Vec<(f64, f64)> = measurements.iter().filter(clear).flat_map(of_seeds).collect();
            if line.converges() { fit(&points) } else { None }
        };
        let slope = law(|p, worth| without_noise(p.rmse * p.rmse, worth.mse));
        let relative_slope = law(|p, worth| without_noise(p.rel_mse, worth.rel_mse));
        let last_slope = match (points.as_slice(), measurements) {
            ([.., a, b], [.., of_a, of_b]) if !b.below_reference_noise => {
                let of = |point: &Point, m: &Measurement| without_noise(point.rel_mse.median, m.reference.rel_mse);
                Some((of(b, of_b) / of(a, of_a)).log10() / (f64::from(b.spp) / f64::from(a.spp)).log10())
            }
            _ => None,
        };
        Curve { line, points, slope, relative_slope, last_slope }
    }

    /// The last rung.
    pub fn last(&self) -> Option<&Point> {
        self.points.last()
    }
}

/// The root of a mean square as it would be against an exact reference; 0 where the noise covers it.
fn without_noise(mean_square: f64, noise: f64) -> f64 {
    (mean_square - noise).max(0.0).sqrt()
}

impl Point {
    fn of(m: &Measurement) -> Option<Self> {
        let range = |of: fn(&Picture) -> f64| Range::of(m.pictures.iter().map(of));
        let (rmse, rel_mse, seconds) = (range(|p| p.rmse)?, range(|p| p.rel_mse)?, range(|p| p.seconds)?);
        let median = Errors { rmse: rmse.median, ..Errors::default() }.with_reference_noise(m.reference.mse);
        let relative = rel_mse.median - m.reference.rel_mse < m.reference.rel_mse;
        Some(Point {
            spp: m.spp,
            seconds,
            rmse,
            rel_mse,
            mae: range(|p| p.mae)?,
            bias: range(|p| p.bias)?,
            flip: range(|p| p.flip)?,
            bias_test: m.bias,
            below_reference_noise: median.below_reference_noise() || relative,
            efficiency: efficiency(without_noise(rmse.median * rmse.median, m.reference.mse).powi(2), seconds.median),
            samples_per_second: range(|p| p.samples as f64 / p.seconds)?.median,
            rays_per_second: range(|p| p.rays as f64 / p.seconds)?.median,
            nonfinite: m.pictures.iter().map(|p| p.nonfinite).sum(),
            cut_paths: m.pictures.iter().map(|p| p.cut_paths).sum(),
            tail_weight: range(|p| p.tail_weight)?.high,
        })
    }

    /// What the test of its relative bias found, for people.
    pub fn bias_words(&self) -> String {
        match self.bias_test.map(|bias| bias.relative) {
            None => String::new(),
            Some(test) if test.found() => format!("{} biased", percent(test.bias())),
            Some(test) => format!("none above {}", percent(test.power())),
        }
    }
}

/// How a bias is judged, for people.
pub fn bias_rule() -> String {
    format!(
        "Bias: of each pixel as a share of its truth, root of the mean square over pixels; told when its square is more \
         than {SIGMAS} standard errors above 0; \"none above\": a bias of that size is noticed every other time, one half as large again nearly always."
    )
}

fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent >= 10.0 { format!("{percent:.0} %") } else { format!("{percent:.2} %") }
}

/// "-0.50 ± 0.01", with a digit more where it is known better.
pub fn slope_words(fit: &Fit) -> String {
    let digits = if fit.slope_error < 0.01 { 3 } else { 2 };
    format!("{:.digits$} ± {:.digits$}", fit.slope, fit.slope_error).replace('-', "\u{2212}")
}
