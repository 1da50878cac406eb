//! One ray's way through a hierarchy of eight boxes a node, the nearest box first: a [`Bvh8`], or a mesh's tree
//! as [`super::mesh_walk`] reads it.

use super::Ray;
use super::bvh8::{Block, Bvh8, Child, Node};
use simd::{Row, Rows, Stack};

/// Places on the stack: the hierarchy is at most [`DEEPEST`] nodes deep and each leaves seven children for later.
const STACK: usize = 256;
/// See [`STACK`].
pub(super) const DEEPEST: usize = (STACK - 1) / 7;

/// What happens in leaves.
pub(super) trait Visitor {
    /// Looks at a leaf; only what lies up to the distance that it returns matters from here. `None` ends the walk.
    fn visit(&mut self, leaf: Child, tmax: f32) -> Option<f32>;
}

/// A hierarchy as one ray sees it.
pub(super) trait Boxes {
    /// Eight floats, one for each of a node's boxes.
    type Eight: Row<8>;
    /// A node at hand.
    type Node: Copy;
    /// The node in a place.
    fn node(&self, index: usize) -> Self::Node;
    /// Which of a node's boxes the ray meets up to `tmax`, as bits, and where it enters them.
    fn meet(&self, node: Self::Node, tmax: f32) -> (u32, Self::Eight);
    /// What is in one of a node's boxes.
    fn child(&self, node: Self::Node, index: usize) -> Child;
    /// Asks for a child to be brought near.
    fn prefetch(&self, child: Child);
}

/// A ray, ready for boxes: a plane at `x` is met at `x * inverse - origin * inverse`.
///
/// Directions of 0 count as 1e-25, so that no product is NaN. Near planes are moved towards the ray's start and far
/// planes away from it by 2^-21 of the origin's coordinate, more than the rounding of the products that cancel (Ize,
/// "Robust BVH Ray Traversal", JCGT 2(2), 2013); the boxes' own padding covers that of their coordinates.
struct BoxRay<F> {
    inverse: [F; 3],
    enter: [F; 3],
    leave: [F; 3],
    /// 1 along axes on which it goes backwards, where upper bounds are met first.
    side: [usize; 3],
}

impl<F: Row<8>> BoxRay<F> {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        let origin = ray.origin.to_array();
        let direction = ray.direction.to_array();
        let mut this =
            BoxRay { inverse: [F::splat(0.0); 3], enter: [F::splat(0.0); 3], leave: [F::splat(0.0); 3], side: [0; 3] };
        for axis in 0..3 {
            let d = direction[axis];
            let inverse = 1.0 / if d.abs() < 1e-25 { 1e-25 } else { d };
            let start = origin[axis] * inverse;
            let slack = start.abs() * (1.0 / 2_097_152.0);
            this.inverse[axis] = F::splat(inverse);
            this.enter[axis] = F::splat(-start - slack);
            this.leave[axis] = F::splat(-start + slack);
            this.side[axis] = usize::from(d < 0.0);
        }
        this
    }

    /// Which boxes are met, as [`Boxes::meet`].
    #[inline(always)]
    fn meet(&self, node: Node, tmax: f32) -> (u32, F) {
        let mut near = F::splat(0.0);
        let mut far = F::splat(tmax);
        for axis in 0..3 {
            let side = self.side[axis];
            near = F::load(node.bounds(axis, side)).mul_add(self.inverse[axis], self.enter[axis]).max(near);
            far = F::load(node.bounds(axis, side ^ 1)).mul_add(self.inverse[axis], self.leave[axis]).min(far);
        }
        (near.le(far), near)
    }
}

/// A [`Bvh8`] as one ray sees it.
struct Blocked<'a, R: Rows> {
    blocks: &'a [Block],
    ray: BoxRay<R::Eight>,
}

impl<'a, R: Rows> Boxes for Blocked<'a, R> {
    type Eight = R::Eight;
    type Node = Node<'a>;

    #[inline(always)]
    fn node(&self, index: usize) -> Node<'a> {
        Node(&self.blocks[index])
    }

    #[inline(always)]
    fn meet(&self, node: Node<'a>, tmax: f32) -> (u32, R::Eight) {
        self.ray.meet(node, tmax)
    }

    #[inline(always)]
    fn child(&self, node: Node<'a>, index: usize) -> Child {
        node.child(index)
    }

    #[inline(always)]
    fn prefetch(&self, child: Child) {
        R::prefetch(self.blocks, child.index());
    }
}

/// A child and the distance of its box: ordered as the distances are, which are not negative.
#[inline(always)]
fn entry(near: f32, child: Child) -> u64 {
    (u64::from(near.to_bits()) << 32) | u64::from(child.0)
}

#[inline(always)]
fn ordered(a: u64, b: u64) -> (u64, u64) {
    (a.min(b), a.max(b))
}

impl Bvh8 {
    /// Shows all leaves whose boxes the ray meets to the visitor.
    #[inline(always)]
    pub(super) fn walk<R: Rows>(&self, ray: &Ray, visitor: &mut impl Visitor) {
        let boxes = Blocked::<R> { blocks: self.blocks.all(), ray: BoxRay::new(ray) };
        walk(&boxes, self.root, ray.tmax, visitor);
    }
}

/// Shows all leaves below a child whose boxes the ray meets to the visitor, near ones first as far as it is cheap to say.
#[inline(always)]
pub(super) fn walk(boxes: &impl Boxes, root: Child, mut tmax: f32, visitor: &mut impl Visitor) {
    let mut stack = Stack::<u64, STACK>::default();
    let mut here = root;
    loop {
        if here.is_leaf() {
            match visitor.visit(here, tmax) {
                Some(t) => tmax = t,
                None => return,
            }
        } else {
            let node = boxes.node(here.index());
            let (mut met, near) = boxes.meet(node, tmax);
            if met != 0 {
                let first = met.trailing_zeros() as usize;
                met &= met - 1;
                if met == 0 {
                    here = boxes.child(node, first);
                    continue;
                }
                let near = near.to_array();
                let second = met.trailing_zeros() as usize;
                met &= met - 1;
                boxes.prefetch(boxes.child(node, first));
                boxes.prefetch(boxes.child(node, second));
                let (near_first, near_second) = (near[first & 7], near[second & 7]);
                if met == 0 {
                    // guessed rather than computed: the next node is on its way before the boxes are compared
                    if near_first <= near_second {
                        stack.push(entry(near_second, boxes.child(node, second)));
                        here = boxes.child(node, first);
                    } else {
                        stack.push(entry(near_first, boxes.child(node, first)));
                        here = boxes.child(node, second);
                    }
                    continue;
                }
                let (mut nearest, other) =
                    ordered(entry(near_first, boxes.child(node, first)), entry(near_second, boxes.child(node, second)));
                stack.push(other);
                while met != 0 {
                    let next = met.trailing_zeros() as usize;
                    met &= met - 1;
                    boxes.prefetch(boxes.child(node, next));
                    let (near, other) = ordered(nearest, entry(near[next & 7], boxes.child(node, next)));
                    stack.push(other);
                    nearest = near;
                }
                here = Child(nearest as u32);
                continue;
            }
        }
        loop {
            let Some(later) = stack.pop() else { return };
            if f32::from_bits((later >> 32) as u32) <= tmax {
                here = Child(later as u32);
                break;
            }
        }
    }
}
