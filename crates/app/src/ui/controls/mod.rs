//! The panel of controls, grouped by what they change. What the scene or the technique cannot use is absent.

use super::{Dump, Viewer};
use egui::{Slider, SliderClamping, Ui};
use pathtrace::{Estimator, Roulette};
use raster::{Fake, Shading};

/// The most samples that the slider offers: 2^16.
const MOST_SPP_EXPONENT: u32 = 16;

pub fn show(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    ui.spacing_mut().slider_width = 130.0;
    let needs = viewer.scene.needs();
    if needs.dielectric || needs.sun {
        group(ui, "Scene (both)", |ui| {
            refraction_ratio(viewer, ui, dump);
            sun_radius(viewer, ui, dump);
        });
    }
    group(ui, "A: fake", |ui| fake(viewer, ui, dump));
    group(ui, "B: truth", |ui| {
        estimator(viewer, ui, dump);
        spp(viewer, ui, dump);
        path_length(viewer, ui, dump);
        if let Some(blind) = viewer.truth.blind_spot(&viewer.scene) {
            ui.small(blind);
        }
    });
    group(ui, "Display (both)", |ui| {
        ui.label("Exposure");
        let slider = ui.add(stepped(&mut viewer.display.exposure, -5.0..=5.0, 0.1).suffix(" EV"));
        dump.note("exposure", viewer.display.exposure, slider);
        ui.horizontal(|ui| {
            let restart = ui.button("Restart").on_hover_text("Path trace again from the first sample (R)");
            if dump.note("restart", "", restart).clicked() {
                viewer.revisions.truth += 1;
            }
            let reset = ui.button("Reset camera").on_hover_text("Back to the scene's own camera (C)");
            if dump.note("reset camera", "", reset).clicked() {
                viewer.camera = viewer.scene.camera;
            }
        });
    });
}

/// A slider that changes its value only when the user does. egui's own default rounds and clamps whatever it is shown,
/// in every frame: a scene's number between two steps would be altered by looking at it, and one that does not survive
/// the way there and back, as 1 / (1 / ratio), would never come to rest.
fn stepped(value: &mut f32, range: std::ops::RangeInclusive<f32>, step: f64) -> Slider<'_> {
    Slider::new(value, range).step_by(step).clamping(SliderClamping::Edits)
}

fn group(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    ui.add_space(6.0);
    ui.strong(title);
    ui.separator();
    contents(ui);
}

fn refraction_ratio(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    let Some(mut ratio) = viewer.scene.refraction_ratio() else { return };
    ui.label(format!("Refraction ratio {ratio:.2} (n = {:.2})", 1.0 / ratio));
    let slider = ui
        .add(stepped(&mut ratio, 0.4..=1.0, 0.01))
        .on_hover_text("Index of refraction outside over inside; 1 is no glass at all");
    if dump.note("refraction ratio", ratio, slider).changed() {
        viewer.scene.set_refraction_ratio(ratio);
        viewer.revisions.shared += 1;
    }
}

fn sun_radius(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    let Some(sun) = &mut viewer.scene.sun else { return };
    ui.label("Sun radius (the fake's is always 0)");
    let slider = ui
        .add(stepped(&mut sun.angular_radius, 0.0..=5.0, 0.1).suffix("°"))
        .on_hover_text("0: hard shadows and no caustic. Larger: softer shadows");
    if dump.note("sun radius", sun.angular_radius, slider).changed() {
        viewer.revisions.truth += 1;
    }
}

fn fake(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    ui.horizontal(|ui| {
        for fake in Fake::ALL {
            let chosen = viewer.fake.fake == fake;
            let hover = match fake {
                Fake::Fair => "The same fake on the truth's light, linear",
                Fake::AsTaught => "As the tutorial's viewer drew it: its bytes are the light",
            };
            let button = ui.selectable_label(chosen, fake.name()).on_hover_text(hover);
            if dump.note(&format!("fake {}", fake.name()), chosen, button).clicked() {
                viewer.fake.fake = fake;
            }
        }
    });
    let combo = egui::ComboBox::from_label("Highlight").selected_text(viewer.fake.shading.name()).show_ui(ui, |ui| {
        for shading in Shading::ALL {
            ui.selectable_value(&mut viewer.fake.shading, shading, shading.name());
        }
    });
    dump.note("shading", viewer.fake.shading.name(), combo.response);
    if let Some(mut reflectivity) = viewer.scene.reflectivity() {
        ui.label("Reflectivity of the fake glass");
        let slider = ui
            .add(stepped(&mut reflectivity, 0.0..=1.0, 0.01))
            .on_hover_text("Share of the refracted surroundings; the rest is white");
        if dump.note("reflectivity", reflectivity, slider).changed() {
            viewer.scene.set_reflectivity(reflectivity);
            viewer.revisions.fake += 1;
        }
    }
}

fn estimator(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    ui.horizontal(|ui| {
        for estimator in Estimator::ALL {
            let chosen = viewer.truth.path.estimator == estimator;
            let hover = match estimator {
                Estimator::Uniform => "Directions uniform on the hemisphere, light found by chance",
                Estimator::Cosine => "Directions cosine-weighted, light found by chance",
                Estimator::Light => "Light sampled at every vertex, indirect light cosine-weighted",
            };
            let button = ui.selectable_label(chosen, estimator.name()).on_hover_text(hover);
            if dump.note(&format!("estimator {}", estimator.name()), chosen, button).clicked() {
                viewer.truth.path.estimator = estimator;
            }
        }
    });
}

/// Samples per pixel: powers of two by slider, any number by typing.
fn spp(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    ui.label("Samples per pixel (spp)");
    ui.horizontal(|ui| {
        let mut exponent = viewer.truth.spp.ilog2();
        let slider = ui.add(Slider::new(&mut exponent, 0..=MOST_SPP_EXPONENT).show_value(false));
        if dump.note("spp", viewer.truth.spp, slider).changed() {
            viewer.truth.spp = 1 << exponent;
        }
        let typed = ui.add(egui::DragValue::new(&mut viewer.truth.spp).range(1..=1u32 << MOST_SPP_EXPONENT));
        dump.note("spp value", viewer.truth.spp, typed);
    });
}

/// One control for how long paths may be: bounces, roulette, or both.
fn path_length(viewer: &mut Viewer, ui: &mut Ui, dump: &mut Dump) {
    let path = &mut viewer.truth.path;
    let mut limited = path.bounces.is_some();
    let name = if limited { "Limit bounces (biased)" } else { "Limit bounces" };
    let check = ui.checkbox(&mut limited, name);
    if dump.note("limit bounces", limited, check).changed() {
        path.bounces = limited.then_some(viewer.bounce_limit);
    }
    if let Some(bounces) = &mut path.bounces {
        let slider = ui.add(Slider::new(bounces, 0..=20)).on_hover_text("0 is direct light only");
        viewer.bounce_limit = *bounces;
        dump.note("bounces", *bounces, slider);
    }
    ui.label("Russian roulette");
    ui.horizontal(|ui| {
        let probability = Roulette::Probability(viewer.probability);
        for (name, roulette) in [("off", Roulette::Off), ("P", probability), ("throughput", Roulette::Throughput)] {
            let chosen = std::mem::discriminant(&path.roulette) == std::mem::discriminant(&roulette);
            let button = ui.selectable_label(chosen, name);
            if dump.note(&format!("roulette {name}"), chosen, button).clicked() {
                path.roulette = roulette;
            }
        }
    });
    if let Roulette::Probability(p) = &mut path.roulette {
        let slider = ui.add(stepped(p, 0.05..=1.0, 0.01)).on_hover_text("Probability to survive each vertex");
        viewer.probability = *p;
        dump.note("roulette probability", *p, slider);
    }
}
