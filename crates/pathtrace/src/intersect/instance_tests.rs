//! Large meshes as instances of trees of their own: the tree against testing everything, an instance against its
//! triangles in the world, and closed surfaces that nothing passes.

use super::baking::is_instanced;
use super::instances::Instances;
use super::mesh_tree::MeshTree;
use super::mesh_walk::{ClosestOf, OccludedBy};
use super::triangle::{ShearedRay, Triangle};
use super::{Accel, Hit, Ray};
use crate::light::Lights;
use crate::sampling;
use crate::sampling::sampler::Sampler;
use rayon::prelude::*;
use scene::glam::{Affine3A, DVec3, EulerRot, Quat};
use scene::{Geometry, Instance, Mesh, Scene, Shape, Vec3, builtin};
use simd::{Lanes, RowLanes};
use std::sync::Arc;

#[path = "../../examples/meshes/statue.rs"]
mod statue;

pub(super) fn statue_mesh(level: u32) -> Arc<Mesh> {
    let (positions, triangles) = statue::statue(level);
    Arc::new(Mesh::new(positions, triangles))
}

fn random(i: u32, stream: u32) -> [f32; 4] {
    Sampler::independent(stream, i, 77).unit4(0)
}

/// The `i`th ray in the space of a mesh about the origin: anywhere, at a corner or at an edge, from inside or from outside.
fn ray_at(mesh: &Mesh, i: u32) -> Ray {
    let ([u, v, w, x], [a, b, c, y]) = (random(i, 1), random(i, 2));
    let origin = sampling::cone(2.0, [u, v]) * if a < 0.5 { 0.2 * w } else { 2.0 + 3.0 * w };
    let triangle = mesh.triangles()[(b * mesh.triangles().len() as f32) as usize];
    let [p, q, _] = triangle.map(|corner| mesh.positions()[corner as usize]);
    let towards = |p: Vec3| Ray::new(origin, (p - origin).normalize());
    match (3.0 * c) as u32 {
        0 => Ray::new(origin, sampling::cone(2.0, [x, y])),
        1 => towards(p),
        _ => towards(p + (q - p) * x),
    }
}

/// Tests everything in the tree's order. Returns the distance of the nearest and its place.
fn nearest(tree: &MeshTree, ray: &Ray) -> Option<(u32, u32)> {
    let sheared = ShearedRay::new(ray);
    let distance = |triangle: &[u32; 3]| {
        let corners = triangle.map(|corner| tree.mesh.positions()[corner as usize]);
        // unsorted, as the tree has it
        Triangle::sorted(corners).intersect(&sheared, ray.tmax).map(|hit| hit.t)
    };
    let hits = (0..).zip(&tree.triangles).filter_map(|(place, triangle)| Some((distance(triangle)?, place)));
    hits.min_by(|a, b| a.partial_cmp(b).unwrap()).map(|(t, place)| (t.to_bits(), place))
}

/// Whether the tree that is unpacked meets the same by every bit.
fn unpacked_finds_the_same(tree: &MeshTree, ray: &Ray, lanes: RowLanes) -> bool {
    let packed = lanes.run(ClosestOf { tree, ray });
    let packed = packed.map(|hit| (hit.t.to_bits(), hit.triangle, hit.barycentrics().map(f32::to_bits)));
    let unpacked = tree.unpacked().expect("it is not deep");
    let place = |hit: &Hit| unpacked.place(hit) as u32;
    let hit = unpacked.closest(ray).map(|hit| (hit.t.to_bits(), place(&hit), hit.barycentrics.map(f32::to_bits)));
    packed == hit && packed.is_some() == unpacked.occluded(ray)
}

#[test]
fn a_meshs_tree_finds_what_testing_everything_finds() {
    let single = statue_mesh(4);
    // every triangle twice: of two at one distance the first in the tree's order is met
    let twice = [single.triangles(), single.triangles()].concat();
    let twice = Arc::new(Mesh::new(single.positions().to_vec(), twice));
    for mesh in [single, twice] {
        let tree = MeshTree::of(&mesh, &|_| true).expect("a tree");
        for lanes in [Lanes::Avx512, Lanes::Avx2, Lanes::Array].map(RowLanes::nearest_to) {
            let differs = |i: &u32| {
                let ray = &ray_at(&mesh, *i);
                let expected = nearest(&tree, ray);
                let found = lanes.run(ClosestOf { tree: &tree, ray }).map(|hit| (hit.t.to_bits(), hit.triangle));
                let mut same = found == expected && lanes.run(OccludedBy { tree: &tree, ray }) == expected.is_some();
                same &= unpacked_finds_the_same(&tree, ray, lanes);
                if let Some((t, _)) = expected {
                    // strictly before the end
                    let until = Ray { tmax: f32::from_bits(t), ..*ray };
                    let shorter = nearest(&tree, &until);
                    same &= unpacked_finds_the_same(&tree, &until, lanes);
                    let found = lanes.run(ClosestOf { tree: &tree, ray: &until });
                    same &= found.map(|hit| (hit.t.to_bits(), hit.triangle)) == shorter;
                    same &= lanes.run(OccludedBy { tree: &tree, ray: &until }) == shorter.is_some();
                }
                !same
            };
            assert_eq!((0..10_000).into_par_iter().filter(differs).count(), 0, "{lanes:?}");
        }
    }
}

/// Where an instance may stand: turned, mirrored, squeezed, tiny, huge, and far away.
fn placements() -> Vec<(&'static str, Affine3A)> {
    let turn = Quat::from_euler(EulerRot::XYZ, 0.4, 1.9, -0.7);
    let place = |scale: Vec3, at: Vec3| Affine3A::from_scale_rotation_translation(scale, turn, at);
    vec![
        ("where it is", Affine3A::IDENTITY),
        ("turned", place(Vec3::ONE, Vec3::new(3.0, -1.0, 2.0))),
        ("mirrored", place(Vec3::new(-1.3, 1.0, 1.0), Vec3::ONE)),
        ("squeezed", Affine3A::from_scale(Vec3::new(0.02, 3.0, 1.0)) * place(Vec3::new(1.0, 7.0, 0.1), Vec3::ONE)),
        ("tiny", place(Vec3::splat(1e-3), Vec3::splat(0.5))),
        ("huge", place(Vec3::splat(1e3), Vec3::splat(-300.0))),
        ("far away", place(Vec3::ONE, Vec3::new(1e4, -1e4, 1e4))),
        ("small and far away", place(Vec3::splat(0.3), Vec3::new(1e4, 0.0, 0.0))),
        ("squeezed, mirrored and far away", place(Vec3::new(1.0, -0.5, 5.0), Vec3::new(0.0, 1e4, 1e3))),
    ]
}

/// A scene of these shapes, all of one material that does not shine.
fn scene_of(geometries: impl IntoIterator<Item = Geometry>) -> Scene {
    let mut scene = builtin::named("cornell").expect("built in");
    let material = scene.materials.iter().position(|material| !material.shines()).expect("a wall");
    scene.shapes = geometries.into_iter().map(|geometry| Shape { geometry, material }).collect();
    scene
}

fn accel_of(scene: &Scene) -> Accel {
    Accel::new(scene, Lights::new(scene).light_of_shape())
}

/// The triangles of an instance in the world, in meshes too small for trees of their own.
fn in_pieces(instance: &Instance) -> Vec<Geometry> {
    let baked = instance.baked();
    let pieces = baked.triangles().chunks(Mesh::LARGE / 2);
    pieces.map(|triangles| Geometry::mesh(baked.positions().to_vec(), triangles.to_vec())).collect()
}

/// A ray in the world where an instance stands that is `ray` in its space, as near as the world's f32 lets it.
fn in_world(to_world: &Affine3A, ray: &Ray) -> Ray {
    let direction = to_world.as_daffine3().transform_vector3(ray.direction.as_dvec3());
    Ray::new(to_world.transform_point3(ray.origin), direction.normalize().as_vec3())
}

#[test]
fn instances_are_met_where_their_triangles_in_the_world_are() {
    let mesh = statue_mesh(5);
    for (name, to_world) in placements() {
        let instance = Instance { mesh: mesh.clone(), to_world };
        let baked = accel_of(&scene_of(in_pieces(&instance)));
        let scene = scene_of([Geometry::Instance(instance)]);
        let accel = accel_of(&scene);
        assert!(is_instanced(&scene, &scene.shapes[0]) && accel.instances().len() == 1 && baked.instances().is_empty());
        let differs = |i: &u32| {
            let ray = in_world(&to_world, &ray_at(&mesh, *i));
            let (Some(a), Some(b)) = (accel.first_met(&ray), baked.first_met(&ray)) else {
                return accel.first_met(&ray).is_some() != baked.first_met(&ray).is_some();
            };
            // corners in the world are rounded once, and by as much may the surface lie elsewhere
            let (apart, across) = (a.point.position - b.point.position, a.point.normal);
            let bound = 6.0 * (a.point.error + b.point.error) + 1e-6 * (ray.origin - a.point.position).abs();
            apart.dot(across).abs() > across.abs().dot(bound)
        };
        // beside silhouettes and sharp edges, where a ray may go to either side
        let differing = (0..10_000).into_par_iter().filter(differs).count();
        assert!(differing <= 100, "{name}: {differing} rays");
    }
}

/// Whether a hit lies well within its triangle: at an edge, what is inwards of one face may be outwards of another.
fn is_within(hit: &Hit) -> bool {
    hit.barycentrics.iter().all(|weight| *weight > 0.1)
}

/// A hit in the world, by f64 and without an instance: how far the point lies from the plane of its triangle.
fn distance_from_plane(accel: &Accel, hit: &Hit, to_world: &Affine3A, position: Vec3) -> (f64, DVec3) {
    let at = accel.instances().attributes(hit);
    let to_world = to_world.as_daffine3();
    let [a, b, c] = at.corners.map(|i| to_world.transform_point3(at.mesh.positions()[i as usize].as_dvec3()));
    let normal = (b - a).cross(c - a).normalize();
    ((position.as_dvec3() - a).dot(normal), normal)
}

#[test]
fn points_on_instances_lie_within_their_bounds_and_normals_point_outwards() {
    let mesh = statue_mesh(5);
    for (name, to_world) in placements() {
        let accel = accel_of(&scene_of([Geometry::Instance(Instance { mesh: mesh.clone(), to_world })]));
        let middle = to_world.transform_point3(Vec3::ZERO);
        let mut met = 0;
        for i in 0..10_000 {
            let ray = in_world(&to_world, &ray_at(&mesh, i));
            let Some(hit) = accel.closest(&ray) else { continue };
            let point = accel.intersection(&ray, &hit).point;
            let (off, normal) = distance_from_plane(&accel, &hit, &to_world, point.position);
            assert!(off.abs() <= normal.abs().dot(point.error.as_dvec3()), "{name}: {off} of {}", point.error);
            let mirrors = if to_world.matrix3.determinant() < 0.0 { -1.0 } else { 1.0 };
            assert!(normal.dot(point.normal.as_dvec3()) * mirrors > 0.999_999, "{name}: {normal} {}", point.normal);
            // the surface is a star about its middle
            let from_middle = (point.position - middle).as_dvec3();
            assert!(point.normal.as_dvec3().dot(from_middle) > -1e-3 * from_middle.length(), "{name}");
            met += 1;
        }
        assert!(met > 5000, "{name}: {met}");
    }
}

#[test]
fn no_ray_that_leaves_an_instance_meets_where_it_has_left() {
    let mesh = statue_mesh(5);
    for (name, to_world) in placements() {
        let accel = accel_of(&scene_of([Geometry::Instance(Instance { mesh: mesh.clone(), to_world })]));
        let meets_again = |i: &u32| {
            let ray = in_world(&to_world, &ray_at(&mesh, *i));
            let Some(hit) = accel.closest(&ray) else { return false };
            let point = accel.intersection(&ray, &hit).point;
            let [u, v, ..] = random(*i, 3);
            let out = sampling::cone(2.0, [u, v]);
            let next = Ray::new(point.leaving_towards(out), out);
            accel.closest(&next).is_some_and(|next| next.primitive == hit.primitive)
        };
        assert_eq!((0..25_000).into_par_iter().filter(meets_again).count(), 0, "{name}");
    }
}

#[test]
fn nothing_passes_a_closed_instance() {
    let mesh = statue_mesh(5);
    for (name, to_world) in placements() {
        let accel = accel_of(&scene_of([Geometry::Instance(Instance { mesh: mesh.clone(), to_world })]));
        let leaks = |i: &u32| {
            let ray = ray_at(&mesh, *i);
            let is_inside = ray.origin.length() < 0.25;
            let ray = in_world(&to_world, &ray);
            let Some(hit) = accel.closest(&ray) else { return is_inside };
            let point = accel.intersection(&ray, &hit).point;
            let [u, v, ..] = random(*i, 4);
            let out = sampling::cone(2.0, [u, v]);
            let inwards = if out.dot(point.normal) > 0.0 { -out } else { out };
            let next = Ray::new(point.leaving_towards(inwards), inwards);
            !accel.occluded(&ray) || (is_within(&hit) && (accel.closest(&next).is_none() || !accel.occluded(&next)))
        };
        assert_eq!((0..50_000).into_par_iter().filter(leaks).count(), 0, "{name}");
    }
}

#[test]
fn of_instances_at_one_distance_the_first_is_met() {
    let mesh = statue_mesh(5);
    let instance = |to_world| Geometry::Instance(Instance { mesh: mesh.clone(), to_world });
    // one by one, and through a tree over them
    for more in [0, 20] {
        let apart = |i: usize| instance(Affine3A::from_translation(Vec3::X * (5.0 + 3.0 * i as f32)));
        let first = [apart(0), instance(Affine3A::IDENTITY), Geometry::Mesh(mesh.clone())];
        let instances = Instances::new(&scene_of(first.into_iter().chain((0..more).map(apart))));
        let mut met = vec![0; instances.len()];
        for i in 0..2000 {
            let ray = ray_at(&mesh, i);
            if let Some(hit) = instances.closest(&ray) {
                met[hit.instance as usize] += 1;
            }
            assert_eq!(instances.closest(&ray).is_some(), instances.occluded(&ray, |_| true));
        }
        assert!(met[1] > 1000 && met[2] == 0, "{met:?}");
    }
}
