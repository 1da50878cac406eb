//! Scenes that were opened from another one, to look at for a moment: undo leads back to that with all its steps, and redo
//! there again.

use super::{Document, History, Model, Session, Settings};
use scene::Scene;

/// A scene as it stood when another took its place.
#[derive(Debug)]
pub(super) struct Standing {
    document: Document,
    session: Session,
    history: History,
}

/// What stands beside the scene that is open.
#[derive(Debug, Default)]
pub(super) struct Beside {
    /// The scene that it was opened from.
    behind: Option<Box<Standing>>,
    /// The scene that undo led back from, and what was set here then.
    ahead: Option<Box<(Settings, Standing)>>,
}

impl Model {
    /// As [`Model::open`], and sets it up; undo leads back.
    pub fn open_from_here(&mut self, scene: Scene, source: String, set_up: impl FnOnce(&mut Session)) {
        let (document, session) = (self.document.clone(), self.session.clone());
        let begun = History::new(self.settings());
        let history = std::mem::replace(&mut self.history, begun);
        self.open(scene, source);
        set_up(&mut self.session);
        self.begin_history();
        self.beside.behind = Some(Box::new(Standing { document, session, history }));
    }

    /// Whether undo leads back to another scene, and redo to one, where no step of this one is left.
    pub(super) fn leads_back_and_on(&self) -> [bool; 2] {
        let as_left = self.beside.ahead.as_deref().is_some_and(|(settings, _)| *settings == self.settings());
        [self.beside.behind.is_some(), as_left]
    }

    /// Goes back to the scene that this one was opened from.
    pub(super) fn go_back(&mut self) {
        let Some(behind) = self.beside.behind.take() else { return };
        let here = self.stand_on(*behind);
        self.beside.ahead = Some(Box::new((self.settings(), here)));
    }

    /// Goes on to the scene that the last undo led back from.
    pub(super) fn go_on(&mut self) {
        let Some(ahead) = self.beside.ahead.take().filter(|ahead| ahead.0 == self.settings()) else { return };
        let here = self.stand_on(ahead.1);
        self.beside.behind = Some(Box::new(here));
    }

    fn stand_on(&mut self, mut there: Standing) -> Standing {
        // all that was made of either is of the other scene
        there.document.opened = self.document.opened + 1;
        there.session.workspace = self.session.workspace;
        let document = std::mem::replace(&mut self.document, there.document);
        let session = std::mem::replace(&mut self.session, there.session);
        let history = std::mem::replace(&mut self.history, there.history);
        self.state.pinned.clear();
        self.look_at_the_whole();
        Standing { document, session, history }
    }
}
