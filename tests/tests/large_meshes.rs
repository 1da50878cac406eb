//! Large meshes on the device keep trees of their own, into whose space rays go: they are met where the same triangles
//! in the world are, no ray passes a closed one wherever it stands, none shadows itself, and pictures
//! agree with the processor's.

#![expect(clippy::unwrap_used, reason = "a test stops at the first thing that is not as it must be")]

use film::Film;
use gpu::compute::{Binding, Compute};
use gpu::wgsl::{self, Source};
use gpu::{Gpu, wgpu};
use pathtrace::gpu::GpuTracer;
use pathtrace::gpu::rays::RayAnswer;
use pathtrace::intersect::Ray;
use pathtrace::sampling::{self, rng};
use pathtrace::{
    ConesAt, FeatureFilm, FeaturePass, GlassShadows, Integrator, NormalsSettings, PathSettings, PhotonSettings,
    SamplerKind, Tracer, WhittedSettings,
};
use scene::glam::{Affine3A, DVec3, EulerRot, Quat};
use scene::{Geometry, Instance, Mesh, Scene, Shape, Vec3};
use std::path::Path;
use std::sync::Arc;

#[path = "../../crates/pathtrace/examples/meshes/bumpy.rs"]
mod bumpy;

const ROOM: &str = r#"
[camera]
eye = [0.5, 2.5, 8]
target = [0, 0.2, 0]
fov_y = 42
[sky]
radiance = [0.3, 0.4, 0.5]
[material.floor]
diffuse = { albedo = [0.6, 0.5, 0.4] }
[material.red]
diffuse = { albedo = [0.7, 0.2, 0.1] }
[material.metal]
mirror = { reflectance = [0.9, 0.8, 0.6] }
[material.glass]
dielectric = { ior = 1.5 }
[material.lamp]
emissive = { radiance = [20, 18, 15] }
[[rectangle]]
corner = [-6, -1.4, 6]
edge_u = [12, 0, 0]
edge_v = [0, 0.1, -12]
material = "floor"
[[rectangle]]
corner = [-1, 5, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "lamp"
"#;

fn devices() -> Vec<Gpu> {
    Gpu::each().unwrap()
}

fn words(item: u32, block: u32) -> [f32; 4] {
    rng::pcg4d([item, block, 19, 1]).map(rng::unit_float)
}

fn direction(item: u32, block: u32) -> Vec3 {
    let [u, v, ..] = words(item, block);
    sampling::cone(2.0, [u, v])
}

/// A bumpy ball of 8,192 triangles.
fn mesh() -> Arc<Mesh> {
    Arc::new(bumpy::bumpy(5))
}

fn turn(x: f32, y: f32, z: f32) -> Quat {
    Quat::from_euler(EulerRot::XYZ, x, y, z)
}

fn placed(scale: Vec3, rotation: Quat, translation: Vec3) -> Affine3A {
    Affine3A::from_scale_rotation_translation(scale, rotation, translation)
}

/// One mesh thrice: turned, mirrored, and squeezed across its axes.
fn three() -> [(Instance, &'static str); 3] {
    let mesh = mesh();
    let squeezed =
        Affine3A::from_quat(turn(0.4, 0.0, 0.9)) * placed(Vec3::new(0.5, 1.3, 0.8), turn(0.0, 1.0, 0.3), Vec3::ZERO);
    let maps = [
        (placed(Vec3::splat(0.9), turn(0.3, 1.2, 2.0), Vec3::new(-2.2, 0.2, 0.1)), "red"),
        (placed(Vec3::new(-0.8, 0.8, 0.8), turn(1.0, 0.2, 0.1), Vec3::new(0.1, -0.1, 0.6)), "metal"),
        (Affine3A::from_translation(Vec3::new(2.3, 0.4, -0.4)) * squeezed, "glass"),
    ];
    maps.map(|(to_world, material)| (Instance { mesh: mesh.clone(), to_world }, material))
}

/// The room with instances, and with the same triangles in the world.
fn rooms(instances: &[(Instance, &str)]) -> [Scene; 2] {
    let room = scene::parse(ROOM, "room", Path::new("room.toml")).unwrap();
    let with = |geometries: &dyn Fn(&Instance) -> Vec<Geometry>| {
        let material = |name: &str| room.materials.iter().position(|material| material.name == name).unwrap();
        let shapes = instances.iter().flat_map(|(instance, name)| {
            let shape = |geometry| Shape { geometry, material: material(name) };
            geometries(instance).into_iter().map(shape).collect::<Vec<_>>()
        });
        Scene { shapes: room.shapes.iter().cloned().chain(shapes).collect(), ..room.clone() }
    };
    [with(&|instance| vec![Geometry::Instance(instance.clone())]), with(&bumpy::in_pieces)]
}

/// Rays from everywhere to everywhere, and rays that leave what they met: all but 1 in 10,000, of which rounding decides
/// at an outline or an edge, meet the same surface at the same place.
fn meet_the_same(instances: &[(Instance, &str)], reach: f32) {
    let [walked, in_world] = rooms(instances);
    let cpu = Tracer::new(&in_world);
    let aimed = |i: u32| (direction(i, 2) * reach * words(i, 4)[0]) * Vec3::new(1.0, 0.4, 0.4);
    let towards = |from: Vec3, to: Vec3| Ray::new(from, (to - from).normalize());
    let first: Vec<Ray> = (0..50_000).map(|i| towards(direction(i, 1) * 2.0 * reach, aimed(i))).collect();
    for gpu in devices() {
        let tracer = GpuTracer::new(&gpu, &walked).unwrap();
        let mut rays = first.clone();
        for bounce in 0..2 {
            let answers = tracer.meet(&rays).unwrap();
            let (mut other, mut met) = (0, 0);
            let mut next = Vec::new();
            for (i, (ray, answer)) in (0..).zip(rays.iter().zip(&answers)) {
                let hit = cpu.accel().first_met(ray);
                let same = hit.map(|hit| hit.material) == answer.point().map(|_| answer.material);
                let occluded = cpu.accel().occluded(ray) == (answer.occluded == 1);
                let (Some(hit), Some(point), true) = (hit, answer.point(), same && occluded) else {
                    other += u32::from(!(same && occluded));
                    continue;
                };
                met += u32::from(in_world.materials[hit.material as usize].name != "floor");
                let distance = (hit.point.position - ray.origin).length();
                let off = (hit.point.position - point.position).length();
                let turned = hit.point.normal.distance(point.normal);
                let t_off = (answer.t * ray.direction.length() - distance).abs();
                other += u32::from(off.max(t_off) > 2e-5 * distance + 2e-5 || turned > 1e-3);
                let out = direction(i, 3);
                next.push(Ray::new(point.leaving_towards(out), out));
            }
            println!("{bounce}: {other} of {} meet something else, {met} met, {}", rays.len(), gpu.describe());
            assert!(met > rays.len() as u32 / 20, "{met} of {} hit", rays.len());
            assert!(other as usize <= rays.len() / 10_000, "{bounce}: {other} of {}, {}", rays.len(), gpu.describe());
            rays = next;
        }
    }
}

#[test]
fn instances_are_met_where_their_triangles_are() {
    meet_the_same(&three(), 4.0);
}

/// As many as take a tree over their boxes.
#[test]
fn many_instances_are_met_where_their_triangles_are() {
    let mesh = mesh();
    let instance = |i: u32| {
        let [x, y, z, size] = words(i, 9);
        let scale =
            Vec3::splat(0.2 + 0.4 * size) * if i.is_multiple_of(3) { Vec3::new(1.0, -1.0, 1.0) } else { Vec3::ONE };
        let at = (Vec3::new(x, y, z) - 0.5) * Vec3::new(8.0, 3.0, 3.0);
        let to_world = placed(scale, turn(6.0 * x, 6.0 * y, 6.0 * z), at);
        (Instance { mesh: mesh.clone(), to_world }, ["red", "metal", "glass"][i as usize % 3])
    };
    meet_the_same(&(0..24).map(instance).collect::<Vec<_>>(), 4.0);
}

/// Where a mesh can stand: far away, tiny, huge, squeezed and mirrored.
fn hard_placements() -> [Affine3A; 4] {
    let far = Vec3::new(1e4, -7e3, 3e3);
    [
        placed(Vec3::splat(50.0), turn(0.3, 1.2, 2.0), far),
        placed(Vec3::splat(1e-3), turn(2.0, 0.1, 1.0), Vec3::new(0.3, 1.0, -2.0)),
        placed(Vec3::splat(1e3), turn(1.0, 1.0, 0.5), Vec3::new(20.0, 700.0, -3.0)),
        placed(Vec3::new(-3.0, 0.2, 1.0), turn(0.8, 2.2, 1.4), Vec3::new(5.0, 0.0, 1.0)),
    ]
}

/// Rays from the inner half of a closed mesh through its corners, its edges and what is between: all meet it, and those
/// that leave what was met neither meet it again nor get out.
#[test]
fn no_ray_passes_a_closed_mesh_and_none_shadows_itself() {
    let mesh = mesh();
    let corners = |i: u32| mesh.triangles()[i as usize % mesh.triangles().len()].map(|c| mesh.positions()[c as usize]);
    let aim = |i: u32| {
        let ([a, b, c], [u, v, ..]) = (corners(i), words(i, 5));
        match i % 4 {
            0 => a,
            1 => a + (b - a) * u,
            2 => b + (c - b) * u,
            _ => a + (b - a) * (u * v) + (c - a) * (u * (1.0 - v)),
        }
    };
    for (number, to_world) in hard_placements().into_iter().enumerate() {
        let [walked, _] = rooms(&[(Instance { mesh: mesh.clone(), to_world }, "red")]);
        let instance = walked.shapes.len() - 1;
        let alone = Scene { shapes: walked.shapes[instance..].to_vec().into(), ..walked };
        let ray = |i: u32| {
            let [from, to] = [direction(i, 6) * 0.2, aim(i)].map(|p| to_world.transform_point3(p));
            Ray::new(from, (to - from).normalize())
        };
        let rays: Vec<Ray> = (0..40_000).map(ray).collect();
        for gpu in devices() {
            let tracer = GpuTracer::new(&gpu, &alone).unwrap();
            let answers = tracer.meet(&rays).unwrap();
            let passed = answers.iter().filter(|a| a.t == 0.0 || a.occluded == 0).count();
            assert_eq!(passed, 0, "placement {number}, {}", gpu.describe());
            for inside in [true, false] {
                let leave = |(i, (ray, answer)): (u32, (&Ray, &RayAnswer))| {
                    let point = answer.point().unwrap();
                    let outwards = i % 4 != 3 || point.normal.dot(ray.direction) > 0.0;
                    assert!(outwards, "outwards is inwards, placement {number}");
                    let [u, v, ..] = words(i, 7);
                    let side = if inside { -point.normal } else { point.normal };
                    let out = sampling::to_world(sampling::cosine_hemisphere([u, v]), side);
                    Ray::new(point.leaving_towards(out), out)
                };
                let left: Vec<Ray> = (0..).zip(rays.iter().zip(&answers)).map(leave).collect();
                let again = tracer.meet(&left).unwrap();
                let own = again.iter().zip(&answers).filter(|(a, b)| a.t > 0.0 && a.normal == b.normal).count();
                // at an edge or a corner a step off one side may be beyond another
                let between = again.iter().skip(3).step_by(4);
                let escaped = between.filter(|a| a.t == 0.0).count();
                println!("placement {number}: {own} meet their own triangle, {escaped} get out, {inside}");
                assert_eq!(own, 0, "placement {number}, {}", gpu.describe());
                assert!(!inside || escaped == 0, "placement {number}: {escaped} get out, {}", gpu.describe());
            }
        }
    }
}

fn by_both(tracers: (&mut GpuTracer, &Tracer), scene: &Scene, integrator: &Integrator, spp: u32) -> [Film; 2] {
    let [mut on_gpu, mut on_cpu] = [(); 2].map(|()| Film::new(96, 64));
    tracers.0.render(&mut on_gpu, &scene.camera, integrator, spp, &|| false).unwrap();
    tracers.1.render(&mut on_cpu, &scene.camera, integrator, spp, &|| false);
    [on_gpu, on_cpu]
}

fn mean(film: &Film) -> Vec3 {
    film.radiances().sum::<Vec3>() / (96.0 * 64.0)
}

/// The picture by an integrator on both machines: the share of pixels that are apart, and the means.
fn compared([walked, in_world]: &[Scene; 2], integrator: &Integrator) -> (f64, [Vec3; 2]) {
    let gpu = Gpu::headless().unwrap();
    let (mut tracer, cpu) = (GpuTracer::new(&gpu, walked).unwrap(), Tracer::new(in_world));
    let [on_gpu, on_cpu] = by_both((&mut tracer, &cpu), walked, integrator, 1);
    let far = |(a, b): &(Vec3, Vec3)| (a - b).abs().max_element() > 1e-3 * b.max_element().max(1.0);
    let apart = on_gpu.radiances().zip(on_cpu.radiances()).filter(far).count() as f64 / (96.0 * 64.0);
    let means = [mean(&on_gpu), mean(&on_cpu)];
    println!("{}: {apart} of the pixels apart, means {means:?}", integrator.name());
    (apart, means)
}

/// Every integrator that devices know: but for pixels where rounding sends a path elsewhere, the same picture as of
/// the triangles in the world on the processor. Photons are sent by what shapes there are, and a piece is another shape:
/// their pictures agree in the mean, to the noise of 16,384 of them.
#[test]
fn pictures_of_instances_are_those_of_their_triangles() {
    let scenes = rooms(&three());
    // pieces of a mesh would get cones of their own
    let paths = PathSettings { bounces: Some(5), cones: ConesAt::Nothing, ..PathSettings::default() };
    let trees = WhittedSettings { glass_shadows: GlassShadows::Clear, ..WhittedSettings::default() };
    let photons = PhotonSettings { photons: 1 << 14, ..PhotonSettings::default() };
    let cases: [(Integrator, f64, f32); 4] = [
        (paths.into(), 2e-3, 1e-3),
        (trees.into(), 2e-3, 1e-3),
        (NormalsSettings::default().into(), 2e-3, 1e-3),
        (photons.into(), 1.0, 1e-2),
    ];
    for (integrator, pixels, allowed) in cases {
        let (apart, means) = compared(&scenes, &integrator);
        assert!(apart <= pixels, "{}: {apart}", integrator.name());
        let off = (means[0] - means[1]).abs().max_element();
        assert!(off < allowed * means[1].max_element(), "{}: {means:?}", integrator.name());
    }
}

#[test]
fn features_of_instances_are_those_of_their_triangles() {
    let [walked, in_world] = rooms(&three());
    let gpu = Gpu::headless().unwrap();
    let pass = FeaturePass::new(&walked.camera, (96, 64), 1, (SamplerKind::Sobol, 1));
    let [mut on_gpu, mut on_cpu] = [(); 2].map(|()| FeatureFilm::new((96, 64)));
    GpuTracer::new(&gpu, &walked).unwrap().add_features(&mut on_gpu, &pass, &|| false).unwrap();
    Tracer::new(&in_world).add_features(&mut on_cpu, &pass, &|| false);
    let [on_gpu, on_cpu] = [on_gpu, on_cpu].map(|film| film.features().unwrap());
    let far = |a: Vec3, b: Vec3| !a.abs_diff_eq(b, 1e-3);
    let is_apart = |i: &usize| {
        let (near, away) = (on_gpu.depth[*i], on_cpu.depth[*i]);
        // nowhere is as far as nowhere
        let depth = near != away && (near - away).abs() > 1e-3 * away;
        depth || far(on_gpu.albedo[*i], on_cpu.albedo[*i]) || far(on_gpu.normal[*i], on_cpu.normal[*i])
    };
    let apart = (0..on_gpu.depth.len()).filter(is_apart).count() as f64 / (96.0 * 64.0);
    println!("{apart} of the pixels apart");
    assert!(apart <= 1e-2, "{apart}");
}

/// Each triangle's normal as a sum of two floats, as devices find it where a ray has met the triangle.
const PLANES: &str = r"//#import pathtrace/intersect/triangle.wgsl
@group(1) @binding(0) var<storage, read> corners: array<vec4f>;
@group(1) @binding(1) var<storage, read_write> normals: array<vec4f>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if 2u * id.x >= arrayLength(&normals) { return; }
    let at = 3u * id.x;
    let plane = plane_of(Triangle(corners[at].xyz, corners[at + 1u].xyz, corners[at + 2u].xyz));
    normals[2u * id.x] = vec4f(plane.normal, 0.0);
    normals[2u * id.x + 1u] = vec4f(plane.normal_low, 0.0);
}";

/// As f64 has them but for 2^-32 of the product of two edges, slivers of a thousandth too, at any size and
/// far from the origin.
#[test]
fn planes_are_found_with_more_bits_than_a_float_has() {
    const TRIANGLES: u32 = 4096;
    let triangle = |i: u32| {
        let [size, off, thin, ..] = words(i, 11);
        let size = 10f32.powf(12.0 * size - 6.0);
        let a = direction(i, 12) * size * 100.0 * off;
        let (u, v) = (direction(i, 13) * size, direction(i, 14) * size);
        let v = if i.is_multiple_of(2) { v } else { u * (1.0 + thin) + v * 1e-3 };
        [a, a + u, a + v]
    };
    let triangles: Vec<[Vec3; 3]> = (0..TRIANGLES).map(triangle).collect();
    let corners: Vec<[f32; 4]> = triangles.iter().flatten().map(|p| p.extend(0.0).to_array()).collect();
    let [room, _] = rooms(&[]);
    let [own, shared] = pathtrace::shaders::LIBRARY;
    let test = [Source { path: "test.wgsl", text: PLANES }];
    let shader = wgsl::compose(&[&test, own, shared], "test.wgsl").unwrap();
    for gpu in devices() {
        let tracer = GpuTracer::new(&gpu, &room).unwrap();
        let (layout, group) = tracer.scene_group();
        let compute =
            Compute::new(&gpu, &shader, "main", Some(layout), &[Binding::Read, Binding::Written], &[]).unwrap();
        let storage = wgpu::BufferUsages::STORAGE;
        let from = gpu.buffer("corners", &corners, storage).unwrap();
        let none = vec![[0f32; 4]; 2 * TRIANGLES as usize];
        let to = gpu.buffer("normals", &none, storage | wgpu::BufferUsages::COPY_SRC).unwrap();
        let bound = [from.as_entire_binding(), to.as_entire_binding()];
        compute.run(&gpu, Some(group), &bound, TRIANGLES as usize).unwrap();
        let normals: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&gpu.read_buffer("normals", &to).unwrap());
        for (corners, normal) in triangles.iter().zip(normals.chunks(2)) {
            let [high, low] = [0, 1].map(|part| Vec3::from_slice(&normal[part]).as_dvec3());
            let [a, b, c] = corners.map(|corner| corner.as_dvec3());
            let (u, v) = (b - a, c - a);
            let exact: DVec3 = u.cross(v);
            let share = exact.length() / (u.length() * v.length());
            let off = (high + low).normalize().distance(exact.normalize()) * share;
            assert!(off < 2f64.powi(-32), "{off:e} of {share:e}, {corners:?}, {}", gpu.describe());
        }
    }
}
