//! The threads beside the UI as one: asks them for whatever no longer fits what the viewer shows, and ends them.

use super::error_map::{ErrorMap, ErrorMapWorker};
use super::export::{Export, Exporter, Outcome};
use super::load::{Loader, Opened};
use super::pane_workers::PaneWorkers;
use super::post_process::{Comparison, PaneUpdate, PaneUpdates, PostProcess};
use super::reference::{Origin, ReferenceUpdate, ReferenceWorker, Wish};
use super::{Order, Side, Wake, step_back};
use crate::ruler::Against;
use crate::ui::Viewer;
use anyhow::Context;
use film::DisplayTransform;
use gpu::Gpu;
use scene::{Camera, Scene};
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::JoinHandle;
use technique::{Adapters, Provenance, SceneChanges, Shot, Technique, Threads};

/// The workers; dropping it ends their threads.
pub struct Engine {
    pane_workers: [PaneWorkers; 2],
    post_process: Arc<PostProcess>,
    post_process_thread: Option<JoinHandle<()>>,
    error_map_worker: Arc<ErrorMapWorker>,
    /// Made when it is first asked for.
    reference_worker: Option<ReferenceWorker>,
    /// Shared by all who trace rays.
    threads: Arc<Threads>,
    exporter: Exporter,
    loader: Loader,
    wake: Wake,
    asked: Asked,
}

/// What each worker was last asked for.
#[derive(Default)]
struct Asked {
    scene: Option<(u64, SceneChanges, Arc<Scene>)>,
    view: Option<View>,
    /// For each pane.
    made: [Option<(u64, u64, Technique)>; 2],
    /// For each pane its job, until its last picture has come.
    unfinished: [Option<u64>; 2],
    display: Option<DisplayTransform>,
    comparison: Comparison,
    /// The view and the origin of the reference.
    reference: Option<(u64, Origin)>,
    paused: bool,
    /// The first view of the scene that is open.
    oldest_view: u64,
    /// Counts views and jobs.
    views: u64,
    jobs: u64,
}

/// What both sides share.
#[derive(PartialEq)]
struct View {
    opened: u64,
    changes: SceneChanges,
    camera: Camera,
    size: (u32, u32),
}

impl Engine {
    /// Starts the threads; `wake` is called whenever there is something to collect.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn start(window: &Gpu, adapters: &Adapters, wake: Wake) -> anyhow::Result<Self> {
        let error_map_worker = Arc::new(ErrorMapWorker::start(wake.clone()).context("no thread for maps")?);
        let (post_process, thread) =
            PostProcess::start(wake.clone(), error_map_worker.clone()).context("no thread for the post_process")?;
        let threads = Arc::new(Threads::beside_the_ui(step_back).context("no threads for tracing rays")?);
        let panes =
            |side| PaneWorkers::new(side, window.clone(), (adapters.clone(), threads.clone()), post_process.clone());
        Ok(Engine {
            pane_workers: Side::ALL.map(panes),
            post_process,
            post_process_thread: Some(thread),
            error_map_worker,
            reference_worker: None,
            threads,
            exporter: Exporter::start(wake.clone()).context("no thread for exports")?,
            loader: Loader::new(wake.clone()),
            wake,
            asked: Asked::default(),
        })
    }

    /// Goes on with another device of the window: fakes are drawn again, and all that is shown is frame again.
    pub fn move_to(&mut self, window: &Gpu) {
        for (pane_workers, made) in self.pane_workers.iter_mut().zip(&mut self.asked.made) {
            pane_workers.move_to(window.clone());
            made.take_if(|(.., technique)| matches!(technique, Technique::Fake(_)));
        }
        self.asked.display = None;
        self.post_process.set_comparison(self.asked.comparison);
    }

    /// What is new since the last call.
    pub fn collect(&mut self) -> Option<PaneUpdates> {
        let mut updates = self.post_process.collect()?;
        for (place, job) in updates.iter_mut().zip(&mut self.asked.unfinished) {
            job.take_if(|job| place.as_ref().is_some_and(|update| is_the_last_of(update, *job)));
            place.take_if(
                |update| matches!(update, PaneUpdate::Picture(d) if d.picture.order.view < self.asked.oldest_view),
            );
        }
        Some(updates)
    }

    /// The map of errors that was drawn since the last call, or that there is none.
    pub fn error_map(&self) -> Option<Option<ErrorMap>> {
        self.error_map_worker.collect()
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

    /// Asks for what has changed in the viewer; returns for each pane the number of its new job, if there is one.
    pub fn ask(&mut self, viewer: &Viewer) -> [Option<u64>; 2] {
        let scene = self.asked.scene_of(viewer);
        let asked = &mut self.asked;
        if asked.display != Some(viewer.settings.display) {
            asked.display = Some(viewer.settings.display);
            self.post_process.set_display(viewer.settings.display);
        }
        if asked.paused != viewer.paused {
            asked.paused = viewer.paused;
            self.pane_workers.iter_mut().for_each(|pane_workers| pane_workers.hold(viewer.paused));
        }
        if asked.follow(viewer) {
            self.post_process.forget_before(asked.oldest_view);
        }
        let mut jobs = [None; 2];
        for (side, pane_workers) in self.pane_workers.iter_mut().enumerate() {
            let technique = viewer.settings.panes[side].in_use();
            let wish = Some((asked.views, viewer.restarts, technique));
            if asked.made[side] == wish {
                continue;
            }
            asked.made[side] = wish;
            pane_workers.submit(technique, asked.order(viewer, scene.clone(), technique));
            jobs[side] = Some(asked.jobs);
            asked.unfinished[side] = Some(asked.jobs);
        }
        self.compare(viewer, &scene);
        jobs
    }

    /// Follows what is compared with what; returns after posting.
    fn compare(&mut self, viewer: &Viewer, scene: &Arc<Scene>) {
        let comparison = viewer.comparison();
        if self.asked.comparison != comparison {
            self.asked.comparison = comparison;
            self.post_process.set_comparison(comparison);
        }
        let origin = match &self.asked.reference {
            Some((view, origin)) if *view == self.asked.views => origin.clone(),
            _ => Origin::Made,
        };
        match comparison.against {
            Against::Reference => self.refer(viewer, scene, origin),
            Against::EachOther => {
                self.reference_worker.iter_mut().for_each(ReferenceWorker::cancel);
                self.asked.reference = None;
            }
        }
        // the user explores: panes come first, and what is paused is quiet
        let busy = self.asked.unfinished.iter().any(Option::is_some);
        self.reference_worker.iter().for_each(|reference_worker| reference_worker.hold(busy || viewer.paused));
    }

    /// Takes the reference of what is seen from this file, until something else is seen.
    pub fn load_reference(&mut self, viewer: &Viewer, file: PathBuf) {
        let scene = self.asked.scene_of(viewer);
        // the same file once more is read once more: it may have changed
        self.asked.reference = None;
        self.refer(viewer, &scene, Origin::File(file));
    }

    fn refer(&mut self, viewer: &Viewer, scene: &Arc<Scene>, origin: Origin) {
        let wish = Some((self.asked.views, origin.clone()));
        if self.asked.reference == wish {
            return;
        }
        if self.reference_worker.is_none() {
            self.reference_worker =
                ReferenceWorker::start(self.threads.clone(), self.post_process.clone(), self.wake.clone()).ok();
        }
        self.asked.reference = wish;
        let shot = shot_of(viewer, scene.clone());
        let view = self.asked.views;
        self.reference_worker.iter_mut().for_each(|reference_worker| {
            reference_worker.submit(Wish { view, shot: shot.clone(), origin: origin.clone() })
        });
    }

    /// Reads a scene beside the UI.
    pub fn load(&self, name: String) {
        self.loader.load(name);
    }

    /// The scene that was read since the last call, or why it was not.
    pub fn loaded(&self) -> Option<Result<Opened, String>> {
        self.loader.loaded()
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
    /// The scene with the viewer's changes, the same one as long as they stay.
    fn scene_of(&mut self, viewer: &Viewer) -> Arc<Scene> {
        let (opened, changes) = (viewer.opened, viewer.settings.changes);
        let scene = match &self.scene {
            Some((of, with, scene)) if (*of, *with) == (opened, changes) => scene.clone(),
            _ => Arc::new(changes.applied_to(&viewer.scene)),
        };
        self.scene = Some((opened, changes, scene.clone()));
        scene
    }

    /// Takes a new number where the view has changed; returns whether older ones show another scene.
    fn follow(&mut self, viewer: &Viewer) -> bool {
        let view = View {
            opened: viewer.opened,
            changes: viewer.settings.changes,
            camera: viewer.camera,
            size: viewer.picture_size,
        };
        if self.view.as_ref() == Some(&view) {
            return false;
        }
        self.views += 1;
        let other_scene = self.view.as_ref().is_some_and(|old| old.opened != view.opened);
        if other_scene {
            self.oldest_view = self.views;
        }
        self.view = Some(view);
        other_scene
    }

    fn order(&mut self, viewer: &Viewer, scene: Arc<Scene>, technique: Technique) -> Order {
        self.jobs += 1;
        let (shot, device) = (shot_of(viewer, scene), technique.name().usual_device());
        let provenance = Arc::new(Provenance { shot, technique, device });
        let shrink = viewer.settings.resolution.shrink();
        Order { job: self.jobs, view: self.views, shrink, restarts: viewer.restarts, provenance }
    }
}

/// What is seen in both panes; `scene` is the viewer's with its changes.
fn shot_of(viewer: &Viewer, scene: Arc<Scene>) -> Shot {
    Shot {
        source: viewer.source.clone(),
        changes: viewer.settings.changes,
        scene,
        camera: viewer.camera,
        size: viewer.picture_size,
    }
}

/// Whether no more comes of a job after this.
fn is_the_last_of(update: &PaneUpdate, job: u64) -> bool {
    match update {
        PaneUpdate::Picture(frame) => frame.picture.order.job == job && !frame.picture.unfinished,
        PaneUpdate::Fault(_) => true,
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        // what it has made is kept while the others end
        self.reference_worker = None;
        self.error_map_worker.close();
        self.post_process.close();
        if let Some(thread) = self.post_process_thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}
