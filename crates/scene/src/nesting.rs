//! Which glass may stand where. A dielectric's index is stated against what surrounds its surface, so every surface is
//! right by itself as long as no two glass shapes overlap: there neither surface's "outside" would be what it says. A
//! scene file with overlapping glass is refused.
//!
//! Allowed are shapes that lie apart, round ones that touch, and one wholly inside another. Flat faces must not touch:
//! of two faces in one place a ray meets only one. Meshes are judged by their bounding box, but for lying inside
//! another shape. Open shapes (rectangles, disks) are not looked at; glass of index 1 is, for a slider may give it
//! another.

use crate::{Bsdf, Geometry, Instance, Material, Shape};
use glam::{DVec2, DVec3, Vec3};

/// Gap, relative to the size of the shapes, that keeps flat faces apart.
const SMALLEST_GAP: f64 = 1e-6;

/// A closed shape, in f64.
struct Solid<'a> {
    index: usize,
    lo: DVec3,
    hi: DVec3,
    form: Form<'a>,
}

enum Form<'a> {
    Ball {
        center: DVec3,
        radius: f64,
    },
    Block(Block),
    /// Its corners are looked at only where it may lie inside another: there may be millions.
    Mesh(&'a Geometry),
}

/// A box turned about the vertical.
struct Block {
    center: DVec3,
    half: DVec3,
    /// Unit direction of its own x in the plane (x, z).
    x: DVec2,
}

/// The first two shapes whose glass overlaps, by index: (earlier, later).
pub fn overlap(shapes: &[Shape], materials: &[Material]) -> Option<(usize, usize)> {
    let refracts = |s: &Shape| matches!(materials[s.material].bsdf, Bsdf::Dielectric { .. });
    let glass = shapes.iter().enumerate().filter(|(_, shape)| refracts(shape));
    let mut solids: Vec<Solid> = glass.filter_map(|(index, shape)| Solid::new(index, &shape.geometry)).collect();
    solids.sort_by(|a, b| a.lo.x.total_cmp(&b.lo.x));
    let (mut found, mut endless): (Option<(usize, usize)>, _) = (None, Effort::corners(usize::MAX));
    for (i, a) in solids.iter().enumerate() {
        let near = solids[i + 1..].iter().take_while(|b| b.lo.x <= a.hi.x);
        for b in near.filter(|b| overlaps(a, b, &mut endless)) {
            let pair = (a.index.min(b.index), a.index.max(b.index));
            found = Some(found.map_or(pair, |other| other.min(pair)));
        }
    }
    found
}

/// What may be looked at before an answer is due: pairs of shapes and corners of meshes.
#[derive(Debug)]
pub struct Effort(usize);

impl Effort {
    /// What a pair of shapes costs, in corners.
    const OF_A_PAIR: usize = 8;

    /// So many corners, a few nanoseconds each.
    pub fn corners(most: usize) -> Self {
        Effort(most)
    }

    /// Takes so much of it; whether there was as much.
    fn take(&mut self, corners: usize) -> bool {
        let left = self.0.checked_sub(corners);
        self.0 = left.unwrap_or(0);
        left.is_some()
    }
}

/// The first shape of `glass` that overlaps the one at `index`, by index. What there is no effort left for does not.
pub fn overlap_with<'s>(
    (index, geometry): (usize, &Geometry),
    glass: impl Iterator<Item = (usize, &'s Geometry)>,
    effort: &mut Effort,
) -> Option<usize> {
    let one = Solid::new(index, geometry)?;
    let mut others = glass.filter(|(other, _)| *other != index);
    let found = others
        .find(|(other, geometry)| Solid::new(*other, geometry).is_some_and(|other| overlaps(&one, &other, effort)));
    found.map(|(other, _)| other)
}

/// Whether two shapes lie neither apart nor one wholly in the other.
fn overlaps(a: &Solid, b: &Solid, effort: &mut Effort) -> bool {
    effort.take(Effort::OF_A_PAIR) && !apart(a, b) && !inside(a, b, effort) && !inside(b, a, effort)
}

/// Whether a point lies inside a ball or a box; other shapes hold none.
pub(crate) fn holds(geometry: &Geometry, point: Vec3) -> bool {
    let solid = Solid::new(0, geometry);
    solid.is_some_and(|solid| solid.holds(point.as_dvec3(), 0.0))
}

impl<'a> Solid<'a> {
    fn new(index: usize, geometry: &'a Geometry) -> Option<Self> {
        let form = match geometry {
            Geometry::Rectangle { .. } | Geometry::Disk { .. } => return None,
            Geometry::Sphere { center, radius } => Form::Ball { center: center.as_dvec3(), radius: f64::from(*radius) },
            Geometry::Box { corner, size, turn_y } => {
                let half = 0.5 * size.as_dvec3();
                let (sin, cos) = f64::from(*turn_y).to_radians().sin_cos();
                let x = DVec2::new(cos, sin);
                let middle = x * half.x + x.perp() * half.z;
                let center = corner.as_dvec3() + DVec3::new(middle.x, half.y, middle.y);
                Form::Block(Block { center, half, x })
            }
            Geometry::Mesh(_) | Geometry::Instance(_) => Form::Mesh(geometry),
        };
        let (lo, hi) = geometry.bounds();
        Some(Solid { index, lo: lo.as_dvec3(), hi: hi.as_dvec3(), form })
    }

    /// Whether a ball of radius `margin` about a point lies inside; meshes hold none.
    fn holds(&self, point: DVec3, margin: f64) -> bool {
        match &self.form {
            Form::Ball { center, radius } => point.distance(*center) + margin <= *radius,
            Form::Block(block) => (block.local(point).abs() + margin).cmple(block.half).all(),
            Form::Mesh(_) => false,
        }
    }

    fn gap(&self) -> f64 {
        SMALLEST_GAP * (self.hi - self.lo).max_element()
    }

    /// Itself, or for a mesh its bounding box.
    fn block(&self) -> Block {
        match &self.form {
            Form::Block(Block { center, half, x }) => Block { center: *center, half: *half, x: *x },
            _ => Block { center: 0.5 * (self.lo + self.hi), half: 0.5 * (self.hi - self.lo), x: DVec2::X },
        }
    }
}

impl Block {
    /// A point in the block's own axes, from its centre.
    fn local(&self, point: DVec3) -> DVec3 {
        let d = point - self.center;
        let flat = DVec2::new(d.x, d.z);
        DVec3::new(flat.dot(self.x), d.y, flat.dot(self.x.perp()))
    }

    fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        (0..8u8).map(|i| {
            let sign = |bit: u8| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let flat = self.x * (sign(0) * self.half.x) + self.x.perp() * (sign(2) * self.half.z);
            self.center + DVec3::new(flat.x, sign(1) * self.half.y, flat.y)
        })
    }

    /// Half the block's width along a unit direction of the plane (x, z).
    fn reach(&self, along: DVec2) -> f64 {
        self.half.x * self.x.dot(along).abs() + self.half.z * self.x.perp().dot(along).abs()
    }
}

fn apart(a: &Solid, b: &Solid) -> bool {
    match (&a.form, &b.form) {
        (Form::Ball { center: c, radius: r }, Form::Ball { center: d, radius: s }) => {
            c.distance(*d) >= (r + s) * (1.0 - SMALLEST_GAP)
        }
        (Form::Ball { center, radius }, _) => ball_apart_from(*center, *radius, &b.block()),
        (_, Form::Ball { center, radius }) => ball_apart_from(*center, *radius, &a.block()),
        _ => blocks_apart(&a.block(), &b.block(), a.gap().max(b.gap())),
    }
}

fn ball_apart_from(center: DVec3, radius: f64, block: &Block) -> bool {
    (block.local(center).abs() - block.half).max(DVec3::ZERO).length() >= radius * (1.0 - SMALLEST_GAP)
}

/// By separating axes: both stand upright, so the vertical and their horizontal axes are all there are.
fn blocks_apart(a: &Block, b: &Block, gap: f64) -> bool {
    let between = b.center - a.center;
    let flat = DVec2::new(between.x, between.z);
    let sideways = [a.x, a.x.perp(), b.x, b.x.perp()];
    between.y.abs() > a.half.y + b.half.y + gap
        || sideways.iter().any(|&axis| flat.dot(axis).abs() > a.reach(axis) + b.reach(axis) + gap)
}

/// Whether `a` lies wholly inside `b`. A mesh does that there is no effort left for.
fn inside(a: &Solid, b: &Solid, effort: &mut Effort) -> bool {
    let holds = |point, margin| b.holds(point, margin);
    match &a.form {
        Form::Ball { center, radius } => holds(*center, radius + a.gap()),
        Form::Block(block) => block.corners().all(|corner| holds(corner, a.gap())),
        // balls and boxes hold all of a mesh whose box they hold; meshes hold none
        Form::Mesh(_) if matches!(b.form, Form::Mesh(_)) => false,
        Form::Mesh(_) if a.block().corners().all(|corner| holds(corner, a.gap())) => true,
        Form::Mesh(geometry) => match geometry {
            Geometry::Instance(Instance { mesh, to_world }) => {
                let to_world = to_world.as_daffine3();
                let corners = mesh.positions().iter().map(|p| to_world.transform_point3(p.as_dvec3()).as_vec3());
                all_inside(corners, b, a.gap(), effort)
            }
            other => all_inside(other.flat_triangles().0.iter().copied(), b, a.gap(), effort),
        },
    }
}

fn all_inside(corners: impl Iterator<Item = Vec3>, b: &Solid, gap: f64, effort: &mut Effort) -> bool {
    for corner in corners {
        if !effort.take(1) {
            return true;
        }
        if !b.holds(corner.as_dvec3(), gap) {
            return false;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stand_ins::FakeMaterial;

    fn overlap_of(geometry: [Geometry; 2]) -> bool {
        let glass = Material {
            name: "glass".into(),
            bsdf: Bsdf::Dielectric { ior: 1.5 },
            emission: None,
            surface: Default::default(),
            fake: FakeMaterial::default(),
        };
        let shapes = geometry.map(|geometry| Shape { geometry, material: 0 });
        let found = overlap(&shapes, &[glass]);
        assert!(found.is_none_or(|pair| pair == (0, 1)));
        found.is_some()
    }

    fn ball(x: f32, radius: f32) -> Geometry {
        Geometry::Sphere { center: Vec3::new(x, 0.0, 0.0), radius }
    }

    fn block(x: f32, size: f32, turn_y: f32) -> Geometry {
        Geometry::Box { corner: Vec3::new(x, -0.5 * size, -0.5 * size), size: Vec3::splat(size), turn_y }
    }

    #[test]
    fn balls_may_touch_or_nest_but_not_overlap() {
        assert!(!overlap_of([ball(0.0, 1.0), ball(2.0, 1.0)]));
        assert!(!overlap_of([ball(0.0, 1.0), ball(0.3, 0.5)]));
        assert!(!overlap_of([ball(0.3, 0.5), ball(0.0, 1.0)]));
        assert!(overlap_of([ball(0.0, 1.0), ball(1.9, 1.0)]));
        assert!(overlap_of([ball(0.0, 1.0), ball(0.0, 1.0)]));
    }

    #[test]
    fn of_meshes_as_much_is_looked_at_as_there_is_effort_for() {
        let corners = (0..100).map(|i| Vec3::new(0.0, (i as f32).sin(), (i as f32).cos()) * 0.9).collect();
        let mesh = Geometry::mesh(corners, vec![[0, 1, 2]]);
        let overlaps_with = |other: &Geometry, most: usize| {
            let glass = [(0, &mesh), (1, other)].into_iter();
            overlap_with((0, &mesh), glass, &mut Effort::corners(most))
        };
        // a ball whose surface the mesh crosses at its last corners
        let across = Geometry::Sphere { center: Vec3::new(0.0, 0.05, 0.0), radius: 0.93 };
        assert_eq!(overlaps_with(&across, 1000), Some(1));
        assert_eq!(overlaps_with(&across, 0), None);
        assert_eq!(overlaps_with(&ball(0.0, 1.0), 1000), None, "it lies inside");
        assert_eq!(overlaps_with(&ball(0.0, 1.0), 10), None);
        assert_eq!(overlaps_with(&ball(0.0, 0.5), 1000), Some(1));
    }

    #[test]
    fn blocks_need_a_gap_and_their_turn_counts() {
        assert!(!overlap_of([block(0.0, 1.0, 0.0), block(1.001, 1.0, 0.0)]));
        assert!(overlap_of([block(0.0, 1.0, 0.0), block(1.0, 1.0, 0.0)]));
        assert!(!overlap_of([block(0.0, 2.0, 0.0), block(0.5, 0.5, 0.0)]));
        // a diamond whose corner would lie in the other's bounding box
        let diamond = Geometry::Box { corner: Vec3::new(0.0, -0.5, 0.0), size: Vec3::ONE, turn_y: 45.0 };
        let beside = Geometry::Box { corner: Vec3::new(0.5, -0.5, -0.4), size: Vec3::splat(0.6), turn_y: 0.0 };
        assert!(!overlap_of([diamond, beside]));
    }

    #[test]
    fn balls_and_blocks() {
        assert!(!overlap_of([ball(0.0, 1.0), block(1.0, 3.0, 0.0)]));
        assert!(overlap_of([ball(0.0, 1.0), block(0.9, 3.0, 0.0)]));
        assert!(!overlap_of([ball(0.0, 1.0), block(-0.3, 0.6, 0.0)]));
        assert!(!overlap_of([ball(0.0, 1.0), block(-1.5, 3.0, 0.0)]));
    }

    #[test]
    fn a_mesh_is_its_box_unless_it_lies_inside() {
        let mesh = |scale: f32, x: f32| {
            let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * scale + Vec3::X * x);
            Geometry::mesh(positions.to_vec(), vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        };
        assert!(!overlap_of([ball(0.0, 1.0), mesh(0.5, 0.0)]));
        assert!(!overlap_of([mesh(0.5, 1.5), ball(0.0, 1.0)]));
        assert!(overlap_of([mesh(0.5, 0.8), ball(0.0, 1.0)]));
    }
}
