//! The keys of the whole window. Letters are ignored while typing; Tab, arrows, space and enter belong to the widgets;
//! PageUp, PageDown, '.', F5 and Esc stay free for a presenter's remote.

use super::{UiCommand, UiContext, export_menu};
use crate::model::{Destination, ExportRequest, ExportSubject, View};
use egui::{Event, Key, Modifiers};

/// What the keys do, for the help.
pub const KEYS: [(&str, &str); 15] = [
    ("T", "swap A and B"),
    ("1 2", "A alone, B alone"),
    ("3", "wipe; again: turn the line"),
    ("4", "side by side"),
    ("5", "error map"),
    ("P", "pause, go on"),
    ("R", "restart"),
    ("C", "camera of the scene"),
    ("H", "hide or show the controls"),
    ("Ctrl+Z  Ctrl+Shift+Z", "undo, redo a setting"),
    ("Ctrl+S  Ctrl+C", "save, copy the picture as seen"),
    ("Ctrl + - 0", "larger, smaller, usual size of all text"),
    ("Ctrl+Q", "quit"),
    ("Tab, arrows, space, enter", "reach and use every control"),
    ("?", "this help"),
];

pub fn listen(cx: &mut UiContext, ctx: &egui::Context) {
    let command = |key| pressed(ctx, key, Modifiers::COMMAND) > 0;
    if command(Key::S) {
        let to = Destination::File(export_menu::seen_file(cx.model));
        cx.commands.push(UiCommand::Export(ExportRequest { subject: ExportSubject::AsSeen, to }));
    }
    if command(Key::Q) {
        cx.commands.push(UiCommand::Quit);
    }
    if ctx.text_edit_focused() {
        return;
    }
    if ctx.input(|i| i.events.contains(&Event::Copy)) {
        cx.commands
            .push(UiCommand::Export(ExportRequest { subject: ExportSubject::AsSeen, to: Destination::Clipboard }));
    }
    for _ in 0..pressed(ctx, Key::Z, Modifiers::COMMAND) {
        cx.model.undo();
    }
    for _ in 0..pressed(ctx, Key::Z, Modifiers::COMMAND | Modifiers::SHIFT) + pressed(ctx, Key::Y, Modifiers::COMMAND) {
        cx.model.redo();
    }
    letters(cx, ctx);
}

/// How often a key went down with just these modifiers since the last frame. Two presses within one slow frame are two;
/// a key that is held is one.
fn pressed(ctx: &egui::Context, wanted: Key, with: Modifiers) -> usize {
    let is_wanted = |event: &&Event| match event {
        Event::Key { key, pressed: true, repeat: false, modifiers, .. } => {
            *key == wanted && modifiers.matches_exact(with)
        }
        _ => false,
    };
    ctx.input(|i| i.events.iter().filter(is_wanted).count())
}

fn letters(cx: &mut UiContext, ctx: &egui::Context) {
    let presses = |key| pressed(ctx, key, Modifiers::NONE);
    let turned_over = |key| presses(key) % 2 == 1;
    for _ in 0..presses(Key::T) {
        cx.model.session.toggle();
        cx.model.state.hint = false;
    }
    for (key, view) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5].into_iter().zip(View::ALL) {
        for _ in 0..presses(key) {
            cx.model.session.choose(view);
        }
    }
    cx.model.state.paused ^= turned_over(Key::P);
    cx.model.state.panel ^= turned_over(Key::H);
    cx.model.state.restarts += presses(Key::R) as u64;
    if presses(Key::C) > 0 {
        cx.model.document.camera = cx.model.document.scene.camera;
    }
    if ctx.input(|i| i.key_pressed(Key::Questionmark)) {
        cx.model.state.help = !cx.model.state.help;
    }
}
