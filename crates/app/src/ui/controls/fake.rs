//! The settings of a fake.

use super::widgets::{Stepped, choice};
use crate::ui::{Dump, Viewer};
use crate::workers::Side;
use egui::{CollapsingHeader, Ui};
use raster::{Fake, Shading};

pub fn show(viewer: &mut Viewer, side: Side, ui: &mut Ui, dump: &mut Dump) {
    let fake = &mut viewer.settings.panes[side as usize].fake;
    let kinds = Fake::ALL.map(|kind| (kind.name().to_owned(), explain(kind), fake.fake == kind));
    if let Some(index) = choice(&format!("{side:?} fake"), kinds, ui, dump) {
        fake.fake = Fake::ALL[index];
    }
    if let Some(own) = viewer.scene.reflectivity() {
        let mut share = fake.reflectivity.unwrap_or(own);
        let slider = Stepped {
            name: &format!("{side:?} reflectivity"),
            label: "Reflectivity of the glass",
            hover: "Share of the refracted surroundings; the rest is white",
            range: 0.0..=1.0,
            step: 0.01,
            suffix: "",
        };
        if slider.show(&mut share, ui, dump) {
            fake.reflectivity = Some(share);
        }
    }
    let more = CollapsingHeader::new("More").id_salt(("more", side as usize)).show_unindented(ui, |ui| {
        ui.label("Highlight");
        let models = Shading::ALL.map(|shading| (shading.name().to_owned(), source(shading), fake.shading == shading));
        if let Some(index) = choice(&format!("{side:?} shading"), models, ui, dump) {
            fake.shading = Shading::ALL[index];
        }
    });
    dump.note(&format!("{side:?} more"), more.fully_open(), more.header_response);
}

fn explain(kind: Fake) -> &'static str {
    match kind {
        Fake::Fair => "The same fake on the truth's light, linear",
        Fake::AsTaught => "As the tutorial's viewer drew it: its bytes are the light",
    }
}

fn source(shading: Shading) -> &'static str {
    match shading {
        Shading::Three => "three.js' MeshPhong: a normalised Blinn-Phong with Fresnel",
        Shading::Phong => "The slides' Phong: cosine between mirrored light and viewer",
        Shading::BlinnPhong => "The slides' Blinn-Phong: cosine between normal and half vector",
    }
}
