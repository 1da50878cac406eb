//! Rendering beside the UI. Each pane has a [`pane_workers`] with a thread for each technique it has used ([`fake`],
//! and [`rays`] with its [`progressive`], who holds a [`backend`] for the processor or for the graphics device); they
//! turn jobs into [`Picture`]s. The [`post_process`] turns pictures into bytes for the screen and measures how far
//! apart they are, from each other or from what the [`reference`] makes, and the [`error_map`] draws where; the
//! [`export`] writes files and fills the clipboard. Every thread is fed through an [`Inbox`] in which newer wishes
//! replace older ones. The UI thread only posts and collects.

pub mod ask;
pub mod backend;
pub mod capture;
pub mod error_map;
pub mod export;
pub mod fake;
pub mod load;
pub mod pane_workers;
pub mod post_process;
pub mod progressive;
pub mod rays;
pub mod reference;

use film::Image;
use scene::{Camera, Scene};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use technique::{Device, Provenance};

/// What a technique has made so far, in linear radiance.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Smaller than asked for in a rough first picture.
    pub image: Image,
    /// Samples per pixel; `None` for a technique that does not sample.
    pub spp: Option<u32>,
    /// Seconds of rendering.
    pub seconds: f64,
    /// Samples that were not finite and are left out.
    pub nonfinite: u64,
    /// What made it: a GPU's name, or a number of threads.
    pub adapter: Arc<str>,
    /// Why it was not made where it should be: one line.
    pub refused: Option<Arc<str>>,
    /// Whether this is a rough picture at a lower resolution.
    pub rough: bool,
    /// Whether more of this job will come.
    pub unfinished: bool,
    /// What it was made for.
    pub order: Order,
}

/// A picture to make: how, and all the rest.
#[derive(Debug, Clone)]
pub struct Job<S> {
    /// The settings of one technique.
    pub settings: S,
    /// What for.
    pub order: Order,
}

/// What a picture is made for.
#[derive(Debug, Clone)]
pub struct Order {
    /// Counts all jobs.
    pub job: u64,
    /// Counts what is seen: scene, camera and size. Only pictures of one view can be compared.
    pub view: u64,
    /// Pixels of the picture area along a side of one of the picture.
    pub shrink: u32,
    /// How often the user began the truth anew.
    pub restarts: u64,
    /// All that the picture depends on.
    pub provenance: Arc<Provenance>,
}

impl Order {
    /// The same, made on this machine.
    pub fn made_on(&self, device: Device) -> Self {
        let mut order = self.clone();
        if order.provenance.device != device {
            Arc::make_mut(&mut order.provenance).device = device;
        }
        order
    }

    /// From where.
    pub fn camera(&self) -> &Camera {
        &self.provenance.shot.camera
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.provenance.shot.size
    }

    /// The scene that is seen.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.provenance.shot.scene
    }
}

/// Lets the threads of the window go first, and those of its driver where the processor draws. What this thread starts
/// steps back with it.
pub fn step_back() {
    // only here is it a thread's own affair; one that may not step back is as fast as before
    #[cfg(target_os = "linux")]
    let _ = rustix::process::nice(10);
}

/// Wakes the UI thread when there is something to collect.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// A place for the latest wish: posting changes what has not been taken yet.
#[derive(Debug, Default)]
pub struct Inbox<T> {
    state: Mutex<State<T>>,
    arrived: Condvar,
}

#[derive(Debug, Default)]
struct State<T> {
    content: T,
    fresh: bool,
    closed: bool,
    /// Whether what is fresh is still taken after closing.
    finish: bool,
}

impl<T: Default> Inbox<T> {
    /// Changes the content and wakes the taker.
    pub fn post(&self, change: impl FnOnce(&mut T)) {
        let mut state = self.lock();
        change(&mut state.content);
        state.fresh = true;
        self.arrived.notify_one();
    }

    /// Changes the content, wakes nobody and returns what `change` does.
    pub fn change<R>(&self, change: impl FnOnce(&mut T) -> R) -> R {
        change(&mut self.lock().content)
    }

    /// Waits for something fresh and takes it; `None` once closed, or once closed and empty.
    pub fn take(&self) -> Option<T> {
        let mut state = self.lock();
        while !state.fresh && !state.closed {
            state = self.arrived.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        if state.closed && !(state.finish && state.fresh) {
            return None;
        }
        state.fresh = false;
        Some(std::mem::take(&mut state.content))
    }

    /// Takes what is fresh now, without waiting.
    pub fn take_now(&self) -> Option<T> {
        let mut state = self.lock();
        std::mem::take(&mut state.fresh).then(|| std::mem::take(&mut state.content))
    }

    /// Whether something waits to be taken, or the end.
    pub fn has_fresh(&self) -> bool {
        let state = self.lock();
        state.fresh || state.closed
    }

    /// Ends the taker's loop.
    pub fn close(&self) {
        self.lock().closed = true;
        self.arrived.notify_all();
    }

    /// Ends the taker's loop once it has taken what is there.
    pub fn close_when_empty(&self) {
        self.lock().finish = true;
        self.close();
    }

    /// A thread that panicked while it held the lock left whole content behind: posting and taking do not stop midway.
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newer_wishes_replace_older_ones() {
        let inbox = Inbox::<u32>::default();
        inbox.post(|v| *v = 1);
        inbox.post(|v| *v = 2);
        assert_eq!((inbox.take(), inbox.take_now()), (Some(2), None));
    }

    #[test]
    fn closing_when_empty_hands_out_the_rest() {
        let inbox = Inbox::<u32>::default();
        inbox.post(|v| *v = 3);
        inbox.close_when_empty();
        assert_eq!((inbox.take(), inbox.take()), (Some(3), None));
    }

    #[test]
    fn closing_ends_a_waiting_taker() {
        let inbox = Arc::new(Inbox::<u32>::default());
        let taker = std::thread::spawn({
            let inbox = inbox.clone();
            move || inbox.take()
        });
        inbox.close();
        assert_eq!(taker.join().unwrap(), None);
    }
}
