//! The settings of a picture by Whitted's method.

use super::device;
use super::truth::{blind_spot, sampling};
use super::widgets::{Stepped, choice, doubling, whole};
use crate::engine::Side;
use crate::ui::{Dump, Viewer};
use egui::{CollapsingHeader, Ui};
use pathtrace::{GlassShadows, WhittedSettings};
use raster::FakeKnobs;

/// Most shadow rays that the slider offers, as a power of two.
const MOST_SHADOW_RAYS_EXPONENT: u32 = 6;

pub fn show(viewer: &mut Viewer, side: Side, ui: &mut Ui, dump: &mut Dump) {
    let scene = viewer.scene.clone();
    let needs = scene.needs();
    let whitted = &mut viewer.settings.panes[side as usize].whitted;
    let tree = &mut whitted.tree;
    if needs.dielectric || needs.mirror || needs.rough_conductor {
        let depth = [&*format!("{side:?} depth"), "Depth of mirrors and glass"];
        whole(depth, &mut tree.depth, 0..=WhittedSettings::MOST_DEPTH.min(16), ui, dump);
    }
    if needs.dielectric {
        ui.label("Shadows of glass");
        let words = GlassShadows::ALL.map(|g| (g.name().to_owned(), explain(g), tree.glass_shadows == g));
        if let Some(index) = choice(&format!("{side:?} glass shadows"), words, ui, dump) {
            tree.glass_shadows = GlassShadows::ALL[index];
        }
    }
    let slider = Stepped {
        name: &format!("{side:?} ambient"),
        label: "Ambient light",
        hover: "Stands for all light from one surface on another, and for the sky's",
        range: FakeKnobs::AMBIENT,
        step: 0.01,
        suffix: "",
    };
    slider.show_over(scene.fake.ambient, &mut tree.ambient, ui, dump);
    let spp = format!("{side:?} spp");
    doubling([&spp, "Samples per pixel (spp)"], &mut whitted.spp, 0..=16, ui, dump);
    let more = CollapsingHeader::new("More").id_salt(("more", side as usize)).show_unindented(ui, |ui| {
        device::show(viewer, side, ui, dump);
        let tree = &mut viewer.settings.panes[side as usize].whitted.tree;
        let rays = format!("{side:?} shadow rays");
        doubling([&rays, "Shadow rays to each lamp"], &mut tree.shadow_rays, 0..=MOST_SHADOW_RAYS_EXPONENT, ui, dump);
        sampling(&mut tree.sampler, &mut tree.seed, side, ui, dump);
    });
    dump.note(&format!("{side:?} more"), more.fully_open(), more.header_response);
    blind_spot(viewer, side, ui);
}

fn explain(shadows: GlassShadows) -> &'static str {
    match shadows {
        GlassShadows::Opaque => "Glass throws a black shadow",
        GlassShadows::Clear => "Light passes glass straight on",
    }
}
