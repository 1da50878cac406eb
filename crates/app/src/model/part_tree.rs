//! The shapes of a scene as a tree: `/` in their names parts branches.

use scene::Scene;
use std::collections::HashMap;
use std::sync::Arc;

/// Branches are at most so deep; what is below stays in the name of the shape.
const DEEPEST: usize = 16;

/// The shapes of a scene by their names. It takes time for each shape, so that it is made once for a scene.
#[derive(Debug, Clone)]
pub struct PartTree {
    scene: Arc<Scene>,
    /// The first one is the root.
    branches: Vec<Branch>,
}

/// Shapes whose names begin alike.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Branch {
    /// What it is called below the branch that it is in.
    pub label: String,
    /// How the names of all its shapes begin, without the last `/`.
    pub path: String,
    /// What is in it, in the order of the scene.
    pub children: Vec<PartChild>,
    /// How many shapes are in it, at whatever depth.
    pub shapes: usize,
}

/// What is in a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartChild {
    /// The branch of this index.
    Branch(u32),
    /// The shape of this index in the scene.
    Shape {
        /// The index of a shape in its scene's list.
        index: u32,
        /// Where in its name begins what it is called here, in bytes.
        label_at: u32,
    },
}

impl PartTree {
    /// The tree of this scene.
    pub fn new(scene: Arc<Scene>) -> Self {
        let mut tree = PartTree { scene: scene.clone(), branches: vec![Branch::default()] };
        let mut known: HashMap<String, u32> = HashMap::new();
        let mut last = (String::new(), 0);
        for index in 0..scene.shapes.len() {
            // those that have no name are called by their place, without branches
            let name = scene.names.shapes.get(index).map_or("", String::as_str);
            let ends = name.match_indices('/').map(|(at, _)| at).take(DEEPEST);
            let path = ends.last().map_or("", |end| &name[..end]);
            if path != last.0 {
                last = (path.to_owned(), tree.branch_at(path, &mut known));
            }
            let label_at = if path.is_empty() { 0 } else { path.len() + 1 };
            let child = PartChild::Shape { index: index as u32, label_at: label_at as u32 };
            tree.branches[last.1 as usize].children.push(child);
        }
        tree.count();
        tree.shorten();
        tree
    }

    /// The branch of this path, which is made if there is none.
    fn branch_at(&mut self, path: &str, known: &mut HashMap<String, u32>) -> u32 {
        if path.is_empty() {
            return 0;
        }
        if let Some(found) = known.get(path) {
            return *found;
        }
        let (above, label) = path.rsplit_once('/').unwrap_or(("", path));
        let parent = self.branch_at(above, known);
        let branch = self.branches.len() as u32;
        self.branches.push(Branch { label: label.into(), path: path.into(), ..Branch::default() });
        self.branches[parent as usize].children.push(PartChild::Branch(branch));
        known.insert(path.to_owned(), branch);
        branch
    }

    /// Counts the shapes of all branches; those of a branch come behind it.
    fn count(&mut self) {
        for branch in (0..self.branches.len()).rev() {
            let count = |child: &PartChild| match child {
                PartChild::Branch(below) => self.branches[*below as usize].shapes,
                PartChild::Shape { .. } => 1,
            };
            self.branches[branch].shapes = self.branches[branch].children.iter().map(count).sum();
        }
    }

    /// A branch with nothing in it but one thing is no branch: that takes both names.
    fn shorten(&mut self) {
        for branch in (0..self.branches.len()).rev() {
            for child in 0..self.branches[branch].children.len() {
                let PartChild::Branch(below) = self.branches[branch].children[child] else { continue };
                let Branch { label, children, .. } = &self.branches[below as usize];
                let only = match children[..] {
                    [only] => only,
                    _ => continue,
                };
                let label = label.clone();
                self.branches[branch].children[child] = match only {
                    PartChild::Branch(last) => {
                        let last_label = &mut self.branches[last as usize].label;
                        *last_label = format!("{label}/{last_label}");
                        only
                    }
                    PartChild::Shape { index, label_at } => {
                        PartChild::Shape { index, label_at: label_at - label.len() as u32 - 1 }
                    }
                };
            }
        }
    }

    /// The scene that it is of.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// All that is in no branch, and the branches above all others.
    pub fn root(&self) -> &Branch {
        &self.branches[0]
    }

    /// The branch of a [`PartChild::Branch`].
    pub fn branch(&self, index: u32) -> &Branch {
        &self.branches[index as usize]
    }

    /// The branches that a shape is in, from the root down, by their paths.
    pub fn above(&self, shape: usize) -> Vec<&str> {
        let name = self.scene.shape_name(shape);
        let mut paths = Vec::new();
        let mut here = self.root();
        while let Some(next) = here.children.iter().find_map(|child| self.holds(child, &name)) {
            paths.push(next.path.as_str());
            here = next;
        }
        paths
    }

    fn holds(&self, child: &PartChild, name: &str) -> Option<&Branch> {
        let PartChild::Branch(index) = child else { return None };
        let branch = self.branch(*index);
        name.strip_prefix(&branch.path)?.starts_with('/').then_some(branch)
    }

    /// The first `most` shapes whose names hold `text`, in whatever case.
    pub fn shapes_called(&self, text: &str, most: usize) -> Vec<u32> {
        let holds = |index: &u32| is_in(text, &self.scene.shape_name(*index as usize));
        (0..self.scene.shapes.len() as u32).filter(holds).take(most).collect()
    }
}

/// Whether `text` is in a name, in whatever case.
pub fn is_in(text: &str, name: &str) -> bool {
    if !(text.is_ascii() && name.is_ascii()) {
        return name.to_lowercase().contains(&text.to_lowercase());
    }
    text.is_empty() || name.as_bytes().windows(text.len()).any(|part| part.eq_ignore_ascii_case(text.as_bytes()))
}

/// What is counted of a scene with its changes.
#[derive(Debug, Clone)]
pub struct PartFacts {
    scene: Arc<Scene>,
    /// How many shapes wear each material.
    pub wearers: Vec<u32>,
    /// The shapes that shine.
    pub shining: Vec<u32>,
}

impl PartFacts {
    /// Facts of this scene, counted once.
    pub fn new(scene: Arc<Scene>) -> Self {
        let mut wearers = vec![0; scene.materials.len()];
        scene.shapes.iter().for_each(|shape| wearers[shape.material] += 1);
        let shines = |index: &u32| scene.material_of(&scene.shapes[*index as usize]).shines();
        let shining = (0..scene.shapes.len() as u32).filter(shines).collect();
        PartFacts { scene, wearers, shining }
    }

    /// The scene that they are of.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Names;

    /// A scene of so many balls, which are called so.
    fn tree(names: &[&str]) -> PartTree {
        let mut scene = scene::builtin::named("whitted").unwrap();
        let ball = scene.shapes.iter().find(|shape| shape.geometry.kind() == "sphere").unwrap().clone();
        scene.shapes = vec![ball; names.len()].into();
        scene.names = Arc::new(Names::new(names.iter().map(|name| (*name).into()).collect(), Vec::new()));
        PartTree::new(Arc::new(scene))
    }

    /// "label(children ...)", as it is nested.
    fn drawn(tree: &PartTree, branch: &Branch) -> String {
        let child = |child: &PartChild| match child {
            PartChild::Branch(index) => {
                let branch = tree.branch(*index);
                format!("{}{}({})", branch.label, branch.shapes, drawn(tree, branch))
            }
            PartChild::Shape { index, label_at } => {
                tree.scene.shape_name(*index as usize)[*label_at as usize..].to_owned()
            }
        };
        branch.children.iter().map(child).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn names_part_at_slashes_and_a_branch_of_one_is_none() {
        let tree =
            tree(&["floor", "car/body", "car/wheel/rim", "car/wheel/tyre", "lamp/bulb", "a/b/c", "a/b/d", "car"]);
        assert_eq!(drawn(&tree, tree.root()), "floor car3(body wheel2(rim tyre)) lamp/bulb a/b2(c d) car");
        assert_eq!(tree.above(3), ["car", "car/wheel"]);
        assert_eq!(tree.above(5), ["a/b"]);
        assert_eq!([0, 4, 7].map(|shape| tree.above(shape).len()), [0; 3]);
        assert_eq!(tree.shapes_called("WHEEL", 9), [2, 3]);
        assert_eq!(tree.shapes_called("", 2), [0, 1]);
    }

    #[test]
    fn names_full_of_slashes_are_not_as_deep_as_they_say() {
        let deep = "x/".repeat(100_000);
        let names = [deep.as_str(), "/", "//a", "//b"];
        let tree = tree(&names);
        assert!(tree.branches.len() < 3 * DEEPEST);
        assert_eq!(tree.root().shapes, 4);
        (0..4).for_each(|shape| assert!(tree.above(shape).len() <= DEEPEST));
    }

    #[test]
    fn a_million_shapes_are_a_tree() {
        let mut scene = scene::builtin::named("whitted").unwrap();
        let ball = scene.shapes[0].clone();
        scene.shapes = vec![ball; 1 << 20].into();
        let names =
            (0..1 << 20).map(|index| format!("wood {}/tree {}/leaf {index}", index >> 14, index >> 8)).collect();
        scene.names = Arc::new(Names { shapes: names, lights: Vec::new() });
        let tree = PartTree::new(Arc::new(scene));
        assert_eq!((tree.root().children.len(), tree.root().shapes), (64, 1 << 20));
        assert_eq!(tree.above(1 << 19), ["wood 32", "wood 32/tree 2048"]);
        assert_eq!(tree.shapes_called("leaf 1048575", 9), [(1 << 20) - 1]);
        let facts = PartFacts::new(tree.scene().clone());
        assert_eq!(facts.wearers.iter().sum::<u32>(), 1 << 20);
    }
}
