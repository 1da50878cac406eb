//! A pane's letter, its technique and its presets, to be chosen: always in sight, in as few lines as the panel has room for.

use super::{named, presets};
use crate::model::{PaneId, PaneSource};
use crate::ui::UiContext;
use crate::ui::theme::{bold, palette};
use crate::ui::widgets::{Explained, segmented, width_of_segments};
use egui::{Button, TextStyle, Ui};
use technique::TechniqueName;

/// Techniques beside each other.
type Row = Vec<TechniqueName>;

/// The pane's letter, its technique and the presets, to be chosen.
pub fn head(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let letter = bold(pane.name()).size(TextStyle::Heading.resolve(ui.style()).size).color(palette(ui).pane(pane));
    named(letter, ui, |ui| {
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            let rows = rows(ui);
            let place = place_of_presets(&rows, ui);
            for (index, row) in rows.iter().enumerate() {
                ui.horizontal(|ui| {
                    techniques(cx, pane, row, ui);
                    if let Some((_, title)) = place.filter(|(row, _)| *row == index) {
                        presets::menu(cx, pane, title, ui);
                    }
                });
            }
            if place.is_none() {
                presets::menu(cx, pane, presets::TITLES[0], ui);
            }
            // more than between the lines, so that they are seen to belong together
            ui.add_space(2.0);
        });
    });
}

/// The techniques in rows that fit.
fn rows(ui: &Ui) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for technique in TechniqueName::OF_LIGHT {
        match rows.last_mut() {
            Some(row) if width(row.iter().copied().chain([technique]), ui) <= ui.available_width() => {
                row.push(technique)
            }
            _ => rows.push(vec![technique]),
        }
    }
    rows
}

/// The row that has room for the menu of presets, the last of several, and the title for which it has: where there is none for the word, a
/// sign.
fn place_of_presets(rows: &[Row], ui: &Ui) -> Option<(usize, &'static str)> {
    let spare = |row: &Row| ui.available_width() - width(row.iter().copied(), ui) - ui.spacing().item_spacing.x;
    presets::TITLES.into_iter().find_map(|title| {
        let row = rows.iter().rposition(|row| presets::width(title, ui) <= spare(row))?;
        Some((row, title))
    })
}

fn width(techniques: impl Iterator<Item = TechniqueName>, ui: &Ui) -> f32 {
    width_of_segments(techniques.map(word), ui)
}

fn techniques(cx: &mut UiContext, pane: PaneId, row: &[TechniqueName], ui: &mut Ui) {
    segmented(ui, |ui| {
        for &technique in row {
            let made_here = *cx.model.session.source(pane) == PaneSource::Made;
            let chosen = made_here && cx.model.session.panes[pane].technique == technique;
            let button = ui.add(Button::selectable(chosen, word(technique))).explained(describe(technique));
            let button = button.accessible_name(technique.title());
            if cx.dump.note(&format!("{pane} {}", technique.name()), chosen, button).clicked() {
                cx.model.session.panes[pane].technique = technique;
                cx.model.session.set_source(pane, PaneSource::Made);
            }
        }
    });
}

/// What stands on its button: its title, as far as there is room for six of them.
fn word(technique: TechniqueName) -> &'static str {
    if technique == TechniqueName::LightTracing { "Light" } else { technique.title() }
}

fn describe(technique: TechniqueName) -> &'static str {
    match technique {
        TechniqueName::Raster => "Rasterised: shadow map, cube map, local shading",
        TechniqueName::Whitted => "Whitted: trees of rays at mirrors and glass, local light elsewhere",
        TechniqueName::Path => "Path traced: light itself, by Monte Carlo",
        TechniqueName::Photon => "Photon mapping: photons from the lights, gathered where the camera looks",
        TechniqueName::LightTracing => "Light tracing: photons from the lights, sent on to the camera",
        TechniqueName::Metropolis => "Metropolis: path tracing in chains, each path a mutation of the last",
        TechniqueName::Normals => "The normals of what is seen",
    }
}
