//! The window while its first scene is read: says what is read and how far it is.

use super::canvas::Canvas;
use crate::engine::beginning::{Beginning, Reading};
use crate::model::{Theme, ViewArgs};
use crate::ui::{self, Dump, UiCommand};
use image_file::shown;
use std::path::Path;
use std::time::Instant;
use technique::Adapters;

/// A window without a scene.
pub struct Waiting {
    /// The window, and what it is drawn with.
    pub canvas: Canvas,
    /// What there is to trace rays.
    pub adapters: Adapters,
    reading: Reading,
    /// The scene that is read, as the user named it.
    name: String,
    theme: Theme,
    dump: Dump,
    scale: f32,
    next_frame: Option<Instant>,
}

/// What became of a frame.
pub enum Waited {
    /// The scene is still being read.
    On,
    /// The scene was read, or cannot be.
    Read(Box<anyhow::Result<Beginning>>),
    /// The user wants it no more.
    Stopped,
    /// The user wants to quit.
    Quit,
}

impl Waiting {
    /// In this window, for what is being read.
    pub fn new(canvas: Canvas, adapters: Adapters, reading: Reading, args: &ViewArgs) -> Self {
        let (name, theme) = (shown(Path::new(&args.scene)), args.theme.unwrap_or_default());
        let (dump, scale, next_frame) = (Dump::default(), 1.0, None);
        Waiting { canvas, adapters, reading, name, theme, dump, scale, next_frame }
    }

    /// When egui wants the next frame by itself.
    pub fn next_frame(&self) -> Option<Instant> {
        self.next_frame
    }

    /// One frame: looks whether the scene is there, and else says how far it is.
    pub fn frame(&mut self) -> Waited {
        if let Some(read) = self.reading.read() {
            return Waited::Read(read.into());
        }
        let mut wish = None;
        let drawn = self.canvas.draw(|ui| {
            self.dump = Dump::default();
            wish = ui::show_waiting((&self.name, self.reading.doing()), self.theme, &mut self.dump, ui).or(wish.take());
        });
        self.scale = drawn.scale;
        (_, self.next_frame) = self.canvas.present(drawn);
        match wish {
            Some(UiCommand::StopLoading) => Waited::Stopped,
            Some(UiCommand::Quit) => Waited::Quit,
            _ => Waited::On,
        }
    }

    /// The last frame's widgets, for tests.
    pub fn dump(&self) -> String {
        self.dump.json(self.scale, None, serde_json::json!({ "loading": self.reading.doing() }))
    }
}
