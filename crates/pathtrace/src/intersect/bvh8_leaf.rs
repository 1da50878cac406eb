//! A ray against the triangles of a leaf, all at once: the same sums and products as [`Triangle::intersect`], so that
//! the same rays meet the same triangles at the same distances.

use super::bvh8::{Bvh8, Child, Curved, LEAF_WIDTH, Leaf, Nearest};
use super::bvh8_walk::Visitor;
use super::coincident::Groups;
use super::primitive::Surface;
use super::triangle::{ShearedRay, Triangle};
use super::{Blocker, Ray};
use simd::{Row, RowKernel, Rows};

/// A [`ShearedRay`] in rows.
pub(super) struct LeafRay<F> {
    /// The sheared axes x, y and z.
    pub axes: [usize; 3],
    origin: [F; 3],
    shear: [F; 2],
    inverse_depth: F,
}

/// What the rows say of a leaf's triangles: those that the ray may meet, as bits, and what to find out more with.
pub(super) struct Candidates<F> {
    pub bits: u32,
    /// Twice the areas opposite of the corners.
    pub areas: [F; 3],
    /// Of the corners, in the ray's frame.
    pub z: [F; 3],
}

impl<F: Row<LEAF_WIDTH>> LeafRay<F> {
    #[inline(always)]
    pub fn new(ray: &ShearedRay) -> Self {
        let z = ray.main_axis;
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let origin = ray.origin.to_array();
        LeafRay {
            axes: [x, y, z],
            origin: [F::splat(origin[x]), F::splat(origin[y]), F::splat(origin[z])],
            shear: [F::splat(ray.shear[0]), F::splat(ray.shear[1])],
            inverse_depth: F::splat(1.0 / ray.depth),
        }
    }

    /// One corner of all triangles of a leaf, along the sheared axes.
    #[inline(always)]
    fn corner(&self, leaf: Leaf, corner: usize) -> [F; 3] {
        let [x, y, z] = self.axes;
        [F::load(leaf.corner(corner, x)), F::load(leaf.corner(corner, y)), F::load(leaf.corner(corner, z))]
    }

    /// The corner in the ray's frame.
    #[inline(always)]
    fn apply(&self, [x, y, z]: [F; 3]) -> [F; 3] {
        let z = z - self.origin[2];
        let x = x - self.origin[0];
        let y = y - self.origin[1];
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }

    /// Triangles whose areas are of one sign and not all 0, unless all their corners lie behind the ray's start or
    /// beyond `tmax`, seen with a margin for the inverse. Corners are given along the sheared axes.
    #[inline(always)]
    pub fn candidates(&self, [a, b, c]: [[F; 3]; 3], tmax: f32) -> Candidates<F> {
        let (a, b, c) = (self.apply(a), self.apply(b), self.apply(c));
        // the one of a and c has its sign turned by turning the difference, which is exact
        let areas = [edge(b, c), edge(c, a), edge(a, b)];
        let zero = F::splat(0.0);
        let least = areas[0].min(areas[1]).min(areas[2]);
        let most = areas[0].max(areas[1]).max(areas[2]);
        let one_sign = zero.le(least) ^ most.le(zero);
        let (ta, tb, tc) = (a[2] * self.inverse_depth, b[2] * self.inverse_depth, c[2] * self.inverse_depth);
        let ahead = zero.le(ta.max(tb).max(tc));
        let before_tmax = (ta.min(tb).min(tc) * F::splat(1.0 - 1.0 / 2_097_152.0)).le(F::splat(tmax));
        Candidates { bits: one_sign & ahead & before_tmax, areas, z: [a[2], b[2], c[2]] }
    }
}

/// Twice the signed area of (z axis, p, q).
#[inline(always)]
fn edge<F: Row<LEAF_WIDTH>>(p: [F; 3], q: [F; 3]) -> F {
    p[0] * q[1] - p[1] * q[0]
}

/// The same element of three rows.
#[inline(always)]
pub(super) fn element<F: Row<LEAF_WIDTH>>(rows: [F; 3], lane: usize) -> [f32; 3] {
    [rows[0].to_array()[lane], rows[1].to_array()[lane], rows[2].to_array()[lane]]
}

/// The next candidate, taken from the bits.
#[inline(always)]
pub(super) fn take(bits: &mut u32) -> usize {
    let lane = bits.trailing_zeros() as usize % LEAF_WIDTH;
    *bits &= *bits - 1;
    lane
}

impl Curved {
    /// Kept out of the walk: what it prepares for spheres, rays at triangles need not wait for.
    #[inline(never)]
    fn distance(&self, ray: &Ray, tmax: f32) -> Option<f32> {
        self.primitive.intersect(ray, &ShearedRay::new(ray), tmax).map(|(t, _)| t)
    }
}

/// Looks for the nearest hit.
pub(super) struct Closest<'a> {
    pub bvh: &'a Bvh8,
    pub ray: &'a Ray,
}

struct ClosestVisitor<'a, F> {
    task: Closest<'a>,
    sheared: ShearedRay,
    leaf_ray: LeafRay<F>,
    nearest: Nearest,
}

impl RowKernel for Closest<'_> {
    type Output = Nearest;
    #[inline(always)]
    fn run<R: Rows>(self) -> Nearest {
        let sheared = ShearedRay::new(self.ray);
        let leaf_ray = LeafRay::<R::Four>::new(&sheared);
        let (bvh, ray) = (self.bvh, self.ray);
        let nearest = Nearest { t: ray.tmax, id: u32::MAX, child: Child::ROOT, lane: 0, areas: [0.0; 3] };
        let mut visitor = ClosestVisitor { task: self, sheared, leaf_ray, nearest };
        bvh.walk::<R>(ray, &mut visitor);
        visitor.nearest
    }
}

impl<F: Row<LEAF_WIDTH>> Visitor for ClosestVisitor<'_, F> {
    #[inline(always)]
    fn visit(&mut self, child: Child, tmax: f32) -> Option<f32> {
        let Closest { bvh, ray } = self.task;
        // one step beyond, so that equal distances reach the comparison of ids
        let reach = |t: f32| if bvh.groups.any() { f32::INFINITY } else { t.next_up() };
        if child.is_curved() {
            let round = &bvh.curved[child.index()];
            if let Some(t) = round.distance(ray, reach(tmax))
                && !bvh.is_curved_hole(round)
            {
                self.nearest.offer(Nearest { t, id: round.id, child, lane: 0, areas: [0.0; 3] }, &bvh.groups);
            }
            return Some(self.nearest.t);
        }
        let leaf = Leaf(&bvh.blocks.all()[child.index()]);
        let corners = [self.leaf_ray.corner(leaf, 0), self.leaf_ray.corner(leaf, 1), self.leaf_ray.corner(leaf, 2)];
        let mut candidates = self.leaf_ray.candidates(corners, tmax);
        while candidates.bits != 0 {
            let lane = take(&mut candidates.bits);
            let triangle = Triangle::sorted(leaf.corners(lane));
            let areas = || element(candidates.areas, lane);
            if let Some(t) = triangle.distance(&self.sheared, element(candidates.z, lane), reach(self.nearest.t))
                && !bvh.is_hole(leaf, lane, areas)
            {
                let areas = areas();
                self.nearest.offer(Nearest { t, id: leaf.id(lane), child, lane, areas }, &bvh.groups);
            }
        }
        Some(self.nearest.t)
    }
}

impl Nearest {
    /// Takes a hit that comes first.
    #[inline(always)]
    fn offer(&mut self, other: Nearest, groups: &Groups) {
        if groups.comes_first((other.t, other.id), (self.t, self.id)) {
            *self = other;
        }
    }
}

/// Looks for any hit that `blocks`.
pub(super) struct Occluded<'a, B> {
    pub bvh: &'a Bvh8,
    pub ray: &'a Ray,
    pub blocks: B,
}

struct OccludedVisitor<'a, B, F> {
    task: Occluded<'a, B>,
    sheared: ShearedRay,
    leaf_ray: LeafRay<F>,
    occluded: bool,
}

impl<B: Fn(Blocker) -> bool> RowKernel for Occluded<'_, B> {
    type Output = bool;
    #[inline(always)]
    fn run<R: Rows>(self) -> bool {
        let sheared = ShearedRay::new(self.ray);
        let leaf_ray = LeafRay::<R::Four>::new(&sheared);
        let (bvh, ray) = (self.bvh, self.ray);
        let mut visitor = OccludedVisitor { task: self, sheared, leaf_ray, occluded: false };
        bvh.walk::<R>(ray, &mut visitor);
        visitor.occluded
    }
}

impl<B: Fn(Blocker) -> bool, F: Row<LEAF_WIDTH>> Visitor for OccludedVisitor<'_, B, F> {
    #[inline(always)]
    fn visit(&mut self, child: Child, tmax: f32) -> Option<f32> {
        let Occluded { bvh, ray, ref blocks } = self.task;
        if child.is_curved() {
            let round = &bvh.curved[child.index()];
            let Surface { material, light, .. } = round.surface;
            let met = round.distance(ray, tmax).filter(|_| !bvh.is_curved_hole(round));
            self.occluded = met.is_some_and(|t| blocks(Blocker { t, id: round.id, material, light }));
            return (!self.occluded).then_some(tmax);
        }
        let leaf = Leaf(&bvh.blocks.all()[child.index()]);
        let corners = [self.leaf_ray.corner(leaf, 0), self.leaf_ray.corner(leaf, 1), self.leaf_ray.corner(leaf, 2)];
        let mut candidates = self.leaf_ray.candidates(corners, tmax);
        while candidates.bits != 0 {
            let lane = take(&mut candidates.bits);
            let triangle = Triangle::sorted(leaf.corners(lane));
            if let Some(t) = triangle.distance(&self.sheared, element(candidates.z, lane), tmax)
                && !bvh.is_hole(leaf, lane, || element(candidates.areas, lane))
            {
                let Surface { material, light, .. } = leaf.surface(lane);
                if blocks(Blocker { t, id: leaf.id(lane), material, light }) {
                    self.occluded = true;
                    return None;
                }
            }
        }
        Some(tmax)
    }
}
