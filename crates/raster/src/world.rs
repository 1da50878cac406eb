//! A scene's triangles on the device. Small shapes share buffers, in the world's space; a mesh that is large, and one that
//! instances put somewhere, is there once in its own space, however many shapes show it.

use crate::tessellation::{Corners, add_flat, add_mesh, add_sphere, filled_normals};
use gpu::{Gpu, GpuError};
use scene::glam::Vec2;
use scene::{Geometry, Mesh, Scene, Shape};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use wgpu::{Buffer, BufferUsages, RenderPass};

/// A scene's triangles on the device.
#[derive(Debug)]
pub struct World {
    /// What the triangles were made of.
    shapes: Arc<[Shape]>,
    segments: u32,
    /// What small shapes share, and then a set for each large mesh.
    buffers: Vec<Buffers>,
    large: Vec<Arc<Mesh>>,
    parts: Vec<Part>,
}

/// Corners and triangles of a mesh on the device.
#[derive(Debug, Clone)]
struct Buffers {
    positions: Buffer,
    /// Those of a mesh without normals are its positions, which are not looked at.
    normals: Buffer,
    /// The same of its places in pictures.
    uvs: Buffer,
    indices: Buffer,
}

/// Where a shape's triangles are.
#[derive(Debug, Clone)]
struct Part {
    /// Place of its buffers in [`World::buffers`].
    buffers: usize,
    indices: Range<u32>,
}

impl World {
    /// The triangles of `scene`: the `kept` ones if nothing changed, and of large meshes those that are there.
    pub fn current<'a>(kept: &'a mut Option<World>, gpu: &Gpu, scene: &Scene) -> Result<&'a World, GpuError> {
        let fits =
            |world: &World| world.segments == scene.fake.segments && of_one_geometry(&world.shapes, &scene.shapes);
        match kept.take() {
            // the next frame has these shapes again, most likely
            Some(world) if fits(&world) => Ok(kept.insert(World { shapes: scene.shapes.clone(), ..world })),
            old => Ok(kept.insert(World::new(gpu, scene, old)?)),
        }
    }

    fn new(gpu: &Gpu, scene: &Scene, old: Option<World>) -> Result<World, GpuError> {
        let segments = scene.fake.segments.max(3);
        let (bytes, limit) = (bytes_of_small(scene, segments), gpu.device.limits().max_buffer_size);
        if bytes > limit {
            return Err(GpuError::TooManyBytes { what: "the scene's triangles".to_owned(), bytes, limit });
        }
        let (corners, mut parts) = small(scene, segments);
        let mut world = World {
            shapes: scene.shapes.clone(),
            segments: scene.fake.segments,
            buffers: vec![Buffers::of_small(gpu, &corners)?],
            large: Vec::new(),
            parts: Vec::new(),
        };
        let shapes = scene.shapes.iter().zip(&mut parts);
        for (mesh, part) in shapes.filter_map(|(shape, part)| Some((large_mesh(&shape.geometry)?, part))) {
            part.buffers = world.buffers_of(gpu, mesh, old.as_ref())?;
        }
        Ok(World { parts, ..world })
    }

    /// Where a large mesh is: made if it is neither there yet nor in `old`.
    fn buffers_of(&mut self, gpu: &Gpu, mesh: &Arc<Mesh>, old: Option<&World>) -> Result<usize, GpuError> {
        let there = |large: &[Arc<Mesh>]| large.iter().position(|other| Arc::ptr_eq(other, mesh)).map(|at| at + 1);
        if let Some(index) = there(&self.large) {
            return Ok(index);
        }
        let kept = old.and_then(|old| Some(old.buffers[there(&old.large)?].clone()));
        self.buffers.push(kept.map_or_else(|| Buffers::of_large(gpu, mesh), Ok)?);
        self.large.push(mesh.clone());
        Ok(self.large.len())
    }

    /// The corners that small shapes share: other ones whenever any triangle is.
    pub fn small_corners(&self) -> &Buffer {
        &self.buffers[0].positions
    }

    /// Draws a shape into a pass whose corners are those of `bound`, which it brings up to date.
    pub fn draw(&self, pass: &mut RenderPass<'_>, shape: usize, bound: &mut Option<usize>) {
        let Part { buffers, indices } = &self.parts[shape];
        if bound.replace(*buffers) != Some(*buffers) {
            self.buffers[*buffers].bind(pass);
        }
        pass.draw_indexed(indices.clone(), 0, 0..1);
    }
}

impl Buffers {
    fn of_small(gpu: &Gpu, corners: &Corners) -> Result<Buffers, GpuError> {
        Ok(Buffers {
            positions: gpu.buffer("the scene's corners", &corners.positions, BufferUsages::VERTEX)?,
            normals: gpu.buffer("the scene's corners", &corners.normals, BufferUsages::VERTEX)?,
            uvs: gpu.buffer("the scene's corners", &corners.uvs, BufferUsages::VERTEX)?,
            indices: gpu.buffer("the scene's triangles", &corners.indices, BufferUsages::INDEX)?,
        })
    }

    fn of_large(gpu: &Gpu, mesh: &Mesh) -> Result<Buffers, GpuError> {
        let triangles = mesh.triangles().len();
        let label = format!("a mesh of {triangles} triangles");
        let positions = gpu.buffer(&label, mesh.positions(), BufferUsages::VERTEX)?;
        let normals = match filled_normals(mesh) {
            normals if normals.is_empty() => positions.clone(),
            normals => gpu.buffer(&label, &normals, BufferUsages::VERTEX)?,
        };
        let uvs = match mesh.uvs() {
            [] => positions.clone(),
            uvs => gpu.buffer::<Vec2>(&label, uvs, BufferUsages::VERTEX)?,
        };
        let indices = gpu.buffer(&label, mesh.triangles(), BufferUsages::INDEX)?;
        Ok(Buffers { positions, normals, uvs, indices })
    }

    fn bind(&self, pass: &mut RenderPass<'_>) {
        for (slot, corners) in (0..).zip([&self.positions, &self.normals, &self.uvs]) {
            pass.set_vertex_buffer(slot, corners.slice(..));
        }
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
    }
}

/// Corners of everything small, and where each shape's triangles are; a large mesh's part has its own buffers yet to come.
fn small(scene: &Scene, segments: u32) -> (Corners, Vec<Part>) {
    let mut corners = Corners::default();
    let mut meshes: HashMap<*const Mesh, Range<u32>> = HashMap::new();
    let mut part = |shape: &Shape| {
        let indices = match (&shape.geometry, shape.geometry.mesh_of()) {
            (_, Some(mesh)) if mesh.is_large() => 0..3 * mesh.triangles().len() as u32,
            (_, Some(mesh)) => {
                meshes.entry(Arc::as_ptr(mesh)).or_insert_with(|| corners.added(|it| add_mesh(it, mesh))).clone()
            }
            (Geometry::Sphere { center, radius }, _) => corners.added(|it| add_sphere(it, *center, *radius, segments)),
            (flat, _) => corners.added(|it| add_flat(it, flat)),
        };
        Part { buffers: 0, indices }
    };
    let parts = scene.shapes.iter().map(&mut part).collect();
    (corners, parts)
}

fn large_mesh(geometry: &Geometry) -> Option<&Arc<Mesh>> {
    geometry.mesh_of().filter(|mesh| mesh.is_large())
}

/// Whether shapes differ in their materials at most. Most frames have the same list, by its address.
fn of_one_geometry(a: &Arc<[Shape]>, b: &Arc<[Shape]>) -> bool {
    Arc::ptr_eq(a, b) || a.iter().map(|s| &s.geometry).eq(b.iter().map(|s| &s.geometry))
}

/// Of the indices that small shapes share, at most.
fn bytes_of_small(scene: &Scene, segments: u32) -> u64 {
    let triangles = |geometry: &Geometry| match geometry {
        Geometry::Sphere { .. } => 2 * u64::from(segments) * u64::from(segments),
        Geometry::Rectangle { .. } => 2,
        Geometry::Disk { .. } => u64::from(scene::shape::DISK_SEGMENTS),
        Geometry::Box { .. } => 12,
        // once each, and far from any limit one by one
        Geometry::Mesh(_) | Geometry::Instance(_) => 0,
    };
    scene.shapes.iter().map(|s| triangles(&s.geometry) * 12).sum()
}
