//! Tracing rays without a window, on either machine: the processor takes over from a graphics device that fails, and
//! goes on from the last film that came back.

use anyhow::Context;
use film::Film;
use gpu::FaultInjection;
use gpu::Gpu;
use pathtrace::gpu::{GpuFilm, GpuTraceError, GpuTracer};
use pathtrace::{Stats, Tracer};
use scene::Scene;
use std::time::{Duration, Instant};
use technique::{Device, DeviceChoice, TracedSettings};

/// Samples that are not worth opening a graphics device for: a second of an ordinary processor.
const LITTLE_WORK: u64 = 1 << 24;

/// How long a device may work on what nobody has read yet.
const AT_RISK: Duration = Duration::from_secs(5);

const INSTEAD: &str = "the graphics device does not trace this; --device cpu does";

/// The graphics device that is to trace so many samples; `None` for the processor.
///
/// # Errors
/// If the user wants one and there is none.
pub fn device_for(wish: DeviceChoice, samples: u64) -> anyhow::Result<Option<Gpu>> {
    let there_is_hardware = || Gpu::adapters().iter().any(|adapter| adapter.chosen && !adapter.software);
    match wish {
        DeviceChoice::Gpu => Gpu::headless().context(INSTEAD).map(Some),
        // what does not open is not faster
        _ if is_for_a_device(wish, samples, there_is_hardware) => Ok(Gpu::headless().ok()),
        _ => Ok(None),
    }
}

/// Where the processor plays the device it is faster as itself, and also where there is little to do.
fn is_for_a_device(wish: DeviceChoice, samples: u64, there_is_hardware: impl FnOnce() -> bool) -> bool {
    match wish {
        DeviceChoice::Cpu => false,
        DeviceChoice::Gpu => true,
        DeviceChoice::Auto => samples >= LITTLE_WORK && there_is_hardware(),
    }
}

/// A film on its way.
pub struct Tracing<'a> {
    scene: &'a Scene,
    rays: TracedSettings,
    on: On,
    /// What has added to it, one after the other.
    makers: Vec<String>,
}

enum On {
    Processor { tracer: Box<Tracer>, film: Film, stats: Stats, spp: u32 },
    Gpu(Box<OnDevice>),
}

struct OnDevice {
    tracer: GpuTracer,
    film: GpuFilm,
    /// As last read.
    read: (Film, Stats),
    read_at: Instant,
    fault: Option<FaultInjection>,
}

/// A film that is done.
pub struct Traced {
    pub film: Film,
    pub stats: Stats,
    /// What it was made by in the end.
    pub device: Device,
    /// Names of all that has made it.
    pub adapter: String,
}

impl<'a> Tracing<'a> {
    /// Makes the scene ready. What a device refuses the processor traces, unless `wish` is the device.
    ///
    /// # Errors
    /// If the device that the user wants can't take it.
    pub fn begin(
        gpu: Option<Gpu>,
        scene: &'a Scene,
        rays: TracedSettings,
        film: Film,
        wish: DeviceChoice,
    ) -> anyhow::Result<Self> {
        let on_device = gpu.map(|gpu| OnDevice::new(&gpu, scene, film.clone()).map(|on| (on, gpu.describe())));
        let (on, maker) = match on_device {
            Some(Ok((on, name))) => (On::Gpu(Box::new(on)), name),
            Some(Err(fault)) if wish == DeviceChoice::Gpu => return Err(fault).context(INSTEAD),
            Some(Err(fault)) => {
                note!("note: the processor traces this, the graphics device does not: {fault}");
                (On::processor(scene, film, Stats::default()), threads())
            }
            None => (On::processor(scene, film, Stats::default()), threads()),
        };
        Ok(Tracing { scene, rays, on, makers: vec![maker] })
    }

    /// Samples that every pixel has.
    pub fn spp(&self) -> u32 {
        match &self.on {
            On::Processor { spp, .. } => *spp,
            On::Gpu(on) => on.film.samples_per_pixel(),
        }
    }

    /// What traces now.
    pub fn device(&self) -> Device {
        match self.on {
            On::Processor { .. } => Device::Cpu,
            On::Gpu(_) => Device::Gpu,
        }
    }

    /// Adds samples to every pixel, unless the device fails: then the processor stands where the film was last read.
    pub fn add(&mut self, samples: u32) {
        match &mut self.on {
            On::Processor { tracer, film, stats, spp } => {
                *stats = stats.plus(tracer.render(film, &self.scene.camera, &self.rays.integrator, samples, &|| false));
                *spp += samples;
            }
            On::Gpu(on) => {
                if let Err(fault) = on.add(self.scene, &self.rays, samples) {
                    self.take_over(&fault);
                }
            }
        }
    }

    /// Brings home what the device has done. If it fails the processor takes over as in [`Tracing::add`].
    pub fn read(&mut self) {
        if let On::Gpu(on) = &mut self.on
            && let Err(fault) = on.read()
        {
            self.take_over(&fault);
        }
    }

    /// The film, as last read.
    pub fn finish(self) -> Traced {
        let (device, adapter) = (self.device(), self.makers.join(", then "));
        match self.on {
            On::Processor { film, stats, .. } => Traced { film, stats, device, adapter },
            On::Gpu(on) => Traced { film: on.read.0, stats: on.read.1, device, adapter },
        }
    }

    fn take_over(&mut self, fault: &GpuTraceError) {
        let On::Gpu(on) = &mut self.on else { return };
        let (film, stats) = std::mem::replace(&mut on.read, (Film::new(1, 1), Stats::default()));
        let spp = film.samples_per_pixel();
        let failed = std::mem::replace(&mut self.on, On::processor(self.scene, film, stats));
        if matches!(fault, GpuTraceError::Hangs(_)) {
            // to let go of a device that does not answer is to wait for its answer
            std::mem::forget(failed);
        }
        note!("note: the processor goes on from {spp} spp, the graphics device failed: {fault}");
        if spp == 0 {
            self.makers.clear();
        }
        self.makers.push(threads());
    }
}

impl On {
    fn processor(scene: &Scene, film: Film, stats: Stats) -> Self {
        let spp = film.samples_per_pixel();
        On::Processor { tracer: Box::new(Tracer::new(scene)), film, stats, spp }
    }
}

impl OnDevice {
    fn new(gpu: &Gpu, scene: &Scene, film: Film) -> Result<Self, GpuTraceError> {
        let tracer = GpuTracer::new(gpu, scene)?;
        Ok(OnDevice {
            film: tracer.film(film.clone())?,
            tracer,
            read: (film, Stats::default()),
            read_at: Instant::now(),
            fault: FaultInjection::of_rays(),
        })
    }

    fn add(&mut self, scene: &Scene, rays: &TracedSettings, samples: u32) -> Result<(), GpuTraceError> {
        let OnDevice { tracer, film, fault, .. } = self;
        let until = film.samples_per_pixel() + samples;
        let gpu = tracer.gpu().clone();
        let stop = || {
            fault.iter().for_each(|fault| fault.count(&gpu));
            false
        };
        tracer.accumulate(film, &scene.camera, &rays.integrator, until, &stop)?;
        // a test does not wait for seconds
        if self.read_at.elapsed() > AT_RISK || self.fault.is_some() {
            self.read()?;
        }
        Ok(())
    }

    fn read(&mut self) -> Result<(), GpuTraceError> {
        self.read = self.film.read(self.tracer.gpu())?;
        self.read_at = Instant::now();
        Ok(())
    }
}

fn threads() -> String {
    format!("{} threads", rayon::current_num_threads())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn auto_takes_hardware_where_there_is_enough_to_do() {
        let of = |wish, samples, hardware| is_for_a_device(wish, samples, || hardware);
        assert!(of(DeviceChoice::Auto, LITTLE_WORK, true) && !of(DeviceChoice::Auto, LITTLE_WORK - 1, true));
        assert!(!of(DeviceChoice::Auto, u64::MAX, false));
        assert!(of(DeviceChoice::Gpu, 0, false) && !of(DeviceChoice::Cpu, u64::MAX, true));
    }
}
