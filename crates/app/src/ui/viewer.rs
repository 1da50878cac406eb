//! The state of the viewer and its keys.

use super::{Dump, Pane, controls, picture, top_bar};
use crate::technique::{FakeSettings, TruthSettings};
use egui::{Key, Modifiers};
use scene::display::DisplayTransform;
use scene::{Camera, Scene};

/// Which picture is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// The fake alone.
    A,
    /// The truth alone.
    B,
    /// Both, under a line that the mouse drags.
    Wipe,
    /// Both whole, A left and B right.
    SideBySide,
}

impl View {
    /// All, in the order of their keys 1 to 4.
    pub const ALL: [View; 4] = [View::A, View::B, View::Wipe, View::SideBySide];

    /// The name on its button.
    pub fn name(self) -> &'static str {
        match self {
            View::A => "A",
            View::B => "B",
            View::Wipe => "Wipe",
            View::SideBySide => "Side by side",
        }
    }
}

/// What only the shell around the viewer can do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Request {
    /// Save the picture as seen.
    Save,
    /// Read and open a scene, by name or file.
    Open(String),
}

/// Counts changes, so that each technique renders again when what it reads has changed, and only then.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Revisions {
    /// Of the scene as a whole: another one was opened.
    pub opened: u64,
    /// Of what both read in the scene.
    pub shared: u64,
    /// Of what the fake alone reads in the scene.
    pub fake: u64,
    /// Of what the truth alone reads in the scene.
    pub truth: u64,
}

/// All that the user can change.
pub struct Viewer {
    /// The scene, with what the sliders changed in it.
    pub scene: Scene,
    /// Where both sides look from.
    pub camera: Camera,
    /// How A is made.
    pub fake: FakeSettings,
    /// How B is made.
    pub truth: TruthSettings,
    /// How both are shown.
    pub display: DisplayTransform,
    /// Which is shown.
    pub view: View,
    /// Where the wipe's line stands, from 0 (left edge) to 1.
    pub wipe: f32,
    /// Counts changes of the scene.
    pub revisions: Revisions,
    /// Whether the controls are open.
    pub panel: bool,
    /// Whether to tell a newcomer about line and key.
    pub hint: bool,
    /// The last thing worth saying, and whether it is a failure.
    pub message: Option<(String, bool)>,
    /// Width and height of one picture in physical pixels, as last drawn.
    pub picture_size: (u32, u32),
    /// The picture area in points, as last drawn.
    pub picture_rect: egui::Rect,
    /// A file to open, as typed.
    pub(super) file_name: String,
    /// The number of bounces to come back to when the limit is switched on.
    pub(super) bounce_limit: u32,
    /// The probability to come back to when roulette by probability is chosen.
    pub(super) probability: f32,
    /// Whether the drag in hand moves the line.
    pub(super) dragging_line: bool,
}

impl Viewer {
    /// The first view of a scene.
    pub fn new(scene: Scene) -> Self {
        Viewer {
            camera: scene.camera,
            scene,
            fake: FakeSettings::default(),
            truth: TruthSettings::default(),
            display: DisplayTransform::default(),
            view: View::Wipe,
            wipe: 0.5,
            revisions: Revisions::default(),
            panel: true,
            hint: true,
            message: None,
            picture_size: (0, 0),
            picture_rect: egui::Rect::ZERO,
            file_name: String::new(),
            bounce_limit: 2,
            probability: 0.8,
            dragging_line: false,
        }
    }

    /// Shows another scene from its own camera; settings stay.
    pub fn open(&mut self, scene: Scene) {
        self.camera = scene.camera;
        self.scene = scene;
        self.revisions.opened += 1;
    }

    /// Draws everything and returns what the user wants of the shell.
    pub fn ui(&mut self, ui: &mut egui::Ui, panes: &[Pane; 2], dump: &mut Dump) -> Vec<Request> {
        let mut requests = Vec::new();
        self.keys(ui.ctx(), &mut requests);
        egui::Panel::top("top bar").show(ui, |ui| top_bar::show(self, ui, dump, &mut requests));
        if self.panel {
            egui::Panel::right("controls").resizable(false).exact_size(280.0).show(ui, |ui| {
                egui::ScrollArea::vertical().show(ui, |ui| controls::show(self, ui, dump));
            });
        }
        // no ground under the pictures, which cover it: where the processor draws, every layer is paid for
        let bare = egui::CentralPanel::default().frame(egui::Frame::NONE);
        bare.show(ui, |ui| picture::show(self, ui, panes, dump));
        requests
    }

    fn keys(&mut self, ctx: &egui::Context, requests: &mut Vec<Request>) {
        if ctx.input_mut(|i| i.consume_key(Modifiers::COMMAND, Key::S)) {
            requests.push(Request::Save);
        }
        if ctx.text_edit_focused() {
            return;
        }
        let pressed = |key| ctx.input(|i| i.key_pressed(key) && i.modifiers.is_none());
        if pressed(Key::T) {
            self.toggle();
        }
        for (key, view) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4].into_iter().zip(View::ALL) {
            if pressed(key) {
                self.view = view;
            }
        }
        if pressed(Key::R) {
            self.revisions.truth += 1;
        }
        if pressed(Key::C) {
            self.camera = self.scene.camera;
        }
        if pressed(Key::H) {
            self.panel = !self.panel;
        }
    }

    /// A becomes B and B becomes A; from a view of both it goes to A.
    fn toggle(&mut self) {
        self.hint = false;
        self.view = if self.view == View::A { View::B } else { View::A };
    }
}
