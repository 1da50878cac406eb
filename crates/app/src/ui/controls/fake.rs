//! The settings of a fake.

use crate::model::PaneId;
use crate::ui::widgets::{Stepped, choice, doubling, whole};
use crate::ui::{Dump, UiContext};
use egui::{CollapsingHeader, Ui};
use raster::{Fake, FakeKnobs, Shading, ShadowFilter, Show};
use scene::Scene;
use technique::FakeSettings;

pub fn show(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let scene = cx.model.document.scene.clone();
    let fake = &mut cx.model.session.panes[pane].fake;
    let kinds = Fake::ALL.map(|kind| (kind.name().to_owned(), explain(kind), fake.fake == kind));
    if let Some(index) = choice(&format!("{pane} fake"), kinds, ui, cx.dump) {
        fake.fake = Fake::ALL[index];
    }
    if let Some(own) = scene.reflectivity() {
        let slider = Stepped {
            name: &format!("{pane} reflectivity"),
            label: "Reflectivity of the glass",
            hover: "Share of the refracted surroundings; the rest is white",
            range: 0.0..=1.0,
            step: 0.01,
            suffix: "",
        };
        slider.show_over(own, &mut fake.reflectivity, ui, cx.dump);
    }
    let more = CollapsingHeader::new("More").id_salt(("more", pane)).show_unindented(ui, |ui| {
        shown(fake, &scene, pane, ui, cx.dump);
        shading(fake, &scene, pane, ui, cx.dump);
        if Show::ShadowMap.available(&scene) {
            shadows(&mut fake.knobs, &scene, pane, ui, cx.dump);
        }
        meshes(&mut fake.knobs, &scene, pane, ui, cx.dump);
    });
    cx.dump.note(&format!("{pane} more"), more.fully_open(), more.header_response);
}

/// The picture, or one of its maps.
fn shown(fake: &mut FakeSettings, scene: &Scene, pane: PaneId, ui: &mut Ui, dump: &mut Dump) {
    ui.label("Show");
    let available: Vec<Show> = Show::ALL.into_iter().filter(|show| show.available(scene)).collect();
    let words = available.iter().map(|&show| (show.name().replace('-', " "), describe(show), fake.show == show));
    let words: Vec<_> = words.collect();
    if let Some(index) = choice(&format!("{pane} show"), words, ui, dump) {
        fake.show = available[index];
    }
}

fn shading(fake: &mut FakeSettings, scene: &Scene, pane: PaneId, ui: &mut Ui, dump: &mut Dump) {
    ui.label("Highlight");
    let models = Shading::ALL.map(|shading| (shading.name().to_owned(), source(shading), fake.shading == shading));
    if let Some(index) = choice(&format!("{pane} shading"), models, ui, dump) {
        fake.shading = Shading::ALL[index];
    }
    let own = scene.materials.first().map_or(30.0, |material| material.fake.shininess);
    let slider = Stepped {
        name: &format!("{pane} shininess"),
        label: "Shininess",
        hover: "Exponent of the highlight: higher is smaller",
        range: 0.0..=200.0,
        step: 1.0,
        suffix: "",
    };
    slider.show_over(own, &mut fake.knobs.shininess, ui, dump);
    let slider = Stepped {
        name: &format!("{pane} ambient"),
        label: "Ambient light",
        hover: "The light that stands for all indirect light; fair scales the sky's by it",
        range: FakeKnobs::AMBIENT,
        step: 0.01,
        suffix: "",
    };
    slider.show_over(scene.fake.ambient, &mut fake.knobs.ambient, ui, dump);
}

fn shadows(knobs: &mut FakeKnobs, scene: &Scene, pane: PaneId, ui: &mut Ui, dump: &mut Dump) {
    let mut size = knobs.shadow_map.unwrap_or(scene.fake.shadow_map);
    if doubling([&format!("{pane} shadow map"), "Shadow map (texels a side)"], &mut size, 4..=12, ui, dump) {
        knobs.shadow_map = Some(size);
    }
    ui.label("Shadow filter");
    let filters = ShadowFilter::ALL.map(|filter| (filter.name().to_owned(), taps(filter), knobs.filter == filter));
    if let Some(index) = choice(&format!("{pane} filter"), filters, ui, dump) {
        knobs.filter = ShadowFilter::ALL[index];
    }
    let slider = Stepped {
        name: &format!("{pane} bias"),
        label: "Shadow bias",
        hover: "Added to depths before they are compared: negative lights what shadows itself",
        range: -0.01..=0.01,
        step: 0.0005,
        suffix: "",
    };
    slider.show(&mut knobs.bias, ui, dump);
}

fn meshes(knobs: &mut FakeKnobs, scene: &Scene, pane: PaneId, ui: &mut Ui, dump: &mut Dump) {
    let needs = scene.needs();
    if needs.dielectric {
        let mut size = knobs.cube_map.unwrap_or(scene.fake.cube_map);
        if doubling([&format!("{pane} cube map"), "Cube map (texels a side)"], &mut size, 2..=11, ui, dump) {
            knobs.cube_map = Some(size);
        }
    }
    if needs.spheres {
        let mut segments = knobs.segments.unwrap_or(scene.fake.segments);
        if whole([&format!("{pane} segments"), "Segments of a sphere"], &mut segments, 3..=200, ui, dump) {
            knobs.segments = Some(segments);
        }
    }
}

fn explain(kind: Fake) -> &'static str {
    match kind {
        Fake::Fair => "The same fake on the truth's light, linear",
        Fake::AsTaught => "As the tutorial's viewer drew it: its bytes are the light",
    }
}

fn describe(show: Show) -> &'static str {
    match show {
        Show::Picture => "The scene",
        Show::CubeFaces => "What surrounds the first glass, unfolded: where refracted rays are looked up",
        Show::ShadowMap => "Depths as the light sees them: white is near",
    }
}

fn source(shading: Shading) -> &'static str {
    match shading {
        Shading::Three => "three.js' MeshPhong: a normalised Blinn-Phong with Fresnel",
        Shading::Phong => "The slides' Phong: cosine between mirrored light and viewer",
        Shading::BlinnPhong => "The slides' Blinn-Phong: cosine between normal and half vector",
    }
}

fn taps(filter: ShadowFilter) -> &'static str {
    match filter {
        ShadowFilter::Hard => "The nearest texel alone",
        ShadowFilter::Pcf => "The mean of 17 comparisons",
        ShadowFilter::PcfSoft => "3 x 3 comparisons, blended: the tutorial's",
    }
}
