//! What meshes say of their surfaces beside where they lie: shading normals and places in textures, which a hit has as
//! the mean of its triangle's corners by the barycentrics.
//!
//! Entries of all meshes lie in one list, behind one of zeros for surfaces that say nothing. A triangle's row names three
//! of them; structures have their rows in the order of their ids.
//!
//! Twin: `shaders/pathtrace/intersect/attributes.wgsl`.

use super::baking::is_instanced;
use super::instances::MeshPoint;
use super::primitive::area_lights_first;
use super::triangle::{in_order, triangle_normal};
use crate::vectors::{VectorColumn, of_lanes};
use scene::glam::Vec2;
use scene::{Geometry, Mesh, Scene, Vec3};
use simd::{Column, Float, MOST_LANES, Vector, Word, WordColumn};
use std::sync::Arc;

/// Normals and places in textures of a scene's meshes.
#[derive(Debug)]
pub(crate) struct MeshAttributes {
    /// Of each shape the entry of its first corner, or 0 if it has none.
    first_of_shape: Vec<u32>,
    /// Unit, world space; zero where there are none.
    pub normals: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    /// Whether any normal map asks for tangents.
    pub has_normal_maps: bool,
}

/// What a triangle has of the attributes of its corners.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct TriangleRow {
    /// Entries of the corners.
    pub corners: [u32; 3],
    /// Direction in which u grows; zero where nothing says it.
    pub tangent: Vec3,
    /// By which the normal's cross product with the tangent is multiplied to point against v, 1 or -1.
    pub handedness: f32,
}

impl MeshAttributes {
    /// Those of a scene that asks for any.
    pub fn of(scene: &Scene) -> Option<Self> {
        let needs = scene.needs();
        (needs.shading_normals || needs.image_textures || needs.alpha_masks).then(|| Self::new(scene))
    }

    fn new(scene: &Scene) -> Self {
        let has_normal_maps = scene.shapes.iter().any(|shape| scene.material_of(shape).surface.normal_map.is_some());
        let (normals, uvs) = (vec![Vec3::ZERO], vec![Vec2::ZERO]);
        let mut all = MeshAttributes { first_of_shape: Vec::new(), normals, uvs, has_normal_maps };
        for shape in scene.shapes.iter() {
            // a large mesh keeps its own, see `Instances::attributes`
            if is_instanced(scene, shape) {
                all.first_of_shape.push(0);
                continue;
            }
            let has_any = |mesh: &&Arc<Mesh>| !mesh.normals().is_empty() || !mesh.uvs().is_empty();
            let first = shape.geometry.mesh_of().filter(has_any).map_or(0, |mesh| match &shape.geometry {
                Geometry::Instance(instance) => all.add(&instance.baked()),
                _ => all.add(mesh),
            });
            all.first_of_shape.push(first);
        }
        all
    }

    /// The entry of a mesh's first corner.
    fn add(&mut self, mesh: &Mesh) -> u32 {
        let (first, count) = (self.normals.len(), mesh.positions().len());
        self.normals.extend(mesh.normals());
        self.normals.resize(first + count, Vec3::ZERO);
        self.uvs.extend(mesh.uvs());
        self.uvs.resize(first + count, Vec2::ZERO);
        first as u32
    }

    /// The row of a triangle of a shape, whose corners are given by their indices and their places.
    pub fn row(&self, shape: usize, triangle: [u32; 3], places: [Vec3; 3]) -> TriangleRow {
        let first = self.first_of_shape[shape];
        if first == 0 {
            return TriangleRow::default();
        }
        let corners = triangle.map(|corner| first + corner);
        let (tangent, handedness) = match self.has_normal_maps {
            true => tangent(places, corners.map(|corner| self.uvs[corner as usize])),
            false => (Vec3::ZERO, 1.0),
        };
        TriangleRow { corners, tangent, handedness }
    }
}

impl TriangleRow {
    /// The same with the corners in the order of their places, as triangles of trees have them.
    pub fn sorted(self, places: [Vec3; 3]) -> Self {
        // as `triangle::sorted`
        let places = places.map(|place| place + Vec3::ZERO);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| in_order(&places[a], &places[b]));
        TriangleRow { corners: order.map(|corner| self.corners[corner]), ..self }
    }
}

/// The rows of all that a tree of the scene holds beside large meshes, in the order that
/// decides ties: see [`primitives`](super::primitive::primitives).
pub(crate) fn rows_of_tree(scene: &Scene, attributes: &MeshAttributes) -> Vec<TriangleRow> {
    let mut rows = Vec::new();
    for index in area_lights_first(scene).filter(|index| !is_instanced(scene, &scene.shapes[*index])) {
        let geometry = &scene.shapes[index].geometry;
        if matches!(geometry, Geometry::Sphere { .. } | Geometry::Disk { .. }) {
            rows.push(TriangleRow::default());
            continue;
        }
        let (positions, triangles) = geometry.flat_triangles();
        for triangle in triangles.iter() {
            let places = triangle.map(|corner| positions[corner as usize]);
            if triangle_normal(places).is_some() {
                rows.push(attributes.row(index, *triangle, places).sorted(places));
            }
        }
    }
    rows
}

/// The direction in which u grows on a triangle, and its handedness; no direction where u or v does not grow.
fn tangent([a, b, c]: [Vec3; 3], uvs: [Vec2; 3]) -> (Vec3, f32) {
    let (to_b, to_c) = ((b - a).as_dvec3(), (c - a).as_dvec3());
    let [a, b, c] = uvs.map(|uv| uv.as_dvec2());
    let (b, c) = (b - a, c - a);
    let side = b.perp_dot(c).signum();
    let along_u = (to_b * c.y - to_c * b.y) * side;
    let along_v = (to_c * b.x - to_b * c.x) * side;
    let tangent = if b.perp_dot(c) == 0.0 { None } else { along_u.try_normalize() };
    let across = to_b.cross(to_c).cross(along_u);
    (tangent.map_or(Vec3::ZERO, |tangent| tangent.as_vec3()), if across.dot(along_v) > 0.0 { -1.0 } else { 1.0 })
}

/// Attributes as lanes look them up.
#[derive(Debug)]
pub(crate) struct AttributeColumns {
    normals: VectorColumn,
    uvs: [Column; 2],
    has_normal_maps: bool,
}

/// Rows as lanes look them up, by the number of a triangle.
#[derive(Debug, Default)]
pub(crate) struct RowColumns {
    corners: [WordColumn; 3],
    tangent: VectorColumn,
    handedness: Column,
}

/// What the surfaces in the lanes have of their meshes.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceAttributes<F: Float> {
    /// Not unit; zero where the mesh has none.
    pub normal: Vector<F>,
    /// Where the surface lies in its textures.
    pub uv: [F; 2],
    /// Of a triangle with a place in a normal map; zero of others.
    pub tangent: Vector<F>,
    /// By which the normal's cross product with the tangent is multiplied to point against v.
    pub handedness: F,
}

impl<F: Float> SurfaceAttributes<F> {
    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        SurfaceAttributes {
            normal: Vector::select(mask, yes.normal, no.normal),
            uv: [0, 1].map(|axis| F::select(mask, yes.uv[axis], no.uv[axis])),
            tangent: Vector::select(mask, yes.tangent, no.tangent),
            handedness: F::select(mask, yes.handedness, no.handedness),
        }
    }
}

/// What single lanes have of large meshes, on its way into lanes.
pub(super) struct EachAttributes {
    normal: [Vec3; MOST_LANES],
    uv: [[f32; MOST_LANES]; 2],
    tangent: [Vec3; MOST_LANES],
    handedness: [f32; MOST_LANES],
}

impl EachAttributes {
    /// Of lanes in which nothing is said yet.
    pub fn none() -> Self {
        let (normal, tangent) = ([Vec3::ZERO; MOST_LANES], [Vec3::ZERO; MOST_LANES]);
        EachAttributes { normal, uv: [[0.0; MOST_LANES]; 2], tangent, handedness: [1.0; MOST_LANES] }
    }

    /// What a large mesh says at a point of it, in the world.
    pub fn set(&mut self, lane: usize, at: &MeshPoint) {
        let weights = Vec3::from(at.barycentrics);
        if let Some(normals) = of_corners(at.mesh.normals(), at.corners) {
            let normal = normals[0] * weights.x + normals[1] * weights.y + normals[2] * weights.z;
            self.normal[lane] = (at.normals_to_world * normal.as_dvec3()).normalize_or_zero().as_vec3();
        }
        if let Some(uvs) = of_corners(at.mesh.uvs(), at.corners) {
            let uv = uvs[0] * weights.x + uvs[1] * weights.y + uvs[2] * weights.z;
            (self.uv[0][lane], self.uv[1][lane]) = (uv.x, uv.y);
            let (tangent, handedness) = tangent(at.places(), uvs);
            // the corners are wound as in the mesh, and a mirror turns that over
            self.handedness[lane] = if at.to_world.matrix3.determinant() < 0.0 { -handedness } else { handedness };
            self.tangent[lane] = tangent;
        }
    }

    pub fn in_lanes<F: Float>(&self) -> SurfaceAttributes<F> {
        SurfaceAttributes {
            normal: of_lanes(&self.normal),
            uv: [F::load(&self.uv[0]), F::load(&self.uv[1])],
            tangent: of_lanes(&self.tangent),
            handedness: F::load(&self.handedness),
        }
    }
}

/// Those of three corners of a mesh that has any.
fn of_corners<T: Copy>(all: &[T], corners: [u32; 3]) -> Option<[T; 3]> {
    (!all.is_empty()).then(|| corners.map(|corner| all[corner as usize]))
}

impl AttributeColumns {
    pub fn new(attributes: &MeshAttributes) -> Self {
        AttributeColumns {
            normals: VectorColumn::new(attributes.normals.iter().copied()),
            uvs: [0, 1].map(|axis| Column::new(attributes.uvs.iter().map(|uv| uv[axis]))),
            has_normal_maps: attributes.has_normal_maps,
        }
    }

    /// Of the triangles with these numbers at these barycentrics.
    #[inline(always)]
    pub fn of<F: Float>(&self, rows: &RowColumns, triangle: F::U, barycentrics: [F; 3]) -> SurfaceAttributes<F> {
        let corners = [0, 1, 2].map(|corner| triangle.look_up_word(&rows.corners[corner]));
        let (normal, uv) = self.at(corners, barycentrics);
        let (mut tangent, mut handedness) = (Vector::zero(), F::splat(1.0));
        if self.has_normal_maps {
            (tangent, handedness) = (rows.tangent.look_up(triangle), triangle.look_up(&rows.handedness));
        }
        SurfaceAttributes { normal, uv, tangent, handedness }
    }

    /// Normal and place in textures between three entries.
    #[inline(always)]
    pub fn at<F: Float>(&self, corners: [F::U; 3], barycentrics: [F; 3]) -> (Vector<F>, [F; 2]) {
        let mean = |of: [F; 3]| of[0] * barycentrics[0] + of[1] * barycentrics[1] + of[2] * barycentrics[2];
        let [a, b, c] = corners.map(|corner| self.normals.look_up(corner));
        let normal = a * barycentrics[0] + b * barycentrics[1] + c * barycentrics[2];
        let uv = [0, 1].map(|axis| mean(corners.map(|corner| corner.look_up(&self.uvs[axis]))));
        (normal, uv)
    }
}

impl RowColumns {
    pub fn new(rows: &[TriangleRow], attributes: &MeshAttributes) -> Self {
        let corners = [0, 1, 2].map(|corner| WordColumn::new(rows.iter().map(|row| row.corners[corner])));
        if !attributes.has_normal_maps {
            return RowColumns { corners, ..RowColumns::default() };
        }
        let tangent = VectorColumn::new(rows.iter().map(|row| row.tangent));
        RowColumns { corners, tangent, handedness: Column::new(rows.iter().map(|row| row.handedness)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle in the plane z = 0, u along x; v grows downwards as in a picture, or upwards where it is mirrored.
    #[test]
    fn tangents_follow_u_and_know_mirrored_pictures() {
        let places = [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y];
        let upright = tangent(places, [Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 0.0)]);
        assert_eq!(upright, (Vec3::X, 1.0));
        // left and right changed places: u grows against x, and up is still up
        let mirrored = tangent(places, [Vec2::new(1.0, 1.0), Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.0)]);
        assert_eq!(mirrored, (-Vec3::X, -1.0));
        // one place in the picture says nothing
        assert_eq!(tangent(places, [Vec2::ONE; 3]).0, Vec3::ZERO);
    }

    #[test]
    fn rows_go_with_sorted_corners() {
        let row = TriangleRow { corners: [7, 8, 9], ..TriangleRow::default() };
        let sorted = row.sorted([Vec3::X, -Vec3::X, Vec3::new(-0.0, 1.0, 0.0)]);
        assert_eq!(sorted.corners, [8, 9, 7]);
    }
}
