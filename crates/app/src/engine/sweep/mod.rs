//! Sweeps beside the UI: a thread that makes tiles and then their reference (`tiles`), and one that turns both into bytes for
//! the screen and into errors (`show`), so that no picture waits for a figure.

pub(super) mod show;
mod tiles;

pub use show::ShownTile;

use self::show::{Show, Shown};
use self::tiles::{Job, Tiles, TilesUpdate};
use super::Wake;
use super::ask::Engine;
use super::make_reference::OpenStore;
use super::worker::Worker;
use crate::model::{Progress, Wanted, WantedSweep};
use crate::ruler::ReferenceImage;
use crate::sweep::{Devices, Tile};
use film::DisplayTransform;
use gpu::Gpu;
use std::sync::Arc;
use technique::{Adapters, Backend, Device, Threads, Trees};

/// The threads; dropping it ends them.
pub struct Sweeper {
    tiles: Worker<Option<Job>, TilesUpdate>,
    show: Worker<Option<Show>, Shown>,
    /// What was asked for last.
    asked: Option<(WantedSweep, u64)>,
    /// Counts what was asked for.
    number: u64,
    /// What there is of it.
    made: Vec<Option<Arc<Tile>>>,
    reference: Option<Arc<ReferenceImage>>,
    display: DisplayTransform,
}

/// What is new of a sweep.
#[derive(Debug, Default)]
pub struct SweepNews {
    /// Counts sweeps: what was known of one with another number holds no more.
    pub number: u64,
    /// Tiles by their places, with what of them has changed.
    pub tiles: Vec<(usize, ShownTile)>,
    /// How far the reference has come.
    pub reference: Option<Progress>,
    /// Lines for the user.
    pub faults: Vec<String>,
}

impl Sweeper {
    /// Starts the threads: the fake is drawn by `gpu`, rays are traced on `threads` or by one of `adapters`.
    ///
    /// # Errors
    /// If the system gives no threads.
    fn start(
        (gpu, adapters, threads): (Gpu, Adapters, Arc<Threads>),
        open_store: OpenStore,
        wake: Wake,
    ) -> std::io::Result<Self> {
        let tiles = Worker::start("sweep", wake.clone(), move || {
            super::step_back();
            Tiles::new(move || devices(gpu.clone(), adapters.clone(), threads.clone()), open_store)
        })?;
        let show = Worker::start("sweep shown", wake, || {
            super::step_back();
            show::Shower::default()
        })?;
        let (made, reference, display) = (Vec::new(), None, DisplayTransform::default());
        Ok(Sweeper { tiles, show, asked: None, number: 0, made, reference, display })
    }

    /// Asks for what is wanted.
    fn ask(&mut self, wanted: &Wanted) {
        self.tiles.hold(wanted.paused);
        let asked = wanted.sweep.clone().map(|sweep| (sweep, wanted.restarts));
        if self.asked != asked {
            self.tiles.cancel();
            self.number += 1;
            (self.made, self.reference) = (Vec::new(), None);
            if let Some((sweep, restarts)) = &asked {
                self.made = vec![None; sweep.plan.tiles.len()];
                let job = Job { number: self.number, sweep: sweep.clone(), restarts: *restarts };
                self.tiles.post(|slot| *slot = Some(job));
            }
            self.asked = asked;
        }
        if self.display != wanted.display {
            self.display = wanted.display;
            self.show_all();
        }
    }

    /// What is new since the last call.
    fn collect(&mut self) -> SweepNews {
        let mut news = SweepNews { number: self.number, ..SweepNews::default() };
        if let Some(update) = self.tiles.collect().filter(|update| update.number == self.number) {
            for (place, tile) in update.tiles {
                self.made.get_mut(place).into_iter().for_each(|made| *made = Some(tile.clone()));
            }
            self.reference = update.reference.or(self.reference.take());
            (news.reference, news.faults) = (update.progress, update.faults);
            self.show_all();
        }
        if let Some(shown) = self.show.collect().filter(|shown| shown.number == self.number) {
            news.tiles = shown.tiles.into_iter().collect();
        }
        news
    }

    fn show_all(&self) {
        let (number, tiles, reference) = (self.number, self.made.clone(), self.reference.clone());
        let show = Show { number, tiles, reference, display: self.display };
        self.show.post(|slot| *slot = Some(show));
    }
}

impl Drop for Sweeper {
    fn drop(&mut self) {
        // a reference in hand is kept before its thread ends
        self.tiles.cancel();
    }
}

impl Engine {
    /// Asks for the sweep that is wanted, if one is.
    pub(super) fn ask_sweep(&mut self, wanted: &Wanted) {
        if self.sweeper.is_none() && wanted.sweep.is_some() {
            let makers = (self.gpu.clone(), self.adapters.clone(), self.threads.clone());
            // without threads there is none; the next frame tries again
            self.sweeper = Sweeper::start(makers, self.open_store.clone(), self.wake.clone()).ok();
        }
        self.sweeper.iter_mut().for_each(|sweeper| sweeper.ask(wanted));
    }

    /// What is new of the sweep since the last call.
    pub fn sweep_news(&mut self) -> Option<SweepNews> {
        self.sweeper.as_mut().map(Sweeper::collect)
    }
}

/// What tiles are made by beside a window.
pub(super) fn devices(gpu: Gpu, adapters: Adapters, threads: Arc<Threads>) -> Devices {
    let on = threads.clone();
    Devices {
        threads,
        open_gpu: Box::new(move || Ok(gpu.clone())),
        ready: Box::new(move |traced, scene, _| {
            // who waits holds no threads
            let _trees = Trees::of(scene, &|_| true);
            let processor =
                |why| Ok((on.turn(technique::Rank::FirstPicture, || Backend::on_the_processor(scene)), why));
            if traced.device_choice().beside(adapters.only_software()) == Device::Cpu {
                return processor(None);
            }
            let chosen = adapters.0.get(usize::from(traced.adapter)).or(adapters.0.first());
            let name = chosen.map_or("of any kind", |adapter| adapter.name.as_str());
            match Backend::beside_a_window(name, scene) {
                Ok(backend) => Ok((backend, None)),
                Err(fault) => processor(Some(format!("by the CPU: the GPU failed: {fault}"))),
            }
        }),
    }
}
