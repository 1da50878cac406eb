//! The thread that draws maps of errors. It has its own because FLIP takes a third of a second, and no picture shall
//! wait for a map; a newer wish replaces one that was not begun.

use super::worker::{Control, Service, Worker};
use super::{Wake, step_back};
use crate::model::{ErrorMap, ErrorMapJob};
use crate::ruler::HeatMap;
use compare::finite_mean;

/// The worker; [`ErrorMapWorker::close`] ends its thread.
pub struct ErrorMapWorker(Worker<Option<ErrorMapJob>, Option<ErrorMap>>);

impl ErrorMapWorker {
    /// Starts the thread, which calls `wake` whenever [`ErrorMapWorker::collect`] has something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake) -> std::io::Result<Self> {
        let service = || {
            step_back();
            ErrorMaps
        };
        Worker::start("error_map_worker", wake, service).map(ErrorMapWorker)
    }

    /// Asks for a map, or says that there is nothing to draw.
    pub fn submit(&self, map_job: Option<ErrorMapJob>) {
        self.0.post(|slot| *slot = map_job);
    }

    /// What is new since the last call: a map, or that there is none.
    pub fn collect(&self) -> Option<Option<ErrorMap>> {
        self.0.collect()
    }

    /// Ends the thread.
    pub fn close(&self) {
        self.0.close();
    }
}

struct ErrorMaps;

impl Service for ErrorMaps {
    type Job = Option<ErrorMapJob>;
    type Update = Option<ErrorMap>;

    fn serve(&mut self, map_job: Self::Job, control: &Control<Self::Job, Self::Update>) {
        // two pictures without the same pixels have no map
        let drawn = map_job.and_then(draw);
        control.tell(|place| *place = drawn);
    }

    fn recover(&mut self, control: &Control<Self::Job, Self::Update>) {
        control.tell(|place| *place = None);
    }
}

fn draw(map_job: ErrorMapJob) -> Option<ErrorMap> {
    let map = HeatMap::of(&map_job.pair, map_job.map, map_job.held).ok()?;
    let rgba = map.rgba();
    let (mean, nonfinite) = match map_job.region {
        Some(region) => {
            let rect = region.pixels((map.width, map.height()));
            finite_mean(&rect.of(&map.values, map.width).copied().collect::<Vec<_>>())
        }
        None => (map.mean, map.nonfinite),
    };
    Some(ErrorMap { map_job, map, mean, nonfinite, rgba })
}
