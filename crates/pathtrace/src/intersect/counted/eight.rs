//! The tree of a large mesh, walked plainly: at each node up to eight boxes, the nearest first.

use super::{CountedHit, Tests, entry, levels, test};
use crate::intersect::Ray;
use crate::intersect::mesh_tree::MeshTree;
use crate::intersect::triangle::ShearedRay;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::node::CwBvhNode;
use scene::Vec3;

/// A child of a node.
#[derive(Clone, Copy)]
enum Child {
    Node(usize),
    Triangles { first: usize, count: usize },
}

/// The children that a node has, with their boxes.
fn children(node: &CwBvhNode) -> impl Iterator<Item = (Aabb, Child)> + '_ {
    (0..8).filter(|&slot| !node.is_child_empty(slot)).map(|slot| {
        let child = if node.is_leaf(slot) {
            let (first, count) = node.child_primitives(slot);
            Child::Triangles { first: first as usize, count: count as usize }
        } else {
            Child::Node(node.child_node_index(slot) as usize)
        };
        (node.child_aabb(slot), child)
    })
}

pub fn closest(tree: &MeshTree, ray: &Ray, tests: &mut Tests) -> Option<CountedHit> {
    let sheared = ShearedRay::new(ray);
    let inverse = ray.direction.map(|d| 1.0 / if d.abs() < 1e-25 { 1e-25 } else { d });
    let (mut nearest, mut tmax) = (None, ray.tmax);
    let mut later = vec![(0.0, Child::Node(0))];
    while let Some((entered, child)) = later.pop() {
        if entered > tmax {
            continue;
        }
        match child {
            Child::Triangles { first, count } => {
                for triangle in &tree.triangles[first..first + count] {
                    test(&tree.mesh, *triangle, &sheared, &mut nearest, &mut tmax);
                }
                tests.triangles += count as u64;
            }
            Child::Node(index) => {
                let Some(node) = tree.nodes.get(index) else { continue };
                let below = later.len();
                for (bounds, child) in children(node) {
                    tests.boxes += 1;
                    later.extend(entry(&bounds, ray, inverse, tmax).map(|t| (t, child)));
                }
                later[below..].sort_by(|a, b| b.0.total_cmp(&a.0));
            }
        }
    }
    nearest
}

pub fn boxes_at(tree: &MeshTree, depth: u32, most: usize) -> (u32, Vec<(Vec3, Vec3)>) {
    let Some(root) = tree.nodes.first() else { return (0, Vec::new()) };
    let root = (root.aabb(), Child::Node(0));
    let (depth, level) = levels(root, depth, most, |(bounds, child)| below(tree, bounds, child));
    (depth, level.into_iter().map(|(bounds, _)| (bounds.min.into(), bounds.max.into())).collect())
}

fn below(tree: &MeshTree, bounds: Aabb, child: Child) -> Vec<(Aabb, Child)> {
    match child {
        Child::Node(index) => children(&tree.nodes[index]).collect(),
        Child::Triangles { .. } => vec![(bounds, child)],
    }
}

/// Steps from the root to the deepest leaf.
pub fn depth(tree: &MeshTree) -> u32 {
    let (mut deepest, mut later) = (0, vec![(0, 0)]);
    while let Some((index, depth)) = later.pop() {
        let Some(node) = tree.nodes.get(index) else { continue };
        for (_, child) in children(node) {
            deepest = deepest.max(depth + 1);
            if let Child::Node(index) = child {
                later.push((index, depth + 1));
            }
        }
    }
    deepest
}
