//! The tree of one large mesh, in the mesh's own space: eight boxes a node, kept in a byte a plane (Ylitie, Karras and
//! Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017). Both machines walk the
//! same arrays: 80 bytes a node, three indices a triangle in the order of the leaves, and the mesh's own positions.
//!
//! A mesh's tree is made once however many scenes, panes and techniques ask for it, and is there as long as one
//! of them holds it.
//!
//! Twin: `shaders/pathtrace/intersect/cwbvh.wgsl`, which walks it.

use super::baking::is_instanced;
use super::mesh_build::Progress;
use super::mesh_known::tree_of;
use super::mesh_unpacked::Unpacked;
use super::mesh_walk::MOST;
use obvhs::cwbvh::node::CwBvhNode;
use rayon::prelude::*;
use scene::{Mesh, Scene};
use std::sync::{Arc, OnceLock};

/// A mesh, ready for rays in its own space.
pub struct MeshTree {
    /// What it is the tree of.
    pub mesh: Arc<Mesh>,
    /// The first is the root. Boxes are padded for the rounding of the box test.
    pub nodes: Vec<CwBvhNode>,
    /// Indices into the mesh's positions, in the order in which leaves name triangles. Of triangles that a ray meets at one
    /// distance the first here is the hit, on either machine.
    pub triangles: Vec<[u32; 3]>,
    /// Seconds that it took to build, be it in an earlier run.
    pub seconds: f64,
    /// The same for fast rays on the processor, once somebody has asked for it.
    unpacked: OnceLock<Option<Unpacked>>,
}

impl MeshTree {
    /// A tree of these nodes over a mesh's triangles, taken in this order of their numbers. It took so many seconds.
    pub(super) fn new(mesh: &Arc<Mesh>, (nodes, order): (Vec<CwBvhNode>, &[u32]), seconds: f64) -> Self {
        let triangles = order.par_iter().map(|&index| mesh.triangles()[index as usize]).collect();
        MeshTree { mesh: mesh.clone(), nodes, triangles, seconds, unpacked: OnceLock::new() }
    }

    /// The mesh's tree, read or built if it is not there; `None` once `progress`, which is told the share that is done, says
    /// that nobody waits for it any more, and if there are more triangles than leaves can name. Of threads that ask at once
    /// all wait for one; where none does it is built no further, unless somebody asks again at once.
    pub fn of(mesh: &Arc<Mesh>, progress: Progress) -> Option<Arc<Self>> {
        if mesh.triangles().len() > MOST { None } else { tree_of(mesh, progress) }
    }

    /// The same tree for fast rays on the processor, made once, which takes [`Unpacked::bytes`] more; `None` if there
    /// can be none.
    pub(super) fn unpacked(&self) -> Option<&Unpacked> {
        self.unpacked.get_or_init(|| on_threads_of_its_own(|| Unpacked::of(self))).as_ref()
    }

    /// Bytes that it takes beside its mesh.
    pub fn bytes(&self) -> usize {
        let unpacked = self.unpacked.get().and_then(Option::as_ref).map_or(0, Unpacked::bytes);
        size_of_val(&*self.nodes) + size_of_val(&*self.triangles) + unpacked
    }
}

/// The meshes of a scene that have trees: those that are met as instances, each once.
pub fn meshes_with_trees(scene: &Scene) -> Vec<&Arc<Mesh>> {
    let instanced = scene.shapes.iter().filter(|shape| is_instanced(scene, shape));
    let meshes = instanced.filter_map(|shape| shape.geometry.mesh_of());
    let mut meshes: Vec<_> = meshes.filter(|mesh| mesh.triangles().len() <= MOST).collect();
    meshes.sort_by_key(|mesh| Arc::as_ptr(mesh));
    meshes.dedup_by_key(|mesh| Arc::as_ptr(mesh));
    meshes
}

/// The trees of [`meshes_with_trees`], as [`MeshTree::of`] makes each: a scene that is made ready for rays while these are
/// held finds them there.
pub fn trees_of(scene: &Scene, progress: Progress) -> Option<Vec<Arc<MeshTree>>> {
    let meshes = meshes_with_trees(scene);
    let total: usize = meshes.iter().map(|mesh| mesh.triangles().len()).sum();
    let mut before = 0;
    let tree = |mesh: &Arc<Mesh>| {
        let own = mesh.triangles().len();
        let share = |done: f32| (before as f32 + done * own as f32) / total as f32;
        let tree = MeshTree::of(mesh, &|done| progress(share(done)));
        before += own;
        tree
    };
    meshes.into_iter().map(tree).collect()
}

/// Runs on a pool of as many threads as the one at hand, while this thread sleeps. On that pool itself it might take up,
/// while it waits for its parts, another's task that waits for the very tree.
fn on_threads_of_its_own<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(rayon::current_num_threads()).build();
    std::thread::scope(|scope| {
        let worker = scope.spawn(|| match pool {
            Ok(pool) => pool.install(work),
            Err(_) => work(),
        });
        worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

#[cfg(test)]
#[path = "mesh_tree_tests.rs"]
pub(super) mod tests;
