//! The card of a part: what it is, and a control for each of its properties.

use super::control::{Change, Field, Place};
use super::{edit, words};
use crate::model::Model;
use crate::ruler::counted;
use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, card, fold, framed};
use egui::{RichText, Ui, accesskit};
use scene::edit::Subject;
use scene::{Scene, Vec3};
use std::sync::Arc;

/// Coordinates go in steps of this share of the scene's extent.
const STEP: f32 = 1.0 / 512.0;

/// What is known of a part of a scene. Some of it takes time for each shape, so that it is found out once for each change.
pub struct Known {
    /// The part that all of it is about.
    pub part: Subject,
    /// The place of a material in the scene's list.
    pub material: Option<usize>,
    scene: Arc<Scene>,
    seen: Arc<Scene>,
    lines: Vec<String>,
    fields: Vec<Field>,
    /// What a shape wears.
    worn: Option<String>,
    step: f64,
}

impl Known {
    /// Keeps what is known of `part` up with the model, or forgets it.
    pub fn keep(known: &mut Option<Known>, part: Option<&Subject>, model: &Model) {
        let (scene, seen) = (&model.document.scene, model.document.seen());
        let holds = known.as_ref().is_some_and(|known| {
            Some(&known.part) == part && Arc::ptr_eq(&known.scene, scene) && Arc::ptr_eq(&known.seen, seen)
        });
        if !holds {
            *known = part.and_then(|part| Known::of(part.clone(), model));
        }
    }

    fn of(part: Subject, model: &Model) -> Option<Self> {
        let (scene, seen) = (&model.document.scene, model.document.seen());
        let edits = &model.document.changes.edits;
        // what is left out is in the scene as it was
        let in_seen = part.index_in(seen).map(|index| (seen, index));
        let (of, index) = in_seen.or_else(|| Some((scene, part.index_in(scene)?)))?;
        let field = |property| {
            let value = edits.value(scene, seen, &part, property)?;
            Some(Field { property, value, words: (property.words)(of), changed: edits.get(&part, property).is_some() })
        };
        let fields: Vec<Field> = part.properties().iter().filter_map(field).collect();
        let worn = matches!(part, Subject::Shape(_)).then(|| of.material_of(&of.shapes[index]).name.clone());
        let material = matches!(part, Subject::Material(_)).then_some(index);
        let (low, high) = scene.bounds();
        let extent = (high - low).max(Vec3::ZERO).max_element();
        let step = f64::from(10f32.powf((STEP * extent).max(1e-6).log10().round()));
        let lines = words::lines(of, &part, index);
        Some(Known { lines, fields, worn, material, step, scene: scene.clone(), seen: seen.clone(), part })
    }

    /// What it wears, if it is a shape.
    pub fn worn(&self) -> Option<Subject> {
        self.worn.clone().map(Subject::Material)
    }
}

/// Draws the card of a part; `wearers` are the shapes that wear it, if it is a material.
pub fn show(cx: &mut UiContext, known: &Known, wearers: Option<u32>, ui: &mut Ui) {
    let (title, kind) = (words::title(&known.part), words::kind(&known.part));
    let id = ui.make_persistent_id(("part", kind));
    card(Some(palette(ui).accent), ui, |ui| {
        let (header, open) = fold(&title, None, (id, true), ui, |ui| {
            ui.push_id(&title, |ui| {
                // both cards may have controls of one name
                ui.ctx().accesskit_node_builder(ui.unique_id(), |node| {
                    node.set_role(accesskit::Role::Group);
                    node.set_label(title.clone());
                });
                lines(cx, known, wearers, ui);
                fields(cx, known, kind, ui);
                leave(cx, known, kind, ui);
            });
        });
        cx.dump.note(&format!("group {kind}"), open, header);
    });
}

fn lines(cx: &mut UiContext, known: &Known, wearers: Option<u32>, ui: &mut Ui) {
    let worn = wearers.map(|count| match count {
        0 => "worn by no shape".into(),
        count => format!("worn by {}", counted(count as usize, "shape")),
    });
    let text = known.lines.iter().cloned().chain(worn).collect::<Vec<_>>().join("; ");
    let said = ui.label(RichText::new(&text).color(palette(ui).dim));
    cx.dump.note(&format!("text {}", words::kind(&known.part)), &text, said);
}

fn fields(cx: &mut UiContext, known: &Known, kind: &str, ui: &mut Ui) {
    for field in &known.fields {
        let name = format!("{kind} {}", field.property.name);
        let mut place = Place { name: &name, step: known.step, dump: cx.dump, fault: None };
        let change = place.show(field, ui);
        if let Some(fault) = place.fault {
            cx.model.say(Err(fault));
        }
        match change {
            Some(Change::Set(value)) => edit(cx.model, &known.part, field.property, Some(value)),
            Some(Change::Reset) => edit(cx.model, &known.part, field.property, None),
            None => {}
        }
    }
}

fn leave(cx: &mut UiContext, known: &Known, kind: &str, ui: &mut Ui) {
    let changed = cx.model.document.changes.edits.changes(&known.part);
    if !changed {
        return;
    }
    let name = format!("Leave the {kind} as in the file");
    let button = ui.add(framed("Leave as in the file", ui)).explained("Takes back what is changed on this card");
    if cx.dump.note(&format!("leave {kind}"), "", button.accessible_name(name)).clicked() {
        cx.model.document.changes.edits.reset_all(&known.part);
        cx.model.apply_changes();
    }
}
