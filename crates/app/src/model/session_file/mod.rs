//! A session's file: TOML that a teacher can read and write. Its first key, `session = 1`, tells it from a scene's file and
//! is its version. Settings stand under their names, and only where they are not those of a new pane: what is left out is as
//! in a new window. `docs/files.md` describes it.

mod ladder;
mod read;
mod table;
mod write;

pub use read::SessionDraft;

use super::{Model, PaneId, PaneSource, Panes, Session, Setup, Theme};
use scene::{Camera, Scene};
use std::path::Path;
use technique::{PaneSettings, SceneChanges};

/// The version that is written, and the latest that is read.
pub const SESSION_VERSION: u32 = 1;

/// More places to come back to nobody tells apart.
const MOST_BOOKMARKS: usize = 1000;

/// How a scene is looked at, as it is kept.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedSession {
    /// What is changed in the scene.
    pub changes: SceneChanges,
    /// Where all panes look from.
    pub camera: Camera,
    /// Places to come back to.
    pub bookmarks: Vec<Camera>,
    /// Panes, view and comparison.
    pub session: Session,
    /// Whether the wipe's line has a place, rather than the one that the scene gives it.
    pub line_placed: bool,
    /// How a window looks that is opened with it.
    pub window: SavedWindow,
}

/// How a window looks; `None` leaves it. One that is open already stays as it is, for that is the room's
/// and not the lecture's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SavedWindow {
    /// Width and height in points.
    pub size: Option<[f64; 2]>,
    /// Its colours and type sizes.
    pub theme: Option<Theme>,
    /// Whether the controls are open.
    pub panel: Option<bool>,
    /// Whether pictures have their labels.
    pub labels: Option<bool>,
}

/// Whether a text begins as a session does. That needs not be without faults, of which who opens it is then told.
pub fn is_session(text: &str) -> bool {
    let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim);
    let mut keys = lines.filter(|line| !line.is_empty() && !line.starts_with('#'));
    let first = keys.next().and_then(|line| line.strip_prefix("session"));
    first.is_some_and(|behind| behind.trim_start().starts_with('='))
}

/// A pane as a new window has it in this scene.
fn new_pane(id: PaneId, scene: &Scene) -> PaneSettings {
    let mut pane = *Session::default().panes.get(id).unwrap_or(&Session::default().panes[PaneId::A]);
    pane.take_usual_estimator(scene);
    pane
}

impl SavedSession {
    /// Pictures that are followed and whose names no text can have, with their panes.
    pub fn files_without_a_text(&self) -> impl Iterator<Item = (PaneId, &Path)> {
        self.session.sources.iter().filter_map(|(pane, source)| match source {
            PaneSource::Followed(file) if file.to_str().is_none() => Some((pane, file.as_path())),
            _ => None,
        })
    }

    /// All that is to be kept, seen in a window of this size in points.
    pub fn of(model: &Model, size: Option<[f64; 2]>) -> Self {
        let Model { document, session, state, .. } = model;
        SavedSession {
            changes: document.changes.clone(),
            camera: document.camera,
            bookmarks: document.bookmarks.clone(),
            session: Session { sweep: model.sweep_to_save(), ..session.clone() },
            line_placed: true,
            window: SavedWindow {
                size,
                theme: Some(state.theme),
                panel: Some(state.panel),
                labels: Some(state.labels),
            },
        }
    }
}

impl Model {
    /// Goes on with a session whose scene is open, but for what is set `beside` it. Undo does not go behind it.
    ///
    /// # Errors
    /// If the camera that is set beside it sees nothing.
    pub fn restore(&mut self, saved: &SavedSession, beside: &Setup) -> Result<(), String> {
        let SavedSession { changes, camera, bookmarks, session, line_placed, .. } = saved;
        self.session = session.clone();
        self.document.bookmarks.clone_from(bookmarks);
        self.state.line_placed = line_placed.then_some(self.document.opened);
        let setup = Setup {
            changes: changes.clone(),
            eye: Some(camera.eye),
            target: Some(camera.target),
            up: Some(camera.up),
            fov: Some(camera.fov_y),
            view: Some(session.view),
            region: session.comparison.region,
            ..Setup::default()
        };
        self.set_up(&setup.overridden_by(beside))
    }

    /// Makes a new window look as one did.
    pub fn restore_window(&mut self, window: &SavedWindow) {
        let state = &mut self.state;
        state.theme = window.theme.unwrap_or(state.theme);
        state.panel = window.panel.unwrap_or(state.panel);
        state.labels = window.labels.unwrap_or(state.labels);
    }
}

/// The panes of a new window.
fn new_panes(scene: &Scene) -> Panes<PaneSettings> {
    Session::default().panes.ids().map(|id| (id, new_pane(id, scene))).collect()
}

#[cfg(test)]
mod tests;
