//! Measuring: exact comparisons, bounds, and means of independently seeded pictures.

use crate::row::{Relation, Row, Verdict};
use crate::runner::{Effort, Runner};
use film::Film;
use pathtrace::{Integrator, Tracer};
use rayon::prelude::*;
use scene::Camera;
use std::sync::atomic::{AtomicBool, Ordering};

/// Independently seeded pictures of a Monte Carlo row.
pub const PICTURES: u32 = 32;

/// Side of those pictures in pixels.
const SIDE: u32 = 4;

/// What a renderer's single precision may be off by beside chance, relative.
const ROUNDING: f64 = 2e-6;

/// By how much the expectations of a spoilt run are too large.
const SPOILT: f64 = 1.05;

/// One case on its way.
pub struct Trial<'a> {
    case: u32,
    runner: Runner<'a>,
    rows: Vec<Row>,
    nonfinite: u64,
}

/// Mean of many pictures and what is known about it.
#[derive(Debug, Clone, Copy)]
pub struct Mean {
    /// Of all pictures.
    pub mean: f64,
    /// Standard error of the mean, from the pictures' spread.
    pub standard_error: f64,
    /// Samples in all pictures together.
    pub samples: f64,
}

impl Mean {
    /// Variance of a single sample over the squared mean.
    pub fn relative_variance(&self) -> f64 {
        (self.standard_error / self.mean).powi(2) * self.samples
    }
}

/// What a row compares.
struct Numbers {
    expected: f64,
    measured: f64,
    tolerance: f64,
    power: Option<(f64, f64)>,
}

impl<'a> Trial<'a> {
    /// Begins case number `case`.
    pub fn new(case: u32, runner: &Runner<'a>) -> Self {
        Trial { case, runner: *runner, rows: Vec::new(), nonfinite: 0 }
    }

    /// Whether everything is run.
    pub fn full(&self) -> bool {
        self.runner.effort == Effort::Full
    }

    /// One of two numbers, by effort.
    pub fn pick<T>(&self, quick: T, full: T) -> T {
        if self.full() { full } else { quick }
    }

    /// What says so.
    pub fn stop_flag(&self) -> &'a AtomicBool {
        self.runner.stop
    }

    /// Whether the user has had enough.
    pub fn stopped(&self) -> bool {
        self.runner.stop.load(Ordering::Relaxed)
    }

    /// The rows, and one that says that no sample was dropped for not being finite.
    pub fn into_rows(mut self) -> Vec<Row> {
        let nonfinite = self.nonfinite as f64;
        self.at_most("all", "samples that were not finite", 0.0, nonfinite);
        self.rows
    }

    /// Largest relative standard error with power.
    pub fn power(&self) -> f64 {
        self.pick(0.005, 0.001)
    }

    fn push(&mut self, subject: &str, quantity: &str, numbers: Numbers, relation: Relation, verdict: Verdict) {
        let Numbers { expected, measured, tolerance, power } = numbers;
        self.rows.push(Row {
            case: self.case,
            device: self.runner.machine.device(),
            subject: subject.to_owned(),
            quantity: quantity.to_owned(),
            expected,
            measured,
            relation,
            tolerance,
            power,
            verdict,
        });
        if let Some(row) = self.rows.last() {
            (self.runner.on_row)(row);
        }
    }

    /// What a row expects: too much in a spoilt run.
    fn demanded(&self, expected: f64) -> f64 {
        if self.runner.spoilt { SPOILT * expected } else { expected }
    }

    /// Measured must be within `tolerance` of expected.
    pub fn equal(&mut self, subject: &str, quantity: &str, expected: f64, measured: f64, tolerance: f64) {
        let expected = self.demanded(expected);
        let verdict = verdict((measured - expected).abs() <= tolerance);
        let numbers = Numbers { expected, measured, tolerance, power: None };
        self.push(subject, quantity, numbers, Relation::Equal, verdict);
    }

    /// Measured must not exceed the bound.
    pub fn at_most(&mut self, subject: &str, quantity: &str, bound: f64, measured: f64) {
        let numbers = Numbers { expected: bound, measured, tolerance: 0.0, power: None };
        self.push(subject, quantity, numbers, Relation::AtMost, verdict(measured <= bound));
    }

    /// Measured is only told.
    pub fn information(&mut self, subject: &str, quantity: &str, expected: f64, measured: f64) {
        let numbers = Numbers { expected, measured, tolerance: (measured - expected).abs(), power: None };
        self.push(subject, quantity, numbers, Relation::Equal, Verdict::Information);
    }

    /// The mean of 32 pictures that `render` adds samples to, given a seed; as many as it takes for a relative
    /// standard error of `power`, but at most `most` a picture's pixel.
    pub fn mean_of(
        &mut self,
        expected: f64,
        power: f64,
        most: u32,
        render: impl Fn(&mut Film, u32, u32, &AtomicBool) + Sync,
    ) -> Mean {
        let mut films: Vec<Film> = (0..PICTURES).map(|_| Film::new(SIDE, SIDE)).collect();
        let mut more = 16;
        loop {
            films.par_iter_mut().enumerate().for_each(|(i, film)| render(film, i as u32 + 1, more, self.runner.stop));
            let spp = films[0].samples_per_pixel();
            let means: Vec<f64> = films.iter().map(|film| film.mean()[0]).collect();
            let n = f64::from(PICTURES);
            let mean = means.iter().sum::<f64>() / n;
            let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n - 1.0);
            let samples = n * f64::from(SIDE * SIDE) * f64::from(spp);
            // where all samples agree, one as large as the mean may still have been missed
            let standard_error = (variance / n).sqrt().hypot(expected / samples);
            if standard_error <= power * expected.abs() || spp >= most || self.stopped() {
                self.nonfinite += films.iter().map(|film| film.nonfinite).sum::<u64>();
                return Mean { mean, standard_error, samples };
            }
            // a spread of 32 is itself known to an eighth: a little more than it asks for, and not too much at once
            let wanted = (standard_error / (power * expected.abs())).powi(2).clamp(1.2, 8.0) * 1.2;
            more = ((f64::from(spp) * (wanted - 1.0)).ceil() as u32).clamp(1, most - spp);
        }
    }

    /// A Monte Carlo row with a power of its own.
    pub fn monte_carlo_to(
        &mut self,
        power: f64,
        subject: &str,
        quantity: &str,
        expected: f64,
        render: impl Fn(&mut Film, u32, u32, &AtomicBool) + Sync,
    ) -> Mean {
        let found = self.mean_of(expected, power, self.pick(20_000, 100_000), render);
        self.mean_and_error(subject, quantity, expected, (found.mean, found.standard_error), power);
        found
    }

    /// A mean with its standard error must be within four of these, and they within `power` of what is expected.
    pub fn mean_and_error(
        &mut self,
        subject: &str,
        quantity: &str,
        expected: f64,
        (mean, standard_error): (f64, f64),
        power: f64,
    ) {
        let tolerance = 4.0 * standard_error + ROUNDING * expected;
        let reached = standard_error / expected;
        let expected = self.demanded(expected);
        let passed = (mean - expected).abs() <= tolerance && reached <= power;
        let numbers = Numbers { expected, measured: mean, tolerance, power: Some((reached, power)) };
        self.push(subject, quantity, numbers, Relation::Equal, verdict(passed));
    }

    /// A Monte Carlo row of a traced picture.
    pub fn traced(
        &mut self,
        quantity: &str,
        expected: f64,
        (tracer, camera): (&Tracer, &Camera),
        integrator: impl Into<Integrator>,
    ) -> Mean {
        let integrator = integrator.into();
        self.monte_carlo_to(self.power(), &subject(integrator), quantity, expected, adding(tracer, camera, integrator))
    }

    /// Counts samples that were not finite.
    pub fn count_nonfinite(&mut self, film: &Film) {
        self.nonfinite += film.nonfinite;
    }

    /// A picture of `size` pixels a side, its dropped samples counted.
    pub fn film(
        &mut self,
        (tracer, camera): (&Tracer, &Camera),
        integrator: impl Into<Integrator>,
        size: u32,
        samples: u32,
    ) -> Film {
        let mut film = Film::new(size, size);
        tracer.render(&mut film, camera, &integrator.into(), samples, &|| self.stopped());
        self.count_nonfinite(&film);
        film
    }
}

/// What adds samples to a film, given a seed and their number; it can be stopped.
pub fn adding<'a>(
    tracer: &'a Tracer,
    camera: &'a Camera,
    integrator: impl Into<Integrator>,
) -> impl Fn(&mut Film, u32, u32, &AtomicBool) + Sync + 'a {
    let integrator = integrator.into();
    move |film, seed, samples, stop| {
        let stop = || stop.load(Ordering::Relaxed);
        tracer.render(film, camera, &integrator.with_seed(seed), samples, &stop);
    }
}

/// What a row calls an integrator: "path mis", "whitted".
pub fn subject(integrator: impl Into<Integrator>) -> String {
    match integrator.into() {
        Integrator::Path(settings) => format!("path {}", settings.estimator.name()),
        other => other.name().into(),
    }
}

/// The pixel farthest from `expected`, by its first channel.
pub fn farthest(film: &Film, expected: f64) -> f64 {
    let off = |value: &f64| (value - expected).abs();
    film.pixels().iter().map(|pixel| pixel.mean()[0]).max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(expected)
}

fn verdict(passed: bool) -> Verdict {
    if passed { Verdict::Pass } else { Verdict::Fail }
}
