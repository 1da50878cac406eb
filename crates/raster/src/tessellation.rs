//! Triangles: spheres as three.js' SphereGeometry cuts them, with smooth normals; everything else flat, as it is.

use bytemuck::{Pod, Zeroable};
use gpu::{Gpu, GpuError};
use scene::{Geometry, Instance, Scene, Shape, Vec3};
use std::f32::consts::{PI, TAU};
use std::ops::Range;
use std::sync::Arc;

/// A corner of a triangle; the shaders' vertex inputs.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// World space.
    pub position: Vec3,
    /// World space, unit, outwards.
    pub normal: Vec3,
}

/// A scene's triangles on the device.
#[derive(Debug)]
pub struct World {
    /// What the triangles were made of.
    shapes: Arc<[Shape]>,
    segments: u32,
    /// All corners.
    pub vertices: wgpu::Buffer,
    /// Three for each triangle.
    pub indices: wgpu::Buffer,
    /// Each shape's part of the indices.
    pub ranges: Vec<Range<u32>>,
}

impl World {
    /// The triangles of `scene`: the `kept` ones if nothing changed.
    pub fn current<'a>(kept: &'a mut Option<World>, gpu: &Gpu, scene: &Scene) -> Result<&'a World, GpuError> {
        let fits =
            |world: &World| world.segments == scene.fake.segments && of_one_geometry(&world.shapes, &scene.shapes);
        match kept.take().filter(fits) {
            // the next frame has these shapes again, most likely
            Some(world) => Ok(kept.insert(World { shapes: scene.shapes.clone(), ..world })),
            None => Ok(kept.insert(World::new(gpu, scene)?)),
        }
    }

    fn new(gpu: &Gpu, scene: &Scene) -> Result<World, GpuError> {
        let segments = scene.fake.segments.max(3);
        let (bytes, limit) = (index_bytes(scene, segments), gpu.device.limits().max_buffer_size);
        if bytes > limit {
            return Err(GpuError::TooManyBytes { what: "the scene's triangles".to_owned(), bytes, limit });
        }
        let (mut vertices, mut indices, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        for shape in scene.shapes.iter() {
            let start = indices.len() as u32;
            match &shape.geometry {
                Geometry::Sphere { center, radius } => {
                    add_sphere(&mut vertices, &mut indices, *center, *radius, segments)
                }
                flat => add_flat(&mut vertices, &mut indices, flat),
            }
            ranges.push(start..indices.len() as u32);
        }
        Ok(World {
            shapes: scene.shapes.clone(),
            segments: scene.fake.segments,
            vertices: gpu.buffer("the scene's corners", &vertices, wgpu::BufferUsages::VERTEX)?,
            indices: gpu.buffer("the scene's triangles", &indices, wgpu::BufferUsages::INDEX)?,
            ranges,
        })
    }
}

/// Whether shapes differ in their materials at most. Most frames have the same list, by its address.
fn of_one_geometry(a: &Arc<[Shape]>, b: &Arc<[Shape]>) -> bool {
    Arc::ptr_eq(a, b) || a.iter().map(|s| &s.geometry).eq(b.iter().map(|s| &s.geometry))
}

fn index_bytes(scene: &Scene, segments: u32) -> u64 {
    let triangles = |geometry: &Geometry| match geometry {
        Geometry::Sphere { .. } => 2 * u64::from(segments) * u64::from(segments),
        Geometry::Rectangle { .. } => 2,
        Geometry::Disk { .. } => u64::from(scene::shape::DISK_SEGMENTS),
        Geometry::Box { .. } => 12,
        Geometry::Mesh(mesh) | Geometry::Instance(Instance { mesh, .. }) => mesh.triangles().len() as u64,
    };
    scene.shapes.iter().map(|s| triangles(&s.geometry) * 12).sum()
}

/// Rows from the north pole; the first and the last have one triangle a segment, the others two.
fn add_sphere(vertices: &mut Vec<Vertex>, indices: &mut Vec<u32>, center: Vec3, radius: f32, segments: u32) {
    let first = vertices.len() as u32;
    for row in 0..=segments {
        let theta = PI * row as f32 / segments as f32;
        for column in 0..=segments {
            let phi = TAU * column as f32 / segments as f32;
            let normal = Vec3::new(-phi.cos() * theta.sin(), theta.cos(), phi.sin() * theta.sin());
            vertices.push(Vertex { position: center + radius * normal, normal: normal.normalize() });
        }
    }
    let at = |row: u32, column: u32| first + row * (segments + 1) + column;
    for row in 0..segments {
        for column in 0..segments {
            let [a, b] = [at(row, column + 1), at(row, column)];
            let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
            if row > 0 {
                indices.extend([a, b, d]);
            }
            if row + 1 < segments {
                indices.extend([b, c, d]);
            }
        }
    }
}

fn add_flat(vertices: &mut Vec<Vertex>, indices: &mut Vec<u32>, geometry: &Geometry) {
    let (positions, triangles) = geometry.flat_triangles();
    for triangle in triangles.iter() {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        let normal = unit_normal(b - a, c - a);
        for position in [a, b, c] {
            indices.push(vertices.len() as u32);
            vertices.push(Vertex { position, normal });
        }
    }
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
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        add_sphere(&mut vertices, &mut indices, *center, *radius, segments.max(3));
        let at = |index: u32| vertices[index as usize].position;
        return of(&mut indices.as_chunks().0.iter().map(|&[a, b, c]| [at(a), at(b), at(c)]));
    }
    let (positions, triangles) = geometry.flat_triangles();
    of(&mut triangles.iter().map(|triangle| triangle.map(|corner| positions[corner as usize])))
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
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        let center = Vec3::new(1.0, 2.0, 3.0);
        add_sphere(&mut vertices, &mut indices, center, 2.0, 100);
        assert_eq!(indices.len(), 3 * (2 * 100 * 100 - 2 * 100));
        let mut area = 0.0;
        for triangle in indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| vertices[triangle[i] as usize].position);
            let normal = (b - a).cross(c - a);
            assert!(normal.dot(a - center) > 0.0);
            area += 0.5 * normal.length();
        }
        assert!((area / (16.0 * PI) - 1.0).abs() < 2e-3);
    }
}
