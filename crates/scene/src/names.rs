//! What the parts of a scene are called. Names are how changes find their part again, so no two shapes share one, and no
//! two point lights.

use crate::{Geometry, Scene};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

/// Names in the order of the scene's lists. A list may be too short: what has no name there is called by its place.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Names {
    /// Of shapes; `/` stands between the parts of a model and what is below them.
    pub shapes: Vec<String>,
    /// Of point lights, in the scene's order.
    pub lights: Vec<String>,
}

impl Names {
    /// Of names that may repeat or be empty: a later one of a name gets a number behind it.
    pub fn new(shapes: Vec<String>, lights: Vec<String>) -> Self {
        Names { shapes: told_apart(shapes), lights: told_apart(lights) }
    }
}

/// In the time of their length, however often a name is there: "ball (2)" is tried for "ball" alone, and once.
fn told_apart(mut names: Vec<String>) -> Vec<String> {
    names.iter_mut().filter(|name| name.is_empty()).for_each(|name| name.push_str("unnamed"));
    let there: HashSet<&str> = names.iter().map(String::as_str).collect();
    let mut times: HashMap<&str, u64> = HashMap::new();
    let mut renamed = Vec::new();
    for (index, name) in names.iter().enumerate() {
        let number = times.entry(name).or_default();
        *number += 1;
        if *number == 1 {
            continue;
        }
        let mut free = format!("{name} ({number})");
        while there.contains(free.as_str()) {
            *number += 1;
            free = format!("{name} ({number})");
        }
        renamed.push((index, free));
    }
    renamed.into_iter().for_each(|(index, free)| names[index] = free);
    names
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

#[cfg(test)]
mod tests;
