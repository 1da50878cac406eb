//! The threads beside the UI as one: asks them for whatever no longer fits what the viewer shows, and ends them.

use super::darkroom::{Comparison, Darkroom, News, Shelf};
use super::exporter::{Export, Exporter, Outcome};
use super::loader::{Loader, Opened};
use super::referee::{Bulletin, Origin, Referee, Wish};
use super::studio::Studio;
use super::surveyor::{Surveyed, Surveyor};
use super::{Order, Side, Wake};
use crate::ruler::{Against, Sought};
use crate::technique::{Adapters, Provenance, Recipe, SceneChanges};
use crate::ui::Viewer;
use anyhow::Context;
use gpu::Gpu;
use scene::display::DisplayTransform;
use scene::{Camera, Scene};
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::JoinHandle;

/// The workers; dropping it ends their threads.
pub struct Crew {
    studios: [Studio; 2],
    darkroom: Arc<Darkroom>,
    darkroom_thread: Option<JoinHandle<()>>,
    surveyor: Arc<Surveyor>,
    /// Made when it is first asked for.
    referee: Option<Referee>,
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
    made: [Option<(u64, u64, Recipe)>; 2],
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

impl Crew {
    /// Starts the threads; `wake` is called whenever there is something to collect.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn start(window: &Gpu, adapters: &Adapters, wake: Wake) -> anyhow::Result<Self> {
        let surveyor = Arc::new(Surveyor::start(wake.clone()).context("no thread for maps")?);
        let (darkroom, thread) =
            Darkroom::start(wake.clone(), surveyor.clone()).context("no thread for the darkroom")?;
        Ok(Crew {
            studios: [Side::A, Side::B]
                .map(|side| Studio::new(side, window.clone(), adapters.clone(), darkroom.clone())),
            darkroom,
            darkroom_thread: Some(thread),
            surveyor,
            referee: None,
            exporter: Exporter::start(wake.clone()).context("no thread for exports")?,
            loader: Loader::new(wake.clone()),
            wake,
            asked: Asked::default(),
        })
    }

    /// Goes on with another device of the window: fakes are drawn again, and all that is shown is developed again.
    pub fn move_to(&mut self, window: &Gpu) {
        for (studio, made) in self.studios.iter_mut().zip(&mut self.asked.made) {
            studio.move_to(window.clone());
            made.take_if(|(.., recipe)| matches!(recipe, Recipe::Fake(_)));
        }
        self.asked.display = None;
        self.darkroom.set_comparison(self.asked.comparison);
    }

    /// What is new since the last call.
    pub fn collect(&mut self) -> Option<Shelf> {
        let mut shelf = self.darkroom.collect()?;
        for (place, job) in shelf.iter_mut().zip(&mut self.asked.unfinished) {
            job.take_if(|job| place.as_ref().is_some_and(|news| is_the_last_of(news, *job)));
            place.take_if(|news| matches!(news, News::Picture(d) if d.picture.order.view < self.asked.oldest_view));
        }
        Some(shelf)
    }

    /// The map of errors that was drawn since the last call, or that there is none.
    pub fn surveyed(&self) -> Option<Option<Surveyed>> {
        self.surveyor.collect()
    }

    /// What the reference has to say since the last call.
    pub fn bulletin(&self) -> Option<Bulletin> {
        let mut bulletin = self.referee.as_ref()?.bulletin()?;
        bulletin.progress.take_if(|progress| Some(progress.view) != self.view_of_the_reference());
        Some(bulletin)
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
            self.darkroom.set_comparison(comparison);
        }
        let origin = match &self.asked.reference {
            Some((view, origin)) if *view == self.asked.views => origin.clone(),
            _ => Origin::Made,
        };
        match comparison.against {
            Against::Reference => self.refer(viewer, scene, origin),
            Against::EachOther => {
                self.referee.iter_mut().for_each(Referee::cancel);
                self.asked.reference = None;
            }
        }
        // the user explores: panes come first, and what is paused is quiet
        let busy = self.asked.unfinished.iter().any(Option::is_some);
        self.referee.iter().for_each(|referee| referee.hold(busy || viewer.paused));
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
        if self.referee.is_none() {
            self.referee = Referee::start(self.darkroom.clone(), self.wake.clone()).ok();
        }
        self.asked.reference = wish;
        let sought = Sought {
            source: viewer.source.clone(),
            changes: viewer.settings.changes,
            scene: scene.clone(),
            camera: viewer.camera,
            size: viewer.picture_size,
        };
        let view = self.asked.views;
        self.referee
            .iter_mut()
            .for_each(|referee| referee.submit(Wish { view, sought: sought.clone(), origin: origin.clone() }));
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
            device: recipe.technique().usual_machine(),
        });
        let shrink = viewer.settings.resolution.shrink();
        Order { job: self.jobs, view: self.views, shrink, restarts: viewer.restarts, scene, provenance }
    }
}

/// Whether no more comes of a job after this.
fn is_the_last_of(news: &News, job: u64) -> bool {
    match news {
        News::Picture(developed) => developed.picture.order.job == job && !developed.picture.unfinished,
        News::Fault(_) => true,
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        // what it has made is kept while the others end
        self.referee = None;
        self.surveyor.close();
        self.darkroom.close();
        if let Some(thread) = self.darkroom_thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}
