//! Whether a device's pictures are the processor's: the same samples, so that they differ by rounding alone.

use super::DeviceReportError;
use film::Film;
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{Integrator, PathSettings, Tracer};
use std::fmt::Write;

/// Side of the pictures that are compared, in pixels.
const SIDE: u32 = 256;

/// Samples of each pixel.
const SPP: u32 = 4;

/// Difference that rounding does not make of a pixel, relative to the picture's mean.
const OTHER: f64 = 1e-3;

/// A line a scene: the means of both pictures, and the share of pixels that took another path.
///
/// # Errors
/// [`DeviceReportError`] if the device fails.
pub fn agreement(gpu: &Gpu) -> Result<String, DeviceReportError> {
    let mut text = format!(
        "{:10} {:>12} {:>12} {:>14} {:>22}\n",
        "scene", "device", "processor", "difference", "pixels of other paths"
    );
    for name in ["cornell", "whitted", "phong"] {
        let scene = scene::builtin::named(name)?;
        let integrator = Integrator::from(PathSettings::default());
        let film = || Film::try_new(SIDE, SIDE).ok_or(DeviceReportError::Memory(SIDE, SIDE));
        let [mut theirs, mut ours] = [film()?, film()?];
        GpuTracer::new(gpu, &scene)?.render(&mut theirs, &scene.camera, &integrator, SPP, &|| false)?;
        Tracer::new(&scene).render(&mut ours, &scene.camera, &integrator, SPP, &|| false);
        let mean =
            |film: &Film| film.pixels().iter().map(|pixel| pixel.mean()[1]).sum::<f64>() / f64::from(SIDE * SIDE);
        let [device, processor] = [mean(&theirs), mean(&ours)];
        let apart = |(a, b): (&film::Pixel, &film::Pixel)| (a.mean()[1] - b.mean()[1]).abs() > OTHER * processor;
        let other = theirs.pixels().iter().zip(ours.pixels()).filter(|pair| apart(*pair)).count();
        let (difference, share) = ((device - processor) / processor, other as f64 / f64::from(SIDE * SIDE));
        let _ = writeln!(text, "{name:10} {device:12.6} {processor:12.6} {difference:14.1e} {:21.2}%", 100.0 * share);
    }
    Ok(text)
}
