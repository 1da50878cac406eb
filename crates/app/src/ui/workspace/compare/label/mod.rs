//! The label of a pane, on the picture: in a corner of what is seen of it, away from the wipe's line.

mod external;
mod text;

use crate::model::{Against, Line, Model, PaneId, PaneView, View};
use crate::ui::overlay::{describe, spoken};
use crate::ui::{UiContext, theme};
use egui::text::{LayoutJob, TextWrapping};
use egui::{Align2, Color32, FontId, Galley, Rect, Stroke, TextFormat, Ui, Vec2, vec2};
use std::sync::Arc;
use text::{Beside, LabelText, Told, no_error};

pub(super) use text::part_of_the_light;

/// Between a label's text and the edge of what is seen of its picture, in points. Half of the line's handle is 7 wide.
const INSET: Vec2 = vec2(22.0, 18.0);
/// The ground around the text.
const PADDING: Vec2 = vec2(10.0, 7.0);
/// The widest text and the narrowest, and the narrowest with figures, in sizes of its type.
const WIDTHS: [f32; 3] = [32.0, 5.0, 12.0];
/// How much of the height of what is seen of a picture its label may cover.
const MOST_HEIGHT: f32 = 0.5;

/// Of figures and facts; notes are yellow.
const PLAIN: Color32 = Color32::from_gray(225);

pub fn show(cx: &mut UiContext, ui: &Ui, clip: Rect, pane: PaneId) {
    let Some(shown) = cx.shown.panes.get(pane).filter(|_| cx.textures.panes.get(pane).is_some()) else { return };
    if !cx.model.state.labels {
        return;
    }
    let beside = beside(cx, pane);
    let mut text = LabelText::of(pane, shown, beside, told(cx, pane, shown), cx.model.state.paused);
    text.notes.extend(no_error(shown, cx.model.session.comparison.comparison(pane).against, beside));
    text.notes.extend(waiting(shown, cx.shown.waiting.get(pane)));
    let room = room(cx, clip, pane);
    let Some(galley) = fitting(ui, &text, pane, room.size()) else { return };
    let place = align(cx.model, pane).align_size_within_rect(galley.size(), room);
    paint(ui, clip, place, galley, colour(pane));
    let (name, whole) = (format!("label {pane}"), text.whole(pane));
    cx.dump.note_text(&name, &whole, place, clip);
    let response = spoken(ui, &name, &whole, place, false);
    let explanation = text.explanations.join("\n");
    if !cx.model.state.posing && !explanation.is_empty() {
        describe(ui, &response, &explanation);
        response.on_hover_text(explanation);
    }
}

/// What its rays wait for, and what stands for that meanwhile.
fn waiting(shown: &PaneView, words: Option<&String>) -> Option<String> {
    match (shown.coarse, words) {
        (true, Some(words)) => Some(format!("coarse meshes: {words}")),
        (true, None) => Some("coarse meshes, until their trees are built".into()),
        (false, words) => words.cloned(),
    }
}

/// What is known of the picture that is shown beside this one.
fn beside<'a>(cx: &UiContext<'a>, pane: PaneId) -> Option<Beside<'a>> {
    cx.shown.panes.iter().find(|(id, _)| *id != pane)
}

/// The errors that are told on a pane's label. Those of two pictures against each other are told once: of A against B,
/// on B's label only where that is alone.
fn told(cx: &UiContext, pane: PaneId, shown: &PaneView) -> Option<Told> {
    let (against, errors) = shown.errors?;
    let told = |of, (against, errors)| Told { of, against, region: shown.region, errors };
    match against {
        Against::Reference => Some(told(pane, (against, errors))),
        Against::Pane(_) if pane == PaneId::A => Some(told(pane, (against, errors))),
        Against::Pane(judge) if cx.model.seen() == View::Pane(pane) => {
            Some(told(judge, cx.shown.panes.get(judge)?.errors?))
        }
        Against::Pane(_) => None,
    }
}

/// Where its text may be: not at the edges, and not where a message stands at the foot of the window.
fn room(cx: &UiContext, clip: Rect, pane: PaneId) -> Rect {
    let mut room = clip.shrink2(INSET);
    if align(cx.model, pane) == Align2::LEFT_BOTTOM {
        room.max.y = room.max.y.min(clip.bottom() - cx.model.state.said_height - PADDING.y);
    }
    room
}

/// Its corner of the part of the picture that is seen: away from the line, and at the foot where the line is above.
fn align(model: &Model, pane: PaneId) -> Align2 {
    match (model.seen(), model.session.line) {
        (View::Wipe, Line::Vertical) if pane != PaneId::A => Align2::RIGHT_TOP,
        (View::Wipe, Line::Horizontal) if pane != PaneId::A => Align2::LEFT_BOTTOM,
        _ => Align2::LEFT_TOP,
    }
}

/// What of a text is shown beside its name.
#[derive(Clone, Copy)]
struct Parts {
    details: bool,
    facts: bool,
    notes: bool,
}

/// As much of a text as there is room for: all of it, or without its facts and then its notes, or its name alone, or nothing.
fn fitting(ui: &Ui, text: &LabelText, pane: PaneId, room: Vec2) -> Option<Arc<Galley>> {
    let size = theme::label_font(ui).size;
    let [widest, narrowest, with_figures] = WIDTHS.map(|width| width * size);
    let width = room.x.min(widest);
    let all = Parts { details: true, facts: true, notes: true };
    let (lacking, bare) = (Parts { facts: false, ..all }, Parts { details: false, facts: false, notes: false });
    let figures = Parts { notes: false, ..lacking };
    let candidates = [(with_figures, all), (with_figures, lacking), (with_figures, figures), (narrowest, bare)];
    candidates.into_iter().filter(|(least, _)| width >= *least).find_map(|(_, parts)| {
        let galley = ui.painter().layout_job(job(ui, text, pane, (size, width), parts));
        (galley.size().y <= MOST_HEIGHT * room.y && galley.size().x <= width).then_some(galley)
    })
}

fn job(ui: &Ui, text: &LabelText, pane: PaneId, (size, width): (f32, f32), parts: Parts) -> LayoutJob {
    let format = |size, colour| TextFormat::simple(FontId::proportional(size), colour);
    let mut job = LayoutJob { wrap: TextWrapping::wrap_at_width(width), ..LayoutJob::default() };
    let bold = |colour| TextFormat::simple(FontId::new(size, theme::semi_bold()), colour);
    job.append(pane.name(), 0.0, bold(colour(pane)));
    job.append(&text.name, 0.5 * size, bold(Color32::WHITE));
    let figures = theme::figures().resolve(ui.style()).size;
    let mut line = |text: &str, colour| job.append(&format!("\n{text}"), 0.0, format(figures, colour));
    if parts.details {
        let width_of = |text: &str| {
            ui.painter()
                .layout_job(LayoutJob::simple_singleline(text.into(), FontId::proportional(figures), Color32::WHITE))
                .size()
                .x
        };
        let lines = text.details_within(|text| width_of(text) <= width);
        lines.iter().for_each(|text| line(text, PLAIN));
    }
    if parts.facts {
        text.facts.iter().for_each(|fact| line(fact, PLAIN));
    }
    if parts.notes {
        text.notes.iter().for_each(|note| line(note, Color32::from_rgb(255, 225, 150)));
    }
    job
}

fn paint(ui: &Ui, clip: Rect, place: Rect, galley: Arc<Galley>, colour: Color32) {
    let painter = ui.painter().with_clip_rect(clip);
    let ground = place.expand2(PADDING);
    painter.rect_filled(ground, 7.0, Color32::from_black_alpha(217));
    painter.vline(ground.left(), ground.y_range(), Stroke::new(3.0, colour));
    painter.galley(place.min, galley, Color32::WHITE);
}

/// Blue and orange, which nobody takes for each other.
fn colour(pane: PaneId) -> Color32 {
    match pane {
        PaneId::A => Color32::from_rgb(140, 200, 255),
        PaneId::B => Color32::from_rgb(255, 185, 100),
        _ => Color32::WHITE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coarse_meshes_are_said_to_be_such_with_or_without_what_is_waited_for() {
        let (coarse, fine) = (PaneView { coarse: true, ..PaneView::default() }, PaneView::default());
        let words = "building the tree of 2.1 million triangles: 40 %, 3 s left".to_owned();
        assert_eq!(waiting(&coarse, Some(&words)), Some(format!("coarse meshes: {words}")));
        assert!(waiting(&coarse, None).is_some_and(|said| said.starts_with("coarse meshes")));
        assert_eq!([waiting(&fine, Some(&words)), waiting(&fine, None)], [Some(words), None]);
    }
}
