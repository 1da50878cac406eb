//! Text over pictures, for eyes and for screen readers.

use super::{UiContext, theme};
use crate::model::Message;
use egui::accesskit;
use egui::{Align2, Color32, Pos2, Rect, Response, Sense, Ui, vec2};

/// At the foot of `rect`: the last thing worth saying, or else hints for a newcomer, as many as stand in one line.
pub fn say(cx: &mut UiContext, ui: &Ui, rect: Rect, hints: &[&str]) {
    let expired = |message: &Message| message.remaining().is_some_and(|left| left.is_zero());
    let dismissed = ui.input(|i| {
        i.events.iter().any(|e| matches!(e, egui::Event::Key { pressed: true, .. })) || i.pointer.any_pressed()
    });
    cx.model.state.message.take_if(|message| expired(message) || (dismissed && message.is_old()));
    // a scene's file stays faulty until it is mended, whatever else is said meanwhile
    let (name, text, colour) = match &cx.model.state.message {
        _ if cx.model.state.loading.is_some() => {
            ("loading", cx.model.state.loading.clone().unwrap_or_default(), Color32::WHITE)
        }
        Some(message) => {
            ui.ctx().request_repaint_after(message.remaining().unwrap_or(std::time::Duration::MAX));
            let colour = if message.failed { Color32::from_rgb(255, 150, 150) } else { Color32::WHITE };
            ("message", message.text.clone(), colour)
        }
        None if cx.model.state.scene_fault.is_some() => {
            let fault = cx.model.state.scene_fault.clone().unwrap_or_default();
            ("fault", fault, Color32::from_rgb(255, 150, 150))
        }
        None if cx.model.state.hint => ("hint", in_one_line(hints, ui, rect), Color32::WHITE),
        None => {
            cx.model.state.said_height = 0.0;
            return;
        }
    };
    let at = rect.center_bottom() - vec2(0.0, 12.0);
    let place = text_box(ui, rect, at, Align2::CENTER_BOTTOM, &text, colour);
    cx.model.state.said_height = rect.bottom() - place.top() + AROUND.y;
    cx.dump.note_text(name, &text, place, rect);
    spoken(ui, name, &text, place, true);
}

/// As many of the first hints as stand in one line before the last one, which is there at any rate.
fn in_one_line(hints: &[&str], ui: &Ui, rect: Rect) -> String {
    let fits = |text: &str| {
        let text = ui.painter().layout_no_wrap(text.to_owned(), theme::label_font(ui), Color32::WHITE);
        text.size().x <= widest(rect)
    };
    let Some((last, before)) = hints.split_last() else { return String::new() };
    let shorter = (1..=before.len()).rev().map(|kept| format!("{} {last}", before[..kept].join(" ")));
    shorter.into_iter().find(|text| fits(text)).unwrap_or_else(|| (*last).to_owned())
}

/// Gives painted text to screen readers and returns what is known of the mouse over it; `aloud` is read out as soon as it
/// changes.
pub fn spoken(ui: &Ui, name: &str, text: &str, place: Rect, aloud: bool) -> Response {
    let response = ui.interact(place, ui.scope_id().with(name), Sense::hover());
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_role(accesskit::Role::Status);
        node.set_label(text.to_owned());
        if aloud {
            node.set_live(accesskit::Live::Polite);
        }
    });
    response
}

/// Gives screen readers what a tooltip says.
pub fn describe(ui: &Ui, response: &Response, text: &str) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(text.to_owned()));
}

/// Between a text and the edge of its ground, in points.
const AROUND: egui::Vec2 = vec2(10.0, 6.0);

/// How wide a text over a picture may be.
fn widest(clip: Rect) -> f32 {
    (clip.width() - 32.0).max(40.0)
}

/// Text on a dark ground that keeps it readable over any picture; returns where it is.
pub fn text_box(ui: &Ui, clip: Rect, at: Pos2, align: Align2, text: &str, colour: Color32) -> Rect {
    let painter = ui.painter().with_clip_rect(clip);
    let galley = painter.layout(text.to_owned(), theme::label_font(ui), colour, widest(clip));
    let place = align.anchor_size(at, galley.size() + 2.0 * AROUND).shrink2(AROUND);
    painter.rect_filled(place.expand2(AROUND), 7.0, Color32::from_black_alpha(217));
    painter.galley(place.min, galley, colour);
    place
}
