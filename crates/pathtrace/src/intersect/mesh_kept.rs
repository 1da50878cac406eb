//! Trees from one run of a program to the next: bytes under a name that says all that a tree depends on. Where they are
//! kept is the affair of a [`Shelf`].
//!
//! A tree that was read is by every bit the one that was built. Nothing of a file is believed: each length is that of the
//! mesh, a hash of all bytes stands at the end, and no node names what is not there.

use super::bvh8_walk::DEEPEST;
use super::mesh_build::{LEAF, PIECE, Progress, Tree, build, depth};
use super::mesh_tree::MeshTree;
use obvhs::cwbvh::node::CwBvhNode;
use rayon::prelude::*;
use scene::Mesh;
use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};
use std::time::Instant;

/// Triangles from which on a mesh's tree is kept: building it takes .07 s of processor time, and reading a thirteenth of that,
/// as for larger ones; what is smaller is not worth a file (docs/performance.md).
pub const KEPT_FROM: usize = 1 << 17;

/// Begins a kept tree. Its number goes up with each change of what follows, or of how trees are built.
const MARK: [u8; 16] = *b"visavis.tree 001";

/// What has built binary trees and compressed them; a test holds it against what the program is linked with.
const BUILDER: &str = "obvhs 0.4.0";

/// Bytes of [`MARK`], of the counts of triangles, positions and nodes, and of the seconds that building took.
const HEAD: usize = MARK.len() + 4 * 8;

/// Bytes of a node, and of a triangle's number.
const NODE: usize = size_of::<CwBvhNode>();
const NUMBER: usize = size_of::<u32>();

/// Where trees are kept. None of it may fail loudly: a tree that is not there is built.
pub trait Shelf: Send + Sync {
    /// What was put under this name, if there is that and it has at most so many bytes.
    fn fetch(&self, name: &str, most: u64) -> Option<Vec<u8>>;

    /// Keeps these bytes under this name, whole or not at all.
    fn put(&self, name: &str, bytes: &[u8]);

    /// What was fetched under this name is not what was put there: it is built, and put there again.
    fn found_damaged(&self, name: &str);
}

static SHELF: OnceLock<Box<dyn Shelf>> = OnceLock::new();

/// How many trees are being put there.
static PUTTING: Mutex<usize> = Mutex::new(0);
static PUT: Condvar = Condvar::new();

/// Keeps trees here from now on, for the whole process; the first shelf stays.
pub fn keep_on(shelf: impl Shelf + 'static) {
    // what a second one would keep the first does
    let _ = SHELF.set(Box::new(shelf));
}

/// Waits until what is being put on the shelf is there: for a program that ends.
pub fn finish() {
    let mut putting = PUTTING.lock().unwrap_or_else(PoisonError::into_inner);
    while *putting > 0 {
        putting = PUT.wait(putting).unwrap_or_else(PoisonError::into_inner);
    }
}

pub(super) fn shelf() -> Option<&'static dyn Shelf> {
    SHELF.get().map(|shelf| &**shelf)
}

/// A tree that is to be put on the shelf, once nobody waits for it any more.
pub(super) struct ToKeep {
    shelf: &'static dyn Shelf,
    name: String,
    tree: Arc<MeshTree>,
    order: Vec<u32>,
}

impl ToKeep {
    fn new(shelf: &'static dyn Shelf, name: String, tree: Arc<MeshTree>, order: Vec<u32>) -> Self {
        *PUTTING.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        ToKeep { shelf, name, tree, order }
    }

    pub fn put(self) {
        self.shelf.put(&self.name, &bytes_of(&self.tree, &self.order));
    }
}

impl Drop for ToKeep {
    fn drop(&mut self) {
        *PUTTING.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        PUT.notify_all();
    }
}

/// The tree as it was kept, else built, and then what is to be kept of it; `None` once `progress` says so.
pub(super) fn fetch_or_build(
    mesh: &Arc<Mesh>,
    shelf: Option<&'static dyn Shelf>,
    progress: Progress,
) -> Option<(Arc<MeshTree>, Option<ToKeep>)> {
    let shelf = shelf.filter(|_| mesh.triangles().len() >= KEPT_FROM);
    let begun = Instant::now();
    let named = shelf.map(|shelf| (shelf, name_of(mesh)));
    if let Some((shelf, name)) = &named
        && let Some(bytes) = shelf.fetch(name, most_bytes(mesh))
    {
        match tree_from(mesh, &bytes) {
            Some(tree) => return Some((Arc::new(tree), None)),
            None => shelf.found_damaged(name),
        }
    }
    let (nodes, order) = build(mesh, progress)?;
    let tree = Arc::new(MeshTree::new(mesh, (nodes, &order), begun.elapsed().as_secs_f64()));
    let to_keep = named.map(|(shelf, name)| ToKeep::new(shelf, name, tree.clone(), order));
    Some((tree, to_keep))
}

/// 32 digits for all that a tree depends on.
fn name_of(mesh: &Mesh) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&MARK).update(BUILDER.as_bytes()).update(std::env::consts::ARCH.as_bytes());
    hasher.update(&(PIECE as u64).to_le_bytes()).update(&LEAF.to_le_bytes()).update(&(DEEPEST as u64).to_le_bytes());
    hasher.update(&mesh.content().to_le_bytes());
    hasher.finalize().to_hex()[..32].to_owned()
}

/// A node has two children at least, so that there are fewer nodes than triangles.
fn most_bytes(mesh: &Mesh) -> u64 {
    let triangles = mesh.triangles().len() as u64;
    (HEAD + blake3::OUT_LEN) as u64 + (NODE + NUMBER) as u64 * triangles
}

/// A tree as it is kept, of its triangles their numbers in the mesh alone.
fn bytes_of(tree: &MeshTree, order: &[u32]) -> Vec<u8> {
    let (nodes, order): (&[u8], &[u8]) = (bytemuck::cast_slice(&tree.nodes), bytemuck::cast_slice(order));
    let mut bytes = Vec::with_capacity(HEAD + nodes.len() + order.len() + blake3::OUT_LEN);
    bytes.extend(MARK);
    for count in [order.len() / NUMBER, tree.mesh.positions().len(), tree.nodes.len()] {
        bytes.extend((count as u64).to_le_bytes());
    }
    bytes.extend(tree.seconds.to_le_bytes());
    bytes.extend(nodes);
    bytes.extend(order);
    let hash = blake3::hash(&bytes);
    bytes.extend(hash.as_bytes());
    bytes
}

/// The tree that was kept of this mesh; `None` if these are not its bytes.
fn tree_from(mesh: &Arc<Mesh>, bytes: &[u8]) -> Option<MeshTree> {
    let (body, hash) = bytes.split_last_chunk::<{ blake3::OUT_LEN }>()?;
    let (mark, rest) = body.split_first_chunk::<{ MARK.len() }>()?;
    let (counts, rest) = rest.split_first_chunk::<{ HEAD - MARK.len() }>()?;
    let [triangles, positions, nodes, seconds] = [0, 8, 16, 24].map(|at| number_at(counts, at));
    let is_the_meshs = (triangles, positions) == (mesh.triangles().len() as u64, mesh.positions().len() as u64);
    let of_nodes = usize::try_from(nodes).ok()?.checked_mul(NODE)?;
    let length = of_nodes.checked_add(mesh.triangles().len().checked_mul(NUMBER)?)?;
    if *mark != MARK || !is_the_meshs || rest.len() != length || blake3::hash(body) != *hash {
        return None;
    }
    let (nodes, order) = rest.split_at(of_nodes);
    let tree: Tree = (bytemuck::pod_collect_to_vec(nodes), bytemuck::pod_collect_to_vec(order));
    if !names_what_is_there(&tree) {
        return None;
    }
    let (nodes, order) = tree;
    let seconds = Some(f64::from_bits(seconds)).filter(|seconds| seconds.is_finite() && *seconds >= 0.0)?;
    Some(MeshTree::new(mesh, (nodes, &order), seconds))
}

fn number_at(counts: &[u8; HEAD - MARK.len()], at: usize) -> u64 {
    u64::from_le_bytes(std::array::from_fn(|i| counts[at + i]))
}

/// Whether each triangle has one place and each node but the root one parent, before it, leaves hold triangles that there
/// are, and no way down is too long.
fn names_what_is_there((nodes, order): &Tree) -> bool {
    let mut triangles = vec![false; order.len()];
    let mut children = vec![false; nodes.len()];
    order.iter().all(|number| is_new(&mut triangles, *number as usize))
        && nodes.iter().enumerate().all(|(index, node)| have_no_other_parent(&mut children, index, node))
        && children.iter().skip(1).all(|named| *named)
        && nodes.par_iter().all(|node| has_triangles(node, order.len()))
        && !nodes.is_empty()
        && depth(nodes) <= DEEPEST
}

/// Notes a place; whether there is such and it was not noted before.
fn is_new(noted: &mut [bool], place: usize) -> bool {
    noted.get_mut(place).is_some_and(|noted| !std::mem::replace(noted, true))
}

fn have_no_other_parent(named: &mut [bool], index: usize, node: &CwBvhNode) -> bool {
    let (first, count) = (node.child_base_idx as usize, node.imask.count_ones() as usize);
    (0..count).all(|child| first > index && is_new(named, first + child))
}

/// Whether its leaves hold so many triangles as there may be, of those that there are.
fn has_triangles(node: &CwBvhNode, all: usize) -> bool {
    (0..8).filter(|slot| !node.is_child_empty(*slot) && node.is_leaf(*slot)).all(|slot| {
        let (place, count) = (node.child_meta[slot] & 31, (node.child_meta[slot] >> 5).count_ones());
        let end = u64::from(node.primitive_base_idx) + u64::from(place) + u64::from(count);
        (1..=LEAF).contains(&count) && end <= all as u64
    })
}

#[cfg(test)]
#[path = "mesh_kept_tests.rs"]
mod tests;
