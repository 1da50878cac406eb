//! Surfaces that lie in one another: a lamp given twice, a rug in the floor, a disk in a tilted wall. Which of them rays
//! meet must not hang on how each one's distance was rounded: the one that comes first in the scene's order is there, and
//! the others are not, to the nearest hit, to shadow rays and to light sampling alike.
//!
//! Large meshes, instances of trees of their own, are not held against anything: of what coincides with one the nearer
//! is met, and at one distance what is no instance.
//!
//! Found once, when a scene is made ready. Where nothing coincides, as in most scenes, there are no groups, and nothing
//! is asked of them.
//!
//! Twin: `shaders/pathtrace/intersect/nearest.wgsl`, which is given the groups.

use super::NO_LIGHT;
use super::pairs::{Bounds, for_each_pair};
use super::sphere::Sphere;
use scene::Vec3;
use scene::glam::{DVec2, DVec3};
use simd::{Word, WordColumn};

/// What stands for the group of a surface that coincides with no other.
pub const NO_GROUP: u32 = u32::MAX;

/// Of meshes of more triangles only those are held against others that another shape comes near.
pub(super) const MOST_TRIANGLES: usize = 1024;

/// Rounding by which a plane may be off, in units of the largest coordinate: some of f32's.
pub(super) const FLAT: f64 = 4.0 / 16_777_216.0;

/// A surface as it is held against others.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    /// Its place in the scene's order.
    id: u32,
    /// Index into the list of lights, or [`NO_LIGHT`].
    light: u32,
    form: Form,
    low: Vec3,
    high: Vec3,
}

#[derive(Debug, Clone)]
enum Form {
    /// Corners around it, and its unit normal.
    Flat(Vec<DVec3>, DVec3),
    Sphere(Sphere),
}

/// Corners of the outline that stands for a disk, drawn around it.
const DISK_CORNERS: usize = 16;

impl Outline {
    /// A convex polygon; `None` without area.
    pub fn flat(id: u32, light: u32, corners: &[Vec3]) -> Option<Self> {
        let exact: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
        let normal = (exact[1] - exact[0]).cross(exact[exact.len() - 1] - exact[0]).try_normalize()?;
        Some(Self::polygon(id, light, exact, normal))
    }

    fn polygon(id: u32, light: u32, corners: Vec<DVec3>, normal: DVec3) -> Self {
        let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let rounded = corners.iter().map(|corner| corner.as_vec3());
        let (low, high) = rounded.fold(none, |(low, high), p| (low.min(p), high.max(p)));
        Outline { id, light, form: Form::Flat(corners, normal), low, high }
    }

    /// The polygon around a disk.
    pub fn disk(id: u32, light: u32, center: Vec3, normal: Vec3, radius: f32) -> Self {
        let normal = normal.as_dvec3().normalize();
        let (u, v) = normal.any_orthonormal_pair();
        let step = std::f64::consts::TAU / DISK_CORNERS as f64;
        let reach = f64::from(radius) / (0.5 * step).cos();
        let corner = |k: usize| {
            let (sine, cosine) = (step * k as f64).sin_cos();
            center.as_dvec3() + (u * cosine + v * sine) * reach
        };
        Self::polygon(id, light, (0..DISK_CORNERS).map(corner).collect(), normal)
    }

    pub fn sphere(id: u32, light: u32, sphere: Sphere) -> Self {
        let Sphere { center, radius } = sphere;
        Outline { id, light, form: Form::Sphere(sphere), low: center - radius, high: center + radius }
    }

    /// Lengths that say nothing here.
    fn rounding(&self) -> f64 {
        FLAT * f64::from(self.low.abs().max(self.high.abs()).max_element())
    }

    /// The axis that a flat one is at right angles to, exactly, and its coordinate there.
    fn level(&self) -> Option<(usize, f32)> {
        (0..3).find(|&axis| self.low[axis] == self.high[axis]).map(|axis| (axis, self.low[axis]))
    }

    /// Whether both lie in one plane, or are one sphere, as far as rounding lets them.
    fn lies_with(&self, other: &Outline) -> bool {
        // the plane of a large one is known better than its corners
        let (one, two) = (self.rounding(), other.rounding());
        let rounding = 0.25 * one.max(two) + 0.75 * one.min(two);
        match (&self.form, &other.form) {
            (Form::Flat(corners, normal), Form::Flat(others, other_normal)) => {
                if let (Some(level), Some(other)) = (self.level(), other.level()) {
                    // what is parallel to axes is not rounded at all
                    return level == other;
                }
                let in_plane = |points: &[DVec3], through: DVec3, normal: &DVec3| {
                    points.iter().all(|p| normal.dot(*p - through).abs() <= rounding)
                };
                // the plane of the larger one is known better
                in_plane(others, corners[0], normal) || in_plane(corners, others[0], other_normal)
            }
            (Form::Sphere(a), Form::Sphere(b)) => a == b,
            _ => false,
        }
    }

    /// Bounds with room for what rounding leaves out.
    fn grown(&self) -> Bounds {
        let room = Vec3::splat(self.rounding() as f32);
        (self.low - room, self.high + room)
    }

    /// Whether both cover some area together; of what lies in one plane.
    fn overlaps(&self, other: &Outline) -> bool {
        let (Form::Flat(corners, normal), Form::Flat(others, _)) = (&self.form, &other.form) else { return true };
        overlap(corners, others, *normal, self.rounding().max(other.rounding()))
    }
}

/// Whether two convex polygons at a right angle to `normal` cover some area together, more than a strip of width `slack`.
pub(super) fn overlap(corners: &[DVec3], others: &[DVec3], normal: DVec3, slack: f64) -> bool {
    let (u, v) = normal.any_orthonormal_pair();
    let flattened =
        |corners: &[DVec3]| -> Vec<DVec2> { corners.iter().map(|p| DVec2::new(u.dot(*p), v.dot(*p))).collect() };
    let [a, b] = [flattened(corners), flattened(others)];
    !separated(&a, &b, slack) && !separated(&b, &a, slack)
}

/// Whether a line along an edge of the first convex polygon parts both, which may overlap by `slack`.
fn separated(a: &[DVec2], b: &[DVec2], slack: f64) -> bool {
    let range = |axis: DVec2, of: &[DVec2]| {
        let along = of.iter().map(|p| axis.dot(*p));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), k| (low.min(k), high.max(k)))
    };
    (0..a.len()).any(|i| {
        let edge = a[(i + 1) % a.len()] - a[i];
        let axis = edge.perp().normalize_or_zero();
        let ((low_a, high_a), (low_b, high_b)) = (range(axis, a), range(axis, b));
        high_a <= low_b + slack || high_b <= low_a + slack
    })
}

/// Surfaces that coincide, each with the number of those that it lies with.
#[derive(Debug, Clone, Default)]
pub struct Groups {
    of_surface: WordColumn,
    of_light: WordColumn,
    lights: u32,
    any: bool,
}

impl Groups {
    /// Of so many surfaces and lights, those among these outlines that coincide.
    pub(super) fn of(outlines: &[Outline], surfaces: usize, lights: usize) -> Self {
        let sets = Sets::of(outlines);
        let (mut of_surface, mut of_light) = (vec![NO_GROUP; surfaces], vec![NO_GROUP; lights]);
        let mut any = false;
        for (index, outline) in outlines.iter().enumerate().filter(|(index, _)| sets.is_shared(*index)) {
            let group = sets.first(index) as u32;
            of_surface[outline.id as usize] = group;
            if let Some(of_light) = of_light.get_mut(outline.light as usize) {
                *of_light = group;
            }
            any = true;
        }
        if !any {
            return Groups::default();
        }
        let [of_surface, of_light] = [of_surface, of_light].map(WordColumn::new);
        Groups { of_surface, of_light, lights: lights as u32, any }
    }

    /// Whether a hit at a distance on the surface of an id comes before another: it is nearer, or as near and earlier in
    /// the scene's order; of surfaces that coincide the earlier, however their distances are rounded.
    #[inline(always)]
    pub(super) fn comes_first(&self, (t, id): (f32, u32), (other_t, other): (f32, u32)) -> bool {
        if self.any && other != u32::MAX {
            let group = self.of_surface(id);
            if group != NO_GROUP && group == self.of_surface(other) {
                return id < other;
            }
        }
        t < other_t || (t == other_t && id < other)
    }

    /// Whether any surface coincides with another.
    #[inline(always)]
    pub fn any(&self) -> bool {
        self.any
    }

    /// The groups of surfaces, or [`NO_GROUP`].
    #[inline(always)]
    pub fn of_surface<U: Word>(&self, id: U) -> U {
        if self.any { id.look_up_word(&self.of_surface) } else { U::splat(NO_GROUP) }
    }

    /// The groups of what shines as these lights, or [`NO_GROUP`]; of numbers that are no light's too.
    #[inline(always)]
    pub fn of_light<U: Word>(&self, light: U) -> U {
        if !self.any {
            return U::splat(NO_GROUP);
        }
        U::select(light.lt(U::splat(self.lights)), light.look_up_word(&self.of_light), U::splat(NO_GROUP))
    }
}

/// Sets of outlines that coincide, by whatever chain of others: each names another of its set, the first itself.
struct Sets {
    next: Vec<usize>,
    /// How many there are in the set of each first one.
    sizes: Vec<u32>,
}

impl Sets {
    fn of(outlines: &[Outline]) -> Self {
        let mut sets = Sets { next: (0..outlines.len()).collect(), sizes: vec![1; outlines.len()] };
        let bounds: Vec<Bounds> = outlines.iter().map(Outline::grown).collect();
        for_each_pair(&bounds, |a, b| {
            let (one, other) = (&outlines[a], &outlines[b]);
            if one.lies_with(other) && one.overlaps(other) {
                sets.join(a, b);
            }
        });
        // the halves of a rectangle that shines are one light
        for (index, [one, other]) in outlines.array_windows().enumerate() {
            // of a mesh each triangle is a light of its own
            let one_light = one.light == other.light && one.light != NO_LIGHT;
            if one_light && (sets.is_shared(index) || sets.is_shared(index + 1)) {
                sets.join(index, index + 1);
            }
        }
        sets
    }

    fn first(&self, mut index: usize) -> usize {
        while self.next[index] != index {
            index = self.next[index];
        }
        index
    }

    /// The smaller set becomes part of the larger, so that no chain is long.
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        if a != b {
            let (large, small) = if self.sizes[a] < self.sizes[b] { (b, a) } else { (a, b) };
            self.next[small] = large;
            self.sizes[large] += self.sizes[small];
        }
    }

    /// Whether an outline's set has others in it.
    fn is_shared(&self, index: usize) -> bool {
        self.sizes[self.first(index)] > 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::glam::{EulerRot, Quat};

    /// A square of this half side about a point, tilted.
    fn square(id: u32, half: f32, center: Vec3) -> Outline {
        let turn = Quat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.8);
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let corners = corners.map(|[x, y]: [f32; 2]| center + turn * Vec3::new(x * half, y * half, 0.0));
        Outline::flat(id, NO_LIGHT, &corners).expect("an area")
    }

    fn coincide(a: Outline, b: Outline) -> bool {
        Groups::of(&[a, b], 2, 0).any()
    }

    #[test]
    fn tilted_surfaces_coincide_in_one_plane_and_not_above_it() {
        let up = Quat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.8) * Vec3::Z;
        for (half, apart) in [(1.0, 1e-6), (100.0, 1e-5), (1e3, 1e-4), (1e4, 1e-3)] {
            assert!(coincide(square(0, half, Vec3::ZERO), square(1, 0.3, Vec3::ZERO)), "{half}");
            assert!(!coincide(square(0, half, Vec3::ZERO), square(1, 0.3, up * apart)), "{half}");
        }
        let far = Vec3::new(1000.0, -300.0, 700.0);
        assert!(coincide(square(0, 2.0, far), square(1, 0.5, far)));
    }

    #[test]
    fn neighbours_and_spheres_of_other_sizes_do_not_coincide() {
        let side = Quat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.8) * Vec3::X;
        assert!(!coincide(square(0, 1.0, Vec3::ZERO), square(1, 1.0, side * 2.0)));
        assert!(coincide(square(0, 1.0, Vec3::ZERO), square(1, 1.0, side * 1.9)));
        let ball = |id: u32, radius: f32| Outline::sphere(id, NO_LIGHT, Sphere { center: Vec3::splat(100.0), radius });
        assert!(coincide(ball(0, 0.3), ball(1, 0.3)));
        assert!(!coincide(ball(0, 0.3), ball(1, 0.3 - 1e-5)));
    }
}
