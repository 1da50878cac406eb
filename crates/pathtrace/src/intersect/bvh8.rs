//! A BVH of eight boxes a node for one ray at a time, for scenes too large to test every ray against everything.
//!
//! All of it lies in blocks of 256 bytes: a node keeps the bounds of its eight children side by side, so that a ray
//! meets all eight in a dozen instructions (Wald, Benthin and Boulos, "Getting Rid of Packets", RT 2008), and a leaf
//! keeps the corners of up to four triangles in the same way, with what shading asks of them: memory is waited for once
//! a node, once a leaf and never again. Spheres and disks are leaves of their own, in a list beside.
//!
//! [`super::bvh8_build`] makes the blocks, [`super::bvh8_walk`] goes through them, [`super::bvh8_leaf`] meets
//! triangles.

use super::bvh8_leaf::{Closest, Occluded};
use super::coincident::Groups;
use super::cutouts::Cutouts;
use super::primitive::{Primitive, Surface};
use super::{Blocker, Hit, Intersection, NO_INSTANCE, Ray, SurfacePoints};
use crate::vectors::lane_vector;
use obvhs::aabb::Aabb;
use scene::Vec3;
use simd::RowLanes;

/// Triangles in a leaf, and floats in a row of it.
pub(super) const LEAF_WIDTH: usize = 4;

/// The eight-wide hierarchy.
pub(super) struct Bvh8 {
    pub root: Child,
    pub blocks: Blocks,
    pub curved: Vec<Curved>,
    /// Which shapes coincide, by their places in the scene's order.
    pub groups: Groups,
    /// Holes in them, if there are any.
    pub cutouts: Option<Box<Cutouts>>,
    pub lanes: RowLanes,
}

/// A sphere or a disk.
pub(super) struct Curved {
    pub primitive: Primitive,
    pub id: u32,
    pub surface: Surface,
}

/// Where a child lies and what it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Child(pub u32);

impl Child {
    /// Set where it is no node.
    pub const LEAF: u32 = 1 << 31;
    const CURVED: u32 = 1 << 30;
    /// No leaf: the first block.
    pub const ROOT: Self = Child(0);

    pub fn node(block: usize) -> Self {
        Child(block as u32)
    }

    pub fn triangles(block: usize) -> Self {
        Child(Self::LEAF | block as u32)
    }

    pub fn curved(index: usize) -> Self {
        Child(Self::LEAF | Self::CURVED | index as u32)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    pub fn is_curved(self) -> bool {
        self.0 & Self::CURVED != 0
    }

    /// The number of its block, or its place among what is round.
    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0 & !(Self::LEAF | Self::CURVED)) as usize
    }

    /// The number of a hit's primitive: its place among what is round, or its block and the place in that.
    #[inline(always)]
    fn primitive(self, lane: usize) -> u32 {
        if self.is_curved() { Self::LEAF | self.index() as u32 } else { (self.index() * LEAF_WIDTH + lane) as u32 }
    }

    /// The leaf and the place in it of [`Child::primitive`].
    #[inline(always)]
    fn of_primitive(primitive: u32) -> (Self, usize) {
        let index = (primitive & !Self::LEAF) as usize;
        if primitive & Self::LEAF != 0 {
            return (Self::curved(index), 0);
        }
        (Self::triangles(index / LEAF_WIDTH), index % LEAF_WIDTH)
    }
}

/// A node or a leaf.
///
/// A node, in rows of eight: lower and upper bounds along x, y and z, then the children. A leaf, in rows of four: the
/// three corners' x, y and z, in the corners' canonical order; then the triangles' places in the scene's order, their
/// normals' x, y and z, their materials and their lights. Numbers that are no floats are kept as a float's bits.
pub(super) type Block = [f32; 64];

const CHILDREN: usize = 6 * 8;
const IDS: usize = 9;
const NORMALS: usize = 10;
const MATERIALS: usize = 13;
const LIGHTS: usize = 14;

/// A block seen as a node.
#[derive(Clone, Copy)]
pub(super) struct Node<'a>(pub &'a Block);

impl<'a> Node<'a> {
    /// No children: boxes that no ray meets.
    pub const EMPTY: Block = {
        let mut block = [0.0; 64];
        let mut i = 0;
        while i < CHILDREN {
            block[i] = if i / 8 % 2 == 0 { f32::INFINITY } else { f32::NEG_INFINITY };
            i += 1;
        }
        block
    };

    /// Bounds of all children along an axis: lower if `side` is 0, upper if 1.
    #[inline(always)]
    pub fn bounds(self, axis: usize, side: usize) -> &'a [f32; 8] {
        &self.0.as_chunks().0[2 * axis + (side & 1)]
    }

    #[inline(always)]
    pub fn child(self, index: usize) -> Child {
        Child(self.0[CHILDREN + (index & 7)].to_bits())
    }

    pub fn set_child(block: &mut Block, index: usize, bounds: &Aabb, child: Child) {
        for axis in 0..3 {
            block[16 * axis + index] = bounds.min[axis];
            block[16 * axis + 8 + index] = bounds.max[axis];
        }
        Self::relink(block, index, child);
    }

    pub fn relink(block: &mut Block, index: usize, child: Child) {
        block[CHILDREN + index] = f32::from_bits(child.0);
    }
}

/// A block seen as a leaf.
#[derive(Clone, Copy)]
pub(super) struct Leaf<'a>(pub &'a Block);

impl<'a> Leaf<'a> {
    /// No triangles: three corners at the origin, which is no area.
    pub const EMPTY: Block = [0.0; 64];

    #[inline(always)]
    fn row(self, row: usize) -> &'a [f32; LEAF_WIDTH] {
        &self.0.as_chunks().0[row & 15]
    }

    /// A coordinate of one corner of all triangles.
    #[inline(always)]
    pub fn corner(self, corner: usize, axis: usize) -> &'a [f32; LEAF_WIDTH] {
        self.row(3 * corner + axis)
    }

    #[inline(always)]
    fn vector(self, row: usize, lane: usize) -> Vec3 {
        Vec3::new(self.row(row)[lane], self.row(row + 1)[lane], self.row(row + 2)[lane])
    }

    /// The sorted corners of one triangle.
    #[inline(always)]
    pub fn corners(self, lane: usize) -> [Vec3; 3] {
        [self.vector(0, lane), self.vector(3, lane), self.vector(6, lane)]
    }

    #[inline(always)]
    pub fn id(self, lane: usize) -> u32 {
        self.row(IDS)[lane].to_bits()
    }

    pub fn surface(self, lane: usize) -> Surface {
        let [material, light] = [MATERIALS, LIGHTS].map(|row| self.row(row)[lane].to_bits());
        Surface { normal: self.vector(NORMALS, lane), material, light }
    }

    pub fn set_triangle(block: &mut Block, lane: usize, corners: [Vec3; 3], id: u32, surface: &Surface) {
        let rows = block.as_chunks_mut::<LEAF_WIDTH>().0;
        for axis in 0..3 {
            for corner in 0..3 {
                rows[3 * corner + axis][lane] = corners[corner][axis];
            }
            rows[NORMALS + axis][lane] = surface.normal[axis];
        }
        rows[IDS][lane] = f32::from_bits(id);
        rows[MATERIALS][lane] = f32::from_bits(surface.material);
        rows[LIGHTS][lane] = f32::from_bits(surface.light);
    }
}

/// Blocks in whole lines of the cache, and never on two pages.
pub(super) struct Blocks {
    floats: Vec<f32>,
    first: usize,
}

impl Blocks {
    /// So many blocks of zeros, which the system provides page by page as they are written.
    pub fn zeroed(count: usize) -> Self {
        let mut floats = vec![0.0f32; 64 * count + 64];
        simd::ask_for_large_pages(&mut floats);
        let first = (floats.as_ptr().addr().wrapping_neg() / 4) % 64;
        Blocks { floats, first }
    }

    #[inline(always)]
    pub fn all(&self) -> &[Block] {
        self.floats[self.first..].as_chunks().0
    }

    pub fn all_mut(&mut self) -> &mut [Block] {
        self.floats[self.first..].as_chunks_mut().0
    }
}

/// The nearest candidate so far.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    pub t: f32,
    pub id: u32,
    /// Where it was met; a node if nowhere.
    pub child: Child,
    /// Which of the leaf's triangles, and twice the areas that the ray's point cuts it into.
    pub lane: usize,
    pub areas: [f32; 3],
}

impl Bvh8 {
    /// The nearest hit before `ray.tmax`, see [`super::Accel::closest`].
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let Nearest { t, child, lane, areas: [u, v, w], .. } = self.nearest(ray);
        if !child.is_leaf() {
            return None;
        }
        let sum = u + v + w;
        let barycentrics = if child.is_curved() { [0.0; 3] } else { [u / sum, v / sum, w / sum] };
        Some(Hit { t, primitive: child.primitive(lane), instance: NO_INSTANCE, barycentrics })
    }

    /// What the ray has met that has this hit.
    pub fn intersection(&self, ray: &Ray, hit: &Hit) -> Intersection {
        let (child, lane) = Child::of_primitive(hit.primitive);
        if child.is_curved() {
            let Curved { primitive, surface, .. } = &self.curved[child.index()];
            return primitive.intersection(ray, hit, surface);
        }
        let leaf = Leaf(&self.blocks.all()[child.index()]);
        let (corners, surface) = (leaf.corners(lane).map(lane_vector), leaf.surface(lane));
        surface.intersection(SurfacePoints::on_triangle(corners, hit.barycentrics, lane_vector(surface.normal)))
    }

    /// The place in the scene's order of what was hit.
    pub fn id(&self, hit: &Hit) -> u32 {
        let (child, lane) = Child::of_primitive(hit.primitive);
        match child.is_curved() {
            true => self.curved[child.index()].id,
            false => Leaf(&self.blocks.all()[child.index()]).id(lane),
        }
    }

    /// The corners of the triangle that was hit; of what is round none that say anything.
    pub fn corners(&self, hit: &Hit) -> [Vec3; 3] {
        let (child, lane) = Child::of_primitive(hit.primitive);
        if child.is_curved() { [Vec3::ZERO; 3] } else { Leaf(&self.blocks.all()[child.index()]).corners(lane) }
    }

    /// Whether a ray that cuts a leaf's triangle into these areas passes a hole in it.
    #[inline(always)]
    pub fn is_hole(&self, leaf: Leaf, lane: usize, areas: impl FnOnce() -> [f32; 3]) -> bool {
        let hole = |cutouts: &Cutouts| cutouts.is_hole(leaf.id(lane), leaf.surface(lane).material, areas());
        self.cutouts.as_deref().is_some_and(hole)
    }

    /// Whether a ray passes what is round, which has one place in textures.
    pub fn is_curved_hole(&self, curved: &Curved) -> bool {
        let material = curved.surface.material;
        self.cutouts.as_ref().is_some_and(|cutouts| cutouts.is_hole(curved.id, material, [0.0; 3]))
    }

    /// The nearest hit, as little of it as the walk carries; none has the id `u32::MAX`.
    #[inline(always)]
    pub fn nearest(&self, ray: &Ray) -> Nearest {
        self.lanes.run(Closest { bvh: self, ray })
    }

    /// Whether anything that `blocks` lies on the ray before `ray.tmax`.
    pub fn occluded_by(&self, ray: &Ray, blocks: impl Fn(Blocker) -> bool) -> bool {
        self.lanes.run(Occluded { bvh: self, ray, blocks })
    }
}
