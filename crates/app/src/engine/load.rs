//! Reading scenes beside the UI: a large file takes its time.

use super::{Inbox, Wake};
use scene::{Scene, builtin};
use std::sync::Arc;

/// Reads one scene after the other; the last one asked for wins.
pub struct Loader {
    updates: Arc<Inbox<PaneUpdates>>,
    wake: Wake,
}

/// A scene that was read.
#[derive(Debug)]
pub struct Opened {
    /// What was asked for: a built-in name or a file.
    pub source: String,
    /// What it holds.
    pub scene: Scene,
}

#[derive(Default)]
struct PaneUpdates {
    wanted: u64,
    loaded: Option<Result<Opened, String>>,
}

impl Loader {
    /// Calls `wake` whenever [`Loader::loaded`] has something.
    pub fn new(wake: Wake) -> Self {
        Loader { updates: Arc::default(), wake }
    }

    /// Reads a scene, by name or file, on a thread of its own.
    pub fn load(&self, name: String) {
        let (updates, wake) = (self.updates.clone(), self.wake.clone());
        let number = updates.change(|updates| {
            updates.wanted += 1;
            updates.wanted
        });
        let started = std::thread::Builder::new().name("loader".into()).spawn({
            let updates = updates.clone();
            move || {
                let read = builtin::named(&name).map_err(|e| e.to_string());
                let loaded = read.map(|scene| Opened { source: name, scene });
                updates.change(|updates| {
                    if updates.wanted == number {
                        updates.loaded = Some(loaded);
                    }
                });
                wake();
            }
        });
        if let Err(e) = started {
            updates.change(|updates| updates.loaded = Some(Err(format!("no thread to read the scene ({e})"))));
        }
    }

    /// The scene that was read since the last call, or why it was not.
    pub fn loaded(&self) -> Option<Result<Opened, String>> {
        self.updates.change(|updates| updates.loaded.take())
    }
}
