//! Rays on the GPU find what is there, and nothing else: closed rooms let none out, walls do not shadow themselves,
//! boxes of the tree are met from far away and in tiny scenes, area lights win in their plane. On every
//! device of this computer.

use gpu::Gpu;
use pathtrace::Tracer;
use pathtrace::gpu::GpuTracer;
use pathtrace::intersect::Ray;
use pathtrace::sampling::sampler::Sampler;
use pathtrace::sampling::{self, rng};
use scene::{Geometry, Scene, Vec3, builtin};
use std::path::Path;

fn devices() -> Vec<Gpu> {
    Gpu::each().unwrap()
}

fn named(name: &str) -> Scene {
    builtin::named(name).unwrap()
}

fn direction(item: u32, block: u32) -> Vec3 {
    let [u, v, ..] = rng::pcg4d([item, block, 5, 1]).map(rng::unit_float);
    sampling::cone(2.0, [u, v])
}

/// A floor of 64 by 64 quads in the square from 0 to `size`: far more than are met one by one.
fn tiled_floor(size: f32) -> Scene {
    let mut scene = named("hard/light-tight-box");
    let along = |i: u32| size * i as f32 / 64.0;
    let positions = (0..65 * 65).map(|i| Vec3::new(along(i % 65), 0.0, along(i / 65))).collect();
    let quad = |i: u32| {
        let a = i / 64 * 65 + i % 64;
        [[a, a + 65, a + 66], [a, a + 66, a + 1]]
    };
    let triangles = (0..64 * 64).flat_map(quad).collect();
    let mut shape = scene.shapes[0].clone();
    shape.geometry = Geometry::mesh(positions, triangles);
    scene.shapes = [shape].into();
    scene
}

/// What rounding does to the distances of boxes grows with the distance of the camera; the boxes stay as they are.
#[test]
fn no_ray_falls_between_boxes_seen_from_far_away() {
    let scene = tiled_floor(1.0);
    for gpu in devices() {
        let tracer = GpuTracer::new(&gpu, &scene).unwrap();
        for distance in [32.0f32, 100.0, 1000.0] {
            let ray = |i| {
                let aim = direction(i, 41).abs() * Vec3::new(0.9, 0.0, 0.9) + Vec3::new(0.05, 0.0, 0.05);
                let up = Vec3::new(direction(i, 42).x, 0.3 + 0.1 * direction(i, 43).y, direction(i, 42).z);
                let eye = aim + up.normalize() * distance;
                Ray::new(eye, (aim - eye).normalize())
            };
            let rays: Vec<Ray> = (0..100_000).map(ray).collect();
            let lost = tracer.meet(&rays).unwrap().iter().filter(|a| a.t == 0.0 || a.occluded == 0).count();
            assert_eq!(lost, 0, "from {distance}, {}", gpu.describe());
        }
    }
}

/// The direction of a shadow ray is as short as its way: in a tiny scene no smaller than the scene.
#[test]
fn shadow_rays_of_tiny_scenes_meet_boxes() {
    for size in [1e-4f32, 1e-6, 1e-7] {
        let scene = tiled_floor(size);
        for gpu in devices() {
            let tracer = GpuTracer::new(&gpu, &scene).unwrap();
            let ray = |i| {
                let aim = (direction(i, 44).abs() * 0.9 + 0.05) * Vec3::new(size, 0.0, size);
                let tilt = if i % 2 == 0 { Vec3::ZERO } else { 1e-3 * direction(i, 45) };
                let way = size * (Vec3::Y + tilt);
                Ray::between(aim + way, aim - way)
            };
            let rays: Vec<Ray> = (0..20_000).map(ray).collect();
            let lost = tracer.meet(&rays).unwrap().iter().filter(|a| a.occluded == 0).count();
            assert_eq!(lost, 0, "size {size}, {}", gpu.describe());
        }
    }
}

/// Rays from the inner half of a closed box of tilted walls 500 units wide, its surface met again and again: none gets
/// out, none meets the wall that it leaves.
#[test]
fn no_ray_leaks_from_a_large_tilted_room_and_no_wall_shadows_itself() {
    let mut room = named("hard/light-tight-box");
    let shapes = room.shapes.iter().cloned().map(|mut shape| {
        shape.geometry = scene::Geometry::Box {
            corner: Vec3::new(-170.0, -250.0, 190.0),
            size: Vec3::new(500.0, 480.0, 510.0),
            turn_y: 31.0,
        };
        shape
    });
    room.shapes = shapes.take(1).collect();
    let (lo, hi) = room.bounds();
    for gpu in devices() {
        let tracer = GpuTracer::new(&gpu, &room).unwrap();
        let start = |i| Ray::new(0.5 * (lo + hi) + direction(i, 20) * 100.0, direction(i, 21));
        let mut rays: Vec<Ray> = (0..20_000).map(start).collect();
        for bounce in 0..6 {
            let answers = tracer.meet(&rays).unwrap();
            let escaped = answers.iter().filter(|a| a.point().is_none() || a.occluded == 0).count();
            assert_eq!(escaped, 0, "bounce {bounce}, {}", gpu.describe());
            let leave = |(i, (ray, answer)): (u32, (&Ray, &pathtrace::gpu::rays::RayAnswer))| {
                let point = answer.point().unwrap();
                let normal = if point.normal.dot(ray.direction) > 0.0 { -point.normal } else { point.normal };
                let [u, v, ..] = Sampler::independent(i, bounce, 3).unit4(0);
                let out = sampling::to_world(sampling::cosine_hemisphere([u, v]), normal);
                (Ray::new(point.leaving_towards(out), out), point.normal)
            };
            let left: Vec<(Ray, Vec3)> = (0..).zip(rays.iter().zip(&answers)).map(leave).collect();
            rays = left.iter().map(|(ray, _)| *ray).collect();
            let again = tracer.meet(&rays).unwrap();
            let own = again.iter().zip(&left).filter(|(answer, (_, normal))| answer.normal == *normal).count();
            assert_eq!(own, 0, "bounce {bounce}, {}", gpu.describe());
        }
    }
}

/// Close to a corner at the origin of walls 500 units wide the step off a wall is tiny, and the plane's other corners
/// are far: floats alone cannot tell which side of it a ray starts on.
#[test]
fn large_walls_do_not_shadow_themselves_close_to_a_corner() {
    let mut room = named("hard/light-tight-box");
    let mut shape = room.shapes[0].clone();
    shape.geometry = scene::Geometry::Box { corner: Vec3::ZERO, size: Vec3::splat(500.0), turn_y: 31.0 };
    room.shapes = [shape].into();
    let (lo, hi) = room.bounds();
    let middle = 0.5 * (lo + hi);
    let aim = |i: u32| direction(i, 22).abs() * middle.signum() * 10f32.powf(-4.0 * rng::unit_float(i << 12));
    let rays: Vec<Ray> = (0..40_000).map(|i| Ray::new(middle, (aim(i) - middle).normalize())).collect();
    for gpu in devices() {
        let tracer = GpuTracer::new(&gpu, &room).unwrap();
        let met: Vec<_> = tracer.meet(&rays).unwrap().iter().filter_map(|answer| answer.point()).collect();
        assert_eq!(met.len(), rays.len());
        let leave = |(i, point): (u32, &pathtrace::intersect::SurfacePoint)| {
            let inside = if point.normal.dot(middle - point.position) < 0.0 { -point.normal } else { point.normal };
            let [u, v, ..] = Sampler::independent(i, 0, 4).unit4(0);
            let out = sampling::to_world(sampling::cosine_hemisphere([u, v]), inside);
            Ray::new(point.leaving_towards(out), out)
        };
        let left: Vec<Ray> = (0..).zip(&met).map(leave).collect();
        let again = tracer.meet(&left).unwrap();
        let own = again.iter().zip(&met).filter(|(answer, point)| answer.normal == point.normal).count();
        assert_eq!(own, 0, "{}", gpu.describe());
    }
}

/// Of surfaces in one plane an area light is met, wherever it stands in the scene, else the one that comes first.
#[test]
fn of_surfaces_in_one_plane_the_area_light_is_met_and_then_the_first() {
    let wall = |corner: &str, u: &str, v: &str, material: &str| {
        format!("[[rectangle]]\ncorner = {corner}\nedge_u = {u}\nedge_v = {v}\nmaterial = \"{material}\"\n")
    };
    let diffuse = |name: &str| format!("[material.{name}]\ndiffuse = {{ albedo = [0.5, 0.5, 0.5] }}\n");
    let text = [
        "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nfov_y = 50\n".to_owned(),
        diffuse("first")
            + &diffuse("second")
            + "[material.lamp]\nemissive = { radiance = [1, 1, 1], two_sided = true }\n",
        wall("[-3, -2, 0.7]", "[6, 0, 0]", "[0, 5, 0]", "first"),
        wall("[-2.5, -2.1, 0.7]", "[5.3, 0, 0]", "[0, 4.4, 0]", "second"),
        wall("[-0.6, -0.5, 0.7]", "[0, 1.1, 0]", "[1.3, 0, 0]", "lamp"),
    ];
    let scene = scene::parse(&text.concat(), "plane", Path::new("plane.toml")).unwrap();
    let cpu = Tracer::new(&scene);
    let aim = |i| direction(i, 30) * Vec3::new(2.0, 1.8, 0.0) + Vec3::Z * 0.7;
    let rays = (0..20_000).map(|i| (direction(i, 31) * 5.0, aim(i))).map(|(o, to)| Ray::new(o, (to - o).normalize()));
    let rays: Vec<Ray> = rays.collect();
    for gpu in devices() {
        let answers = GpuTracer::new(&gpu, &scene).unwrap().meet(&rays).unwrap();
        let mut met = [0; 3];
        for (ray, answer) in rays.iter().zip(&answers) {
            let hit = cpu.accel().first_met(ray);
            assert_eq!(hit.map(|hit| hit.material), answer.point().map(|_| answer.material));
            if let Some(hit) = hit {
                met[hit.material as usize] += 1;
            }
        }
        let [first, second, area_light] = ["first", "second", "lamp"]
            .map(|name| met[scene.materials.iter().position(|material| material.name == name).unwrap()]);
        assert!(first > 10_000 && second == 0 && area_light > 500, "{met:?}");
    }
}
