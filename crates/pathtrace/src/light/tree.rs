//! Many lights, chosen by what they may send to a point: Conty Estevez and Kulla, "Importance Sampling of Many Lights with
//! Adaptive Tree Splitting" (2018), with one light a sample as in pbrt-v4's BVHLightSampler, whose bounds these are but for
//! spheres in place of boxes. A point's normal is not asked: what chance meets from there is weighted by the density of
//! this choice, and paths do not keep the normals of their vertices.
//!
//! Twin: `shaders/pathtrace/light/tree.wgsl`.

use super::tree_build::{Node, nodes_over};
use super::{Light, LightBounds};
use crate::vectors::each_lane;
use scene::Vec3;
use simd::{Float, MOST_LANES, Vector, Word};

/// Lights in a tree.
#[derive(Debug, Clone)]
pub struct LightTree {
    /// The root first, children side by side.
    nodes: Vec<Node>,
    /// Of each light the way to it, from the root: bit by bit, whether it is the second of two.
    trails: Vec<u32>,
}

/// Bit of a node's contents: it is a leaf, and the rest is its light. Else it is the first of two nodes side by side.
pub(crate) const LEAF: u32 = 1 << 31;

/// The largest float below 1.
pub(crate) const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// Least square of a distance: nearer, intensity over it might be infinite.
pub(crate) const LEAST_SQUARE: f32 = 1e-20;

/// From so many lights on one is chosen by a tree. Over a floor below 64 to 4,000 small lamps that takes an eighth of the
/// samples or less, at .3 to .5 microseconds each where a search in running sums takes .02; of a ball of 1,000 triangles,
/// all of which are equally far from most points, a half.
pub(super) const MANY: usize = 128;

/// More lights than trails of 32 bits lead to surely: of so many one is chosen by power.
const MOST: usize = 1 << 20;

impl LightTree {
    /// Over all lights that have a place, which stand first; `None` where they are few.
    pub(super) fn over(lights: &[Light]) -> Option<Self> {
        let bounds: Vec<LightBounds> = lights.iter().map_while(LightBounds::of).collect();
        (MANY..=MOST).contains(&bounds.len()).then(|| LightTree::new(&bounds))
    }

    /// Over lights with these bounds, in their order; there must be one.
    pub(super) fn new(bounds: &[LightBounds]) -> Self {
        let (nodes, trails) = nodes_over(bounds);
        LightTree { nodes, trails }
    }

    /// The nodes, the root first.
    pub(crate) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// How many lights there are.
    pub(crate) fn len(&self) -> usize {
        self.trails.len()
    }

    /// Of each light the way to it: see [`LightTree`].
    pub(crate) fn trails(&self) -> &[u32] {
        &self.trails
    }

    /// The light that `u` in [0, 1) chooses for a point, and with what probability: 0 where none is found that may reach it.
    pub fn choose(&self, x: Vec3, u: f32) -> (u32, f32) {
        let (mut node, mut u, mut probability) = (&self.nodes[0], u, 1.0);
        while node.contents & LEAF == 0 {
            let shares = self.shares(node, x);
            let second = usize::from(u >= shares[0]);
            let share = shares[second];
            if share <= 0.0 {
                return (0, 0.0);
            }
            let passed = if second == 1 { shares[0] } else { 0.0 };
            u = ((u - passed) / share).clamp(0.0, BELOW_ONE);
            probability *= share;
            node = &self.nodes[node.contents as usize + second];
        }
        (node.contents & !LEAF, probability)
    }

    /// The probability with which [`LightTree::choose`] takes a light for a point.
    pub fn probability(&self, light: u32, x: Vec3) -> f32 {
        let Some(&(mut trail)) = self.trails.get(light as usize) else { return 0.0 };
        let (mut node, mut probability) = (&self.nodes[0], 1.0);
        while node.contents & LEAF == 0 {
            let second = (trail & 1) as usize;
            probability *= self.shares(node, x)[second];
            node = &self.nodes[node.contents as usize + second];
            trail >>= 1;
        }
        probability
    }

    /// [`LightTree::choose`] in each lane. One after the other and out of line: each goes its own way down, and inline it
    /// would slow kernels down that never come here.
    #[inline(always)]
    pub fn choose_lanes<F: Float>(&self, x: Vector<F>, u: F) -> (F::U, F) {
        let mut numbers = [0.0; MOST_LANES];
        u.store(&mut numbers);
        let (lights, probabilities) = self.choose_each(F::LANES, &each_lane(x), &numbers);
        (F::U::load(&lights), F::load(&probabilities))
    }

    /// [`LightTree::probability`] in each lane, as [`LightTree::choose_lanes`].
    #[inline(always)]
    pub fn probability_lanes<F: Float>(&self, light: F::U, x: Vector<F>) -> F {
        let mut lights = [0; MOST_LANES];
        light.store(&mut lights);
        F::load(&self.probability_each(F::LANES, &lights, &each_lane(x)))
    }

    #[cold]
    #[inline(never)]
    fn choose_each(
        &self,
        lanes: usize,
        x: &[Vec3; MOST_LANES],
        u: &[f32; MOST_LANES],
    ) -> ([u32; MOST_LANES], [f32; MOST_LANES]) {
        let mut chosen = ([0; MOST_LANES], [0.0; MOST_LANES]);
        for lane in 0..lanes {
            (chosen.0[lane], chosen.1[lane]) = self.choose(x[lane], u[lane]);
        }
        chosen
    }

    #[cold]
    #[inline(never)]
    fn probability_each(&self, lanes: usize, lights: &[u32; MOST_LANES], x: &[Vec3; MOST_LANES]) -> [f32; MOST_LANES] {
        std::array::from_fn(|lane| if lane < lanes { self.probability(lights[lane], x[lane]) } else { 0.0 })
    }

    /// Probabilities of a node's two: 0 of those whose light cannot get there.
    fn shares(&self, node: &Node, x: Vec3) -> [f32; 2] {
        let first = node.contents as usize;
        let parts = [first, first + 1].map(|child| self.nodes[child].importance(x));
        let sum = parts[0] + parts[1];
        if sum > 0.0 { parts.map(|part| part / sum) } else { [0.0; 2] }
    }
}

impl Node {
    /// A bound of what its lights send to a point: all of it from where it lies nearest, and turned towards it as far as any
    /// of its normals may be.
    fn importance(&self, x: Vec3) -> f32 {
        let away = x - self.center;
        let (distance2, radius2) = (away.length_squared(), self.radius * self.radius);
        let reach = distance2.max(radius2).max(LEAST_SQUARE);
        if distance2 <= radius2 {
            return self.intensity / reach;
        }
        let (angle, spread) = ((away.dot(self.axis) / distance2.sqrt()).clamp(-1.0, 1.0), self.cos_spread);
        let [sin_angle, sin_spread] = [angle, spread].map(|cosine| (1.0 - cosine * cosine).max(0.0).sqrt());
        // of the angle between axis and point that is beyond the spread, what is beyond the sphere's half
        let within = angle >= spread;
        let cos_beyond = if within { 1.0 } else { angle * spread + sin_angle * sin_spread };
        let sin_beyond = if within { 0.0 } else { sin_angle * spread - angle * sin_spread };
        let sin2_half = (radius2 / distance2.max(LEAST_SQUARE)).min(1.0);
        let cos_half = (1.0 - sin2_half).sqrt();
        let cosine = if cos_beyond >= cos_half { 1.0 } else { cos_beyond * cos_half + sin_beyond * sin2_half.sqrt() };
        self.intensity * cosine.max(0.0) / reach
    }
}

#[cfg(test)]
mod tests;
