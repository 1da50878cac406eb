//! Pictures that another program makes, in a pane beside those that are made here: received by tev's protocol, or read
//! from a file again and again. A pane has a thread that looks for what is new a few times a second, however much comes, and
//! hands it on as a [`Picture`] of the view that the pane shows.

mod follower;
mod gallery;
mod protocol;
mod receiver;

use self::follower::{FileState, Follower};
use self::gallery::Snapshot;
use self::receiver::Receiver;
use super::post_process::PostProcess;
use super::worker::{Control, Service, Worker};
use super::{FAULT, Order, Picture, step_back};
use crate::model::{Effort, External, PaneId, PaneSource};
use film::Image;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often a received picture is looked at, and a file.
const EVERY: [Duration; 2] = [Duration::from_millis(100), Duration::from_millis(250)];

/// Looking takes at most one part in so many of the time.
const SHARE: u32 = 5;

/// So many pixels more of a picture, and it is looked at after so much longer: who shows it has to put it on the screen.
const PIXELS_A_LOOK: u32 = 1 << 21;

/// How soon it is tried again to listen on a port that is taken.
const RETRY: Duration = Duration::from_secs(1);

/// A picture to come by.
#[derive(Debug)]
pub struct ExternalJob {
    /// Where it comes from.
    pub source: PaneSource,
    /// Which job and which view it is shown for.
    pub order: Order,
}

/// The worker; dropping it ends its thread.
pub struct ExternalWorker(Worker<Task>);

/// What the thread of a pane does next.
#[derive(Debug, Default)]
enum Task {
    /// Listens to nobody and follows nothing.
    #[default]
    Close,
    /// Shows nothing, and goes on with what comes from here.
    Keep(PaneSource),
    Show(ExternalJob),
}

impl ExternalWorker {
    /// Starts the thread of a pane.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(pane: PaneId, post_process: Arc<PostProcess>) -> std::io::Result<Self> {
        let service = move || {
            step_back();
            Externals { pane, post_process, order: None, open: None }
        };
        Worker::start(&format!("external {pane:?}"), Arc::new(|| ()), service).map(ExternalWorker)
    }

    /// Shows this from now on.
    pub fn submit(&self, job: ExternalJob) {
        self.0.post(|slot| *slot = Task::Show(job));
    }

    /// Shows nothing for now; what comes from this source meanwhile is there with the next job.
    pub fn keep(&self, source: PaneSource) {
        self.0.post(|slot| *slot = Task::Keep(source));
    }

    /// Listens to nobody and follows nothing any more.
    pub fn cancel(&self) {
        self.0.cancel();
    }
}

/// Looks after one pane.
struct Externals {
    pane: PaneId,
    post_process: Arc<PostProcess>,
    /// Of the job in hand, or the last one.
    order: Option<Order>,
    /// What is listened on or followed.
    open: Option<(PaneSource, Open)>,
}

enum Open {
    Port(Receiver),
    File(Follower),
}

/// What there is to show.
struct Sight {
    version: u64,
    picture: Option<Image>,
    seconds: f64,
    external: External,
}

impl Service for Externals {
    type Job = Task;
    type Update = ();

    fn serve(&mut self, task: Task, control: &Control<Task, ()>) {
        let (source, order) = match task {
            Task::Close => return self.open = None,
            Task::Keep(source) => return drop(self.open.take_if(|(before, _)| *before != source)),
            Task::Show(ExternalJob { source, order }) => (source, order),
        };
        self.order = Some(order.clone());
        // a port is free again before another is listened on
        self.open.take_if(|(before, _)| *before != source);
        while self.open.is_none() && !control.ends_soon() {
            match Open::begin(&source) {
                Ok(open) => self.open = Some((source.clone(), open)),
                Err(fault) => {
                    self.post_process.report(self.pane, order.clone(), fault);
                    control.rest(RETRY);
                }
            }
        }
        let (mut version, mut pixels) = (None, 0);
        while let Some((source, open)) = self.open.as_mut().filter(|_| !control.ends_soon()) {
            let start = Instant::now();
            let every = open.every() * (1 + pixels / PIXELS_A_LOOK);
            if let Some(sight) = open.since(version, source) {
                version = Some(sight.version);
                pixels = sight.picture.as_ref().map_or(0, |image| image.width() * image.height());
                self.show(sight, &order);
            }
            control.rest(every.max(start.elapsed() * SHARE));
        }
    }

    fn recover(&mut self, _control: &Control<Task, ()>) {
        self.open = None;
        if let Some(order) = self.order.take() {
            self.post_process.report(self.pane, order, FAULT.into());
        }
    }
}

impl Externals {
    fn show(&self, sight: Sight, order: &Order) {
        let Sight { picture, seconds, external, .. } = sight;
        let Some(image) = picture else {
            let fault = external.fault.unwrap_or_else(|| waiting(&external.source));
            return self.post_process.report(self.pane, order.clone(), fault);
        };
        let nonfinite = image.radiances().iter().filter(|radiance| !radiance.is_finite()).count() as u64;
        let picture = Picture {
            image,
            external: Some(Arc::new(external)),
            before: None,
            lag: None,
            spp: None,
            runs: 1,
            seconds,
            effort: Effort::Traced(pathtrace::Stats::default()),
            noisy: false,
            nonfinite,
            adapter: "another program".into(),
            refused: None,
            filter_fault: None,
            cut: None,
            rough: false,
            coarse: false,
            // nobody knows, and the reference does not wait for it
            unfinished: false,
            order: order.clone(),
        };
        self.post_process.deliver(self.pane, picture);
    }
}

/// What stands in the place of a picture that nobody has sent.
fn waiting(source: &PaneSource) -> String {
    match source {
        PaneSource::Received(port) => {
            format!(
                "no picture yet: send one by tev's protocol to 127.0.0.1:{port}, as pbrt --display-server localhost:{port}"
            )
        }
        _ => "no picture yet".into(),
    }
}

impl Open {
    fn begin(source: &PaneSource) -> Result<Self, String> {
        match source {
            PaneSource::Received(port) => Receiver::start(*port).map(Open::Port),
            PaneSource::Followed(file) => Ok(Open::File(Follower::new(file.clone()))),
            PaneSource::Made => Err(FAULT.into()),
        }
    }

    fn every(&self) -> Duration {
        match self {
            Open::Port(_) => EVERY[0],
            Open::File(_) => EVERY[1],
        }
    }

    /// What is new since a version.
    fn since(&mut self, version: Option<u64>, source: &PaneSource) -> Option<Sight> {
        let source = source.clone();
        Some(match self {
            Open::Port(receiver) => {
                let Snapshot { version, picture, seconds, changes, fault } = receiver.since(version)?;
                let (name, picture) = picture.map_or((String::new(), None), |(name, image)| (name, Some(image)));
                Sight {
                    version,
                    picture,
                    seconds,
                    external: External { name, source, changes, notes: Vec::new(), fault },
                }
            }
            Open::File(follower) => {
                let FileState { version, picture, notes, seconds, changes, fault } = follower.since(version)?.clone();
                let name = name_of(&source);
                Sight { version, picture, seconds, external: External { name, source, changes, notes, fault } }
            }
        })
    }
}

fn name_of(source: &PaneSource) -> String {
    let PaneSource::Followed(file) = source else { return String::new() };
    image_file::shown(Path::new(file.file_name().unwrap_or(file.as_os_str())))
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
