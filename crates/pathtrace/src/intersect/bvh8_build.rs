//! Builds a [`Bvh8`] on all threads.
//!
//! Space is halved until thousands of shapes are left together. obvhs makes a binary hierarchy of each such piece from
//! the bottom up (PLOC: Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
//! Construction", TVCG 24(3), 2018), and one more over the small subtrees of all pieces: where space was halved shows
//! nowhere but in these, and a large shape finds its place at the top. [`super::bvh8_collapse`] says which nodes to
//! keep.

use super::bvh8::{Block, Blocks, Bvh8, Child, Node};
use super::bvh8_collapse::{Forest, Listed, Part, Place, Room, Shapes, Tree};
use super::bvh8_walk::DEEPEST;
use super::coincident::Groups;
use super::primitive::{Primitive, padding};
use obvhs::Boundable;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;
use scene::Vec3;
use scene::glam::Vec3A;
use simd::RowLanes;

/// Shapes that obvhs gets at a time: few enough to stay in a core's cache.
const PIECE: usize = 8192;
/// Most triangles of a subtree that is kept when the pieces are put together.
const SUBTREE: u32 = 32;
/// Share of nodes that obvhs tries to place better, in pieces and in the hierarchy over them.
const REINSERTED: [f32; 2] = [0.02, 0.5];
/// Shapes that a thread measures at a time.
const CHUNK: usize = 1 << 15;

/// A shape's padded box and its number.
#[derive(Clone, Copy)]
pub(super) struct Boxed {
    pub lower: Vec3,
    pub upper: Vec3,
    pub shape: u32,
}

impl Boundable for Boxed {
    fn aabb(&self) -> Aabb {
        Aabb::new(Vec3A::from(self.lower), Vec3A::from(self.upper))
    }
}

impl Boxed {
    /// Twice the centre.
    pub fn middle(&self) -> Vec3 {
        self.lower + self.upper
    }
}

impl Bvh8 {
    /// `None` if the hierarchy would be deeper than a walk can be, or of nothing.
    pub fn new(shapes: Listed, lanes: RowLanes) -> Option<Self> {
        if shapes.primitives.is_empty() {
            return None;
        }
        let padding = padding(shapes.primitives);
        let boxed = |(shape, primitive): (usize, &Primitive)| {
            let (lower, upper) = primitive.bounds();
            Boxed { lower: lower - padding, upper: upper + padding, shape: shape as u32 }
        };
        let mut boxed: Vec<Boxed> = shapes.primitives.par_iter().enumerate().map(boxed).collect();
        let mut trees = split(&mut boxed, shapes);
        let mut ends = Vec::new();
        if trees.len() > 1 {
            let subtrees = |(tree, of): (usize, &Tree)| {
                of.subtrees(0, SUBTREE).into_iter().map(move |node| Place { tree, node }).collect::<Vec<_>>()
            };
            ends = trees.par_iter().enumerate().flat_map_iter(subtrees).collect();
            let boxes: Vec<Aabb> = ends.iter().map(|end| *trees[end.tree].node(end.node).aabb()).collect();
            let top = binary(&boxes, (0..boxes.len() as u32).collect(), REINSERTED[1]);
            trees.push(Tree::of_trees(top, &ends, &trees));
        }
        furnished(&Forest { trees, ends, shapes }, lanes)
    }
}

/// Halves space until pieces are small, and makes a tree of each.
fn split(boxed: &mut [Boxed], shapes: Listed) -> Vec<Tree> {
    if boxed.len() <= PIECE {
        let bvh = binary(boxed, boxed.iter().map(|b| b.shape).collect(), REINSERTED[0]);
        return vec![Tree::of_shapes(bvh, shapes)];
    }
    let middle = halve(boxed);
    let (left, right) = boxed.split_at_mut(middle);
    let (mut trees, mut others) = rayon::join(|| split(left, shapes), || split(right, shapes));
    trees.append(&mut others);
    trees
}

/// Sorts shapes by the side of the middle of the longest axis that they lie on; of shapes all in one place a half is as
/// good as another. Returns how many are on the first side.
pub(super) fn halve(boxed: &mut [Boxed]) -> usize {
    let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (lower, upper) = boxed
        .par_chunks(CHUNK)
        .map(|chunk| chunk.iter().map(Boxed::middle).fold(empty, |(lo, hi), p| (lo.min(p), hi.max(p))))
        .reduce(|| empty, |a, b| (a.0.min(b.0), a.1.max(b.1)));
    let axis = (upper - lower).max_position();
    let plane = (lower[axis] + upper[axis]) / 2.0;
    let mut first = 0;
    for index in 0..boxed.len() {
        if boxed[index].middle()[axis] < plane {
            boxed.swap(first, index);
            first += 1;
        }
    }
    if first == 0 || first == boxed.len() { boxed.len() / 2 } else { first }
}

/// A binary hierarchy of boxes of these numbers, one a leaf.
fn binary<T: Boundable>(boxes: &[T], numbers: Vec<u32>, reinserted: f32) -> Bvh2 {
    let mut builder = PlocBuilder::with_capacity(boxes.len());
    let places = (0..boxes.len() as u32).collect();
    let mut bvh = builder.build(PlocSearchDistance::Low, boxes, places, SortPrecision::U64, 2);
    ReinsertionOptimizer::default().run(&mut bvh, reinserted, None);
    Bvh2 { primitive_indices: numbers, ..bvh }
}

/// Puts the hierarchy that a forest plans into blocks; `None` if it is deeper than a walk can be.
pub(super) fn furnished(forest: &Forest<impl Shapes>, lanes: RowLanes) -> Option<Bvh8> {
    let (mut top, mut links, mut depth) = (Vec::new(), Vec::new(), 0);
    let mut asked = vec![Vec::new(); forest.trees.len()];
    if forest.is_top(forest.root()) {
        (_, depth) = forest.add_top(forest.root(), &mut top, &mut links);
        for link in &links {
            asked[link.place.tree].push(link.place);
        }
    } else {
        asked[0].push(forest.root());
    }
    // measured first, so that parts are written where they stay
    let room_of = |places: &Vec<Place>| places.iter().map(|place| forest.room(*place)).fold(Room::default(), Room::and);
    let rooms: Vec<Room> = asked.par_iter().map(room_of).collect();
    let all = rooms.iter().copied().fold(Room { blocks: top.len(), ..Room::default() }, Room::and);
    if depth + all.depth > DEEPEST {
        return None;
    }
    let mut blocks = Blocks::zeroed(all.blocks);
    let (to_top, rest) = blocks.all_mut().split_at_mut(top.len());
    let parts = parts(&rooms, rest, top.len());
    let added = |(mut part, places): (Part, Vec<Place>)| {
        let children: Vec<Child> = places.into_iter().map(|place| forest.add(place, &mut part)).collect();
        (children, part.curved)
    };
    let (children, curved): (Vec<_>, Vec<_>) = parts.into_par_iter().zip(asked).map(added).unzip();
    let mut children: Vec<_> = children.into_iter().map(Vec::into_iter).collect();
    let mut next = |tree: usize| children[tree].next().unwrap_or(Child::ROOT);
    let root = if top.is_empty() { next(0) } else { Child::ROOT };
    for link in &links {
        Node::relink(&mut top[link.block], link.index, next(link.place.tree));
    }
    to_top.copy_from_slice(&top);
    let curved = curved.into_iter().flatten().collect();
    Some(Bvh8 { root, blocks, curved, groups: Groups::default(), cutouts: None, lanes })
}

/// Parts of these sizes, one after the other, behind as many blocks as come first.
fn parts<'a>(rooms: &[Room], mut rest: &'a mut [Block], before: usize) -> Vec<Part<'a>> {
    let (mut first_block, mut first_curved) = (before, 0);
    let mut parts = Vec::with_capacity(rooms.len());
    for room in rooms {
        let (blocks, others) = std::mem::take(&mut rest).split_at_mut(room.blocks);
        parts.push(Part { blocks, taken: 0, first_block, curved: Vec::with_capacity(room.curved), first_curved });
        (rest, first_block, first_curved) = (others, first_block + room.blocks, first_curved + room.curved);
    }
    parts
}
