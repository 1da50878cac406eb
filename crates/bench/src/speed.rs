//! How fast this machine is, measured before a bench is planned.

use crate::plan::{Part, RUNG};
use film::{Features, Film, Image, Vec3};
use pathtrace::{Integrator, Tracer};
use reference::Maker;
use scene::Scene;
use serde::{Deserialize, Serialize};
use std::time::Instant;
use technique::{Denoiser, Filters};

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
    /// Seconds that a pixel takes in the slowest filter.
    pub denoising: f64,
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
            denoising: seconds_of_a_filtered_pixel(),
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

/// The network's, whatever the picture; no time at all where it has no memory.
fn seconds_of_a_filtered_pixel() -> f64 {
    let pixels = (SIDE * SIDE) as usize;
    let black = vec![Vec3::ZERO; pixels];
    let picture = Image::new(SIDE, SIDE, black.clone());
    let features = Features::new((SIDE, SIDE), black.clone(), black, vec![0.0; pixels]);
    let (Some(picture), Some(features)) = (picture, features) else { return 0.0 };
    let mut seconds = f64::INFINITY;
    // the first reads the weights too
    for _ in 0..2 {
        let start = Instant::now();
        // one that fails tells so where its picture is wanted
        drop(Denoiser::Unet.apply(&picture, &features, None, &Filters::on_the_processor(), &|| false));
        seconds = seconds.min(start.elapsed().as_secs_f64());
    }
    seconds / pixels as f64
}

fn seconds_of_one_sample(tracer: &Tracer, scene: &Scene, integrator: &Integrator) -> f64 {
    let start = Instant::now();
    tracer.render(&mut Film::new(SIDE, SIDE), &scene.camera, integrator, 1, &|| false);
    start.elapsed().as_secs_f64()
}
