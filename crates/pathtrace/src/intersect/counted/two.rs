//! A binary tree as a course builds it first: at each node two boxes, the nearer one before the other.

use super::{CountedHit, Tests, entry, levels, test};
use crate::intersect::Ray;
use crate::intersect::triangle::ShearedRay;
use obvhs::Boundable;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use scene::glam::Vec3A;
use scene::{Mesh, Vec3};
use std::time::Duration;

/// Boxes in pairs, and the triangles in the order of the leaves.
pub struct TwoBoxes {
    tree: Bvh2,
    triangles: Vec<[u32; 3]>,
    depth: u32,
}

struct Corners([Vec3; 3], Vec3);

impl Boundable for Corners {
    fn aabb(&self) -> Aabb {
        let Corners([a, b, c], padding) = self;
        Aabb::new(Vec3A::from(a.min(*b).min(*c) - padding), Vec3A::from(a.max(*b).max(*c) + padding))
    }
}

impl TwoBoxes {
    /// Of all triangles, one or a few a leaf.
    pub fn new(mesh: &Mesh) -> Self {
        let (lo, hi) = mesh.bounds();
        // for the rounding of the box test, as pictures' trees have it
        let padding = Vec3::splat((lo.abs().max(hi.abs()).max_element() + (hi - lo).max_element()) / 1_048_576.0);
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| mesh.positions()[corner as usize]);
        let boxes: Vec<Corners> = mesh.triangles().iter().map(|triangle| Corners(corners(triangle), padding)).collect();
        let mut took = Duration::ZERO;
        let tree = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut took);
        let triangles = tree.primitive_indices.iter().map(|&index| mesh.triangles()[index as usize]).collect();
        let depth = depth_of(&tree);
        TwoBoxes { tree, triangles, depth }
    }

    pub fn closest(&self, mesh: &Mesh, ray: &Ray, tests: &mut Tests) -> Option<CountedHit> {
        let root = self.tree.nodes.first()?;
        let sheared = ShearedRay::new(ray);
        let inverse = ray.direction.map(|d| 1.0 / if d.abs() < 1e-25 { 1e-25 } else { d });
        let (mut nearest, mut tmax) = (None, ray.tmax);
        let mut later: Vec<(f32, u32)> = Vec::with_capacity(64);
        let mut here = *root;
        tests.boxes += 1;
        entry(&here.aabb, ray, inverse, tmax)?;
        loop {
            if here.prim_count > 0 {
                let first = here.first_index as usize;
                for triangle in &self.triangles[first..first + here.prim_count as usize] {
                    test(mesh, *triangle, &sheared, &mut nearest, &mut tmax);
                }
                tests.triangles += u64::from(here.prim_count);
            } else {
                tests.boxes += 2;
                let children = [here.first_index, here.first_index + 1];
                let met = children.map(|child| entry(&self.tree.nodes[child as usize].aabb, ray, inverse, tmax));
                let [near, far] = match met {
                    [Some(a), Some(b)] if b < a => [Some((b, children[1])), Some((a, children[0]))],
                    [a, b] => [a.map(|t| (t, children[0])), b.map(|t| (t, children[1]))],
                };
                later.extend(far);
                later.extend(near);
            }
            here = loop {
                let Some((t, child)) = later.pop() else { return nearest };
                if t <= tmax {
                    break self.tree.nodes[child as usize];
                }
            };
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.tree.nodes)
    }

    pub fn depth(&self) -> u32 {
        self.depth
    }

    pub fn boxes_at(&self, depth: u32, most: usize) -> (u32, Vec<(Vec3, Vec3)>) {
        let Some(root) = self.tree.nodes.first() else { return (0, Vec::new()) };
        let (depth, nodes) = levels(root, depth, most, |node| self.children(node));
        (depth, nodes.into_iter().map(|node| (node.aabb.min.into(), node.aabb.max.into())).collect())
    }

    fn children<'a>(&'a self, node: &'a Bvh2Node) -> Vec<&'a Bvh2Node> {
        if node.prim_count > 0 {
            return vec![node];
        }
        let first = node.first_index as usize;
        self.tree.nodes[first..first + 2].iter().collect()
    }
}

fn depth_of(tree: &Bvh2) -> u32 {
    let (mut deepest, mut later) = (0, vec![(0, 0)]);
    while let Some((index, depth)) = later.pop() {
        let Some(node) = tree.nodes.get(index) else { continue };
        deepest = deepest.max(depth);
        if node.prim_count == 0 {
            let first = node.first_index as usize;
            later.extend([(first, depth + 1), (first + 1, depth + 1)]);
        }
    }
    deepest
}
