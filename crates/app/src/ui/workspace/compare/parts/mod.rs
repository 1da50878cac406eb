//! The parts of the scene: a tree of what there is, what the chosen one is and can be made, and the mouse on the pictures.

mod card;
mod colour;
mod control;
pub mod mouse;
mod rows;
mod tree;
mod words;

use self::card::Known;
use self::rows::{List, Row};
use crate::model::{Model, PartFacts, PartTree};
use crate::ui::pressed::Keys;
use crate::ui::theme::{bold, palette};
use crate::ui::widgets::{Explained, Icon, card, framed, icon_button};
use crate::ui::{UiContext, controls};
use egui::{Frame, Key, Margin, RichText, TextStyle, Ui};
use scene::Scene;
use scene::edit::{Edits, Property, Subject, Value};
use std::sync::Arc;

/// Windows narrower than this, in points, have the tree on a card at the right.
const ROOMY: f32 = 1000.0;
/// Of the tree at the left, in sizes of the type: at first, at least and at most.
const WIDTHS: [f32; 3] = [17.0, 11.0, 32.0];
/// And at first no wider than this, in points.
const USUAL_AT_MOST: f32 = 240.0;
/// Rows of the tree that are seen where it stands on a card.
const ROWS_ON_A_CARD: usize = 9;
/// And where the window is low.
const ROWS_OF_FEW: usize = 5;
/// Of so many parts one finds any at a glance.
const AT_A_GLANCE: usize = 12;

/// What is remembered of the parts from frame to frame, so that scenes of a million shapes cost nothing while they rest.
#[derive(Default)]
pub struct Parts {
    /// Of the scene as it was opened.
    tree: Option<PartTree>,
    /// Of the scene with its changes.
    facts: Option<PartFacts>,
    list: List,
    /// What the chosen part is, and what a chosen shape wears.
    known: [Option<Known>; 2],
    /// The place of the chosen shape in the scene as it was opened.
    chosen_shape: Option<u32>,
    /// The part that the tree was last unfolded for.
    followed: Option<Subject>,
    /// Whether the tree has to be scrolled to the chosen row.
    scroll: bool,
    /// Where the tree was scrolled to, and how much of it was seen, in points.
    seen: [f32; 2],
    was_open: bool,
}

pub fn button(cx: &mut UiContext, ui: &mut Ui) {
    let open = cx.model.state.parts.open;
    let hover = "What there is in the scene, and what it is made of: look at it and change it (O); a click chooses";
    let button = icon_button(Icon::Parts, ("Parts", hover), (true, open), ui);
    if cx.dump.note("parts", open, button).clicked() {
        open_or_close(cx.model, !open);
    }
}

/// O opens and closes them.
pub fn keys(cx: &mut UiContext, keys: &Keys) {
    if keys.presses(Key::O) % 2 == 1 {
        open_or_close(cx.model, !cx.model.state.parts.open);
    }
}

/// Opens them with the controls, among which it stands what they are, or closes them.
pub fn open_or_close(model: &mut Model, open: bool) {
    model.state.parts.open = open;
    model.state.panel |= open;
}

impl Parts {
    /// Looks at what there is now. A click on the pictures belongs to the parts or to the probe: opening one closes the other.
    pub fn follow(&mut self, cx: &mut UiContext) {
        let model = &mut *cx.model;
        if model.state.parts.open && model.session.probe.open {
            let newer_is_the_probe = self.was_open;
            (model.state.parts.open, model.session.probe.open) = (!newer_is_the_probe, newer_is_the_probe);
        }
        self.was_open = model.state.parts.open;
        if !self.was_open {
            let list = std::mem::take(&mut self.list).forgotten();
            *self = Parts { list, ..Parts::default() };
            return;
        }
        let (scene, seen) = (&model.document.scene, model.document.seen());
        if self.tree.as_ref().is_none_or(|tree| !Arc::ptr_eq(tree.scene(), scene)) {
            self.tree = Some(PartTree::new(scene.clone()));
            // of another scene it may be another part, or none
            model.state.parts.selected.take_if(|chosen| chosen.index_in(scene).is_none());
            (self.followed, self.list.stale) = (None, true);
        }
        if self.facts.as_ref().is_none_or(|facts| !Arc::ptr_eq(facts.scene(), seen)) {
            self.facts = Some(PartFacts::new(seen.clone()));
            self.list.stale = true;
        }
        self.know(model);
        self.unfold_for(model);
    }

    /// What the chosen part is.
    fn know(&mut self, model: &Model) {
        let chosen = model.state.parts.selected.as_ref();
        Known::keep(&mut self.known[0], chosen, model);
        let worn = self.known[0].as_ref().and_then(Known::worn);
        let [_, of_material] = &mut self.known;
        Known::keep(of_material, worn.as_ref(), model);
    }

    /// Unfolds the tree where the chosen part is, once for each that is chosen.
    fn unfold_for(&mut self, model: &Model) {
        let (Some(tree), Some(facts)) = (&self.tree, &self.facts) else { return };
        let chosen = &model.state.parts.selected;
        let another = self.followed != *chosen;
        if another {
            let index = chosen.as_ref().and_then(|chosen| chosen.index_in(tree.scene()));
            self.chosen_shape = index.map(|index| index as u32).filter(|_| matches!(chosen, Some(Subject::Shape(_))));
            if let Some(subject) = chosen {
                self.list.unfold(subject, self.chosen_shape, tree);
            }
            self.followed.clone_from(chosen);
        }
        self.list.lay_out(tree, facts);
        if let (true, Some(subject)) = (another, chosen) {
            let is_it = |row: &Row| row.is_of(subject, self.chosen_shape, tree, facts);
            if !self.list.rows.iter().any(is_it) && !self.list.filter.is_empty() {
                self.list.filter.clear();
                self.list.stale = true;
                self.list.lay_out(tree, facts);
            }
            self.scroll = true;
        }
    }

    /// The tree at the left, where the window is wide enough for it.
    pub fn beside(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        if !self.is_shown(cx) || !is_roomy(ui) {
            return;
        }
        let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin { left: 8, right: 8, top: 8, bottom: 6 });
        let type_size = TextStyle::Body.resolve(ui.style()).size;
        let [usual, least, most] = WIDTHS.map(|width| width * type_size);
        let usual = usual.min(USUAL_AT_MOST);
        let panel =
            egui::Panel::left("parts").resizable(true).default_size(usual).size_range(least..=most).frame(frame);
        panel.show(ui, |ui| {
            self.head(cx, ui);
            let below = ui.spacing().interact_size.y + 2.0 * ui.spacing().item_spacing.y;
            tree::show(self, cx, ui, (ui.available_height() - below).max(60.0));
            self.foot(cx, ui);
        });
    }

    /// What is told of the chosen part, above the other cards.
    pub fn cards(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        if !self.is_shown(cx) {
            return;
        }
        if !is_roomy(ui) {
            card(None, ui, |ui| {
                self.head(cx, ui);
                let row = tree::row_height(ui) + ui.spacing().item_spacing.y;
                let most = if controls::is_low(ui) { ROWS_OF_FEW } else { ROWS_ON_A_CARD };
                tree::show(self, cx, ui, row * most.min(self.list.rows.len()) as f32);
                // where every line counts it is there with what it takes back
                if !cx.model.document.changes.edits.is_empty() {
                    self.foot(cx, ui);
                }
            });
        }
        match &self.known {
            [Some(part), worn] => {
                let wearers = |of: &Known| Some((self.facts.as_ref()?, of.material?));
                let wearers = |of: &Known| wearers(of).map(|(facts, material)| facts.wearers[material]);
                card::show(cx, part, wearers(part), ui);
                if let Some(worn) = worn {
                    card::show(cx, worn, wearers(worn), ui);
                }
            }
            [None, _] => card(None, ui, |ui| {
                let hint =
                    "Click an object on the picture, or a row of the tree: here stands what it is, to be changed.";
                cx.dump.note("text parts", hint, ui.label(RichText::new(hint).color(palette(ui).dim)));
            }),
        }
    }

    fn is_shown(&self, cx: &UiContext) -> bool {
        cx.model.state.parts.open && cx.model.state.panel && self.tree.is_some()
    }

    /// What scene it is, and a field by which one finds parts where there are many.
    fn head(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        let scene = cx.model.document.scene.clone();
        ui.horizontal(|ui| {
            let close = "Close";
            let room = ui.available_width() - tree::text_width(close, ui) - 28.0;
            ui.scope(|ui| {
                ui.set_max_width(room);
                let name = ui.add(egui::Label::new(bold(&scene.name)).truncate());
                cx.dump.note("text scene of parts", &scene.name, name);
            });
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let close =
                    ui.add(framed(close, ui)).explained("Close the parts (O, Esc)").accessible_name("Close the parts");
                if cx.dump.note("close parts", "", close).clicked() {
                    cx.model.state.parts.open = false;
                }
            });
        });
        if count(&scene) <= AT_A_GLANCE {
            self.list.stale |= !self.list.filter.is_empty();
            self.list.filter.clear();
            return;
        }
        let edit = egui::TextEdit::singleline(&mut self.list.filter).hint_text("Find").desired_width(f32::INFINITY);
        let line = ui.add(edit).explained("Parts whose names hold these letters").accessible_name("Find a part");
        if cx.dump.note("find part", &self.list.filter, line).changed() {
            self.list.stale = true;
        }
    }

    fn foot(&self, cx: &mut UiContext, ui: &mut Ui) {
        let changed = !cx.model.document.changes.edits.is_empty();
        let text = "Leave all as in the file";
        let button = ui.add_enabled(changed, framed(text, ui)).explained("Takes back every change of a part");
        if cx.dump.note("leave all", changed, button).clicked() {
            cx.model.document.changes.edits = Edits::default();
            cx.model.apply_changes();
        }
    }
}

fn is_roomy(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() >= ROOMY
}

/// How many parts there are to choose from.
fn count(scene: &Scene) -> usize {
    scene.cameras.len() + scene.point_lights.len() + scene.shapes.len() + scene.materials.len() + scene.variants.len()
}

/// Changes a property, as [`Model::edit`] does. What was told of a change that could not be made goes with one that could.
fn edit(model: &mut Model, subject: &Subject, property: &'static Property, value: Option<Value>) {
    let told = model.state.message.take();
    let refused = model.state.parts.refused.take();
    model.edit(subject, property, value);
    match &model.state.message {
        Some(message) => model.state.parts.refused = Some(message.text.clone()),
        None => model.state.message = told.filter(|message| refused.as_ref() != Some(&message.text)),
    }
}
