//! Large meshes where they stand: a tree over their boxes in the world, and a tree of each mesh in its own space, shared
//! by all its instances.
//!
//! A ray goes into a mesh's space unnormalised, so that distances stay what they are in the world. The maps are kept and
//! applied in f64: a ray's start there is off by its rounding to f32 alone, and so is a hit's point in the world. Of
//! instances that are met at one distance the first of the scene is there.
//!
//! Twin: `shaders/pathtrace/intersect/instances.wgsl`.

use super::baking::is_instanced;
use super::mesh_tree::MeshTree;
use super::mesh_unpacked::{MOST_UNPACKED, Unpacked};
use super::mesh_walk::{ClosestOf, CompressedRay, EachMet, OccludedBy};
use super::{Hit, Intersection, NO_INSTANCE, NO_LIGHT, Ray, SurfacePoint, gamma};
use obvhs::Boundable;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::cwbvh::node::CwBvhNode;
use scene::glam::{DAffine3, DMat3, DVec3, Vec3A};
use scene::{Geometry, Instance, Mesh, Scene, Shape, Vec3};
use simd::{Lanes, RowLanes};
use std::sync::Arc;
use std::time::Duration;

/// Most instances whose boxes are tested one after the other. Measured with one: the tree over it takes an eighth
/// of a ray's time.
const FEW: usize = 4;

/// All large meshes of a scene.
pub struct Instances {
    /// In the scene's order.
    placed: Vec<Placed>,
    /// The tree over their boxes, and their numbers in its order; nothing if they are few.
    nodes: Vec<CwBvhNode>,
    order: Vec<u32>,
    /// Whether there is memory for trees that need no decoding.
    unpacked: bool,
    lanes: RowLanes,
}

/// A large mesh, put somewhere.
struct Placed {
    tree: Arc<MeshTree>,
    to_world: DAffine3,
    to_mesh: DAffine3,
    /// Whether it stands where its own space says.
    is_in_place: bool,
    /// Of normals: the inverse transposed.
    normals_to_world: DMat3,
    /// Absolute values of `to_world`'s matrix: how far errors in the mesh's space reach.
    reach: DMat3,
    /// In the world, with room for the rounding of its corners, of the box test and of rays in the mesh's space.
    bounds: Aabb,
    material: u32,
    /// Index into the scene's shapes.
    shape: u32,
}

/// Where on a large mesh a hit lies: what its attributes are mixed from.
#[derive(Debug, Clone, Copy)]
pub struct MeshPoint<'a> {
    /// The mesh, in its own space.
    pub mesh: &'a Arc<Mesh>,
    /// Indices of the triangle's corners: into the mesh's positions, normals and places in textures.
    pub corners: [u32; 3],
    /// Weights of these corners, adding up to 1.
    pub barycentrics: [f32; 3],
    /// From the mesh's space to the world's.
    pub to_world: DAffine3,
    /// Takes normals of the mesh's space to the world's, of any length there.
    pub normals_to_world: DMat3,
}

impl MeshPoint<'_> {
    /// The triangle's corners in the world.
    pub fn places(&self) -> [Vec3; 3] {
        let place = |corner: u32| self.mesh.positions()[corner as usize].as_dvec3();
        self.corners.map(|corner| self.to_world.transform_point3(place(corner)).as_vec3())
    }
}

impl Instances {
    /// Those of a scene, with the trees of their meshes. Matrices that cannot be undone leave nothing that a ray could meet.
    pub fn new(scene: &Scene) -> Self {
        let instanced = scene.shapes.iter().enumerate().filter(|(_, shape)| is_instanced(scene, shape));
        let placed: Vec<Placed> = instanced.filter_map(|(index, shape)| Placed::new(index, shape)).collect();
        let (nodes, order) = tree_over(&placed);
        let unpacked = triangles_of(&placed) <= MOST_UNPACKED;
        if unpacked {
            placed.iter().for_each(|placed| _ = placed.tree.unpacked());
        }
        Instances { placed, nodes, order, unpacked, lanes: RowLanes::nearest_to(Lanes::best()) }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.placed.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.placed.is_empty()
    }

    /// Triangles of all of them, those of a mesh as often as it stands in the scene.
    pub fn triangles(&self) -> usize {
        self.placed.iter().map(|placed| placed.tree.triangles.len()).sum()
    }

    /// The nearest hit before `ray.tmax`.
    #[inline(never)]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let mut nearest = None::<Hit>;
        let visit = |index: usize, tmax: f32| {
            // what comes earlier in the scene is there also at the same distance
            let is_earlier = nearest.is_some_and(|hit| (index as u32) < hit.instance);
            let reach = if is_earlier { tmax.next_up() } else { tmax };
            if let Some(hit) = self.closest_of(&self.placed[index], ray, reach) {
                nearest = Some(Hit { instance: index as u32, ..hit });
            }
            Some(nearest.map_or(tmax, |hit| hit.t))
        };
        self.visit_met(ray, visit);
        nearest
    }

    /// Whether any whose material `blocks` lies on the ray before `ray.tmax`.
    #[inline(never)]
    pub fn occluded(&self, ray: &Ray, blocks: impl Fn(u32) -> bool) -> bool {
        let mut occluded = false;
        let visit = |index: usize, tmax: f32| {
            let placed = &self.placed[index];
            occluded = blocks(placed.material) && self.is_occluded_by(placed, ray);
            (!occluded).then_some(tmax)
        };
        self.visit_met(ray, visit);
        occluded
    }

    /// The tree that needs no decoding, if rays go through that: only it knows its hits' primitives.
    #[inline(always)]
    fn unpacked<'a>(&self, placed: &'a Placed) -> Option<&'a Unpacked> {
        if self.unpacked { placed.tree.unpacked() } else { None }
    }

    /// The nearest hit of one of them before `tmax`, of no instance yet.
    #[inline(always)]
    fn closest_of(&self, placed: &Placed, ray: &Ray, tmax: f32) -> Option<Hit> {
        let (tree, ray) = (&*placed.tree, &placed.ray_in_mesh(ray, tmax));
        if let Some(unpacked) = self.unpacked(placed) {
            return unpacked.closest(ray);
        }
        let hit = self.lanes.run(ClosestOf { tree, ray })?;
        Some(Hit { t: hit.t, primitive: hit.triangle, instance: NO_INSTANCE, barycentrics: hit.barycentrics() })
    }

    #[inline(always)]
    fn is_occluded_by(&self, placed: &Placed, ray: &Ray) -> bool {
        let (tree, ray) = (&*placed.tree, &placed.ray_in_mesh(ray, ray.tmax));
        if let Some(unpacked) = self.unpacked(placed) {
            return unpacked.occluded(ray);
        }
        self.lanes.run(OccludedBy { tree, ray })
    }

    /// Shows those whose boxes the ray meets to the visitor, which says how far it goes from there on; `None` ends it.
    #[inline(always)]
    fn visit_met(&self, ray: &Ray, mut visit: impl FnMut(usize, f32) -> Option<f32>) {
        if self.placed.len() > FEW {
            return self.lanes.run(EachMet { nodes: &self.nodes, order: &self.order, ray, visit });
        }
        let (box_ray, mut tmax) = (CompressedRay::new(ray), ray.tmax);
        for (index, placed) in self.placed.iter().enumerate() {
            if box_ray.meets(&placed.bounds, tmax) {
                let Some(nearer) = visit(index, tmax) else { return };
                tmax = nearer;
            }
        }
    }

    /// What the ray has met that has this hit.
    pub fn intersection(&self, hit: &Hit) -> Intersection {
        let placed = &self.placed[hit.instance as usize];
        let corners = match self.unpacked(placed) {
            Some(unpacked) => unpacked.corners(hit),
            None => {
                let positions = placed.tree.mesh.positions();
                placed.tree.triangles[hit.primitive as usize].map(|corner| positions[corner as usize])
            }
        };
        let point = placed.point(corners, hit.barycentrics);
        Intersection { point, material: placed.material, light: NO_LIGHT }
    }

    /// Index into the scene's shapes of what was hit.
    pub fn shape(&self, hit: &Hit) -> u32 {
        self.placed[hit.instance as usize].shape
    }

    /// What the attributes of a hit are mixed from.
    pub fn attributes(&self, hit: &Hit) -> MeshPoint<'_> {
        debug_assert_ne!(hit.instance, NO_INSTANCE);
        let placed = &self.placed[hit.instance as usize];
        let place = self.unpacked(placed).map_or(hit.primitive as usize, |unpacked| unpacked.place(hit));
        MeshPoint {
            mesh: &placed.tree.mesh,
            corners: placed.tree.triangles[place],
            barycentrics: hit.barycentrics,
            to_world: placed.to_world,
            normals_to_world: placed.normals_to_world,
        }
    }
}

/// Triangles of the meshes of these, each counted once.
fn triangles_of(placed: &[Placed]) -> usize {
    let mut trees: Vec<&Arc<MeshTree>> = placed.iter().map(|placed| &placed.tree).collect();
    trees.sort_by_key(|tree| Arc::as_ptr(tree));
    trees.dedup_by_key(|tree| Arc::as_ptr(tree));
    trees.into_iter().map(|tree| tree.triangles.len()).sum()
}

impl Placed {
    fn new(index: usize, shape: &Shape) -> Option<Self> {
        let (mesh, to_world) = match &shape.geometry {
            Geometry::Mesh(mesh) => (mesh, DAffine3::IDENTITY),
            Geometry::Instance(Instance { mesh, to_world }) => (mesh, to_world.as_daffine3()),
            Geometry::Sphere { .. } | Geometry::Rectangle { .. } | Geometry::Disk { .. } | Geometry::Box { .. } => {
                return None;
            }
        };
        let to_mesh = to_world.inverse();
        if !to_mesh.is_finite() {
            return None;
        }
        let is_in_place = to_world == DAffine3::IDENTITY;
        let m = to_world.matrix3;
        let reach = DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
        let normals_to_world = to_mesh.matrix3.transpose();
        let material = shape.material as u32;
        let tree = MeshTree::of(mesh, &|_| true)?;
        let bounds = bounds_of(&tree.mesh, &to_world, &reach);
        let shape = index as u32;
        Some(Placed { tree, to_world, to_mesh, is_in_place, normals_to_world, reach, bounds, material, shape })
    }

    #[inline(always)]
    fn ray_in_mesh(&self, ray: &Ray, tmax: f32) -> Ray {
        if self.is_in_place {
            // what the map to itself makes of it, by every bit: it knows no -0.0
            return Ray { origin: ray.origin + Vec3::ZERO, tmax, ..*ray };
        }
        let origin = self.to_mesh.transform_point3(ray.origin.as_dvec3()).as_vec3();
        let direction = self.to_mesh.transform_vector3(ray.direction.as_dvec3()).as_vec3();
        Ray { tmax, ..Ray::new(origin, direction) }
    }

    /// The point of a triangle in the world, and its outward normal: that of the winding, which a map that mirrors turns
    /// over and back again.
    fn point(&self, corners: [Vec3; 3], barycentrics: [f32; 3]) -> SurfacePoint {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let weights = DVec3::from_array(barycentrics.map(f64::from));
        let weights = weights / weights.element_sum();
        let in_mesh = a * weights.x + b * weights.y + c * weights.z;
        let in_world = self.to_world.transform_point3(in_mesh);
        let normal = (self.normals_to_world * (b - a).cross(c - a)).normalize();
        // the rounding of the position, and that of the next ray's start when it is taken back into the mesh's space
        let rounding = f64::from(gamma(1)) * in_world.abs() + self.reach * (f64::from(gamma(2)) * in_mesh.abs());
        SurfacePoint { position: in_world.as_vec3(), error: rounding.as_vec3(), normal: normal.as_vec3(), radius: 0.0 }
    }
}

/// The box of a mesh that is placed so, see [`Placed::bounds`].
fn bounds_of(mesh: &Mesh, to_world: &DAffine3, reach: &DMat3) -> Aabb {
    let (lo, hi) = mesh.bounds();
    let (middle, half) = (0.5 * (lo.as_dvec3() + hi.as_dvec3()), 0.5 * (hi.as_dvec3() - lo.as_dvec3()));
    let (middle, half) = (to_world.transform_point3(middle), *reach * half);
    let largest = (middle.abs() + half).max_element() + half.max_element();
    let in_mesh = DVec3::splat(f64::from(lo.abs().max(hi.abs()).max_element()));
    let room = DVec3::splat(2.0 * largest / 1_048_576.0) + *reach * in_mesh * (1.0 / 1_048_576.0);
    let corner = |corner: DVec3| Vec3A::from(corner.as_vec3());
    Aabb::new(corner(middle - half - room), corner(middle + half + room))
}

impl Boundable for Placed {
    fn aabb(&self) -> Aabb {
        self.bounds
    }
}

fn tree_over(placed: &[Placed]) -> (Vec<CwBvhNode>, Vec<u32>) {
    if placed.len() <= FEW {
        return (Vec::new(), Vec::new());
    }
    let mut took = Duration::ZERO;
    let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
    let tree = build_cwbvh(placed, params, &mut took);
    (tree.nodes, tree.primitive_indices)
}
