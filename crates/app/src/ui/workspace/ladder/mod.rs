//! From the fake to the truth, one defect at a time: rungs with the error that is left and what they cost, and the picture of
//! one of them beside the truth. "What went wrong here?"

mod cards;
mod picture;
mod rows;
mod text;

use super::Workspace;
use crate::model::{COMPARE, LadderShows, Model, Wanted};
use crate::ui::pressed::{HelpLine, Keys};
use crate::ui::theme::palette;
use crate::ui::widgets::{Icon, choice};
use crate::ui::{UiContext, controls as common};
use egui::{Frame, Key, Margin, TextStyle, Ui};

/// The rungs at the left, a picture in the middle, controls at the right.
pub struct Ladder;

/// The keys of what a rung is shown beside, in the order of [`LadderShows::ALL`].
const SHOWS_KEYS: [Key; LadderShows::ALL.len()] = [Key::Num1, Key::Num2, Key::Num3, Key::Num4];

/// Width of the rungs' panel in sizes of the type, and the most that it takes of the window.
const WIDTH_OF_ROWS: f32 = 36.5;
const MOST_OF_THE_WINDOW: f32 = 0.46;

impl Workspace for Ladder {
    fn id(&self) -> &'static str {
        crate::model::LADDER
    }

    fn name(&self) -> &'static str {
        "Ladder"
    }

    fn icon(&self) -> Icon {
        Icon::Ladder
    }

    fn about(&self) -> &'static str {
        "What went wrong here? From the fake to the truth, one defect at a time; again: back to the comparison (D)"
    }

    /// Beside what the rung is shown.
    fn bar(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        let shows = cx.model.session.ladder.shows;
        let words = LadderShows::ALL.map(|each| (each.name().to_owned(), explain(each), each == shows));
        if let Some(index) = choice(("ladder shows", "Rung"), words, ui, cx.dump) {
            cx.model.session.ladder.shows = LadderShows::ALL[index];
        }
    }

    fn keys(&mut self, cx: &mut UiContext, keys: &Keys) {
        for (key, shows) in SHOWS_KEYS.into_iter().zip(LadderShows::ALL) {
            if keys.presses(key) > 0 {
                cx.model.session.ladder.shows = shows;
            }
        }
    }

    fn escape(&mut self, cx: &mut UiContext) {
        cx.model.session.workspace = COMPARE;
    }

    fn ui(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        cx.model.follow_the_ladder();
        let whole = ui.available_rect_before_wrap();
        common::panel(cx, ui, cards::heads, cards::cards);
        let right = ui.available_rect_before_wrap().right();
        let type_size = TextStyle::Body.resolve(ui.style()).size;
        let width = (WIDTH_OF_ROWS * type_size).min(MOST_OF_THE_WINDOW * whole.width());
        let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::symmetric(8, 6));
        egui::Panel::left("rungs").resizable(false).exact_size(width).frame(frame).show(ui, |ui| rows::show(cx, ui));
        let below = egui::Panel::bottom("rung in words").resizable(false).frame(frame);
        below.exact_size(text::HEIGHT * type_size).show(ui, |ui| text::show(cx, ui));
        egui::CentralPanel::default().show(ui, |ui| picture::show(cx, ui));
        let [right, bottom] = [whole.right().min(right), whole.bottom()];
        cx.model.state.seen_corners = [whole.left(), whole.top(), right, bottom];
    }

    fn wanted(&self, model: &Model) -> Wanted {
        Wanted { ladder: Some(model.wanted_ladder()), ..model.wanted([]) }
    }

    fn help(&self) -> Vec<HelpLine> {
        vec![
            ("click a rung, up, down", "show its picture, and what there is to say about it"),
            ("1 2 3 4", "beside the reference, behind a line, the step from the rung before, where its errors are"),
            ("drag the line", "more of one picture, less of the other"),
            ("Esc", "back to the comparison"),
        ]
    }
}

fn explain(shows: LadderShows) -> &'static str {
    match shows {
        LadderShows::Beside => "The rung and the reference beside each other (1)",
        LadderShows::Wipe => "The rung, and behind a line the reference (2)",
        LadderShows::Step => "The rung before it, and behind a line this one: what the repair changes (3)",
        LadderShows::Errors => "Where the errors of the rung are, against the reference (4)",
    }
}
