//! How fast this machine is, measured before a bench is planned.

use crate::plan::{Part, RUNG};
use film::Film;
use pathtrace::{Integrator, Tracer};
use reference::Maker;
use scene::Scene;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Side of the picture by which speeds are measured.
const SIDE: u32 = 48;

/// How fast things go: samples a second.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Speed {
    /// Samples of a reference per second.
    pub reference: f64,
    /// Of a part's lines, all alike.
    pub lines: f64,
    /// Seconds that it takes to learn a guide, whatever the picture's size.
    pub learning: f64,
}

impl Speed {
    /// Measured in about half a second. What is dear takes part in proportion to its samples, and what learns a guide only
    /// in [`Speed::learning`].
    pub(crate) fn measured(part: &Part, scene: &Scene) -> Self {
        let tracer = Tracer::new(scene);
        let part = Part { width: SIDE, height: SIDE, ..part.clone() };
        let lines = part.lines(scene);
        let timed = lines.iter().filter(|line| line.converges() && !line.learns());
        let shares: Vec<(Integrator, u32)> =
            timed.filter_map(|line| Some((line.integrator(1)?, if line.is_dear() { 1 } else { RUNG }))).collect();
        let learning = lines.iter().find(|line| line.learns()).and_then(|line| line.integrator(1));
        Speed {
            reference: samples_per_second(&tracer, scene, &[(Maker::settings(1).into(), RUNG)]),
            lines: samples_per_second(&tracer, scene, &shares),
            learning: learning.map_or(0.0, |guided| seconds_of_one_sample(&tracer, scene, &guided)),
        }
    }
}

/// Samples a second of all these settings in turn, each with so many samples per pixel, over at least a fifth of a second.
fn samples_per_second(tracer: &Tracer, scene: &Scene, shares: &[(Integrator, u32)]) -> f64 {
    const LEAST_SECONDS: f64 = 0.2;
    let all = || -> u64 {
        let samples = |(way, spp): &(Integrator, u32)| {
            let mut film = Film::new(SIDE, SIDE);
            tracer.render(&mut film, &scene.camera, way, *spp, &|| false).samples
        };
        shares.iter().map(samples).sum()
    };
    // threads and caches awake before the clock runs
    all();
    let (start, mut samples) = (Instant::now(), 0u64);
    while start.elapsed().as_secs_f64() < LEAST_SECONDS {
        samples += all();
    }
    samples as f64 / start.elapsed().as_secs_f64()
}

fn seconds_of_one_sample(tracer: &Tracer, scene: &Scene, integrator: &Integrator) -> f64 {
    let start = Instant::now();
    tracer.render(&mut Film::new(SIDE, SIDE), &scene.camera, integrator, 1, &|| false);
    start.elapsed().as_secs_f64()
}
