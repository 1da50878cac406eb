//! Builds that somebody waits for, and builds that nobody does.

use super::super::mesh_tree::tests::sheet;
use super::*;

#[test]
fn who_no_longer_waits_is_free_at_once_and_the_next_goes_on_with_the_same_build() {
    let mesh = sheet(600);
    let reached = Mutex::new(0.0);
    let give_up = |done: f32| {
        *reached.lock().expect("a number") = done;
        done == 0.0
    };
    assert!(tree_of(&mesh, &give_up).is_none());
    let reached = reached.into_inner().expect("a number");
    assert!(reached > 0.0 && reached < 1.0, "{reached}");
    let first = Mutex::new(None);
    let note = |done: f32| {
        first.lock().expect("a number").get_or_insert(done);
        true
    };
    assert_eq!(tree_of(&mesh, &note).expect("a tree").triangles.len(), 720_000);
    assert!(first.into_inner().expect("a number") >= Some(reached));
}

#[test]
fn a_build_ends_with_its_mesh() {
    let mesh = sheet(600);
    assert!(tree_of(&mesh, &|_| false).is_none());
    let weak = Arc::downgrade(&mesh);
    drop(mesh);
    let begun = Instant::now();
    while weak.strong_count() > 0 {
        assert!(begun.elapsed() < Duration::from_secs(60));
        std::thread::yield_now();
    }
}

#[test]
fn what_was_built_for_nobody_is_let_go() {
    let mesh = sheet(100);
    assert!(tree_of(&mesh, &|_| false).is_none());
    let begun = Instant::now();
    // the mesh stays, its tree does not
    while Arc::strong_count(&mesh) > 1 {
        assert!(begun.elapsed() < Duration::from_secs(60));
        std::thread::yield_now();
    }
    assert_eq!(tree_of(&mesh, &|_| true).expect("a tree").triangles.len(), 20_000);
}
