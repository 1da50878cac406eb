//! What traces a pane's rays, the processor or the graphics device, and the films that either adds samples to.

use super::rays::RayJob;
use film::Film;
use gpu::FaultInjection;
use gpu::Gpu;
use pathtrace::gpu::{GpuFilm, GpuTraceError, GpuTracer};
use pathtrace::{Integrator, Tracer};
use scene::Scene;
use technique::Device;

/// Seconds that a dispatch may take: a frame of the window waits about that long for the same adapter, and so does a
/// newer job. Where the processor plays the adapter a dispatch costs so much by itself that shorter ones would only add
/// to it.
const BUDGET: f64 = 0.008;
const BUDGET_OF_SOFTWARE: f64 = 0.04;

/// A scene made ready for rays.
pub enum Backend {
    /// On the processor.
    Cpu(Box<Tracer>),
    /// On the graphics device.
    Gpu(Box<GpuBackend>),
}

/// A scene on a graphics device.
pub struct GpuBackend {
    /// What the adapter is called among all of them.
    name: String,
    tracer: GpuTracer,
    fault: Option<FaultInjection>,
}

/// A film, and what a device has added to it.
pub struct Accumulation {
    /// The film as last frame.
    film: Film,
    /// Samples that every pixel has, on the device too.
    spp: u32,
    /// Samples that a pixel may have at most: a pass that was stopped leaves some with more than others.
    most: u32,
    on_device: Option<GpuFilm>,
    /// What has added to it, one after the other.
    makers: Vec<String>,
    /// How many of them have added to the film as last frame.
    resolved_by: usize,
}

impl Backend {
    /// A scene on the processor.
    pub fn on_the_processor(scene: &Scene) -> Self {
        Backend::Cpu(Box::new(Tracer::new(scene)))
    }

    /// A scene on a graphics device of its own. The window's would do, but one queue serves first what came first, so
    /// that its frames would wait behind rays, and a device that is lost over rays would take the window with it.
    ///
    /// # Errors
    /// If there is no such device, or if it can't take the scene.
    pub fn on_the_device(adapter: &str, scene: &Scene) -> Result<Self, GpuTraceError> {
        let gpu = Gpu::headless_on(adapter)?;
        let mut tracer = GpuTracer::new(&gpu, scene)?;
        tracer.set_budget(if gpu.is_software() { BUDGET_OF_SOFTWARE } else { BUDGET });
        Ok(Backend::Gpu(Box::new(GpuBackend { name: adapter.to_owned(), tracer, fault: FaultInjection::of_rays() })))
    }

    /// The machine.
    pub fn machine(&self) -> Device {
        match self {
            Backend::Cpu(_) => Device::Cpu,
            Backend::Gpu(_) => Device::Gpu,
        }
    }

    /// The adapter's name, or how many threads there are.
    pub fn adapter(&self) -> String {
        match self {
            Backend::Cpu(_) => format!("{} threads", rayon::current_num_threads()),
            Backend::Gpu(gpu_backend) => gpu_backend.name.clone(),
        }
    }

    /// Whether it can begin at once: a device may have to compile first.
    pub fn has_compiled(&self, integrator: &Integrator) -> bool {
        match self {
            Backend::Cpu(_) => true,
            Backend::Gpu(gpu_backend) => gpu_backend.tracer.has_compiled(integrator),
        }
    }

    /// Adds `samples` to every pixel, unless `stop` says so; returns how many it took in all. A pass that was stopped
    /// is completed by the next one.
    ///
    /// # Errors
    /// If the device fails; the accumulation is then as it was when it was last frame.
    pub fn accumulate(
        &mut self,
        accumulation: &mut Accumulation,
        job: &RayJob,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Result<u64, GpuTraceError> {
        let until = accumulation.spp + samples;
        accumulation.most = accumulation.most.max(until);
        let maker = self.adapter();
        if accumulation.makers.last() != Some(&maker) {
            accumulation.makers.push(maker);
        }
        match self {
            Backend::Cpu(tracer) => {
                let stats =
                    tracer.render(&mut accumulation.film, job.order.camera(), &job.settings.integrator, samples, stop);
                accumulation.resolved_by = accumulation.makers.len();
                if !stop() {
                    accumulation.spp = until;
                }
                Ok(stats.samples)
            }
            Backend::Gpu(gpu_backend) => gpu_backend.accumulate(accumulation, job, until, stop),
        }
    }

    /// Brings what a device has added into the film.
    ///
    /// # Errors
    /// If the device fails.
    pub fn resolve(&self, accumulation: &mut Accumulation) -> Result<(), GpuTraceError> {
        if let (Backend::Gpu(gpu_backend), Some(on_device)) = (self, &mut accumulation.on_device) {
            accumulation.film = on_device.read(gpu_backend.tracer.gpu())?.0;
            accumulation.resolved_by = accumulation.makers.len();
        }
        Ok(())
    }

    /// Takes a film off the device, as far as that still gives it back.
    pub fn release(&self, accumulation: &mut Accumulation) {
        // what a failed device does not give back is lost, and made again
        let _ = self.resolve(accumulation);
        accumulation.forget_the_device();
    }
}

impl GpuBackend {
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
        job: &RayJob,
        until: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<u64, GpuTraceError> {
        let GpuBackend { tracer, fault, .. } = self;
        let film = match accumulation.on_device.take() {
            Some(film) => film,
            None => tracer.film(accumulation.film.clone())?,
        };
        let film = accumulation.on_device.insert(film);
        let before = film.samples_per_pixel();
        let gpu = tracer.gpu().clone();
        let stop = || {
            fault.iter().for_each(|fault| fault.count(&gpu));
            stop()
        };
        tracer.accumulate(film, job.order.camera(), &job.settings.integrator, until, &stop)?;
        accumulation.spp = film.samples_per_pixel();
        let pixels = u64::from(film.width()) * u64::from(film.height());
        Ok(pixels * u64::from(accumulation.spp - before))
    }
}

impl Accumulation {
    /// A film without light; `None` if there is no memory for it.
    pub fn blank(width: u32, height: u32) -> Option<Self> {
        let film = Film::try_new(width, height)?;
        Some(Accumulation { film, spp: 0, most: 0, on_device: None, makers: Vec::new(), resolved_by: 0 })
    }

    /// The film as last frame.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// Samples that every pixel has.
    pub fn spp(&self) -> u32 {
        self.spp
    }

    /// Samples that a pixel may have at most.
    pub fn most(&self) -> u32 {
        self.most
    }

    /// What has made it: an adapter's name, or how many threads; both where one took over.
    pub fn made_by(&self) -> String {
        self.makers.join(", then ")
    }

    /// Goes on from the film as last frame.
    pub fn forget_the_device(&mut self) {
        self.makers.truncate(self.resolved_by);
        if self.on_device.take().is_some() {
            self.spp = self.film.samples_per_pixel();
        }
    }
}
