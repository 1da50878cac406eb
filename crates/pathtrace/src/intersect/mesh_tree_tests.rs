//! One tree a mesh, whoever asks for it.

use super::*;
use scene::{Geometry, Shape, Vec3, builtin};
use std::sync::Barrier;
use std::sync::Mutex;

/// A flat mesh of so many squares each way.
pub fn sheet(n: u32) -> Arc<Mesh> {
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

#[test]
fn tasks_of_one_pool_that_ask_for_it_unpacked_at_once_do_not_wait_for_themselves() {
    let tree = MeshTree::of(&sheet(300), &|_| true).expect("a tree");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
    let ask = || tree.unpacked().map(Unpacked::bytes);
    let ((a, b), (c, d)) = pool.install(|| rayon::join(|| rayon::join(ask, ask), || rayon::join(ask, ask)));
    assert!(a > Some(0) && [b, c, d] == [a; 3]);
}
