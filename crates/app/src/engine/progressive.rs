//! How a picture of rays comes about: a rough one at once, then ever more samples, until the wished number or a new
//! job. A graphics device that fails is replaced by the processor, which goes on from the last film that came back.

use super::backend::{Accumulation, Backend};
use super::post_process::PostProcess;
use super::rays::{Gate, RayJob, Stop};
use super::{Order, Picture};
use crate::model::PaneId;
use pathtrace::gpu::GpuTraceError;
use scene::{Geometry, Scene, Shape};
use std::sync::Arc;
use std::time::{Duration, Instant};
use technique::{Adapters, Device};

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
struct CachedFilm {
    accumulation: Accumulation,
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
pub struct ProgressiveRenderer {
    side: PaneId,
    /// What can trace rays beside the processor.
    adapters: Adapters,
    post_process: Arc<PostProcess>,
    gate: Arc<Gate>,
    /// The scene of the last job, ready for rays.
    ready: Option<(Arc<Scene>, Backend)>,
    refusal: Option<Refusal>,
    /// The films of the last jobs, the latest last.
    kept: Vec<CachedFilm>,
    /// Measured on the last job of each machine: what one sample of one pixel costs.
    seconds_per_sample: [f64; 2],
    /// When the job in hand was begun.
    begun: Instant,
}

impl ProgressiveRenderer {
    /// A renderer for one side.
    pub fn new(side: PaneId, adapters: Adapters, post_process: Arc<PostProcess>, gate: Arc<Gate>) -> Self {
        ProgressiveRenderer {
            side,
            adapters,
            post_process,
            gate,
            ready: None,
            refusal: None,
            kept: Vec::new(),
            seconds_per_sample: [1e-6; 2],
            begun: Instant::now(),
        }
    }

    /// Makes a picture as far as it gets.
    pub fn render_job(&mut self, job: &RayJob, stop: &Stop) {
        self.begun = Instant::now();
        let kept = self.best_kept(job);
        let mut rough = kept.is_none();
        let mut backend = self.make_ready(job, &mut rough, stop);
        let cached = match kept {
            Some(cached) => Some(CachedFilm { job: job.clone(), ..cached }),
            None => {
                if rough {
                    self.rough_by_whoever_is_ready(&mut backend, job, stop);
                }
                if stop.now() { None } else { self.blank(job) }
            }
        };
        let cached = cached.map(|cached| self.refine(&mut backend, cached, stop));
        self.kept.extend(cached.filter(|cached| cached.accumulation.spp() > 0));
        if self.kept.len() > MOST_KEPT {
            self.kept.remove(0);
        }
        self.ready = Some((job.order.scene().clone(), backend));
    }

    /// The scene on the machine that the job wants, or on the processor. Where that takes its time and a `rough`
    /// picture is wanted, it is shown before.
    fn make_ready(&mut self, job: &RayJob, rough: &mut bool, stop: &Stop) -> Backend {
        let scene = job.order.scene();
        let machine = self.machine_for(job);
        let adapter = self.adapter_for(job);
        let before = self.ready.take();
        if let Some((of, backend)) = before {
            let same_scene = Arc::ptr_eq(&of, scene);
            let same_device = machine == Device::Cpu || backend.adapter() == adapter;
            if same_scene && backend.machine() == machine && same_device {
                return backend;
            }
            if !same_scene {
                self.kept.clear();
            }
            self.kept.iter_mut().for_each(|cached| backend.release(&mut cached.accumulation));
            if let (Backend::Gpu(mut gpu_backend), Device::Gpu, true) = (backend, machine, same_device) {
                match gpu_backend.take_scene(scene) {
                    Ok(()) => return Backend::Gpu(gpu_backend),
                    Err(fault) => self.refuse(job, &fault),
                }
                return Backend::on_the_processor(scene);
            }
        }
        let mut processor = Backend::on_the_processor(scene);
        if machine == Device::Cpu {
            return processor;
        }
        // a device takes its time to open and to compile
        if std::mem::take(rough) {
            self.rough(&mut processor, job, stop);
        }
        match Backend::on_the_device(&adapter, scene) {
            Ok(backend) => return backend,
            Err(fault) => self.refuse(job, &fault),
        }
        processor
    }

    /// The machine that the job wants, unless that has failed at this scene and nobody has asked to try again.
    fn machine_for(&mut self, job: &RayJob) -> Device {
        let wish = job.settings.device.beside(self.adapters.only_software());
        let Order { restarts, provenance, .. } = &job.order;
        let stands = |of: &Refusal| of.source == provenance.shot.source && of.restarts == *restarts;
        self.refusal.take_if(|refusal| wish == Device::Cpu || !stands(refusal));
        if self.refusal.is_some() { Device::Cpu } else { wish }
    }

    /// The name of the adapter that the job wants; without any, one that is not there.
    fn adapter_for(&self, job: &RayJob) -> String {
        let adapters = &self.adapters.0;
        let chosen = adapters.get(usize::from(job.settings.adapter)).or(adapters.first());
        chosen.map_or_else(|| "of any kind".into(), |adapter| adapter.name.clone())
    }

    fn refuse(&mut self, job: &RayJob, fault: &GpuTraceError) {
        let (why, source) = (fault.to_string().into(), job.order.provenance.shot.source.clone());
        self.refusal = Some(Refusal { why, source, restarts: job.order.restarts });
    }

    /// The processor takes over from a device that has failed.
    fn replace(&mut self, backend: &mut Backend, accumulation: &mut Accumulation, job: &RayJob, fault: &GpuTraceError) {
        self.refuse(job, fault);
        let failed = std::mem::replace(backend, Backend::on_the_processor(job.order.scene()));
        if matches!(fault, GpuTraceError::Hangs(_)) {
            // to let go of a device that does not answer is to wait for its answer
            std::mem::forget(failed);
        }
        self.kept
            .iter_mut()
            .map(|cached| &mut cached.accumulation)
            .chain([accumulation])
            .for_each(Accumulation::forget_the_device);
    }

    /// The kept film that is nearest to what `job` asks for, of the same picture.
    fn best_kept(&mut self, job: &RayJob) -> Option<CachedFilm> {
        let serves =
            |cached: &CachedFilm| same_picture(&cached.job, job) && cached.accumulation.most() <= job.settings.spp;
        let serving = self.kept.iter().enumerate().filter(|(_, cached)| serves(cached));
        let (index, _) = serving.max_by_key(|(_, cached)| cached.accumulation.spp())?;
        Some(self.kept.remove(index))
    }

    /// A film without light, or a word that there is no memory for it.
    fn blank(&self, job: &RayJob) -> Option<CachedFilm> {
        let (width, height) = job.order.size();
        let accumulation = Accumulation::blank(width, height);
        if accumulation.is_none() {
            let fault = format!("not enough memory for {width} x {height} pixels; make the window smaller");
            self.post_process.report(self.side, job.order.clone(), fault);
        }
        accumulation.map(|accumulation| CachedFilm { accumulation, spent: Duration::ZERO, job: job.clone() })
    }

    /// Rough pictures by the processor where the device has to compile first, which takes longer than anyone should
    /// look at the last picture.
    fn rough_by_whoever_is_ready(&mut self, backend: &mut Backend, job: &RayJob, stop: &Stop) {
        let triangles = |shape: &Shape| match &shape.geometry {
            Geometry::Mesh(mesh) => mesh.triangles().len(),
            _ => 0,
        };
        // where the processor would take as long to make the scene ready, nothing is won
        let large = job.order.scene().shapes.iter().map(triangles).sum::<usize>() > LARGE;
        if large || backend.has_compiled(&job.settings.integrator) {
            self.rough(backend, job, stop);
        } else {
            self.rough(&mut Backend::on_the_processor(job.order.scene()), job, stop);
        }
    }

    /// Pictures of an eighth, a quarter and half the resolution, beginning with the finest that is ready in time.
    fn rough(&mut self, backend: &mut Backend, job: &RayJob, stop: &Stop) {
        let (width, height) = job.order.size();
        let pixels = f64::from(width) * f64::from(height);
        let mut shown = false;
        for shrink in [8, 4, 2] {
            // it may be another machine's from one to the next
            let per_sample = self.seconds_per_sample[backend.machine() as usize];
            let (pixels, finer) = (pixels / f64::from(shrink * shrink), pixels / f64::from(shrink * shrink / 4));
            let patience = if shrink == 2 { AT_ONCE } else { ROUGH };
            if finer * per_sample <= patience.as_secs_f64() {
                continue;
            }
            let fitting = ROUGH.as_secs_f64() / (pixels * per_sample);
            let samples = (fitting as u32).clamp(1, job.settings.spp.min(16));
            let Some(mut accumulation) = Accumulation::blank(width.div_ceil(shrink), height.div_ceil(shrink)) else {
                return;
            };
            let start = Instant::now();
            let (begun, first) = (self.begun, !shown);
            let stop = || stop.now() && !(first && begun.elapsed() < GRACE);
            self.accumulate(backend, &mut accumulation, job, samples, &stop);
            if stop() {
                return;
            }
            self.resolve(backend, &mut accumulation, job);
            // a device that has failed leaves nothing
            if accumulation.spp() > 0 {
                self.deliver(backend, &accumulation, job, start.elapsed(), [true, true]);
                shown = true;
            }
        }
    }

    /// Adds samples up to the wished number, or as many as there is time for. A pass that was stopped in the middle is
    /// completed by the next one.
    fn refine(&mut self, backend: &mut Backend, mut cached: CachedFilm, stop: &Stop) -> CachedFilm {
        let wished = cached.job.settings.spp;
        let gate = self.gate.clone();
        let mut shown = Instant::now();
        // a film that goes on is shown at once, for the label says how far it shall go
        if cached.accumulation.spp() > 0 {
            self.show(backend, &mut cached);
        }
        while cached.accumulation.spp() < wished {
            let before = cached.accumulation.spp();
            // while held, a new picture still gets its first pass
            if before > 0 && gate.is_held() {
                self.show(backend, &mut cached);
                gate.pass(stop);
            }
            if stop.soon() {
                break;
            }
            let start = Instant::now();
            let per_sample = self.seconds_per_sample[backend.machine() as usize];
            let per_pass = per_sample * cached.accumulation.film().pixels().len() as f64;
            let refresh = (cached.spent / 8).clamp(REFRESH[0], REFRESH[1]);
            let fitting = (refresh.as_secs_f64() / per_pass) as u32;
            let samples = fitting.clamp(1, before.max(1)).min(wished - before);
            let CachedFilm { accumulation, job, .. } = &mut cached;
            self.accumulate(backend, accumulation, job, samples, &|| stop.now());
            if stop.now() {
                break;
            }
            cached.spent += start.elapsed();
            let spp = cached.accumulation.spp();
            if spp > 0 && (before == 0 || spp == wished || shown.elapsed() >= refresh) {
                self.show(backend, &mut cached);
                shown = Instant::now();
            }
        }
        cached
    }

    fn accumulate(
        &mut self,
        backend: &mut Backend,
        accumulation: &mut Accumulation,
        job: &RayJob,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) {
        let start = Instant::now();
        let machine = backend.machine();
        match backend.accumulate(accumulation, job, samples, stop) {
            Ok(taken) if taken > 1000 => {
                self.seconds_per_sample[machine as usize] = start.elapsed().as_secs_f64() / taken as f64;
            }
            Ok(_) => {}
            Err(fault) => self.replace(backend, accumulation, job, &fault),
        }
    }

    fn resolve(&mut self, backend: &mut Backend, accumulation: &mut Accumulation, job: &RayJob) {
        if let Err(fault) = backend.resolve(accumulation) {
            self.replace(backend, accumulation, job, &fault);
        }
    }

    fn show(&mut self, backend: &mut Backend, cached: &mut CachedFilm) {
        let CachedFilm { accumulation, spent, job } = cached;
        self.resolve(backend, accumulation, job);
        if accumulation.spp() > 0 {
            self.deliver(backend, accumulation, job, *spent, [false, accumulation.spp() < job.settings.spp]);
        }
    }

    fn deliver(
        &self,
        backend: &Backend,
        accumulation: &Accumulation,
        job: &RayJob,
        spent: Duration,
        [rough, unfinished]: [bool; 2],
    ) {
        let film = accumulation.film();
        self.post_process.deliver(
            self.side,
            Picture {
                image: film.image(),
                spp: Some(film.samples_per_pixel()),
                seconds: spent.as_secs_f64(),
                nonfinite: film.nonfinite,
                adapter: accumulation.made_by().into(),
                refused: self.refusal.as_ref().map(|refusal| refusal.why.clone()),
                rough,
                unfinished,
                order: job.order.made_on(backend.machine()),
            },
        );
    }
}

/// Whether two jobs differ in the wished number of samples alone.
pub fn same_picture(a: &RayJob, b: &RayJob) -> bool {
    let how = |job: &RayJob| (job.settings.integrator, job.settings.device, job.settings.adapter);
    let seen = |job: &RayJob| (*job.order.camera(), job.order.size(), job.order.restarts);
    how(a) == how(b) && seen(a) == seen(b) && Arc::ptr_eq(a.order.scene(), b.order.scene())
}
