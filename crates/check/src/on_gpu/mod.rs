//! The hard cases on a graphics device: the same scenes and closed forms as on the processor, as far as a device
//! renders them. Case 22 is left out: random numbers are compared with the processor's bit for bit, and what is made of
//! them number for number, by the twins' tests. So is case 24: the fake's formulas are the processor's.
//!
//! A software device takes a second to compile for a scene's needs and settings, longer than for most pictures: where
//! scenes differ in numbers alone, one tracer takes one after the other.

mod area_lights;
mod energy;
mod estimators;
mod fake;
mod glass;
mod rays;
mod robustness;
mod surfaces;

use crate::measure::{Mean, Trial, farthest, subject};
use film::Film;
use gpu::Gpu;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::{Integrator, LightSampling};
use raster::RasterError;
use scene::{Camera, Scene};
use std::sync::atomic::Ordering;

/// Why a device has not gone through with a case.
#[derive(Debug, thiserror::Error)]
pub enum DeviceFault {
    /// The device failed while it traced rays.
    #[error(transparent)]
    Trace(#[from] GpuTraceError),
    /// The device failed while it drew the fake.
    #[error(transparent)]
    Raster(#[from] RasterError),
}

pub type Outcome = Result<(), DeviceFault>;

/// What runs a case on a device.
pub struct Bench<'a, 'b> {
    pub gpu: &'a Gpu,
    pub trial: &'a mut Trial<'b>,
}

/// What runs the case on a device, if that renders it.
pub fn of_number(case: u32) -> Option<fn(&mut Bench) -> Outcome> {
    Some(match case {
        1 => energy::white_furnace,
        2 => energy::closed_box,
        3 => energy::point_light,
        4 => area_lights::rectangle,
        5 => area_lights::edge_on,
        6 => area_lights::disk,
        7 => area_lights::sphere,
        8 => area_lights::touching_wall,
        9 => estimators::three_of_one,
        10 => glass::fresnel,
        11 => glass::index_one,
        12 => glass::slab,
        13 => glass::through_a_sphere,
        14 => glass::furnace,
        15 => glass::camera_inside,
        16 => rays::closed_mesh,
        17 => rays::light_tight_box,
        18 => rays::self_intersection,
        19 => rays::far_spheres,
        20 => robustness::invariance,
        21 => robustness::degenerate,
        23 => energy::million_samples,
        25 => surfaces::far_lamp,
        26 => surfaces::lamps_in_one_place,
        27 => surfaces::contact,
        28 => surfaces::gallery,
        29 => surfaces::board,
        30 => fake::at_any_scale,
        31 => glass::caustic,
        _ => return None,
    })
}

/// A scene on the device and what looks at it.
type Seen<'a> = (&'a mut GpuTracer, &'a Camera);

/// Pixels along each side of a picture whose mean is asked for.
const SIDE: u32 = 32;

impl Bench<'_, '_> {
    fn tracer(&self, scene: &Scene) -> Result<GpuTracer, GpuTraceError> {
        GpuTracer::new(self.gpu, scene)
    }

    /// A square picture, its dropped samples counted.
    fn film(
        &mut self,
        (tracer, camera): Seen,
        integrator: impl Into<Integrator>,
        size: u32,
        samples: u32,
    ) -> Result<Film, GpuTraceError> {
        let mut film = Film::new(size, size);
        let trial = &*self.trial;
        tracer.render(&mut film, camera, &integrator.into(), samples, &|| trial.stopped())?;
        self.trial.count_nonfinite(&film);
        Ok(film)
    }

    /// A picture whose every pixel is `expected`, without noise.
    fn exactly(&mut self, quantity: &str, expected: f64, seen: Seen, integrator: impl Into<Integrator>) -> Outcome {
        let integrator = integrator.into();
        let film = self.film(seen, integrator, SIDE, 8)?;
        self.trial.equal(&subject(integrator), quantity, expected, farthest(&film, expected), 1e-5);
        Ok(())
    }

    /// The mean of a picture that sees one thing.
    fn mean(
        &mut self,
        quantity: &str,
        expected: f64,
        seen: Seen,
        integrator: impl Into<Integrator>,
    ) -> Result<Mean, GpuTraceError> {
        let integrator = integrator.into();
        let power = match integrator {
            // a density that is off by a twentieth moves a weighted mean by less than a hundredth, and its samples
            // spread little
            Integrator::Path(path) if path.estimator.light == LightSampling::Mis => 0.001,
            _ => self.trial.power(),
        };
        self.mean_to(power, quantity, expected, seen, integrator)
    }

    /// As [`Bench::mean`], to a relative standard error of `power`.
    fn mean_to(
        &mut self,
        power: f64,
        quantity: &str,
        expected: f64,
        seen: Seen,
        integrator: impl Into<Integrator>,
    ) -> Result<Mean, GpuTraceError> {
        let integrator = integrator.into();
        let found = self.mean_of(expected, power, seen, integrator)?;
        let measured = (found.mean, found.standard_error);
        self.trial.mean_and_error(&subject(integrator), quantity, expected, measured, power);
        Ok(found)
    }

    /// The mean of a picture of as many samples as it takes for a relative standard error of `power`.
    fn mean_of(
        &mut self,
        expected: f64,
        power: f64,
        (tracer, camera): Seen,
        integrator: impl Into<Integrator>,
    ) -> Result<Mean, GpuTraceError> {
        let (integrator, stop) = (integrator.into(), self.trial.stop_flag());
        let mut film = Film::new(SIDE, SIDE);
        let most = self.trial.pick(4096, 65_536);
        let mut more = 16;
        loop {
            tracer.render(&mut film, camera, &integrator, more, &|| stop.load(Ordering::Relaxed))?;
            let each = film.samples_per_pixel();
            let samples = f64::from(SIDE * SIDE) * f64::from(each.max(1));
            // where all samples agree, one as large as the mean may still have been missed
            let standard_error = film.standard_error()[0].hypot(expected / samples);
            if standard_error <= power * expected || each >= most || self.trial.stopped() {
                self.trial.count_nonfinite(&film);
                return Ok(Mean { mean: film.mean()[0], standard_error, samples });
            }
            let wanted = (standard_error / (power * expected)).powi(2).clamp(1.2, 8.0) * 1.2;
            more = ((f64::from(each) * (wanted - 1.0)).ceil() as u32).clamp(1, most - each);
        }
    }
}
