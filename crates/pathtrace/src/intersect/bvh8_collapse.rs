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
    /// A tree of shapes, of which leaves hold as many as a block at most.
    pub fn of_shapes(bvh: Bvh2, shapes: impl Shapes) -> Self {
        let size = |shape: &u32| match shapes.primitive(*shape) {
            Primitive::Triangle(_) => 1,
            Primitive::Sphere(_) | Primitive::Disk(_) => LEAF_WIDTH as u32 + 1,
        };
        Self::planned(bvh, LEAF_WIDTH as u32, |in_leaf| (in_leaf.iter().map(size).sum(), Plan::default()))
    }

    /// A tree over subtrees of others, one a leaf.
    pub fn of_trees(bvh: Bvh2, ends: &[Place], trees: &[Tree]) -> Self {
        Self::planned(bvh, 0, |in_leaf| {
            let Place { tree, node } = ends[in_leaf[0] as usize];
            (trees[tree].sizes[node], trees[tree].plans[node])
        })
    }

    /// Plans all subtrees of more triangles than `leaf_size`, children before their parents.
    fn planned(bvh: Bvh2, leaf_size: u32, of_leaf: impl Fn(&[u32]) -> (u32, Plan)) -> Self {
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
                (tree.sizes[node], tree.plans[node]) = of_leaf(tree.in_leaf(node));
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

    /// The numbers of what is in a leaf.
    fn in_leaf(&self, leaf: usize) -> &[u32] {
        let Bvh2Node { first_index, prim_count, .. } = *self.node(leaf);
        &self.bvh.primitive_indices[first_index as usize..][..prim_count as usize]
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

/// What a part of the hierarchy takes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Room {
    pub blocks: usize,
    /// How many shapes are round.
    pub curved: usize,
    /// Nodes on the longest way down.
    pub depth: usize,
}

impl Room {
    /// For both, side by side.
    pub fn and(self, other: Room) -> Room {
        Room {
            blocks: self.blocks + other.blocks,
            curved: self.curved + other.curved,
            depth: self.depth.max(other.depth),
        }
    }
}

/// Where a part of the hierarchy is put.
pub(super) struct Part<'a> {
    pub blocks: &'a mut [Block],
    /// Of its blocks those that are taken, and the number that the first has among all.
    pub taken: usize,
    pub first_block: usize,
    pub curved: Vec<Curved>,
    /// The place that its first round shape will have among all.
    pub first_curved: usize,
}

impl Part<'_> {
    /// Takes the next block. Returns its number among all.
    fn take(&mut self, block: Block) -> usize {
        self.blocks[self.taken] = block;
        self.taken += 1;
        self.first_block + self.taken - 1
    }
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
        let is_end = self.is_top(place) && node.is_leaf();
        if is_end { self.ends[self.trees[place.tree].in_leaf(place.node)[0] as usize] } else { place }
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

    /// What will be in a node.
    fn children(&self, place: Place) -> Vec<Place> {
        let mut roots = Vec::with_capacity(WIDTH);
        self.roots(place, WIDTH, &mut roots);
        roots
    }

    /// Adds the nodes above the trees of shapes. Returns the longest way down through them.
    pub fn add_top(&self, place: Place, blocks: &mut Vec<Block>, links: &mut Vec<Link>) -> (Child, usize) {
        let block = blocks.len();
        blocks.push(Node::EMPTY);
        let mut depth = 0;
        for (index, place) in self.children(place).into_iter().enumerate() {
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

    fn is_leaf(&self, Place { tree, node }: Place) -> bool {
        self.trees[tree].plans[node].left[WIDTH] == 0
    }

    /// What all that lies below a place in a tree of shapes takes.
    pub fn room(&self, place: Place) -> Room {
        if self.is_leaf(place) {
            let is_curved = self.trees[place.tree].sizes[place.node] > LEAF_WIDTH as u32;
            return Room { blocks: usize::from(!is_curved), curved: usize::from(is_curved), depth: 0 };
        }
        let children = self.children(place).into_iter().map(|child| self.room(child));
        let Room { blocks, curved, depth } = children.fold(Room::default(), Room::and);
        Room { blocks: blocks + 1, curved, depth: depth + 1 }
    }

    /// Adds all that lies below a place in a tree of shapes.
    pub fn add(&self, place: Place, part: &mut Part) -> Child {
        if self.is_leaf(place) {
            return self.add_leaf(place, part);
        }
        let number = part.take(Node::EMPTY);
        let block = number - part.first_block;
        for (index, place) in self.children(place).into_iter().enumerate() {
            let child = self.add(place, part);
            Node::set_child(&mut part.blocks[block], index, self.trees[place.tree].node(place.node).aabb(), child);
        }
        Child::node(number)
    }

    /// Adds a sphere, a disk, or triangles side by side.
    fn add_leaf(&self, place: Place, part: &mut Part) -> Child {
        let tree = &self.trees[place.tree];
        let leaves = tree.subtrees(place.node, 1);
        let mut block = Leaf::EMPTY;
        for (lane, &id) in leaves.iter().flat_map(|leaf| tree.in_leaf(*leaf)).enumerate() {
            let surface = self.shapes.surface(id);
            match self.shapes.primitive(id) {
                Primitive::Triangle(triangle) => Leaf::set_triangle(&mut block, lane, triangle.corners, id, &surface),
                primitive => {
                    part.curved.push(Curved { primitive, id, surface });
                    return Child::curved(part.first_curved + part.curved.len() - 1);
                }
            }
        }
        Child::triangles(part.take(block))
    }
}
