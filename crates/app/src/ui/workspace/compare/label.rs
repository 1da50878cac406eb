//! Name, cost and error of a pane, on the picture: in a corner of what is seen of it.

use crate::model::{Line, PaneId, PaneView, View};
use crate::ruler::brief;
use crate::ui::UiContext;
use crate::ui::overlay::{spoken, text_box};
use egui::{Align2, Color32, Rect, Ui, vec2};
use technique::Device;

pub fn show(cx: &mut UiContext, ui: &Ui, clip: Rect, pane: PaneId) {
    let Some(shown) = cx.shown.panes.get(pane).filter(|_| cx.textures.panes.get(pane).is_some()) else { return };
    let text = text(cx, pane, shown);
    let inset = vec2(12.0, 10.0);
    let session = &cx.model.session;
    let (corner, align) = match (session.view, session.line) {
        (View::Wipe, Line::Vertical) if pane != PaneId::A => {
            (clip.right_top() + vec2(-inset.x, inset.y), Align2::RIGHT_TOP)
        }
        _ => (clip.left_top() + inset, Align2::LEFT_TOP),
    };
    let place = text_box(ui, clip, corner, align, &text, colour(pane));
    cx.dump.note_text(&format!("label {pane}"), &text, place, clip);
    spoken(ui, &format!("label {pane}"), &text, place, false);
}

/// Blue and orange, which nobody takes for each other.
fn colour(pane: PaneId) -> Color32 {
    match pane {
        PaneId::A => Color32::from_rgb(140, 200, 255),
        PaneId::B => Color32::from_rgb(255, 185, 100),
        _ => Color32::WHITE,
    }
}

fn text(cx: &UiContext, pane: PaneId, shown: &PaneView) -> String {
    let name = shown.provenance.as_ref().map_or(String::new(), |p| p.technique.label());
    let mut text = format!("{pane}: {name}\n{}", progress(cx, pane, shown));
    if let Some(why) = &shown.refused {
        text += &format!("\non the CPU: the GPU failed: {why}");
    }
    if let Some(cut) = &shown.cut {
        text += &format!("\n{cut}");
    }
    if shown.nonfinite > 0 {
        text += &format!("\n{} samples were not finite and are left out", shown.nonfinite);
    }
    if let Some((against, e)) = shown.errors {
        let (judge, rel_mse, rmse) = (against.name(), brief(e.rel_mse), brief(e.rmse));
        text += &format!("\n{pane} - {judge}: relMSE {rel_mse}\nRMSE {rmse}, bias {:+.1} %", 100.0 * e.relative_bias);
        if e.below_reference_noise() {
            text += "\nat the reference's noise";
        }
    }
    text
}

fn progress(cx: &UiContext, pane: PaneId, shown: &PaneView) -> String {
    let wished = cx.model.session.panes[pane].wished_spp().unwrap_or(0);
    let paused = if cx.model.state.paused && shown.unfinished { ", paused" } else { "" };
    let by = if shown.provenance.as_ref().is_some_and(|made| made.device == Device::Gpu) { " on the GPU" } else { "" };
    match shown.spp {
        Some(spp) if shown.rough => format!("{spp} spp{}", resolution(shown)),
        Some(spp) => format!("{spp} of {wished} spp, {:.1} s{by}{paused}{}", shown.seconds, resolution(shown)),
        None => format!("{:.0} ms{}", shown.seconds * 1000.0, resolution(shown)),
    }
}

/// Of a picture with fewer pixels than there is room for: ", at 1/4 of the resolution".
fn resolution(shown: &PaneView) -> String {
    if shown.shrink > 1 { format!(", at 1/{} of the resolution", shown.shrink) } else { String::new() }
}
