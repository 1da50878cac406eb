//! The settings of a picture by Whitted's method.

use super::device;
use super::truth::{blind_spot, sampling};
use crate::model::PaneId;
use crate::ui::UiContext;
use crate::ui::widgets::{Stepped, choice, doubling, whole};
use egui::{CollapsingHeader, Ui};
use pathtrace::{GlassShadows, WhittedSettings};
use raster::FakeKnobs;

/// Most shadow rays that the slider offers, as a power of two.
const MOST_SHADOW_RAYS_EXPONENT: u32 = 6;

pub fn show(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let scene = cx.model.document.scene.clone();
    let needs = scene.needs();
    let whitted = &mut cx.model.session.panes[pane].whitted;
    let tree = &mut whitted.tree;
    if needs.dielectric || needs.mirror || needs.rough_conductor {
        let depth = [&*format!("{pane} depth"), "Depth of mirrors and glass"];
        whole(depth, &mut tree.depth, 0..=WhittedSettings::MOST_DEPTH.min(16), ui, cx.dump);
    }
    if needs.dielectric {
        ui.label("Shadows of glass");
        let words = GlassShadows::ALL.map(|g| (g.name().to_owned(), explain(g), tree.glass_shadows == g));
        if let Some(index) = choice(&format!("{pane} glass shadows"), words, ui, cx.dump) {
            tree.glass_shadows = GlassShadows::ALL[index];
        }
    }
    let slider = Stepped {
        name: &format!("{pane} ambient"),
        label: "Ambient light",
        hover: "Stands for all light from one surface on another, and for the sky's",
        range: FakeKnobs::AMBIENT,
        step: 0.01,
        suffix: "",
    };
    slider.show_over(scene.fake.ambient, &mut tree.ambient, ui, cx.dump);
    let spp = format!("{pane} spp");
    doubling([&spp, "Samples per pixel (spp)"], &mut whitted.spp, 0..=16, ui, cx.dump);
    let more = CollapsingHeader::new("More").id_salt(("more", pane)).show_unindented(ui, |ui| {
        device::show(cx, pane, ui);
        let tree = &mut cx.model.session.panes[pane].whitted.tree;
        let rays = format!("{pane} shadow rays");
        doubling(
            [&rays, "Shadow rays to each lamp"],
            &mut tree.shadow_rays,
            0..=MOST_SHADOW_RAYS_EXPONENT,
            ui,
            cx.dump,
        );
        sampling(&mut tree.sampler, &mut tree.seed, pane, ui, cx.dump);
    });
    cx.dump.note(&format!("{pane} more"), more.fully_open(), more.header_response);
    blind_spot(cx, pane, ui);
}

fn explain(shadows: GlassShadows) -> &'static str {
    match shadows {
        GlassShadows::Opaque => "Glass throws a black shadow",
        GlassShadows::Clear => "Light passes glass straight on",
    }
}
