//! The probe: one pixel looked into, Monte Carlo integration seen. How the mean of its samples settles, how they are
//! spread, and the tutorial's integral with the numbers of one sample in it.

mod integral;
mod mean;
mod spread;

use super::plots::drawer_room;
use super::{label, magnify};
use crate::model::{
    Channel, Destination, ExportRequest, ExportSubject, PaneId, PaneProbe, PaneSource, PixelSamples, pixel_at,
};
use crate::ui::pressed::Keys;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, Icon, choice, framed, icon_button};
use crate::ui::{UiCommand, UiContext, export_menu};
use egui::{
    Color32, Frame, Key, Margin, Modifiers, Painter, Pos2, Rect, RichText, Stroke, StrokeKind, TextStyle, Ui, vec2,
};
use film::{Image, Vec3};
use technique::Technique;

/// Of the drawer at first, in points, and in rows of text where that is large; and at least.
const HEIGHT: f32 = 250.0;
const ROWS: f32 = 13.0;
const LEAST_HEIGHT: f32 = 140.0;
/// Of the drawer's width: the course of the mean, and the spread.
const SHARES: [f32; 2] = [0.33, 0.24];

/// Pixels that the arrow keys move by, and with Shift.
const KEYS: [(Key, [i64; 2]); 4] =
    [(Key::ArrowLeft, [-1, 0]), (Key::ArrowRight, [1, 0]), (Key::ArrowUp, [0, -1]), (Key::ArrowDown, [0, 1])];

pub fn button(cx: &mut UiContext, ui: &mut Ui) {
    let open = cx.model.session.probe.open;
    let hover = "Look into a pixel: its samples, their mean and the integral, in numbers (B); a click chooses it";
    let button = icon_button(Icon::Probe, ("Probe", hover), (true, open), ui);
    if cx.dump.note("probe", open, button).clicked() {
        cx.model.session.probe.open = !open;
    }
}

/// B opens and closes it; with Alt the arrow keys move the pixel, with Alt and Shift they turn to another sample.
pub fn keys(cx: &mut UiContext, keys: &Keys) {
    if keys.presses(Key::B) % 2 == 1 {
        cx.model.session.probe.open = !cx.model.session.probe.open;
    }
    if !cx.model.session.probe.open {
        return;
    }
    for (key, [columns, rows]) in KEYS {
        let presses = keys.presses_with(key, Modifiers::ALT) as i64;
        if presses > 0 {
            let size = cx.model.state.picture.size;
            cx.model.session.probe.step([columns * presses, rows * presses], size);
        }
        let turns = keys.presses_with(key, Modifiers::ALT | Modifiers::SHIFT) as i64;
        if turns > 0 && columns != 0 {
            integral::turn(cx, columns * turns);
        }
    }
}

/// A click on the pictures chooses the pixel while the probe is open.
pub fn choose(cx: &mut UiContext, frames: &[Rect], at: Pos2) {
    let share = magnify::picture_at(&cx.model.state.magnification, frames, at);
    if cx.model.session.probe.open && share.iter().all(|share| (0.0..1.0).contains(share)) {
        cx.model.session.probe.at = share;
    }
}

/// Marks the pixel on a picture that lies at `place`.
pub fn mark(cx: &UiContext, painter: &Painter, place: Rect) {
    let (probe, size) = (cx.model.session.probe, cx.model.state.picture.size);
    if !probe.open || size.0 == 0 || size.1 == 0 {
        return;
    }
    let pixel = place.size() / vec2(size.0 as f32, size.1 as f32);
    let [column, row] = probe.pixel(size).map(|at| at as f32 + 0.5);
    let middle = place.min + vec2(column, row) * pixel;
    let (half, arm) = (0.5 * pixel.x.max(7.0), 9.0);
    for (width, colour) in [(4.0, Color32::from_black_alpha(170)), (2.0, Color32::WHITE)] {
        let (stroke, square) = (Stroke::new(width, colour), Rect::from_center_size(middle, vec2(half, half) * 2.0));
        painter.rect_stroke(square, 0.0, stroke, StrokeKind::Outside);
        for way in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
            painter.line_segment([middle + (half + 1.0) * way, middle + (half + arm) * way], stroke);
        }
    }
}

/// Draws the drawer, if it is open.
pub fn drawer(cx: &mut UiContext, ui: &mut Ui) {
    if !cx.model.session.probe.open {
        return;
    }
    let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin::symmetric(10, 6));
    let height = HEIGHT.max(ROWS * ui.text_style_height(&TextStyle::Body));
    let most = drawer_room(cx, ui);
    let panel = egui::Panel::bottom("probe").resizable(true).default_size(height.min(most)).frame(frame);
    let panel = panel.size_range(LEAST_HEIGHT.min(most)..=most);
    panel.show(ui, |ui| {
        head(cx, ui);
        let room = ui.available_width();
        ui.horizontal_top(|ui| {
            mean::plot(cx, ui, SHARES[0] * room);
            spread::plot(cx, ui, SHARES[1] * room);
            ui.add_space(8.0);
            ui.vertical(|ui| egui::ScrollArea::vertical().show(ui, |ui| integral::show(cx, ui)));
        });
    });
}

/// Which pixel it is, what is drawn of it, and its samples as a file.
fn head(cx: &mut UiContext, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let [column, row] = cx.model.session.probe.pixel(cx.model.state.picture.size);
        let text = format!("Pixel {column}, {row}");
        let said = ui.label(RichText::new(&text).strong());
        let said = said.explained("A click on the pictures chooses it, Alt and an arrow key moves it");
        cx.dump.note("text pixel", &text, said);
        for pane in cx.model.session.panes.ids() {
            if let Some(counted) = counted(cx, pane) {
                let said = ui.label(RichText::new(&counted).color(palette(ui).pane(pane)));
                cx.dump.note(&format!("probed light {pane}"), &counted, said);
            }
        }
        let chosen = &mut cx.model.session.probe.channel;
        let words = Channel::ALL.map(|c| (c.name().to_owned(), "Which number of each sample is drawn", *chosen == c));
        if let Some(index) = choice(("samples of", "Samples"), words, ui, cx.dump) {
            *chosen = Channel::ALL[index];
        }
        let any = samples(cx).next().is_some();
        let button = ui.add_enabled(any, framed("CSV", ui)).explained("All samples as comma-separated values");
        let button = button.accessible_name("Save the samples as CSV");
        if cx.dump.note("samples CSV", any, button).clicked() {
            let to = Destination::File(export_menu::samples_file(cx.model));
            cx.commands.push(UiCommand::Export(ExportRequest { subject: ExportSubject::Samples, to }));
        }
        let close = ui.add(framed("Close", ui)).explained("Close the probe (B)").accessible_name("Close the probe");
        if cx.dump.note("close probe", "", close).clicked() {
            cx.model.session.probe.open = false;
        }
    });
}

/// "A: only LDE", of a pane whose samples are of a part of the light.
fn counted(cx: &UiContext, pane: PaneId) -> Option<String> {
    let settings = cx.model.session.panes.get(pane).filter(|_| traced(cx, pane).is_some())?;
    Some(format!("{pane}: {}", label::part_of_the_light(&settings.in_use())?))
}

/// The radiance that a picture has at the pixel.
fn radiance(cx: &UiContext, image: &Image) -> Option<Vec3> {
    let [column, row] = pixel_at(cx.model.session.probe.at, image.size());
    image.at(column, row)
}

/// Whether another program makes a pane's picture, so that the settings of the pane say nothing about it.
fn is_external(cx: &UiContext, pane: PaneId) -> bool {
    *cx.model.session.source(pane) != PaneSource::Made
}

/// The technique of a pane whose pixels have samples that can be traced again.
fn traced(cx: &UiContext, pane: PaneId) -> Option<Technique> {
    let technique = cx.model.session.panes.get(pane)?.in_use();
    (matches!(technique, Technique::Traced(_)) && !is_external(cx, pane)).then_some(technique)
}

/// What is known of a pane's pixel, where it has samples: none of the technique that the pane had before.
fn probed<'a>(cx: &UiContext<'a>, pane: PaneId) -> Option<&'a PaneProbe> {
    cx.shown.probe.get(pane).filter(|_| traced(cx, pane).is_some())
}

/// The samples of each pane that has any.
fn samples<'a>(cx: &UiContext<'a>) -> impl Iterator<Item = (PaneId, &'a PixelSamples)> {
    let of = |pane| Some((pane, probed(cx, pane)?.samples.as_deref()?));
    cx.shown.probe.ids().filter_map(of)
}

/// The one value of a pane whose pixels have no samples.
fn value_without_samples(cx: &UiContext, pane: PaneId) -> Option<Vec3> {
    let shown = cx.shown.panes.get(pane)?;
    let was_traced = shown.provenance.as_ref().is_some_and(|made| matches!(made.technique, Technique::Traced(_)));
    let is_of_before = was_traced || shown.external.is_some() != is_external(cx, pane);
    radiance(cx, shown.image.as_ref()?).filter(|_| traced(cx, pane).is_none() && !is_of_before)
}
