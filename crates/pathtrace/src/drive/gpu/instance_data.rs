//! Large meshes that stand in the world: taken out of a scene, whose other shapes go the usual ways, and laid out
//! as `shaders/pathtrace/intersect/instances.wgsl` reads them.

use super::GpuTraceError;
use super::scene_data::Header;
use super::shape_data::{COUNT_SHIFT, MOST_WAITING, Node, ShapeData, Shapes, Surface, nodes};
use super::tables::Uploaded;
use crate::intersect::NO_LIGHT;
use crate::intersect::baking::is_instanced;
use crate::intersect::coincident::NO_GROUP;
use bytemuck::Zeroable;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use scene::glam::{Affine3A, DMat3, Mat3, Vec3A};
use scene::{Geometry, Instance, Mesh, Scene, Shape, Vec3};
use std::borrow::Cow;
use std::sync::Arc;

/// The bit of a mesh's place that says that it stands in the world as it is.
pub(crate) const UNMOVED: u32 = 1 << 31;

/// The large meshes of a scene, in the order in which they stand there.
#[derive(Debug, Default)]
pub(crate) struct Instances {
    /// Each mesh once, however many instances it has.
    pub meshes: Vec<Arc<Mesh>>,
    placed: Vec<Placed>,
}

/// A mesh somewhere in the world.
#[derive(Debug)]
struct Placed {
    /// Its place in the list.
    mesh: usize,
    instance: Instance,
    material: u32,
}

/// A scene without its large meshes, and those.
pub(crate) struct Parted<'a> {
    pub others: Cow<'a, Scene>,
    /// [`crate::light::Lights::light_of_shape`] of the others.
    pub light_of_shape: Cow<'a, [u32]>,
    pub instances: Instances,
}

impl<'a> Parted<'a> {
    pub fn new(scene: &'a Scene, light_of_shape: &'a [u32]) -> Self {
        let mut instances = Instances::default();
        scene.shapes.iter().filter(|shape| is_instanced(scene, shape)).for_each(|shape| instances.add(shape));
        if instances.is_empty() {
            let (others, light_of_shape) = (Cow::Borrowed(scene), Cow::Borrowed(light_of_shape));
            return Parted { others, light_of_shape, instances };
        }
        let others = scene.shapes.iter().zip(light_of_shape).filter(|(shape, _)| !is_instanced(scene, shape));
        let (shapes, lights): (Vec<Shape>, Vec<u32>) = others.map(|(shape, light)| (shape.clone(), *light)).unzip();
        let others = Cow::Owned(Scene { shapes: shapes.into(), ..scene.clone() });
        Parted { others, light_of_shape: Cow::Owned(lights), instances }
    }
}

impl Instances {
    pub fn is_empty(&self) -> bool {
        self.placed.is_empty()
    }

    fn add(&mut self, shape: &Shape) {
        let instance = match &shape.geometry {
            Geometry::Instance(instance) => instance.clone(),
            Geometry::Mesh(mesh) => Instance { mesh: mesh.clone(), to_world: Affine3A::IDENTITY },
            _ => return,
        };
        // what is flattened to nothing is met by no ray
        if !instance.to_world.inverse().is_finite() {
            return;
        }
        let known = self.meshes.iter().position(|mesh| Arc::ptr_eq(mesh, &instance.mesh));
        let mesh = known.unwrap_or_else(|| {
            self.meshes.push(instance.mesh.clone());
            self.meshes.len() - 1
        });
        self.placed.push(Placed { mesh, instance, material: shape.material as u32 });
    }

    /// Puts them behind what there is of other shapes.
    ///
    /// # Errors
    /// [`GpuTraceError::TooDeep`] and [`GpuTraceError::TooMany`] where the shader's stack or a node's
    /// bits do not suffice.
    pub fn append_to(&self, shapes: &mut Shapes, tables: &Uploaded, header: &mut Header) -> Result<(), GpuTraceError> {
        header.instances = self.placed.len() as u32;
        header.instance_primitives = shapes.primitives.len() as u32;
        header.instance_surfaces = shapes.surfaces.len() as u32;
        header.instance_root = shapes.nodes.len() as u32;
        for Placed { mesh, instance, material } in &self.placed {
            shapes.primitives.extend(maps(&instance.to_world, tables.places[*mesh]));
            let surface = Surface { material: *material, light: NO_LIGHT, group: NO_GROUP, ..Surface::zeroed() };
            shapes.surfaces.push(surface);
        }
        match self.placed.len() {
            // what the root would hold
            0 | 1 => header.instance_root = 1 << COUNT_SHIFT,
            _ => shapes.nodes.extend(self.tree(header.instance_root)?),
        }
        Ok(())
    }

    /// The tree over their boxes, an instance a leaf; its first node will have this index.
    fn tree(&self, first: u32) -> Result<Vec<Node>, GpuTraceError> {
        let boxes: Vec<Aabb> = self.placed.iter().map(|placed| padded_box(&placed.instance)).collect();
        let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
        let mut build_time = std::time::Duration::ZERO;
        let tree = build_bvh2(&boxes, params, &mut build_time);
        let depth = tree.depth(0);
        if depth >= MOST_WAITING {
            return Err(GpuTraceError::TooDeep { depth, limit: MOST_WAITING - 1 });
        }
        let index_mask = (1 << COUNT_SHIFT) - 1;
        let placed = |node: Node| {
            let index = node.contents & index_mask;
            let index = if node.contents > index { tree.primitive_indices[index as usize] } else { index + first };
            Node { contents: (node.contents & !index_mask) | index, ..node }
        };
        Ok(nodes(&tree)?.into_iter().map(placed).collect())
    }
}

/// The box in the world, with room for what the ray's way into the instance's space rounds: 2^-18 of the largest
/// coordinate and the extent, more than a scene's box is padded by.
fn padded_box(instance: &Instance) -> Aabb {
    let (low, high) = instance.bounds();
    let largest = low.abs().max(high.abs()).max_element();
    let room = Vec3::splat((largest + (high - low).max_element()) / 262_144.0);
    Aabb::new(Vec3A::from(low - room), Vec3A::from(high + room))
}

/// The map back into the mesh's space, with how far the instance is moved, and the map into the world:
/// `Instance` in the shader.
fn maps(to_world: &Affine3A, place: u32) -> [ShapeData; 2] {
    let forward = Mat3::from(to_world.matrix3);
    let backward = forward.as_dmat3().inverse();
    let moved = Vec3::from(to_world.translation);
    let unmoved = if *to_world == Affine3A::IDENTITY { UNMOVED } else { 0 };
    let back = ShapeData { normal_low: moved, tag: place | unmoved, ..rows(&backward) };
    [back, rows(&forward.as_dmat3())]
}

fn rows(map: &DMat3) -> ShapeData {
    let [a, b, c] = [0, 1, 2].map(|row| map.row(row).as_vec3());
    ShapeData { a, b, c, ..ShapeData::zeroed() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::glam::Quat;
    use scene::{Material, builtin};

    fn large_mesh() -> Arc<Mesh> {
        let triangles = vec![[0, 1, 2]; Mesh::LARGE];
        Arc::new(Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles))
    }

    fn with_instances(count: usize) -> Scene {
        let mut scene = builtin::named("cornell").expect("it is built in");
        let mesh = large_mesh();
        let material = scene.materials.iter().position(|material| !material.shines()).expect("a wall");
        let shape = |index: usize| {
            let to_world = Affine3A::from_translation(Vec3::X * index as f32);
            Shape { geometry: Geometry::Instance(Instance { mesh: mesh.clone(), to_world }), material }
        };
        scene.shapes = scene.shapes.iter().cloned().chain((0..count).map(shape)).collect();
        scene
    }

    #[test]
    fn large_meshes_are_taken_out_of_a_scene_unless_they_shine() {
        let mut scene = with_instances(3);
        let lights = vec![NO_LIGHT; scene.shapes.len()];
        let parted = Parted::new(&scene, &lights);
        assert_eq!(parted.others.shapes.len(), scene.shapes.len() - 3);
        assert_eq!(parted.light_of_shape.len(), parted.others.shapes.len());
        assert_eq!((parted.instances.placed.len(), parted.instances.meshes.len()), (3, 1));
        let shines = |material: &Material| material.shines();
        let lamp = scene.materials.iter().position(shines).expect("a lamp");
        let mut shapes = scene.shapes.to_vec();
        shapes.iter_mut().filter(|shape| shape.geometry.mesh_of().is_some()).for_each(|shape| shape.material = lamp);
        scene.shapes = shapes.into();
        assert!(Parted::new(&scene, &lights).instances.is_empty());
    }

    /// Every instance is one leaf of the tree, whose box holds it.
    #[test]
    fn each_instance_is_in_one_leaf_of_the_tree_behind_the_others() {
        let scene = with_instances(40);
        let lights = vec![NO_LIGHT; scene.shapes.len()];
        let instances = Parted::new(&scene, &lights).instances;
        let first = 7;
        let tree = instances.tree(first).expect("few");
        let mut found: Vec<u32> = Vec::new();
        let mut waiting = vec![first];
        while let Some(contents) = waiting.pop() {
            for node in [contents, contents + 1].map(|index| tree[(index - first) as usize]) {
                if node.contents >> COUNT_SHIFT == 0 {
                    waiting.push(node.contents);
                    continue;
                }
                assert_eq!(node.contents >> COUNT_SHIFT, 1);
                let index = node.contents & ((1 << COUNT_SHIFT) - 1);
                assert!(node.low.x < index as f32 && node.high.x > index as f32 + 1.0, "{index}: {node:?}");
                found.push(index);
            }
        }
        found.sort_unstable();
        assert_eq!(found, (0..40).collect::<Vec<_>>());
    }

    #[test]
    fn the_map_back_undoes_the_map_into_the_world() {
        let turn = Quat::from_rotation_y(0.8) * Quat::from_rotation_x(2.0);
        let moved = Vec3::new(1e4, -3.0, 77.0);
        let to_world = Affine3A::from_scale_rotation_translation(Vec3::new(-2.0, 0.3, 1e3), turn, moved);
        let [back, forward] = maps(&to_world, 9);
        assert_eq!((back.tag, back.normal_low), (9, moved));
        assert_eq!(maps(&Affine3A::IDENTITY, 9)[0].tag, 9 | UNMOVED);
        let map = |rows: &ShapeData, v: Vec3| Vec3::new(rows.a.dot(v), rows.b.dot(v), rows.c.dot(v));
        for v in [Vec3::X, Vec3::Y, Vec3::Z] {
            assert!(map(&back, map(&forward, v)).distance(v) < 1e-5);
            assert!((map(&forward, v) + moved).distance(to_world.transform_point3(v)) < 1e-3);
        }
    }
}
