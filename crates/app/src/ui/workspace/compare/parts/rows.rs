//! The rows of the tree of parts, as they are folded.

use crate::model::{PartChild, PartFacts, PartTree, is_in};
use scene::Scene;
use scene::edit::Subject;
use std::collections::HashSet;

/// Of shapes that are found by their names so many are listed.
const MOST_FOUND: usize = 2000;

/// What belongs together in the tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Section {
    /// Cameras that the scene's file has.
    Cameras,
    /// What shines, be it a shape or not.
    Lights,
    /// Shapes, as a tree of their names.
    Shapes,
    /// Materials, which are what shapes wear.
    Materials,
    /// Versions of a model.
    Variants,
}

impl Section {
    /// The title over its rows.
    pub fn name(self) -> &'static str {
        match self {
            Section::Cameras => "Cameras",
            Section::Lights => "Lights",
            Section::Shapes => "Shapes",
            Section::Materials => "Materials",
            Section::Variants => "Variants",
        }
    }
}

/// A row of the tree. Numbers are indices into the lists of the scene as it was opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Row {
    /// A title that folds what is below it, and how much that is.
    Section(Section, usize),
    /// One of the file's cameras.
    Camera(usize),
    /// The sun, where the scene has one.
    Sun,
    /// What comes from where nothing is.
    Sky,
    /// A point light by its index in the scene.
    Light(usize),
    /// A shape that shines, by its index in the scene with its changes.
    Shining(u32),
    /// Shapes whose names begin alike.
    Branch {
        /// Its index in the tree.
        index: u32,
        /// How many branches it is in.
        depth: usize,
    },
    /// A shape by its index in the scene.
    Shape {
        /// Its index in the scene's list of its kind.
        index: u32,
        /// Where in its name begins what is shown.
        label_at: u32,
        /// How many branches it is in.
        depth: usize,
    },
    /// A material by its index in the scene.
    Material(usize),
    /// A variant, or the usual one.
    Variant(Option<usize>),
}

impl Row {
    /// Whether it stands for a part; `shape` is the index of that, if it is a shape.
    pub fn is_of(&self, part: &Subject, shape: Option<u32>, tree: &PartTree, facts: &PartFacts) -> bool {
        match (self, part) {
            (Row::Sun, Subject::Sun) | (Row::Sky, Subject::Sky) => true,
            (Row::Light(index), Subject::Light(name)) => tree.scene().light_name(*index) == *name,
            (Row::Material(index), Subject::Material(name)) => tree.scene().materials[*index].name == *name,
            (Row::Shape { index, .. }, Subject::Shape(_)) => shape == Some(*index),
            (Row::Shining(index), Subject::Shape(name)) => facts.scene().shape_name(*index as usize) == *name,
            _ => false,
        }
    }
}

/// The rows, and what they are of.
#[derive(Debug, Default)]
pub struct List {
    /// What is seen, from above.
    pub rows: Vec<Row>,
    /// What names have to hold.
    pub filter: String,
    /// Whether they have to be laid out anew.
    pub stale: bool,
    /// Branches that are unfolded, by their paths.
    open: HashSet<String>,
    /// Sections that are folded.
    folded: HashSet<Section>,
}

impl List {
    /// The same without its rows.
    pub fn forgotten(self) -> Self {
        List { rows: Vec::new(), stale: true, ..self }
    }

    /// Whether a section or a branch is unfolded; `None` of what cannot be.
    pub fn is_open(&self, row: Row, tree: &PartTree) -> Option<bool> {
        match row {
            Row::Section(section, _) => Some(!self.filter.is_empty() || !self.folded.contains(&section)),
            Row::Branch { index, .. } => Some(self.open.contains(&tree.branch(index).path)),
            _ => None,
        }
    }

    /// Folds what is unfolded, and the other way round.
    pub fn turn_over(&mut self, row: Row, tree: &PartTree) {
        match row {
            Row::Section(section, _) if !self.folded.remove(&section) => _ = self.folded.insert(section),
            Row::Branch { index, .. } => {
                let path = &tree.branch(index).path;
                if !self.open.remove(path) {
                    self.open.insert(path.clone());
                }
            }
            _ => {}
        }
        self.stale = true;
    }

    /// Unfolds all that a part is in.
    pub fn unfold(&mut self, part: &Subject, shape: Option<u32>, tree: &PartTree) {
        let section = match part {
            Subject::Material(_) => Section::Materials,
            Subject::Shape(_) => Section::Shapes,
            Subject::Light(_) | Subject::Sun | Subject::Sky => Section::Lights,
        };
        self.stale |= self.folded.remove(&section);
        for path in shape.map(|shape| tree.above(shape as usize)).unwrap_or_default() {
            self.stale |= self.open.insert(path.to_owned());
        }
    }

    /// Lays the rows out, if anything has changed.
    pub fn lay_out(&mut self, tree: &PartTree, facts: &PartFacts) {
        if !std::mem::take(&mut self.stale) {
            return;
        }
        let scene = tree.scene();
        let named = |name: &str| is_in(self.filter.trim(), name);
        let mut rows = Vec::new();
        let mut section = |section: Section, list: Vec<Row>| {
            if !list.is_empty() {
                rows.push(Row::Section(section, list.len()));
                let open = !self.filter.is_empty() || !self.folded.contains(&section);
                rows.extend(list.into_iter().filter(|_| open));
            }
        };
        let cameras = (0..scene.cameras.len()).filter(|index| named(&scene.cameras[*index].name)).map(Row::Camera);
        section(Section::Cameras, cameras.collect());
        section(Section::Lights, lights(scene, facts, named));
        let shapes = match self.filter.trim() {
            "" => self.below(tree),
            text => found(tree, text),
        };
        section(Section::Shapes, shapes);
        let materials = (0..scene.materials.len()).filter(|index| named(&scene.materials[*index].name));
        section(Section::Materials, materials.map(Row::Material).collect());
        let variants = (0..scene.variants.len()).filter(|index| named(&scene.variants[*index].name));
        let usual = (!scene.variants.is_empty() && named(USUAL)).then_some(Row::Variant(None));
        section(Section::Variants, usual.into_iter().chain(variants.map(|index| Row::Variant(Some(index)))).collect());
        // of shapes the title tells all of them, however they are folded
        for row in &mut rows {
            if let (Row::Section(Section::Shapes, count), true) = (row, self.filter.is_empty()) {
                *count = tree.root().shapes;
            }
        }
        self.rows = rows;
    }

    /// The shapes by their branches, as far as these are unfolded.
    fn below(&self, tree: &PartTree) -> Vec<Row> {
        let mut rows = Vec::new();
        // what is still to come, the next one last
        let mut waiting: Vec<(&[PartChild], usize)> = vec![(&tree.root().children, 0)];
        while let Some((children, depth)) = waiting.pop() {
            let Some((first, rest)) = children.split_first() else { continue };
            waiting.push((rest, depth));
            match *first {
                PartChild::Shape { index, label_at } => rows.push(Row::Shape { index, label_at, depth }),
                PartChild::Branch(index) => {
                    rows.push(Row::Branch { index, depth });
                    let branch = tree.branch(index);
                    if self.open.contains(&branch.path) {
                        waiting.push((&branch.children, depth + 1));
                    }
                }
            }
        }
        rows
    }
}

/// What the variant is called that a file shows where none is chosen.
pub const USUAL: &str = "usual";

fn lights(scene: &Scene, facts: &PartFacts, named: impl Fn(&str) -> bool) -> Vec<Row> {
    let sun = scene.sun.filter(|_| named("sun")).map(|_| Row::Sun);
    let sky = named("sky").then_some(Row::Sky);
    let points = (0..scene.point_lights.len()).filter(|index| named(&scene.light_name(*index))).map(Row::Light);
    let seen = facts.scene();
    let shining = facts.shining.iter().filter(|index| named(&seen.shape_name(**index as usize)));
    sun.into_iter().chain(sky).chain(points).chain(shining.map(|index| Row::Shining(*index))).collect()
}

/// Shapes by their whole names.
fn found(tree: &PartTree, text: &str) -> Vec<Row> {
    let shapes = tree.shapes_called(text, MOST_FOUND).into_iter();
    shapes.map(|index| Row::Shape { index, label_at: 0, depth: 0 }).collect()
}
