//! Trees that are there or being built, so that a mesh's tree is made once however many ask for it at once.
//!
//! It is built on threads of its own, not on those that ask: who no longer waits is free at once. A build that nobody
//! waits for goes on for [`GRACE`], for a camera that moves asks for the same again; without its mesh it ends at once.

use super::mesh_build::Progress;
use super::mesh_kept::{self, ToKeep};
use super::mesh_tree::MeshTree;
use scene::Mesh;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

/// How often who waits for a tree asks whether to go on, where nothing is new.
const PATIENCE: Duration = Duration::from_millis(20);

/// How long a build goes on, and what was built is there, for nobody.
const GRACE: Duration = Duration::from_millis(500);

/// A mesh that was asked for, and its tree.
struct Known {
    /// Tells this build from all others of the program.
    number: u64,
    mesh: Weak<Mesh>,
    state: State,
    /// How many wait for it.
    waiting: usize,
    /// When the last one that waited went.
    left: Instant,
}

enum State {
    /// Which share is done.
    Building(f32),
    /// Done, and held until the last one that waits has it.
    Built(Arc<MeshTree>),
    /// There as long as somebody has it.
    Shared(Weak<MeshTree>),
}

/// Meshes whose trees are there, or being built.
static KNOWN: Mutex<Table> = Mutex::new(Table { builds: 0, all: Vec::new() });
/// More of a tree is done, or somebody has gone.
static CHANGED: Condvar = Condvar::new();

struct Table {
    builds: u64,
    all: Vec<Known>,
}

/// The mesh's tree, as [`MeshTree::of`] has it.
pub(super) fn tree_of(mesh: &Arc<Mesh>, progress: Progress) -> Option<Arc<MeshTree>> {
    let waiter = match ask(mesh) {
        Ok(tree) => return Some(tree),
        Err(waiter) => waiter,
    };
    let mut told = None;
    loop {
        match waiter.look(told) {
            Look::Taken(tree) => return progress(1.0).then_some(tree),
            Look::Building(done) if !progress(done) => return None,
            Look::Building(done) => told = Some(done),
            // its thread has told why
            Look::Failed => resume_unwind(Box::new("a mesh's tree could not be built")),
        }
    }
}

/// Someone who waits for a tree.
struct Waiter(u64);

enum Look {
    Taken(Arc<MeshTree>),
    Building(f32),
    Failed,
}

/// The tree if it is there, else a place among those who wait for it; the first of them has it built.
fn ask(mesh: &Arc<Mesh>) -> Result<Arc<MeshTree>, Waiter> {
    let mut known = known();
    known.all.retain(|known| known.mesh.strong_count() > 0);
    let own = known.all.iter_mut().find(|known| known.mesh.as_ptr() == Arc::as_ptr(mesh));
    match own {
        Some(Known { state: State::Built(tree), .. }) => return Ok(tree.clone()),
        Some(own @ Known { state: State::Building(_), .. }) => {
            own.waiting += 1;
            return Err(Waiter(own.number));
        }
        Some(Known { state: State::Shared(tree), .. }) => {
            if let Some(tree) = tree.upgrade() {
                return Ok(tree);
            }
        }
        None => {}
    }
    known.all.retain(|known| known.mesh.as_ptr() != Arc::as_ptr(mesh));
    known.builds += 1;
    let number = known.builds;
    let (state, left) = (State::Building(0.0), Instant::now());
    known.all.push(Known { number, mesh: Arc::downgrade(mesh), state, waiting: 1, left });
    drop(known);
    let waiter = Waiter(number);
    begin(number, mesh);
    Err(waiter)
}

impl Waiter {
    /// How it stands, once that is something else than what was told, or after a while.
    fn look(&self, told: Option<f32>) -> Look {
        let mut known = known();
        if known.share(self.0).is_some_and(|done| Some(done) == told) {
            (known, _) = CHANGED.wait_timeout(known, PATIENCE).unwrap_or_else(PoisonError::into_inner);
        }
        let Some(own) = known.find(self.0) else { return Look::Failed };
        let tree = match &own.state {
            State::Building(done) => return Look::Building(*done),
            State::Built(tree) => tree.clone(),
            State::Shared(_) => return Look::Failed,
        };
        if own.waiting == 1 {
            own.state = State::Shared(Arc::downgrade(&tree));
        }
        Look::Taken(tree)
    }
}

impl Drop for Waiter {
    fn drop(&mut self) {
        if let Some(own) = known().find(self.0) {
            own.waiting -= 1;
            own.left = Instant::now();
        }
        CHANGED.notify_all();
    }
}

impl Table {
    fn find(&mut self, number: u64) -> Option<&mut Known> {
        self.all.iter_mut().find(|known| known.number == number)
    }

    fn share(&mut self, number: u64) -> Option<f32> {
        match self.find(number)?.state {
            State::Building(done) => Some(done),
            State::Built(_) | State::Shared(_) => None,
        }
    }

    fn forget(&mut self, number: u64) {
        self.all.retain(|known| known.number != number);
    }
}

impl Known {
    /// Whether somebody waits, or may come again.
    fn is_wanted(&self) -> bool {
        // the build itself holds it too
        self.waiting > 0 || (self.mesh.strong_count() > 1 && self.left.elapsed() < GRACE)
    }
}

fn known() -> MutexGuard<'static, Table> {
    // it holds whole entries at any time
    KNOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Builds on a pool of as many threads as the one at hand. On that pool itself the build might take up, while it waits for
/// its parts, another's task that waits for the very tree.
fn begin(number: u64, mesh: &Arc<Mesh>) {
    let threads = rayon::current_num_threads();
    let own = mesh.clone();
    let begun = std::thread::Builder::new().name("mesh tree".into()).spawn(move || {
        make(number, own, threads);
        linger(number);
    });
    if begun.is_err() {
        make(number, mesh.clone(), 1);
    }
}

fn make(number: u64, mesh: Arc<Mesh>, threads: usize) {
    let progress = |done: f32| goes_on(number, done);
    let work = || mesh_kept::fetch_or_build(&mesh, mesh_kept::shelf(), &progress);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let made = catch_unwind(AssertUnwindSafe(|| match &pool {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }));
    drop(pool);
    // nothing of the mesh is held beyond the tree
    drop(mesh);
    let Ok(Some((tree, to_keep))) = made else {
        known().forget(number);
        CHANGED.notify_all();
        return;
    };
    if let Some(own) = known().find(number) {
        own.state = State::Built(tree);
    }
    CHANGED.notify_all();
    // nobody waits for that
    to_keep.into_iter().for_each(ToKeep::put);
}

/// Notes which share is done; whether to go on. Once it was told to stop a build is not known any more.
fn goes_on(number: u64, done: f32) -> bool {
    let mut known = known();
    let Some(own) = known.find(number) else { return false };
    let is_wanted = own.is_wanted();
    // threads tell it in any order
    if let State::Building(before) = &mut own.state {
        *before = done.max(*before);
    }
    if !is_wanted {
        known.forget(number);
    }
    drop(known);
    CHANGED.notify_all();
    is_wanted
}

/// Holds what was built until everybody has it who waits, and for a while if nobody does.
fn linger(number: u64) {
    let mut known = known();
    loop {
        let Some(own) = known.find(number) else { return };
        let State::Built(tree) = &own.state else { return };
        if own.waiting == 0 && own.left.elapsed() >= GRACE {
            let tree = tree.clone();
            own.state = State::Shared(Arc::downgrade(&tree));
            drop(known);
            return;
        }
        (known, _) = CHANGED.wait_timeout(known, PATIENCE).unwrap_or_else(PoisonError::into_inner);
    }
}

#[cfg(test)]
#[path = "mesh_known_tests.rs"]
mod tests;
