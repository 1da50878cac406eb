//! The eight-wide hierarchy against the two-wide one and against testing everything: the same hits, bit for bit, on all
//! kinds of lanes.

use super::Ray;
use super::bvh2::Bvh2;
use super::bvh8::Bvh8;
use super::bvh8_collapse::Listed;
use super::disk::Disk;
use super::primitive::{Primitive, Surface};
use super::sphere::Sphere;
use super::triangle::{ShearedRay, Triangle, triangle_normal};
use crate::sampling;
use crate::sampling::sampler::Sampler;
use rayon::prelude::*;
use scene::Vec3;
use simd::{Lanes, RowLanes};

/// Shapes with what every test needs of them.
struct Model {
    primitives: Vec<Primitive>,
    surfaces: Vec<Surface>,
    corners: Vec<[Vec3; 3]>,
    /// Somewhere inside, and how far it is to the outside.
    middle: Vec3,
    size: f32,
}

impl Model {
    fn new(corners: Vec<[Vec3; 3]>, middle: Vec3, size: f32) -> Self {
        let mut model = Model { primitives: vec![], surfaces: vec![], corners: vec![], middle, size };
        for corners in corners {
            if let Some(normal) = triangle_normal(corners) {
                model.corners.push(corners);
                model.add(Primitive::Triangle(Triangle::new(corners)), normal);
            }
        }
        model
    }

    fn add(&mut self, primitive: Primitive, normal: Vec3) {
        let material = self.primitives.len() as u32 % 3;
        self.surfaces.push(Surface { normal, material, light: self.primitives.len() as u32 });
        self.primitives.push(primitive);
    }

    fn shapes(&self) -> Listed<'_> {
        Listed { primitives: &self.primitives, surfaces: &self.surfaces }
    }

    /// A surface over a grid of `n` by `n` quads, from the unit square's points.
    fn grid(n: u32, point: impl Fn(f32, f32) -> Vec3) -> Vec<[Vec3; 3]> {
        let at = |i: u32, j: u32| point(i as f32 / n as f32, j as f32 / n as f32);
        let quad = |i, j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        let quads = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| quad(i, j));
        quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
    }

    /// A closed sphere with bumps.
    fn bumpy_sphere(n: u32, middle: Vec3, size: f32) -> Self {
        let corners = Self::grid(n, |u, v| {
            // both ends of a full turn are one point, to the bit
            let (theta, phi) = (std::f32::consts::PI * v, std::f32::consts::TAU * if u == 1.0 { 0.0 } else { u });
            let sin = if v == 1.0 { 0.0 } else { theta.sin() };
            let out = Vec3::new(sin * phi.cos(), theta.cos(), sin * phi.sin());
            middle + out * (size * (1.0 + 0.004 * (40.0 * out.x).sin() * (37.0 * out.z).cos()))
        });
        Self::new(corners, middle, size)
    }

    /// A cube of small squares, in the planes of which axis-parallel rays run.
    fn cube(n: u32, middle: Vec3, size: f32) -> Self {
        let mut corners = vec![];
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                corners.extend(Self::grid(n, |u, v| {
                    let mut p = [0.0; 3];
                    (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, 2.0 * u - 1.0, 2.0 * v - 1.0);
                    middle + Vec3::from_array(p) * size
                }));
            }
        }
        Self::new(corners, middle, size)
    }

    /// Triangles, spheres and disks of all sizes anywhere, every triangle twice: where they are met the earlier one
    /// counts.
    fn soup(count: u32) -> Self {
        let mut corners = vec![];
        let vector = |i, j| {
            let [x, y, z, w] = Sampler::independent(i, j, 5).unit4(0);
            (Vec3::new(x, y, z) * 2.0 - 1.0, w)
        };
        for i in 0..count {
            let (a, size) = vector(i, 0);
            let size = 0.003 + size.powi(4);
            let b = a + vector(i, 1).0 * size;
            corners.push([a, b, a + vector(i, 2).0 * size]);
        }
        corners.extend(corners.clone());
        let mut model = Self::new(corners, Vec3::ZERO, 1.0);
        for i in 0..count / 8 {
            let (center, size) = vector(i, 3);
            model.add(Primitive::Sphere(Sphere { center, radius: 0.2 * size.powi(4) }), Vec3::ZERO);
            let (center, size) = vector(i, 4);
            let normal = sampling::uniform_hemisphere([vector(i, 5).1, size]);
            model.add(Primitive::Disk(Disk { center, normal, radius: 0.2 * size.powi(4) }), normal);
        }
        model
    }

    /// The `i`th ray: anywhere, at a corner, at an edge or along an axis through a corner; from inside or from outside.
    fn ray(&self, i: u32) -> Ray {
        let [u, v, w, x] = Sampler::independent(i, 7, 1).unit4(0);
        let [a, b, c, d] = crate::sampling::rng::pcg4d([i, 11, 12, 13]);
        let from = sampling::cone(2.0, [u, v]) * self.size * if a & 8 == 0 { 0.5 * w.cbrt() } else { 1.5 + 3.0 * w };
        let origin = self.middle + from;
        let corners = self.corners[b as usize % self.corners.len()];
        let corner = corners[c as usize % 3];
        let towards = |p: Vec3| Ray::new(origin, (p - origin).normalize());
        match a % 4 {
            0 => Ray::new(origin, sampling::cone(2.0, [x, v])),
            1 => towards(corner),
            2 => towards(corner + (corners[(c as usize + 1) % 3] - corner) * x),
            _ => {
                let axis = d as usize % 3;
                let mut origin = corner;
                origin[axis] = self.middle[axis] - if d & 8 == 0 { 0.0 } else { 2.0 * self.size };
                let mut direction = Vec3::splat(if d & 16 == 0 { 0.0 } else { -0.0 });
                direction[axis] = if d & 32 == 0 { 1.0 } else { -1.0 };
                Ray::new(origin, direction)
            }
        }
    }

    /// Rays for which `differs` says so.
    fn differing(&self, rays: u32, differs: impl Fn(&Ray) -> bool + Sync) -> usize {
        (0..rays).into_par_iter().filter(|&i| differs(&self.ray(i))).count()
    }

    /// Tests everything. Returns the distance and number of the nearest hit.
    fn nearest(&self, ray: &Ray) -> Option<(u32, u32)> {
        let sheared = ShearedRay::new(ray);
        let hits = self.primitives.iter().enumerate();
        let hits = hits.filter_map(|(id, p)| p.intersect(ray, &sheared, ray.tmax).map(|hit| (hit.0, id as u32)));
        hits.min_by(|a, b| a.partial_cmp(b).unwrap()).map(|(t, id)| (t.to_bits(), id))
    }
}

fn hit(bvh: &Bvh8, ray: &Ray) -> Option<(u32, u32)> {
    let nearest = bvh.nearest(ray);
    (nearest.id != u32::MAX).then(|| (nearest.t.to_bits(), nearest.id))
}

fn each_lanes() -> impl Iterator<Item = RowLanes> {
    [Lanes::Avx512, Lanes::Avx2, Lanes::Array].into_iter().map(RowLanes::nearest_to)
}

/// Compares all that can be asked of a hierarchy.
fn agree_on(name: &str, model: &Model, rays: u32) {
    let two = Bvh2::new(&model.primitives, &model.surfaces);
    for lanes in each_lanes() {
        let eight = Bvh8::new(model.shapes(), lanes).expect("a hierarchy");
        let differing = model.differing(rays, |ray| {
            let nearest = two.nearest(ray);
            let expected = (nearest.id != u32::MAX).then(|| (nearest.t.to_bits(), nearest.id));
            let mut same = hit(&eight, ray) == expected;
            if let (Some(a), Some(b)) = (two.closest(ray), eight.closest(ray)) {
                same &= (a.t, a.barycentrics) == (b.t, b.barycentrics);
                let (a, b) = (two.intersection(ray, &a), eight.intersection(ray, &b));
                same &= a.point == b.point && (a.material, a.light) == (b.material, b.light);
                same &= b.light == nearest.id && b.material == nearest.id % 3;
            }
            same &= eight.occluded_by(ray, |_| true) == expected.is_some();
            same &= eight.occluded_by(ray, |met| met.material == 1) == two.occluded_by(ray, |met| met.material == 1);
            if let Some((t, _)) = expected {
                let until = |tmax| Ray { tmax, ..*ray };
                let t = f32::from_bits(t);
                same &= !eight.occluded_by(&until(0.999 * t), |_| true);
                same &= eight.occluded_by(&until(1.001 * t), |_| true);
            }
            !same
        });
        assert_eq!(differing, 0, "{name}, {lanes:?}: rays of {rays} that differ");
    }
}

#[test]
fn both_hierarchies_meet_the_same_triangles_at_the_same_distances() {
    agree_on("bumpy sphere", &Model::bumpy_sphere(150, Vec3::ZERO, 1.0), 150_000);
    agree_on("bumpy sphere far from the origin", &Model::bumpy_sphere(60, Vec3::splat(1e4), 1.0), 100_000);
    agree_on("cube", &Model::cube(40, Vec3::ZERO, 1.0), 150_000);
    agree_on("tiny cube", &Model::cube(10, Vec3::ZERO, 1e-4), 50_000);
    agree_on("huge cube", &Model::cube(10, Vec3::splat(1e4), 1e4), 50_000);
    agree_on("soup", &Model::soup(4000), 150_000);
}

#[test]
fn the_hierarchy_finds_what_testing_everything_finds() {
    for (name, model) in [
        ("bumpy sphere", Model::bumpy_sphere(24, Vec3::ZERO, 1.0)),
        ("cube", Model::cube(8, Vec3::new(3.0, -2.0, 1.0), 0.7)),
        ("soup", Model::soup(300)),
    ] {
        for lanes in each_lanes() {
            let eight = Bvh8::new(model.shapes(), lanes).expect("a hierarchy");
            let differing = model.differing(30_000, |ray| hit(&eight, ray) != model.nearest(ray));
            assert_eq!(differing, 0, "{name}, {lanes:?}");
        }
    }
}

#[test]
fn no_ray_leaves_a_closed_mesh() {
    for (name, model) in [
        ("bumpy sphere", Model::bumpy_sphere(100, Vec3::splat(100.0), 1.0)),
        ("cube", Model::cube(30, Vec3::splat(100.0), 1.0)),
    ] {
        for lanes in each_lanes() {
            let eight = Bvh8::new(model.shapes(), lanes).expect("a hierarchy");
            let inside = |ray: &Ray| (ray.origin - model.middle).abs().max_element() < 0.6;
            let lost = |ray: &Ray| eight.closest(ray).is_none() || !eight.occluded_by(ray, |_| true);
            assert_eq!(model.differing(200_000, |ray| inside(ray) && lost(ray)), 0, "{name}, {lanes:?}");
        }
    }
}

/// From so far away that an origin's last digit is more than the padding of the boxes.
#[test]
fn boxes_hold_rays_from_far_away() {
    let model = Model::bumpy_sphere(60, Vec3::ZERO, 1.0);
    let eight = Bvh8::new(model.shapes(), RowLanes::nearest_to(Lanes::best())).expect("a hierarchy");
    let away = |ray: &Ray| Ray::new(ray.origin - ray.direction * 1e4, ray.direction);
    let missed = |ray: &Ray| hit(&eight, &away(ray)).is_some() != model.nearest(&away(ray)).is_some();
    assert_eq!(model.differing(20_000, missed), 0);
}

#[test]
fn few_shapes_make_a_hierarchy() {
    for count in [1, 2, 4, 5, 9] {
        let model = Model::soup(count);
        let eight = Bvh8::new(model.shapes(), RowLanes::nearest_to(Lanes::best())).expect("a hierarchy");
        assert_eq!(model.differing(2000, |ray| hit(&eight, ray) != model.nearest(ray)), 0, "{count}");
    }
}

/// Clustering chains what lies in one place, deeper than a walk may be.
#[test]
fn shapes_in_one_place_are_left_to_two_children_a_node() {
    let model = Model::new(vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 1000], Vec3::ZERO, 1.0);
    let lanes = RowLanes::nearest_to(Lanes::best());
    assert!(Bvh8::new(model.shapes(), lanes).is_none());
    let through = Ray::new(Vec3::new(0.2, 0.3, -1.0), Vec3::Z);
    assert_eq!(Bvh2::new(&model.primitives, &model.surfaces).nearest(&through).id, 0);
}

/// With all that shading asks; two children a node take 140.
#[test]
fn a_triangle_takes_about_a_hundred_bytes() {
    let model = Model::bumpy_sphere(150, Vec3::ZERO, 1.0);
    let bvh = Bvh8::new(model.shapes(), RowLanes::nearest_to(Lanes::best())).expect("a hierarchy");
    let bytes = size_of_val(bvh.blocks.all()) as f64 / model.primitives.len() as f64;
    assert!((80.0..110.0).contains(&bytes), "{bytes}");
}
