//! Reading scenes beside the UI: a large file takes its time.

use super::Wake;
use super::worker::{Control, Service, Worker};
use scene::{Scene, builtin};
use std::cell::RefCell;

/// Reads scenes; the last one asked for wins, and does not wait for the others.
pub struct Loader {
    wake: Wake,
    /// Reads the last one; or why it does not.
    last: RefCell<Option<Result<Reader, String>>>,
}

type Reader = Worker<Option<String>, Option<Result<Opened, String>>>;

/// A scene that was read.
#[derive(Debug)]
pub struct Opened {
    /// What was asked for: a built-in name or a file.
    pub source: String,
    /// The scene that was read from it.
    pub scene: Scene,
    /// What of it is probably not meant, see [`Scene::notes`].
    pub notes: Vec<String>,
}

impl Loader {
    /// Calls `wake` whenever [`Loader::loaded`] has something.
    pub fn new(wake: Wake) -> Self {
        Loader { wake, last: RefCell::default() }
    }

    /// Reads a scene, by name or file, on a thread of its own.
    pub fn load(&self, name: String) {
        let started = Worker::start("loader", self.wake.clone(), || Scenes);
        let reader = started.map_err(|e| format!("no thread to read the scene ({e})"));
        if let Ok(reader) = &reader {
            reader.post(|slot| *slot = Some(name));
        }
        if let Some(Ok(before)) = self.last.replace(Some(reader)) {
            before.leave();
        }
    }

    /// The scene that was read since the last call, or why it was not.
    pub fn loaded(&self) -> Option<Result<Opened, String>> {
        let mut last = self.last.borrow_mut();
        let loaded = match last.as_ref()? {
            Ok(reader) => reader.collect().flatten()?,
            Err(fault) => Err(fault.clone()),
        };
        if let Some(Ok(reader)) = last.take() {
            reader.leave();
        }
        Some(loaded)
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        if let Some(Ok(reader)) = self.last.take() {
            // a window does not stay open until a scene is read
            reader.leave();
        }
    }
}

struct Scenes;

impl Service for Scenes {
    type Job = Option<String>;
    type Update = Option<Result<Opened, String>>;

    fn serve(&mut self, name: Option<String>, control: &Control<Self::Job, Self::Update>) {
        let Some(name) = name else { return };
        let read = builtin::named(&name).map_err(|e| e.to_string());
        control.tell(|loaded| *loaded = Some(read.map(|scene| Opened { source: name, notes: scene.notes(), scene })));
    }

    fn recover(&mut self, control: &Control<Self::Job, Self::Update>) {
        control.tell(|loaded| *loaded = Some(Err("reading the scene stopped at a fault of its own".into())));
    }
}
