//! The acceleration structure over triangles, spheres and disks: obvhs' BVH2 where they are few, eight children a node
//! (`bvh8`) where they are many. Both give the same hits.
//!
//! Twin of the BVH2: `shaders/pathtrace/intersect/bvh2.wgsl`.

use super::bvh8::Bvh8;
use super::bvh8_collapse::Shapes;
use super::disk::Disk;
use super::sphere::Sphere;
use super::surface_point::SurfacePoint;
use super::triangle::{ShearedRay, Triangle, triangle_normal};
use super::{Ray, gamma};
use crate::light::Lights;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::RayHit;
use rayon::prelude::*;
use scene::glam::Vec3A;
use scene::{Geometry, Scene, Vec3};
use simd::{Lanes, RowLanes};

/// What a ray can hit.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Primitive {
    Triangle(Triangle),
    Sphere(Sphere),
    Disk(Disk),
}

/// A primitive and what shading needs of it, beside the part that intersection reads.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surface {
    /// Unit normal of a triangle; others have their own.
    pub normal: Vec3,
    pub material: u32,
    /// See [`Hit::light`].
    pub light: u32,
}

/// All shapes of a scene, ready for rays.
pub struct Accel {
    hierarchy: Hierarchy,
    count: usize,
}

enum Hierarchy {
    Two(Binary),
    Eight(Bvh8),
}

/// Two children a node.
pub(crate) struct Binary {
    pub(crate) bvh: Bvh2,
    /// In the order of the BVH's leaves.
    pub(crate) primitives: Vec<Primitive>,
    /// Each primitive's place in the scene's order, area lights first, which decides ties.
    pub(crate) ids: Vec<u32>,
    pub(crate) surfaces: Vec<Surface>,
}

/// Fewest primitives for eight children a node.
const LARGE: usize = 128;

/// The nearest meeting of a ray with a surface.
#[derive(Debug, Clone, Copy)]
pub struct Hit {
    /// Where, with the outward normal.
    pub point: SurfacePoint,
    /// Index into the scene's materials.
    pub material: u32,
    /// Index into the list of lights, or [`NO_LIGHT`].
    pub light: u32,
}

/// What stands for the light of a surface that is not one.
pub const NO_LIGHT: u32 = u32::MAX;

/// The nearest candidate so far, as little as can be carried through the traversal.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    pub t: f32,
    index: usize,
    pub id: u32,
    barycentrics: [f32; 3],
}

impl Accel {
    /// Builds the structure. Triangles without area, which no ray can meet, are left out. `lights` are the scene's.
    pub fn new(scene: &Scene, lights: &Lights) -> Self {
        let (primitives, surfaces) = primitives(scene, lights);
        let count = primitives.len();
        let shapes = Shapes { primitives: &primitives, surfaces: &surfaces };
        let eight = if count < LARGE { None } else { Bvh8::new(shapes, RowLanes::nearest_to(Lanes::best())) };
        let hierarchy = match eight {
            Some(bvh) => Hierarchy::Eight(bvh),
            None => Hierarchy::Two(Binary::new(&primitives, &surfaces)),
        };
        Accel { hierarchy, count }
    }

    /// Number of triangles, spheres and disks.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is nothing to hit.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The nearest hit before `ray.tmax`; of several at one distance an area light, else the primitive that comes
    /// first in the scene.
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let (point, surface) = match &self.hierarchy {
            Hierarchy::Two(binary) => binary.closest(ray),
            Hierarchy::Eight(bvh) => bvh.closest(ray),
        }?;
        Some(Hit { point, material: surface.material, light: surface.light })
    }

    /// Whether anything lies on the ray before `ray.tmax`.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.occluded_by(ray, |_| true)
    }

    /// Whether anything of a material that `blocks` lies on the ray before `ray.tmax`.
    #[inline]
    pub fn occluded_by(&self, ray: &Ray, blocks: impl Fn(u32) -> bool) -> bool {
        match &self.hierarchy {
            Hierarchy::Two(binary) => binary.occluded_by(ray, blocks),
            Hierarchy::Eight(bvh) => bvh.occluded_by(ray, blocks),
        }
    }
}

impl Binary {
    /// Of a whole scene, however large.
    pub(crate) fn of(scene: &Scene, lights: &Lights) -> Self {
        let (primitives, surfaces) = primitives(scene, lights);
        Binary::new(&primitives, &surfaces)
    }

    /// Number of triangles, spheres and disks.
    pub(crate) fn len(&self) -> usize {
        self.primitives.len()
    }

    pub(super) fn new(primitives: &[Primitive], surfaces: &[Surface]) -> Self {
        let boxes = padded_boxes(primitives);
        let mut build_time = std::time::Duration::ZERO;
        let bvh = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut build_time);
        let order = bvh.primitive_indices.clone();
        Binary {
            bvh,
            primitives: order.iter().map(|&i| primitives[i as usize]).collect(),
            surfaces: order.iter().map(|&i| surfaces[i as usize]).collect(),
            ids: order,
        }
    }

    pub(super) fn closest(&self, ray: &Ray) -> Option<(SurfacePoint, Surface)> {
        let nearest = self.nearest(ray);
        let surface = self.surfaces.get(nearest.index)?;
        let point = self.primitives[nearest.index].point(ray, nearest.t, nearest.barycentrics, surface);
        Some((point, *surface))
    }

    pub(super) fn nearest(&self, ray: &Ray) -> Nearest {
        let sheared = ShearedRay::new(ray);
        let mut nearest = Nearest { t: ray.tmax, index: usize::MAX, id: u32::MAX, barycentrics: [0.0; 3] };
        self.traverse(ray, |index, tmax| {
            // one step beyond, so that equal distances reach the comparison of ids
            if let Some((t, barycentrics)) = self.primitives[index].intersect(ray, &sheared, tmax.next_up()) {
                let id = self.ids[index];
                if t < nearest.t || (t == nearest.t && id < nearest.id) {
                    nearest = Nearest { t, index, id, barycentrics };
                }
            }
            Visit::Before(nearest.t)
        });
        nearest
    }

    #[inline]
    pub(super) fn occluded_by(&self, ray: &Ray, blocks: impl Fn(u32) -> bool) -> bool {
        let sheared = ShearedRay::new(ray);
        let mut occluded = false;
        self.traverse(ray, |index, tmax| {
            occluded = self.primitives[index].intersect(ray, &sheared, tmax).is_some()
                && blocks(self.surfaces[index].material);
            if occluded { Visit::Stop } else { Visit::Before(tmax) }
        });
        occluded
    }

    #[inline(always)]
    fn traverse(&self, ray: &Ray, mut visit: impl FnMut(usize, f32) -> Visit) {
        let box_ray = obvhs::ray::Ray::new(Vec3A::from(ray.origin), Vec3A::from(ray.direction), 0.0, ray.tmax);
        let mut leaf = |node: &obvhs::bvh2::node::Bvh2Node, ray: &mut obvhs::ray::Ray, _: &mut RayHit| {
            let first = node.first_index as usize;
            for index in first..first + node.prim_count as usize {
                match visit(index, ray.tmax) {
                    Visit::Before(t) => ray.tmax = t,
                    Visit::Stop => return false,
                }
            }
            true
        };
        obvhs::fast_stack!(u32, (96, 192), self.bvh.max_depth, stack, {
            self.bvh.ray_traverse_dynamic(&mut stack, box_ray, &mut RayHit::none(), &mut leaf);
        });
    }
}

enum Visit {
    /// Go on; only what lies before this distance matters from here.
    Before(f32),
    Stop,
}

impl Primitive {
    #[inline(always)]
    pub(super) fn intersect(&self, ray: &Ray, sheared: &ShearedRay, tmax: f32) -> Option<(f32, [f32; 3])> {
        match self {
            Primitive::Triangle(triangle) => triangle.intersect(sheared, tmax).map(|hit| (hit.t, hit.barycentrics)),
            Primitive::Sphere(sphere) => sphere.intersect(ray, tmax).map(|t| (t, [0.0; 3])),
            Primitive::Disk(disk) => disk.intersect(ray, tmax).map(|t| (t, [0.0; 3])),
        }
    }

    /// The point that a ray meets at the distance `t`.
    pub(super) fn point(&self, ray: &Ray, t: f32, barycentrics: [f32; 3], surface: &Surface) -> SurfacePoint {
        match self {
            Primitive::Triangle(t) => SurfacePoint::on_triangle(t.corners, barycentrics, surface.normal),
            Primitive::Sphere(s) => SurfacePoint::on_sphere(s.center, s.radius, s.meeting(ray, t)),
            Primitive::Disk(d) => SurfacePoint::on_disk(d.center, ray.origin + ray.direction * t, d.normal),
        }
    }

    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        match self {
            Primitive::Triangle(Triangle { corners: [a, b, c], .. }) => (a.min(*b).min(*c), a.max(*b).max(*c)),
            Primitive::Sphere(s) => (s.center - Vec3::splat(s.radius), s.center + Vec3::splat(s.radius)),
            Primitive::Disk(Disk { center, normal, radius }) => {
                Geometry::Disk { center: *center, normal: *normal, radius: *radius }.bounds()
            }
        }
    }
}

/// The shapes' indices in the order that decides ties: area lights first, so that an area light in the plane of a wall
/// wins against the wall.
pub fn area_lights_first(scene: &Scene) -> impl Iterator<Item = usize> {
    let is_area_light = |index: &usize| scene.material_of(&scene.shapes[*index]).emission.is_some();
    let (area_lights, others): (Vec<_>, Vec<_>) = (0..scene.shapes.len()).partition(is_area_light);
    area_lights.into_iter().chain(others)
}

fn primitives(scene: &Scene, lights: &Lights) -> (Vec<Primitive>, Vec<Surface>) {
    let (mut primitives, mut surfaces) = (Vec::new(), Vec::new());
    for index in area_lights_first(scene) {
        let shape = &scene.shapes[index];
        let material = shape.material as u32;
        let first_light = lights.first_of_shape(index);
        let mut light = first_light.unwrap_or(NO_LIGHT);
        let mut add = |primitive, normal, light| {
            primitives.push(primitive);
            surfaces.push(Surface { normal, material, light });
        };
        match shape.geometry {
            Geometry::Sphere { center, radius } => add(Primitive::Sphere(Sphere { center, radius }), Vec3::ZERO, light),
            Geometry::Disk { center, normal, radius } => {
                add(Primitive::Disk(Disk { center, normal, radius }), normal, light);
            }
            Geometry::Rectangle { .. } | Geometry::Box { .. } | Geometry::Mesh { .. } => {
                let (positions, triangles) = shape.geometry.flat_triangles();
                // the two halves of a rectangle are one light, other triangles are each their own
                let step = u32::from(first_light.is_some() && !matches!(shape.geometry, Geometry::Rectangle { .. }));
                for corners in triangles.iter().map(|t| t.map(|i| positions[i as usize])) {
                    if let Some(normal) = triangle_normal(corners) {
                        add(Primitive::Triangle(Triangle::new(corners)), normal, light);
                        light += step;
                    }
                }
            }
        }
    }
    (primitives, surfaces)
}

/// How much boxes are grown: 2^-20 of (largest coordinate + extent): the box test rounds, and treats directions below
/// 1.2e-7 as if they were that. Measured on a bumpy sphere of 100,000 triangles: without, up to 2 % of axis-parallel
/// rays are lost; with it none of 10 million.
pub(super) fn padding(primitives: &[Primitive]) -> Vec3 {
    let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let union = |a: (Vec3, Vec3), b: (Vec3, Vec3)| (a.0.min(b.0), a.1.max(b.1));
    let scene = primitives.par_iter().with_min_len(4096).map(Primitive::bounds).reduce(|| none, union);
    let largest = scene.0.abs().max(scene.1.abs()).max_element();
    Vec3::splat((largest + (scene.1 - scene.0).max_element()) / 1_048_576.0 + gamma(1) * largest)
}

fn padded_boxes(primitives: &[Primitive]) -> Vec<Aabb> {
    let padding = padding(primitives);
    let padded = |(lo, hi)| Aabb::new(Vec3A::from(lo - padding), Vec3A::from(hi + padding));
    primitives.iter().map(Primitive::bounds).map(padded).collect()
}
