//! The three pictures beside each other, what is told below each, the boxes of the trees, and the colours' legend.

use crate::model::{Counted, TreeFacts, grouped};
use crate::ui::UiContext;
use crate::ui::overlay::say;
use crate::ui::theme::{figures, palette, semi_bold};
use crate::ui::widgets::Explained;
use compare::{ColourMap, log_ticks, tick_text};
use egui::text::{LayoutJob, TextWrapping};
use egui::{Color32, FontId, Mesh, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};
use pathtrace::intersect::counted::Structure;
use scene::{Camera, Vec3};

/// Between pictures, in points.
const GAP: f32 = 10.0;
/// Lines below a picture.
const LINES: usize = 4;
/// Height of the legend, in lines.
const LEGEND: f32 = 2.2;
/// Strips of the legend's bar.
const STEPS: usize = 128;

/// Draws all that there is.
pub fn show_all(cx: &mut UiContext, ui: &mut Ui) {
    let room = ui.max_rect();
    let font = figures().resolve(ui.style());
    let row = 1.3 * font.size;
    let coloured = cx.model.session.trees.show != Counted::Surface;
    let legend = if coloured { LEGEND * row } else { 0.0 };
    let width = ((room.width() - 2.0 * GAP) / 3.0).max(24.0).floor();
    let height = (room.height() - LINES as f32 * row - legend).max(24.0).floor();
    let pixels = (vec2(width, height) * ui.ctx().pixels_per_point()).max(vec2(1.0, 1.0));
    cx.model.state.tree_pixels = (pixels.x as u32, pixels.y as u32);
    for structure in Structure::ALL {
        let place = structure as usize;
        let corner = room.min + vec2(place as f32 * (width + GAP), 0.0);
        let rect = Rect::from_min_size(corner, vec2(width, height));
        show(cx, ui, structure, rect);
        let lines = lines_of(structure, cx.shown.trees.facts[place].as_ref());
        letter(ui, rect, &lines, (&font, row));
    }
    if coloured {
        let top = room.top() + height + LINES as f32 * row;
        show_legend(cx, ui, Rect::from_min_size(pos2(room.left(), top), vec2(room.width(), legend)), &font);
    }
    let hints = std::mem::replace(&mut cx.model.state.hint, false);
    say(cx, ui, room, &[""]);
    cx.model.state.hint = hints;
}

fn show(cx: &mut UiContext, ui: &mut Ui, structure: Structure, rect: Rect) {
    let place = structure as usize;
    let facts = cx.shown.trees.facts[place].as_ref();
    match cx.textures.trees[place].filter(|_| facts.is_some_and(|facts| facts.rays > 0)) {
        Some(texture) => {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture, rect, whole, Color32::WHITE);
        }
        None => _ = ui.painter().rect_filled(rect, 2.0, palette(ui).card),
    }
    if let (Some(facts), Some(camera)) = (facts, cx.shown.trees.camera) {
        draw_boxes(ui, rect, &camera, &facts.boxes.1);
    }
    let response = ui.interact(rect, ui.scope_id().with(("tree", place)), Sense::hover());
    let spoken = lines_of(structure, facts).join(", ");
    let response = response.explained(&spoken);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &spoken));
    cx.dump.note(&format!("tree {}", structure.name()), spoken, response);
}

/// What stands below a picture: its name first.
fn lines_of(structure: Structure, facts: Option<&TreeFacts>) -> Vec<String> {
    let mut lines = vec![structure.name().to_owned()];
    let Some(facts) = facts else { return lines };
    if let Some(fault) = &facts.fault {
        lines.push(fault.clone());
        return lines;
    }
    let (boxes, triangles) = (mean(facts.boxes_a_ray), mean(facts.triangles_a_ray));
    match structure {
        Structure::List => lines.push(format!("all {triangles} triangles a ray")),
        Structure::Two | Structure::Eight if facts.rays > 0 => {
            lines.push(format!("{boxes} boxes, {triangles} triangles a ray"));
        }
        Structure::Two | Structure::Eight => {}
    }
    if facts.rays > 0 {
        lines.push(match facts.whole_seconds > 1.01 * facts.seconds {
            true => format!("≈ {} for every pixel (extrapolated)", duration(facts.whole_seconds)),
            false => format!("{} for {} rays", duration(facts.seconds), grouped(facts.rays)),
        });
    }
    if structure != Structure::List && facts.build_seconds > 0.0 {
        let (seconds, bytes) = (duration(facts.build_seconds), facts.bytes_a_triangle);
        let drawn = &facts.boxes;
        lines.push(match drawn.1.is_empty() {
            true => format!("built in {seconds}, {bytes:.0} bytes of boxes a triangle, {} deep", facts.depth),
            false => format!("{} boxes drawn, {} of {} steps below the root", drawn.1.len(), drawn.0, facts.depth),
        });
    }
    lines
}

/// Two digits are known of a time, if that: "0.12 s", "33 s", "4 min", "2 h".
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{:.1} ms", 1e3 * s),
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{} h", grouped((s / 3600.0).round() as u64)),
    }
}

fn mean(count: f64) -> String {
    if count < 100.0 { format!("{count:.1}") } else { grouped(count.round() as u64) }
}

fn letter(ui: &Ui, rect: Rect, lines: &[String], (font, row): (&FontId, f32)) {
    let palette = palette(ui);
    for (number, text) in lines.iter().enumerate().take(LINES) {
        let (colour, font) = match number {
            0 => (palette.text, FontId::new(font.size, semi_bold())),
            _ => (palette.dim, font.clone()),
        };
        let mut job = LayoutJob::simple_singleline(text.clone(), font, colour);
        job.wrap = TextWrapping::truncate_at_width(rect.width());
        let galley = ui.painter().layout_job(job);
        ui.painter().galley(pos2(rect.left(), rect.bottom() + 3.0 + number as f32 * row), galley, colour);
    }
}

/// The twelve edges of each box, where they are before the camera.
fn draw_boxes(ui: &Ui, rect: Rect, camera: &Camera, boxes: &[(Vec3, Vec3)]) {
    let frame = camera.frame(rect.width() / rect.height());
    let project = |p: Vec3| -> Option<Pos2> {
        let from_eye = p - frame.eye;
        let depth = from_eye.dot(frame.forward);
        let along = |axis: Vec3| from_eye.dot(axis) / (axis.length_squared() * depth);
        let at = vec2(along(frame.right), -along(frame.up));
        (depth > 0.0).then(|| rect.center() + 0.5 * at * rect.size())
    };
    let stroke = Stroke::new(1.0, Color32::from_white_alpha(if boxes.len() > 300 { 60 } else { 150 }));
    let corner = |(lo, hi): &(Vec3, Vec3), i: usize| {
        let side = |axis: usize| if i >> axis & 1 == 0 { lo[axis] } else { hi[axis] };
        project(Vec3::new(side(0), side(1), side(2)))
    };
    let edges =
        (0..8usize).flat_map(|i| (0..3).filter(move |axis| i >> axis & 1 == 0).map(move |axis| (i, i | 1 << axis)));
    let edges: Vec<(usize, usize)> = edges.collect();
    let lines = boxes.iter().flat_map(|bounds| {
        let corners: [Option<Pos2>; 8] = std::array::from_fn(|i| corner(bounds, i));
        edges.iter().filter_map(move |&(a, b)| Some([corners[a]?, corners[b]?])).collect::<Vec<_>>()
    });
    ui.painter().with_clip_rect(rect).extend(lines.map(|ends| Shape::line_segment(ends, stroke)));
}

/// The colours of one test to the most that any ray of the three pictures has, by the logarithm.
fn show_legend(cx: &mut UiContext, ui: &Ui, rect: Rect, font: &FontId) {
    let (most, palette) = (cx.shown.trees.most.max(1.0), palette(ui));
    let width = (0.5 * rect.width()).min(420.0);
    let name = format!("{} that a ray is tested against", cx.model.session.trees.show.name());
    let name = ui.painter().layout_no_wrap(name, font.clone(), palette.dim);
    let left = rect.left() + name.size().x + GAP;
    ui.painter().galley(pos2(rect.left(), rect.top() + 2.0), name, palette.dim);
    let bar = Rect::from_min_size(
        pos2(left, rect.top() + 4.0),
        vec2(width.min(rect.right() - left).max(24.0), 0.8 * font.size),
    );
    let mut mesh = Mesh::default();
    for step in 0..STEPS {
        let [from, to] = [step, step + 1].map(|step| bar.left() + bar.width() * step as f32 / STEPS as f32);
        let [r, g, b] = ColourMap::Viridis.srgb((step as f32 + 0.5) / STEPS as f32);
        let strip = Rect::from_min_max(pos2(from, bar.top()), pos2(to, bar.bottom()));
        mesh.add_colored_rect(strip, Color32::from_rgb(r, g, b));
    }
    ui.painter().add(mesh);
    let mut free = f32::NEG_INFINITY;
    for tick in std::iter::once(0.0).chain(log_ticks(0.0, most.log10())) {
        let share = ((1.0 + tick).ln() / (1.0 + most).ln()) as f32;
        let galley = ui.painter().layout_no_wrap(
            if tick > 0.0 { tick_text(tick) } else { "0".into() },
            font.clone(),
            palette.dim,
        );
        let at = bar.left() + share * bar.width();
        let left = (at - 0.5 * galley.size().x).clamp(bar.left(), (bar.right() - galley.size().x).max(bar.left()));
        if share <= 1.0 && left > free {
            free = left + galley.size().x + 6.0;
            ui.painter()
                .line_segment([pos2(at, bar.bottom()), pos2(at, bar.bottom() - 4.0)], Stroke::new(1.0, Color32::WHITE));
            ui.painter().galley(pos2(left, bar.bottom() + 1.0), galley, palette.dim);
        }
    }
}
