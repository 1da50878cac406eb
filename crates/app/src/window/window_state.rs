//! The viewer's window: one frame after the other from what egui, the viewer and the workers have.

use super::canvas::Canvas;
use super::frame_stats::{Clock, FrameStats};
use super::recovery::DeviceRecovery;
use super::surface::{Painting, Presented};
use super::textures::{Uploads, WindowTextures};
use super::{dialogue, place, scale_factor};
use crate::engine::Wake;
use crate::engine::ask::Engine;
use crate::engine::capture::Capture;
use crate::engine::load::Opened;
use crate::engine::memory::{self, Memory};
use crate::model::{Destination, ExportRequest, Model, Remembered, SWEEP, ViewArgs};
use crate::ui::{UiCommand, Workspaces};
use crate::viewer::Viewer;
use reference::Store;
use std::sync::Arc;
use std::time::Instant;
use technique::Adapters;
use winit::window::Fullscreen;

/// Everything that lives as long as the window.
pub struct WindowState {
    viewer: Viewer,
    textures: WindowTextures,
    /// The window, and what it is drawn with.
    pub canvas: Canvas,
    /// The window's title as it was last set.
    title: String,
    recovery: DeviceRecovery,
    next_frame: Option<Instant>,
    /// Where the next frame's picture goes, beside the screen.
    poses: Vec<Destination>,
    /// Whether the window closes once those pictures are taken.
    quitting: bool,
    stats: FrameStats,
    /// Physical pixels per point in the last frame.
    scale: f32,
}

/// What a window's viewer begins with.
pub struct First {
    /// As options set it up.
    pub model: Model,
    /// What it was read from.
    pub opened: Opened,
    /// What earlier windows have left.
    pub remembered: Remembered,
    /// When the program was started.
    pub started: Instant,
}

impl WindowState {
    /// Shows in a window what was read.
    ///
    /// # Errors
    /// If there are no threads.
    pub fn begin(
        canvas: Canvas,
        adapters: Adapters,
        first: First,
        args: &ViewArgs,
        wake: Wake,
    ) -> anyhow::Result<Self> {
        let First { model, opened, remembered, started } = first;
        let engine = Engine::start(&canvas.gpu, &adapters, Arc::new(Store::of_the_user), wake)?;
        let workspaces = Workspaces::beginning_with(args.workspace.as_deref());
        let mut viewer = Viewer::new(model.beside(adapters, args.device), workspaces, engine, started);
        // without a thread nothing is remembered
        viewer.remember(remembered, memory::file_of_the_user().and_then(|file| Memory::start(file).ok()));
        opened.notes.iter().for_each(|line| note!("note: {line}"));
        viewer.begin_with(opened);
        canvas.request_frame();
        Ok(WindowState {
            viewer,
            title: String::new(),
            textures: WindowTextures::default(),
            canvas,
            recovery: DeviceRecovery::new(),
            next_frame: None,
            poses: Vec::new(),
            quitting: false,
            stats: FrameStats::default(),
            scale: 1.0,
        })
    }

    /// When egui wants the next frame by itself.
    pub fn next_frame(&self) -> Option<Instant> {
        self.next_frame
    }

    /// Remembers where the window was, and tells what frames have cost.
    pub fn close(mut self) -> FrameStats {
        self.remember_place();
        self.stats
    }

    fn remember_place(&mut self) {
        let before = self.viewer.model.state.remembered.window;
        self.viewer.remember_window(place::of(&self.canvas.window, before));
    }

    /// Says what is open.
    fn entitle(&mut self) {
        let title = format!("{} - Visavis", self.viewer.title());
        if title != self.title {
            self.canvas.window.set_title(&title);
            self.title = title;
        }
    }

    /// Says something in the window.
    pub fn say(&mut self, words: &str) {
        self.viewer.model.say(Ok(words.into()));
        self.canvas.request_frame();
    }

    /// Says that a scale is no use and that the one before stays.
    pub fn tell_of_scale(&mut self, unusable: f64) {
        self.viewer.model.say(Err(scale_factor::is_ignored(unusable)));
        self.canvas.request_frame();
    }

    /// One frame: collect, draw, ask for what has changed, present. Returns whether the user wants to quit.
    pub fn frame(&mut self) -> bool {
        let clock = Clock::start();
        self.recover();
        self.viewer.collect(&mut Uploads {
            gpu: &self.canvas.gpu,
            renderer: &mut self.canvas.surface.renderer,
            textures: &mut self.textures,
        });
        self.entitle();
        let poses = std::mem::take(&mut self.poses);
        self.viewer.model.state.posing = !poses.is_empty();
        let scale = self.canvas.window.scale_factor();
        self.viewer.model.state.window = Some(self.canvas.surface.size().map(|pixels| f64::from(pixels) / scale));
        let drawn = self.canvas.draw(|ui| self.viewer.draw(ui));
        self.scale = drawn.scale;
        self.viewer.take_commands().into_iter().for_each(|command| self.handle(command));
        self.viewer.ask();
        let session = &self.viewer.model.session;
        self.stats.note(if session.is_in(SWEEP) { "Sweep" } else { session.view.name() }, clock.elapsed());
        poses.into_iter().for_each(|to| self.capture(&drawn.painting(), to));
        let (shown, next) = self.canvas.present(drawn);
        if shown == Presented::Shown {
            self.stats.note_shown(self.canvas.egui.egui_ctx().input(|i| i.pointer.any_down()));
            self.viewer.shown();
        }
        self.next_frame = next;
        self.quitting && self.poses.is_empty()
    }

    /// Begins again with a new device where the window's has failed. What was on the screen is frame again.
    fn recover(&mut self) {
        self.recovery.count_frame(&self.canvas.gpu);
        let Some(fault) = self.canvas.gpu.fault().filter(|_| self.recovery.is_due()) else { return };
        match self.canvas.surface.begin_again(self.canvas.display.clone()) {
            Ok(gpu) => self.canvas.gpu = gpu,
            Err(why) => {
                crate::console::to_stderr(format_args!(
                    "visavis: the window's GPU failed ({fault}) and is gone: {why:#}\n"
                ));
                return;
            }
        }
        let side = self.canvas.gpu.device.limits().max_texture_dimension_2d as usize;
        self.canvas.egui.set_max_texture_side(self.recovery.another_side(side));
        self.textures = WindowTextures::default();
        self.viewer.move_to(&self.canvas.gpu);
        self.viewer.model.say(Err(format!("The window's GPU failed and was begun again: {fault}")));
    }

    fn handle(&mut self, command: UiCommand) {
        match self.viewer.handle(command) {
            Some(UiCommand::Export(ExportRequest { to, .. })) => self.poses.push(to),
            Some(UiCommand::FullScreen) => self.toggle_full_screen(),
            Some(UiCommand::Choose(wish)) => {
                let choice = dialogue::choose(&wish, &self.canvas.window);
                self.viewer.wait_for_file(wish.purpose, choice);
            }
            Some(UiCommand::Quit) => self.quitting = true,
            _ => {}
        }
        self.canvas.request_frame();
    }

    /// On the screen that the window is on.
    fn toggle_full_screen(&mut self) {
        let is_full = self.canvas.window.fullscreen().is_some();
        if !is_full {
            // to which it comes back, also if it is closed meanwhile
            self.remember_place();
        }
        self.canvas.window.set_fullscreen((!is_full).then_some(Fullscreen::Borderless(None)));
    }

    /// Exports the picture area of a frame as it is on the screen, line and labels included.
    fn capture(&mut self, painting: &Painting, to: Destination) {
        let [width, height] = self.canvas.surface.size();
        let [left, top, right, bottom] = self.viewer.model.seen_corners();
        let pixel = |points: f32, most: u32| ((points * self.scale).round().max(0.0) as u32).min(most);
        let part = [pixel(left, width), pixel(top, height), pixel(right, width), pixel(bottom, height)];
        if part[0] >= part[2] || part[1] >= part[3] {
            return self
                .viewer
                .model
                .say(Err("nothing is shown yet that could be saved; try again in a moment".into()));
        }
        let Some(texture) = self.canvas.surface.capture(&self.canvas.gpu, painting) else {
            return self.viewer.model.say(Err("the GPU failed at this picture; try again in a moment".into()));
        };
        self.viewer.export_as_seen(Capture { gpu: self.canvas.gpu.clone(), texture, part }, to);
        // the next frame has hint and message again
        self.canvas.request_frame();
    }

    /// The last frame's widgets and the state behind them.
    pub fn dump(&self) -> String {
        let more = serde_json::json!({ "dragged_ms": self.stats.while_dragging() });
        self.viewer.dump(self.canvas.egui.egui_ctx(), self.scale, more)
    }
}
