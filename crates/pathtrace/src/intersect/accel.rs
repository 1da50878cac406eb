//! The acceleration structure over triangles, spheres and disks: two children a node (`bvh2`) where they are
//! few, eight (`bvh8`) where they are many. Both give the same hits. Large meshes stand
//! beside it as [`super::instances`].

use super::baking::is_instanced;
use super::bvh2::Bvh2;
use super::bvh8::Bvh8;
use super::bvh8_collapse::Listed;
use super::coincident::Groups;
use super::cutouts::Cutouts;
use super::instances::Instances;
use super::owners::Owners;
use super::primitive::primitives;
use super::{Blocker, Hit, Intersection, NO_INSTANCE, Ray};
use scene::{Scene, Shape};
use simd::{Lanes, RowLanes};

/// All shapes of a scene, ready for rays.
pub struct Accel {
    hierarchy: Hierarchy,
    instances: Instances,
    /// Triangles, spheres and disks in the hierarchy.
    count: usize,
    owners: Owners,
}

enum Hierarchy {
    Two(Bvh2),
    Eight(Bvh8),
}

/// Fewest primitives for eight children a node.
const LARGE: usize = 128;

impl Accel {
    /// Builds the structure. Triangles without area, which no ray can meet, are left out. `light_of_shape` is
    /// [`crate::light::Lights::light_of_shape`] of the scene.
    pub fn new(scene: &Scene, light_of_shape: &[u32]) -> Self {
        let is_left_out = |shape: &Shape| is_instanced(scene, shape);
        let (primitives, surfaces, groups, owners) = primitives(scene, light_of_shape, is_left_out);
        let count = primitives.len();
        let shapes = Listed { primitives: &primitives, surfaces: &surfaces };
        let eight = if count < LARGE { None } else { Bvh8::new(shapes, RowLanes::nearest_to(Lanes::best())) };
        let cutouts = Cutouts::of(scene);
        let hierarchy = match eight {
            Some(bvh) => Hierarchy::Eight(Bvh8 { groups, cutouts, ..bvh }),
            None => Hierarchy::Two(Bvh2 { groups, cutouts, ..Bvh2::new(&primitives, &surfaces) }),
        };
        Accel { hierarchy, instances: Instances::new(scene), count, owners }
    }

    /// Number of triangles, spheres and disks, those of a large mesh as often as it stands in the scene.
    pub fn len(&self) -> usize {
        self.count + self.instances.triangles()
    }

    /// Whether there is nothing to hit.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The large meshes, which keep trees of their own.
    pub fn instances(&self) -> &Instances {
        &self.instances
    }

    /// The nearest hit before `ray.tmax`; of several at one distance an area light, else the primitive that comes
    /// first in the scene; large meshes after all others.
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let nearest = self.closest_beside_instances(ray);
        if self.instances.is_empty() {
            return nearest;
        }
        let tmax = nearest.map_or(ray.tmax, |hit| hit.t);
        self.instances.closest(&Ray { tmax, ..*ray }).or(nearest)
    }

    /// As [`Accel::closest`], of all that is no large mesh.
    #[inline]
    pub fn closest_beside_instances(&self, ray: &Ray) -> Option<Hit> {
        if self.count == 0 {
            return None;
        }
        match &self.hierarchy {
            Hierarchy::Two(bvh) => bvh.closest(ray),
            Hierarchy::Eight(bvh) => bvh.closest(ray),
        }
    }

    /// What the ray has met that has this hit.
    pub fn intersection(&self, ray: &Ray, hit: &Hit) -> Intersection {
        if hit.instance != NO_INSTANCE {
            return self.instances.intersection(hit);
        }
        match &self.hierarchy {
            Hierarchy::Two(bvh) => bvh.intersection(ray, hit),
            Hierarchy::Eight(bvh) => bvh.intersection(ray, hit),
        }
    }

    /// The place in the scene's order, area lights first, of what was hit.
    pub(super) fn id(&self, hit: &Hit) -> u32 {
        match &self.hierarchy {
            Hierarchy::Two(bvh) => bvh.ids[hit.primitive as usize],
            Hierarchy::Eight(bvh) => bvh.id(hit),
        }
    }

    /// Index into the scene's shapes of what was hit.
    pub fn shape(&self, hit: &Hit) -> u32 {
        if hit.instance != NO_INSTANCE { self.instances.shape(hit) } else { self.owners.of(self.id(hit)) }
    }

    /// What the ray meets first: [`Accel::closest`] and [`Accel::intersection`].
    pub fn first_met(&self, ray: &Ray) -> Option<Intersection> {
        self.closest(ray).map(|hit| self.intersection(ray, &hit))
    }

    /// Whether anything lies on the ray before `ray.tmax`.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.occluded_by(ray, |_| true) || (!self.instances.is_empty() && self.instances.occluded(ray, |_| true))
    }

    /// Which of the shapes coincide, by their places in the scene's order.
    pub fn groups(&self) -> &Groups {
        match &self.hierarchy {
            Hierarchy::Two(bvh) => &bvh.groups,
            Hierarchy::Eight(bvh) => &bvh.groups,
        }
    }

    /// Whether anything beside large meshes that `blocks` lies on the ray before `ray.tmax`.
    #[inline]
    pub fn occluded_by(&self, ray: &Ray, blocks: impl Fn(Blocker) -> bool) -> bool {
        if self.count == 0 {
            return false;
        }
        match &self.hierarchy {
            Hierarchy::Two(bvh) => bvh.occluded_by(ray, blocks),
            Hierarchy::Eight(bvh) => bvh.occluded_by(ray, blocks),
        }
    }
}
