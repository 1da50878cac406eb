//! One ray's way through a [`MeshTree`], in the mesh's space: its compressed nodes as [`walk`] reads them, and its
//! triangles, taken from the mesh's own positions and met as in [`super::triangle`].
//!
//! An edge's neighbours name the same two positions, and a difference of two products turns its sign exactly with the
//! order of the factors: so the edge is one number to both without a sorting of corners.

use super::Ray;
use super::bvh8::{Child, LEAF_WIDTH};
use super::bvh8_leaf::{LeafRay, element, take};
use super::bvh8_walk::{Boxes, Visitor, walk};
use super::mesh_tree::MeshTree;
use super::triangle::{ShearedRay, Triangle};
use obvhs::aabb::Aabb;
use obvhs::cwbvh::node::CwBvhNode;
use scene::Vec3;
use simd::{Row, RowKernel, Rows};

/// A leaf's triangles as a [`Child`] says it: how many more than one, above the place of the first.
const COUNT: u32 = 29;

/// Most triangles that places in a leaf's [`Child`] can tell apart.
pub(super) const MOST: usize = 1 << COUNT;

/// What is met first of a tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MeshHit {
    pub t: f32,
    /// The triangle's place in the tree's order.
    pub triangle: u32,
    /// Twice the areas that the ray's point cuts the triangle into, opposite of the corners.
    areas: [f32; 3],
}

impl MeshHit {
    /// Weights of the triangle's corners in the mesh's order.
    pub fn barycentrics(&self) -> [f32; 3] {
        let [u, v, w] = self.areas;
        let sum = u + v + w;
        [u / sum, v / sum, w / sum]
    }
}

/// A ray, ready for compressed boxes, with the slack of [`super::bvh8_walk`]: a plane at `p + q * s` is met at
/// `q * (s * inverse) + (p * inverse - origin * inverse)`. `s` is a power of two, so that the first product is exact, and
/// what rounding `p * inverse` adds the boxes' padding covers.
pub(super) struct CompressedRay {
    inverse: [f32; 3],
    enter: [f32; 3],
    leave: [f32; 3],
    backwards: [bool; 3],
}

impl CompressedRay {
    pub fn new(ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let mut this = CompressedRay { inverse: [0.0; 3], enter: [0.0; 3], leave: [0.0; 3], backwards: [false; 3] };
        for axis in 0..3 {
            let d = direction[axis];
            let inverse = 1.0 / if d.abs() < 1e-25 { 1e-25 } else { d };
            let start = origin[axis] * inverse;
            let slack = start.abs() * (1.0 / 2_097_152.0);
            this.inverse[axis] = inverse;
            this.enter[axis] = -start - slack;
            this.leave[axis] = -start + slack;
            this.backwards[axis] = d < 0.0;
        }
        this
    }

    /// Whether the ray meets a box up to `tmax`, which is padded as those of nodes are.
    pub fn meets(&self, bounds: &Aabb, tmax: f32) -> bool {
        let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
        let (mut near, mut far) = (0.0f32, tmax);
        for axis in 0..3 {
            let (first, last) = if self.backwards[axis] { (high, low) } else { (low, high) };
            near = near.max(first[axis] * self.inverse[axis] + self.enter[axis]);
            far = far.min(last[axis] * self.inverse[axis] + self.leave[axis]);
        }
        near <= far
    }

    /// Which boxes are met and where, as [`Boxes::meet`].
    #[inline(always)]
    fn meet<F: Row<8>>(&self, node: &CwBvhNode, tmax: f32) -> (u32, F) {
        let mut near = F::splat(0.0);
        let mut far = F::splat(tmax);
        let corner = node.p.to_array();
        let planes = [
            (&node.child_min_x, &node.child_max_x),
            (&node.child_min_y, &node.child_max_y),
            (&node.child_min_z, &node.child_max_z),
        ];
        for axis in 0..3 {
            let (low, high) = planes[axis];
            let (first, last) = if self.backwards[axis] { (high, low) } else { (low, high) };
            let step = F::splat(f32::from_bits(u32::from(node.e[axis]) << 23) * self.inverse[axis]);
            let start = corner[axis] * self.inverse[axis];
            near = F::of_bytes(first).mul_add(step, F::splat(start + self.enter[axis])).max(near);
            far = F::of_bytes(last).mul_add(step, F::splat(start + self.leave[axis])).min(far);
        }
        (near.le(far) & occupied(node), near)
    }
}

/// Which of a node's children there are, as bits: each of their bytes in `child_meta` has bit 5 set.
#[inline(always)]
fn occupied(node: &CwBvhNode) -> u32 {
    let ones = (u64::from_le_bytes(node.child_meta) >> 5) & 0x0101_0101_0101_0101;
    // brings bit 8 i to bit 56 + i
    (ones.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u32
}

/// A child by its slot: a node by its place, or so many triangles from a place on.
#[inline(always)]
pub(super) fn child(node: &CwBvhNode, slot: usize) -> Child {
    let before = (1u32 << slot) - 1;
    if u32::from(node.imask) >> slot & 1 != 0 {
        return Child(node.child_base_idx + (u32::from(node.imask) & before).count_ones());
    }
    let meta = u32::from(node.child_meta[slot & 7]);
    let more = (meta >> 5).count_ones() - 1;
    Child(Child::LEAF | more << COUNT | (node.primitive_base_idx + (meta & 31)))
}

/// A compressed tree as one ray sees it. Leaves name places in `leaves`.
struct Compressed<'a, R: Rows, T> {
    nodes: &'a [CwBvhNode],
    leaves: &'a [T],
    ray: CompressedRay,
    rows: std::marker::PhantomData<R>,
}

impl<'a, R: Rows, T> Compressed<'a, R, T> {
    #[inline(always)]
    fn new(nodes: &'a [CwBvhNode], leaves: &'a [T], ray: &Ray) -> Self {
        Compressed { nodes, leaves, ray: CompressedRay::new(ray), rows: std::marker::PhantomData }
    }
}

impl<'a, R: Rows, T> Boxes for Compressed<'a, R, T> {
    type Eight = R::Eight;
    type Node = &'a CwBvhNode;

    #[inline(always)]
    fn node(&self, index: usize) -> &'a CwBvhNode {
        &self.nodes[index]
    }

    #[inline(always)]
    fn meet(&self, node: &'a CwBvhNode, tmax: f32) -> (u32, R::Eight) {
        self.ray.meet(node, tmax)
    }

    #[inline(always)]
    fn child(&self, node: &'a CwBvhNode, index: usize) -> Child {
        child(node, index)
    }

    #[inline(always)]
    fn prefetch(&self, child: Child) {
        if child.is_leaf() {
            R::prefetch(self.leaves, leaf(child).0);
        } else {
            R::prefetch(self.nodes, child.index());
        }
    }
}

/// Where a leaf's triangles begin, and how many there are.
#[inline(always)]
pub(super) fn leaf(child: Child) -> (usize, usize) {
    let first = child.0 & (MOST as u32 - 1);
    (first as usize, (child.0 >> COUNT & 3) as usize + 1)
}

/// What the triangles of a leaf are held against.
struct Triangles<'a, F> {
    tree: &'a MeshTree,
    positions: &'a [Vec3],
    sheared: ShearedRay,
    rows: LeafRay<F>,
}

impl<'a, F: Row<LEAF_WIDTH>> Triangles<'a, F> {
    #[inline(always)]
    fn new(tree: &'a MeshTree, ray: &Ray) -> Self {
        let sheared = ShearedRay::new(ray);
        Triangles { tree, positions: tree.mesh.positions(), sheared, rows: LeafRay::new(&sheared) }
    }

    #[inline(always)]
    fn corners(&self, triangle: usize) -> [Vec3; 3] {
        let [a, b, c] = self.tree.triangles[triangle];
        [self.positions[a as usize], self.positions[b as usize], self.positions[c as usize]]
    }

    /// Shows the triangles of a leaf that the ray meets to `met`, which says how far the ray goes from there on.
    #[inline(always)]
    fn meet(&self, child: Child, mut tmax: f32, mut met: impl FnMut(MeshHit) -> f32) {
        let (first, count) = leaf(child);
        let last = first + count - 1;
        // a leaf of fewer has its last one again
        let [a, b, c] = [self.corners(first), self.corners(last.min(first + 1)), self.corners(last)];
        let mut corners = [[F::splat(0.0); 3]; 3];
        for corner in 0..3 {
            for (along, axis) in self.rows.axes.into_iter().enumerate() {
                let row = [a[corner][axis], b[corner][axis], c[corner][axis], c[corner][axis]];
                corners[corner][along] = F::load(&row);
            }
        }
        let mut candidates = self.rows.candidates(corners, tmax);
        candidates.bits &= (1 << count) - 1;
        while candidates.bits != 0 {
            let lane = take(&mut candidates.bits);
            let triangle = Triangle::sorted(self.corners(first + lane));
            if let Some(t) = triangle.distance(&self.sheared, element(candidates.z, lane), tmax.next_up()) {
                let areas = element(candidates.areas, lane);
                tmax = met(MeshHit { t, triangle: (first + lane) as u32, areas });
            }
        }
    }
}

/// Looks for the nearest hit of a tree before `ray.tmax`; of several at one distance the first in the tree's order.
pub(super) struct ClosestOf<'a> {
    pub tree: &'a MeshTree,
    pub ray: &'a Ray,
}

struct ClosestVisitor<'a, F> {
    triangles: Triangles<'a, F>,
    nearest: MeshHit,
}

impl RowKernel for ClosestOf<'_> {
    type Output = Option<MeshHit>;
    #[inline(always)]
    fn run<R: Rows>(self) -> Option<MeshHit> {
        let ClosestOf { tree, ray } = self;
        let boxes = Compressed::<R, _>::new(&tree.nodes, &tree.triangles, ray);
        // hits at the end itself are beyond it: where an end is another's hit, the other has come first
        let nearest = MeshHit { t: ray.tmax.next_down(), triangle: u32::MAX, areas: [0.0; 3] };
        let mut visitor = ClosestVisitor { triangles: Triangles::<R::Four>::new(tree, ray), nearest };
        walk(&boxes, Child::ROOT, nearest.t, &mut visitor);
        (visitor.nearest.triangle != u32::MAX).then_some(visitor.nearest)
    }
}

impl<F: Row<LEAF_WIDTH>> Visitor for ClosestVisitor<'_, F> {
    #[inline(always)]
    fn visit(&mut self, child: Child, tmax: f32) -> Option<f32> {
        let nearest = &mut self.nearest;
        self.triangles.meet(child, tmax, |hit| {
            if hit.t < nearest.t || (hit.t == nearest.t && hit.triangle < nearest.triangle) {
                *nearest = hit;
            }
            nearest.t
        });
        Some(nearest.t)
    }
}

/// Looks for any triangle of a tree before `ray.tmax`.
pub(super) struct OccludedBy<'a> {
    pub tree: &'a MeshTree,
    pub ray: &'a Ray,
}

struct OccludedVisitor<'a, F> {
    triangles: Triangles<'a, F>,
    occluded: bool,
}

impl RowKernel for OccludedBy<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<R: Rows>(self) -> bool {
        let OccludedBy { tree, ray } = self;
        let boxes = Compressed::<R, _>::new(&tree.nodes, &tree.triangles, ray);
        let mut visitor = OccludedVisitor { triangles: Triangles::<R::Four>::new(tree, ray), occluded: false };
        walk(&boxes, Child::ROOT, ray.tmax.next_down(), &mut visitor);
        visitor.occluded
    }
}

impl<F: Row<LEAF_WIDTH>> Visitor for OccludedVisitor<'_, F> {
    #[inline(always)]
    fn visit(&mut self, child: Child, tmax: f32) -> Option<f32> {
        let occluded = &mut self.occluded;
        self.triangles.meet(child, tmax, |_| {
            *occluded = true;
            tmax
        });
        (!self.occluded).then_some(tmax)
    }
}

/// Shows the leaves of a compressed tree over boxes in the world to a visitor, by the place of each in the tree's order
/// (a leaf has one); it says how far the ray goes from there on, `None` to end the walk.
pub(super) struct EachMet<'a, V> {
    pub nodes: &'a [CwBvhNode],
    pub order: &'a [u32],
    pub ray: &'a Ray,
    pub visit: V,
}

struct EachVisitor<'a, V> {
    order: &'a [u32],
    visit: V,
}

impl<V: FnMut(usize, f32) -> Option<f32>> RowKernel for EachMet<'_, V> {
    type Output = ();
    #[inline(always)]
    fn run<R: Rows>(self) {
        let EachMet { nodes, order, ray, visit } = self;
        let boxes = Compressed::<R, _>::new(nodes, order, ray);
        walk(&boxes, Child::ROOT, ray.tmax, &mut EachVisitor { order, visit });
    }
}

impl<V: FnMut(usize, f32) -> Option<f32>> Visitor for EachVisitor<'_, V> {
    #[inline(always)]
    fn visit(&mut self, child: Child, mut tmax: f32) -> Option<f32> {
        let (first, count) = leaf(child);
        for place in first..first + count {
            tmax = (self.visit)(self.order[place] as usize, tmax)?;
        }
        Some(tmax)
    }
}
