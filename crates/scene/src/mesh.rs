//! Triangles with shared corners, and a mesh put into the world several times.

use crate::canonical;
use crate::runs::runs_of;
use glam::{Affine3A, Vec2, Vec3, Vec3A};
use std::sync::{Arc, OnceLock};

/// Triangles with shared corners; geometric normals follow the winding (counter-clockwise seen from outside). Never
/// changed once it is made: what was derived from it holds for as long as it is there.
#[derive(Debug)]
pub struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    bounds: (Vec3, Vec3),
    content: OnceLock<u128>,
    runs: OnceLock<Box<[(Vec3, Vec3)]>>,
}

impl Mesh {
    /// Triangles from which on a mesh has a tree of its own: rays go into its space, and it is never taken apart into
    /// triangles of the world.
    pub const LARGE: usize = 4096;

    /// Most triangles of all small meshes that are put into one scene by maps, each as often as it stands there: they are
    /// taken apart into triangles of the world, some 600 bytes each.
    pub const MOST_COPIED: u64 = 1 << 22;

    /// Of corners, and of three indices into them for each triangle. Flat: without normals and texture coordinates.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        Mesh::with_attributes(positions, triangles, Vec::new(), Vec::new())
    }

    /// As [`Mesh::new`], with a unit shading normal and a place in textures at each position. Either list may be empty,
    /// and has else as many elements as there are positions; a list of another length is left out.
    pub fn with_attributes(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>, normals: Vec<Vec3>, uvs: Vec<Vec2>) -> Self {
        let bounds = bounds_of(&positions);
        let normals = if normals.len() == positions.len() { normals } else { Vec::new() };
        let uvs = if uvs.len() == positions.len() { uvs } else { Vec::new() };
        Mesh { positions, triangles, normals, uvs, bounds, content: OnceLock::new(), runs: OnceLock::new() }
    }

    /// Corners in the mesh's own space, in the order in which triangles name them.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Three indices into [`Mesh::positions`] for each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Unit shading normals, one a position; empty where triangles are shaded as flat as they are.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Places in textures, one a position, (0, 0) at the picture's upper left corner; empty if there are none.
    pub fn uvs(&self) -> &[Vec2] {
        &self.uvs
    }

    /// Smallest axis-parallel box: (lower corner, upper corner).
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.bounds
    }

    /// Whether it has so many triangles that it keeps a tree of its own.
    pub fn is_large(&self) -> bool {
        self.triangles.len() >= Mesh::LARGE
    }

    /// Smallest boxes around [`RUN`](crate::runs::RUN) triangles each, in their order; made once.
    pub fn runs(&self) -> &[(Vec3, Vec3)] {
        self.runs.get_or_init(|| runs_of(self))
    }

    /// A hash of all that it holds, made once: meshes with the same are the same to every technique.
    pub fn content(&self) -> u128 {
        *self.content.get_or_init(|| canonical::hash(|canonical| canonical.mesh(self)))
    }
}

impl PartialEq for Mesh {
    /// One mesh is equal to itself without a look at its corners, and so are two whose hashes are known.
    fn eq(&self, other: &Mesh) -> bool {
        if let (Some(one), Some(another)) = (self.content.get(), other.content.get()) {
            return one == another;
        }
        std::ptr::eq(self, other)
            || (self.positions == other.positions
                && self.triangles == other.triangles
                && self.normals == other.normals
                && self.uvs == other.uvs)
    }
}

/// A mesh, put somewhere: several share its corners and its tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    /// The triangles, in their own space.
    pub mesh: Arc<Mesh>,
    /// From the mesh's space to the world's: any map that can be undone. One that mirrors turns the winding over, and
    /// what was outside stays outside.
    pub to_world: Affine3A,
}

impl Instance {
    /// Smallest axis-parallel box in the world that holds the mesh's own box.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        in_world(&self.to_world, self.mesh.bounds())
    }

    /// Whether it turns the winding over.
    pub fn mirrors(&self) -> bool {
        self.to_world.matrix3.determinant() < 0.0
    }

    /// The corners in the world, rounded once.
    pub fn positions(&self) -> Vec<Vec3> {
        let to_world = self.to_world.as_daffine3();
        self.mesh.positions().iter().map(|p| to_world.transform_point3(p.as_dvec3()).as_vec3()).collect()
    }

    /// The triangles, wound so that outwards is outwards in the world.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let mirrors = self.mirrors();
        let turned = |&[a, b, c]: &[u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
        self.mesh.triangles().iter().map(turned).collect()
    }

    /// The mesh in the world's space, with its normals and places in textures.
    pub fn baked(&self) -> Mesh {
        let turned = self.to_world.as_daffine3().matrix3.inverse().transpose();
        let normal = |n: &Vec3| (turned * n.as_dvec3()).normalize_or_zero().as_vec3();
        let normals = self.mesh.normals().iter().map(normal).collect();
        Mesh::with_attributes(self.positions(), self.triangles(), normals, self.mesh.uvs().to_vec())
    }
}

/// Smallest axis-parallel box in the world that holds a box in a space that `to_world` puts there.
pub fn in_world(to_world: &Affine3A, (lo, hi): (Vec3, Vec3)) -> (Vec3, Vec3) {
    if lo.cmpgt(hi).any() {
        return (lo, hi);
    }
    let middle = to_world.transform_point3(0.5 * (lo + hi));
    let half = Vec3A::from(0.5 * (hi - lo));
    let m = to_world.matrix3;
    let reach = Vec3::from(m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z);
    (middle - reach, middle + reach)
}

pub(crate) fn bounds_of(positions: &[Vec3]) -> (Vec3, Vec3) {
    positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    fn triangle() -> Arc<Mesh> {
        let normals = vec![Vec3::Z; 3];
        let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::Y];
        Arc::new(Mesh::with_attributes(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]], normals, uvs))
    }

    fn outwards(mesh: &Mesh) -> Vec3 {
        let [a, b, c] = mesh.triangles()[0].map(|i| mesh.positions()[i as usize]);
        (b - a).cross(c - a).normalize()
    }

    #[test]
    fn a_mirrored_instance_keeps_its_outside_outside() {
        let to_world = Affine3A::from_scale_rotation_translation(Vec3::new(-2.0, 1.0, 1.0), Quat::IDENTITY, Vec3::Y);
        let baked = Instance { mesh: triangle(), to_world }.baked();
        assert_eq!(outwards(&baked), Vec3::Z);
        assert_eq!(baked.normals()[0], Vec3::Z);
        assert_eq!(baked.positions()[1], Vec3::new(-2.0, 1.0, 0.0));
    }

    #[test]
    fn normals_of_a_squeezed_instance_stay_across_its_surface() {
        let turn = Quat::from_rotation_x(0.7);
        let squeezed = Affine3A::from_scale(Vec3::new(1.0, 3.0, 0.2));
        let to_world = squeezed * Affine3A::from_quat(turn);
        let baked = Instance { mesh: triangle(), to_world }.baked();
        assert!(outwards(&baked).dot(baked.normals()[1]) > 0.99999);
    }

    #[test]
    fn an_instances_box_holds_its_corners() {
        let to_world = Affine3A::from_scale_rotation_translation(
            Vec3::new(2.0, -1.0, 0.5),
            Quat::from_rotation_y(1.1),
            Vec3::new(3.0, 0.0, -7.0),
        );
        let instance = Instance { mesh: triangle(), to_world };
        let (lo, hi) = instance.bounds();
        assert!(instance.positions().iter().all(|p| (p + 1e-5).cmpge(lo).all() && (p - 1e-5).cmple(hi).all()));
    }

    #[test]
    fn runs_hold_their_triangles() {
        let corner = |i: u32| Vec3::new(i as f32, (i % 7) as f32, 0.0);
        let triangles: Vec<_> = (0..1500).map(|i| [i, i + 1, i + 2]).collect();
        let mesh = Mesh::new((0..1502).map(corner).collect(), triangles);
        assert_eq!(mesh.runs().len(), 3);
        assert_eq!(mesh.runs()[1], (Vec3::new(512.0, 0.0, 0.0), Vec3::new(1025.0, 6.0, 0.0)));
        assert_eq!(mesh.runs()[2].1.x, 1501.0);
    }

    #[test]
    fn attributes_count_in_what_a_mesh_is() {
        let (flat, smooth) = (Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]), triangle());
        assert_ne!(flat.content(), smooth.content());
        assert_ne!(flat, *smooth);
        assert_eq!(smooth.content(), triangle().content());
    }
}
