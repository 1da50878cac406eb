//! The keys of the whole window. Letters are ignored while typing; Tab, arrows, space and enter belong to the widgets;
//! PageUp, PageDown, '.' and F5 stay free for a presenter's remote, and so does Esc where nothing is open that it closes.

use super::pressed::{HelpLine, Keys};
use super::{UiCommand, UiContext, Workspaces, export_menu};
use crate::model::{COMPARE, Destination, ExportRequest, ExportSubject, LADDER, SWEEP, TREES};
use egui::{Context, Event, Key, Modifiers, Popup};

/// What the keys do that every workspace has, for the help.
pub const KEYS: [HelpLine; 19] = [
    ("S", "sweep: many pictures at once, and back to the comparison"),
    ("D", "ladder: from the fake to the truth, one defect at a time, and back to the comparison"),
    ("X", "trees: what a ray is tested against, and back to the comparison"),
    ("P", "pause, go on"),
    ("R", "restart"),
    ("C", "camera of the scene"),
    ("H", "hide or show the controls"),
    ("L", "hide or show the labels"),
    ("Ctrl+Z  Ctrl+Shift+Z", "undo, redo a setting"),
    ("Ctrl+S  Ctrl+C", "save, copy the picture as seen"),
    ("Ctrl+Shift+S", "save the session: all that makes this again"),
    ("Ctrl+P", "save a lab report: one page to read, to print and to hand in"),
    ("Ctrl+R", "read the scene's file again"),
    ("Ctrl + - 0", "larger, smaller, usual size of all text"),
    ("F11", "full screen, and back"),
    ("Esc", "close the menu or the help that is open, or end what a workspace has begun"),
    ("Ctrl+Q", "quit"),
    ("Tab, arrows, space, enter", "reach and use every control"),
    ("?", "this help"),
];

pub fn listen(workspaces: &mut Workspaces, cx: &mut UiContext, context: &Context) {
    let keys = Keys::of(context);
    if keys.command(Key::S) > 0 {
        let file = Destination::File(export_menu::seen_file(cx.model));
        export_as_seen(cx, file);
    }
    if keys.presses_with(Key::S, Modifiers::COMMAND | Modifiers::SHIFT) > 0 {
        let to = Destination::File(export_menu::session_file(cx.model));
        cx.commands.push(UiCommand::Export(ExportRequest { subject: ExportSubject::Session, to }));
    }
    if keys.command(Key::P) > 0 && !cx.model.session.is_in(COMPARE) {
        cx.model.say(Err("a report is of the comparison: Esc goes back to it".into()));
    } else if keys.command(Key::P) > 0 {
        let to = Destination::File(export_menu::report_file(cx.model));
        cx.commands.push(UiCommand::Export(ExportRequest { subject: ExportSubject::Report, to }));
    }
    if keys.command(Key::R) > 0 {
        cx.commands.push(UiCommand::ReadAgain);
    }
    if keys.command(Key::Q) > 0 {
        cx.commands.push(UiCommand::Quit);
    }
    if keys.presses(Key::F11) % 2 == 1 {
        cx.commands.push(UiCommand::FullScreen);
    }
    // egui takes the keyboard from a text field at once
    let was_typing = std::mem::replace(&mut cx.model.state.typing, context.text_edit_focused());
    // egui closes the menu that is open, and the help below waits for the next press
    if keys.presses(Key::Escape) > 0 && !was_typing && !Popup::is_any_open(context) {
        if cx.model.state.loading.is_some() {
            cx.commands.push(UiCommand::StopLoading);
        } else if cx.model.state.help {
            cx.model.state.help = false;
        } else {
            workspaces.open_mut().escape(cx);
        }
    }
    if context.text_edit_focused() {
        return;
    }
    if context.input(|i| i.events.contains(&Event::Copy)) {
        export_as_seen(cx, Destination::Clipboard);
    }
    // settings of A and B are not changed where nobody sees them
    let steps_are_seen = !cx.model.session.is_in(TREES);
    for _ in 0..keys.command(Key::Z) * usize::from(steps_are_seen) {
        cx.model.undo();
    }
    let again = keys.presses_with(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT) + keys.command(Key::Y);
    for _ in 0..again * usize::from(steps_are_seen) {
        cx.model.redo();
    }
    workspaces.open_mut().keys(cx, &keys);
    letters(cx, &keys);
}

fn export_as_seen(cx: &mut UiContext, to: Destination) {
    let subject = export_menu::seen_subject(cx.model);
    cx.commands.push(UiCommand::Export(ExportRequest { subject, to }));
}

fn letters(cx: &mut UiContext, keys: &Keys) {
    let turned_over = |key| keys.presses(key) % 2 == 1;
    for (key, workspace) in [(Key::S, SWEEP), (Key::D, LADDER), (Key::X, TREES)] {
        if turned_over(key) {
            cx.model.turn_to(workspace);
        }
    }
    let state = &mut cx.model.state;
    state.paused ^= turned_over(Key::P);
    state.panel ^= turned_over(Key::H);
    state.labels ^= turned_over(Key::L);
    state.restarts += keys.presses(Key::R) as u64;
    if keys.presses(Key::C) > 0 {
        cx.model.document.camera = cx.model.document.scene.camera;
    }
    if keys.is_pressed(Key::Questionmark) {
        cx.model.state.help = !cx.model.state.help;
    }
}
