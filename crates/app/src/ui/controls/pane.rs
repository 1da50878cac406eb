//! The settings of a pane's technique: in which order they stand, and what is no setting. Their table says the rest.

use super::setting::{Change, Place};
use super::{bugs, device, external, light};
use crate::model::{PaneId, PaneSource};
use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::fold;
use egui::Ui;
use raster::Shading;
use technique::settings::{Setting, all_of_panes, capitalised};
use technique::{BlindSpot, PaneSettings, Technique, TechniqueName};

/// In which order a technique's controls stand; a setting that is not named stands behind those that are.
fn order(technique: TechniqueName) -> &'static [&'static str] {
    match technique {
        TechniqueName::Raster => &[
            "fake",
            "reflectivity",
            "show",
            "shading",
            "ambient",
            "diffuse",
            "specular",
            "shininess",
            "shadow-map",
            "shadow-filter",
            "shadow-bias",
            "cube-map",
            "segments",
        ],
        TechniqueName::Whitted => &[
            "depth",
            "light",
            "glass-shadows",
            "ambient",
            "traced-sun",
            "spp",
            "denoise",
            "trust",
            "runs",
            "shadow-rays",
            "show",
            "sampler",
            "seed",
        ],
        TechniqueName::Photon => &[
            "photon-picture",
            "photons",
            "radius",
            "alpha",
            "direct-light",
            "spp",
            "denoise",
            "trust",
            "runs",
            "traced-sun",
            "show",
            "sampler",
            "seed",
        ],
        TechniqueName::LightTracing => {
            &["photons", "spp", "denoise", "trust", "runs", "traced-sun", "show", "sampler", "seed"]
        }
        TechniqueName::Metropolis => &[
            "estimator",
            "spp",
            "denoise",
            "trust",
            "runs",
            "light",
            "connections",
            "chains",
            "large-step",
            "mutation",
            "bounces",
            "roulette",
            "traced-sun",
            "show",
            "sampler",
            "seed",
        ],
        TechniqueName::Normals => &["space", "spp", "sampler", "seed"],
        TechniqueName::Path => &[
            "estimator",
            "spp",
            "denoise",
            "trust",
            "runs",
            "light",
            "connections",
            "bounces",
            "branches",
            "roulette",
            "show",
            "sampler",
            "seed",
        ],
    }
}

pub fn show(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    if *cx.model.session.source(pane) == PaneSource::Made {
        of_technique(cx, pane, ui);
        let id = ui.make_persistent_id(("external", pane));
        let title = "Another program's picture";
        let (header, open) = fold(title, Some(palette(ui).dim), (id, false), ui, |ui| external::show(cx, pane, ui));
        cx.dump.note(&format!("{pane} external"), open, header);
    } else {
        external::show(cx, pane, ui);
    }
}

fn of_technique(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let technique = cx.model.session.panes[pane].technique;
    let scene = cx.model.document.seen();
    let mut usable: Vec<_> =
        all_of_panes().filter(|row| row.is_of(technique) && row.needs.missing_in(scene).is_none()).collect();
    let order = order(technique);
    usable.sort_by_key(|row| order.iter().position(|name| *name == row.name).unwrap_or(order.len()));
    let settings = &cx.model.session.panes[pane];
    let (broken, usable): (Vec<_>, Vec<_>) = usable.into_iter().partition(|row| bugs::is_here(row));
    let (more, first): (Vec<_>, Vec<_>) = usable.into_iter().partition(|row| is_rare(row, settings));
    let light = first.iter().position(|row| row.name == "light").map_or(0, |light| light + 1);
    rows(cx, pane, &first[..light], ui);
    if light > 0 {
        light::bars(cx, pane, ui);
    }
    rows(cx, pane, &first[light..], ui);
    let id = ui.make_persistent_id(("more", pane));
    let chooses_device = matches!(cx.model.session.panes[pane].in_use(), Technique::Traced(_));
    let count = more.len() + usize::from(chooses_device && !cx.model.adapters.0.is_empty());
    let title = format!("{count} more settings");
    let (header, open) = fold(&title, Some(palette(ui).dim), (id, false), ui, |ui| {
        if chooses_device {
            device::show(cx, pane, ui);
        }
        rows(cx, pane, &more, ui);
    });
    cx.dump.note(&format!("{pane} more"), open, header);
    bugs::show(cx, pane, &broken, ui);
    faults(cx, pane, ui);
}

/// The terms of the slides' local models: k_a, k_d, k_s and p.
const OF_LOCAL_MODELS: [&str; 5] = ["shading", "ambient", "diffuse", "specular", "shininess"];

/// Whether a row stands among those that are folded away. Who has chosen one of the slides' models looks at its coefficients.
fn is_rare(row: &Setting<PaneSettings>, settings: &PaneSettings) -> bool {
    let looked_at = settings.fake.shading != Shading::Three && OF_LOCAL_MODELS.contains(&row.name);
    row.control.more.contains(&settings.technique) && !looked_at
}

pub(super) fn rows(cx: &mut UiContext, pane: PaneId, rows: &[&Setting<PaneSettings>], ui: &mut Ui) {
    let settings = &mut cx.model.session.panes[pane];
    let scene = cx.model.document.seen().clone();
    let mut place = Place {
        pane: Some((pane, settings.technique)),
        scene: &scene,
        kept: cx.model.state.switched_off.entry(pane),
        dump: cx.dump,
        fault: None,
    };
    for setting in rows {
        match place.show(setting, settings, ui) {
            Some(Change::Set(value)) => settings.set(setting, value),
            Some(Change::Reset) => settings.reset(setting),
            None => {}
        }
    }
    if let Some(fault) = place.fault {
        cx.model.say(Err(fault));
    }
}

/// Says what the settings of what is traced cannot do together, and what they cannot see.
fn faults(cx: &UiContext, pane: PaneId, ui: &mut Ui) {
    let Technique::Traced(traced) = cx.model.session.panes[pane].in_use() else { return };
    if let Err(fault) = traced.integrator.check() {
        ui.label(capitalised(&fault.to_string()));
    }
    let scene = cx.model.document.seen().clone();
    for line in traced.blind_spots(&scene).into_iter().filter_map(BlindSpot::explanation) {
        ui.label(capitalised(line));
    }
}
