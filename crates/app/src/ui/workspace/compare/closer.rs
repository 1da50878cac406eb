//! The card for looking closer: how large pictures are shown, and the region that figures speak of.

use super::{flicker, parts, region};
use crate::model::Magnification;
use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, choice, framed};
use egui::{RichText, Ui};

/// Why it does not flicker faster.
const FLICKER: &str = "A and B by turns at one place, twice a second (F): three flashes a second can harm people with \
                       photosensitive epilepsy";

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    ui.label(RichText::new("Magnified").color(palette(ui).dim));
    let factor = cx.model.state.magnification.factor();
    let words =
        Magnification::FACTORS.map(|f| (format!("{f}x"), "Pixels of the screen for one (+ and -, 0)", f == factor));
    if let Some(index) = choice(("magnified", "Magnified"), words, ui, cx.dump) {
        let magnification = &mut cx.model.state.magnification;
        *magnification = magnification.by(Magnification::FACTORS[index], [0.5; 2]);
    }
    let loupe = &mut cx.model.state.loupe;
    let check =
        ui.checkbox(loupe, "Loupe").explained("The pixels under the mouse of A, B, the reference and the error (I)");
    cx.dump.note("loupe", *loupe, check);
    let flickers = cx.model.state.flicker.is_some();
    let check = ui.checkbox(&mut flickers.clone(), "Flicker between A and B").explained(FLICKER);
    if cx.dump.note("flicker", flickers, check).clicked() {
        flicker::toggle(cx);
    }
    let open = cx.model.state.parts.open;
    let check = ui.checkbox(&mut open.clone(), "Parts of the scene").explained("What there is, to be changed (O)");
    if cx.dump.note("parts of the scene", open, check).clicked() {
        parts::open_or_close(cx.model, !open);
    }
    marked(cx, ui);
}

/// The region in pixels, and the way back to the whole picture.
fn marked(cx: &mut UiContext, ui: &mut Ui) {
    let Some(marked) = cx.model.session.comparison.region else {
        let words = if cx.model.state.marking { "Cancel" } else { "Mark a region" };
        let button =
            ui.add(framed(words, ui)).explained("By the next drag over the pictures (M, or Alt+drag at any time)");
        if cx.dump.note("mark region", cx.model.state.marking, button).clicked() {
            region::toggle(cx);
        }
        return;
    };
    let pixels = marked.pixels(cx.model.state.picture.size);
    let ((width, height), (x, y)) = (pixels.size(), pixels.start);
    let text = format!("Region: {width} x {height} pixels at {x}, {y}");
    cx.dump.note("text region", &text, ui.label(&text));
    let button = ui.add(framed("Whole picture", ui)).explained("Figures and plots speak of all of it again (M or Esc)");
    if cx.dump.note("whole picture", "", button).clicked() {
        region::end(cx);
    }
}
