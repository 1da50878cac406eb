//! Trees over lights: what bounds groups of them, and how they are divided.

use super::Light;
use super::flat::{Flat, Outline};
use super::tree::LEAF;
use film::colour::luminance;
use scene::Vec3;
use std::f32::consts::{FRAC_PI_2, PI};

/// What bounds the light of some lights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// The box around them.
    pub lo: Vec3,
    pub hi: Vec3,
    /// A cone that holds their normals: its axis, and the angle to its side, pi where there is no normal.
    pub axis: Vec3,
    pub spread: f32,
    /// Largest radiant intensity, the sum of theirs.
    pub intensity: f32,
}

/// A group of lights, or one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    /// Of a sphere around them.
    pub center: Vec3,
    pub radius: f32,
    /// Of a cone that holds their normals.
    pub axis: Vec3,
    /// Cosine of the angle to its side.
    pub cos_spread: f32,
    /// Largest radiant intensity in any direction.
    pub intensity: f32,
    /// Children or a light, see [`LEAF`].
    pub contents: u32,
}

/// Depth from which on groups are halved: trails have 32 bits, and no more than 2^20 lights are left to divide there.
const HALVED: u32 = 12;

/// Slices into which a group is sorted along each axis, between which it is divided.
const SLICES: usize = 12;

/// The nodes of a tree, the root first and children side by side, and of each light the way to it.
pub(super) fn nodes_over(bounds: &[Bounds]) -> (Vec<Node>, Vec<u32>) {
    let mut lights: Vec<u32> = (0..bounds.len() as u32).collect();
    let mut nodes = vec![node_of(bounds, &lights)];
    let mut trails = vec![0; bounds.len()];
    // a node, the group below it, and the way there
    let mut waiting = vec![(0usize, 0..lights.len(), 0u32, 0u32)];
    while let Some((node, range, trail, depth)) = waiting.pop() {
        let group = &mut lights[range.clone()];
        if let [light] = group {
            nodes[node].contents = LEAF | *light;
            trails[*light as usize] = trail;
            continue;
        }
        let middle = range.start + divide(bounds, group, depth);
        let halves = [range.start..middle, middle..range.end];
        nodes[node].contents = nodes.len() as u32;
        for (bit, half) in (0u32..).zip(halves) {
            waiting.push((nodes.len(), half.clone(), trail | bit << depth, depth + 1));
            nodes.push(node_of(bounds, &lights[half]));
        }
    }
    (nodes, trails)
}

/// Sorts a group of two at least into two and says how many are in the first.
fn divide(bounds: &[Bounds], group: &mut [u32], depth: u32) -> usize {
    let of = |light: &u32| &bounds[*light as usize];
    let whole = union_of(group.iter().map(of));
    let best = if depth < HALVED { cheapest(bounds, group, &whole) } else { None };
    if let Some((axis, slice)) = best {
        let in_first = |light: &u32| slice_of(of(light), &whole, axis) < slice;
        group.sort_by_key(|light| !in_first(light));
        return group.partition_point(in_first);
    }
    let axis = (whole.hi - whole.lo).max_position();
    let half = group.len() / 2;
    group.sort_by(|a, b| of(a).center()[axis].total_cmp(&of(b).center()[axis]).then(a.cmp(b)));
    half
}

/// Axis and slice between which both parts cost least, if any lights lie on both sides: the surface area orientation
/// heuristic, with the regularity of section 4.4 in the paper.
fn cheapest(bounds: &[Bounds], group: &[u32], whole: &Bounds) -> Option<(usize, usize)> {
    let size = whole.hi - whole.lo;
    let mut best: Option<(f32, (usize, usize))> = None;
    for axis in (0..3).filter(|&axis| size[axis] > 0.0) {
        let mut slices = [None; SLICES];
        for light in group {
            let of_light = &bounds[*light as usize];
            let slice: &mut Option<Bounds> = &mut slices[slice_of(of_light, whole, axis)];
            *slice = Some(slice.map_or(*of_light, |slice| slice.with(of_light)));
        }
        for slice in 1..SLICES {
            let [first, second] = [&slices[..slice], &slices[slice..]].map(|part| part.iter().flatten());
            if first.clone().next().is_none() || second.clone().next().is_none() {
                continue;
            }
            let cost = (union_of(first).cost() + union_of(second).cost()) * size.max_element() / size[axis];
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, (axis, slice)));
            }
        }
    }
    best.map(|(_, place)| place)
}

fn slice_of(bounds: &Bounds, whole: &Bounds, axis: usize) -> usize {
    let share = (bounds.center()[axis] - whole.lo[axis]) / (whole.hi[axis] - whole.lo[axis]);
    ((share * SLICES as f32) as usize).min(SLICES - 1)
}

fn union_of<'a>(bounds: impl Iterator<Item = &'a Bounds>) -> Bounds {
    bounds.copied().reduce(|sum, bounds| sum.with(&bounds)).unwrap_or(Bounds::OF_NOTHING)
}

fn node_of(bounds: &[Bounds], group: &[u32]) -> Node {
    let all = union_of(group.iter().map(|light| &bounds[*light as usize]));
    Node {
        center: all.center(),
        // rounding does not take a light out of it
        radius: 0.5 * (all.hi - all.lo).length() * (1.0 + 1e-5),
        axis: all.axis,
        cos_spread: if all.spread >= PI { -1.0 } else { (all.spread + 1e-3).min(PI).cos() },
        intensity: all.intensity,
        contents: 0,
    }
}

impl Bounds {
    const OF_NOTHING: Self = Bounds { lo: Vec3::ZERO, hi: Vec3::ZERO, axis: Vec3::Y, spread: 0.0, intensity: 0.0 };

    /// Of a light that has a place.
    pub fn of(light: &Light) -> Option<Self> {
        let everywhere = (Vec3::Y, PI);
        let ((lo, hi), (axis, spread), intensity) = match light {
            Light::Flat(flat, emission) => {
                let normals = if emission.two_sided { everywhere } else { (flat.normal, 0.0) };
                (box_of(flat), normals, luminance(emission.radiance) * flat.area)
            }
            Light::Sphere(sphere, emission) => {
                let (center, radius) = (sphere.center, sphere.radius);
                let intensity = luminance(emission.radiance) * PI * radius * radius;
                ((center - radius, center + radius), everywhere, intensity)
            }
            Light::Point(point) => ((point.position, point.position), everywhere, luminance(point.intensity)),
            Light::Sun(_) | Light::Environment(_) => return None,
        };
        Some(Bounds { lo, hi, axis, spread, intensity })
    }

    fn center(&self) -> Vec3 {
        0.5 * (self.lo + self.hi)
    }

    fn with(&self, other: &Bounds) -> Bounds {
        let (axis, spread) = cone_around((self.axis, self.spread), (other.axis, other.spread));
        let (lo, hi) = (self.lo.min(other.lo), self.hi.max(other.hi));
        Bounds { lo, hi, axis, spread, intensity: self.intensity + other.intensity }
    }

    /// What it costs to hold these lights in one group: intensity, times the surface of the box, times the solid angle into
    /// which they shine, weighted by the cosine.
    fn cost(&self) -> f32 {
        let size = self.hi - self.lo;
        let surface = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
        let (sin, cos) = self.spread.sin_cos();
        let reach = (self.spread + FRAC_PI_2).min(PI);
        let beside = 2.0 * reach * sin - (self.spread - 2.0 * reach).cos() - 2.0 * self.spread * sin + cos;
        self.intensity * surface * (2.0 * PI * (1.0 - cos) + FRAC_PI_2 * beside)
    }
}

fn box_of(flat: &Flat) -> (Vec3, Vec3) {
    let (corner, u, v) = (flat.corner, flat.edge_u, flat.edge_v);
    if flat.outline == Outline::Disk {
        let half = Vec3::from_array([0, 1, 2].map(|axis| u[axis].hypot(v[axis])));
        return (corner - half, corner + half);
    }
    let opposite = if flat.outline == Outline::Triangle { corner } else { corner + u + v };
    let corners = [corner, corner + u, corner + v, opposite];
    corners.into_iter().fold((corner, corner), |(lo, hi), corner| (lo.min(corner), hi.max(corner)))
}

/// The narrowest cone around two.
fn cone_around((a, spread_a): (Vec3, f32), (b, spread_b): (Vec3, f32)) -> (Vec3, f32) {
    let between = a.dot(b).clamp(-1.0, 1.0).acos();
    if (between + spread_b).min(PI) <= spread_a {
        return (a, spread_a);
    }
    if (between + spread_a).min(PI) <= spread_b {
        return (b, spread_b);
    }
    let spread = 0.5 * (spread_a + between + spread_b);
    let across = a.cross(b);
    if spread >= PI || across.length_squared() < 1e-12 {
        return (a, PI);
    }
    let turn = scene::glam::Quat::from_axis_angle(across.normalize(), spread - spread_a);
    ((turn * a).normalize(), spread)
}
