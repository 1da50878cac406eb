//! Builds the arrays of a [`super::MeshTree`] on all threads, in little more memory than they need.
//!
//! Space is halved until thousands of triangles are left together, as in [`super::bvh8_build`]. obvhs makes a compressed
//! tree of each such piece, which is kept, and one more over the pieces' boxes; it goes on in each piece's root.

use super::bvh8_build::{Boxed, halve};
use super::bvh8_walk::DEEPEST;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::cwbvh::node::CwBvhNode;
use obvhs::cwbvh::{BRANCHING, CwBvh};
use obvhs::ploc::PlocBuilder;
use obvhs::{Boundable, BvhBuildParams};
use rayon::prelude::*;
use scene::{Mesh, Vec3};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Triangles that obvhs gets at a time.
pub(super) const PIECE: usize = 1 << 15;
/// Most triangles of a leaf.
pub(super) const LEAF: u32 = 3;

/// Says which share of the work is done, and hears whether it goes on.
pub type Progress<'a> = &'a (dyn Fn(f32) -> bool + Sync);

/// How a binary tree is made before it is compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Make {
    /// From the bottom up, so that boxes are small.
    Clustered,
    /// Halved by count, so that it is not deep, whatever the triangles are like.
    Balanced,
}

/// Nodes, and triangles by their numbers in the order of the leaves.
pub(super) type Tree = (Vec<CwBvhNode>, Vec<u32>);

/// A mesh's tree; `None` once `progress` says so.
pub(super) fn build(mesh: &Mesh, progress: Progress) -> Option<Tree> {
    let (nodes, order) = nodes_of(mesh, Make::Clustered, progress)?;
    if depth(&nodes) <= DEEPEST { Some((nodes, order)) } else { nodes_of(mesh, Make::Balanced, progress) }
}

fn nodes_of(mesh: &Mesh, make: Make, progress: Progress) -> Option<Tree> {
    if !progress(0.0) {
        return None;
    }
    let stopped = AtomicBool::new(false);
    let mut boxes = boxes_of(mesh);
    let total = boxes.len();
    let done = AtomicUsize::new(0);
    let piece = |boxes: &mut [Boxed]| {
        if stopped.load(Ordering::Relaxed) {
            return None;
        }
        let piece = piece_of(boxes, make);
        let done = done.fetch_add(boxes.len(), Ordering::Relaxed) + boxes.len();
        if !progress(done as f32 / total as f32) {
            stopped.store(true, Ordering::Relaxed);
        }
        Some(piece)
    };
    // asked between pieces and before each halving; once it was told to stop, no more
    let goes_on = || {
        let goes_on = !stopped.load(Ordering::Relaxed) && progress(done.load(Ordering::Relaxed) as f32 / total as f32);
        stopped.fetch_or(!goes_on, Ordering::Relaxed);
        goes_on
    };
    let pieces = split(&mut boxes, &piece, &goes_on)?;
    drop(boxes);
    (!stopped.load(Ordering::Relaxed)).then(|| joined(pieces, make))
}

/// How much the boxes of a mesh's triangles are grown, as [`super::primitive::padding`] says it of a scene's.
pub(super) fn padding(mesh: &Mesh) -> Vec3 {
    let (lo, hi) = mesh.bounds();
    let largest = lo.abs().max(hi.abs()).max_element();
    Vec3::splat((largest + (hi - lo).max_element()) / 1_048_576.0 + super::gamma(1) * largest)
}

/// The triangles' padded boxes.
fn boxes_of(mesh: &Mesh) -> Vec<Boxed> {
    let padding = padding(mesh);
    let boxed = |(index, triangle): (usize, &[u32; 3])| {
        let [a, b, c] = triangle.map(|corner| mesh.positions()[corner as usize]);
        Boxed { lower: a.min(b).min(c) - padding, upper: a.max(b).max(c) + padding, shape: index as u32 }
    };
    mesh.triangles().par_iter().enumerate().map(boxed).collect()
}

/// A piece's tree and its box.
struct Piece {
    tree: Tree,
    bounds: Aabb,
}

/// Halves space until pieces are small, and makes a tree of each.
fn split(
    boxes: &mut [Boxed],
    tree_of: &(impl Fn(&mut [Boxed]) -> Option<Piece> + Sync),
    goes_on: &(impl Fn() -> bool + Sync),
) -> Option<Vec<Piece>> {
    if boxes.len() <= PIECE {
        return Some(vec![tree_of(boxes)?]);
    }
    if !goes_on() {
        return None;
    }
    let middle = halve(boxes);
    let (left, right) = boxes.split_at_mut(middle);
    let (one, other) = rayon::join(|| split(left, tree_of, goes_on), || split(right, tree_of, goes_on));
    let mut pieces = one?;
    pieces.append(&mut other?);
    Some(pieces)
}

fn piece_of(boxes: &mut [Boxed], make: Make) -> Piece {
    let CwBvh { mut nodes, primitive_indices, total_aabb, .. } = compressed(boxes, make, LEAF);
    // room that was taken in advance is given back: there are thousands of pieces
    nodes.shrink_to_fit();
    Piece { tree: (nodes, primitive_indices), bounds: total_aabb }
}

/// A compressed tree over boxes, which it puts into another order; it names them by their numbers.
fn compressed(boxes: &mut [Boxed], make: Make, most_in_leaf: u32) -> CwBvh {
    let binary = match make {
        Make::Clustered => clustered(boxes),
        Make::Balanced => balanced(boxes),
    };
    let mut tree = bvh2_to_cwbvh(&binary, most_in_leaf, true, false);
    tree.primitive_indices.iter_mut().for_each(|index| *index = boxes[*index as usize].shape);
    tree
}

/// A binary tree from the bottom up, one box a leaf.
fn clustered(boxes: &[Boxed]) -> Bvh2 {
    let BvhBuildParams {
        ploc_search_distance, sort_precision, search_depth_threshold, reinsertion_batch_ratio, ..
    } = BvhBuildParams::medium_build();
    let places = (0..boxes.len() as u32).collect();
    let mut builder = PlocBuilder::with_capacity(boxes.len());
    let mut binary = builder.build(ploc_search_distance, boxes, places, sort_precision, search_depth_threshold);
    ReinsertionOptimizer::default().run(&mut binary, reinsertion_batch_ratio, None);
    binary
}

/// A binary tree whose branches hold as many boxes each, one a leaf.
fn balanced(boxes: &mut [Boxed]) -> Bvh2 {
    let mut binary = Bvh2::default();
    binary.nodes.push(Bvh2Node::default());
    fill(boxes, 0, &mut binary);
    binary
}

fn fill(boxes: &mut [Boxed], node: usize, binary: &mut Bvh2) {
    if let [one] = boxes {
        // boxes are put into this order
        let place = binary.primitive_indices.len() as u32;
        binary.nodes[node] = Bvh2Node::new(one.aabb(), 1, place);
        binary.primitive_indices.push(place);
        return;
    }
    let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = boxes.iter().map(Boxed::middle).fold(none, |(lo, hi), p| (lo.min(p), hi.max(p)));
    let axis = (high - low).max_position();
    let half = boxes.len() / 2;
    boxes.select_nth_unstable_by(half, |a, b| a.middle()[axis].total_cmp(&b.middle()[axis]));
    let first = binary.nodes.len();
    binary.nodes.extend([Bvh2Node::default(); 2]);
    let (left, right) = boxes.split_at_mut(half);
    fill(left, first, binary);
    fill(right, first + 1, binary);
    let bounds = binary.nodes[first].aabb().union(binary.nodes[first + 1].aabb());
    binary.nodes[node] = Bvh2Node::new(bounds, 0, first as u32);
}

/// One tree of all pieces: one over their boxes, whose leaves become the pieces' roots.
fn joined(mut pieces: Vec<Piece>, make: Make) -> Tree {
    if pieces.len() == 1 {
        return pieces.swap_remove(0).tree;
    }
    let top = over(&pieces, make);
    let (mut nodes, roots) = opened(&top);
    let most = pieces.iter().map(|piece| piece.tree.0.len()).sum::<usize>() + nodes.len();
    nodes.reserve_exact(most - nodes.len());
    let mut order = Vec::with_capacity(pieces.iter().map(|piece| piece.tree.1.len()).sum());
    for (root, piece) in roots {
        let (of_piece, order_of_piece) = std::mem::take(&mut pieces[piece].tree);
        // all but the root lie one after the other
        let (first_node, first_triangle) = (nodes.len() as u32 - 1, order.len() as u32);
        let moved = |node: &CwBvhNode| CwBvhNode {
            child_base_idx: node.child_base_idx + first_node,
            primitive_base_idx: node.primitive_base_idx + first_triangle,
            ..*node
        };
        let mut moved = of_piece.iter().map(moved);
        if let Some(moved_root) = moved.next() {
            nodes[root] = moved_root;
        }
        nodes.extend(moved);
        order.extend(order_of_piece);
    }
    (nodes, order)
}

/// A compressed tree over the pieces' boxes, one a leaf.
fn over(pieces: &[Piece], make: Make) -> CwBvh {
    let boxed = |(Piece { bounds, .. }, shape): (&Piece, u32)| Boxed {
        lower: bounds.min.into(),
        upper: bounds.max.into(),
        shape,
    };
    compressed(&mut pieces.iter().zip(0..).map(boxed).collect::<Vec<_>>(), make, 1)
}

/// A tree whose leaves are to become nodes, all children of a node one after the other. Also returns where these lie, and
/// what is in each.
fn opened(top: &CwBvh) -> (Vec<CwBvhNode>, Vec<(usize, usize)>) {
    let (mut nodes, mut roots) = (vec![CwBvhNode::default()], Vec::new());
    let mut open = vec![(0, 0)];
    while let Some((place, of_top)) = open.pop() {
        let mut node = top.nodes[of_top];
        (node.child_base_idx, node.primitive_base_idx, node.imask) = (nodes.len() as u32, 0, 0);
        for slot in (0..BRANCHING).filter(|slot| !top.nodes[of_top].is_child_empty(*slot)) {
            if top.nodes[of_top].is_leaf(slot) {
                let (first, _) = top.nodes[of_top].child_primitives(slot);
                roots.push((nodes.len(), top.primitive_indices[first as usize] as usize));
            } else {
                open.push((nodes.len(), top.nodes[of_top].child_node_index(slot) as usize));
            }
            node.imask |= 1 << slot;
            node.child_meta[slot] = 0b0010_0000 | (24 + slot as u8);
            nodes.push(CwBvhNode::default());
        }
        nodes[place] = node;
    }
    (nodes, roots)
}

/// How many nodes lie on the longest way down. Children lie behind their parents.
pub(super) fn depth(nodes: &[CwBvhNode]) -> usize {
    let mut depths = vec![1u16; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        let first = node.child_base_idx as usize;
        let children = node.imask.count_ones() as usize;
        let below = depths[index].saturating_add(1);
        depths[first..first + children].fill(below);
    }
    depths.into_iter().max().map_or(0, usize::from)
}

#[cfg(test)]
mod tests {
    use super::super::mesh_tree::tests::sheet;
    use super::*;
    use std::sync::Mutex;

    /// Triangles, each a thousandth smaller than the one before and closer to one corner: what is clustered from the bottom
    /// up is a chain.
    fn chain() -> Mesh {
        let size = |i: u32| 0.96f32.powi(i as i32);
        let corner = |i: u32| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| (p + 1.0) * size(i / 3));
        let positions = (0..6000).map(|i| corner(i)[i as usize % 3]).collect();
        Mesh::new(positions, (0..2000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
    }

    #[test]
    fn a_tree_that_would_be_too_deep_is_balanced() {
        let mesh = chain();
        let (nodes, _) = nodes_of(&mesh, Make::Clustered, &|_| true).expect("a tree");
        assert!(depth(&nodes) > DEEPEST, "{}", depth(&nodes));
        let (nodes, mut order) = build(&mesh, &|_| true).expect("a tree");
        assert!(depth(&nodes) <= DEEPEST);
        order.sort_unstable();
        assert!(order.into_iter().eq(0..2000));
    }

    #[test]
    fn progress_goes_from_nothing_to_all_and_a_build_that_is_given_up_ends() {
        let mesh = sheet(300);
        let heard = Mutex::new(Vec::new());
        let note = |done: f32| {
            heard.lock().expect("a list").push(done);
            true
        };
        assert!(build(&mesh, &note).is_some());
        let heard = heard.into_inner().expect("a list");
        let most = heard.iter().copied().fold(0.0, f32::max);
        assert_eq!((heard[0], most), (0.0, 1.0));
        assert!(heard.len() > 6, "{heard:?}");
        let said = AtomicUsize::new(0);
        assert!(build(&mesh, &|_| said.fetch_add(1, Ordering::Relaxed) == 0).is_none());
        // whoever asks while another is told so may hear it as well
        assert!(said.load(Ordering::Relaxed) <= 3);
    }
}
