//! The thread that looks into one pixel: traces its samples again, for each pane those that its picture is to have, and
//! takes one of them apart. A sample is a pure function of pixel, number and seed, so that nothing of the pictures' own
//! renderers is needed, and nothing is held up by it.

use super::asked_pane::same_shot;
use super::worker::{Control, Service, Worker};
use super::{FAULT, Wake, step_back};
use crate::model::{MOST_PROBED, PaneId, PaneProbe, Panes, PixelSamples, ProbeWish, Wanted, pixel_at};
use pathtrace::{FirstVertex, Integrator, ProbedPixel, Tracer};
use scene::Scene;
use std::sync::Arc;
use technique::{Rank, Shot, Technique, Threads, TracedSettings, Trees};

/// Samples of the first step, and how many times as many there are after the next: something is seen at once.
const FIRST_STEP: u32 = 256;
const GROWTH: u32 = 2;
/// Samples of a step at most: pictures wait for no more.
const MOST_OF_A_STEP: u32 = 8192;

/// What asks the thread, which is started when a pixel is first looked into; dropping it ends the thread.
#[derive(Default)]
pub struct Probes {
    worker: Option<Worker<Option<ProbeJob>, Probed>>,
    last: Option<ProbeJob>,
    /// The number of jobs so far: answers to older ones are dropped.
    jobs: u64,
}

/// A pixel, and the pictures that it is of.
#[derive(Debug, Clone, PartialEq)]
struct ProbeJob {
    number: u64,
    wish: ProbeWish,
    panes: Vec<(PaneId, ProbedPicture)>,
}

/// What a pixel's samples depend on, beside which pixel it is.
#[derive(Debug, Clone)]
struct ProbedPicture {
    shot: Shot,
    settings: TracedSettings,
}

/// What became of a job so far.
#[derive(Debug, Default)]
struct Probed {
    job: u64,
    panes: Panes<PaneProbe>,
}

impl PartialEq for ProbedPicture {
    fn eq(&self, other: &Self) -> bool {
        same_shot(&self.shot, &other.shot) && self.settings == other.settings
    }
}

impl Probes {
    /// Asks for what is wanted, if that is not what was asked for.
    pub fn follow(&mut self, wanted: &Wanted, threads: &Arc<Threads>, wake: &Wake) {
        let Some(wish) = wanted.probe else {
            self.worker.iter().filter(|_| self.last.is_some()).for_each(Worker::cancel);
            self.last = None;
            return;
        };
        let traced = wanted.panes.iter().filter_map(|(id, pane)| match pane.technique {
            Technique::Traced(settings) => Some((id, ProbedPicture { shot: pane.shot.clone(), settings })),
            Technique::Fake(_) => None,
        });
        let job = ProbeJob { number: self.jobs, wish, panes: traced.collect() };
        if self.last.as_ref() == Some(&job) {
            return;
        }
        if self.worker.is_none() {
            let threads = threads.clone();
            let service = move || {
                step_back();
                Prober { threads, number: 0, asked: Vec::new(), panes: Panes::default() }
            };
            // without a thread there are no samples; the next frame tries again
            self.worker = Worker::start("probe", wake.clone(), service).ok();
        }
        let Some(worker) = &self.worker else { return };
        self.jobs += 1;
        let job = ProbeJob { number: self.jobs, ..job };
        worker.cancel();
        worker.post(|slot| *slot = Some(job.clone()));
        self.last = Some(job);
    }

    /// What is new of the pixel that was asked for last.
    pub fn collect(&self) -> Panes<PaneProbe> {
        let probed = self.worker.as_ref().and_then(Worker::collect).filter(|_| self.last.is_some());
        probed.filter(|probed| probed.job == self.jobs).map(|probed| probed.panes).unwrap_or_default()
    }
}

/// The thread that makes the samples of one pixel, step by step.
struct Prober {
    threads: Arc<Threads>,
    /// The job in hand, and whom it is for.
    number: u64,
    asked: Vec<PaneId>,
    /// What is known of each pane, to go on with.
    panes: Panes<Kept>,
}

/// What was made ready for a pane's picture.
struct Kept {
    /// The scene as the document has it, and the sun that these rays see in it.
    scene: Arc<Scene>,
    sun_radius: Option<f32>,
    /// Both ready for rays.
    tracer: Tracer,
    /// What the samples are of.
    probed: ProbedPixel,
    integrator: Integrator,
    samples: Arc<PixelSamples>,
}

/// Says whether something else is wanted.
type Ends<'a> = dyn Fn() -> bool + Sync + 'a;

type ProbeControl = Control<Option<ProbeJob>, Probed>;

impl Service for Prober {
    type Job = Option<ProbeJob>;
    type Update = Probed;

    fn serve(&mut self, job: Option<ProbeJob>, control: &ProbeControl) {
        let Some(job) = job else {
            self.panes = Panes::default();
            return;
        };
        (self.number, self.asked) = (job.number, job.panes.iter().map(|(id, _)| *id).collect());
        let asked = &self.asked;
        self.panes.retain(|id, _| asked.contains(&id));
        for (id, picture) in &job.panes {
            if let Some(why) = refusal(&picture.settings) {
                self.panes.remove(*id);
                self.tell(control, *id, PaneProbe { fault: Some(why), ..PaneProbe::default() });
            } else if self.look_into(*id, picture, job.wish, control).is_none() {
                return;
            }
        }
    }

    fn recover(&mut self, control: &ProbeControl) {
        self.panes = Panes::default();
        for &id in &self.asked {
            self.tell(control, id, PaneProbe { fault: Some(FAULT.into()), ..PaneProbe::default() });
        }
    }
}

/// Why a pixel of such a picture has no samples of its own: a line.
fn refusal(settings: &TracedSettings) -> Option<String> {
    let feature = settings.feature.map(|_| "what is shown is no light".to_owned());
    feature.or_else(|| Some(settings.integrator.binds_pixels()?.to_owned()))
}

impl Prober {
    fn tell(&self, control: &ProbeControl, id: PaneId, probe: PaneProbe) {
        control.tell(|told| {
            if told.job != self.number {
                *told = Probed { job: self.number, panes: Panes::default() };
            }
            told.panes.insert(id, probe);
        });
    }

    /// All samples of a pane's pixel, step by step; `None` where something else is wanted meanwhile.
    fn look_into(
        &mut self,
        id: PaneId,
        picture: &ProbedPicture,
        wish: ProbeWish,
        control: &ProbeControl,
    ) -> Option<()> {
        let ends: &Ends = &|| control.ends_now();
        self.make_ready(id, picture, ends)?;
        let threads = self.threads.clone();
        self.panes.get_mut(id)?.turn_to(picture, wish.at);
        loop {
            let kept = self.panes.get_mut(id)?;
            let goes_on = kept.trace_on(&threads, ends)?;
            let vertex = kept.take_apart(wish.sample, &threads, ends)?;
            let samples = Some(kept.samples.clone());
            self.tell(control, id, PaneProbe { samples, vertex, fault: None });
            if !goes_on {
                return Some(());
            }
        }
    }

    /// The scene ready for rays, unless it is.
    fn make_ready(&mut self, id: PaneId, picture: &ProbedPicture, ends: &Ends) -> Option<()> {
        let ProbedPicture { shot, settings } = picture;
        let is_ready = |kept: &Kept| Arc::ptr_eq(&kept.scene, &shot.scene) && kept.sun_radius == settings.sun_radius;
        if self.panes.get(id).is_some_and(is_ready) {
            return Some(());
        }
        let scene = settings.applied_to(&shot.scene);
        let _trees = Trees::of(&scene, &|_| !ends())?;
        let tracer = self.threads.turn_unless(ends, Rank::FirstPicture, || Tracer::new(&scene))?;
        self.panes.insert(id, Kept::new(tracer, picture));
        Some(())
    }
}

impl Kept {
    fn new(tracer: Tracer, ProbedPicture { shot, settings }: &ProbedPicture) -> Self {
        let probed = ProbedPixel { camera: shot.camera, size: [shot.size.0, shot.size.1], pixel: [0; 2] };
        let samples = Arc::new(PixelSamples::new(probed.pixel, settings.spp, Vec::new()));
        let (scene, sun_radius) = (shot.scene.clone(), settings.sun_radius);
        Kept { scene, sun_radius, tracer, probed, integrator: settings.integrator, samples }
    }

    /// Goes to a pixel of a picture; samples of another are forgotten, and those beyond the wished number.
    fn turn_to(&mut self, ProbedPicture { shot, settings }: &ProbedPicture, at: [f32; 2]) {
        let pixel = pixel_at(at, shot.size);
        let probed = ProbedPixel { camera: shot.camera, size: [shot.size.0, shot.size.1], pixel };
        let is_same = (self.probed, self.integrator) == (probed, settings.integrator);
        if is_same && self.samples.wished == settings.spp {
            return;
        }
        let mut samples = if is_same { self.samples.samples.clone() } else { Vec::new() };
        samples.truncate(settings.spp as usize);
        (self.probed, self.integrator) = (probed, settings.integrator);
        self.samples = Arc::new(PixelSamples::new(pixel, settings.spp, samples));
    }

    /// Traces the next step, and says whether there is one more.
    fn trace_on(&mut self, threads: &Threads, ends: &Ends) -> Option<bool> {
        let (known, wished) = (self.samples.samples.len() as u32, self.samples.wished);
        let wanted = wished.min(MOST_PROBED);
        let until = (GROWTH * known).clamp(FIRST_STEP, known.max(FIRST_STEP) + MOST_OF_A_STEP).min(wanted);
        if known < until {
            let trace = || self.tracer.samples_of_pixel(&self.probed, &self.integrator, known..until, &|| ends());
            let step = threads.turn_unless(ends, Rank::FirstPicture, trace)??;
            let samples = [&*self.samples.samples, &*step].concat();
            self.samples = Arc::new(PixelSamples::new(self.probed.pixel, wished, samples));
        }
        Some(until < wanted)
    }

    /// Takes this sample apart, or the last, where the walk lets itself be taken apart.
    fn take_apart(&self, sample: Option<u32>, threads: &Threads, ends: &Ends) -> Option<Option<(u32, FirstVertex)>> {
        let last = (self.samples.samples.len() as u32).saturating_sub(1);
        let sample = sample.unwrap_or(last).min(last);
        let take = || self.tracer.first_vertex(&self.probed, &self.integrator, sample, &|| ends());
        let vertex = threads.turn_unless(ends, Rank::FirstPicture, take)?;
        Some(vertex.map(|vertex| (sample, vertex)))
    }
}
