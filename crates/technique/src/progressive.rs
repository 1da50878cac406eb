//! How a picture of rays comes about where someone watches: a rough one at once, then ever more samples, until the
//! wished number or a new request. The last films are kept: a request that differs only in the wished number goes on
//! where one of them stopped, and a view that was left for a moment is there again.

mod waiting;

use crate::Watch;
use crate::history::Past;
use crate::patience::Patient;
use crate::renderer::Renderer;
use crate::speeds::Speeds;
use crate::{Accumulation, Adapters, Backend, Device, Rank, Runs, Shot, Technique, Threads, TracedSettings};
use scene::{Scene, Shape};
use std::sync::Arc;
use std::time::{Duration, Instant};
use waiting::Coarse;

/// Time that a request may go on after a newer one came, if it has not shown anything yet: else a drag would never show
/// anything.
const GRACE: Duration = Duration::from_millis(80);
/// The same for how far samples are trusted, of which there is no rough picture: that takes two passes, and two filters.
const GRACE_OF_THE_WEIGHT: Duration = Duration::from_millis(500);
/// Time that a rough picture may take: with the two frames of the window around it, it shall be on the screen within a
/// tenth of a second.
const ROUGH: Duration = Duration::from_millis(20);
/// A full picture that takes no longer than this needs no rough one before it.
const AT_ONCE: Duration = Duration::from_millis(30);

/// Triangles that take the processor a tenth of a second to make ready.
const LARGE: usize = 100_000;

/// Films that are kept beside the one in hand: one to come back to.
const MOST_KEPT: usize = 2;

/// A picture to make.
#[derive(Debug, Clone)]
pub struct Request {
    /// Scene, camera and size to render.
    pub shot: Shot,
    /// How, where, and how far.
    pub settings: TracedSettings,
    /// How often the user began anew.
    pub restarts: u64,
}

/// Why the graphics device is not used, and until when.
struct Refusal {
    why: Arc<str>,
    source: String,
    restarts: u64,
}

/// A scene, and what is seen of it under a sun of this radius.
struct Seen {
    of: Arc<Scene>,
    sun_radius: Option<f32>,
    scene: Arc<Scene>,
}

/// A film and the request that it belongs to, whose wished number of samples may grow.
struct CachedFilm {
    accumulation: Accumulation,
    /// What came before it, where it is one of several.
    runs: Option<Runs>,
    request: Request,
}

/// Makes one picture after the other, each from the rough to the fine.
pub struct ProgressiveRenderer {
    /// What can trace rays beside the processor.
    adapters: Adapters,
    threads: Arc<Threads>,
    /// The scene of the last request as its rays see it.
    seen: Option<Seen>,
    /// That scene, ready for rays.
    ready: Option<Renderer>,
    speeds: Speeds,
    refusal: Option<Refusal>,
    /// The films of the last requests, the latest last.
    kept: Vec<CachedFilm>,
    /// The scene that waits for its trees, with coarse meshes.
    coarse: Option<Coarse>,
    /// What they showed, where that counts.
    past: Past,
    /// When the request in hand was begun.
    begun: Instant,
}

/// There is not enough memory for a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoMemory;

impl Request {
    /// Whether two requests differ in the wished number of samples, or of runs, alone.
    pub fn is_same_picture(&self, other: &Request) -> bool {
        let how = |of: &Request| {
            let TracedSettings { integrator, device, adapter, spp: _, runs: _, sun_radius, denoise, feature } =
                of.settings;
            // to be judged by its parts a film has to be made in parts
            (integrator, device, adapter, sun_radius, feature, denoise.trusts())
        };
        let seen = |of: &Request| (of.shot.camera, of.shot.size, of.restarts);
        how(self) == how(other) && seen(self) == seen(other) && Arc::ptr_eq(&self.shot.scene, &other.shot.scene)
    }
}

/// What was kept of a request, or else a film without light.
fn films_for(request: &Request, kept: Option<CachedFilm>) -> Result<CachedFilm, NoMemory> {
    let TracedSettings { spp, runs, denoise, .. } = request.settings;
    let (accumulation, before) = match kept {
        Some(kept) => (kept.accumulation, kept.runs.filter(|runs| runs.go_on_to(&request.settings))),
        None => (Accumulation::blank(request.shot.size).ok_or(NoMemory)?, None),
    };
    let runs = match before {
        None if runs > 1 => Some(Runs::blank(request.shot.size, spp, denoise).ok_or(NoMemory)?),
        before => before.filter(|_| runs > 1),
    };
    Ok(CachedFilm { accumulation, runs, request: request.clone() })
}

impl CachedFilm {
    /// How many runs are done, and what the one in hand has.
    fn progress(&self) -> (u32, u32) {
        (self.runs.as_ref().map_or(0, Runs::done), self.accumulation.spp())
    }

    fn has_samples(&self) -> bool {
        self.progress() > (0, 0)
    }

    fn refine(&mut self, renderer: &mut Renderer, watch: &impl Watch) {
        let CachedFilm { accumulation, runs, request } = self;
        let (camera, TracedSettings { integrator, spp, runs: wanted, .. }) = (&request.shot.camera, &request.settings);
        match runs {
            Some(runs) => renderer.refine_runs((accumulation, runs), camera, (integrator, *wanted), watch),
            None => renderer.refine(accumulation, camera, (integrator, *spp), watch),
        }
    }
}

impl ProgressiveRenderer {
    /// On these threads, or by one of these adapters.
    pub fn new(adapters: Adapters, threads: Arc<Threads>) -> Self {
        ProgressiveRenderer {
            adapters,
            threads,
            seen: None,
            ready: None,
            speeds: Speeds::default(),
            refusal: None,
            kept: Vec::new(),
            coarse: None,
            past: Past::default(),
            begun: Instant::now(),
        }
    }

    /// Makes a picture as far as it gets.
    ///
    /// # Errors
    /// If there is no memory for its film.
    pub fn render(&mut self, request: &Request, watch: &impl Watch) -> Result<(), NoMemory> {
        self.begun = Instant::now();
        let request = &self.as_seen(request);
        let Some(_trees) = self.trees(request, watch) else { return Ok(()) };
        let kept = self.best_kept(request);
        // a picture without a weight is no rough one of the weight
        let weight = request.settings.denoise.shows_the_weight();
        let mut rough = kept.is_none() && !weight;
        let grace = if weight && kept.is_none() { GRACE_OF_THE_WEIGHT } else { Duration::ZERO };
        let mut renderer = self.make_ready(request, &mut rough, watch);
        renderer.feature = request.settings.feature;
        renderer.past = std::mem::take(&mut self.past);
        renderer.past.turn_to(request, watch.denoise().history);
        if rough && !renderer.show_moved(request, watch) {
            self.rough_by_whoever_is_ready(&mut renderer, request, watch);
        }
        let refined = films_for(request, kept).map(|mut film| {
            let watch = Patient::until(watch, Instant::now() + grace);
            if film.has_samples() || !watch.ends_now() {
                film.refine(&mut renderer, &watch);
            }
            if film.has_samples() {
                self.kept.push(film);
            }
        });
        self.past = std::mem::take(&mut renderer.past);
        self.take_note_of(&renderer, request);
        if self.kept.len() > MOST_KEPT {
            self.kept.remove(0);
        }
        self.ready = Some(renderer);
        refined
    }

    /// The request of the scene as its rays see it, which is one and the same as long as its sun stays.
    fn as_seen(&mut self, request: &Request) -> Request {
        let Request { shot, settings, .. } = request;
        let stands = |seen: &Seen| Arc::ptr_eq(&seen.of, &shot.scene) && seen.sun_radius == settings.sun_radius;
        let seen = self.seen.take().filter(stands).unwrap_or_else(|| Seen {
            of: shot.scene.clone(),
            sun_radius: settings.sun_radius,
            scene: settings.applied_to(&shot.scene),
        });
        let scene = seen.scene.clone();
        self.seen = Some(seen);
        // where no light is traced there is nothing to take a mean of
        let technique = Technique::Traced(*settings);
        let settings = TracedSettings { runs: technique.runs(), denoise: technique.denoise(), ..*settings };
        Request { shot: Shot { scene, ..shot.clone() }, settings, ..*request }
    }

    /// The scene on the device that is asked for, or on the processor.
    fn make_ready(&mut self, request: &Request, rough: &mut bool, watch: &impl Watch) -> Renderer {
        let device = self.device_for(request);
        let adapter = self.adapter_for(request);
        let ready = match self.ready.take() {
            Some(renderer) if renderer.is_ready_for(&request.shot.scene, device, &adapter) => renderer,
            before => {
                let backend = self.backend_for(request, before, (device, &adapter), rough, watch);
                self.renderer(request, backend)
            }
        };
        ready.with_refusal(self.refusal.as_ref().map(|refusal| refusal.why.clone()))
    }

    /// Where opening a device takes its time and a `rough` picture is wanted, it is shown before.
    fn backend_for(
        &mut self,
        request: &Request,
        before: Option<Renderer>,
        (device, adapter): (Device, &str),
        rough: &mut bool,
        watch: &impl Watch,
    ) -> Backend {
        let scene = &request.shot.scene;
        if let Some(before) = before {
            if !Arc::ptr_eq(before.scene(), scene) {
                self.kept.clear();
            }
            self.kept.iter_mut().for_each(|kept| before.release(&mut kept.accumulation));
            match before.into_backend() {
                Backend::Gpu(mut backend) if device == Device::Gpu && backend.name() == adapter => {
                    match backend.take_scene(scene) {
                        Ok(()) => return Backend::Gpu(backend),
                        Err(fault) => self.refuse(request, &fault.to_string()),
                    }
                    return self.processor(request);
                }
                _ => {}
            }
        }
        let processor = self.processor(request);
        if device == Device::Cpu {
            return processor;
        }
        let mut renderer = self.renderer(request, processor);
        if std::mem::take(rough) {
            self.rough(&mut renderer, request, watch);
        }
        match Backend::beside_a_window(adapter, scene) {
            Ok(backend) => backend,
            Err(fault) => {
                self.refuse(request, &fault.to_string());
                renderer.into_backend()
            }
        }
    }

    fn processor(&self, request: &Request) -> Backend {
        self.threads.turn(Rank::RoughPicture, || Backend::on_the_processor(&request.shot.scene))
    }

    fn renderer(&self, request: &Request, backend: Backend) -> Renderer {
        let mut renderer = Renderer::new(request.shot.scene.clone(), backend, self.threads.clone());
        renderer.feature = request.settings.feature;
        renderer.with_speeds(self.speeds)
    }

    /// The device that is asked for, unless that cannot follow these paths, or has failed at this scene and nobody has
    /// asked to try again.
    fn device_for(&mut self, request: &Request) -> Device {
        let wish = request.settings.device_choice().beside(self.adapters.only_software());
        let stands = |of: &Refusal| of.source == request.shot.source && of.restarts == request.restarts;
        self.refusal.take_if(|refusal| wish == Device::Cpu || !stands(refusal));
        if self.refusal.is_some() { Device::Cpu } else { wish }
    }

    /// The adapter that is asked for, else the best.
    fn adapter_for(&self, request: &Request) -> String {
        let adapters = &self.adapters.0;
        let chosen = adapters.get(usize::from(request.settings.adapter)).or(adapters.first());
        chosen.map_or_else(|| "of any kind".into(), |adapter| adapter.name.clone())
    }

    fn refuse(&mut self, request: &Request, why: &str) {
        let (why, source) = (why.into(), request.shot.source.clone());
        self.refusal = Some(Refusal { why, source, restarts: request.restarts });
    }

    /// Remembers how fast it was, and whether a device was lost: what it held of other films is lost too.
    fn take_note_of(&mut self, renderer: &Renderer, request: &Request) {
        self.speeds = renderer.speeds;
        if let (Some(why), None) = (renderer.refusal(), &self.refusal) {
            self.refuse(request, why);
            self.kept.iter_mut().for_each(|kept| kept.accumulation.forget_the_device());
        }
    }

    /// The kept film that is nearest to what is asked for, of the same picture.
    fn best_kept(&mut self, request: &Request) -> Option<CachedFilm> {
        let serves = |kept: &CachedFilm| {
            kept.request.is_same_picture(request)
                && kept.accumulation.most() <= request.settings.spp
                && kept.runs.as_ref().is_none_or(|runs| match runs.done() {
                    0 => true,
                    // what is in hand is of another seed than a picture alone
                    _ => request.settings.runs > 1 && runs.go_on_to(&request.settings),
                })
        };
        let serving = self.kept.iter().enumerate().filter(|(_, kept)| serves(kept));
        let (index, _) = serving.max_by_key(|(_, kept)| kept.progress())?;
        Some(self.kept.remove(index))
    }

    /// Rough pictures by the processor where the device has to compile first, which takes longer than anyone should
    /// look at the last picture.
    fn rough_by_whoever_is_ready(&mut self, renderer: &mut Renderer, request: &Request, watch: &impl Watch) {
        let triangles = |shape: &Shape| shape.geometry.mesh_of().map_or(0, |mesh| mesh.triangles().len());
        // where the processor would take as long to make the scene ready, nothing is won
        let large = request.shot.scene.shapes.iter().map(triangles).sum::<usize>() > LARGE;
        if large || renderer.has_compiled(&request.settings.integrator) {
            self.rough(renderer, request, watch);
        } else {
            let processor = self.processor(request);
            self.rough(&mut self.renderer(request, processor), request, watch);
            renderer.speeds = self.speeds;
        }
    }

    /// Pictures of an eighth, a quarter and half the resolution, beginning with the finest that is ready in time.
    fn rough(&mut self, renderer: &mut Renderer, request: &Request, watch: &impl Watch) {
        let Request { shot, settings, .. } = request;
        let (width, height) = shot.size;
        let pixels = f64::from(width) * f64::from(height);
        renderer.rank = Rank::RoughPicture;
        let mut shown = false;
        for shrink in [8, 4, 2] {
            let (pixels, finer) = (pixels / f64::from(shrink * shrink), pixels / f64::from(shrink * shrink / 4));
            let patience = if shrink == 2 { AT_ONCE } else { ROUGH };
            if renderer.forecast(finer) <= patience.as_secs_f64() {
                continue;
            }
            let fitting = ROUGH.as_secs_f64() / renderer.forecast(pixels);
            let samples = (fitting as u32).clamp(1, settings.spp.min(16));
            let size = (width.div_ceil(shrink), height.div_ceil(shrink));
            let Some(mut accumulation) = Accumulation::blank(size) else { break };
            let (begun, first) = (self.begun, !shown);
            let ends = || watch.ends_now() && !(first && begun.elapsed() < GRACE);
            let lost = renderer.add(&mut accumulation, &shot.camera, &settings.integrator, samples, &ends).is_err();
            if ends() {
                break;
            }
            // a device that has failed leaves nothing
            if !lost && renderer.resolve(&mut accumulation).is_ok() && accumulation.spp() > 0 {
                watch.show(renderer.frame(&accumulation, [true, true]));
                shown = true;
            }
        }
        self.take_note_of(renderer, request);
    }
}
