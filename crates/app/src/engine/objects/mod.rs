//! The thread that finds out which shape each pixel shows, while parts of the scene are looked at: a map of the view, the
//! outline of what is chosen in it, and what lies behind each other where it is looked into. The scene stays ready for
//! rays from view to view, and the map from choice to choice.

mod outline;
#[cfg(test)]
mod tests;

use super::worker::{Control, Service, Worker};
use super::{FAULT, Wake, step_back};
use crate::model::{ObjectMap, ObjectsWish, ShapesAlong, pixel_at};
pub use outline::OutlinePicture;
use outline::outline;
use pathtrace::{MOST_ALONG, Tracer};
use scene::Scene;
use std::sync::Arc;
use technique::{Rank, Threads, Trees};

/// First pictures of what was changed go before; between passes that add samples it has its turn.
const RANK: Rank = Rank::Refinement;

/// What asks the thread, which is started when parts are first looked at; dropping it ends the thread.
#[derive(Default)]
pub struct Objects {
    worker: Option<Worker<Job, ObjectsNews>>,
    last: Option<ObjectsWish>,
    /// The number of jobs so far: answers to older ones are dropped.
    jobs: u64,
}

/// What the thread is asked for.
#[derive(Debug, Default)]
enum Job {
    /// Nothing: what was cancelled. The scene stays ready.
    #[default]
    Rest,
    /// To keep nothing of what nobody looks at.
    Forget,
    /// To find what is wanted; the number of this job.
    Find(u64, ObjectsWish),
}

/// What became of a job, or why nothing did: a line.
type ObjectsNews = Option<(u64, Result<FoundObjects, String>)>;

/// All that is known of a view.
#[derive(Debug, Clone)]
pub struct FoundObjects {
    /// Which shape each pixel shows; one and the same until another view is wanted.
    pub map: Arc<ObjectMap>,
    /// The outline of what was to be outlined, if any of it is seen.
    pub outline: Option<OutlinePicture>,
    /// What lies behind each other where the view is looked into.
    pub along: Option<ShapesAlong>,
}

impl Objects {
    /// Asks for what is wanted, if that is not what was asked for.
    pub fn follow(&mut self, wanted: Option<&ObjectsWish>, threads: &Arc<Threads>, wake: &Wake) {
        if self.last.as_ref() == wanted {
            return;
        }
        let Some(wish) = wanted else {
            if let Some(worker) = &self.worker {
                worker.cancel();
                worker.post(|job| *job = Job::Forget);
            }
            self.last = None;
            return;
        };
        if self.worker.is_none() {
            let threads = threads.clone();
            let service = move || {
                step_back();
                Finder::new(threads)
            };
            // without a thread nothing is found; the next frame tries again
            self.worker = Worker::start("objects", wake.clone(), service).ok();
        }
        let Some(worker) = &self.worker else { return };
        // the map in hand is also that of another choice in the same view
        let is_same_view = self.last.as_ref().is_some_and(|last| {
            Arc::ptr_eq(&last.scene, &wish.scene) && (last.camera, last.size) == (wish.camera, wish.size)
        });
        if !is_same_view {
            worker.cancel();
        }
        self.jobs += 1;
        worker.post(|job| *job = Job::Find(self.jobs, wish.clone()));
        self.last = Some(wish.clone());
    }

    /// Tells all again, whose texture is lost.
    pub(super) fn show_again(&mut self) {
        self.last = None;
    }

    /// What was found for the last wish since the last call, or why nothing was: a line.
    pub fn collect(&self) -> Option<Result<FoundObjects, String>> {
        let (number, found) = self.worker.as_ref()?.collect()??;
        (self.last.is_some() && number == self.jobs).then_some(found)
    }
}

/// The thread that finds what is wanted.
struct Finder {
    threads: Arc<Threads>,
    /// A scene, and that ready for rays.
    ready: Option<(Arc<Scene>, Arc<Tracer>)>,
    /// The map of the view that was asked for last.
    map: Option<Arc<ObjectMap>>,
    /// Of the job in hand.
    number: u64,
}

/// Says whether another view is wanted.
type Ends<'a> = dyn Fn() -> bool + Sync + 'a;

impl Service for Finder {
    type Job = Job;
    type Update = ObjectsNews;

    fn serve(&mut self, job: Job, control: &Control<Job, ObjectsNews>) {
        match job {
            Job::Rest => {}
            Job::Forget => self.forget(),
            Job::Find(number, wish) => {
                self.number = number;
                if let Some(found) = self.find(&wish, &|| control.ends_now()) {
                    control.tell(|news| *news = Some((number, Ok(found))));
                }
            }
        }
    }

    fn recover(&mut self, control: &Control<Job, ObjectsNews>) {
        self.forget();
        control.tell(|news| *news = Some((self.number, Err(FAULT.into()))));
    }
}

impl Finder {
    fn new(threads: Arc<Threads>) -> Self {
        Finder { threads, ready: None, map: None, number: 0 }
    }

    fn forget(&mut self) {
        (self.ready, self.map) = (None, None);
    }

    /// All that is wanted; `None` once `ends` says so.
    fn find(&mut self, wish: &ObjectsWish, ends: &Ends) -> Option<FoundObjects> {
        let map = match self.map.take().filter(|map| wish.is_of_the_view_of(map)) {
            Some(map) => map,
            None => Arc::new(self.trace(wish, ends)?),
        };
        self.map = Some(map.clone());
        let along = match wish.looked_into {
            Some(at) => Some(self.look_into(wish, at, ends)?),
            None => None,
        };
        Some(FoundObjects { outline: outline(&map, &wish.outlined), map, along })
    }

    fn trace(&mut self, wish: &ObjectsWish, ends: &Ends) -> Option<ObjectMap> {
        let tracer = self.make_ready(&wish.scene, ends)?;
        let (frame, size) = (wish.frame(), ObjectMap::size_for(wish.size));
        loop {
            // a rough picture goes before: of what is seen now there is one
            let gives_way = || ends() || self.threads.are_wanted_by_more_than(Rank::FirstPicture);
            let trace = || tracer.first_shapes(&frame, size, &gives_way);
            match self.threads.turn_unless(ends, RANK, trace)? {
                Some(shapes) => {
                    return Some(ObjectMap { scene: wish.scene.clone(), camera: wish.camera, size, shapes });
                }
                None if ends() => return None,
                None => {}
            }
        }
    }

    /// What lies behind each other at a place, in the middle of the map's pixel there: the map shows the first of it. One ray,
    /// which needs no turn.
    fn look_into(&mut self, wish: &ObjectsWish, at: [f32; 2], ends: &Ends) -> Option<ShapesAlong> {
        let tracer = self.make_ready(&wish.scene, ends)?;
        let size = ObjectMap::size_for(wish.size);
        let met = tracer.shapes_along(&wish.frame(), size, pixel_at(at, size), MOST_ALONG);
        Some(ShapesAlong { at, shapes: met.iter().map(|met| met.shape).collect() })
    }

    /// The scene ready for rays, made so unless it is.
    fn make_ready(&mut self, scene: &Arc<Scene>, ends: &Ends) -> Option<Arc<Tracer>> {
        if let Some((_, tracer)) = self.ready.as_ref().filter(|(ready, _)| Arc::ptr_eq(ready, scene)) {
            return Some(tracer.clone());
        }
        let _trees = Trees::of(scene, &|_| !ends())?;
        // before there is another: both would take twice the memory
        self.ready = None;
        let tracer = Arc::new(self.threads.turn_unless(ends, RANK, || Tracer::new(scene))?);
        self.ready = Some((scene.clone(), tracer.clone()));
        Some(tracer)
    }
}
