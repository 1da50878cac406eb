//! The keys of the whole window. Letters are ignored while typing; Tab, arrows, space and enter belong to the widgets;
//! PageUp, PageDown, '.', F5 and Esc stay free for a presenter's remote.

use super::{UiCommand, View, Viewer, What};
use crate::engine::export::Destination;
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

pub fn listen(viewer: &mut Viewer, ctx: &egui::Context, commands: &mut Vec<UiCommand>) {
    let command = |key| pressed(ctx, key, Modifiers::COMMAND) > 0;
    if command(Key::S) {
        let to = Destination::File(viewer.export.seen_file(viewer));
        commands.push(UiCommand::Export { what: What::Seen, to });
    }
    if command(Key::Q) {
        commands.push(UiCommand::Quit);
    }
    if ctx.text_edit_focused() {
        return;
    }
    if ctx.input(|i| i.events.contains(&Event::Copy)) {
        commands.push(UiCommand::Export { what: What::Seen, to: Destination::Clipboard });
    }
    for _ in 0..pressed(ctx, Key::Z, Modifiers::COMMAND) {
        viewer.undo();
    }
    for _ in 0..pressed(ctx, Key::Z, Modifiers::COMMAND | Modifiers::SHIFT) + pressed(ctx, Key::Y, Modifiers::COMMAND) {
        viewer.redo();
    }
    letters(viewer, ctx);
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

fn letters(viewer: &mut Viewer, ctx: &egui::Context) {
    let presses = |key| pressed(ctx, key, Modifiers::NONE);
    let turned_over = |key| presses(key) % 2 == 1;
    for _ in 0..presses(Key::T) {
        viewer.toggle();
    }
    for (key, view) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5].into_iter().zip(View::ALL) {
        for _ in 0..presses(key) {
            viewer.choose(view);
        }
    }
    viewer.paused ^= turned_over(Key::P);
    viewer.panel ^= turned_over(Key::H);
    viewer.restarts += presses(Key::R) as u64;
    if presses(Key::C) > 0 {
        viewer.camera = viewer.scene.camera;
    }
    if ctx.input(|i| i.key_pressed(Key::Questionmark)) {
        viewer.help = !viewer.help;
    }
}
