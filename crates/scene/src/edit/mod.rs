//! What is changed in a scene part by part: a material, where a shape stands, a light. A part is known by its name and a
//! change by its property, each of which is a row of one table ([`Subject::properties`]): the window's controls, the text
//! of changes and files of changed scenes are read from it.
//!
//! Changes are of the scene as it was opened, and each states what is to be rather than by how much: so they can be made,
//! taken back and written down in any order.

mod apply;
mod compose;
mod fit;
mod lights;
mod materials;
mod places;
mod shapes;
mod text;
mod value;

pub use crate::file::changed::{CameraChange, ChangedScene, file_text, flattened, to_save};
pub(crate) use apply::{Change, Refused};
pub use text::{Wrong, edits_of, quoted};
pub use value::{Kind, Value};

use crate::Scene;
use std::collections::BTreeMap;
use std::fmt;

/// A part of a scene that can be changed.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Subject {
    /// The material of this name.
    Material(String),
    /// The shape that [`Scene::shape_name`] calls so.
    Shape(String),
    /// The point light that [`Scene::light_name`] calls so.
    Light(String),
    /// The sun, if there is one.
    Sun,
    /// What comes from where nothing is.
    Sky,
}

/// What can be changed in a kind of subjects: a row of its table. `usize` is the subject's index in the scene's list of
/// its kind, 0 for those that there is one of.
#[derive(Debug)]
pub struct Property {
    /// In texts: a key of TOML.
    pub name: &'static str,
    /// In front of its control.
    pub label: &'static str,
    /// What it does, in a line.
    pub help: &'static str,
    /// What it may be.
    pub kind: Kind,
    /// The words that it may be, if it is one.
    pub words: fn(&Scene) -> Vec<String>,
    /// What it is in a scene; `None` where this subject has no such property as it is.
    pub get: fn(&Scene, usize) -> Option<Value>,
    /// Makes it so, if it is a value of its kind. Nothing happens to a subject that has no such property.
    pub set: fn(&mut Scene, usize, &Value),
}

/// Of properties that are no words.
fn no_words(_: &Scene) -> Vec<String> {
    Vec::new()
}

/// Why changes cannot be made: a line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct CannotEdit(pub String);

impl Subject {
    /// The table of what can be changed in it, in the order in which changes are made.
    pub fn properties(&self) -> &'static [Property] {
        match self {
            Subject::Material(_) => materials::PROPERTIES,
            Subject::Shape(_) => shapes::PROPERTIES,
            Subject::Light(_) => lights::OF_POINT_LIGHTS,
            Subject::Sun => lights::OF_SUN,
            Subject::Sky => lights::OF_SKY,
        }
    }

    /// The row of this name.
    pub fn property(&self, name: &str) -> Option<&'static Property> {
        self.properties().iter().find(|property| property.name == name)
    }

    /// Its index in the scene's list of its kind; `None` if the scene has none of it.
    pub fn index_in(&self, scene: &Scene) -> Option<usize> {
        match self {
            Subject::Material(name) => scene.materials.iter().position(|material| material.name == *name),
            Subject::Shape(name) => (0..scene.shapes.len()).find(|index| scene.shape_name(*index) == *name),
            Subject::Light(name) => (0..scene.point_lights.len()).find(|index| scene.light_name(*index) == *name),
            Subject::Sun => scene.sun.map(|_| 0),
            Subject::Sky => Some(0),
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Subject::Material(name) => write!(f, "material '{}'", image_file::escaped(name)),
            Subject::Shape(name) => write!(f, "shape '{}'", image_file::escaped(name)),
            Subject::Light(name) => write!(f, "light '{}'", image_file::escaped(name)),
            Subject::Sun => f.write_str("the sun"),
            Subject::Sky => f.write_str("the sky"),
        }
    }
}

/// Changes of a scene's parts, each property of each subject once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edits {
    /// Which of the file's variants is worn, by its name.
    pub variant: Option<String>,
    /// In the order of subjects; what is in no order of its table is sorted out as it is applied.
    values: BTreeMap<Subject, BTreeMap<&'static str, Value>>,
}

impl Edits {
    /// Whether nothing is changed.
    pub fn is_empty(&self) -> bool {
        self.variant.is_none() && self.values.is_empty()
    }

    /// The subjects that are changed, with what of them.
    pub fn iter(&self) -> impl Iterator<Item = (&Subject, &BTreeMap<&'static str, Value>)> {
        self.values.iter()
    }

    /// What a property is changed to, if it is.
    pub fn get(&self, subject: &Subject, property: &Property) -> Option<&Value> {
        self.values.get(subject)?.get(property.name)
    }

    /// Whether anything of it is changed.
    pub fn changes(&self, subject: &Subject) -> bool {
        self.values.contains_key(subject)
    }

    /// Changes a property of a subject. A value that it cannot have is refused where changes are made.
    pub fn set(&mut self, subject: &Subject, property: &'static Property, value: Value) {
        self.values.entry(subject.clone()).or_default().insert(property.name, value.without_signed_zeros());
    }

    /// Leaves a property to the scene again.
    pub fn reset(&mut self, subject: &Subject, property: &Property) {
        if let Some(values) = self.values.get_mut(subject) {
            values.remove(property.name);
            if values.is_empty() {
                self.values.remove(subject);
            }
        }
    }

    /// Leaves all of a subject to the scene again.
    pub fn reset_all(&mut self, subject: &Subject) {
        self.values.remove(subject);
    }

    /// These changes over others: where both have one of the same property, these hold.
    pub fn over(&self, others: &Edits) -> Edits {
        let mut all = others.clone();
        all.variant = self.variant.clone().or(all.variant);
        for (subject, values) in &self.values {
            all.values
                .entry(subject.clone())
                .or_default()
                .extend(values.iter().map(|(name, value)| (*name, value.clone())));
        }
        all
    }

    /// What a property is in `scene` with these changes, which `edited` is: with sizes and turns as they were changed, which
    /// count from the scene's own.
    pub fn value(&self, scene: &Scene, edited: &Scene, subject: &Subject, property: &Property) -> Option<Value> {
        // what is left out is in the scene as it was
        let there = subject.index_in(edited).map(|index| (edited, index));
        let (of, index) = there.or_else(|| Some((scene, subject.index_in(scene)?)))?;
        let now = (property.get)(of, index)?;
        let stated = self.get(subject, property).filter(|_| matches!(subject, Subject::Shape(_)));
        Some(stated.cloned().unwrap_or(now))
    }
}

#[cfg(test)]
mod limit_tests;
#[cfg(test)]
mod tests;
