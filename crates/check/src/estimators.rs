//! Several estimators of one integral: their means, their variances, and how fast their errors fall.

use crate::area_lights::{RECTANGLE, direct, from_above};
use crate::hard::known;
use crate::measure::{Trial, adding};
use film::Film;
use pathtrace::{Estimator, PathSettings, SamplerKind, Tracer, estimate_with_replicates};
use scene::Camera;
use std::convert::Infallible;
use std::sync::atomic::Ordering;

/// Relative variance of one sample, from f64.
pub const VARIANCES: [(Estimator, f64); 3] =
    [(Estimator::COSINE, 29.8), (Estimator::LIGHT, 0.431), (Estimator::MIS, 0.439)];

/// The point of the floor that all of them look at, and its radiance.
pub fn far_point() -> (Camera, f64) {
    let (x, y, expected) = RECTANGLE[2];
    (from_above(x, y, 0.5), expected)
}

pub fn three_of_one(trial: &mut Trial) {
    let scene = known("rectangle-light");
    let (camera, expected) = far_point();
    let tracer = Tracer::new(&scene);
    let seen = (&tracer, &camera);
    for (estimator, variance) in VARIANCES {
        let settings = direct(estimator);
        trial.traced("mean", expected, seen, settings);
        let mut film = Film::new(64, 64);
        tracer.render(&mut film, &camera, &settings.into(), trial.pick(128, 1024), &|| trial.stopped());
        trial.count_nonfinite(&film);
        let subject = format!("path {}", estimator.name());
        let measured = variance_of_a_sample(&film) / (expected * expected);
        trial.equal(&subject, "relative variance of a sample", variance, measured, 0.05 * variance);
        // errors over the spread of pictures, 16 to 16384 samples
        let pictures = trial.pick(2304, 4096);
        if estimator != Estimator::COSINE || trial.full() {
            let measured = slope_on_the_processor(trial, seen, &settings, pictures);
            trial.equal(&subject, "slope of the error, independent", -0.5, measured, 0.05);
            let sobol = PathSettings { sampler: SamplerKind::Sobol, ..settings };
            let measured = slope_on_the_processor(trial, seen, &sobol, pictures / 4);
            trial.at_most(&subject, "slope of the error, Sobol", -0.45, measured);
        }
    }
    replicates(trial, &tracer, expected);
}

/// Variance of a sample inside of a pixel, mean over all pixels.
pub fn variance_of_a_sample(film: &Film) -> f64 {
    let samples = f64::from(film.samples_per_pixel());
    film.pixels().iter().map(|p| p.variance_of_mean()[0] * samples).sum::<f64>() / film.pixels().len() as f64
}

/// The power of the number of samples with which the error falls, from 16 samples to 2^`last`, over the spread of
/// pixels that all see one point; `render` makes a film of so many samples.
///
/// # Errors
/// Those of `render`.
pub fn slope<E>(expected: f64, last: u32, mut render: impl FnMut(u32) -> Result<Film, E>) -> Result<f64, E> {
    let mut errors = Vec::new();
    for exponent in (4..=last).step_by(2) {
        let film = render(1 << exponent)?;
        let squares = film.pixels().iter().map(|p| (p.mean()[0] - expected).powi(2)).sum::<f64>();
        errors.push((f64::from(exponent), 0.5 * (squares / film.pixels().len() as f64).log2()));
    }
    Ok(fitted_slope(&errors))
}

fn slope_on_the_processor(
    trial: &Trial,
    (tracer, camera): (&Tracer, &Camera),
    settings: &PathSettings,
    pictures: u32,
) -> f64 {
    let side = f64::from(pictures).sqrt() as u32;
    let Ok(slope) = slope(RECTANGLE[2].2, trial.pick(10, 14), |samples| {
        let mut film = Film::new(side, side);
        tracer.render(&mut film, camera, &(*settings).into(), samples, &|| trial.stopped());
        Ok::<_, Infallible>(film)
    });
    slope
}

/// Least squares through (x, y).
fn fitted_slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let covariance: f64 = points.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
    covariance / points.iter().map(|(x, _)| (x - mx).powi(2)).sum::<f64>()
}

/// A film's standard errors are the spread of pictures of many seeds: from samples if these are independent, from
/// replicates if they are not.
fn replicates(trial: &mut Trial, tracer: &Tracer, expected: f64) {
    let (camera, _) = far_point();
    let settings = direct(Estimator::default());
    let stop = trial.stop_flag();
    let independent = |seed: u32| {
        let mut film = Film::new(32, 32);
        adding(tracer, &camera, settings)(&mut film, seed + 1, 64, stop);
        film
    };
    let ratio = told_and_true(independent, 32);
    trial.equal("film", "standard error over spread, independent", 1.0, ratio, 0.1);
    let sobol = PathSettings { sampler: SamplerKind::Sobol, ..settings };
    let replicated = |seed: u32| {
        let settings = PathSettings { seed: seed * 100, ..sobol }.into();
        estimate_with_replicates(tracer, &camera, &settings, (16, 16), 16, 16, &|| stop.load(Ordering::Relaxed))
    };
    let ratio = told_and_true(replicated, 16);
    trial.equal("film", "standard error over spread, Sobol replicates", 1.0, ratio, 0.1);
    let mean = replicated(1).mean()[0];
    trial.equal("path light", "mean, Sobol replicates", expected, mean, 0.005 * expected);
    let alone = |seed: u32| {
        let mut film = Film::new(16, 16);
        adding(tracer, &camera, sobol)(&mut film, seed + 1, 64, stop);
        film
    };
    trial.information("film", "standard error over spread, Sobol without replicates", 1.0, told_and_true(alone, 16));
}

/// The standard error that the first of 32 films of `side` pixels a side tells, over the spread of all: mean squares
/// over the pixels.
fn told_and_true(film: impl Fn(u32) -> Film, side: u32) -> f64 {
    let films: Vec<Film> = (0..32).map(film).collect();
    let pixels = f64::from(side * side);
    let told: f64 = films[0].pixels().iter().map(|p| p.variance_of_mean()[0]).sum::<f64>() / pixels;
    let spread = (0..films[0].pixels().len()).map(|i| {
        let values: Vec<f64> = films.iter().map(|film| film.pixels()[i].mean()[0]).collect();
        let mean = values.iter().sum::<f64>() / 32.0;
        values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 31.0
    });
    (told / (spread.sum::<f64>() / pixels)).sqrt()
}
