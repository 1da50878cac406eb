//! The effects of light on the map of errors: lines between them, their names with what they have of the error, and a table of
//! them beside it.

use crate::model::{EffectsOfView, ShownEffects, Sides, label_texts, percent, put_labels};
use crate::ui::UiContext;
use crate::ui::overlay::spoken;
use crate::ui::theme::{self, palette};
use crate::ui::widgets::Explained;
use egui::{Button, Color32, Galley, Grid, Mesh, Painter, Pos2, Rect, RichText, Shape, Stroke, Ui, pos2, vec2};
use std::sync::Arc;
use technique::effects::{Effect, EffectShare};

/// Lies over all that is not looked at.
const DIMMED: Color32 = Color32::from_black_alpha(185);

/// A line, and what keeps it apart from whatever it runs over, in points.
const LINES: [(f32, Color32); 2] = [(3.4, Color32::from_black_alpha(190)), (1.4, Color32::WHITE)];

/// Around the words of a label, in points.
const AROUND: egui::Vec2 = vec2(7.0, 3.0);

/// Draws the lines over a map that lies at `place`, and takes the light from all but the effect in hand.
pub fn lines(cx: &UiContext, painter: &Painter, place: Rect) {
    let Some(ShownEffects { of_view, .. }) = &cx.shown.effects else { return };
    if let Some(bright) = cx.model.state.effect.bright(of_view) {
        painter.add(all_but(of_view, bright, place));
    }
    for (width, colour) in LINES {
        for line in &of_view.outlines {
            let points: Vec<Pos2> = line.iter().map(|at| at_share(place, *at)).collect();
            painter.add(Shape::line(points, Stroke::new(width, colour)));
        }
    }
}

/// A dark veil over all other effects, a strip for each row of what lies together.
fn all_but(of_view: &EffectsOfView, bright: Effect, place: Rect) -> Mesh {
    let (width, height) = of_view.map.size;
    let mut veil = Mesh::default();
    for (row, effects) in (0..).zip(of_view.map.effects.chunks(width.max(1) as usize)) {
        let mut column = 0;
        for run in effects.chunk_by(|a, b| (*a == bright) == (*b == bright)) {
            let end = column + run.len();
            if run[0] != bright {
                let corner = |x: usize, y: u32| at_share(place, [x as f32 / width as f32, y as f32 / height as f32]);
                veil.add_colored_rect(Rect::from_min_max(corner(column, row), corner(end, row + 1)), DIMMED);
            }
            column = end;
        }
    }
    veil
}

fn at_share(place: Rect, [x, y]: [f32; 2]) -> Pos2 {
    place.min + vec2(x, y) * place.size()
}

/// Writes names on the map, none over another nor over the `legend`.
pub fn labels(cx: &mut UiContext, ui: &Ui, (place, clip): (Rect, Rect), legend: Rect) {
    let Some(ShownEffects { of_view, shares }) = &cx.shown.effects else { return };
    let painter = ui.painter().with_clip_rect(clip);
    let font = theme::label_font(ui);
    let laid: Vec<(Effect, Arc<Galley>)> = label_texts(&of_view.places, shares, cx.model.state.effect.bright(of_view))
        .into_iter()
        .map(|(effect, text)| (effect, painter.layout_no_wrap(text, font.clone(), Color32::WHITE)))
        .collect();
    let sizes: Vec<(Effect, [f32; 2])> =
        laid.iter().map(|(effect, galley)| (*effect, (galley.size() + 2.0 * AROUND).into())).collect();
    let seen = place.intersect(clip).shrink(4.0);
    let put = put_labels(&sizes, &of_view.places, (sides(place), sides(seen)), vec![sides(legend)]);
    for (effect, [left, top, right, bottom]) in put {
        let Some((_, galley)) = laid.iter().find(|(other, _)| *other == effect) else { continue };
        let ground = Rect::from_min_max(pos2(left, top), pos2(right, bottom));
        painter.rect_filled(ground, 5.0, Color32::from_black_alpha(217));
        painter.galley(ground.min + AROUND, galley.clone(), Color32::WHITE);
        let name = format!("label effect {}", effect.name());
        cx.dump.note_text(&name, galley.text(), ground, clip);
        spoken(ui, &name, galley.text(), ground, false);
    }
}

fn sides(rect: Rect) -> Sides {
    [rect.left(), rect.top(), rect.right(), rect.bottom()]
}

/// The switch, and once the effects are known a table of them.
pub fn controls(cx: &mut UiContext, ui: &mut Ui) {
    let on = &mut cx.model.session.comparison.effects;
    let hover =
        "Outlines and names what makes each part of the picture: refraction, a shadow's edge, a caustic ... (E)";
    let check = ui.checkbox(on, "Name the effects").explained(hover);
    if cx.dump.note("effects", *on, check).changed() {
        cx.model.state.effect = Default::default();
    }
    if !cx.model.session.comparison.effects {
        return;
    }
    match &cx.shown.effects {
        None => cx.dump.note("text effects", "", ui.label(RichText::new("looking ...").color(palette(ui).dim))),
        Some(effects) => table(cx, &effects.shares, ui),
    };
}

/// Each effect with its share of pixels and of squared relative error; a row under the mouse, or clicked, leaves its effect alone
/// in the light.
fn table(cx: &mut UiContext, shares: &[EffectShare], ui: &mut Ui) -> egui::Response {
    let grid = Grid::new("effects").num_columns(3).spacing([10.0, 2.0]).show(ui, |ui| {
        for (title, hover) in [
            ("effect", "What makes the pixels what they are"),
            ("pixels", "Its share of the picture"),
            ("relMSE", "Its share of the squared relative error, whose mean is relMSE"),
        ] {
            ui.label(RichText::new(title).color(palette(ui).dim)).explained(hover);
        }
        ui.end_row();
        for share in shares {
            row(cx, share, ui);
            ui.end_row();
        }
    });
    if let Some(chosen) = cx.model.state.effect.chosen {
        let row = chosen.row();
        ui.label(RichText::new(format!("{} {}", row.about, row.fake)));
    }
    grid.response
}

fn row(cx: &mut UiContext, share: &EffectShare, ui: &mut Ui) {
    let (effect, row) = (share.effect, share.effect.row());
    let [pixels, error] = [share.pixels, share.error].map(percent);
    let chosen = cx.model.state.effect.chosen == Some(effect);
    let button = ui.add(Button::selectable(chosen, row.title));
    let button = button.explained(&format!("{}\nThe fake: {} ({})", row.about, row.fake, row.slide));
    ui.ctx().accesskit_node_builder(button.id, |node| {
        node.set_label(format!("{}: {pixels} of the pixels, {error} of the error", row.title));
    });
    let in_hand = &mut cx.model.state.effect;
    if button.hovered() || button.has_focus() {
        in_hand.hovered = Some(effect);
    }
    if button.clicked() {
        in_hand.chosen = if chosen { None } else { Some(effect) };
    }
    cx.dump.note(&format!("effect {}", effect.name()), &error, button);
    ui.label(pixels);
    ui.label(error);
}
