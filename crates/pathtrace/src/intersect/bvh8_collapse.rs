//! From two children a node to eight: which nodes of binary hierarchies to keep.
//!
//! Subtrees of up to four triangles become leaves. Of the nodes above them those are kept that make the sum of their
//! areas least, by dynamic programming from the leaves up: Ylitie, Karras and Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs" (HPG 2017), section 3.1, with leaves of a given size.

use super::bvh8::{Block, Child, Curved, LEAF_WIDTH, Leaf, Node};
use super::primitive::{Primitive, Surface};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;

/// Children of a node.
const WIDTH: usize = 8;

/// What the hierarchies' leaves refer to, by number.
pub(super) trait Shapes: Copy + Sync {
    /// What rays are held against.
    fn primitive(&self, shape: u32) -> Primitive;
    /// What shading asks of it.
    fn surface(&self, shape: u32) -> Surface;
}

/// Shapes in lists, by their places.
#[derive(Clone, Copy)]
pub(super) struct Listed<'a> {
    pub primitives: &'a [Primitive],
    pub surfaces: &'a [Surface],
}

impl Shapes for Listed<'_> {
    fn primitive(&self, shape: u32) -> Primitive {
        self.primitives[shape as usize]
    }

    fn surface(&self, shape: u32) -> Surface {
        self.surfaces[shape as usize]
    }
}

/// How best to represent a subtree by several nodes and leaves.
#[derive(Clone, Copy, Default)]
pub(super) struct Plan {
    /// The least area of nodes, where at most as many roots as the index are allowed; leaves cost nothing.
    cost: [f32; WIDTH],
    /// For as many children or roots as the index, how many of them to give to the left subtree; 0 for one root fewer.
    left: [u8; WIDTH + 1],
}

impl Plan {
    /// The plan of a node of this area over two subtrees.
    fn above(area: f32, left: &Plan, right: &Plan) -> Self {
        let mut plan = Plan::default();
        let mut of_children = [f32::INFINITY; WIDTH + 1];
        for (count, least) in of_children.iter_mut().enumerate().skip(2) {
            for of_left in 1..count {
                let cost = left.cost[of_left] + right.cost[count - of_left];
                if cost < *least {
                    *least = cost;
                    plan.left[count] = of_left as u8;
                }
            }
        }
        plan.cost[1] = area + of_children[WIDTH];
        for (count, &cost) in of_children.iter().enumerate().take(WIDTH).skip(2) {
            let with_fewer = plan.cost[count - 1];
            if with_fewer <= cost {
                plan.left[count] = 0;
            }
            plan.cost[count] = cost.min(with_fewer);
        }
        plan
    }
}

/// A binary hierarchy and what is to become of its subtrees.
pub(super) struct Tree {
    bvh: Bvh2,
    /// Triangles below a node. A shape that is round counts as too many for a leaf of triangles.
    sizes: Vec<u32>,
    plans: Vec<Plan>,
}

impl Tree {
    /// A tree of shapes, each in a leaf whose `first_index` it is.
    pub fn of_shapes(bvh: Bvh2, shapes: impl Shapes) -> Self {
        let size = |shape: u32| match shapes.primitive(shape) {
            Primitive::Triangle(_) => 1,
            Primitive::Sphere(_) | Primitive::Disk(_) => LEAF_WIDTH as u32 + 1,
        };
        Self::planned(bvh, LEAF_WIDTH as u32, |shape| (size(shape), Plan::default()))
    }

    /// A tree over subtrees of others.
    pub fn of_trees(bvh: Bvh2, ends: &[Place], trees: &[Tree]) -> Self {
        Self::planned(bvh, 0, |end| {
            let Place { tree, node } = ends[end as usize];
            (trees[tree].sizes[node], trees[tree].plans[node])
        })
    }

    /// Plans all subtrees of more triangles than `leaf_size`, children before their parents.
    fn planned(bvh: Bvh2, leaf_size: u32, of_leaf: impl Fn(u32) -> (u32, Plan)) -> Self {
        let count = bvh.nodes.len();
        let mut tree = Tree { bvh, sizes: vec![0; count], plans: vec![Plan::default(); count] };
        let mut order = Vec::with_capacity(count);
        order.push(0);
        let mut next = 0;
        while let Some(&node) = order.get(next) {
            if !tree.node(node).is_leaf() {
                order.extend(tree.children(node));
            }
            next += 1;
        }
        for node in order.into_iter().rev() {
            if tree.node(node).is_leaf() {
                (tree.sizes[node], tree.plans[node]) = of_leaf(tree.node(node).first_index);
            } else {
                let [left, right] = tree.children(node);
                tree.sizes[node] = tree.sizes[left] + tree.sizes[right];
                if tree.sizes[node] > leaf_size {
                    let area = tree.node(node).aabb().half_area();
                    tree.plans[node] = Plan::above(area, &tree.plans[left], &tree.plans[right]);
                }
            }
        }
        tree
    }

    pub fn node(&self, node: usize) -> &Bvh2Node {
        &self.bvh.nodes[node]
    }

    fn children(&self, node: usize) -> [usize; 2] {
        let first = self.node(node).first_index as usize;
        [first, first + 1]
    }

    /// The largest subtrees of at most `size` triangles, below a node.
    pub fn subtrees(&self, node: usize, size: u32) -> Vec<usize> {
        let mut found = Vec::new();
        let mut open = vec![node];
        while let Some(node) = open.pop() {
            if self.sizes[node] <= size || self.node(node).is_leaf() {
                found.push(node);
            } else {
                open.extend(self.children(node));
            }
        }
        found
    }
}

/// A node of one of several trees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    pub tree: usize,
    pub node: usize,
}

/// Trees of shapes and, as the last, the tree over their subtrees, unless there is but one.
pub(super) struct Forest<S> {
    pub trees: Vec<Tree>,
    /// What the leaves of the last are.
    pub ends: Vec<Place>,
    pub shapes: S,
}

/// A part of the hierarchy, numbered as if it were alone.
#[derive(Default)]
pub(super) struct Part {
    pub blocks: Vec<Block>,
    pub curved: Vec<Curved>,
    /// What was asked for, in order.
    pub children: Vec<Child>,
    /// Nodes on the longest way down.
    pub depth: usize,
}

/// A child of a block at the top that will be known later.
pub(super) struct Link {
    pub block: usize,
    pub index: usize,
    pub place: Place,
}

impl<S: Shapes> Forest<S> {
    /// Where the hierarchy begins.
    pub fn root(&self) -> Place {
        Place { tree: self.trees.len() - 1, node: 0 }
    }

    pub fn is_top(&self, place: Place) -> bool {
        self.trees.len() > 1 && place.tree + 1 == self.trees.len()
    }

    /// The place itself, or the subtree that stands in it.
    fn resolved(&self, place: Place) -> Place {
        let node = self.trees[place.tree].node(place.node);
        if self.is_top(place) && node.is_leaf() { self.ends[node.first_index as usize] } else { place }
    }

    /// The roots of a subtree, of which there may be `count`.
    fn roots(&self, place: Place, mut count: usize, roots: &mut Vec<Place>) {
        let Place { tree, node } = self.resolved(place);
        let plan = &self.trees[tree].plans[node];
        while count > 1 && plan.left[count] == 0 {
            count -= 1;
        }
        if count == 1 {
            return roots.push(Place { tree, node });
        }
        let of_left = usize::from(plan.left[count]);
        let [left, right] = self.trees[tree].children(node);
        self.roots(Place { tree, node: left }, of_left, roots);
        self.roots(Place { tree, node: right }, count - of_left, roots);
    }

    /// Adds a node of no children, and says which it will have.
    fn open(&self, place: Place, blocks: &mut Vec<Block>) -> (usize, Vec<Place>) {
        let mut roots = Vec::with_capacity(WIDTH);
        self.roots(place, WIDTH, &mut roots);
        blocks.push(Node::EMPTY);
        (blocks.len() - 1, roots)
    }

    /// Adds the nodes above the trees of shapes. Returns the longest way down through them.
    pub fn add_top(&self, place: Place, blocks: &mut Vec<Block>, links: &mut Vec<Link>) -> (Child, usize) {
        let (block, roots) = self.open(place, blocks);
        let mut depth = 0;
        for (index, place) in roots.into_iter().enumerate() {
            let child = if self.is_top(place) {
                let (child, below) = self.add_top(place, blocks, links);
                depth = depth.max(below);
                child
            } else {
                links.push(Link { block, index, place });
                Child::ROOT
            };
            Node::set_child(&mut blocks[block], index, self.trees[place.tree].node(place.node).aabb(), child);
        }
        (Child::node(block), depth + 1)
    }

    /// Adds all that lies below a place in a tree of shapes. Returns the longest way down through it.
    pub fn add(&self, place: Place, part: &mut Part) -> (Child, usize) {
        if self.trees[place.tree].plans[place.node].left[WIDTH] == 0 {
            return (self.add_leaf(place, part), 0);
        }
        let (block, roots) = self.open(place, &mut part.blocks);
        let mut depth = 0;
        for (index, place) in roots.into_iter().enumerate() {
            let (child, below) = self.add(place, part);
            depth = depth.max(below);
            Node::set_child(&mut part.blocks[block], index, self.trees[place.tree].node(place.node).aabb(), child);
        }
        (Child::node(block), depth + 1)
    }

    /// Adds a sphere, a disk, or triangles side by side.
    fn add_leaf(&self, place: Place, part: &mut Part) -> Child {
        let tree = &self.trees[place.tree];
        let mut block = Leaf::EMPTY;
        for (lane, node) in tree.subtrees(place.node, 1).into_iter().enumerate() {
            let id = tree.node(node).first_index;
            let surface = self.shapes.surface(id);
            match self.shapes.primitive(id) {
                Primitive::Triangle(triangle) => Leaf::set_triangle(&mut block, lane, triangle.corners, id, &surface),
                primitive => {
                    part.curved.push(Curved { primitive, id, surface });
                    return Child::curved(part.curved.len() - 1);
                }
            }
        }
        part.blocks.push(block);
        Child::triangles(part.blocks.len() - 1)
    }
}
