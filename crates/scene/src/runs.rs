//! Boxes around runs of a mesh's triangles, for whoever must not look at all of them.

use crate::mesh::Mesh;
use glam::Vec3;

/// Triangles in a run. What made the mesh puts neighbours after each other, so that a run is a small part of it.
pub const RUN: usize = 512;

/// Smallest boxes around each run of triangles: (lower corner, upper corner).
pub(crate) fn runs_of(mesh: &Mesh) -> Box<[(Vec3, Vec3)]> {
    let corners = |run: &[[u32; 3]]| {
        let corners = run.iter().flatten().map(|corner| mesh.positions()[*corner as usize]);
        corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    };
    mesh.triangles().chunks(RUN).map(corners).collect()
}
