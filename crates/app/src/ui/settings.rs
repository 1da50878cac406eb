//! What undo gives back: the settings of both panes, the scene's sliders and the display.

use film::DisplayTransform;
use technique::{PaneSettings, SceneChanges, TechniqueName};

/// Everything that a slider or a choice changes. Camera, view and line are not part of it: moving them loses nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// What is changed in the scene, for both panes.
    pub changes: SceneChanges,
    /// How A and B are made.
    pub panes: [PaneSettings; 2],
    /// How both are shown.
    pub display: DisplayTransform,
    /// Of both.
    pub resolution: Resolution,
}

/// How many pixels a picture has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resolution {
    /// As many as the picture area. While something changes, pictures that take too long for that begin coarser.
    #[default]
    Full,
    /// One for two by two.
    Half,
    /// One for four by four.
    Quarter,
}

impl Resolution {
    /// All, the finest first.
    pub const ALL: [Resolution; 3] = [Resolution::Full, Resolution::Half, Resolution::Quarter];

    /// Pixels of the picture area along a side of one of the picture.
    pub fn shrink(self) -> u32 {
        match self {
            Resolution::Full => 1,
            Resolution::Half => 2,
            Resolution::Quarter => 4,
        }
    }

    /// "full", "1/2", "1/4".
    pub fn name(self) -> &'static str {
        match self {
            Resolution::Full => "full",
            Resolution::Half => "1/2",
            Resolution::Quarter => "1/4",
        }
    }
}

impl Default for Settings {
    /// The fake against the truth.
    fn default() -> Self {
        Settings {
            changes: SceneChanges::default(),
            panes: [PaneSettings::of(TechniqueName::Raster), PaneSettings::of(TechniqueName::Path)],
            display: DisplayTransform::default(),
            resolution: Resolution::default(),
        }
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
        self.earlier.push(std::mem::replace(&mut self.settled, *settings));
        self.undone.clear();
        if self.earlier.len() > MOST_STEPS {
            self.earlier.remove(0);
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
        self.undone.push(std::mem::replace(&mut self.settled, earlier));
        Some(earlier)
    }

    /// The settings that the last undo took away.
    pub fn redo(&mut self, settings: &Settings) -> Option<Settings> {
        self.note(settings, false);
        let later = self.undone.pop()?;
        self.earlier.push(std::mem::replace(&mut self.settled, later));
        Some(later)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exposed(exposure: f32) -> Settings {
        Settings { display: DisplayTransform { exposure }, ..Settings::default() }
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
