//! The thread that draws maps of errors. It has its own because FLIP takes a third of a second, and no picture shall
//! wait for a map; a newer wish replaces one that was not begun.

use super::{Inbox, Wake, step_back};
use crate::model::{ErrorMap, ErrorMapJob};
use crate::ruler::HeatMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

/// The worker; [`ErrorMapWorker::close`] ends its thread.
pub struct ErrorMapWorker {
    inbox: Arc<Inbox<Option<ErrorMapJob>>>,
    updates: Arc<Inbox<Option<ErrorMap>>>,
    thread: Mutex<Option<JoinHandle<()>>>,
}

impl ErrorMapWorker {
    /// Starts the thread, which calls `wake` whenever [`ErrorMapWorker::collect`] has something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake) -> std::io::Result<Self> {
        let (inbox, updates) = (Arc::new(Inbox::<Option<ErrorMapJob>>::default()), Arc::new(Inbox::default()));
        let thread = std::thread::Builder::new().name("error_map_worker".into()).spawn({
            let (inbox, updates) = (inbox.clone(), updates.clone());
            move || {
                step_back();
                while let Some(map_job) = inbox.take() {
                    // two pictures without the same pixels have no map
                    let drawn = map_job.and_then(draw);
                    updates.post(|place| *place = drawn);
                    wake();
                }
            }
        })?;
        Ok(ErrorMapWorker { inbox, updates, thread: Mutex::new(Some(thread)) })
    }

    /// Asks for a map, or says that there is nothing to draw.
    pub fn submit(&self, map_job: Option<ErrorMapJob>) {
        self.inbox.post(|slot| *slot = map_job);
    }

    /// What is new since the last call: a map, or that there is none.
    pub fn collect(&self) -> Option<Option<ErrorMap>> {
        self.updates.take_now()
    }

    /// Ends the thread.
    pub fn close(&self) {
        self.inbox.close();
        let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(thread) = thread {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}

fn draw(map_job: ErrorMapJob) -> Option<ErrorMap> {
    let map = HeatMap::of(&map_job.pair, map_job.map, map_job.held).ok()?;
    let rgba = map.rgba();
    Some(ErrorMap { map_job, map, rgba })
}
