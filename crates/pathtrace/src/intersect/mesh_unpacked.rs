//! A mesh's tree as the processor goes through it faster where there is memory for it: a [`Bvh8`], so that nothing is
//! decoded, and looked up by index, on a ray's way.
//!
//! Leaves of the compressed tree name up to three triangles and seldom have so many, those of a [`Bvh8`] hold four side by
//! side. So of the compressed nodes only what lies below which is taken: boxes are made anew from the triangles, children
//! are joined by two into a binary hierarchy with as many in a leaf as fit, and [`super::bvh8_collapse`] says which of its
//! nodes to keep, as it does for small shapes.
//!
//! Triangles keep the order of their corners and their places in the tree's order, by which of several at one distance the
//! first is met. Boxes of neither tree leave out what a ray meets: what it meets, at which distance and with which
//! weights, is by every bit what [`super::mesh_walk`] finds.

use super::bvh8::{Bvh8, Child, LEAF_WIDTH};
use super::bvh8_build::furnished;
use super::bvh8_collapse::{Forest, Place, Shapes, Tree};
use super::mesh_build::padding;
use super::mesh_tree::MeshTree;
use super::mesh_walk::{child, leaf};
use super::primitive::{Primitive, Surface};
use super::triangle::Triangle;
use super::{Hit, NO_LIGHT, Ray};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::cwbvh::node::CwBvhNode;
use rayon::prelude::*;
use scene::Vec3;
use scene::glam::Vec3A;
use simd::{Lanes, RowLanes};

/// Most triangles of all meshes of a scene together that are unpacked. They take 99 bytes each, 208 MB in all, and half as
/// much again while they are made: beyond that, memory is worth more than the third that rays gain.
pub const MOST_UNPACKED: usize = 1 << 21;

/// Most triangles of a part that is planned, and put into blocks, by one thread.
const PART: usize = 8192;

/// Triangles by their places in the tree's order.
pub struct Unpacked(Bvh8);

impl Unpacked {
    /// Of a tree that is there, on all threads; `None` if it has no triangles or would be deeper than a walk can be.
    pub fn of(tree: &MeshTree) -> Option<Self> {
        let triangles = Triangles { tree, padding: padding(&tree.mesh) };
        let sizes = sizes(&tree.nodes);
        let is_part = |child: Child| child.is_leaf() || sizes[child.index()] <= PART;
        let mut roots = Vec::new();
        add_parts(&tree.nodes, Child::ROOT, &is_part, &mut roots);
        let of_part = |root: &Child| {
            let ends = |child: Child| child.is_leaf().then(|| triangles.in_leaf(child));
            Some(Tree::of_shapes(Joiner::run(&tree.nodes, *root, LEAF_WIDTH, ends)?, triangles))
        };
        let mut trees = roots.par_iter().map(of_part).collect::<Option<Vec<Tree>>>()?;
        let mut ends = Vec::new();
        if trees.len() > 1 {
            // the same way down as that of `add_parts`
            let next = |child: Child| {
                let part = is_part(child).then_some(ends.len())?;
                ends.push(Place { tree: part, node: 0 });
                Some(vec![Root::leaf(*trees[part].node(0).aabb(), part as u32)])
            };
            let top = Joiner::run(&tree.nodes, Child::ROOT, 1, next)?;
            trees.push(Tree::of_trees(top, &ends, &trees));
        }
        let lanes = RowLanes::nearest_to(Lanes::best());
        furnished(&Forest { trees, ends, shapes: triangles }, lanes).map(Unpacked)
    }

    /// The nearest hit before `ray.tmax`, whose primitive only [`Unpacked::place`] and [`Unpacked::corners`] know.
    #[inline(always)]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        // a hit at the end itself is beyond it
        self.0.closest(&Ray { tmax: ray.tmax.next_down(), ..*ray })
    }

    /// The place in the tree's order of the triangle that was hit.
    pub fn place(&self, hit: &Hit) -> usize {
        self.0.id(hit) as usize
    }

    /// Its corners, which lie where the ray has just met them.
    pub fn corners(&self, hit: &Hit) -> [Vec3; 3] {
        self.0.corners(hit)
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

    /// How many nodes and leaves it has.
    #[cfg(test)]
    pub fn blocks(&self) -> [usize; 2] {
        let (mut open, mut nodes, mut leaves) = (vec![self.0.root], 0, 0);
        while let Some(child) = open.pop() {
            if child.is_leaf() {
                leaves += 1;
                continue;
            }
            nodes += 1;
            let node = super::bvh8::Node(&self.0.blocks.all()[child.index()]);
            open.extend((0..8).filter(|slot| node.bounds(0, 0)[*slot] < f32::INFINITY).map(|slot| node.child(slot)));
        }
        [nodes, leaves]
    }
}

/// The triangles of a tree, by their places in its order.
#[derive(Clone, Copy)]
struct Triangles<'a> {
    tree: &'a MeshTree,
    padding: Vec3,
}

impl Triangles<'_> {
    fn corners(&self, place: usize) -> [Vec3; 3] {
        self.tree.triangles[place].map(|corner| self.tree.mesh.positions()[corner as usize])
    }

    /// Those of a compressed leaf.
    fn in_leaf(&self, packed: Child) -> Vec<Root> {
        let (first, count) = leaf(packed);
        let root = |place: usize| {
            let [a, b, c] = self.corners(place);
            let (low, high) = (a.min(b).min(c) - self.padding, a.max(b).max(c) + self.padding);
            Root::leaf(Aabb::new(Vec3A::from(low), Vec3A::from(high)), place as u32)
        };
        (first..first + count).map(root).collect()
    }
}

impl Shapes for Triangles<'_> {
    fn primitive(&self, place: u32) -> Primitive {
        // unsorted, as the tree has them
        Primitive::Triangle(Triangle::sorted(self.corners(place as usize)))
    }

    fn surface(&self, _: u32) -> Surface {
        // what a hit's attributes are mixed from is looked up for the one that is left
        Surface { normal: Vec3::ZERO, material: 0, light: NO_LIGHT }
    }
}

/// What is in a node's boxes.
fn children(node: &CwBvhNode) -> impl Iterator<Item = Child> + '_ {
    (0..8).filter(|slot| !node.is_child_empty(*slot)).map(|slot| child(node, slot))
}

/// How many triangles lie below each node. Children lie behind their parents.
fn sizes(nodes: &[CwBvhNode]) -> Vec<usize> {
    let mut sizes = vec![0; nodes.len()];
    for (index, node) in nodes.iter().enumerate().rev() {
        let size = |child: Child| if child.is_leaf() { leaf(child).1 } else { sizes[child.index()] };
        sizes[index] = children(node).map(size).sum();
    }
    sizes
}

/// The topmost nodes and leaves below a child that are parts.
fn add_parts(nodes: &[CwBvhNode], below: Child, is_part: &impl Fn(Child) -> bool, parts: &mut Vec<Child>) {
    if is_part(below) {
        return parts.push(below);
    }
    for child in children(&nodes[below.index()]) {
        add_parts(nodes, child, is_part, parts);
    }
}

/// A binary hierarchy of what lies below a compressed child, in the making.
struct Joiner<'a, E> {
    nodes: &'a [CwBvhNode],
    /// What stands for a child that it goes no further from.
    ends: E,
    /// How much fits into one leaf.
    most_in_leaf: usize,
    binary: Bvh2,
}

/// What has no parent yet: a node, or a leaf of these.
struct Root {
    node: Bvh2Node,
    in_leaf: [u32; LEAF_WIDTH],
}

impl Root {
    fn leaf(bounds: Aabb, number: u32) -> Self {
        let mut in_leaf = [0; LEAF_WIDTH];
        in_leaf[0] = number;
        Root { node: Bvh2Node::new(bounds, 1, 0), in_leaf }
    }
}

impl<'a, E: FnMut(Child) -> Option<Vec<Root>>> Joiner<'a, E> {
    /// The binary tree below a child; `None` where there are no triangles.
    fn run(nodes: &'a [CwBvhNode], below: Child, most_in_leaf: usize, ends: E) -> Option<Bvh2> {
        let mut joiner = Joiner { nodes, ends, most_in_leaf, binary: Bvh2::default() };
        joiner.binary.nodes.push(Bvh2Node::default());
        let root = joiner.below(below)?;
        joiner.binary.nodes[0] = joiner.closed(root);
        Some(joiner.binary)
    }

    fn below(&mut self, child: Child) -> Option<Root> {
        let ends = (self.ends)(child);
        let roots = ends.unwrap_or_else(|| {
            let mut roots = Vec::with_capacity(24);
            for child in children(&self.nodes[child.index()]) {
                match (self.ends)(child) {
                    Some(ends) => roots.extend(ends),
                    None => roots.extend(self.below(child)),
                }
            }
            roots
        });
        self.joined(roots)
    }

    /// Joins two at a time, those whose box is smallest together, until one is left.
    fn joined(&mut self, mut roots: Vec<Root>) -> Option<Root> {
        while roots.len() > 1 {
            let mut least = (f32::INFINITY, 0, 1);
            for second in 1..roots.len() {
                for first in 0..second {
                    let area = roots[first].node.aabb().union(roots[second].node.aabb()).half_area();
                    if area < least.0 {
                        least = (area, first, second);
                    }
                }
            }
            // the second first: what takes its place is none of both
            let pair = [least.2, least.1].map(|index| roots.swap_remove(index));
            roots.push(self.both(pair));
        }
        roots.pop()
    }

    /// Puts two into one leaf if they fit, else above them a node.
    fn both(&mut self, [mut one, other]: [Root; 2]) -> Root {
        let bounds = one.node.aabb().union(other.node.aabb());
        let [count, more] = [&one, &other].map(|root| root.node.prim_count as usize);
        if count > 0 && more > 0 && count + more <= self.most_in_leaf {
            one.in_leaf[count..count + more].copy_from_slice(&other.in_leaf[..more]);
            one.node = Bvh2Node::new(bounds, (count + more) as u32, 0);
            return one;
        }
        let node = Bvh2Node::new(bounds, 0, self.binary.nodes.len() as u32);
        let pair = [self.closed(one), self.closed(other)];
        self.binary.nodes.extend(pair);
        Root { node, in_leaf: [0; LEAF_WIDTH] }
    }

    /// As the child of another.
    fn closed(&mut self, Root { mut node, in_leaf }: Root) -> Bvh2Node {
        if node.is_leaf() {
            node.first_index = self.binary.primitive_indices.len() as u32;
            self.binary.primitive_indices.extend(&in_leaf[..node.prim_count as usize]);
        }
        node
    }
}
