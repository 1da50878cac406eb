//! What traces a pane's rays, the processor or the graphics device, and the films that either adds samples to.

use super::rays::RayJob;
use crate::fuse::Fuse;
use crate::technique::{Machine, Method};
use gpu::Gpu;
use pathtrace::Tracer;
use pathtrace::gpu::{Choice, GpuFilm, GpuTraceError, GpuTracer};
use scene::{Film, Scene};

/// Seconds that a dispatch may take: a frame of the window waits about that long for the same adapter, and so does a newer
/// job. Where the processor plays the adapter a dispatch costs so much by itself that shorter ones would only add to it.
const BUDGET: f64 = 0.008;
const BUDGET_OF_SOFTWARE: f64 = 0.04;

/// A scene made ready for rays.
pub enum Kernel {
    /// On the processor.
    Cpu(Box<Tracer>),
    /// On the graphics device.
    Gpu(Box<Card>),
}

/// A scene on a graphics device.
pub struct Card {
    /// What the adapter is called among all of them.
    name: String,
    tracer: GpuTracer,
    fuse: Option<Fuse>,
}

/// A film, and what a device has added to it.
pub struct Plate {
    /// The film as last developed.
    film: Film,
    /// Samples that every pixel has, on the device too.
    spp: u32,
    /// Samples that a pixel may have at most: a pass that was stopped leaves some with more than others.
    most: u32,
    on_device: Option<GpuFilm>,
    /// What has added to it, one after the other.
    makers: Vec<String>,
    /// How many of them have added to the film as last developed.
    developed_by: usize,
}

impl Kernel {
    /// A scene on the processor.
    pub fn on_the_processor(scene: &Scene) -> Self {
        Kernel::Cpu(Box::new(Tracer::new(scene)))
    }

    /// A scene on a graphics device of its own. The window's would do, but one queue serves first what came first, so that
    /// its frames would wait behind rays, and a device that is lost over rays would take the window with it.
    ///
    /// # Errors
    /// If there is no such device, or if it can't take the scene.
    pub fn on_the_device(adapter: &str, scene: &Scene) -> Result<Self, GpuTraceError> {
        let gpu = Gpu::headless_on(adapter)?;
        let mut tracer = GpuTracer::new(&gpu, scene)?;
        tracer.set_budget(if gpu.is_software() { BUDGET_OF_SOFTWARE } else { BUDGET });
        Ok(Kernel::Gpu(Box::new(Card { name: adapter.to_owned(), tracer, fuse: Fuse::of_rays() })))
    }

    /// The machine.
    pub fn machine(&self) -> Machine {
        match self {
            Kernel::Cpu(_) => Machine::Cpu,
            Kernel::Gpu(_) => Machine::Gpu,
        }
    }

    /// The adapter's name, or how many threads there are.
    pub fn adapter(&self) -> String {
        match self {
            Kernel::Cpu(_) => format!("{} threads", rayon::current_num_threads()),
            Kernel::Gpu(card) => card.name.clone(),
        }
    }

    /// Whether it can begin at once: a device may have to compile first.
    pub fn has_compiled(&self, method: &Method) -> bool {
        match (self, method) {
            (Kernel::Cpu(_), _) => true,
            (Kernel::Gpu(card), Method::Path(path)) => card.tracer.has_compiled(Choice::of_paths(path)),
            (Kernel::Gpu(card), Method::Whitted(tree)) => card.tracer.has_compiled(Choice::of_trees(tree)),
        }
    }

    /// Adds `samples` to every pixel, unless `stop` says so; returns how many it took in all. A pass that was stopped is
    /// completed by the next one.
    ///
    /// # Errors
    /// If the device fails; the plate is then as it was when it was last developed.
    pub fn expose(
        &mut self,
        plate: &mut Plate,
        job: &RayJob,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Result<u64, GpuTraceError> {
        let until = plate.spp + samples;
        plate.most = plate.most.max(until);
        let maker = self.adapter();
        if plate.makers.last() != Some(&maker) {
            plate.makers.push(maker);
        }
        match self {
            Kernel::Cpu(tracer) => {
                let stats = job.settings.render(tracer, &mut plate.film, job.order.camera(), samples, stop);
                plate.developed_by = plate.makers.len();
                if !stop() {
                    plate.spp = until;
                }
                Ok(stats.samples)
            }
            Kernel::Gpu(card) => card.expose(plate, job, until, stop),
        }
    }

    /// Brings what a device has added into the film.
    ///
    /// # Errors
    /// If the device fails.
    pub fn develop(&self, plate: &mut Plate) -> Result<(), GpuTraceError> {
        if let (Kernel::Gpu(card), Some(on_device)) = (self, &mut plate.on_device) {
            plate.film = on_device.read(card.tracer.gpu())?.0;
            plate.developed_by = plate.makers.len();
        }
        Ok(())
    }

    /// Takes a film off the device, as far as that still gives it back.
    pub fn release(&self, plate: &mut Plate) {
        // what a failed device does not give back is lost, and made again
        let _ = self.develop(plate);
        plate.forget_the_device();
    }
}

impl Card {
    /// Takes another scene. What is compiled stays where it does for that one too.
    ///
    /// # Errors
    /// If the device can't take it.
    pub fn take_scene(&mut self, scene: &Scene) -> Result<(), GpuTraceError> {
        self.tracer.set_scene(scene)
    }

    fn expose(
        &mut self,
        plate: &mut Plate,
        job: &RayJob,
        until: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<u64, GpuTraceError> {
        let Card { tracer, fuse, .. } = self;
        let film = match plate.on_device.take() {
            Some(film) => film,
            None => tracer.film(plate.film.clone())?,
        };
        let film = plate.on_device.insert(film);
        let before = film.samples_per_pixel();
        let gpu = tracer.gpu().clone();
        let stop = || {
            fuse.iter().for_each(|fuse| fuse.burn(&gpu));
            stop()
        };
        match &job.settings.method {
            Method::Path(path) => tracer.expose(film, job.order.camera(), path, until, &stop)?,
            Method::Whitted(tree) => tracer.expose_whitted(film, job.order.camera(), tree, until, &stop)?,
        }
        plate.spp = film.samples_per_pixel();
        let pixels = u64::from(film.width()) * u64::from(film.height());
        Ok(pixels * u64::from(plate.spp - before))
    }
}

impl Plate {
    /// A film without light; `None` if there is no memory for it.
    pub fn blank(width: u32, height: u32) -> Option<Self> {
        let film = Film::try_new(width, height)?;
        Some(Plate { film, spp: 0, most: 0, on_device: None, makers: Vec::new(), developed_by: 0 })
    }

    /// The film as last developed.
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

    /// Goes on from the film as last developed.
    pub fn forget_the_device(&mut self) {
        self.makers.truncate(self.developed_by);
        if self.on_device.take().is_some() {
            self.spp = self.film.samples_per_pixel();
        }
    }
}
