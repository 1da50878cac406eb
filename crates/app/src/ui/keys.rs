//! The keys of the whole window. Letters are ignored while typing; Tab, arrows, space and enter belong to the widgets;
//! PageUp, PageDown, '.', F5 and Esc stay free for a presenter's remote.

use super::{Request, View, Viewer, What};
use crate::workers::exporter::Destination;
use egui::{Event, Key, Modifiers};

/// What the keys do, for the help.
pub const KEYS: [(&str, &str); 14] = [
    ("T", "swap A and B"),
    ("1 2", "A alone, B alone"),
    ("3", "wipe; again: turn the line"),
    ("4", "side by side"),
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

pub fn listen(viewer: &mut Viewer, ctx: &egui::Context, requests: &mut Vec<Request>) {
    let command = |key| ctx.input_mut(|i| i.consume_key(Modifiers::COMMAND, key));
    if command(Key::S) {
        let to = Destination::File(viewer.export.seen_file(viewer));
        requests.push(Request::Export { what: What::Seen, to });
    }
    if command(Key::Q) {
        requests.push(Request::Quit);
    }
    if ctx.text_edit_focused() {
        return;
    }
    if ctx.input(|i| i.events.contains(&Event::Copy)) {
        requests.push(Request::Export { what: What::Seen, to: Destination::Clipboard });
    }
    let shifted = Modifiers::COMMAND | Modifiers::SHIFT;
    if ctx.input_mut(|i| i.consume_key(shifted, Key::Z)) || command(Key::Y) {
        viewer.redo();
    } else if command(Key::Z) {
        viewer.undo();
    }
    letters(viewer, ctx);
}

fn letters(viewer: &mut Viewer, ctx: &egui::Context) {
    // every press counts, also two within one slow frame
    let presses = |key| if ctx.input(|i| i.modifiers.is_none()) { ctx.input(|i| i.num_presses(key)) } else { 0 };
    let pressed = |key| presses(key) > 0;
    let turned_over = |key| presses(key) % 2 == 1;
    for _ in 0..presses(Key::T) {
        viewer.toggle();
    }
    for (key, view) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4].into_iter().zip(View::ALL) {
        if pressed(key) {
            viewer.choose(view);
        }
    }
    viewer.paused ^= turned_over(Key::P);
    viewer.panel ^= turned_over(Key::H);
    viewer.restarts += presses(Key::R) as u64;
    if pressed(Key::C) {
        viewer.camera = viewer.scene.camera;
    }
    if ctx.input(|i| i.key_pressed(Key::Questionmark)) {
        viewer.help = !viewer.help;
    }
}
