//! What undo gives back: the camera, the settings of all panes, what a sweep varies, what a ladder repairs, the scene's sliders and the display.

use super::{Axis, Document, Equal, Order, PaneSource, Panes, Resolution, Session};
use film::DisplayTransform;
use raster::Repairs;
use scene::edit::Edits;
use scene::{Camera, Scene};
use technique::{PaneSettings, SceneChanges};

/// Everything that a slider, a choice or the mouse on the picture changes. View and line are not part of it: moving them loses nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Where all panes look from.
    pub camera: Camera,
    /// What is changed in the scene, for all panes.
    pub changes: SceneChanges,
    /// How each is made.
    pub panes: Panes<PaneSettings>,
    /// Where the pictures come from that are not made here.
    pub sources: Panes<PaneSource>,
    /// What a sweep varies along columns and rows, what is equal of its tiles, and their seconds.
    pub sweep: (Axis, Axis, Equal, f32),
    /// What is repaired on a ladder, and in which order.
    pub ladder: (Repairs, Order),
    /// How all are shown.
    pub display: DisplayTransform,
    /// How many pixels pictures have.
    pub resolution: Resolution,
}

impl Settings {
    /// The settings as they stand now.
    pub fn of(document: &Document, session: &Session) -> Self {
        let Session { panes, sources, sweep, ladder, display, resolution, .. } = session;
        Settings {
            camera: document.camera,
            changes: document.changes.clone(),
            panes: panes.clone(),
            sources: sources.clone(),
            sweep: (sweep.columns.clone(), sweep.rows.clone(), sweep.equal, sweep.seconds),
            ladder: (ladder.repairs, ladder.order),
            display: *display,
            resolution: *resolution,
        }
    }

    /// Makes document and session what they were.
    pub fn restore(self, document: &mut Document, session: &mut Session) {
        (document.camera, document.changes) = (self.camera, self.changes);
        (session.panes, session.sources) = (self.panes, self.sources);
        let sweep = &mut session.sweep;
        (sweep.columns, sweep.rows, sweep.equal, sweep.seconds) = self.sweep;
        (session.ladder.repairs, session.ladder.order) = self.ladder;
        (session.display, session.resolution) = (self.display, self.resolution);
    }
}

/// Earlier settings, and those that were undone. A drag is one step however far it goes.
#[derive(Debug)]
pub struct History {
    settled: Settings,
    earlier: Vec<Settings>,
    undone: Vec<Settings>,
}

/// Steps that are kept.
const MOST_STEPS: usize = 200;

impl History {
    /// A history that begins here.
    pub fn new(settings: Settings) -> Self {
        History { settled: settings, earlier: Vec::new(), undone: Vec::new() }
    }

    /// Keeps the settings of before if they have changed; while the user is `busy` the change is not over yet.
    pub fn note(&mut self, settings: &Settings, busy: bool) {
        if busy || *settings == self.settled {
            return;
        }
        self.earlier.push(std::mem::replace(&mut self.settled, settings.clone()));
        self.undone.clear();
        if self.earlier.len() > MOST_STEPS {
            self.earlier.remove(0);
        }
    }

    /// Stands at these settings, to which the last undo or redo came: what could not be made of them is no step.
    pub fn stand_at(&mut self, settings: Settings) {
        self.settled = settings;
    }

    /// Leaves out of all steps what is changed in parts that the scene, which has become another, has no more.
    pub fn fit(&mut self, scene: &Scene) {
        let mut last = (Edits::default(), Edits::default());
        let later = self.undone.iter_mut();
        for settings in self.earlier.iter_mut().chain([&mut self.settled]).chain(later) {
            let edits = &mut settings.changes.edits;
            // most steps change nothing here
            if *edits != last.0 {
                last = (edits.clone(), edits.fitting(scene).0);
            }
            edits.clone_from(&last.1);
        }
        for steps in [&mut self.earlier, &mut self.undone] {
            steps.dedup();
            steps.pop_if(|step| *step == self.settled);
        }
    }

    /// Whether there is something to undo: a step, or a change that is not over yet.
    pub fn can_undo(&self, settings: &Settings) -> bool {
        !self.earlier.is_empty() || *settings != self.settled
    }

    /// Whether there is something to do again.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// The settings before the last change; one that is not over yet ends here.
    pub fn undo(&mut self, settings: &Settings) -> Option<Settings> {
        self.note(settings, false);
        let earlier = self.earlier.pop()?;
        self.undone.push(std::mem::replace(&mut self.settled, earlier.clone()));
        Some(earlier)
    }

    /// The settings that the last undo took away.
    pub fn redo(&mut self, settings: &Settings) -> Option<Settings> {
        self.note(settings, false);
        let later = self.undone.pop()?;
        self.earlier.push(std::mem::replace(&mut self.settled, later.clone()));
        Some(later)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exposed(exposure: f32) -> Settings {
        let session = Session { display: DisplayTransform { exposure }, ..Session::default() };
        let cornell = scene::builtin::named("cornell").unwrap();
        Settings::of(&Document::new(cornell, "cornell".into()), &session)
    }

    #[test]
    fn a_drag_is_one_step_and_comes_back_by_redo() {
        let mut history = History::new(exposed(0.0));
        for (exposure, busy) in [(0.5, true), (1.0, true), (2.0, false)] {
            history.note(&exposed(exposure), busy);
        }
        assert_eq!(history.undo(&exposed(2.0)), Some(exposed(0.0)));
        assert_eq!(history.undo(&exposed(0.0)), None);
        assert_eq!(history.redo(&exposed(0.0)), Some(exposed(2.0)));
        assert!(!history.can_redo() && history.can_undo(&exposed(2.0)));
    }

    #[test]
    fn a_new_change_forgets_what_was_undone() {
        let mut history = History::new(exposed(0.0));
        history.note(&exposed(1.0), false);
        history.undo(&exposed(1.0));
        history.note(&exposed(3.0), false);
        assert_eq!((history.redo(&exposed(3.0)), history.undo(&exposed(3.0))), (None, Some(exposed(0.0))));
    }

    /// A number that is still being typed is a step of its own when undo is asked for.
    #[test]
    fn undo_takes_back_a_change_that_is_not_over_and_nothing_else() {
        let mut history = History::new(exposed(0.0));
        history.note(&exposed(1.0), false);
        history.note(&exposed(7.0), true);
        assert!(history.can_undo(&exposed(7.0)));
        assert_eq!(history.undo(&exposed(7.0)), Some(exposed(1.0)));
        assert_eq!(history.redo(&exposed(1.0)), Some(exposed(7.0)));
    }
}
