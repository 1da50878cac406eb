//! The hard cases on a graphics device: the same scenes and closed forms as on the processor, as far as a device
//! renders them. Case 22 is left out: random numbers are compared with the processor's bit for bit, and what is made of
//! them number for number, by the twins' tests. So is case 24: the fake has tests of its own.
//!
//! A software device takes a second to compile for a scene's needs and settings, longer than for most pictures: where
//! scenes differ in numbers alone, one tracer takes one after the other.

mod area_lights;
mod energy;
mod estimators;
mod glass;
mod rays;
mod robustness;

use crate::case::Case;
use crate::measure::{Effort, Mean, Trial, farthest};
use crate::row::{Device, Row};
use film::Film;
use gpu::Gpu;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::{LightSampling, PathSettings, WhittedSettings};
use scene::{Camera, Scene};
use std::sync::atomic::{AtomicBool, Ordering};

type Outcome = Result<(), GpuTraceError>;

/// What runs a case on a device.
struct Bench<'a, 'b> {
    gpu: &'a Gpu,
    trial: &'a mut Trial<'b>,
}

/// Runs those of `cases` that a device renders, as [`crate::run`] does on the processor.
///
/// # Errors
/// [`GpuTraceError`] if the device fails.
pub fn run_on_gpu(
    gpu: &Gpu,
    cases: &[Case],
    effort: Effort,
    stop: &AtomicBool,
    mut on_rows: impl FnMut(&Case, &[Row]) -> bool,
) -> Result<Vec<Row>, GpuTraceError> {
    let mut all = Vec::new();
    for case in cases {
        let Some(run) = of_number(case.number) else { continue };
        let mut trial = Trial::new(case.number, effort, stop).on(Device::Gpu);
        run(&mut Bench { gpu, trial: &mut trial })?;
        if trial.stopped() {
            break;
        }
        let rows = trial.into_rows();
        let go_on = on_rows(case, &rows);
        all.extend(rows);
        if !go_on {
            break;
        }
    }
    Ok(all)
}

fn of_number(case: u32) -> Option<fn(&mut Bench) -> Outcome> {
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
        settings: &PathSettings,
        size: u32,
        samples: u32,
    ) -> Result<Film, GpuTraceError> {
        let mut film = Film::new(size, size);
        let trial = &*self.trial;
        tracer.render(&mut film, camera, &(*settings).into(), samples, &|| trial.stopped())?;
        self.trial.count_nonfinite(&film);
        Ok(film)
    }

    /// As [`Bench::film`], by Whitted's method.
    fn whitted_film(
        &mut self,
        (tracer, camera): Seen,
        settings: &WhittedSettings,
        size: u32,
        samples: u32,
    ) -> Result<Film, GpuTraceError> {
        let mut film = Film::new(size, size);
        let trial = &*self.trial;
        tracer.render(&mut film, camera, &(*settings).into(), samples, &|| trial.stopped())?;
        self.trial.count_nonfinite(&film);
        Ok(film)
    }

    /// A picture whose every pixel is `expected`, without noise.
    fn exactly(&mut self, quantity: &str, expected: f64, seen: Seen, settings: &PathSettings) -> Outcome {
        let film = self.film(seen, settings, SIDE, 8)?;
        self.trial.equal(&subject(settings), quantity, expected, farthest(&film, expected), 1e-5);
        Ok(())
    }

    /// As [`Bench::exactly`], by Whitted's method.
    fn whitted_exactly(&mut self, quantity: &str, expected: f64, seen: Seen, settings: &WhittedSettings) -> Outcome {
        let film = self.whitted_film(seen, settings, 8, 4)?;
        self.trial.equal("whitted", quantity, expected, farthest(&film, expected), 1e-5);
        Ok(())
    }

    /// The mean of a picture that sees one thing.
    fn mean(
        &mut self,
        quantity: &str,
        expected: f64,
        seen: Seen,
        settings: &PathSettings,
    ) -> Result<Mean, GpuTraceError> {
        // a density that is off by a twentieth moves a weighted mean by less than a hundredth, and its samples spread
        // little
        let power = if settings.estimator.light == LightSampling::Mis { 0.001 } else { self.trial.power() };
        self.mean_to(power, quantity, expected, seen, settings)
    }

    /// As [`Bench::mean`], to a relative standard error of `power`.
    fn mean_to(
        &mut self,
        power: f64,
        quantity: &str,
        expected: f64,
        seen: Seen,
        settings: &PathSettings,
    ) -> Result<Mean, GpuTraceError> {
        let found = self.mean_of(expected, power, seen, settings)?;
        let measured = (found.mean, found.standard_error);
        self.trial.mean_and_error(&subject(settings), quantity, expected, measured, power);
        Ok(found)
    }

    /// As [`Bench::mean`], by Whitted's method.
    fn whitted_mean(
        &mut self,
        quantity: &str,
        expected: f64,
        (tracer, camera): Seen,
        settings: &WhittedSettings,
    ) -> Outcome {
        let (power, stop) = (self.trial.power(), self.trial.stop_flag());
        let found = self.gathered(expected, power, |film, samples| {
            tracer.render(film, camera, &(*settings).into(), samples, &|| stop.load(Ordering::Relaxed)).map(drop)
        })?;
        self.trial.mean_and_error("whitted", quantity, expected, (found.mean, found.standard_error), power);
        Ok(())
    }

    /// The mean of a picture of as many samples as it takes for a relative standard error of `power`.
    fn mean_of(
        &mut self,
        expected: f64,
        power: f64,
        (tracer, camera): Seen,
        settings: &PathSettings,
    ) -> Result<Mean, GpuTraceError> {
        let stop = self.trial.stop_flag();
        self.gathered(expected, power, |film, samples| {
            tracer.render(film, camera, &(*settings).into(), samples, &|| stop.load(Ordering::Relaxed)).map(drop)
        })
    }

    /// As [`Bench::mean_of`], of a picture to which `render` adds samples.
    fn gathered(
        &mut self,
        expected: f64,
        power: f64,
        mut render: impl FnMut(&mut Film, u32) -> Outcome,
    ) -> Result<Mean, GpuTraceError> {
        let mut film = Film::new(SIDE, SIDE);
        let most = self.trial.pick(4096, 65_536);
        let mut more = 16;
        loop {
            render(&mut film, more)?;
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

fn subject(settings: &PathSettings) -> String {
    format!("path {}", settings.estimator.name())
}
