//! The acceleration structure where primitives are few: obvhs' BVH of two children a node. It lies on the device as
//! well.
//!
//! Twin: `shaders/pathtrace/intersect/bvh2.wgsl`.

use super::coincident::Groups;
use super::cutouts::Cutouts;
use super::primitive::{Primitive, Surface, padding, primitives};
use super::triangle::ShearedRay;
use super::{Blocker, Hit, Intersection, NO_INSTANCE, NO_PRIMITIVE, Ray};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2 as Tree;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::RayHit;
use scene::Scene;
use scene::glam::Vec3A;

/// Two children a node.
pub(crate) struct Bvh2 {
    pub(crate) tree: Tree,
    /// In the order of the BVH's leaves.
    pub(crate) primitives: Vec<Primitive>,
    /// Each primitive's place in the scene's order, area lights first, which decides ties.
    pub(crate) ids: Vec<u32>,
    pub(crate) surfaces: Vec<Surface>,
    /// Which of them coincide, by their places in the scene's order.
    pub(crate) groups: Groups,
    /// Holes in them, if there are any.
    pub(super) cutouts: Option<Box<Cutouts>>,
}

/// The nearest candidate so far, as little as can be carried through the traversal.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    pub t: f32,
    /// Its place in the order of the leaves, or [`NO_PRIMITIVE`].
    primitive: u32,
    pub id: u32,
    barycentrics: [f32; 3],
}

impl Bvh2 {
    /// Of a whole scene, however large, large meshes with all their triangles.
    pub(crate) fn of(scene: &Scene, light_of_shape: &[u32]) -> Self {
        let (primitives, surfaces, groups, _) = primitives(scene, light_of_shape, |_| false);
        Bvh2 { groups, ..Bvh2::new(&primitives, &surfaces) }
    }

    pub(super) fn new(primitives: &[Primitive], surfaces: &[Surface]) -> Self {
        let boxes = padded_boxes(primitives);
        let mut build_time = std::time::Duration::ZERO;
        let tree = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut build_time);
        let order = tree.primitive_indices.clone();
        Bvh2 {
            tree,
            primitives: order.iter().map(|&i| primitives[i as usize]).collect(),
            surfaces: order.iter().map(|&i| surfaces[i as usize]).collect(),
            ids: order,
            groups: Groups::default(),
            cutouts: None,
        }
    }

    /// The nearest hit before `ray.tmax`, see [`super::Accel::closest`].
    pub(super) fn closest(&self, ray: &Ray) -> Option<Hit> {
        let Nearest { t, primitive, barycentrics, .. } = self.nearest(ray);
        (primitive != NO_PRIMITIVE).then_some(Hit { t, primitive, instance: NO_INSTANCE, barycentrics })
    }

    /// What the ray has met that has this hit.
    pub(super) fn intersection(&self, ray: &Ray, hit: &Hit) -> Intersection {
        let place = hit.primitive as usize;
        self.primitives[place].intersection(ray, hit, &self.surfaces[place])
    }

    pub(super) fn nearest(&self, ray: &Ray) -> Nearest {
        let sheared = ShearedRay::new(ray);
        let mut nearest = Nearest { t: ray.tmax, primitive: NO_PRIMITIVE, id: u32::MAX, barycentrics: [0.0; 3] };
        self.traverse(ray, |index, tmax| {
            // one step beyond, so that equal distances reach the comparison of ids
            let reach = if self.groups.any() { f32::INFINITY } else { tmax.next_up() };
            if let Some((t, barycentrics)) = self.primitives[index].intersect(ray, &sheared, reach)
                && !self.is_hole(index, barycentrics)
            {
                let id = self.ids[index];
                if self.groups.comes_first((t, id), (nearest.t, nearest.id)) {
                    nearest = Nearest { t, primitive: index as u32, id, barycentrics };
                }
            }
            Visit::Before(nearest.t)
        });
        nearest
    }

    #[inline]
    pub(super) fn occluded_by(&self, ray: &Ray, blocks: impl Fn(Blocker) -> bool) -> bool {
        let sheared = ShearedRay::new(ray);
        let mut occluded = false;
        self.traverse(ray, |index, tmax| {
            occluded = self.primitives[index].intersect(ray, &sheared, tmax).is_some_and(|(t, barycentrics)| {
                let Surface { material, light, .. } = self.surfaces[index];
                !self.is_hole(index, barycentrics) && blocks(Blocker { t, id: self.ids[index], material, light })
            });
            if occluded { Visit::Stop } else { Visit::Before(tmax) }
        });
        occluded
    }

    #[inline(always)]
    fn is_hole(&self, index: usize, barycentrics: [f32; 3]) -> bool {
        let material = self.surfaces[index].material;
        self.cutouts.as_ref().is_some_and(|cutouts| cutouts.is_hole(self.ids[index], material, barycentrics))
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
        obvhs::fast_stack!(u32, (96, 192), self.tree.max_depth, stack, {
            self.tree.ray_traverse_dynamic(&mut stack, box_ray, &mut RayHit::none(), &mut leaf);
        });
    }
}

enum Visit {
    /// Go on; only what lies before this distance matters from here.
    Before(f32),
    Stop,
}

fn padded_boxes(primitives: &[Primitive]) -> Vec<Aabb> {
    let padding = padding(primitives);
    let padded = |(lo, hi)| Aabb::new(Vec3A::from(lo - padding), Vec3A::from(hi + padding));
    primitives.iter().map(Primitive::bounds).map(padded).collect()
}
