//! How many paths and rays a second a device traces, and the processor beside it.

use super::{DeviceReportError, Extent, Peaks, statue};
use film::Film;
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{Integrator, PathSettings, Stats, Tracer};
use scene::Scene;
use std::fmt::Write;
use std::time::Instant;

/// Seconds that a dispatch may take: nobody else waits for the device.
const BUDGET: f64 = 0.1;

/// Samples of a pixel that are measured, at most.
const MOST: u32 = 1 << 14;

/// How fast a scene is traced.
#[derive(Debug, Clone, PartialEq)]
pub struct Rate {
    /// Name of the scene that was traced.
    pub scene: String,
    /// Rays and paths a second on the device, and by the processor.
    pub device: [f64; 2],
    /// The same of the processor.
    pub processor: [f64; 2],
    /// Whether the device's own clock was believed.
    pub by_its_clock: bool,
}

/// Complete paths with light sampling in `cornell`, `whitted` and over a statue.
///
/// # Errors
/// [`DeviceReportError`] if the device fails.
pub fn rates(gpu: &Gpu, extent: &Extent) -> Result<Vec<Rate>, DeviceReportError> {
    let scenes = [scene::builtin::named("cornell")?, scene::builtin::named("whitted")?, statue(extent.level)?];
    scenes.iter().map(|scene| rate(gpu, scene, extent)).collect()
}

fn rate(gpu: &Gpu, scene: &Scene, extent: &Extent) -> Result<Rate, DeviceReportError> {
    let (width, height) = extent.size;
    let integrator = Integrator::from(PathSettings::default());
    let mut tracer = GpuTracer::new(gpu, scene)?;
    tracer.set_budget(BUDGET);
    let film = || Film::try_new(width, height).ok_or(DeviceReportError::Memory(width, height));
    let mut on_device = tracer.film(film()?)?;
    let mut add = |until: u32| -> Result<f64, DeviceReportError> {
        tracer.accumulate(&mut on_device, &scene.camera, &integrator, until, &|| false)?;
        Ok(tracer.take_seconds())
    };
    add(1)?;
    let (mut done, mut seconds) = (1, 0.0);
    while seconds < extent.seconds && done < MOST {
        seconds += add(2 * done)?;
        done *= 2;
    }
    let (_, stats) = on_device.read(gpu)?;
    // of the samples that were timed: all but the first of each pixel
    let timed = 1.0 - 1.0 / f64::from(done);
    let device = [stats.rays, stats.samples].map(|count| timed * count as f64 / seconds);
    let processor = on_the_processor(scene, &integrator, film()?, extent.seconds);
    Ok(Rate { scene: scene.name.clone(), device, processor, by_its_clock: tracer.has_a_clock() })
}

fn on_the_processor(scene: &Scene, integrator: &Integrator, mut film: Film, least: f64) -> [f64; 2] {
    let tracer = Tracer::new(scene);
    let (mut sum, mut samples) = (Stats::default(), 1);
    let start = Instant::now();
    loop {
        sum = sum.plus(tracer.render(&mut film, &scene.camera, integrator, samples, &|| false));
        let seconds = start.elapsed().as_secs_f64();
        if seconds >= least || film.samples_per_pixel() >= MOST {
            return [sum.rays, sum.samples].map(|count| count as f64 / seconds);
        }
        samples = film.samples_per_pixel();
    }
}

/// A line a scene: rays and paths of both machines, and what a ray may cost of the device's peaks where they are known.
pub fn tell_rates(rates: &[Rate], peaks: Option<Peaks>) -> String {
    let mut text = format!(
        "{:10} {:>10} {:>10} {:>14} {:>14} {:>13} {:>11}\n",
        "scene", "Mpaths/s", "Mrays/s", "cpu, Mpaths/s", "cpu, Mrays/s", "flop per ray", "B per ray"
    );
    for rate in rates {
        let [[rays, paths], [cpu_rays, cpu_paths]] = [rate.device, rate.processor].map(|of| of.map(|rate| 1e-6 * rate));
        let per_ray = |peak: fn(&Peaks) -> f64| {
            peaks.as_ref().map_or_else(|| "-".into(), |peaks| format!("{:.0}", peak(peaks) / (1e6 * rays)))
        };
        let (flop, bytes) = (per_ray(|peaks| peaks.operations), per_ray(|peaks| peaks.bytes));
        let clock = if rate.by_its_clock { "" } else { " (by the wall's clock)" };
        let _ = writeln!(
            text,
            "{:10} {paths:10.1} {rays:10.1} {cpu_paths:14.2} {cpu_rays:14.2} {flop:>13} {bytes:>11}{clock}",
            rate.scene
        );
    }
    text
}
