//! How a picture of rays comes about: a rough one at once, then ever more samples, until the wished number or a new job. A
//! graphics device that fails is replaced by the processor, which goes on from the last film that came back.

use super::darkroom::Darkroom;
use super::kernel::{Kernel, Plate};
use super::rays::{Gate, RayJob, Stop};
use super::{Order, Picture, Side};
use crate::technique::{Adapters, Machine};
use pathtrace::gpu::GpuTraceError;
use scene::{Geometry, Scene, Shape};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time that a job may go on after a newer one came, if it has not shown anything yet: else a drag would never show
/// anything.
const GRACE: Duration = Duration::from_millis(80);
/// Time that a rough picture may take: with the two frames of the window around it, it shall be on the screen within a
/// tenth of a second.
const ROUGH: Duration = Duration::from_millis(20);
/// A full picture that takes no longer than this needs no rough one before it.
const AT_ONCE: Duration = Duration::from_millis(30);
/// Least and most time between two pictures once the resolution is full: an eighth of the time spent so far, because
/// showing costs too, and a picture changes ever less.
const REFRESH: [Duration; 2] = [Duration::from_millis(150), Duration::from_secs(1)];

/// Triangles that take the processor a tenth of a second to make ready.
const LARGE: usize = 100_000;

/// Films that are kept beside the one in hand: one to come back to.
const MOST_KEPT: usize = 2;

/// A film and what has gone into it.
struct Exposed {
    plate: Plate,
    spent: Duration,
    /// The job it belongs to; its wished number of samples may grow.
    job: RayJob,
}

/// Why the graphics device is not used, and until when.
struct Refusal {
    why: Arc<str>,
    source: String,
    restarts: u64,
}

/// The one who paints.
pub struct Painter {
    side: Side,
    /// What can trace rays beside the processor.
    adapters: Adapters,
    darkroom: Arc<Darkroom>,
    gate: Arc<Gate>,
    /// The scene of the last job, ready for rays.
    ready: Option<(Arc<Scene>, Kernel)>,
    refusal: Option<Refusal>,
    /// The films of the last jobs, the latest last.
    kept: Vec<Exposed>,
    /// Measured on the last job of each machine: what one sample of one pixel costs.
    seconds_per_sample: [f64; 2],
    /// When the job in hand was begun.
    begun: Instant,
}

impl Painter {
    /// A painter for one side.
    pub fn new(side: Side, adapters: Adapters, darkroom: Arc<Darkroom>, gate: Arc<Gate>) -> Self {
        Painter {
            side,
            adapters,
            darkroom,
            gate,
            ready: None,
            refusal: None,
            kept: Vec::new(),
            seconds_per_sample: [1e-6; 2],
            begun: Instant::now(),
        }
    }

    /// Makes a picture as far as it gets.
    pub fn paint(&mut self, job: &RayJob, stop: &Stop) {
        self.begun = Instant::now();
        let kept = self.best_kept(job);
        let mut rough = kept.is_none();
        let mut kernel = self.make_ready(job, &mut rough, stop);
        let exposed = match kept {
            Some(exposed) => Some(Exposed { job: job.clone(), ..exposed }),
            None => {
                if rough {
                    self.rough_by_whoever_is_ready(&mut kernel, job, stop);
                }
                if stop.now() { None } else { self.blank(job) }
            }
        };
        let exposed = exposed.map(|exposed| self.refine(&mut kernel, exposed, stop));
        self.kept.extend(exposed.filter(|exposed| exposed.plate.spp() > 0));
        if self.kept.len() > MOST_KEPT {
            self.kept.remove(0);
        }
        self.ready = Some((job.order.scene.clone(), kernel));
    }

    /// The scene on the machine that the job wants, or on the processor. Where that takes its time and a `rough` picture is
    /// wanted, it is shown before.
    fn make_ready(&mut self, job: &RayJob, rough: &mut bool, stop: &Stop) -> Kernel {
        let scene = &job.order.scene;
        let machine = self.machine_for(job);
        let adapter = self.adapter_for(job);
        let before = self.ready.take();
        if let Some((of, kernel)) = before {
            let same_scene = Arc::ptr_eq(&of, scene);
            let same_device = machine == Machine::Cpu || kernel.adapter() == adapter;
            if same_scene && kernel.machine() == machine && same_device {
                return kernel;
            }
            if !same_scene {
                self.kept.clear();
            }
            self.kept.iter_mut().for_each(|exposed| kernel.release(&mut exposed.plate));
            if let (Kernel::Gpu(mut card), Machine::Gpu, true) = (kernel, machine, same_device) {
                match card.take_scene(scene) {
                    Ok(()) => return Kernel::Gpu(card),
                    Err(fault) => self.refuse(job, &fault),
                }
                return Kernel::on_the_processor(scene);
            }
        }
        let mut processor = Kernel::on_the_processor(scene);
        if machine == Machine::Cpu {
            return processor;
        }
        // a device takes its time to open and to compile
        if std::mem::take(rough) {
            self.rough(&mut processor, job, stop);
        }
        match Kernel::on_the_device(&adapter, scene) {
            Ok(kernel) => return kernel,
            Err(fault) => self.refuse(job, &fault),
        }
        processor
    }

    /// The machine that the job wants, unless that has failed at this scene and nobody has asked to try again.
    fn machine_for(&mut self, job: &RayJob) -> Machine {
        let wish = job.settings.device.beside(self.adapters.only_software());
        let Order { restarts, provenance, .. } = &job.order;
        let stands = |of: &Refusal| of.source == provenance.source && of.restarts == *restarts;
        self.refusal.take_if(|refusal| wish == Machine::Cpu || !stands(refusal));
        if self.refusal.is_some() { Machine::Cpu } else { wish }
    }

    /// The name of the adapter that the job wants; without any, one that is not there.
    fn adapter_for(&self, job: &RayJob) -> String {
        let adapters = &self.adapters.0;
        let chosen = adapters.get(usize::from(job.settings.adapter)).or(adapters.first());
        chosen.map_or_else(|| "of any kind".into(), |adapter| adapter.name.clone())
    }

    fn refuse(&mut self, job: &RayJob, fault: &GpuTraceError) {
        let (why, source) = (fault.to_string().into(), job.order.provenance.source.clone());
        self.refusal = Some(Refusal { why, source, restarts: job.order.restarts });
    }

    /// The processor takes over from a device that has failed.
    fn replace(&mut self, kernel: &mut Kernel, plate: &mut Plate, job: &RayJob, fault: &GpuTraceError) {
        self.refuse(job, fault);
        let failed = std::mem::replace(kernel, Kernel::on_the_processor(&job.order.scene));
        if matches!(fault, GpuTraceError::Hangs(_)) {
            // to let go of a device that does not answer is to wait for its answer
            std::mem::forget(failed);
        }
        self.kept.iter_mut().map(|exposed| &mut exposed.plate).chain([plate]).for_each(Plate::forget_the_device);
    }

    /// The kept film that is nearest to what `job` asks for, of the same picture.
    fn best_kept(&mut self, job: &RayJob) -> Option<Exposed> {
        let serves = |exposed: &Exposed| same_picture(&exposed.job, job) && exposed.plate.most() <= job.settings.spp;
        let serving = self.kept.iter().enumerate().filter(|(_, exposed)| serves(exposed));
        let (index, _) = serving.max_by_key(|(_, exposed)| exposed.plate.spp())?;
        Some(self.kept.remove(index))
    }

    /// A film without light, or a word that there is no memory for it.
    fn blank(&self, job: &RayJob) -> Option<Exposed> {
        let (width, height) = job.order.size();
        let plate = Plate::blank(width, height);
        if plate.is_none() {
            let fault = format!("not enough memory for {width} x {height} pixels; make the window smaller");
            self.darkroom.report(self.side, job.order.clone(), fault);
        }
        plate.map(|plate| Exposed { plate, spent: Duration::ZERO, job: job.clone() })
    }

    /// Rough pictures by the processor where the device has to compile first, which takes longer than anyone should look at
    /// the last picture.
    fn rough_by_whoever_is_ready(&mut self, kernel: &mut Kernel, job: &RayJob, stop: &Stop) {
        let triangles = |shape: &Shape| match &shape.geometry {
            Geometry::Mesh { triangles, .. } => triangles.len(),
            _ => 0,
        };
        // where the processor would take as long to make the scene ready, nothing is won
        let large = job.order.scene.shapes.iter().map(triangles).sum::<usize>() > LARGE;
        if large || kernel.has_compiled(&job.settings.method) {
            self.rough(kernel, job, stop);
        } else {
            self.rough(&mut Kernel::on_the_processor(&job.order.scene), job, stop);
        }
    }

    /// Pictures of an eighth, a quarter and half the resolution, beginning with the finest that is ready in time.
    fn rough(&mut self, kernel: &mut Kernel, job: &RayJob, stop: &Stop) {
        let (width, height) = job.order.size();
        let pixels = f64::from(width) * f64::from(height);
        let mut shown = false;
        for shrink in [8, 4, 2] {
            // it may be another machine's from one to the next
            let per_sample = self.seconds_per_sample[kernel.machine() as usize];
            let (pixels, finer) = (pixels / f64::from(shrink * shrink), pixels / f64::from(shrink * shrink / 4));
            let patience = if shrink == 2 { AT_ONCE } else { ROUGH };
            if finer * per_sample <= patience.as_secs_f64() {
                continue;
            }
            let fitting = ROUGH.as_secs_f64() / (pixels * per_sample);
            let samples = (fitting as u32).clamp(1, job.settings.spp.min(16));
            let Some(mut plate) = Plate::blank(width.div_ceil(shrink), height.div_ceil(shrink)) else { return };
            let start = Instant::now();
            let (begun, first) = (self.begun, !shown);
            let stop = || stop.now() && !(first && begun.elapsed() < GRACE);
            self.expose(kernel, &mut plate, job, samples, &stop);
            if stop() {
                return;
            }
            self.develop(kernel, &mut plate, job);
            // a device that has failed leaves nothing
            if plate.spp() > 0 {
                self.deliver(kernel, &plate, job, start.elapsed(), [true, true]);
                shown = true;
            }
        }
    }

    /// Adds samples up to the wished number, or as many as there is time for. A pass that was stopped in the middle is
    /// completed by the next one.
    fn refine(&mut self, kernel: &mut Kernel, mut exposed: Exposed, stop: &Stop) -> Exposed {
        let wished = exposed.job.settings.spp;
        let gate = self.gate.clone();
        let mut shown = Instant::now();
        // a film that goes on is shown at once, for the label says how far it shall go
        if exposed.plate.spp() > 0 {
            self.show(kernel, &mut exposed);
        }
        while exposed.plate.spp() < wished {
            let before = exposed.plate.spp();
            // while held, a new picture still gets its first pass
            if before > 0 && gate.is_held() {
                self.show(kernel, &mut exposed);
                gate.pass(stop);
            }
            if stop.soon() {
                break;
            }
            let start = Instant::now();
            let per_sample = self.seconds_per_sample[kernel.machine() as usize];
            let per_pass = per_sample * exposed.plate.film().pixels().len() as f64;
            let refresh = (exposed.spent / 8).clamp(REFRESH[0], REFRESH[1]);
            let fitting = (refresh.as_secs_f64() / per_pass) as u32;
            let samples = fitting.clamp(1, before.max(1)).min(wished - before);
            let Exposed { plate, job, .. } = &mut exposed;
            self.expose(kernel, plate, job, samples, &|| stop.now());
            if stop.now() {
                break;
            }
            exposed.spent += start.elapsed();
            let spp = exposed.plate.spp();
            if spp > 0 && (before == 0 || spp == wished || shown.elapsed() >= refresh) {
                self.show(kernel, &mut exposed);
                shown = Instant::now();
            }
        }
        exposed
    }

    fn expose(
        &mut self,
        kernel: &mut Kernel,
        plate: &mut Plate,
        job: &RayJob,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) {
        let start = Instant::now();
        let machine = kernel.machine();
        match kernel.expose(plate, job, samples, stop) {
            Ok(taken) if taken > 1000 => {
                self.seconds_per_sample[machine as usize] = start.elapsed().as_secs_f64() / taken as f64;
            }
            Ok(_) => {}
            Err(fault) => self.replace(kernel, plate, job, &fault),
        }
    }

    fn develop(&mut self, kernel: &mut Kernel, plate: &mut Plate, job: &RayJob) {
        if let Err(fault) = kernel.develop(plate) {
            self.replace(kernel, plate, job, &fault);
        }
    }

    fn show(&mut self, kernel: &mut Kernel, exposed: &mut Exposed) {
        let Exposed { plate, spent, job } = exposed;
        self.develop(kernel, plate, job);
        if plate.spp() > 0 {
            self.deliver(kernel, plate, job, *spent, [false, plate.spp() < job.settings.spp]);
        }
    }

    fn deliver(&self, kernel: &Kernel, plate: &Plate, job: &RayJob, spent: Duration, [rough, unfinished]: [bool; 2]) {
        let film = plate.film();
        self.darkroom.deliver(
            self.side,
            Picture {
                width: film.width(),
                height: film.height(),
                radiances: film.radiances().collect(),
                spp: Some(film.samples_per_pixel()),
                seconds: spent.as_secs_f64(),
                nonfinite: film.nonfinite,
                adapter: plate.made_by().into(),
                refused: self.refusal.as_ref().map(|refusal| refusal.why.clone()),
                rough,
                unfinished,
                order: job.order.made_on(kernel.machine()),
            },
        );
    }
}

/// Whether two jobs differ in the wished number of samples alone.
pub fn same_picture(a: &RayJob, b: &RayJob) -> bool {
    let how = |job: &RayJob| (job.settings.method, job.settings.device, job.settings.adapter);
    let seen = |job: &RayJob| (*job.order.camera(), job.order.size(), job.order.restarts);
    how(a) == how(b) && seen(a) == seen(b) && Arc::ptr_eq(&a.order.scene, &b.order.scene)
}
