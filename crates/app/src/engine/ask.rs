//! The threads beside the UI as one: asks them for whatever no longer fits what is wanted, and ends them.

use super::asked_pane::{AskedPane, FakesTime};
use super::dialogue::Dialogues;
use super::error_map::ErrorMapWorker;
use super::export::{Export, Exporter, Outcome};
use super::load::{Asked as AskedFile, Loaded, Loader, Refusal};
use super::make_reference::OpenStore;
use super::pane_workers::PaneWorkers;
use super::post_process::{PaneUpdates, PostProcess};
use super::reference::{ReferenceUpdate, ReferenceWorker, Wish};
use super::sweep::Sweeper;
use super::thumbnails::Thumbnails;
use super::watch::{News, Watched, Watcher};
use super::{Order, STEPS_BACK, Wake, light::LightMeter, step_farther_back};
use crate::model::{Against, Comparison, ErrorMap, MapWish, Origin, PaneId, Panes, Wanted, WantedPane};
use anyhow::Context;
use film::DisplayTransform;
use gpu::Gpu;
use std::path::PathBuf;
use std::sync::Arc;
use technique::{Adapters, Provenance, Shot, Technique, Threads};

/// The workers; dropping it ends their threads.
pub struct Engine {
    /// The window's device, and what can trace rays.
    pub(super) gpu: Gpu,
    pub(super) adapters: Adapters,
    /// Made when a pane is first wanted.
    pane_workers: Panes<PaneWorkers>,
    post_process: Arc<PostProcess>,
    error_map_worker: Arc<ErrorMapWorker>,
    /// Made when it is first asked for.
    reference_worker: Option<ReferenceWorker>,
    pub(super) open_store: OpenStore,
    /// Shared by all who trace rays.
    pub(super) threads: Arc<Threads>,
    exporter: Exporter,
    loader: Loader,
    /// Reads pictures to compare with, whatever else is opened.
    reference_loader: Loader,
    watcher: Watcher,
    pub(super) dialogues: Dialogues,
    /// Made when they are first asked for.
    pub(super) thumbnails: Option<Thumbnails>,
    /// Made when they are first asked for, as are trees, hard cases and ladders.
    pub(super) sweeper: Option<Sweeper>,
    pub(super) trees: Option<super::trees::TreeStudy>,
    pub(super) cases: Option<super::cases::CaseBench>,
    pub(super) ladder: Option<super::ladder::LadderStudy>,
    /// Looks into a pixel.
    pub probes: super::probe::Probes,
    /// Finds which shape each pixel shows.
    pub objects: super::objects::Objects,
    pub(crate) light: LightMeter,
    pub(super) wake: Wake,
    asked: Asked,
}

/// What each worker was last asked for.
#[derive(Default)]
struct Asked {
    opened: u64,
    /// What is seen, and the number of each: panes that show the same share it.
    views: Vec<(u64, Shot)>,
    panes: Panes<AskedPane>,
    display: Option<DisplayTransform>,
    comparisons: Vec<Comparison>,
    map: Option<MapWish>,
    histograms: bool,
    /// The view and the origin of the reference.
    reference: Option<(u64, Origin)>,
    paused: bool,
    /// The first view of the scene that is open.
    oldest_view: u64,
    /// Count views and jobs.
    newest_view: u64,
    jobs: u64,
}

impl Engine {
    /// Starts the threads; `wake` is called whenever there is something to collect. References are kept where
    /// `open_store` says.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn start(window: &Gpu, adapters: &Adapters, open_store: OpenStore, wake: Wake) -> anyhow::Result<Self> {
        let error_map_worker = Arc::new(ErrorMapWorker::start(wake.clone()).context("no thread for maps")?);
        let post_process =
            PostProcess::start(wake.clone(), error_map_worker.clone()).context("no thread for post-processing")?;
        let threads =
            Arc::new(Threads::beside_the_ui(step_farther_back, STEPS_BACK).context("no threads for tracing rays")?);
        Ok(Engine {
            gpu: window.clone(),
            adapters: adapters.clone(),
            pane_workers: Panes::default(),
            post_process: Arc::new(post_process),
            error_map_worker,
            reference_worker: None,
            light: LightMeter::new(threads.clone(), wake.clone()),
            open_store,
            threads,
            exporter: Exporter::start(wake.clone()).context("no thread for exports")?,
            loader: Loader::new(wake.clone()),
            reference_loader: Loader::new(wake.clone()),
            watcher: Watcher::start(wake.clone()).context("no thread to watch files")?,
            dialogues: Dialogues::new(wake.clone()),
            thumbnails: None,
            sweeper: None,
            trees: None,
            cases: None,
            ladder: None,
            probes: Default::default(),
            objects: Default::default(),
            wake,
            asked: Asked::default(),
        })
    }

    /// Goes on with another device of the window: fakes are drawn again, and all that is shown is resolved again.
    pub fn move_to(&mut self, window: &Gpu) {
        self.gpu = window.clone();
        (self.sweeper, self.ladder) = (None, None);
        self.show_trees_again();
        self.objects.show_again();
        self.pane_workers.values_mut().for_each(|workers| workers.move_to(window.clone()));
        for pane in self.asked.panes.values_mut() {
            pane.made.take_if(|(_, technique, _)| matches!(technique, Technique::Fake(_)));
        }
        self.asked.display = None;
        self.post_process.set_comparisons(self.asked.comparisons.clone(), self.asked.map);
    }

    /// What the rays of panes wait for now, in words, where that has changed since the last call.
    pub fn waiting(&self) -> Panes<Option<String>> {
        self.pane_workers.iter().filter_map(|(id, workers)| Some((id, workers.news()?))).collect()
    }

    /// What is new since the last call.
    pub fn collect(&mut self) -> Option<PaneUpdates> {
        let mut updates = self.post_process.collect()?;
        for (id, pane) in self.asked.panes.iter_mut() {
            updates.get(id).into_iter().for_each(|update| pane.follow(update));
        }
        let (oldest_view, asked) = (self.asked.oldest_view, &self.asked.panes);
        updates.retain(|id, update| asked.get(id).is_some() && !update.is_older_than(oldest_view));
        Some(updates)
    }

    /// The map of errors that was drawn since the last call, or that there is none.
    pub fn error_map(&self) -> Option<Option<ErrorMap>> {
        let looked_at = self.asked.map.is_some();
        self.error_map_worker.collect().map(|drawn| drawn.filter(|_| looked_at))
    }

    /// What the reference has to say since the last call.
    pub fn update(&self) -> Option<ReferenceUpdate> {
        let mut update = self.reference_worker.as_ref()?.update()?;
        update.progress.take_if(|progress| Some(progress.view) != self.view_of_the_reference());
        Some(update)
    }

    /// The view whose reference is asked for, if one is.
    pub fn view_of_the_reference(&self) -> Option<u64> {
        self.asked.reference.as_ref().map(|(view, _)| *view)
    }

    /// Asks for what is wanted and was not before; returns the numbers of the new jobs.
    pub fn ask(&mut self, wanted: &Wanted) -> Panes<u64> {
        let asked = &mut self.asked;
        if asked.display != Some(wanted.display) {
            asked.display = Some(wanted.display);
            self.post_process.set_display(wanted.display);
        }
        if asked.paused != wanted.paused {
            asked.paused = wanted.paused;
            self.pane_workers.values_mut().for_each(|workers| workers.hold(wanted.paused));
        }
        self.follow_the_panes(wanted);
        if self.asked.follow_the_scene(wanted) {
            self.post_process.forget_before(self.asked.oldest_view);
        }
        let mut jobs = Panes::default();
        for (id, pane) in wanted.panes.iter() {
            if let Some(order) = self.asked.order(id, pane, wanted.restarts) {
                jobs.insert(id, order.job);
                // panes come first: the reference is told before it has to wait for them
                self.reference_worker.iter().for_each(|reference_worker| reference_worker.hold(true));
                self.workers(id).submit(pane.technique, &pane.source, order);
            }
        }
        self.measure_fakes();
        self.light.measure(&wanted.light);
        self.compare(wanted);
        [Engine::ask_sweep, Engine::ask_ladder, Engine::ask_trees].into_iter().for_each(|ask| ask(self, wanted));
        self.probes.follow(wanted, &self.threads, &self.wake);
        self.objects.follow(wanted.objects.as_ref(), &self.threads, &self.wake);
        jobs
    }

    /// Once all panes rest, fakes are measured again, one after the other: so far what else was made has slowed them.
    fn measure_fakes(&mut self) {
        if self.asked.is_busy() {
            return;
        }
        let at_work = self.asked.panes.iter_mut().find(|(_, pane)| pane.fakes_time == FakesTime::AtWork);
        if let Some((id, pane)) = at_work {
            pane.fakes_time = FakesTime::InHand;
            self.reference_worker.iter().for_each(|reference_worker| reference_worker.hold(true));
            self.pane_workers.get(id).into_iter().for_each(PaneWorkers::measure_again);
        }
    }

    /// Stops the workers of panes that are no longer wanted. They stay: what they have made is there again with the
    /// pane.
    fn follow_the_panes(&mut self, wanted: &Wanted) {
        let gone: Vec<PaneId> = self.asked.panes.ids().filter(|id| wanted.panes.get(*id).is_none()).collect();
        for id in gone {
            self.asked.panes.remove(id);
            self.pane_workers.get_mut(id).into_iter().for_each(PaneWorkers::rest_unseen);
            self.post_process.forget_pane(id);
        }
        for (id, workers) in self.pane_workers.iter_mut().filter(|(id, _)| wanted.panes.get(*id).is_none()) {
            workers.follow_unseen(wanted.sources.get(id));
        }
    }

    fn workers(&mut self, id: PaneId) -> &mut PaneWorkers {
        if self.pane_workers.get(id).is_none() {
            let tracers = (self.adapters.clone(), self.threads.clone());
            let mut workers =
                PaneWorkers::new(id, self.gpu.clone(), tracers, self.post_process.clone(), self.wake.clone());
            workers.hold(self.asked.paused);
            self.pane_workers.insert(id, workers);
        }
        &mut self.pane_workers[id]
    }

    /// Follows what is compared with what.
    fn compare(&mut self, wanted: &Wanted) {
        if (&self.asked.comparisons, self.asked.map) != (&wanted.comparisons, wanted.map) {
            (self.asked.comparisons, self.asked.map) = (wanted.comparisons.clone(), wanted.map);
            self.post_process.set_comparisons(wanted.comparisons.clone(), wanted.map);
        }
        if self.asked.histograms != wanted.histograms {
            self.asked.histograms = wanted.histograms;
            self.post_process.set_histograms(wanted.histograms);
        }
        // one reference at a time: of what the first pane shows that is judged by one
        let mut judged = wanted.comparisons.iter().filter(|comparison| comparison.against == Against::Reference);
        match judged.next().and_then(|comparison| self.asked.panes.get(comparison.of)) {
            Some(&AskedPane { view, .. }) => {
                let origin = match &self.asked.reference {
                    Some((of, origin)) if *of == view => origin.clone(),
                    _ => Origin::Made,
                };
                self.refer(view, origin);
            }
            None => {
                self.reference_worker.iter_mut().for_each(ReferenceWorker::cancel);
                self.asked.reference = None;
            }
        }
        // the user explores: panes come first, and what is paused is quiet
        let held = self.asked.is_busy() || wanted.paused;
        self.reference_worker.iter().for_each(|reference_worker| reference_worker.hold(held));
    }

    /// Takes the reference of what is seen from this file, until something else is seen.
    pub fn load_reference(&mut self, file: PathBuf) {
        // the same file once more is read once more: it may have changed
        let before = self.asked.reference.take();
        let seen = before.map(|(view, _)| view).or_else(|| Some(self.asked.views.first()?.0));
        seen.into_iter().for_each(|view| self.refer(view, Origin::File(file.clone())));
    }

    fn refer(&mut self, view: u64, origin: Origin) {
        let wish = Some((view, origin.clone()));
        let Some((_, shot)) = self.asked.views.iter().find(|(number, _)| *number == view) else { return };
        if self.asked.reference == wish {
            return;
        }
        let shot = shot.clone();
        if self.reference_worker.is_none() {
            // without threads there is no reference; the next frame tries again
            self.reference_worker = ReferenceWorker::start(
                self.threads.clone(),
                self.post_process.clone(),
                self.open_store.clone(),
                self.wake.clone(),
            )
            .ok();
        }
        if let Some(worker) = &mut self.reference_worker {
            worker.submit(Wish { view, shot, origin });
            self.asked.reference = wish;
        }
    }

    /// Reads a file beside the UI.
    pub fn load(&self, asked: AskedFile) {
        match asked {
            AskedFile::Open { .. } => self.loader.load(asked),
            AskedFile::Reference(_) => self.reference_loader.load(asked),
        }
    }

    /// What was read since the last call, or why nothing was; `doing` becomes what is being read.
    pub fn loaded(&self, doing: &mut Option<String>) -> Option<Result<Loaded, Refusal>> {
        self.loader.loaded(doing).or_else(|| self.reference_loader.loaded(&mut None))
    }

    /// Reads the scene no further that is being read; whether there was one.
    pub fn stop_loading(&self) -> bool {
        self.loader.stop()
    }

    /// Watches the file of the scene that is open, if it is one.
    pub fn watch(&self, watched: Option<Watched>) {
        self.watcher.watch(watched);
    }

    /// What has changed on disk since the last call.
    pub fn news(&self) -> News {
        self.watcher.news()
    }

    /// Writes a picture to a file or the clipboard.
    pub fn export(&self, export: Export) {
        self.exporter.submit(export);
    }

    /// What has become of exports since the last call.
    pub fn exported(&self) -> Vec<Outcome> {
        self.exporter.outcomes()
    }
}

impl Asked {
    /// Gives each pane the number of what it shows, a new one where nobody showed that before; returns whether older
    /// ones show another scene.
    fn follow_the_scene(&mut self, wanted: &Wanted) -> bool {
        let other_scene = self.newest_view > 0 && self.opened != wanted.opened;
        self.opened = wanted.opened;
        if other_scene {
            self.oldest_view = self.newest_view + 1;
        }
        let oldest_view = self.oldest_view;
        let mut before = std::mem::take(&mut self.views);
        before.retain(|(number, _)| *number >= oldest_view);
        for (id, pane) in wanted.panes.iter() {
            let shows = |(_, shot): &&(u64, Shot)| shot.is_of_the_same_view(&pane.shot);
            let known = self.views.iter().find(shows).or_else(|| before.iter().find(shows)).map(|(number, _)| *number);
            let view = known.unwrap_or_else(|| {
                self.newest_view += 1;
                self.newest_view
            });
            if !self.views.iter().any(|(number, _)| *number == view) {
                self.views.push((view, pane.shot.clone()));
            }
            let asked = self.panes.entry(id);
            if asked.view != view {
                (asked.view, asked.made) = (view, None);
            }
        }
        other_scene
    }

    /// Whether a pane's picture is being made or measured.
    fn is_busy(&self) -> bool {
        self.panes.values().any(AskedPane::is_busy)
    }

    /// What a pane's workers are to make, if that is not what they were asked for.
    fn order(&mut self, id: PaneId, pane: &WantedPane, restarts: u64) -> Option<Order> {
        let asked = self.panes.entry(id);
        let made = Some((restarts, pane.technique, pane.source.clone()));
        if asked.made == made {
            return None;
        }
        self.jobs += 1;
        (asked.made, asked.unfinished) = (made, Some(self.jobs));
        asked.fakes_time = FakesTime::Settled;
        let (shot, technique) = (pane.shot.clone(), pane.technique);
        let provenance = Arc::new(Provenance { shot, technique, device: technique.name().usual_device() });
        let (view, shrink, own_camera) = (asked.view, pane.shrink, pane.own_camera);
        Some(Order { job: self.jobs, view, shrink, restarts, own_camera, provenance })
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        // who waits for a pane's threads to end, ends only after it
        self.pane_workers.values_mut().for_each(PaneWorkers::rest);
        // what it has made is kept while the others end
        self.reference_worker = None;
        self.error_map_worker.close();
        self.post_process.close();
    }
}
