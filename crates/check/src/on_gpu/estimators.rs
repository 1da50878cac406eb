//! Several estimators of one integral: their means, their variances, and how fast their errors fall.

use super::{Bench, Outcome};
use crate::area_lights::direct;
use crate::estimators::{VARIANCES, far_point, slope, variance_of_a_sample};
use crate::hard::known;
use pathtrace::{Estimator, PathSettings, SamplerKind};

/// Samples a pixel of the picture that tells the variance, which has 4096.
const SAMPLES: [u32; 2] = [128, 1024];

/// Pixels along each side of the pictures whose errors are compared. Over 1024 of them an error is known to 2.2 %, and
/// the slope from 16 to 1024 samples to .007. A software device traces a million samples a second: four slopes take 3.5
/// million.
const SIDE: u32 = 32;

pub fn three_of_one(bench: &mut Bench) -> Outcome {
    let (camera, expected) = far_point();
    let tracer = &mut bench.tracer(&known("rectangle-light"))?;
    for (estimator, variance) in VARIANCES {
        let settings = direct(estimator);
        let subject = super::subject(settings);
        bench.mean("mean", expected, (tracer, &camera), settings)?;
        let [quick, full] = SAMPLES;
        let film = bench.film((tracer, &camera), settings, 64, bench.trial.pick(quick, full))?;
        let measured = variance_of_a_sample(&film) / (expected * expected);
        bench.trial.equal(&subject, "relative variance of a sample", variance, measured, 0.05 * variance);
        if estimator == Estimator::COSINE && !bench.trial.full() {
            continue;
        }
        let last = bench.trial.pick(10, 14);
        let mut falls = |settings: &PathSettings, side: u32| {
            slope(expected, last, |samples| bench.film((tracer, &camera), *settings, side, samples))
        };
        let measured = falls(&settings, SIDE)?;
        let sobol = falls(&PathSettings { sampler: SamplerKind::Sobol, ..settings }, SIDE / 2)?;
        bench.trial.equal(&subject, "slope of the error, independent", -0.5, measured, 0.05);
        bench.trial.at_most(&subject, "slope of the error, Sobol", -0.45, sobol);
    }
    Ok(())
}
