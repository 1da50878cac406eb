//! Mirrors of the structs in `shaders/lib/scene.wgsl`, field for field, and what fills them. A test compares every offset with
//! the shader compiler's. Padding is spelled out as `unused*`.

use super::GpuTraceError;
use crate::geometry::accel::{Binary, Primitive};
use crate::light::flat::Outline;
use crate::light::{Light as HostLight, Lights, SunDisc};
use crate::sobol::reversed_point;
use bytemuck::{Pod, Zeroable};
use scene::glam::DVec3;
use scene::material::Emission;
use scene::{Bsdf, Scene, Texture, Vec3};

/// What the whole scene shares.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Header {
    /// Radiance where nothing is hit.
    pub sky: Vec3,
    /// How many triangles, spheres and disks there are.
    pub primitives: u32,
    /// Unit direction of a sun that has a disc.
    pub sun_towards: Vec3,
    /// Square of the chord that spans the disc's angular radius, 0 without a disc.
    pub sun_chord_squared: f32,
    /// Radiance of the disc.
    pub sun_radiance: Vec3,
    /// Density per solid angle with which the sun's disc is sampled.
    pub sun_pdf: f32,
    /// What is sampled as a light.
    pub lights: u32,
    /// 0, which no compiler knows.
    pub zero: u32,
    /// Padding.
    pub unused: [u32; 2],
}

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

/// A triangle, sphere or disk.
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

/// What shading needs of a primitive.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Surface {
    /// Unit normal of a triangle.
    pub normal: Vec3,
    /// Index into the materials.
    pub material: u32,
    /// Index into the lights, or [`crate::geometry::NO_LIGHT`].
    pub light: u32,
    /// Padding.
    pub unused: [u32; 3],
}

/// Two colours of cells that fill space; `even` alone without a pattern.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Checkerboard {
    /// Colour of cells whose indices add up to an even number.
    pub even: Vec3,
    /// Padding.
    pub unused0: u32,
    /// Colour of the others.
    pub odd: Vec3,
    /// Padding.
    pub unused1: u32,
    /// A corner of cell (0, 0, 0).
    pub origin: Vec3,
    /// Padding.
    pub unused2: u32,
    /// 1 / cell size, 0 along axes without pattern.
    pub cells_per_unit: Vec3,
    /// Padding.
    pub unused3: u32,
}

/// How a surface looks.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Material {
    /// Albedo or reflectance.
    pub colour: Checkerboard,
    /// Radiance sent out.
    pub emission: Vec3,
    /// 0 none, 1 the one that the normal points away from, 2 both.
    pub emitting_sides: u32,
    /// 0 diffuse, 1 checkerboard, 2 mirror, 3 dielectric.
    pub bsdf: u32,
    /// Index of refraction of the inside over the outside.
    pub ior: f32,
    /// Root of |ior^2 - 1|.
    pub root: f32,
    /// What a float could not hold of it.
    pub root_low: f32,
}

/// What is sampled as a light.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Light {
    /// Corner of a flat lamp, centre of a disk or ball, a point light, the direction to the sun.
    pub position: Vec3,
    /// 0 rectangle, 1 triangle, 2 disk, 3 ball, 4 point, 5 sun.
    pub outline: u32,
    /// First edge of a flat lamp, a radius of a disk.
    pub u: Vec3,
    /// Area of a flat lamp, radius of a ball, 1 - cos of the sun's angular radius.
    pub area: f32,
    /// Second edge of a flat lamp, another radius of a disk.
    pub v: Vec3,
    /// 1 if a parallelogram's edges are at right angles.
    pub square: u32,
    /// Unit normal of a flat lamp.
    pub normal: Vec3,
    /// 1 if both sides shine.
    pub two_sided: u32,
    /// Radiance; intensity of a point, irradiance of a delta sun.
    pub radiance: Vec3,
    /// Of being chosen.
    pub probability: f32,
    /// Running sum of the probabilities.
    pub cumulative: f32,
    /// Padding.
    pub unused: [u32; 3],
}

const KIND_SHIFT: u32 = 30;
const COUNT_SHIFT: u32 = 27;
/// Inner nodes that can wait in a traversal.
const MOST_WAITING: usize = 64;

/// The header of a scene.
pub(crate) fn header(scene: &Scene, tree: &Binary, lights: &Lights) -> Header {
    let disc = scene.sun.as_ref().and_then(SunDisc::new);
    Header {
        sky: scene.sky,
        primitives: tree.len() as u32,
        sun_towards: disc.map_or(Vec3::Y, |d| d.towards),
        sun_chord_squared: disc.map_or(0.0, |d| d.chord_squared),
        sun_radiance: disc.map_or(Vec3::ZERO, |d| d.radiance),
        // a delta sun is never met
        sun_pdf: disc.map_or(0.0, |_| lights.sun_pdf()),
        lights: lights.len() as u32,
        zero: 0,
        unused: [0; 2],
    }
}

/// The tree, breadth first, with the root left out: its box is what its children's are.
///
/// # Errors
/// [`GpuTraceError::TooDeep`] and [`GpuTraceError::TooMany`] where the shader's stack or a node's bits do not suffice.
pub(crate) fn nodes(tree: &Binary) -> Result<Vec<Node>, GpuTraceError> {
    let boxes = &tree.bvh.nodes;
    if boxes.is_empty() {
        return Ok(vec![Node::zeroed(); 2]);
    }
    let depth = tree.bvh.depth(0);
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
    if order.len().max(tree.len()) >= 1 << COUNT_SHIFT {
        return Err(GpuTraceError::TooMany { what: "triangles" });
    }
    Ok(nodes)
}

/// The primitives in the order of the leaves.
pub(crate) fn primitives(tree: &Binary) -> Vec<ShapeData> {
    let tagged = tree.primitives.iter().zip(&tree.ids);
    let one = |(primitive, &id): (&Primitive, &u32)| match primitive {
        Primitive::Triangle(triangle) => {
            let [a, b, c] = triangle.corners;
            let (normal, normal_low) = two_floats(triangle.normal / triangle.normal.abs().max_element());
            let [normal_x, normal_y, normal_z] = normal.to_array();
            ShapeData { a, normal_x, b, normal_y, c, normal_z, normal_low, tag: id }
        }
        Primitive::Sphere(sphere) => {
            let (a, normal_x, tag) = (sphere.center, sphere.radius, id | 1 << KIND_SHIFT);
            ShapeData { a, normal_x, tag, ..ShapeData::zeroed() }
        }
        Primitive::Disk(disk) => {
            let (a, b, normal_x, tag) = (disk.center, disk.normal, disk.radius, id | 2 << KIND_SHIFT);
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

/// What shading needs of each primitive.
pub(crate) fn surfaces(tree: &Binary) -> Vec<Surface> {
    let one = |s: &crate::geometry::accel::Surface| Surface {
        normal: s.normal,
        material: s.material,
        light: s.light,
        unused: [0; 3],
    };
    tree.surfaces.iter().map(one).collect()
}

/// The scene's materials.
pub fn materials(scene: &Scene) -> Vec<Material> {
    scene.materials.iter().map(material).collect()
}

fn material(from: &scene::Material) -> Material {
    let mut to = Material::zeroed();
    match from.bsdf {
        Bsdf::Diffuse { albedo: Texture::Constant(albedo) } => to.colour.even = albedo,
        Bsdf::Diffuse { albedo: Texture::Checkerboard(board) } => {
            to.bsdf = 1;
            to.colour.even = board.even;
            to.colour.odd = board.odd;
            to.colour.origin = board.origin;
            to.colour.cells_per_unit = board.cells_per_unit();
        }
        Bsdf::Mirror { reflectance } => {
            to.bsdf = 2;
            to.colour.even = reflectance;
        }
        Bsdf::Dielectric { ior } => {
            let n = f64::from(ior);
            let root = ((n - 1.0) * (n + 1.0)).abs().sqrt();
            to.bsdf = 3;
            to.ior = ior;
            to.root = root as f32;
            to.root_low = (root - f64::from(to.root)) as f32;
        }
    }
    if let Some(emission) = from.emission {
        to.emission = emission.radiance;
        to.emitting_sides = 1 + u32::from(emission.two_sided);
    }
    to
}

/// What is sampled as a light.
pub fn lights(lights: &Lights) -> Vec<Light> {
    let chances = lights.probabilities.iter().zip(&lights.cumulative);
    let one = |(from, (&probability, &cumulative))| Light { probability, cumulative, ..light(from) };
    lights.lights.iter().zip(chances).map(one).collect()
}

fn light(from: &HostLight) -> Light {
    let none = Light::zeroed();
    let lamp =
        |emission: &Emission| Light { radiance: emission.radiance, two_sided: u32::from(emission.two_sided), ..none };
    match from {
        HostLight::Flat(flat, emission) => {
            let (outline, square) = match flat.outline {
                Outline::Rectangle => (0, 1),
                Outline::Parallelogram => (0, 0),
                Outline::Triangle => (1, 0),
                Outline::Disk => (2, 0),
            };
            let (position, u, v) = (flat.corner, flat.edge_u, flat.edge_v);
            Light { position, u, v, outline, square, area: flat.area, normal: flat.normal, ..lamp(emission) }
        }
        HostLight::Sphere(sphere, emission) => {
            Light { position: sphere.center, area: sphere.radius, outline: 3, ..lamp(emission) }
        }
        HostLight::Point(point) => Light { position: point.position, radiance: point.intensity, outline: 4, ..none },
        HostLight::Sun(sun) => {
            let area = sun.one_minus_cos();
            let radiance = if area > 0.0 { sun.radiance() } else { sun.irradiance };
            Light { position: sun.towards, area, radiance, outline: 5, ..none }
        }
    }
}

/// What each byte of an index adds to dimensions 1 to 3 of a Sobol point: four tables of 256.
pub fn sobol_bytes() -> Vec<[u32; 4]> {
    let entry = |i: u32| {
        let index = (i & 255) << (8 * (i >> 8));
        [reversed_point(index, 1), reversed_point(index, 2), reversed_point(index, 3), 0]
    };
    (0..1024).map(entry).collect()
}
