//! The tree of nodes: where each stands in the world (glTF 2.0, section 3.5).

use super::buffers::Document;
use super::json::Node;
use super::{Refused, Remarks, named};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A node of the scene that is shown.
pub struct Placed<'a> {
    pub node: &'a Node,
    pub index: u32,
    /// The node that it is below, by its place among those that are shown.
    pub parent: Option<usize>,
    /// From its own space to the world's.
    pub to_world: DAffine3,
}

impl Placed<'_> {
    pub fn name(&self) -> String {
        named("node", self.index, self.node.name.as_deref())
    }
}

/// The nodes of the scene that the file shows first, parents before their children. However deep, with a stack of its own.
pub fn placed<'a>(document: &'a Document, remarks: &mut Remarks) -> Result<Vec<Placed<'a>>, Refused> {
    let nodes = &document.root.nodes;
    // of a tree each node is named once at most: else no memory is taken for all that is named
    let named_ones: usize = nodes.iter().map(|node| node.children.len()).sum();
    if named_ones > nodes.len() {
        return Err(Refused(format!(
            "{} nodes are named as children {named_ones} times: nodes must be a tree",
            nodes.len()
        )));
    }
    let mut seen = vec![false; nodes.len()];
    let mut found: Vec<Placed> = Vec::new();
    let mut open: Vec<(u32, Option<usize>)> = roots(document, remarks)?.into_iter().map(|i| (i, None)).collect();
    open.reverse();
    while let Some((index, parent)) = open.pop() {
        let Some(node) = nodes.get(index as usize) else {
            return Err(Refused(format!("node {index} is named, but there are {}", nodes.len())));
        };
        if std::mem::replace(&mut seen[index as usize], true) {
            let name = named("node", index, node.name.as_deref());
            return Err(Refused(format!("{name} has two parents, or is below itself: nodes must be a tree")));
        }
        let place_of_parent = parent.map_or(DAffine3::IDENTITY, |parent| found[parent].to_world);
        let placed = Placed { node, index, parent, to_world: place_of_parent * own_place(node) };
        let finite = placed.to_world.is_finite();
        if !finite {
            return Err(Refused(format!("{}: its place is not finite", placed.name())));
        }
        open.extend(node.children.iter().rev().map(|child| (*child, Some(found.len()))));
        found.push(placed);
    }
    // without scenes every node is below one that has no parent, or below itself
    let lost = seen.iter().position(|seen| !seen).filter(|_| document.root.scenes.is_empty());
    if let Some(index) = lost {
        let name = named("node", index as u32, nodes[index].name.as_deref());
        return Err(Refused(format!("{name} is below itself, or below such a node: nodes must be a tree")));
    }
    Ok(found)
}

/// The nodes that the first scene begins with; of a file without scenes those that have no parent.
fn roots(document: &Document, remarks: &mut Remarks) -> Result<Vec<u32>, Refused> {
    let (nodes, scenes) = (&document.root.nodes, &document.root.scenes);
    if scenes.len() > 1 {
        remarks.add("it has further scenes, which are not shown");
    }
    let first = document.root.scene.unwrap_or(0);
    if let Some(scene) = scenes.get(first as usize) {
        if scene.nodes.len() > nodes.len() {
            return Err(Refused(format!("scene {first} begins with more nodes than there are: nodes must be a tree")));
        }
        return Ok(scene.nodes.clone());
    }
    if document.root.scene.is_some() {
        return Err(Refused(format!("scene {first} is to be shown, but there are {}", scenes.len())));
    }
    let mut is_child = vec![false; nodes.len()];
    for child in nodes.iter().flat_map(|node| &node.children) {
        if let Some(is_child) = is_child.get_mut(*child as usize) {
            *is_child = true;
        }
    }
    Ok((0..nodes.len() as u32).filter(|index| !is_child[*index as usize]).collect())
}

/// Of a node in its parent's space.
fn own_place(node: &Node) -> DAffine3 {
    if let Some(m) = node.matrix {
        let column = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
        let matrix3 = DMat3::from_cols(column(0), column(1), column(2));
        return DAffine3 { matrix3, translation: column(3) };
    }
    let turn = node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    // exporters round: a turn of length 0.9999 would squeeze; and one of length 0 is none
    let turn = if turn.length_squared() > 0.0 { turn.normalize() } else { DQuat::IDENTITY };
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from);
    DAffine3::from_scale_rotation_translation(scale, turn, node.translation.map_or(DVec3::ZERO, DVec3::from))
}
