//! How long a picture takes while a slider moves: the ratio of refraction, so that everything is made anew.

use super::{DeviceReportError, Extent, median_and_99th};
use film::Film;
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{Integrator, PathSettings};
use raster::{Raster, RasterSettings, Repairs};
use scene::Scene;
use std::fmt::Write;
use std::time::Instant;

/// Where the slider goes.
const RATIOS: [f32; 2] = [0.6, 1.0];

/// A line each for the fake, the fake repaired and paths of one sample a pixel: milliseconds until the picture is on the
/// device, until it is on the processor too, and the bytes that this takes.
///
/// # Errors
/// [`DeviceReportError`] if the device fails.
pub fn frames(gpu: &Gpu, extent: &Extent) -> Result<String, DeviceReportError> {
    let scene = scene::builtin::named("whitted")?;
    let mut text = format!(
        "{:24} {:>12} {:>12} {:>14} {:>14} {:>10}\n",
        "whitted, a drag", "drawn, ms", "99th", "read back, ms", "99th", "MB back"
    );
    for (name, repairs) in [("the fake", Repairs::NONE), ("the fake repaired", Repairs::ALL)] {
        let mut raster = Raster::new(gpu)?;
        let (width, height) = extent.size;
        let settings = RasterSettings { repairs, ..RasterSettings::new(width, height) };
        let mut fake = Drag { scene: scene.clone(), extent };
        let drawn = fake.timed(|scene| Ok(raster.draw(scene, &scene.camera, &settings)?))?;
        let back = fake.timed(|scene| Ok(raster.render(scene, &scene.camera, &settings).map(drop)?))?;
        tell(&mut text, name, (drawn, back), extent, BYTES_OF_THE_FAKE);
    }
    let (drawn, back) = paths(gpu, &scene, extent)?;
    tell(&mut text, "paths, 1 spp", (drawn, back), extent, BYTES_OF_A_FILM);
    Ok(text)
}

/// Of a pixel that is read back of the fair fake: four numbers.
const BYTES_OF_THE_FAKE: f64 = 16.0;

/// Of a pixel of a film of rays: sums, squares, counts.
const BYTES_OF_A_FILM: f64 = size_of::<pathtrace::gpu::film_data::Pixel>() as f64;

fn paths(gpu: &Gpu, scene: &Scene, extent: &Extent) -> Result<(Times, Times), DeviceReportError> {
    let (width, height) = extent.size;
    let integrator = Integrator::from(PathSettings::default());
    let mut tracer = GpuTracer::new(gpu, scene)?;
    let mut drag = Drag { scene: scene.clone(), extent };
    let mut one = |scene: &Scene, reads: bool| -> Result<(), DeviceReportError> {
        tracer.set_scene(scene)?;
        let film = Film::try_new(width, height).ok_or(DeviceReportError::Memory(width, height))?;
        let mut film = tracer.film(film)?;
        tracer.accumulate(&mut film, &scene.camera, &integrator, 1, &|| false)?;
        if reads { Ok(film.read(gpu).map(drop)?) } else { Ok(gpu.wait_for_all("a picture")?) }
    };
    Ok((drag.timed(|scene| one(scene, false))?, drag.timed(|scene| one(scene, true))?))
}

/// Milliseconds: the median of all pictures, and the 99th percentile.
type Times = [f64; 2];

/// A slider's way across [`RATIOS`], a picture at each step.
struct Drag<'a> {
    scene: Scene,
    extent: &'a Extent,
}

impl Drag<'_> {
    /// A picture at each place, the first of which is not counted: it compiles.
    fn timed(
        &mut self,
        mut picture: impl FnMut(&Scene) -> Result<(), DeviceReportError>,
    ) -> Result<Times, DeviceReportError> {
        let count = self.extent.pictures.max(1);
        let mut times = Vec::with_capacity(count);
        for index in 0..=count {
            let share = index as f32 / count as f32;
            self.scene.set_refraction_ratio(RATIOS[0] + (RATIOS[1] - RATIOS[0]) * share);
            let start = Instant::now();
            picture(&self.scene)?;
            if index > 0 {
                times.push(1e3 * start.elapsed().as_secs_f64());
            }
        }
        Ok(median_and_99th(times))
    }
}

fn tell(text: &mut String, name: &str, (drawn, back): (Times, Times), extent: &Extent, bytes: f64) {
    let pixels = f64::from(extent.size.0) * f64::from(extent.size.1);
    let _ = writeln!(
        text,
        "{name:24} {:12.2} {:12.2} {:14.2} {:14.2} {:10.1}",
        drawn[0],
        drawn[1],
        back[0],
        back[1],
        1e-6 * bytes * pixels
    );
}
