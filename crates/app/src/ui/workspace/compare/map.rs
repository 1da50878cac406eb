//! The map of errors, and on it what its colours mean: its name, a colour bar with ticks, its mean, what is not finite,
//! and the numbers under the mouse.

use super::comparison::reference_state;
use super::{effects, magnify, region};
use crate::model::{Against, Comparison, ErrorMap, IN_THE_REGION};
use crate::ruler::{GREY, HeatMap, Pair, brief};
use crate::ui::overlay::{spoken, text_box};
use crate::ui::{UiContext, theme};
use compare::ColourScale;
use egui::{Align2, Color32, Galley, Mesh, Pos2, Rect, Stroke, Ui, pos2, vec2};
use scene::Vec3;
use std::sync::Arc;

/// Steps of colour along the bar.
const STEPS: u32 = 128;

/// Around what the legend says, in points.
const AROUND: egui::Vec2 = vec2(10.0, 6.0);

/// Shows it at `place`, as far as it lies in `rect`.
pub fn show(cx: &mut UiContext, ui: &Ui, (place, rect): (Rect, Rect), hover: Option<Pos2>) {
    let painter = ui.painter().with_clip_rect(rect);
    let (Some(map), Some(texture)) = (&cx.shown.map, cx.textures.map) else {
        // what there will be a map of
        if let Some(texture) = cx.textures.panes.get(cx.model.session.comparison.mapped().of) {
            magnify::paint(&painter, *texture, place, rect);
        }
        let text = why_not(cx);
        let place = text_box(ui, rect, rect.center(), Align2::CENTER_CENTER, &text, Color32::WHITE);
        cx.dump.note_text("label no map", &text, place, rect);
        spoken(ui, "label no map", &text, place, false);
        return;
    };
    magnify::paint(&painter, texture, place, rect);
    effects::lines(cx, &painter, place);
    region::show(cx, &painter, place);
    let under_the_mouse =
        hover.filter(|_| !cx.model.state.posing && !cx.model.state.loupe).and_then(|at| numbers_at(map, place, at));
    if cx.model.state.labels {
        let legend = legend(cx, ui, rect, map, under_the_mouse);
        effects::labels(cx, ui, (place, rect), legend);
    }
}

/// Why there is nothing to see.
fn why_not(cx: &UiContext) -> String {
    let Comparison { of, against, .. } = cx.model.session.comparison.mapped();
    let judge = match against {
        Against::Pane(judge) => Some(judge),
        Against::Reference => None,
    };
    for pane in std::iter::once(of).chain(judge) {
        let Some(shown) = cx.shown.panes.get(pane) else { continue };
        if let Some(fault) = &shown.fault {
            return format!("{pane}: {fault}");
        }
        if let Some([has, seen]) = shown.misfit() {
            return format!(
                "{pane} has {}x{} pixels, and what is seen {}x{}: it has no errors",
                has.0, has.1, seen.0, seen.1
            );
        }
        if shown.provenance.as_ref().is_some_and(|provenance| !provenance.technique.shows_the_scene()) {
            return format!("{pane} does not show the light of the scene: it has no errors");
        }
        let light = shown.provenance.as_ref().map(|provenance| provenance.technique.light());
        if light.is_some_and(|light| !light.is_all()) && against == Against::Reference {
            return format!("{pane} shows a part of the light, the reference all of it: there is no error to tell");
        }
    }
    match against {
        Against::Pane(_) => "rendering ...".into(),
        Against::Reference => format!("{}\ntwo pictures make a map", reference_state(cx)),
    }
}

/// "x 12, y 34: A 0.1 0.2 0.3, reference 0.1 0.2 0.3: 0.004".
fn numbers_at(map: &ErrorMap, place: Rect, at: Pos2) -> Option<String> {
    let HeatMap { width, values, .. } = &map.map;
    let height = map.map.height();
    let share = (at - place.min) / place.size();
    let (x, y) = ((share.x * *width as f32) as u32, (share.y * height as f32) as u32);
    let index = (x < *width && y < height).then_some(y as usize * *width as usize + x as usize)?;
    let channels = |v: Vec3| v.to_array().map(|channel| brief(f64::from(channel))).join(" ");
    let Pair { names, images, .. } = &map.map_job.pair;
    let [a, r] = images.each_ref().map(|image| image.at(x, y).map(channels));
    let error = brief(f64::from(*values.get(index)?));
    Some(format!("x {x}, y {y}: {error}\n{} {}\n{} {}", names[0], a?, names[1], r?))
}

/// The box in the corner, from top to bottom: name, bar, ticks, and the rest in words. Returns where it is.
pub fn legend(cx: &mut UiContext, ui: &Ui, rect: Rect, drawn: &ErrorMap, pixel: Option<String>) -> Rect {
    let map = &drawn.map;
    let painter = ui.painter().with_clip_rect(rect);
    let font = theme::label_font(ui);
    let size = font.size;
    let width = (15.0 * size).min(rect.width() - 36.0).max(40.0);
    let lay = |text: String| painter.layout(text, font.clone(), Color32::WHITE, width);
    let (name, words) = (lay(map.label.clone()), lay(in_words(drawn, pixel)));
    let (bar_height, gap) = (0.9 * size, 0.3 * size);
    let line = name.rows.first().map_or(size, |row| row.height());
    let height = name.size().y + gap + bar_height + gap + line + gap + words.size().y;
    let place = Rect::from_min_size(rect.min + vec2(22.0, 16.0), vec2(width, height));
    painter.rect_filled(place.expand2(AROUND), 7.0, Color32::from_black_alpha(217));

    painter.galley(place.min, name.clone(), Color32::WHITE);
    let bar = Rect::from_min_size(pos2(place.left(), place.top() + name.size().y + gap), vec2(width, bar_height));
    painter.add(coloured(bar, &map.scale));
    for (text, galley, at) in ticks(&map.scale, bar, lay) {
        let foot = pos2(at, bar.bottom());
        painter.line_segment([foot, foot - vec2(0.0, 0.35 * bar_height)], Stroke::new(1.0, Color32::WHITE));
        let left = (at - 0.5 * galley.size().x).clamp(bar.left(), bar.right() - galley.size().x);
        let corner = pos2(left, bar.bottom() + gap);
        cx.dump.note_text(&format!("label tick {text}"), &text, Rect::from_min_size(corner, galley.size()), rect);
        painter.galley(corner, galley, Color32::WHITE);
    }
    let below = place.bottom() - words.size().y;
    let text = format!("{}\n{}", name.text(), words.text());
    painter.galley(pos2(place.left(), below), words, Color32::WHITE);
    cx.dump.note_text("label map", &text, place, rect);
    cx.dump.note_text("bar map", map.scale.map.name(), bar, rect);
    spoken(ui, "label map", &text, place, false);
    place.expand2(AROUND)
}

/// Mean, what is not finite, the numbers under the mouse.
fn in_words(drawn: &ErrorMap, pixel: Option<String>) -> String {
    let place = drawn.map_job.region.map_or_else(String::new, |_| format!(" {IN_THE_REGION}"));
    let mut text = format!("mean{place} {}", brief(drawn.mean));
    if drawn.map.within_noise.is_some() {
        text += &format!("\ngrey: {GREY}");
    }
    if drawn.nonfinite > 0 {
        text += &format!("\n{} pixels{place} are not finite: hatched", drawn.nonfinite);
    }
    pixel.into_iter().for_each(|pixel| text += &format!("\n{pixel}"));
    text
}

fn coloured(bar: Rect, scale: &ColourScale) -> Mesh {
    let mut mesh = Mesh::default();
    for step in 0..STEPS {
        let [from, to] = [step, step + 1].map(|step| bar.left() + bar.width() * step as f32 / STEPS as f32);
        let [r, g, b] = scale.map.srgb((step as f32 + 0.5) / STEPS as f32);
        let strip = Rect::from_min_max(pos2(from, bar.top()), pos2(to, bar.bottom()));
        mesh.add_colored_rect(strip, Color32::from_rgb(r, g, b));
    }
    mesh
}

/// Text and place of the marks that have room beside each other.
fn ticks(scale: &ColourScale, bar: Rect, lay: impl Fn(String) -> Arc<Galley>) -> Vec<(String, Arc<Galley>, f32)> {
    let mut shown: Vec<(String, Arc<Galley>, f32)> = Vec::new();
    let mut free = f32::NEG_INFINITY;
    for tick in scale.ticks(4) {
        let galley = lay(tick.text.clone());
        let at = bar.left() + tick.position * bar.width();
        let left = (at - 0.5 * galley.size().x).clamp(bar.left(), bar.right() - galley.size().x);
        if left >= free {
            free = left + galley.size().x + 4.0;
            shown.push((tick.text, galley, at));
        }
    }
    shown
}
