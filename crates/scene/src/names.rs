//! What the parts of a scene are called. Names are how changes find their part again, so no two shapes share one, and no
//! two point lights.

use crate::{Geometry, Scene};
use std::borrow::Cow;
use std::collections::HashSet;

/// Names in the order of the scene's lists. A list may be too short: what has no name there is called by its place.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Names {
    /// Of shapes; `/` stands between the parts of a model and what is below them.
    pub shapes: Vec<String>,
    /// Of point lights.
    pub lights: Vec<String>,
}

impl Names {
    /// Of names that may repeat or be empty: a later one of a name gets a number behind it.
    pub fn new(shapes: Vec<String>, lights: Vec<String>) -> Self {
        Names { shapes: told_apart(shapes), lights: told_apart(lights) }
    }
}

fn told_apart(names: Vec<String>) -> Vec<String> {
    let mut taken: HashSet<String> = HashSet::new();
    let all: HashSet<String> = names.iter().cloned().collect();
    let unique = |name: String, taken: &mut HashSet<String>| {
        let mut tried = name.clone();
        let mut number = 1u64;
        while tried.is_empty() || taken.contains(&tried) || (number > 1 && all.contains(&tried)) {
            number += 1;
            tried = format!("{name} ({number})");
        }
        taken.insert(tried.clone());
        tried
    };
    names.into_iter().map(|name| unique(name, &mut taken)).collect()
}

impl Scene {
    /// What a shape is called.
    pub fn shape_name(&self, index: usize) -> Cow<'_, str> {
        match self.names.shapes.get(index) {
            Some(name) => name.into(),
            None => format!("{} {}", self.shapes.get(index).map_or("shape", |shape| shape.geometry.kind()), index + 1)
                .into(),
        }
    }

    /// What a point light is called.
    pub fn light_name(&self, index: usize) -> Cow<'_, str> {
        self.names.lights.get(index).map_or_else(|| format!("light {}", index + 1).into(), |name| name.into())
    }
}

impl Geometry {
    /// What it is, in a word.
    pub fn kind(&self) -> &'static str {
        match self {
            Geometry::Sphere { .. } => "sphere",
            Geometry::Rectangle { .. } => "rectangle",
            Geometry::Disk { .. } => "disk",
            Geometry::Box { .. } => "box",
            Geometry::Mesh(_) | Geometry::Instance(_) => "mesh",
        }
    }
}
