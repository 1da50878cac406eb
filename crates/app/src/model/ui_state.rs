//! What controls come back to, and what is in hand: nothing that anyone would miss the next day.

use super::{
    CasesState, Curve, EffectInHand, ExportMenu, LadderState, Magnification, Message, PaneId, Panes, PartsState,
    PictureArea, Remembered, Slide, SweepPlan, Theme,
};
use scene::Vec3;
use std::path::PathBuf;

/// The state of the controls.
#[derive(Debug, Clone)]
pub struct UiState {
    /// How it all looks.
    pub theme: Theme,
    /// Whether the controls are open.
    pub panel: bool,
    /// Whether the help is open.
    pub help: bool,
    /// Whether the help was there in the last frame.
    pub help_was_open: bool,
    /// Whether pictures have their labels.
    pub labels: bool,
    /// Whether to tell a newcomer about line and key.
    pub hint: bool,
    /// The last thing worth saying.
    pub message: Option<Message>,
    /// How much of the foot of the picture area the message or the hint took in the last frame, in points.
    pub said_height: f32,
    /// Whether what is traced waits.
    pub paused: bool,
    /// How often the user began the pictures anew.
    pub restarts: u64,
    /// Whether this frame is for a picture: nothing but panes, line and labels is in it.
    pub posing: bool,
    /// Width and height of the window in points, if there is one.
    pub window: Option<[f64; 2]>,
    /// Where pictures are shown, as last drawn.
    pub picture: PictureArea,
    /// The scene, by [`Document::opened`](super::Document::opened), for which the wipe's line was put in its place.
    pub line_placed: Option<u64>,
    /// What the drag in hand does.
    pub drag: Drag,
    /// Whether the next drag marks a region.
    pub marking: bool,
    /// How much larger pictures are shown than they are.
    pub magnification: Magnification,
    /// What the wheel has turned of its next step of that.
    pub wheel: f32,
    /// Whether the pixels under the mouse are shown with their numbers.
    pub loupe: bool,
    /// Which sample the probe takes apart, from 0; `None` for the last.
    pub probed_sample: Option<u32>,
    /// Whether histograms are in sight.
    pub histograms: bool,
    /// The parts of the scene, and which of them is in hand.
    pub parts: PartsState,
    /// The effect of light that is looked at alone on the map of errors.
    pub effect: EffectInHand,
    /// Panes whose light by bounce is in sight.
    pub light_bars: Vec<PaneId>,
    /// The pane whose turn it is while A and B flicker.
    pub flicker: Option<PaneId>,
    /// What is wrong with the scene's file as it stands on disk, until it is mended; the scene before is shown.
    pub scene_fault: Option<String>,
    /// What is being read or made of a scene that takes its time, and how far it is.
    pub loading: Option<String>,
    /// The scenes in the folder of the one that is open, if it is a file.
    pub neighbours: Vec<PathBuf>,
    /// The files that were opened last, and the window of before.
    pub remembered: Remembered,
    /// Whether small pictures of the built-in scenes are asked for, and those of the hard cases.
    pub thumbnails: [bool; 2],
    /// Whether a file dialogue of the system's is open.
    pub choosing_file: bool,
    /// A scene to open, as typed.
    pub scene_file: String,
    /// A reference to load, as typed.
    pub reference_file: String,
    /// Pictures of other programs to follow, as typed, where a pane asks for one.
    pub picture_files: Panes<String>,
    /// The slide that is shown once its scene has come.
    pub awaited_slide: Option<&'static Slide>,
    /// Whether a text field had the keyboard when the last frame began.
    pub typing: bool,
    /// Curves of errors that were kept, to compare others with.
    pub pinned: Vec<Curve>,
    /// What the export menu shows while it is open.
    pub export: ExportMenu,
    /// The sweep as it was last drawn.
    pub sweep: SweepState,
    /// What the scene gives the ladder nothing to repair for.
    pub ladder: LadderState,
    /// Width and height in pixels of a picture of rays, as last drawn.
    pub tree_pixels: (u32, u32),
    /// Left, top, right and bottom in points of what workspaces of several pictures show beside their controls.
    pub seen_corners: [f32; 4],
    /// How hard cases are looked at.
    pub cases: CasesState,
    /// What switched-off settings come back to.
    pub switched_off: Panes<SwitchedOff>,
}

/// What a drag on the pictures does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Drag {
    /// Turns or moves the camera.
    #[default]
    Camera,
    /// Moves the wipe's line.
    Line,
    /// Moves what is seen of magnified pictures.
    Magnified,
    /// Marks a region between two points, in shares of a picture.
    Region([[f32; 2]; 2]),
    /// Moves the shape that is chosen.
    Part {
        /// Where its middle stood when the drag began.
        from: Vec3,
        /// Whether it was moved since.
        moved: bool,
    },
    /// Nothing more: what it did was given up.
    Nothing,
}

/// A sweep as far as it can be made.
#[derive(Debug, Clone, Default)]
pub struct SweepState {
    /// Where a tile is shown.
    pub area: PictureArea,
    /// The last one that could be made: what is being typed takes nothing down.
    pub plan: Option<SweepPlan>,
    /// Why what is typed now cannot: one line.
    pub fault: Option<String>,
}

/// What a pane's settings come back to when they are switched on again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SwitchedOff {
    /// The number of bounces when the limit is switched on.
    pub bounces: u32,
    /// The probability when roulette by probability is chosen.
    pub probability: f32,
}

impl Default for SwitchedOff {
    fn default() -> Self {
        SwitchedOff { bounces: 2, probability: 0.8 }
    }
}

impl UiState {
    /// The state at first.
    pub fn new(theme: Theme) -> Self {
        UiState {
            theme,
            panel: true,
            help: false,
            help_was_open: false,
            labels: true,
            hint: true,
            message: None,
            said_height: 0.0,
            paused: false,
            restarts: 0,
            posing: false,
            window: None,
            picture: PictureArea::default(),
            line_placed: None,
            drag: Drag::default(),
            marking: false,
            magnification: Magnification::default(),
            wheel: 0.0,
            loupe: false,
            probed_sample: None,
            histograms: false,
            parts: PartsState::default(),
            effect: EffectInHand::default(),
            light_bars: Vec::new(),
            flicker: None,
            scene_fault: None,
            loading: None,
            neighbours: Vec::new(),
            remembered: Remembered::default(),
            thumbnails: [false; 2],
            choosing_file: false,
            scene_file: String::new(),
            reference_file: String::new(),
            picture_files: Panes::default(),
            awaited_slide: None,
            typing: false,
            pinned: Vec::new(),
            export: ExportMenu::default(),
            sweep: SweepState::default(),
            ladder: LadderState::default(),
            tree_pixels: (0, 0),
            seen_corners: [0.0; 4],
            cases: CasesState::default(),
            switched_off: Panes::default(),
        }
    }
}
