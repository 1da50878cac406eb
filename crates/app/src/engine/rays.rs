//! The thread that traces rays for one pane. Its [`ProgressiveRenderer`] makes one job's picture after the other.

use super::post_process::PostProcess;
use super::worker::{Control, Service, Worker};
use super::{FAULT, Job, Order, Picture, Undenoised, Wake, step_back};
use crate::model::{Effort, PaneId};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use technique::{
    Adapters, DenoiseSettings, Denoised, Frame, Halves, NOISY, NoMemory, Pacing, ProgressiveRenderer, Request, Reused,
    Threads, TracedSettings, TreeProgress, Watch,
};

/// A picture to make.
pub type RayJob = Job<TracedSettings>;

/// Least and most time between two pictures once the resolution is full: an eighth of the time spent so far, because
/// showing costs too, and a picture changes ever less.
const REFRESH: [Duration; 2] = [Duration::from_millis(150), Duration::from_secs(1)];

/// What is waited for, in words, where a picture has to wait.
pub type RayNews = Option<String>;

/// The worker; dropping it ends its thread.
pub struct RayWorker {
    worker: Worker<Option<RayJob>, RayNews>,
    /// The job in hand, or the last one.
    last: Option<Request>,
}

impl RayWorker {
    /// Starts the thread, which traces on `threads` or by one of `adapters`. `wake` is called whenever [`RayWorker::news`]
    /// has something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(
        pane: PaneId,
        (adapters, threads): (Adapters, Arc<Threads>),
        post_process: Arc<PostProcess>,
        wake: Wake,
    ) -> std::io::Result<Self> {
        let service = move || {
            step_back();
            let renderer = ProgressiveRenderer::new(adapters.clone(), threads.clone());
            Rays { pane, adapters, threads, renderer, post_process, order: None }
        };
        let worker = Worker::start(&format!("rays {pane:?}"), wake, service)?;
        Ok(RayWorker { worker, last: None })
    }

    /// Asks for a picture. The one in hand stops at once, or after its pass if it only shall have more or fewer
    /// samples.
    pub fn submit(&mut self, job: RayJob) {
        let request = request_of(&job);
        if !self.last.as_ref().is_some_and(|last| last.is_same_picture(&request)) {
            self.cancel();
        }
        self.last = Some(request);
        self.worker.post(|slot| *slot = Some(job));
    }

    /// Stops the picture in hand.
    pub fn cancel(&mut self) {
        self.last = None;
        self.worker.cancel();
    }

    /// What is waited for now, if that has changed since the last call.
    pub fn news(&self) -> Option<RayNews> {
        self.worker.collect()
    }

    /// Holds the picture where it is, or lets it go on. While held, a new job still shows its first full picture.
    pub fn hold(&self, held: bool) {
        self.worker.hold(held);
    }
}

type RayControl = Control<Option<RayJob>, RayNews>;

/// Traces rays for one pane.
struct Rays {
    pane: PaneId,
    adapters: Adapters,
    threads: Arc<Threads>,
    renderer: ProgressiveRenderer,
    post_process: Arc<PostProcess>,
    /// Of the job in hand, or the last one.
    order: Option<Order>,
}

impl Service for Rays {
    type Job = Option<RayJob>;
    type Update = RayNews;

    fn serve(&mut self, job: Option<RayJob>, control: &RayControl) {
        let Some(job) = job else { return };
        self.order = Some(job.order.clone());
        let watch = PaneWatch {
            pane: self.pane,
            order: &job.order,
            has_noise_source: job.settings.noise_source(job.order.scene()).is_some(),
            control,
            post_process: &self.post_process,
            filtering: AtomicU64::new(0),
            waits: Mutex::new(None),
        };
        if let Err(NoMemory) = self.renderer.render(&request_of(&job), &watch) {
            let (width, height) = job.order.size();
            let fault = format!("not enough memory for {width} x {height} pixels; make the window smaller");
            self.post_process.report(self.pane, job.order, fault);
        }
    }

    fn recover(&mut self, control: &RayControl) {
        control.tell(|news| *news = None);
        if let Some(order) = self.order.take() {
            self.post_process.report(self.pane, order, FAULT.into());
        }
        self.renderer = ProgressiveRenderer::new(self.adapters.clone(), self.threads.clone());
    }
}

fn request_of(job: &RayJob) -> Request {
    let Order { restarts, provenance, .. } = &job.order;
    Request { shot: provenance.shot.clone(), settings: job.settings, restarts: *restarts }
}

/// A pane that waits for a job's pictures.
struct PaneWatch<'a> {
    pane: PaneId,
    order: &'a Order,
    /// Whether its settings leave light of its scene to chance.
    has_noise_source: bool,
    control: &'a RayControl,
    post_process: &'a PostProcess,
    /// Milliseconds that all between film and picture took last.
    filtering: AtomicU64,
    /// What was told last that it waits for.
    waits: Mutex<RayNews>,
}

impl Watch for PaneWatch<'_> {
    fn ends_now(&self) -> bool {
        self.control.ends_now()
    }

    fn ends_soon(&self, _spp: u32) -> bool {
        self.control.ends_soon()
    }

    fn is_held(&self) -> bool {
        self.control.is_held()
    }

    fn wait(&self) {
        self.control.wait();
    }

    fn denoise(&self) -> DenoiseSettings {
        self.order.provenance.technique.denoise()
    }

    fn pacing(&self, spent: Duration) -> Pacing {
        let refresh = (spent / 8).clamp(REFRESH[0], REFRESH[1]);
        // a denoiser has half of the time at most
        let show = refresh.max(Duration::from_millis(self.filtering.load(Ordering::Relaxed)));
        Pacing { pass: refresh, show, growth: 1 }
    }

    fn waits_for_trees(&self, trees: Option<TreeProgress>) {
        let words = trees.map(|trees| trees.to_string());
        let mut told = self.waits.lock().unwrap_or_else(PoisonError::into_inner);
        if *told != words {
            told.clone_from(&words);
            self.control.tell(|news| *news = words);
        }
    }

    fn show(&self, frame: Frame) {
        let film = frame.film;
        let mut filter_fault = None;
        let halves = frame.earlier.and_then(|earlier| Halves::of(film, earlier));
        let undenoised = frame.reused.as_ref().map_or_else(|| film.image(), |reused| reused.image.clone());
        let mut filtering = frame.reused.as_ref().map_or(0.0, |reused| reused.seconds);
        let (mut image, before) = match frame.denoised {
            Some(Ok(Denoised { image, seconds, made_by, refused })) => {
                filtering += seconds;
                filter_fault = refused.map(|why| format!("denoised on the CPU: the GPU failed: {why}").into());
                let halves = halves.as_ref().map(|halves| halves.samples);
                (image, Some(Box::new(Undenoised { image: undenoised, seconds, by: made_by.into(), halves })))
            }
            Some(Err(fault)) => {
                filter_fault = Some(format!("not denoised: {fault}").into());
                (undenoised, None)
            }
            None => (undenoised, None),
        };
        self.filtering.store((1000.0 * filtering) as u64, Ordering::Relaxed);
        // an EXR of the pane keeps them
        image.layers.extend(frame.features.iter().flat_map(|features| features.layers()));
        image.layers.extend(frame.reused.iter().map(Reused::layer));
        image.layers.extend(before.iter().map(|before| before.image.as_layer(NOISY)));
        image.layers.extend(halves.iter().filter(|_| before.is_some()).flat_map(Halves::layers));
        let is_mean = before.is_none() && frame.reused.is_none();
        let picture = Picture {
            image,
            external: None,
            spp: Some(film.samples_per_pixel()),
            runs: frame.runs,
            seconds: frame.seconds,
            effort: Effort::Traced(frame.stats),
            noisy: self.has_noise_source && !frame.rough && is_mean && compare::is_visibly_noisy(film),
            nonfinite: film.nonfinite,
            adapter: frame.made_by.into(),
            refused: frame.refused,
            filter_fault,
            before,
            lag: frame.reused.map(|reused| reused.lag),
            cut: None,
            rough: frame.rough,
            coarse: frame.coarse,
            unfinished: frame.unfinished,
            order: self.order.made_on(frame.device),
        };
        self.post_process.deliver(self.pane, picture);
    }
}
