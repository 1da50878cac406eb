//! A mesh's tree as the processor goes through it faster where there is memory for it: the same nodes and leaves, with
//! the planes of boxes as floats and the corners of triangles side by side in blocks of a [`Bvh8`], so that nothing is
//! decoded, and looked up by index, on a ray's way.
//!
//! Triangles keep the order of their corners and their places in the tree's order: what a ray meets, at which distance
//! and with which weights, is by every bit what [`super::mesh_walk`] finds.

use super::bvh8::{Blocks, Bvh8, Child, Leaf, Node};
use super::coincident::Groups;
use super::mesh_tree::MeshTree;
use super::mesh_walk::{child, leaf};
use super::primitive::Surface;
use super::{Hit, NO_INSTANCE, NO_LIGHT, Ray};
use obvhs::aabb::Aabb;
use obvhs::cwbvh::node::CwBvhNode;
use scene::Vec3;
use scene::glam::Vec3A;
use simd::{Lanes, RowLanes};

/// Most triangles of all meshes of a scene together that are unpacked: they take about 200 bytes each.
pub const MOST_UNPACKED: usize = 1 << 20;

/// Blocks of nodes, then of leaves.
pub struct Unpacked(Bvh8);

impl Unpacked {
    /// Of a tree that is there.
    pub fn of(tree: &MeshTree) -> Self {
        let leaves = tree.nodes.iter().map(|node| children(node).filter(|(_, child)| child.is_leaf()).count());
        let nodes = tree.nodes.len();
        let mut blocks = Blocks::zeroed(nodes + leaves.sum::<usize>());
        let (to_nodes, to_leaves) = blocks.all_mut().split_at_mut(nodes);
        let mut next = 0;
        for (node, block) in tree.nodes.iter().zip(to_nodes) {
            *block = Node::EMPTY;
            for (slot, packed) in children(node) {
                let mut here = packed;
                if packed.is_leaf() {
                    fill(&mut to_leaves[next], tree, packed);
                    here = Child::triangles(nodes + next);
                    next += 1;
                }
                Node::set_child(block, slot, &bounds(node, slot), here);
            }
        }
        let lanes = RowLanes::nearest_to(Lanes::best());
        Unpacked(Bvh8 {
            root: Child::ROOT,
            blocks,
            curved: Vec::new(),
            groups: Groups::default(),
            cutouts: None,
            lanes,
        })
    }

    /// The nearest hit before `ray.tmax`, whose primitive is the triangle's place in the tree's order.
    #[inline(always)]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        // a hit at the end itself is beyond it
        let nearest = self.0.nearest(&Ray { tmax: ray.tmax.next_down(), ..*ray });
        let [u, v, w] = nearest.areas;
        let sum = u + v + w;
        let hit = Hit {
            t: nearest.t,
            primitive: nearest.id,
            instance: NO_INSTANCE,
            barycentrics: [u / sum, v / sum, w / sum],
        };
        nearest.child.is_leaf().then_some(hit)
    }

    /// Whether any triangle lies on the ray before `ray.tmax`.
    #[inline(always)]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded_by(ray, |_| true)
    }

    /// Bytes that it takes beside the tree.
    pub fn bytes(&self) -> usize {
        size_of_val(self.0.blocks.all())
    }
}

/// A node's children with their slots.
fn children(node: &CwBvhNode) -> impl Iterator<Item = (usize, Child)> + '_ {
    (0..8).filter(|slot| !node.is_child_empty(*slot)).map(|slot| (slot, child(node, slot)))
}

/// A child's box, its planes rounded away from what is inside.
fn bounds(node: &CwBvhNode, slot: usize) -> Aabb {
    let corner = node.p.to_array();
    let lows = [node.child_min_x[slot], node.child_min_y[slot], node.child_min_z[slot]];
    let highs = [node.child_max_x[slot], node.child_max_y[slot], node.child_max_z[slot]];
    let plane = |axis: usize, steps: u8| {
        let step = f64::from(f32::from_bits(u32::from(node.e[axis]) << 23));
        f64::from(corner[axis]) + f64::from(steps) * step
    };
    let below = |exact: f64| if f64::from(exact as f32) > exact { (exact as f32).next_down() } else { exact as f32 };
    let low = Vec3::from([0, 1, 2].map(|axis| below(plane(axis, lows[axis]))));
    let high = Vec3::from([0, 1, 2].map(|axis| -below(-plane(axis, highs[axis]))));
    Aabb::new(Vec3A::from(low), Vec3A::from(high))
}

/// A leaf's triangles, each with its place in the tree's order.
fn fill(block: &mut super::bvh8::Block, tree: &MeshTree, packed: Child) {
    // what a hit's attributes are mixed from is looked up for the one that is left
    let surface = Surface { normal: Vec3::ZERO, material: 0, light: NO_LIGHT };
    let (first, count) = leaf(packed);
    for lane in 0..count {
        let corners = tree.triangles[first + lane].map(|corner| tree.mesh.positions()[corner as usize]);
        Leaf::set_triangle(block, lane, corners, (first + lane) as u32, &surface);
    }
}
