use super::{Scratch, ShapeList};
use crate::intersect::aggregate::Aggregate;
use crate::intersect::{Intersections, NO_LIGHT, Ray, SurfacePoint};
use crate::light::Lights;
use crate::sampling::sampler::Sampler;
use crate::sampling::{cone, cosine_hemisphere, to_world};
use crate::vectors::{glam_vector, lane_vector};
use scene::glam::{EulerRot, Quat};
use scene::{Geometry, Scene, Shape, Vec3, builtin};

/// An aggregate and what a list of one lane needs.
struct Subject {
    aggregate: Aggregate,
    scratch: Scratch<f32>,
}

impl Subject {
    fn new(scene: &Scene) -> Self {
        let aggregate = Aggregate::new(scene, Lights::new(scene).light_of_shape());
        let scratch = Scratch::new(aggregate.shape_list());
        assert!(aggregate.shape_list().is_some(), "{}", scene.name);
        Subject { aggregate, scratch }
    }

    fn shape_list(&mut self) -> (&ShapeList, &mut Scratch<f32>) {
        (self.aggregate.shape_list().expect("few shapes"), &mut self.scratch)
    }

    fn closest(&mut self, ray: &Ray) -> Option<Intersections<f32>> {
        let (shape_list, scratch) = self.shape_list();
        let hit = shape_list.closest(&ray.lane(), scratch);
        let met = shape_list.intersections(&ray.lane(), &hit);
        met.met.then_some(met)
    }

    fn occluded(&mut self, ray: &Ray) -> bool {
        let (shape_list, scratch) = self.shape_list();
        shape_list.occluded(&ray.lane(), NO_LIGHT - 1, true, false, scratch)
    }
}

fn random(i: u32, stream: u32) -> [f32; 4] {
    Sampler::independent(stream, i, 77).unit4(0)
}

fn any_direction(u: f32, v: f32) -> Vec3 {
    cone(2.0, [u, v])
}

/// The shapes of `pieces`, each with the material of its number, under the sky of the light-tight box.
fn scene_of(pieces: &[(Geometry, usize)]) -> Scene {
    let mut scene = builtin::named("cornell").expect("built in");
    scene.shapes = pieces.iter().map(|(g, material)| Shape { geometry: g.clone(), material: *material }).collect();
    scene
}

/// A turned box, its six faces parallelograms, or twelve triangles.
fn closed_box(halves: bool, scale: f32, shift: f32) -> (Scene, Vec<Vec3>) {
    let corner = Vec3::splat(shift) - Vec3::new(0.3, 1.0, 1.2) * scale;
    let turned = Geometry::Box { corner, size: Vec3::splat(2.0 * scale), turn_y: -17.0 };
    let (positions, triangles) = turned.flat_triangles();
    let (positions, triangles) = (positions.into_owned(), triangles.into_owned());
    if !halves {
        return (scene_of(&[(turned, 0)]), positions);
    }
    let middle = positions.iter().sum::<Vec3>() / 8.0;
    let turn = Quat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.8);
    let positions: Vec<Vec3> = positions.iter().map(|p| middle + turn * (p - middle)).collect();
    (scene_of(&[(Geometry::mesh(positions.clone(), triangles), 0)]), positions)
}

const PLACES: [(f32, f32); 5] = [(1.0, 0.0), (1.0, 1e4), (1e4, 0.0), (1e-4, 0.0), (1e3, 1e6)];

#[test]
fn no_ray_leaves_a_closed_box() {
    for (scale, shift) in PLACES {
        for halves in [false, true] {
            let (scene, corners) = closed_box(halves, scale, shift);
            let middle = corners.iter().sum::<Vec3>() / 8.0;
            let mut subject = Subject::new(&scene);
            for i in 0..60_000 {
                let [u, v, w, x] = random(i, 1);
                let origin = middle + any_direction(u, v) * (0.5 * scale * w);
                let [a, b] = [i % 8, i / 8 % 8].map(|corner| corners[corner as usize]);
                let aim = match i % 5 {
                    0 => a,
                    1 => a + (b - a) * x,
                    2 => origin + any_direction(x, w),
                    3 => origin + Vec3::AXES[i as usize % 3],
                    // from below a corner or an edge, straight up
                    _ => Vec3::new(origin.x, a.y, origin.z),
                };
                let origin =
                    if i % 5 == 4 { Vec3::new(a.x.min(b.x).max(origin.x), origin.y, origin.z) } else { origin };
                let direction = (aim - origin).normalize_or(Vec3::Y);
                let ray = Ray::new(origin, direction);
                assert!(subject.closest(&ray).is_some(), "scale {scale} at {shift}, halves {halves}: {i} escapes");
            }
        }
    }
}

#[test]
fn rays_that_leave_a_convex_box_meet_nothing_and_those_into_it_its_far_side() {
    for (scale, shift) in PLACES {
        for halves in [false, true] {
            let (scene, corners) = closed_box(halves, scale, shift);
            let middle = corners.iter().sum::<Vec3>() / 8.0;
            let mut subject = Subject::new(&scene);
            let mut lost = 0;
            for i in 0..40_000 {
                let [u, v, w, x] = random(i, 2);
                let eye = middle + any_direction(u, v) * (scale * if i % 2 == 0 { 4.0 } else { 400.0 });
                let aim = middle + any_direction(w, x) * (0.7 * scale);
                let Some(hit) = subject.closest(&Ray::new(eye, (aim - eye).normalize())) else { continue };
                let outside = glam_vector(hit.point.normal).dot(eye - middle) > 0.0;
                let normal = glam_vector(hit.point.normal) * if outside { 1.0 } else { -1.0 };
                let out = to_world(cosine_hemisphere([x, u]), normal);
                let from = |d: Vec3| glam_vector(hit.point.leaving_towards(lane_vector(d)));
                assert!(subject.closest(&Ray::new(from(out), out)).is_none(), "scale {scale} at {shift}: {i}");
                assert!(!subject.occluded(&Ray::between(from(out), from(out) + out * scale)));
                let back = subject.closest(&Ray::new(from(-out), -out));
                lost += u32::from(back.is_none());
                assert!(back.is_none_or(|far| far.point.normal.dot(hit.point.normal) < 0.999));
            }
            // a hit within rounding of an edge may start outside
            assert!(lost <= if shift > 100.0 * scale { 400 } else { 1 }, "scale {scale} at {shift}: {lost}");
        }
    }
}

/// An area light in the plane of a wall, tilted so that rounding moves each of them: at equal distance the area light
/// is met.
#[test]
fn an_area_light_in_its_wall_wins() {
    for i in 0..20 {
        let [a, b, c, d] = random(i, 3);
        let turn = Quat::from_euler(EulerRot::XYZ, 3.0 * a, 3.0 * b, 3.0 * c);
        let [corner, edge_u, edge_v] = [Vec3::new(d, 5.0, 1.0), turn * Vec3::X * 3.0, turn * Vec3::Y * 2.0];
        let wall = Geometry::Rectangle { corner, edge_u, edge_v };
        let area_light = Geometry::Rectangle {
            corner: corner + edge_u * 0.3 + edge_v * 0.2,
            edge_u: edge_u * 0.4,
            edge_v: edge_v * 0.5,
        };
        let mut scene = scene_of(&[(wall, 0), (area_light, 0)]);
        let area_light_material = scene.materials.iter().position(|m| m.emission.is_some()).expect("a lamp");
        let walls = scene.materials.iter().position(|m| m.emission.is_none()).expect("a wall");
        let materials = [walls, area_light_material];
        scene.shapes =
            (0..).zip(scene.shapes.iter()).map(|(i, s)| Shape { material: materials[i], ..s.clone() }).collect();
        let mut subject = Subject::new(&scene);
        for j in 0..2000 {
            let [u, v, w, x] = random(j, 4);
            let aim = corner + edge_u * (0.31 + 0.38 * u) + edge_v * (0.21 + 0.48 * v);
            let eye = aim + any_direction(w, x) * 4.0;
            let hit = subject.closest(&Ray::new(eye, (aim - eye).normalize())).expect("a hit");
            assert_eq!(hit.material, area_light_material as u32, "{i} {j}");
        }
    }
}

/// The tree and the shape_list are two ways to the same hits: but for rays at edges, which either may give to a
/// neighbour.
#[test]
fn list_and_tree_agree() {
    let all = builtin::names().chain(builtin::hard_names()).map(|name| builtin::named(name).expect("built in"));
    let in_a_list = |scene: &Scene| {
        !scene.needs().large_meshes && ShapeList::new(scene, Lights::new(scene).light_of_shape()).is_some()
    };
    let scenes: Vec<Scene> = all.filter(in_a_list).collect();
    assert!(scenes.len() > 24, "{}", scenes.len());
    for scene in scenes {
        let name = &scene.name;
        let mut subject = Subject::new(&scene);
        let (lo, hi) = scene.bounds();
        let (middle, size) = (0.5 * (lo + hi), (hi - lo).length());
        let (mut apart, mut differently_shadowed, n) = (0, 0, 20_000);
        let mut last: Option<SurfacePoint> = None;
        for i in 0..n {
            let [u, v, w, x] = random(i, 5);
            let origin = middle + any_direction(u, v) * (0.6 * size * w);
            let direction = any_direction(x, random(i, 6)[0]);
            let origin = last.map_or(origin, |point| point.leaving_towards(direction));
            let ray = Ray::new(origin, direction);
            let (of_tree, of_shape_list) = (subject.aggregate.accel().first_met(&ray), subject.closest(&ray));
            let agree = match (&of_tree, &of_shape_list) {
                (Some(a), Some(b)) => {
                    let off = (a.point.position - glam_vector(b.point.position)).length();
                    (a.material, a.light) == (b.material, b.light) && off <= 1e-4 * size
                }
                (a, b) => a.is_none() && b.is_none(),
            };
            apart += u32::from(!agree);
            if scene.sun.is_some() {
                differently_shadowed += u32::from(of_tree.is_some() != subject.occluded(&ray));
            }
            if let (Some(hit), Some(point)) = (&of_tree, last) {
                let towards = (hit.point.position - point.position).normalize_or(Vec3::Y);
                let shadow = Ray::between(point.leaving_towards(towards), hit.point.leaving_towards(-towards));
                differently_shadowed +=
                    u32::from(subject.aggregate.accel().occluded(&shadow) != subject.occluded(&shadow));
            }
            last = of_tree.map(|hit| hit.point).filter(|_| i % 3 != 0);
        }
        assert!(apart <= n / 5000 && differently_shadowed <= n / 5000, "{name}: {apart}, {differently_shadowed}");
    }
}
