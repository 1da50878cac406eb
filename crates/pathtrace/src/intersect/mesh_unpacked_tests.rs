//! Unpacked trees of meshes: as full as those of small shapes, and the same hits as the compressed trees where these are
//! odd. What they meet of usual ones is in [`super::instance_tests`].

use super::Ray;
use super::instance_tests::statue_mesh;
use super::mesh_tree::MeshTree;
use super::mesh_walk::ClosestOf;
use crate::sampling;
use crate::sampling::sampler::Sampler;
use scene::{Mesh, Vec3};
use simd::{Lanes, RowLanes};
use std::sync::Arc;

fn tree_of(corners: Vec<[Vec3; 3]>) -> Arc<MeshTree> {
    let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = Arc::new(Mesh::new(corners.into_iter().flatten().collect(), triangles));
    MeshTree::of(&mesh, &|_| true).expect("a tree")
}

/// Of so many rays at somewhere in a triangle of the mesh, from up to `far` away: for how many both trees find
/// something else, and how many find anything.
fn differing(tree: &MeshTree, far: f32, rays: u32) -> (usize, usize) {
    let unpacked = tree.unpacked().expect("it is not deep");
    let lanes = RowLanes::nearest_to(Lanes::best());
    let (mut differing, mut met) = (0, 0);
    for i in 0..rays {
        let [x, y, z, w] = Sampler::independent(i, 1, 5).unit4(0);
        let [a, b, ..] = Sampler::independent(i, 2, 5).unit4(0);
        let triangle = tree.triangles[(x * tree.triangles.len() as f32) as usize];
        let [p, q, r] = triangle.map(|corner| tree.mesh.positions()[corner as usize]);
        let at = p + (q - p) * y * w + (r - p) * z * (1.0 - w);
        let direction = sampling::cone(2.0, [a, b]);
        let ray = &Ray::new(at - direction * far * w, direction);
        let corners = |place: u32| tree.triangles[place as usize].map(|corner| tree.mesh.positions()[corner as usize]);
        let packed = lanes.run(ClosestOf { tree, ray });
        let packed = packed.map(|hit| (hit.t, hit.triangle, hit.barycentrics(), corners(hit.triangle)));
        let hit = unpacked.closest(ray);
        let hit = hit.map(|hit| (hit.t, unpacked.place(&hit) as u32, hit.barycentrics, unpacked.corners(&hit)));
        differing += usize::from(packed != hit || packed.is_some() != unpacked.occluded(ray));
        met += usize::from(hit.is_some());
    }
    (differing, met)
}

fn tree_of_statue(level: u32) -> Arc<MeshTree> {
    MeshTree::of(&statue_mesh(level), &|_| true).expect("a tree")
}

#[test]
fn leaves_hold_three_of_four_triangles_and_a_triangle_takes_a_hundred_bytes() {
    let tree = tree_of_statue(6);
    let unpacked = tree.unpacked().expect("it is not deep");
    let [nodes, leaves] = unpacked.blocks();
    let triangles = tree.triangles.len() as f64;
    let (in_leaf, in_node) = (triangles / leaves as f64, (nodes + leaves - 1) as f64 / nodes as f64);
    let bytes = unpacked.bytes() as f64 / triangles;
    assert!(in_leaf > 3.0 && in_node > 5.5, "{in_leaf} of 4 and {in_node} of 8");
    assert!(bytes < 105.0, "{bytes}");
}

#[test]
fn what_is_put_together_of_many_parts_is_met_as_in_the_compressed_tree() {
    let (differing, met) = differing(&tree_of_statue(7), 1.0, 20_000);
    assert!(differing == 0 && met > 19_000, "{differing}, {met}");
}

#[test]
fn triangles_in_one_place_or_of_all_sizes_are_met_as_in_the_compressed_tree() {
    let one_place = tree_of(vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 9000]);
    assert_eq!(differing(&one_place, 1.0, 500), (0, 500));
    let corners = |i: i32| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| (p + 1.0) * 0.96f32.powi(i));
    assert_eq!(differing(&tree_of((0..2000).map(corners).collect()), 1e-3, 5000).0, 0);
    let flat = |i: i32| [Vec3::ZERO, Vec3::X, 2.0 * Vec3::X].map(|p| p + Vec3::Y * i as f32);
    assert_eq!(differing(&tree_of((0..5000).map(flat).collect()), 1.0, 5000).0, 0);
}

#[test]
fn few_triangles_make_an_unpacked_tree() {
    for count in [1, 2, 3, 4, 5, 9, 33] {
        let corners = |i: i32| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + Vec3::Z * (i * i) as f32);
        let (differing, met) = differing(&tree_of((0..count).map(corners).collect()), 1.0, 2000);
        assert!(differing == 0 && met > 1900, "{count}: {differing}, {met}");
    }
}
