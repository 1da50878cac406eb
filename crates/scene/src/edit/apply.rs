//! Changes, made in a scene; and what is looked at before they are shown.

use super::places::Places;
use super::{CannotEdit, Edits, Property, Subject, Value, fit, shapes};
use crate::file::beyond_copies;
use crate::nesting::{Effort, overlap_with};
use crate::{Bsdf, Geometry, Mesh, Scene, Shape, limits};
use std::collections::BTreeSet;

/// Which change cannot be made, and why: a line.
#[derive(Debug)]
pub(crate) struct Refused {
    pub change: Change,
    pub why: String,
}

/// A change, or all of a subject.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Change {
    Variant,
    All(Subject),
    One(Subject, &'static str),
}

/// Corners of glass meshes, and pairs of glass shapes in these, that are looked at for overlaps: a millisecond or two. A slider
/// asks at each of its moves, and whoever draws the window waits for the answer. What is beyond is shown without an
/// answer, as glass of glTF models that overlaps is: light is bent wrongly there. Files of changed scenes ask the same,
/// so that what was shown can be opened again.
const EFFORT: usize = 1 << 18;

impl Edits {
    /// The scene with these changes; its meshes stay shared.
    ///
    /// # Errors
    /// If the scene lacks a part or a variant that is changed; if a value or a word is none of its property's; if glass would
    /// overlap other glass; or if shapes would leave what numbers may be in a scene's file.
    pub fn applied_to(&self, scene: &Scene) -> Result<Scene, CannotEdit> {
        self.apply(scene).map_err(|Refused { why, .. }| CannotEdit(why))
    }

    /// As [`Edits::applied_to`], telling which change it is that cannot be made.
    pub(crate) fn apply(&self, scene: &Scene) -> Result<Scene, Refused> {
        let mut edited = scene.clone();
        if let Some(name) = &self.variant {
            edited.wear(name).map_err(|why| Refused { change: Change::Variant, why })?;
        }
        // a file's variant is shown as the file has it, with whatever glass
        let worn = edited.clone();
        let (places, mut moved) = (Places::of(self.values.len(), scene), Vec::new());
        for (subject, values) in &self.values {
            let lacks =
                || Refused { change: Change::All(subject.clone()), why: fit::lacks(scene, subject).to_string() };
            let index = places.find(subject).ok_or_else(lacks)?;
            for property in subject.properties() {
                if let Some(value) = values.get(property.name) {
                    set(&mut edited, (subject, index), property, value)?;
                }
            }
            let is_shape = matches!(subject, Subject::Shape(_));
            if is_shape && edited.shapes[index].geometry != scene.shapes[index].geometry {
                moved.push((subject, index));
            }
        }
        let hidden = shapes::hidden(self, &places);
        moved.retain(|(_, index)| !hidden.contains(index));
        can_stand(scene, &edited, &moved)?;
        self.glass_lies_apart(&worn, &edited, &hidden)?;
        shapes::remove(&mut edited, &hidden);
        Ok(edited)
    }

    /// Refuses glass that was changed and overlaps other glass, unless it has done so in the scene already.
    fn glass_lies_apart(&self, scene: &Scene, edited: &Scene, hidden: &BTreeSet<usize>) -> Result<(), Refused> {
        let all: Vec<(usize, &Geometry)> = (edited.shapes.iter().enumerate())
            .filter(|(index, shape)| is_glass(edited, shape) && !hidden.contains(index))
            .map(|(index, shape)| (index, &shape.geometry))
            .collect();
        let was = |index: usize| {
            let shape = &scene.shapes[index];
            is_glass(scene, shape).then_some((index, &shape.geometry))
        };
        let mut effort = Effort::corners(EFFORT);
        for &(index, geometry) in all.iter().filter(|(index, geometry)| was(*index) != Some((*index, geometry))) {
            let overlapped = |other: usize, effort: &mut Effort| {
                let pair = was(index).zip(was(other));
                pair.is_some_and(|(one, other)| overlap_with(one, [other].into_iter(), effort).is_some())
            };
            let mut others = all.iter().copied();
            while let Some(other) = overlap_with((index, geometry), others.by_ref(), &mut effort) {
                if !overlapped(other, &mut effort) {
                    return Err(self.overlapping(edited, index, other));
                }
            }
        }
        Ok(())
    }

    fn overlapping(&self, edited: &Scene, index: usize, other: usize) -> Refused {
        let shape = |index: usize| Subject::Shape(edited.shape_name(index).into_owned());
        let material = Subject::Material(edited.material_of(&edited.shapes[index]).name.clone());
        let changed = [shape(index), shape(other), material].into_iter().find(|subject| self.changes(subject));
        let why = format!(
            "{} would overlap other glass, {}: glass lies apart, or one wholly inside the other",
            shape(index),
            shape(other)
        );
        Refused { change: changed.map_or(Change::Variant, Change::All), why }
    }
}

fn is_glass(scene: &Scene, shape: &Shape) -> bool {
    matches!(scene.material_of(shape).bsdf, Bsdf::Dielectric { .. })
}

/// Makes a change of what there is, if it may be.
fn set(
    scene: &mut Scene,
    (subject, index): (&Subject, usize),
    property: &Property,
    value: &Value,
) -> Result<(), Refused> {
    let refuse = |why| Err(Refused { change: Change::One(subject.clone(), property.name), why });
    let Property { name, kind, .. } = property;
    let Some(now) = (property.get)(scene, index) else { return Ok(()) };
    if now == *value {
        // also where it is none that a text could state
        return Ok(());
    }
    if !kind.holds(value) {
        return refuse(format!("{name} of {subject}: expected {}", kind.expected()));
    }
    if let Some(why) = fit::unknown_word(scene, subject, index, property, value) {
        return refuse(why.to_string());
    }
    (property.set)(scene, index, value);
    let too_bright = |scale: f32| *name == "strength" && value.number() != Some(scale);
    if *subject == Subject::Sky && scene.environment.as_ref().is_some_and(|map| too_bright(map.scale())) {
        return refuse(format!("{name} of {subject}: its brightest pixel would shine with more than 1e12"));
    }
    Ok(())
}

/// Refuses shapes that stand elsewhere than in the scene, and where or as none may.
fn can_stand(scene: &Scene, edited: &Scene, moved: &[(&Subject, usize)]) -> Result<(), Refused> {
    for (subject, index) in moved {
        if let Some(what) = limits::beyond(&edited.shapes[*index].geometry) {
            return Err(Refused { change: Change::All((*subject).clone()), why: format!("{subject} would {what}") });
        }
    }
    // a mesh that is moved is put into the world by a map
    let is_mesh = |index: usize| matches!(scene.shapes[index].geometry, Geometry::Mesh(_));
    match moved.iter().find(|(_, index)| is_mesh(*index)) {
        Some((subject, _)) if beyond_copies(&edited.shapes).is_some() => {
            let why = format!(
                "{subject}: meshes below {} triangles that are moved have {} triangles together at most",
                Mesh::LARGE,
                Mesh::MOST_COPIED
            );
            Err(Refused { change: Change::All((*subject).clone()), why })
        }
        _ => Ok(()),
    }
}
