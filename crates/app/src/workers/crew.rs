//! The threads beside the UI as one: asks them for whatever no longer fits what the viewer shows, and ends them.

use super::darkroom::{Darkroom, News, Shelf};
use super::exporter::{Export, Exporter, Outcome};
use super::loader::{Loader, Opened};
use super::studio::Studio;
use super::{Order, Side, Wake};
use crate::technique::{Provenance, Recipe, SceneChanges};
use crate::ui::Viewer;
use anyhow::Context;
use gpu::Gpu;
use scene::display::DisplayTransform;
use scene::{Camera, Scene};
use std::sync::Arc;
use std::thread::JoinHandle;

/// The workers; dropping it ends their threads.
pub struct Crew {
    studios: [Studio; 2],
    darkroom: Arc<Darkroom>,
    darkroom_thread: Option<JoinHandle<()>>,
    exporter: Exporter,
    loader: Loader,
    asked: Asked,
}

/// What each worker was last asked for.
#[derive(Default)]
struct Asked {
    scene: Option<(u64, SceneChanges, Arc<Scene>)>,
    view: Option<View>,
    /// For each pane.
    made: [Option<(u64, u64, Recipe)>; 2],
    display: Option<DisplayTransform>,
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

impl Crew {
    /// Starts the threads; `wake` is called whenever there is something to collect.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn start(window: &Gpu, wake: Wake) -> anyhow::Result<Self> {
        let (darkroom, thread) = Darkroom::start(wake.clone()).context("no thread for the darkroom")?;
        Ok(Crew {
            studios: [Side::A, Side::B].map(|side| Studio::new(side, window.clone(), darkroom.clone())),
            darkroom,
            darkroom_thread: Some(thread),
            exporter: Exporter::start(wake.clone()).context("no thread for exports")?,
            loader: Loader::new(wake),
            asked: Asked::default(),
        })
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<Shelf> {
        let mut shelf = self.darkroom.collect()?;
        for place in &mut shelf {
            place.take_if(|news| matches!(news, News::Picture(d) if d.picture.order.view < self.asked.oldest_view));
        }
        Some(shelf)
    }

    /// Asks for what has changed in the viewer; returns for each pane the number of its new job, if there is one.
    pub fn ask(&mut self, viewer: &Viewer) -> [Option<u64>; 2] {
        let scene = self.asked.scene_of(viewer);
        let asked = &mut self.asked;
        if asked.display != Some(viewer.settings.display) {
            asked.display = Some(viewer.settings.display);
            self.darkroom.set_display(viewer.settings.display);
        }
        if asked.paused != viewer.paused {
            asked.paused = viewer.paused;
            self.studios.iter_mut().for_each(|studio| studio.hold(viewer.paused));
        }
        if asked.follow(viewer) {
            self.darkroom.forget_before(asked.oldest_view);
        }
        let mut jobs = [None; 2];
        for (side, studio) in self.studios.iter_mut().enumerate() {
            let recipe = viewer.settings.panes[side].recipe();
            let wish = Some((asked.views, viewer.restarts, recipe));
            if asked.made[side] == wish {
                continue;
            }
            asked.made[side] = wish;
            studio.submit(recipe, asked.order(viewer, scene.clone(), recipe));
            jobs[side] = Some(asked.jobs);
        }
        jobs
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

    fn order(&mut self, viewer: &Viewer, scene: Arc<Scene>, recipe: Recipe) -> Order {
        self.jobs += 1;
        let provenance = Arc::new(Provenance {
            source: viewer.source.clone(),
            changes: viewer.settings.changes,
            camera: viewer.camera,
            recipe,
            size: viewer.picture_size,
        });
        Order { job: self.jobs, view: self.views, restarts: viewer.restarts, scene, provenance }
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        self.darkroom.close();
        if let Some(thread) = self.darkroom_thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}
