//! What there is to say about the rung that is selected: its paragraph, its slide, its error and what it costs.

use super::rows::{figure, milliseconds};
use crate::model::{Rung, RungFacts};
use crate::ui::UiContext;
use crate::ui::theme::palette;
use egui::{RichText, ScrollArea, Ui};

/// Height of all of it in sizes of the type.
pub const HEIGHT: f32 = 11.5;

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let rung = cx.model.session.ladder.selected;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.label(RichText::new(rung.title()).heading());
        let text = ui.label(rung.text());
        cx.dump.note("text rung", rung.text(), text);
        let cost = cost_of(cx, rung);
        let line = ui.label(&cost);
        cx.dump.note("text rung cost", &cost, line);
        let slide = format!("Slide: {}", rung.slide());
        let line = ui.label(RichText::new(&slide).color(palette(ui).dim));
        cx.dump.note("text rung slide", &slide, line);
    });
}

/// Its figures in words, or why there are none.
fn cost_of(cx: &UiContext, rung: Rung) -> String {
    if let Some(what) = cx.model.missing_for(rung) {
        return format!("Nothing to repair here: the scene has no {what}.");
    }
    if !cx.model.climbs(rung) {
        return "Left out: tick its box to climb it.".into();
    }
    let Some(facts) = cx.shown.ladder.facts(rung) else { return "Not reached yet.".into() };
    let error = match facts.errors {
        Some(errors) => format!("relMSE {}, FLIP {}", figure(errors.errors.rel_mse), figure(errors.flip)),
        None => "no error without a reference".into(),
    };
    let taken = cx.shown.ladder.taken_by(rung).map_or_else(String::new, |taken| {
        let (word, by) = if taken < 0.0 { ("more", -taken) } else { ("less", taken) };
        format!(" ({} {word} than before)", figure(by))
    });
    format!("{error}{taken}; {}.", times(rung, facts))
}

fn times(rung: Rung, facts: &RungFacts) -> String {
    let [frame, anew] = [facts.frame_ms, facts.anew_ms].map(milliseconds);
    if matches!(rung, Rung::Whitted | Rung::Path) {
        return format!("{anew} ms for the picture");
    }
    format!("{anew} ms a frame, {frame} ms where maps stay")
}
