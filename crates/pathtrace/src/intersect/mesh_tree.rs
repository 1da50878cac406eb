//! The tree of one large mesh, in the mesh's own space: eight boxes a node, kept in a byte a plane (Ylitie, Karras and
//! Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017). Both machines walk the
//! same arrays: 80 bytes a node, three indices a triangle in the order of the leaves, and the mesh's own positions.
//!
//! A mesh's tree is made once however many scenes, panes and techniques ask for it, and is there as long as one
//! of them holds it.
//!
//! Twin: `shaders/pathtrace/intersect/cwbvh.wgsl`, which walks it.

use super::baking::is_instanced;
use super::mesh_build::{Progress, build};
use super::mesh_unpacked::Unpacked;
use obvhs::cwbvh::node::CwBvhNode;
use scene::{Mesh, Scene};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock, PoisonError, Weak};
use std::time::Duration;

/// A mesh, ready for rays in its own space.
pub struct MeshTree {
    /// What it is the tree of.
    pub mesh: Arc<Mesh>,
    /// The first is the root. Boxes are padded for the rounding of the box test.
    pub nodes: Vec<CwBvhNode>,
    /// Indices into the mesh's positions, in the order in which leaves name triangles. Of triangles that a ray meets at one
    /// distance the first here is the hit, on either machine.
    pub triangles: Vec<[u32; 3]>,
    /// The same for fast rays on the processor, once somebody has asked for it.
    unpacked: OnceLock<Option<Unpacked>>,
}

/// A mesh that was asked for, and its tree.
struct Known {
    mesh: Weak<Mesh>,
    state: State,
}

enum State {
    /// Which share is done, as a float's bits.
    Building(Arc<AtomicU32>),
    Built(Weak<MeshTree>),
}

/// Meshes whose trees are there, or being built.
static KNOWN: Mutex<Vec<Known>> = Mutex::new(Vec::new());
/// A tree is built, or will not be.
static CHANGED: Condvar = Condvar::new();
/// How often who waits for another's tree asks whether to go on.
const PATIENCE: Duration = Duration::from_millis(30);

/// What is to be done for a tree.
enum Claim {
    Take(Arc<MeshTree>),
    Build(Building),
    Wait(f32),
}

/// The right to build a mesh's tree, which another has if it was not.
struct Building {
    mesh: Weak<Mesh>,
    done: Arc<AtomicU32>,
}

impl MeshTree {
    /// The mesh's tree, built if it is not there; `None` once `progress`, which is told the share that is done, says that
    /// nobody wants it any more. Of threads that ask at once one builds, and the others wait.
    pub fn of(mesh: &Arc<Mesh>, progress: Progress) -> Option<Arc<Self>> {
        loop {
            match claim(mesh) {
                Claim::Take(tree) => return Some(tree),
                Claim::Build(building) => return building.build(mesh, progress),
                Claim::Wait(done) => {
                    if !progress(done) {
                        return None;
                    }
                }
            }
        }
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

/// Trees of all meshes of a scene that are met as instances, as [`MeshTree::of`] makes each: a scene that is made ready
/// for rays while these are held finds them there.
pub fn trees_of(scene: &Scene, progress: Progress) -> Option<Vec<Arc<MeshTree>>> {
    let instanced = scene.shapes.iter().filter(|shape| is_instanced(scene, shape));
    let mut meshes: Vec<&Arc<Mesh>> = instanced.filter_map(|shape| shape.geometry.mesh_of()).collect();
    meshes.sort_by_key(|mesh| Arc::as_ptr(mesh));
    meshes.dedup_by_key(|mesh| Arc::as_ptr(mesh));
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

fn known() -> MutexGuard<'static, Vec<Known>> {
    // it holds whole entries at any time
    KNOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes the tree if it is there, the right to build it if nobody has that, or waits a little.
fn claim(mesh: &Arc<Mesh>) -> Claim {
    let mut known = known();
    known.retain(|known| known.mesh.strong_count() > 0);
    let mesh = Arc::downgrade(mesh);
    let place = known.iter().position(|known| known.mesh.ptr_eq(&mesh));
    match place.map(|place| &known[place].state) {
        Some(State::Building(done)) => {
            let done = f32::from_bits(done.load(Ordering::Relaxed));
            let _ = CHANGED.wait_timeout(known, PATIENCE);
            return Claim::Wait(done);
        }
        Some(State::Built(tree)) => {
            if let Some(tree) = tree.upgrade() {
                return Claim::Take(tree);
            }
        }
        None => {}
    }
    known.retain(|known| !known.mesh.ptr_eq(&mesh));
    let done = Arc::new(AtomicU32::new(0));
    known.push(Known { mesh: mesh.clone(), state: State::Building(done.clone()) });
    Claim::Build(Building { mesh, done })
}

impl Building {
    fn build(self, mesh: &Arc<Mesh>, progress: Progress) -> Option<Arc<MeshTree>> {
        let noted = |done: f32| {
            self.done.store(done.to_bits(), Ordering::Relaxed);
            progress(done)
        };
        let (nodes, triangles) = on_threads_of_its_own(|| build(mesh, &noted))?;
        let tree = Arc::new(MeshTree { mesh: mesh.clone(), nodes, triangles, unpacked: OnceLock::new() });
        for known in known().iter_mut().filter(|known| known.mesh.ptr_eq(&self.mesh)) {
            known.state = State::Built(Arc::downgrade(&tree));
        }
        Some(tree)
    }
}

impl Drop for Building {
    fn drop(&mut self) {
        let is_given_up = |known: &Known| known.mesh.ptr_eq(&self.mesh) && matches!(known.state, State::Building(_));
        known().retain(|known| !is_given_up(known));
        CHANGED.notify_all();
    }
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
mod tests {
    use super::*;
    use scene::{Geometry, Shape, Vec3, builtin};
    use std::sync::Barrier;
    use std::sync::atomic::AtomicUsize;

    /// A flat mesh of so many squares each way.
    fn sheet(n: u32) -> Arc<Mesh> {
        let corner = |i: u32| Vec3::new((i % (n + 1)) as f32, 0.0, (i / (n + 1)) as f32);
        let cell = |i: u32| {
            let a = i / n * (n + 1) + i % n;
            [[a, a + n + 1, a + 1], [a + 1, a + n + 1, a + n + 2]]
        };
        let positions = (0..(n + 1) * (n + 1)).map(corner).collect();
        Arc::new(Mesh::new(positions, (0..n * n).flat_map(cell).collect()))
    }

    #[test]
    fn threads_that_ask_at_once_get_one_tree() {
        let mesh = sheet(200);
        let together = Barrier::new(4);
        let ask = || {
            together.wait();
            MeshTree::of(&mesh, &|_| true).expect("a tree")
        };
        let trees: Vec<_> = std::thread::scope(|scope| {
            let asked: Vec<_> = (0..4).map(|_| scope.spawn(ask)).collect();
            asked.into_iter().map(|thread| thread.join().expect("a tree")).collect()
        });
        assert!(trees.iter().all(|tree| Arc::ptr_eq(tree, &trees[0])));
        // and another after them, but none is kept for nobody
        assert!(Arc::ptr_eq(&MeshTree::of(&mesh, &|_| true).expect("a tree"), &trees[0]));
        let tree = Arc::downgrade(&trees[0]);
        drop(trees);
        assert!(tree.upgrade().is_none());
    }

    #[test]
    fn tasks_of_one_pool_that_ask_at_once_do_not_wait_for_themselves() {
        let mesh = sheet(300);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
        let ask = || MeshTree::of(&mesh, &|_| true).expect("a tree").triangles.len();
        let ((a, b), (c, d)) = pool.install(|| rayon::join(|| rayon::join(ask, ask), || rayon::join(ask, ask)));
        assert_eq!([a, b, c, d], [180_000; 4]);
    }

    #[test]
    fn tasks_of_one_pool_that_ask_for_it_unpacked_at_once_do_not_wait_for_themselves() {
        let tree = MeshTree::of(&sheet(300), &|_| true).expect("a tree");
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
        let ask = || tree.unpacked().map(Unpacked::bytes);
        let ((a, b), (c, d)) = pool.install(|| rayon::join(|| rayon::join(ask, ask), || rayon::join(ask, ask)));
        assert!(a > Some(0) && [b, c, d] == [a; 3]);
    }

    #[test]
    fn a_build_that_is_given_up_ends_at_once_and_another_may_begin() {
        let mesh = sheet(300);
        let said = AtomicUsize::new(0);
        let give_up = |_: f32| said.fetch_add(1, Ordering::Relaxed) == 0;
        assert!(MeshTree::of(&mesh, &give_up).is_none());
        // whoever asks while another is told so may hear it as well
        assert!(said.load(Ordering::Relaxed) <= 3);
        assert_eq!(MeshTree::of(&mesh, &|_| true).expect("a tree").triangles.len(), 180_000);
    }

    #[test]
    fn progress_goes_from_nothing_to_all() {
        let mesh = sheet(300);
        let heard = Mutex::new(Vec::new());
        let note = |done: f32| {
            heard.lock().expect("a list").push(done);
            true
        };
        let _tree = MeshTree::of(&mesh, &note).expect("a tree");
        let heard = heard.into_inner().expect("a list");
        let most = heard.iter().copied().fold(0.0, f32::max);
        assert_eq!((heard[0], most), (0.0, 1.0));
        assert!(heard.len() > 6, "{heard:?}");
    }

    #[test]
    fn a_scene_that_is_made_ready_finds_the_trees_that_were_asked_for() {
        let mut scene = builtin::named("cornell").expect("built in");
        let material = scene.materials.iter().position(|material| !material.shines()).expect("a wall");
        let (one, other) = (sheet(100), sheet(60));
        let shape = |mesh: &Arc<Mesh>| Shape { geometry: Geometry::Mesh(mesh.clone()), material };
        scene.shapes = [shape(&one), shape(&other), shape(&one), shape(&sheet(3))].into();
        let last = Mutex::new(0.0);
        let note = |done: f32| {
            let mut last = last.lock().expect("a number");
            *last = done.max(*last);
            true
        };
        let trees = trees_of(&scene, &note).expect("trees");
        assert_eq!((trees.len(), *last.lock().expect("a number")), (2, 1.0));
        let tree = |mesh| MeshTree::of(mesh, &|_| panic!("it is there")).expect("a tree");
        assert!([&one, &other].into_iter().all(|mesh| trees.iter().any(|known| Arc::ptr_eq(known, &tree(mesh)))));
    }
}
