//! Trees as bytes and back, and bytes that are none.

use super::super::mesh_tree::tests::sheet;
use super::*;
use std::collections::HashMap;

/// Keeps bytes in memory, and counts what was damaged.
#[derive(Default)]
struct Memory {
    kept: Mutex<HashMap<String, Vec<u8>>>,
    damaged: Mutex<usize>,
}

impl Shelf for Memory {
    fn fetch(&self, name: &str, most: u64) -> Option<Vec<u8>> {
        self.kept.lock().expect("a table").get(name).filter(|bytes| bytes.len() as u64 <= most).cloned()
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        self.kept.lock().expect("a table").insert(name.to_owned(), bytes.to_vec());
    }

    fn found_damaged(&self, _name: &str) {
        *self.damaged.lock().expect("a number") += 1;
    }
}

impl Memory {
    fn leaked() -> &'static Self {
        Box::leak(Box::default())
    }

    fn bytes(&self) -> Vec<Vec<u8>> {
        self.kept.lock().expect("a table").values().cloned().collect()
    }

    fn damaged(&self) -> usize {
        *self.damaged.lock().expect("a number")
    }
}

/// The tree, and whether it was built.
fn obtained(mesh: &Arc<Mesh>, shelf: &'static Memory) -> (Arc<MeshTree>, bool) {
    let built = Mutex::new(false);
    let note = |_| {
        *built.lock().expect("a word") = true;
        true
    };
    let (tree, to_keep) = fetch_or_build(mesh, Some(shelf), &note).expect("a tree");
    to_keep.into_iter().for_each(ToKeep::put);
    (tree, built.into_inner().expect("a word"))
}

/// A mesh of the fewest triangles whose tree is kept, and another that only looks like it.
fn kept_mesh() -> Arc<Mesh> {
    sheet(256)
}

fn same(one: &MeshTree, other: &MeshTree) -> bool {
    let bytes = |tree: &MeshTree| (bytemuck::cast_slice::<_, u8>(&tree.nodes).to_vec(), tree.triangles.clone());
    bytes(one) == bytes(other) && one.seconds.to_bits() == other.seconds.to_bits()
}

#[test]
fn a_tree_that_was_read_is_the_one_that_was_built_by_every_bit() {
    let (mesh, shelf) = (kept_mesh(), Memory::leaked());
    assert_eq!(mesh.triangles().len(), KEPT_FROM);
    let (built, was_built) = obtained(&mesh, shelf);
    // another mesh of the same content, as another run would have it
    let (read, was_built_again) = obtained(&kept_mesh(), shelf);
    assert_eq!((was_built, was_built_again, shelf.damaged()), (true, false, 0));
    assert!(same(&built, &read));
    assert!(shelf.bytes()[0].len() as u64 <= most_bytes(&mesh));
}

#[test]
fn trees_of_small_meshes_are_not_kept() {
    let shelf = Memory::leaked();
    assert!(obtained(&sheet(255), shelf).1);
    assert!(shelf.bytes().is_empty());
}

#[test]
fn a_mesh_of_other_content_has_another_name() {
    let moved = |mesh: &Mesh, by: f32| {
        let positions = mesh.positions().iter().map(|position| *position + by).collect();
        Mesh::new(positions, mesh.triangles().to_vec())
    };
    let mesh = sheet(8);
    assert_eq!(name_of(&moved(&mesh, 0.0)), name_of(&mesh));
    assert_ne!(name_of(&moved(&mesh, 1.0)), name_of(&mesh));
    assert_eq!(name_of(&mesh).len(), 32);
}

#[test]
fn what_is_cut_or_flipped_is_built_anew_and_put_back() {
    let (mesh, shelf) = (kept_mesh(), Memory::leaked());
    let (built, _) = obtained(&mesh, shelf);
    let (name, whole) = shelf.kept.lock().expect("a table").iter().next().map(|(n, b)| (n.clone(), b.clone())).unwrap();
    let length = whole.len();
    let mut wrong: Vec<Vec<u8>> = [0, 1, 15, 16, HEAD - 1, HEAD, HEAD + 31, HEAD + 32, length / 2, length - 1]
        .map(|end| whole[..end].to_vec())
        .into();
    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        bytes
    };
    wrong
        .extend((0..HEAD).chain([HEAD, length / 3, 2 * length / 3, length - 33, length - 32, length - 1]).map(flipped));
    wrong.push([&whole[..], &[0]].concat());
    for (count, bytes) in wrong.into_iter().enumerate() {
        assert!(tree_from(&mesh, &bytes).is_none(), "case {count}");
    }
    shelf.put(&name, &flipped(length / 2));
    let (again, was_built) = obtained(&mesh, shelf);
    assert_eq!((was_built, shelf.damaged()), (true, 1));
    assert_eq!((&again.triangles, again.nodes.len()), (&built.triangles, built.nodes.len()));
    assert!(same(&again, &obtained(&mesh, shelf).0), "what was put back is read");
}

/// A hash that is right says that the bytes are as they were written, not that they are a tree.
#[test]
fn a_tree_that_names_what_is_not_there_is_refused() {
    let mesh = kept_mesh();
    let (nodes, order) = build(&mesh, &|_| true).expect("a tree");
    let spoiled = |spoil: &dyn Fn(&mut Vec<CwBvhNode>, &mut Vec<u32>)| {
        let (mut nodes, mut order) = (nodes.clone(), order.clone());
        spoil(&mut nodes, &mut order);
        names_what_is_there(&(nodes, order))
    };
    let inner = nodes.iter().skip(1).position(|node| node.imask != 0).map_or(0, |place| place + 1);
    let has_a_leaf = |node: &CwBvhNode| (0..8).any(|slot| !node.is_child_empty(slot) && node.is_leaf(slot));
    let of_leaves = nodes.iter().position(has_a_leaf).expect("a node with a leaf");
    assert!(spoiled(&|_, _| ()));
    assert!(!spoiled(&|_, order| order[5] = order[6]), "a triangle twice");
    assert!(!spoiled(&|_, order| order[5] = u32::MAX), "no such triangle");
    assert!(!spoiled(&|nodes, _| nodes.clear()), "no root");
    assert!(!spoiled(&|nodes, _| nodes[inner].child_base_idx = u32::MAX - 1), "no such node");
    assert!(!spoiled(&|nodes, _| nodes[inner].child_base_idx = inner as u32), "its own child");
    assert!(!spoiled(&|nodes, _| nodes[inner].child_base_idx = nodes[0].child_base_idx), "another's child");
    assert!(!spoiled(&|nodes, _| nodes.push(CwBvhNode::default())), "nobody's child");
    assert!(!spoiled(&|nodes, _| nodes[of_leaves].primitive_base_idx = u32::MAX - 2), "no such leaf");
}

#[test]
fn the_builder_that_names_say_is_the_one_that_builds() {
    let lock = include_str!("../../../../Cargo.lock");
    let (name, version) = BUILDER.split_once(' ').expect("a name and a version");
    let package = format!("name = \"{name}\"\nversion = \"{version}\"\n");
    assert!(lock.replace("\r\n", "\n").contains(&package), "{BUILDER}: raise the number in MARK where trees change");
}
