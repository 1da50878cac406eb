//! The settings of a truth.

use super::device;
use crate::model::PaneId;
use crate::ui::widgets::{Stepped, choice, doubling, fit};
use crate::ui::{Dump, UiContext};
use egui::{CollapsingHeader, DragValue, Slider, SliderClamping, Ui};
use pathtrace::{Directions, Estimator, LightSampling, PathSettings, Roulette, SamplerKind};
use technique::Technique;

/// The most samples that the slider offers: 2^16.
const MOST_SPP_EXPONENT: u32 = 16;
/// The most bounces that the slider offers, as in the tutorial.
const MOST_BOUNCES: u32 = 20;

pub fn show(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let truth = &mut cx.model.session.panes[pane].truth;
    let estimators = Estimator::ALL.map(|e| (e.name().to_owned(), explain(e), truth.path.estimator == e));
    if let Some(index) = choice(&format!("{pane} estimator"), estimators, ui, cx.dump) {
        truth.path.estimator = Estimator::ALL[index];
    }
    let name = format!("{pane} spp");
    doubling([&name, "Samples per pixel (spp)"], &mut truth.spp, 0..=MOST_SPP_EXPONENT, ui, cx.dump);
    bounces(cx, pane, ui);
    roulette(cx, pane, ui);
    let more = CollapsingHeader::new("More").id_salt(("more", pane)).show_unindented(ui, |ui| {
        device::show(cx, pane, ui);
        let path = &mut cx.model.session.panes[pane].truth.path;
        branches(path, pane, ui, cx.dump);
        sampling(&mut path.sampler, &mut path.seed, pane, ui, cx.dump);
    });
    cx.dump.note(&format!("{pane} more"), more.fully_open(), more.header_response);
    if let Err(fault) = cx.model.session.panes[pane].truth.path.check() {
        ui.label(fault.to_string());
    }
    blind_spot(cx, pane, ui);
}

/// The tutorial's N: directions at each diffuse vertex.
fn branches(path: &mut PathSettings, pane: PaneId, ui: &mut Ui, dump: &mut Dump) {
    let name = format!("{pane} branches");
    doubling([&name, "Directions N at each vertex"], &mut path.branches, 0..=4, ui, dump);
}

/// Where random numbers come from.
pub fn sampling(sampler: &mut SamplerKind, seed: &mut u32, pane: PaneId, ui: &mut Ui, dump: &mut Dump) {
    ui.label("Random numbers");
    let words = SamplerKind::ALL.map(|kind| (kind.name().to_owned(), describe(kind), *sampler == kind));
    if let Some(index) = choice(&format!("{pane} sampler"), words, ui, dump) {
        *sampler = SamplerKind::ALL[index];
    }
    ui.horizontal(|ui| {
        let label = ui.label("Seed");
        let value = ui.add(DragValue::new(seed)).labelled_by(label.id);
        dump.note(&format!("{pane} seed"), *seed, value.on_hover_text("One of 2^32 independent pictures"));
    });
}

fn describe(kind: SamplerKind) -> &'static str {
    match kind {
        SamplerKind::Independent => "Each number independent of all others",
        SamplerKind::Sobol => "Samples of a pixel keep apart from each other: errors fall faster",
    }
}

/// Says what the pane's settings cannot see.
pub fn blind_spot(cx: &UiContext, pane: PaneId, ui: &mut Ui) {
    let scene = cx.model.document.changes.applied_to(&cx.model.document.scene);
    if let Technique::Traced(rays) = cx.model.session.panes[pane].in_use()
        && let Some(blind) = rays.blind_spot(&scene)
    {
        ui.label(blind);
    }
}

fn explain(estimator: Estimator) -> &'static str {
    match (estimator.directions, estimator.light) {
        (Directions::Uniform, LightSampling::BsdfOnly) => "Directions uniform on the hemisphere, light found by chance",
        (Directions::Cosine, LightSampling::BsdfOnly) => "Directions cosine-weighted, light found by chance",
        (Directions::Cosine, LightSampling::NextEvent) => {
            "Light sampled at every vertex, indirect light cosine-weighted"
        }
        (Directions::Cosine, LightSampling::Mis) => {
            "Light sampled and met by chance, weighted; cosine-weighted directions"
        }
        (Directions::Uniform, LightSampling::NextEvent) => "Light sampled at every vertex, indirect light uniform",
        (Directions::Uniform, LightSampling::Mis) => "Light sampled and met by chance, weighted; uniform directions",
    }
}

/// With roulette below, the one control for how long paths may be.
fn bounces(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let path = &mut cx.model.session.panes[pane].truth.path;
    let kept = &mut cx.model.state.switched_off.entry(pane).bounces;
    let mut limited = path.bounces.is_some();
    let name = if limited { "Limit bounces (biased)" } else { "Limit bounces" };
    let check = ui.checkbox(&mut limited, name).on_hover_text("Longer paths are lost: the picture gets too dark");
    if cx.dump.note(&format!("{pane} limit bounces"), limited, check).changed() {
        path.bounces = limited.then_some(*kept);
    }
    if let Some(bounces) = &mut path.bounces {
        fit(ui);
        let slider = Slider::new(bounces, 0..=MOST_BOUNCES).clamping(SliderClamping::Edits);
        let slider = ui.add(slider).accessible_name("Bounces").on_hover_text("0 is direct light only");
        *kept = *bounces;
        cx.dump.note(&format!("{pane} bounces"), *bounces, slider);
    }
}

fn roulette(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let roulette = &mut cx.model.session.panes[pane].truth.path.roulette;
    let kept = &mut cx.model.state.switched_off.entry(pane).probability;
    ui.label("Roulette");
    let off = *roulette == Roulette::OFF;
    let words = [
        ("off".to_owned(), "Paths end by the number of bounces alone", off),
        ("P".to_owned(), "Each vertex is survived with probability P", roulette.probability.is_some()),
        ("throughput".to_owned(), "Dark paths end sooner than bright ones", roulette.throughput),
    ];
    match choice(&format!("{pane} roulette"), words, ui, cx.dump) {
        Some(0) => *roulette = Roulette::OFF,
        Some(1) => roulette.probability = if roulette.probability.is_some() { None } else { Some(*kept) },
        Some(_) => roulette.throughput = !roulette.throughput,
        None => {}
    }
    if let Some(p) = &mut roulette.probability {
        let slider = Stepped {
            name: &format!("{pane} roulette probability"),
            label: "Probability P to survive a vertex",
            hover: "What survives is divided by P, so that the mean stays",
            range: 0.05..=1.0,
            step: 0.01,
            suffix: "",
        };
        slider.show(p, ui, cx.dump);
        *kept = *p;
    }
}
