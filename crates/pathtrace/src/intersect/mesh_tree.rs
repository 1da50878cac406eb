//! The tree of one large mesh, in the mesh's own space: eight boxes a node, kept in a byte a plane (Ylitie, Karras and
//! Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017). Both machines walk the
//! same arrays: 80 bytes a node, three indices a triangle in the order of the leaves, and the mesh's own positions.
//!
//! Twin: `shaders/pathtrace/intersect/cwbvh.wgsl`, which walks it.

use obvhs::Boundable;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::cwbvh::node::CwBvhNode;
use scene::glam::Vec3A;
use scene::{Mesh, Vec3};
use std::sync::Arc;
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
}

/// A triangle's padded box.
struct Boxed(Vec3, Vec3);

impl Boundable for Boxed {
    fn aabb(&self) -> Aabb {
        Aabb::new(Vec3A::from(self.0), Vec3A::from(self.1))
    }
}

impl MeshTree {
    /// The tree of a mesh.
    pub fn of(mesh: &Arc<Mesh>) -> Arc<Self> {
        Arc::new(MeshTree::new(mesh))
    }

    /// Builds it on all threads.
    pub fn new(mesh: &Arc<Mesh>) -> Self {
        let (lo, hi) = mesh.bounds();
        // as `primitive::padding`
        let largest = lo.abs().max(hi.abs()).max_element();
        let padding = Vec3::splat((largest + (hi - lo).max_element()) / 1_048_576.0);
        let boxed = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| mesh.positions()[corner as usize]);
            Boxed(a.min(b).min(c) - padding, a.max(b).max(c) + padding)
        };
        let boxes: Vec<Boxed> = mesh.triangles().iter().map(boxed).collect();
        let mut took = Duration::ZERO;
        let tree = build_cwbvh(&boxes, BvhBuildParams::medium_build(), &mut took);
        let triangles = tree.primitive_indices.iter().map(|&index| mesh.triangles()[index as usize]).collect();
        MeshTree { mesh: mesh.clone(), nodes: tree.nodes, triangles }
    }
}
