//! Mirrors of what `shaders/pathtrace/scene.wgsl` says of shapes, field for field, and what fills them: few shapes one
//! by one, many in a tree. A test compares every offset with the shader compiler's.

use super::GpuTraceError;
use crate::intersect::attributes::{MeshAttributes, TriangleRow, rows_of_tree};
use crate::intersect::bvh2::Bvh2;
use crate::intersect::coincident::Groups;
use crate::intersect::primitive::{self, Primitive};
use crate::intersect::shape_list::{ListedForm, ListedPlane, ShapeList};
use crate::intersect::triangle::{in_order, sorted};
use bytemuck::{Pod, Zeroable};
use obvhs::bvh2::Bvh2 as Tree;
use scene::glam::DVec3;
use scene::{Scene, Vec3};

/// A node of the BVH; two children lie side by side, the root's are 0 and 1.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Node {
    /// Corner of the box.
    pub low: Vec3,
    /// Index of an inner node's first child, or of a leaf's first primitive with their number above.
    pub contents: u32,
    /// Other corner of the box.
    pub high: Vec3,
    /// Padding.
    pub unused: u32,
}

/// A triangle, sphere or disk of the tree: `Primitive` in the shader.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShapeData {
    /// Corner or centre.
    pub a: Vec3,
    /// Of the normal, or a radius.
    pub normal_x: f32,
    /// Corner, or normal of a disk.
    pub b: Vec3,
    /// Of the normal.
    pub normal_y: f32,
    /// Corner.
    pub c: Vec3,
    /// Of the normal.
    pub normal_z: f32,
    /// What a float could not hold of the normal.
    pub normal_low: Vec3,
    /// Place in the scene's order, the kind above.
    pub tag: u32,
}

/// What shading needs of a primitive, in the order of the leaves; of few shapes in the order of their ids.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Surface {
    /// Unit normal of a flat one.
    pub normal: Vec3,
    /// Index into the materials.
    pub material: u32,
    /// Index into the lights, or [`crate::intersect::NO_LIGHT`].
    pub light: u32,
    /// Of what it coincides with, or [`NO_GROUP`](crate::intersect::coincident::NO_GROUP).
    pub group: u32,
    /// Place of its row in `mesh_data`, 0 if it has none.
    pub triangle: u32,
    /// Padding.
    pub unused: u32,
}

/// One of few shapes: `Shape` in the shader.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FewShape {
    /// Corner or centre.
    pub a: Vec3,
    /// Of the normal, or a radius.
    pub normal_x: f32,
    /// Corner, or normal of a disk.
    pub b: Vec3,
    /// Of the normal.
    pub normal_y: f32,
    /// Corner.
    pub c: Vec3,
    /// Of the normal.
    pub normal_z: f32,
    /// Corner of a quadrilateral.
    pub d: Vec3,
    /// Place in the scene's order.
    pub id: u32,
    /// What a float could not hold of the normal.
    pub normal_low: Vec3,
    /// How far from its plane its points may lie.
    pub flatness: f32,
    /// Of its plane.
    pub plane_point: Vec3,
    /// Padding.
    pub unused: u32,
}

/// Shapes that the shader's list has room for.
pub const MOST_SHAPES: usize = 64;

/// Most shapes that are met one by one. With boxes added to the Cornell box a tree is faster beyond about 35 of them on
/// Mesa's llvmpipe; on hardware it was not measured. Twice as many find room, should each be split.
const FEW: usize = MOST_SHAPES / 2;

/// The kind of a primitive stands above this bit of its tag, the number of a leaf's primitives above that of a node's.
pub(crate) const KIND_SHIFT: u32 = 30;
pub(crate) const COUNT_SHIFT: u32 = 27;

/// Kinds of the tree's primitives.
pub(crate) const KIND_TRIANGLE: u32 = 0;
pub(crate) const KIND_SPHERE: u32 = 1;
pub(crate) const KIND_DISK: u32 = 2;

/// Inner nodes that can wait in a traversal.
pub(crate) const MOST_WAITING: usize = 64;

/// A scene's shapes as the device holds them.
#[derive(Debug, Default)]
pub(crate) struct Shapes {
    /// Few shapes, by kinds; else empty.
    pub few: Vec<FewShape>,
    pub seen: [u32; 4],
    pub shading: [u32; 4],
    /// Of the tree; else empty.
    pub nodes: Vec<Node>,
    pub primitives: Vec<ShapeData>,
    pub surfaces: Vec<Surface>,
    /// What meshes say of these, where any of the scene says anything.
    pub rows: Vec<TriangleRow>,
    /// Which of them coincide.
    pub groups: Groups,
}

/// Which shapes there are, and how rays find them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct ShapeKinds {
    /// One by one, without a tree.
    pub few: bool,
    pub quadrilaterals: bool,
    pub triangles: bool,
    pub spheres: bool,
    pub disks: bool,
    /// Whether any of them coincide.
    pub coincident: bool,
}

impl Shapes {
    /// One by one if they are few, else in a tree.
    ///
    /// # Errors
    /// [`GpuTraceError::TooDeep`] and [`GpuTraceError::TooMany`] where the shader's stack or a node's bits do not
    /// suffice.
    pub fn new(scene: &Scene, light_of_shape: &[u32]) -> Result<Self, GpuTraceError> {
        match ShapeList::new(scene, light_of_shape) {
            Some(shape_list) if shape_list.len()[0] <= FEW => Ok(Shapes::few(scene, &shape_list)),
            _ => Shapes::in_a_tree(scene, light_of_shape),
        }
    }

    /// In a tree, however few.
    ///
    /// # Errors
    /// As [`Shapes::new`].
    pub fn in_a_tree(scene: &Scene, light_of_shape: &[u32]) -> Result<Self, GpuTraceError> {
        let tree = Bvh2::of(scene, light_of_shape);
        let surfaces = surfaces(tree.surfaces.iter().zip(tree.ids.iter().copied()), &tree.groups);
        let rows = MeshAttributes::of(scene).map_or(Vec::new(), |attributes| {
            let rows = rows_of_tree(scene, &attributes);
            tree.ids.iter().map(|&id| rows[id as usize]).collect()
        });
        let (nodes, primitives, groups) = (nodes(&tree.tree)?, primitives(&tree), tree.groups);
        Ok(Shapes { nodes, primitives, surfaces, rows, groups, ..Shapes::default() })
    }

    /// The same among large meshes, which shadow rays go to that were not looked at: any of few shapes may shade then.
    pub fn among_others(self) -> Self {
        Shapes { shading: self.seen, ..self }
    }

    fn few(scene: &Scene, shape_list: &ShapeList) -> Self {
        // by kind, those that shade before those that do not
        let mut lists: [Vec<FewShape>; 8] = Default::default();
        for shape in shape_list.shapes() {
            let mut add = |kind: usize, form: FewShape| {
                lists[2 * kind + usize::from(!shape.shades)].push(FewShape { id: shape.id, ..form });
            };
            let none = FewShape::zeroed();
            match shape.form {
                ListedForm::Quadrilateral(corners, plane) => match sorted_quadrilateral(corners) {
                    Some([a, b, c, d]) => add(0, FewShape { a, b, c, d, ..in_plane(plane) }),
                    None => {
                        let [a, b, c, d] = corners;
                        for [a, b, c] in [[a, b, c], [a, c, d]].map(sorted) {
                            add(1, FewShape { a, b, c, ..in_plane(plane) });
                        }
                    }
                },
                ListedForm::Triangle(corners, plane) => {
                    let [a, b, c] = sorted(corners);
                    add(1, FewShape { a, b, c, ..in_plane(plane) });
                }
                ListedForm::Sphere { center, radius } => add(2, FewShape { a: center, normal_x: radius, ..none }),
                ListedForm::Disk { center, normal, radius } => {
                    add(3, FewShape { a: center, b: normal, normal_x: radius, ..none });
                }
            }
        }
        let groups = shape_list.groups().clone();
        let surfaces = surfaces(shape_list.surfaces().iter().zip(0..), &groups);
        let rows = MeshAttributes::of(scene).map_or(Vec::new(), |attributes| shape_list.sorted_rows(&attributes));
        let mut shapes = Shapes { surfaces, rows, groups, ..Shapes::default() };
        for kind in 0..4 {
            let [shading, others] = [2 * kind, 2 * kind + 1].map(|list| std::mem::take(&mut lists[list]));
            shapes.few.extend(shading);
            shapes.shading[kind] = shapes.few.len() as u32;
            shapes.few.extend(others);
            shapes.seen[kind] = shapes.few.len() as u32;
        }
        shapes
    }

    /// Which of them there are.
    pub fn kinds(&self) -> ShapeKinds {
        let has = |kind: u32| self.primitives.iter().any(|primitive| primitive.tag >> KIND_SHIFT == kind);
        let [quadrilaterals, triangles, spheres, disks] = self.seen;
        ShapeKinds {
            few: self.primitives.is_empty(),
            quadrilaterals: quadrilaterals > 0,
            triangles: triangles > quadrilaterals || has(KIND_TRIANGLE),
            spheres: spheres > triangles || has(KIND_SPHERE),
            disks: disks > spheres || has(KIND_DISK),
            coincident: self.groups.any(),
        }
    }
}

/// The corners from the first in lexicographic order on, if the one across from it comes last: neighbours then evaluate
/// the same expression for their common edge.
fn sorted_quadrilateral(corners: [Vec3; 4]) -> Option<[Vec3; 4]> {
    let before = |p: Vec3, q: Vec3| in_order(&p, &q).is_lt();
    let first = (0..4).find(|&i| (0..4).all(|j| i == j || before(corners[i], corners[j])))?;
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| corners[(first + i) % 4]);
    (before(b, c) && before(d, c)).then_some([a, b, c, d])
}

fn in_plane(plane: ListedPlane) -> FewShape {
    let ListedPlane { point, normal, flatness } = plane;
    let (normal, normal_low) = two_floats(normal / normal.abs().max_element());
    let [normal_x, normal_y, normal_z] = normal.to_array();
    FewShape { normal_x, normal_y, normal_z, normal_low, flatness, plane_point: point, ..FewShape::zeroed() }
}

/// The tree, breadth first, with the root left out: its box is what its children's are.
///
/// # Errors
/// [`GpuTraceError::TooDeep`] and [`GpuTraceError::TooMany`] where the shader's stack or a node's bits do not suffice.
pub(super) fn nodes(tree: &Tree) -> Result<Vec<Node>, GpuTraceError> {
    let boxes = &tree.nodes;
    if boxes.is_empty() {
        return Ok(vec![Node::zeroed(); 2]);
    }
    let depth = tree.depth(0);
    if depth > MOST_WAITING {
        return Err(GpuTraceError::TooDeep { depth, limit: MOST_WAITING });
    }
    let node = |index: u32, contents: u32| {
        let bounds = boxes[index as usize].aabb();
        let (low, high) = (Vec3::from(bounds.min), Vec3::from(bounds.max));
        Node { low, contents, high, unused: 0 }
    };
    // a lone leaf stands on both sides of the root: what it holds is met twice at one distance
    let first = if boxes[0].is_leaf() { [0, 0] } else { [boxes[0].first_index, boxes[0].first_index + 1] };
    let mut order: Vec<u32> = first.to_vec();
    let mut nodes = Vec::with_capacity(boxes.len());
    let mut next = 0;
    while let Some(&index) = order.get(next) {
        next += 1;
        let from = &boxes[index as usize];
        let contents = if from.is_leaf() {
            if from.prim_count >= 1 << (32 - COUNT_SHIFT) {
                return Err(GpuTraceError::TooMany { what: "shapes at one place" });
            }
            from.first_index | from.prim_count << COUNT_SHIFT
        } else {
            let children = order.len() as u32;
            order.extend([from.first_index, from.first_index + 1]);
            children
        };
        nodes.push(node(index, contents));
    }
    if order.len().max(tree.primitive_indices.len()) >= 1 << COUNT_SHIFT {
        return Err(GpuTraceError::TooMany { what: "triangles" });
    }
    Ok(nodes)
}

/// The primitives in the order of the leaves.
fn primitives(tree: &Bvh2) -> Vec<ShapeData> {
    let tagged = tree.primitives.iter().zip(&tree.ids);
    let one = |(primitive, &id): (&Primitive, &u32)| match primitive {
        Primitive::Triangle(triangle) => {
            let [a, b, c] = triangle.corners;
            let (normal, normal_low) = two_floats(triangle.normal / triangle.normal.abs().max_element());
            let [normal_x, normal_y, normal_z] = normal.to_array();
            ShapeData { a, normal_x, b, normal_y, c, normal_z, normal_low, tag: id | KIND_TRIANGLE << KIND_SHIFT }
        }
        Primitive::Sphere(sphere) => {
            let (a, normal_x, tag) = (sphere.center, sphere.radius, id | KIND_SPHERE << KIND_SHIFT);
            ShapeData { a, normal_x, tag, ..ShapeData::zeroed() }
        }
        Primitive::Disk(disk) => {
            let (a, b, normal_x, tag) = (disk.center, disk.normal, disk.radius, id | KIND_DISK << KIND_SHIFT);
            ShapeData { a, b, normal_x, tag, ..ShapeData::zeroed() }
        }
    };
    tagged.map(one).collect()
}

/// A vector as the sum of one rounded to f32 and what that left, rounded again.
fn two_floats(v: DVec3) -> (Vec3, Vec3) {
    let rounded = v.as_vec3();
    (rounded, (v - rounded.as_dvec3()).as_vec3())
}

/// Surfaces with their places in the scene's order.
fn surfaces<'a>(all: impl Iterator<Item = (&'a primitive::Surface, u32)>, groups: &Groups) -> Vec<Surface> {
    let one = |(s, id): (&primitive::Surface, u32)| Surface {
        normal: s.normal,
        material: s.material,
        light: s.light,
        group: groups.of_surface(id),
        triangle: 0,
        unused: 0,
    };
    all.map(one).collect()
}
