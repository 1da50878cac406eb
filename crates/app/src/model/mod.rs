//! What the window is about, as plain values: no egui, no threads, no window. Below `ui`, `engine` and `window`, which
//! meet only here.
//!
//! A [`Model`] is a [`Document`] (what is looked at), a [`Session`] (how) and a [`UiState`] (what controls remember).
//! Out of it comes what is [`Wanted`]; what is made of that comes back as a [`ViewModel`].

mod cases;
mod comparison;
mod document;
mod effects;
mod effort;
mod error_map;
mod errors;
mod export;
mod file_wish;
mod first_line;
mod history;
mod ladder;
mod light_parts;
mod magnification;
mod message;
mod pane;
mod pane_source;
mod part_tree;
mod parts;
mod picture_area;
mod plots;
mod probe;
mod reference;
mod region;
mod remembered;
mod session;
mod session_file;
mod setup;
mod slides;
mod standing;
mod sweep;
mod theme;
mod trees;
mod ui_state;
mod view;
mod view_args;
mod view_model;
mod wanted;
mod workspaces;

pub use cases::{
    CaseCourse, CaseMachine, CaseMark, CaseResult, CasesState, CasesView, WantedCases, off_by, telling_row,
};
pub use comparison::{Against, CompareWith, Comparison, ComparisonSettings, MapWish};
pub use document::Document;
pub use effects::{EffectInHand, EffectsOfView, ShownEffects, Sides, label_texts, percent, put_labels};
pub use effort::{Compiling, Drawing, Effort};
pub use error_map::{ErrorMap, ErrorMapJob};
pub use errors::{ErrorHistory, ErrorPoint};
pub use export::{Destination, ExportMenu, ExportRequest, ExportSubject, PlotFile, SlideSize, SweepFile};
pub use file_wish::{FilePurpose, FileWish};
pub use history::{History, Settings};
pub use ladder::{
    LadderSettings, LadderShows, LadderState, LadderView, Order, Rung, RungFacts, WantedLadder, as_taught, repaired,
    repairs_of,
};
pub use light_parts::{LightByBounce, LightWish, light_parts};
pub use magnification::Magnification;
pub use message::{Message, in_few};
pub use pane::{PaneId, Panes};
pub use pane_source::{External, PaneSource, USUAL_PORT};
pub use part_tree::{Branch, PartChild, PartFacts, PartTree, is_in};
pub use parts::{ObjectMap, ObjectsWish, PartsState, ShapesAlong};
pub use picture_area::PictureArea;
pub use plots::{Cost, Curve, Measure, Owner, PlotSettings, csv, guide, judge_of_all, pin};
pub use probe::{
    Bin, Channel, Drawn, MOST_PROBED, PaneProbe, PixelSamples, ProbeSettings, ProbeWish, RunningMean, Spread, pixel_at,
    samples_csv,
};
pub use reference::{Origin, Progress};
pub use region::{IN_THE_REGION, Region};
pub use remembered::{Remembered, WindowPlace};
pub use session::{Resolution, Session};
pub use session_file::{SESSION_VERSION, SavedSession, SavedWindow, SessionDraft, is_session};
pub use setup::{MapSetup, Setup};
pub use slides::{SLIDES, Slide};
pub use sweep::{
    Axis, Equal, Line as SweepLine, MOST_TILES, MOST_VALUES, PlannedTile, SWEEPS, SweepMeasure, SweepPlan, SweepPreset,
    SweepSettings, TECHNIQUE, TileErrors, TileFacts, best, captions, sweep_csv, variable,
};
pub use theme::Theme;
pub use trees::{
    Counted, TreeFacts, TreePlot, TreePoint, TreesSettings, TreesView, WantedTrees, extrapolated, grouped,
    statue_triangles,
};
pub use ui_state::{Drag, SweepState, SwitchedOff, UiState};
pub use view::{Line, View};
pub use view_args::ViewArgs;
pub use view_model::{Denoising, PaneView, SweepView, ViewModel};
pub use wanted::{Wanted, WantedPane, WantedSweep};
pub use workspaces::{CASES, COMPARE, EVERYBODYS, LADDER, SWEEP, TREES};

use scene::{Needs, Scene};
use technique::{Adapters, DeviceChoice, FakeSettings, Technique};

/// All that the user can change.
#[derive(Debug)]
pub struct Model {
    /// What is looked at.
    pub document: Document,
    /// How it is looked at.
    pub session: Session,
    /// What controls remember from frame to frame; in no file.
    pub state: UiState,
    /// The graphics devices that can trace rays.
    pub adapters: Adapters,
    history: History,
    beside: standing::Beside,
}

impl Model {
    /// The first view of a scene that was opened by the name `source`.
    pub fn new(scene: Scene, source: String, theme: Theme) -> Self {
        let (document, mut session) = (Document::new(scene, source), Session::default());
        session.forget_the_scene(&Needs::default(), &document.scene);
        let history = History::new(Settings::of(&document, &session));
        Model {
            document,
            session,
            state: UiState::new(theme),
            adapters: Adapters::default(),
            history,
            beside: standing::Beside::default(),
        }
    }

    /// The same beside graphics devices, and with rays traced where `device` says, if it does.
    pub fn beside(mut self, adapters: Adapters, device: impl Into<Option<DeviceChoice>>) -> Self {
        self.adapters = adapters;
        device.into().into_iter().for_each(|device| self.session.trace_on(device));
        self.begin_history();
        self
    }

    /// Shows another scene from its own camera. What was set against the scene before goes; techniques and their ways
    /// stay.
    pub fn open(&mut self, scene: Scene, source: String) {
        let before = self.document.scene.needs();
        self.document.open(scene, source);
        self.state.pinned.clear();
        self.look_at_the_whole();
        self.session.forget_the_scene(&before, &self.document.scene);
        self.take_awaited_slide();
        self.begin_history();
    }

    /// Shows another version of the scene that is open; camera, view, settings and what is changed in parts that it still
    /// has stay. Returns `None` if it is the same, and else a line about the changes that go, if any do.
    pub fn reread(&mut self, scene: Scene) -> Option<Vec<String>> {
        if *self.document.scene == scene {
            return None;
        }
        let lost = self.document.reread(scene);
        self.history.fit(&self.document.scene);
        self.session.look_at_what_there_is(&self.document.scene);
        let line =
            || format!("what was changed in it and does not fit any more is as the file has it: {}", lost.join("; "));
        Some((!lost.is_empty()).then(line).into_iter().collect())
    }

    /// Undo does not go behind this.
    fn begin_history(&mut self) {
        self.history = History::new(self.settings());
        self.beside = standing::Beside::default();
    }

    /// Puts the wipe's line where it stands at first, for each scene once.
    pub fn place_line(&mut self) {
        let Document { scene, camera, opened, .. } = &self.document;
        if self.state.line_placed != Some(*opened) {
            let aspect = self.state.picture.aspect();
            (self.session.line, self.session.wipe) = first_line::first_line(scene, camera, aspect);
            self.state.line_placed = Some(*opened);
        }
    }

    /// Puts the wipe's line, as it is turned, where it cuts most evenly what is specular.
    pub fn place_line_again(&mut self) {
        let Document { scene, camera, .. } = &self.document;
        let aspect = self.state.picture.aspect();
        self.session.wipe = first_line::first_place(scene, camera, aspect, self.session.line);
    }

    /// Shows a view, as [`Session::choose`]; a line that turns takes its place.
    pub fn choose(&mut self, view: View) {
        if self.state.flicker.take().is_some() && self.session.view == view {
            return;
        }
        let line = self.session.line;
        self.session.choose(view);
        if self.session.line != line {
            self.place_line_again();
        }
    }

    /// Shows all of the pictures, of which all figures speak.
    pub fn look_at_the_whole(&mut self) {
        self.session.comparison.region = None;
        self.state.magnification = Magnification::default();
    }

    /// What is seen: while A and B flicker the one whose turn it is, else the view that was chosen.
    pub fn seen(&self) -> View {
        self.state.flicker.map_or(self.session.view, View::Pane)
    }

    /// Says a line to the user.
    pub fn say(&mut self, outcome: Result<String, String>) {
        self.state.message = Some(Message::new(outcome));
    }

    /// Says what of the scene is probably not meant, if there is anything: it stays until it was seen. Returns the notes that
    /// are left for stderr.
    pub fn say_notes<'a>(&mut self, notes: &'a [String]) -> &'a [String] {
        let (text, left) = message::in_few(notes);
        if !notes.is_empty() {
            self.state.message = Some(Message::note(text));
        }
        left
    }

    /// What undo gives back, as it stands.
    pub fn settings(&self) -> Settings {
        Settings::of(&self.document, &self.session)
    }

    /// Whether there is something to undo, and to do again.
    pub fn can_undo_and_redo(&self) -> [bool; 2] {
        let [back, on] = self.leads_back_and_on();
        [self.history.can_undo(&self.settings()) || back, self.history.can_redo() || on]
    }

    /// Takes back the last change of a setting; before the first goes back to the scene that this one was opened from.
    pub fn undo(&mut self) {
        match self.history.undo(&self.settings()) {
            Some(earlier) => self.go_to(earlier),
            None => self.go_back(),
        }
    }

    /// Makes the change again that the last undo took back.
    pub fn redo(&mut self) {
        match self.history.redo(&self.settings()) {
            Some(later) => self.go_to(later),
            None => self.go_on(),
        }
    }

    fn go_to(&mut self, settings: Settings) {
        settings.restore(&mut self.document, &mut self.session);
        self.apply_changes();
        self.history.stand_at(self.settings());
    }

    /// Ends a frame in which the user may have changed anything; a change is not over yet while the user is `busy`.
    pub fn settle(&mut self, busy: bool) {
        self.apply_changes();
        let settings = self.settings();
        self.history.note(&settings, busy);
    }

    /// These panes' pictures for the picture area as it was last drawn, without comparisons: what a workspace begins
    /// with.
    pub fn wanted(&self, panes: impl IntoIterator<Item = PaneId>) -> Wanted {
        let Model { document, session, state, .. } = self;
        let shot = document.shot(&state.picture);
        let pane = |id| {
            let (source, shot) = (session.source(id).clone(), shot.clone());
            let technique = match source {
                PaneSource::Made => session.panes.get(id)?.in_use(),
                _ => Technique::Fake(FakeSettings::default()),
            };
            let (own_camera, shrink) = (document.camera, state.picture.shrink);
            Some((id, WantedPane { shot, own_camera, technique, source, shrink }))
        };
        // before the first layout there is no place for a picture
        let (width, height) = state.picture.size;
        let panes = panes.into_iter().filter(|_| width > 0 && height > 0);
        Wanted {
            opened: document.opened,
            panes: panes.filter_map(pane).collect(),
            sources: session.sources.clone(),
            comparisons: Vec::new(),
            map: None,
            sweep: None,
            ladder: None,
            trees: None,
            cases: None,
            histograms: false,
            probe: None,
            objects: None,
            effects: None,
            light: Vec::new(),
            display: session.display,
            paused: state.paused,
            restarts: state.restarts,
        }
    }
}
