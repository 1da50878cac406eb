//! What traces: the processor or a graphics device, each with a scene made ready for rays.

use crate::{Accumulation, Device, DeviceFilters};
use gpu::{FaultInjection, Gpu};
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::{FeatureFilm, FeaturePass, Integrator, SamplerKind, Stats, Tracer};
use scene::{Camera, Scene};
use std::sync::atomic::{AtomicBool, Ordering};

/// Seconds that a dispatch may take beside a window: a frame of it waits about that long for the same adapter, and so
/// does a newer job. Where the processor plays the adapter a dispatch costs so much by itself that shorter ones would
/// only add to it.
const BUDGET: f64 = 0.008;
const BUDGET_OF_SOFTWARE: f64 = 0.04;

/// A scene made ready for rays.
pub enum Backend {
    /// The scene made ready on the processor.
    Cpu(Box<Tracer>),
    /// On a graphics device.
    Gpu(Box<GpuBackend>),
}

/// A scene on a graphics device.
pub struct GpuBackend {
    /// What the adapter is called among all of them.
    name: String,
    tracer: GpuTracer,
    /// `None` where the processor filters faster.
    pub(crate) filters: Option<DeviceFilters>,
    fault: Option<FaultInjection>,
}

impl Backend {
    /// A scene on the processor.
    pub fn on_the_processor(scene: &Scene) -> Self {
        Tracer::new(scene).into()
    }

    /// A scene on a graphics device.
    ///
    /// # Errors
    /// If the device can't take the scene.
    pub fn on_the_device(gpu: &Gpu, scene: &Scene) -> Result<Self, GpuTraceError> {
        Ok(GpuTracer::new(gpu, scene)?.into())
    }

    /// A scene on a graphics device of its own, beside a window. The window's would do, but one queue serves first what
    /// came first, so that its frames would wait behind rays, and a device that is lost over rays would take the window
    /// with it.
    ///
    /// # Errors
    /// If there is no such device, or if it can't take the scene.
    pub fn beside_a_window(adapter: &str, scene: &Scene) -> Result<Self, GpuTraceError> {
        let gpu = Gpu::headless_on(adapter)?;
        let mut tracer = GpuTracer::new(&gpu, scene)?;
        tracer.set_budget(if gpu.is_software() { BUDGET_OF_SOFTWARE } else { BUDGET });
        Ok(GpuBackend::new(adapter.to_owned(), tracer).into())
    }

    /// The device that it adds samples on.
    pub fn device(&self) -> Device {
        match self {
            Backend::Cpu(_) => Device::Cpu,
            Backend::Gpu(_) => Device::Gpu,
        }
    }

    /// The adapter's name; `None` of the processor.
    pub fn adapter(&self) -> Option<&str> {
        match self {
            Backend::Cpu(_) => None,
            Backend::Gpu(gpu_backend) => Some(&gpu_backend.name),
        }
    }

    /// Whether it can begin at once: a device may have to compile first.
    pub fn has_compiled(&self, integrator: &Integrator) -> bool {
        match self {
            Backend::Cpu(_) => true,
            Backend::Gpu(gpu_backend) => gpu_backend.tracer.has_compiled(integrator),
        }
    }

    /// The same of features, with these random numbers.
    pub(crate) fn has_compiled_features(&self, sampler: SamplerKind) -> bool {
        match self {
            Backend::Cpu(_) => true,
            Backend::Gpu(gpu_backend) => gpu_backend.tracer.has_compiled_features(sampler),
        }
    }

    /// Whether a device is lost on purpose after a while.
    pub fn fails_on_purpose(&self) -> bool {
        matches!(self, Backend::Gpu(gpu_backend) if gpu_backend.fault.is_some())
    }

    /// Whether a device is timed by the wall's clock: it has none of its own, or one that was wrong.
    pub fn is_timed_by_the_wall(&self) -> bool {
        matches!(self, Backend::Gpu(gpu_backend) if !gpu_backend.tracer.has_a_clock())
    }

    /// Seconds of a device's own clock that tracing has taken since the last call; `None` of the processor.
    pub fn take_device_seconds(&mut self) -> Option<f64> {
        match self {
            Backend::Cpu(_) => None,
            Backend::Gpu(gpu_backend) => Some(gpu_backend.tracer.take_seconds()),
        }
    }

    /// Adds `samples` to every pixel, unless `stop` says so; returns how many it took in all. A pass that was stopped
    /// is completed by the next one. The processor does it on the current pool.
    ///
    /// # Errors
    /// If the device fails; what it has added since the film was last read is then lost.
    pub fn accumulate(
        &mut self,
        accumulation: &mut Accumulation,
        camera: &Camera,
        integrator: &Integrator,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Result<u64, GpuTraceError> {
        let until = accumulation.spp.saturating_add(samples);
        accumulation.begin_pass(self.maker(), until);
        match self {
            Backend::Cpu(tracer) => {
                // what has said so once may not say so again: a hold that ended meanwhile
                let stopped = AtomicBool::new(false);
                let stop = || {
                    stop() && {
                        stopped.store(true, Ordering::Relaxed);
                        true
                    }
                };
                let stats = tracer.render(&mut accumulation.film, camera, integrator, samples, &stop);
                accumulation.stats = accumulation.stats.plus(stats);
                accumulation.is_read();
                let is_whole = !stopped.load(Ordering::Relaxed);
                let counted = accumulation.film.samples_per_pixel();
                accumulation.spp = if is_whole { until } else { accumulation.own(counted) };
                Ok(stats.samples)
            }
            Backend::Gpu(gpu_backend) => gpu_backend.accumulate(accumulation, camera, integrator, until, stop),
        }
    }

    /// Adds samples to what is known of pixels, unless `stop` says so. The processor does it on the current pool.
    ///
    /// # Errors
    /// If the device fails; what there was stays.
    pub(crate) fn add_features(
        &mut self,
        film: &mut FeatureFilm,
        pass: &FeaturePass,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Result<Stats, GpuTraceError> {
        match self {
            Backend::Cpu(tracer) => Ok(tracer.add_features(film, pass, stop)),
            Backend::Gpu(gpu_backend) => gpu_backend.add_features(film, pass, stop),
        }
    }

    /// Who makes what it adds: an adapter's name, or how many threads the current pool has.
    pub(crate) fn maker(&self) -> String {
        self.adapter().map_or_else(threads_name, str::to_owned)
    }

    /// Brings what a device has added into the film.
    ///
    /// # Errors
    /// If the device fails.
    pub fn resolve(&self, accumulation: &mut Accumulation) -> Result<(), GpuTraceError> {
        match self {
            Backend::Cpu(_) => Ok(()),
            Backend::Gpu(gpu_backend) => accumulation.read(gpu_backend.tracer.gpu()),
        }
    }

    /// Takes a film off the device, as far as that still gives it back.
    pub fn release(&self, accumulation: &mut Accumulation) {
        // what a failed device does not give back is lost, and made again
        let _ = self.resolve(accumulation);
        accumulation.forget_the_device();
    }

    /// Lets go of a device that has failed.
    pub(crate) fn abandon(self, fault: &GpuTraceError) {
        if matches!(fault, GpuTraceError::Hangs(_)) {
            // to let go of a device that does not answer is to wait for its answer
            std::mem::forget(self);
        }
    }
}

/// What the current pool is called.
pub(crate) fn threads_name() -> String {
    let threads = rayon::current_num_threads();
    if threads == 1 { "1 thread".into() } else { format!("{threads} threads") }
}

impl From<Tracer> for Backend {
    fn from(tracer: Tracer) -> Self {
        Backend::Cpu(Box::new(tracer))
    }
}

impl From<GpuTracer> for Backend {
    fn from(tracer: GpuTracer) -> Self {
        GpuBackend::new(tracer.gpu().describe(), tracer).into()
    }
}

impl From<GpuBackend> for Backend {
    fn from(backend: GpuBackend) -> Self {
        Backend::Gpu(Box::new(backend))
    }
}

impl GpuBackend {
    fn new(name: String, tracer: GpuTracer) -> Self {
        let (filters, fault) = (DeviceFilters::of(tracer.gpu()), FaultInjection::of_rays());
        GpuBackend { name, tracer, filters, fault }
    }

    /// Filters that run on it; `None` where the processor filters faster.
    pub fn filters(&self) -> Option<&DeviceFilters> {
        self.filters.as_ref()
    }

    /// What the adapter is called among all of them.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Takes another scene. What is compiled stays where it does for that one too.
    ///
    /// # Errors
    /// If the device can't take it.
    pub fn take_scene(&mut self, scene: &Scene) -> Result<(), GpuTraceError> {
        self.tracer.set_scene(scene)
    }

    fn accumulate(
        &mut self,
        accumulation: &mut Accumulation,
        camera: &Camera,
        integrator: &Integrator,
        until: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<u64, GpuTraceError> {
        let GpuBackend { tracer, fault, .. } = self;
        let end = accumulation.end_of(until);
        let film = accumulation.on_device(tracer)?;
        let (before, pixels) = (film.samples_per_pixel(), u64::from(film.width()) * u64::from(film.height()));
        let gpu = tracer.gpu().clone();
        tracer.accumulate(film, camera, integrator, end, &counting(fault.as_ref(), &gpu, stop))?;
        let counted = film.samples_per_pixel();
        accumulation.spp = accumulation.own(counted);
        Ok(pixels * u64::from(counted - before))
    }

    fn add_features(
        &mut self,
        film: &mut FeatureFilm,
        pass: &FeaturePass,
        stop: &impl Fn() -> bool,
    ) -> Result<Stats, GpuTraceError> {
        let GpuBackend { tracer, fault, .. } = self;
        let gpu = tracer.gpu().clone();
        tracer.add_features(film, pass, &counting(fault.as_ref(), &gpu, stop))
    }
}

/// What is asked between dispatches, which counts them for who loses the device on purpose.
fn counting(fault: Option<&FaultInjection>, gpu: &Gpu, stop: &impl Fn() -> bool) -> impl Fn() -> bool {
    move || {
        fault.iter().for_each(|fault| fault.count(gpu));
        stop()
    }
}
