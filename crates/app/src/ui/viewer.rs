//! The state of the viewer, and its frame.

use super::export_menu::ExportMenu;
use super::settings::{History, Settings};
use super::{
    ComparisonSettings, Dump, Line, Message, Theme, View, ViewModel, What, controls, help, keys, picture, top_bar,
};
use crate::engine::Side;
use crate::engine::export::Destination;
use crate::engine::post_process::Comparison;
use crate::ruler::Against;
use crate::technique::{Adapters, DeviceChoice};
use scene::{Camera, Scene};
use std::path::PathBuf;
use std::sync::Arc;

/// What only the window around the viewer can do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UiCommand {
    /// Write a picture to a file or the clipboard.
    Export {
        /// Which.
        what: What,
        /// Where to.
        to: Destination,
    },
    /// Read and open a scene, by name or file.
    Open(String),
    /// Read a reference from a file.
    LoadReference(PathBuf),
    /// Close the window.
    Quit,
}

/// All that the user can change.
pub struct Viewer {
    /// The scene as it was opened.
    pub scene: Arc<Scene>,
    /// What the user opened it by: a built-in name or a file.
    pub source: String,
    /// Counts the scenes opened.
    pub opened: u64,
    /// What sliders and choices say.
    pub settings: Settings,
    /// The graphics devices that can trace rays.
    pub adapters: Adapters,
    /// Where both sides look from.
    pub camera: Camera,
    /// Which is shown.
    pub view: View,
    /// Where the wipe's line stands, from 0 (left or top edge) to 1.
    pub wipe: f32,
    /// How the wipe's line stands.
    pub line: Line,
    /// What is compared with what, and how it is drawn.
    pub comparison: ComparisonSettings,
    /// Whether the truth waits.
    pub paused: bool,
    /// How often the user began the pictures anew.
    pub restarts: u64,
    /// How it all looks.
    pub theme: Theme,
    /// Whether the controls are open.
    pub panel: bool,
    /// Whether the help is open.
    pub help: bool,
    /// Whether to tell a newcomer about line and key.
    pub hint: bool,
    /// The last thing worth saying.
    pub message: Option<Message>,
    /// Whether this frame is for a picture: nothing but panes, line and labels is in it.
    pub posing: bool,
    /// Width and height of one picture in physical pixels, as last drawn.
    pub picture_size: (u32, u32),
    /// The picture area in points, as last drawn.
    pub picture_rect: egui::Rect,
    pub(super) history: History,
    pub(super) export: ExportMenu,
    pub(super) bookmarks: Vec<Camera>,
    pub(super) memory: Memory,
    dressed: Option<Theme>,
}

/// What controls come back to, and drags in hand.
pub(super) struct Memory {
    /// A file to open, as typed.
    pub file_name: String,
    /// The number of bounces when the limit is switched on, for each pane.
    pub bounce_limits: [u32; 2],
    /// The probability when roulette by probability is chosen, for each pane.
    pub probabilities: [f32; 2],
    /// Whether the drag in hand moves the line.
    pub dragging_line: bool,
    /// Whether the help was there in the last frame.
    pub help_was_open: bool,
}

impl Viewer {
    /// The first view of a scene that was opened by the name `source`.
    pub fn new(scene: Scene, source: String, theme: Theme) -> Self {
        let mut settings = Settings::default();
        settings.panes.iter_mut().for_each(|pane| pane.take_usual_estimator(&scene));
        Viewer {
            camera: scene.camera,
            scene: Arc::new(scene),
            source,
            opened: 0,
            settings,
            adapters: Adapters::default(),
            view: View::Wipe,
            wipe: 0.5,
            line: Line::Vertical,
            comparison: ComparisonSettings::default(),
            paused: false,
            restarts: 0,
            theme,
            panel: true,
            help: false,
            hint: true,
            message: None,
            posing: false,
            picture_size: (0, 0),
            picture_rect: egui::Rect::ZERO,
            history: History::new(settings),
            export: ExportMenu::default(),
            bookmarks: Vec::new(),
            memory: Memory {
                file_name: String::new(),
                bounce_limits: [2; 2],
                probabilities: [0.8; 2],
                dragging_line: false,
                help_was_open: false,
            },
            dressed: None,
        }
    }

    /// The same beside graphics devices, and with rays traced where `device` says.
    pub fn beside(mut self, adapters: Adapters, device: DeviceChoice) -> Self {
        self.adapters = adapters;
        self.settings.panes.iter_mut().for_each(|pane| pane.device = device);
        self.history = History::new(self.settings);
        self
    }

    /// Shows another scene from its own camera. What was set against the scene before goes; techniques and their ways
    /// stay.
    pub fn open(&mut self, scene: Scene, source: String) {
        self.camera = scene.camera;
        self.scene = Arc::new(scene);
        self.source = source;
        self.opened += 1;
        self.settings.changes = Default::default();
        for pane in &mut self.settings.panes {
            pane.forget_the_scene(&self.scene);
            pane.take_usual_estimator(&self.scene);
        }
        self.history = History::new(self.settings);
        self.bookmarks.clear();
    }

    /// Says a line to the user.
    pub fn say(&mut self, outcome: Result<String, String>) {
        self.message = Some(Message::new(outcome));
    }

    /// Draws everything and returns what the user wants of the window.
    pub fn ui(&mut self, ui: &mut egui::Ui, model: &ViewModel, dump: &mut Dump) -> Vec<UiCommand> {
        let mut commands = Vec::new();
        if self.dressed != Some(self.theme) {
            self.theme.apply(ui.ctx());
            self.dressed = Some(self.theme);
            ui.ctx().request_repaint();
        }
        keys::listen(self, ui.ctx(), &mut commands);
        egui::Panel::top("top bar").show(ui, |ui| top_bar::show(self, ui, model, dump, &mut commands));
        if self.panel {
            let width = controls::width(ui.available_width());
            egui::Panel::right("controls").resizable(false).exact_size(width).show(ui, |ui| {
                egui::ScrollArea::vertical()
                    .auto_shrink(false)
                    .show(ui, |ui| controls::show(self, ui, model, dump, &mut commands));
            });
        }
        // no ground under the pictures, which cover it: where the processor draws, every layer is paid for
        let bare = egui::CentralPanel::default().frame(egui::Frame::NONE);
        bare.show(ui, |ui| picture::show(self, ui, model, dump));
        help::show(self, ui, dump);
        let busy = ui.input(|i| i.pointer.any_down()) || ui.ctx().text_edit_focused();
        self.history.note(&self.settings, busy);
        commands
    }

    pub(super) fn undo(&mut self) {
        self.settings = self.history.undo(&self.settings).unwrap_or(self.settings);
    }

    pub(super) fn redo(&mut self) {
        self.settings = self.history.redo(&self.settings).unwrap_or(self.settings);
    }

    /// How errors are measured, and whether they are drawn.
    pub fn comparison(&self) -> Comparison {
        let map = (self.view == View::ErrorMap).then(|| self.comparison.wish());
        Comparison { against: self.comparison.against, map }
    }

    /// A becomes B and B becomes A; from a view of both it goes to A. Maps against the reference take turns too.
    pub(super) fn toggle(&mut self) {
        self.hint = false;
        match (self.view, self.comparison.against) {
            (View::ErrorMap, Against::Reference) => self.comparison.of = self.comparison.of.other(),
            (View::A, _) => self.view = View::B,
            _ => self.view = View::A,
        }
    }

    /// Shows a view; choosing the wipe once more turns its line. From one pane it goes to the map of that pane's
    /// errors.
    pub(super) fn choose(&mut self, view: View) {
        match (self.view, view) {
            (View::Wipe, View::Wipe) => self.line = self.line.turned(),
            (View::A, View::ErrorMap) => self.comparison.of = Side::A,
            (View::B, View::ErrorMap) => self.comparison.of = Side::B,
            _ => {}
        }
        self.view = view;
    }
}
