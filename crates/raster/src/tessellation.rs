//! Triangles: spheres as three.js' SphereGeometry cuts them, with smooth normals; meshes with the normals that they have;
//! everything else flat, as it is.

use scene::glam::{Affine3A, Vec2};
use scene::runs::RUN;
use scene::{Geometry, Mesh, Vec3};
use std::borrow::Cow;
use std::f32::consts::{PI, TAU};
use std::ops::Range;

/// Corners of triangles, one list for each of the shaders' vertex inputs, and three of them for each triangle.
#[derive(Debug, Default)]
pub struct Corners {
    pub positions: Vec<Vec3>,
    /// Unit, outwards; zero of a triangle without area.
    pub normals: Vec<Vec3>,
    /// Places in pictures; (0, 0) of what has none.
    pub uvs: Vec<Vec2>,
    pub indices: Vec<u32>,
}

impl Corners {
    /// The indices that `add` adds.
    pub fn added(&mut self, add: impl FnOnce(&mut Corners)) -> Range<u32> {
        let start = self.indices.len() as u32;
        add(self);
        start..self.indices.len() as u32
    }

    fn push(&mut self, position: Vec3, normal: Vec3, uv: Vec2) {
        self.positions.push(position);
        self.normals.push(normal);
        self.uvs.push(uv);
    }

    fn next(&self) -> u32 {
        self.positions.len() as u32
    }
}

/// Rows from the north pole; the first and the last have one triangle a segment, the others two.
pub fn add_sphere(corners: &mut Corners, center: Vec3, radius: f32, segments: u32) {
    let first = corners.next();
    for row in 0..=segments {
        let theta = PI * row as f32 / segments as f32;
        for column in 0..=segments {
            let phi = TAU * column as f32 / segments as f32;
            let normal = Vec3::new(-phi.cos() * theta.sin(), theta.cos(), phi.sin() * theta.sin());
            corners.push(center + radius * normal, normal.normalize(), Vec2::ZERO);
        }
    }
    let at = |row: u32, column: u32| first + row * (segments + 1) + column;
    for row in 0..segments {
        for column in 0..segments {
            let [a, b] = [at(row, column + 1), at(row, column)];
            let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
            if row > 0 {
                corners.indices.extend([a, b, d]);
            }
            if row + 1 < segments {
                corners.indices.extend([b, c, d]);
            }
        }
    }
}

/// A shape without corners that triangles share.
pub fn add_flat(corners: &mut Corners, geometry: &Geometry) {
    let (positions, triangles) = geometry.flat_triangles();
    add_flat_triangles(corners, &positions, &triangles, &[]);
}

fn add_flat_triangles(corners: &mut Corners, positions: &[Vec3], triangles: &[[u32; 3]], uvs: &[Vec2]) {
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        let normal = unit_normal(b - a, c - a);
        for (position, corner) in [a, b, c].into_iter().zip(triangle) {
            corners.indices.push(corners.next());
            corners.push(position, normal, uvs.get(*corner as usize).copied().unwrap_or_default());
        }
    }
}

/// A mesh in its own space.
pub fn add_mesh(corners: &mut Corners, mesh: &Mesh) {
    let normals = filled_normals(mesh);
    if normals.is_empty() {
        return add_flat_triangles(corners, mesh.positions(), mesh.triangles(), mesh.uvs());
    }
    let first = corners.next();
    let uvs = mesh.uvs().iter().copied().chain(std::iter::repeat(Vec2::ZERO));
    for ((position, normal), uv) in mesh.positions().iter().zip(&*normals).zip(uvs) {
        corners.push(*position, *normal, uv);
    }
    corners.indices.extend(mesh.triangles().iter().flatten().map(|corner| first + corner));
}

/// The normals of a mesh, none if it has none; where one has no length, that of a triangle which has the corner.
pub fn filled_normals(mesh: &Mesh) -> Cow<'_, [Vec3]> {
    let missing = |normal: &Vec3| *normal == Vec3::ZERO || !normal.is_finite();
    if !mesh.normals().iter().any(missing) {
        return mesh.normals().into();
    }
    let mut normals = mesh.normals().to_vec();
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|corner| mesh.positions()[corner as usize]);
        for corner in triangle.map(|corner| corner as usize) {
            if missing(&normals[corner]) {
                normals[corner] = unit_normal(b - a, c - a);
            }
        }
    }
    normals.into()
}

/// Unit normal of what two edges span; zero if that is nothing. In `f64`, where squares of lengths of any scale still
/// fit.
pub(crate) fn unit_normal(edge_u: Vec3, edge_v: Vec3) -> Vec3 {
    edge_u.as_dvec3().cross(edge_v.as_dvec3()).normalize_or_zero().as_vec3()
}

/// What `of` finds in the triangles that are drawn of a shape. Those of a mesh are looked at where they are.
pub(crate) fn triangles_of<T>(
    geometry: &Geometry,
    segments: u32,
    of: impl FnOnce(&mut dyn Iterator<Item = [Vec3; 3]>) -> T,
) -> T {
    if let Geometry::Sphere { center, radius } = geometry {
        let mut corners = Corners::default();
        add_sphere(&mut corners, *center, *radius, segments.max(3));
        let at = |index: u32| corners.positions[index as usize];
        return of(&mut corners.indices.as_chunks().0.iter().map(|&[a, b, c]| [at(a), at(b), at(c)]));
    }
    let (positions, triangles) = geometry.flat_triangles();
    of(&mut triangles.iter().map(|triangle| triangle.map(|corner| positions[corner as usize])))
}

/// The mesh of a shape that is large, and what puts it into the world.
pub(crate) fn large_mesh(geometry: &Geometry) -> Option<(&Mesh, Affine3A)> {
    let found = match geometry {
        Geometry::Mesh(mesh) => (&**mesh, Affine3A::IDENTITY),
        Geometry::Instance(instance) => (&*instance.mesh, instance.to_world),
        _ => return None,
    };
    found.0.is_large().then_some(found)
}

/// Runs of a large mesh: the box around each in the world, and its triangles there. Whoever looks at all triangles looks at
/// millions in each frame.
pub(crate) fn runs_of<'a>(
    (mesh, to_world): (&'a Mesh, Affine3A),
) -> impl Iterator<Item = ((Vec3, Vec3), impl Iterator<Item = [Vec3; 3]> + 'a)> {
    mesh.runs().iter().zip(mesh.triangles().chunks(RUN)).map(move |(bounds, triangles)| {
        let in_place = move |corner: u32| to_world.transform_point3(mesh.positions()[corner as usize]);
        (scene::in_world(&to_world, *bounds), triangles.iter().map(move |triangle| triangle.map(in_place)))
    })
}

/// The corners of a box.
pub(crate) fn corners((low, high): (Vec3, Vec3)) -> [Vec3; 8] {
    std::array::from_fn(|i| {
        let pick = |bit: usize, low: f32, high: f32| if i >> bit & 1 == 0 { low } else { high };
        Vec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_is_closed_round_and_wound_outwards() {
        let mut corners = Corners::default();
        let center = Vec3::new(1.0, 2.0, 3.0);
        add_sphere(&mut corners, center, 2.0, 100);
        assert_eq!(corners.indices.len(), 3 * (2 * 100 * 100 - 2 * 100));
        let mut area = 0.0;
        for triangle in corners.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| corners.positions[triangle[i] as usize]);
            let normal = (b - a).cross(c - a);
            assert!(normal.dot(a - center) > 0.0);
            area += 0.5 * normal.length();
        }
        assert!((area / (16.0 * PI) - 1.0).abs() < 2e-3);
    }
}
