//! Name, cost and error of a pane, on the picture: in a corner of what is seen of it.

use super::{Dump, Pane, View, Viewer, spoken, text_box};
use crate::engine::Side;
use crate::ruler::{Against, brief};
use crate::ui::Line;
use egui::{Align2, Color32, Rect, Ui, vec2};
use technique::Device;

pub fn show(viewer: &Viewer, ui: &Ui, clip: Rect, side: Side, pane: &Pane, dump: &mut Dump) {
    if pane.texture.is_none() {
        return;
    }
    let colour = match side {
        Side::A => Color32::from_rgb(140, 200, 255),
        Side::B => Color32::from_rgb(255, 185, 100),
    };
    let text = text(viewer, side, pane);
    let inset = vec2(12.0, 10.0);
    let (corner, align) = match (viewer.view, viewer.line, side) {
        (View::Wipe, Line::Vertical, Side::B) => (clip.right_top() + vec2(-inset.x, inset.y), Align2::RIGHT_TOP),
        _ => (clip.left_top() + inset, Align2::LEFT_TOP),
    };
    let place = text_box(viewer, ui, clip, corner, align, &text, colour);
    dump.note_text(&format!("label {side:?}"), &text, place, clip);
    spoken(ui, &format!("label {side:?}"), &text, place, false);
}

fn text(viewer: &Viewer, side: Side, pane: &Pane) -> String {
    let name = pane.provenance.as_ref().map_or(String::new(), |p| p.technique.label());
    let mut text = format!("{side:?}: {name}\n{}", progress(viewer, side, pane));
    if let Some(why) = &pane.refused {
        text += &format!("\non the CPU: the GPU failed: {why}");
    }
    if pane.nonfinite > 0 {
        text += &format!("\n{} samples were not finite and are left out", pane.nonfinite);
    }
    if let Some(e) = pane.errors {
        let (name, other) = (side.name(), side.other().name());
        let other = if pane.against == Against::Reference { "reference" } else { other };
        let (rel_mse, rmse) = (brief(e.rel_mse), brief(e.rmse));
        text += &format!("\n{name} - {other}: relMSE {rel_mse}\nRMSE {rmse}, bias {:+.1} %", 100.0 * e.relative_bias);
        if e.below_reference_noise() {
            text += "\nat the reference's noise";
        }
    }
    text
}

fn progress(viewer: &Viewer, side: Side, pane: &Pane) -> String {
    let wished = viewer.settings.panes[side as usize].wished_spp().unwrap_or(0);
    let paused = if viewer.paused && pane.unfinished { ", paused" } else { "" };
    let by = if pane.provenance.as_ref().is_some_and(|made| made.device == Device::Gpu) { " on the GPU" } else { "" };
    match pane.spp {
        Some(spp) if pane.rough => format!("{spp} spp{}", resolution(pane)),
        Some(spp) => format!("{spp} of {wished} spp, {:.1} s{by}{paused}{}", pane.seconds, resolution(pane)),
        None => format!("{:.0} ms{}", pane.seconds * 1000.0, resolution(pane)),
    }
}

/// Of a picture with fewer pixels than there is room for: ", at 1/4 of the resolution".
fn resolution(pane: &Pane) -> String {
    if pane.shrink > 1 { format!(", at 1/{} of the resolution", pane.shrink) } else { String::new() }
}
