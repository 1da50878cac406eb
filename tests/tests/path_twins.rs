//! The path tracer on the GPU is the twin of the CPU's: rays meet the same surfaces at the same places, pictures agree
//! pixel by pixel, and their means within their errors, on every device of this computer.

mod pair;

use film::Film;
use gpu::Gpu;
use pair::{Pair, paths};
use pathtrace::gpu::GpuTracer;
use pathtrace::intersect::Ray;
use pathtrace::sampling::{self, rng};
use pathtrace::{
    ConesAt, Estimator, GlassShadows, NormalsSettings, PathSettings, Roulette, SamplerKind, Space, Tracer,
    WhittedSettings,
};
use scene::{Camera, Scene, Vec3, builtin};
use std::path::Path;

const EVERYTHING: &str = include_str!("scenes/everything-more.toml");

fn devices() -> Vec<Gpu> {
    Gpu::each().unwrap()
}

fn named(name: &str) -> Scene {
    match name {
        "everything" => scene::parse(EVERYTHING, "everything", Path::new("everything-more.toml")).unwrap(),
        _ => builtin::named(name).unwrap(),
    }
}

fn direction(item: u32, block: u32) -> Vec3 {
    let [u, v, ..] = rng::pcg4d([item, block, 5, 1]).map(rng::unit_float);
    sampling::cone(2.0, [u, v])
}

/// Triangles, spheres and disks of all sizes, each of its own material, so that a hit tells what was met.
fn crowd(shapes_in_it: u32) -> Scene {
    let mut text =
        String::from("[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nfov_y = 50\n[sky]\nradiance = [1, 1, 1]\n");
    let mut shapes = String::new();
    for i in 0..shapes_in_it {
        let [size, ..] = rng::pcg4d([i, 0, 6, 1]).map(rng::unit_float);
        let size = 10f32.powf(-2.5 * size);
        let at = direction(i, 7) * (0.2 + 3.0 * rng::unit_float(rng::pcg4d([i, 1, 6, 1])[0]));
        let vector = |v: Vec3| format!("[{:.7}, {:.7}, {:.7}]", v.x, v.y, v.z);
        text += &format!("[material.m{i}]\ndiffuse = {{ albedo = [{:.4}, 0.5, 0.5] }}\n", i as f32 / 1000.0);
        shapes += &match i % 3 {
            0 => format!("[[sphere]]\ncenter = {}\nradius = {:.6}\n", vector(at), 0.3 * size),
            1 => format!(
                "[[disk]]\ncenter = {}\nnormal = {}\nradius = {:.6}\n",
                vector(at),
                vector(direction(i, 8)),
                size
            ),
            _ => {
                let (u, v) = (direction(i, 8) * size, direction(i, 9) * size);
                format!("[[rectangle]]\ncorner = {}\nedge_u = {}\nedge_v = {}\n", vector(at), vector(u), vector(v))
            }
        };
        shapes += &format!("material = \"m{i}\"\n");
    }
    scene::parse(&(text + &shapes), "crowd", Path::new("crowd.toml")).unwrap()
}

#[test]
fn rays_meet_the_same_surfaces_at_the_same_places_through_a_tree() {
    rays_meet_the_same_surfaces_at_the_same_places(&crowd(1000));
}

#[test]
fn rays_meet_the_same_surfaces_at_the_same_places_among_few_shapes() {
    rays_meet_the_same_surfaces_at_the_same_places(&crowd(21));
}

/// Rays from everywhere to everywhere, and rays that leave what they met: the same surface on both machines for all but
/// 1 in 100,000, at the same place.
fn rays_meet_the_same_surfaces_at_the_same_places(scene: &Scene) {
    let cpu = Tracer::new(scene);
    let aimed = |i: u32| direction(i, 2) * (2.0 * rng::unit_float(rng::pcg4d([i, 4, 5, 1])[0]));
    let towards = |from: Vec3, to: Vec3| Ray::new(from, (to - from).normalize());
    let first: Vec<Ray> = (0..100_000).map(|i| towards(direction(i, 1) * 4.0, aimed(i))).collect();
    for gpu in devices() {
        let tracer = GpuTracer::new(&gpu, scene).unwrap();
        let mut rays = first.clone();
        for bounce in 0..2 {
            let answers = tracer.meet(&rays).unwrap();
            // beside that share of the distance, what rounding does to coordinates of 3 where rays graze a sphere
            let (mut other, mut met) = (0, 0);
            let mut next = Vec::new();
            for (i, (ray, answer)) in (0..).zip(rays.iter().zip(&answers)) {
                let hit = cpu.accel().first_met(ray);
                let same = hit.map(|hit| hit.material) == answer.point().map(|_| answer.material);
                other += u32::from(!same || cpu.accel().occluded(ray) != (answer.occluded == 1));
                let (Some(hit), Some(point), true) = (hit, answer.point(), same) else { continue };
                met += 1;
                let distance = (hit.point.position - ray.origin).length();
                let off = (hit.point.position - point.position).length();
                assert!(off <= 1e-5 * distance + 1e-5, "{bounce}: off by {off} at {distance}, ray {i}");
                let off = (answer.t * ray.direction.length() - distance).abs();
                assert!(off <= 1e-5 * distance + 1e-5, "{bounce}: t off by {off} at {distance}, ray {i}");
                let out = direction(i, 3);
                next.push(Ray::new(hit.point.leaving_towards(out), out));
            }
            assert!(met > rays.len() / 20, "{met} of {} hit", rays.len());
            assert!(other <= 1, "{bounce}: {other} of {} meet something else, {}", rays.len(), gpu.describe());
            rays = next;
        }
    }
}

fn settings(estimator: Estimator, bounces: u32) -> PathSettings {
    PathSettings { estimator, bounces: Some(bounces), ..PathSettings::default() }
}

/// One sample a pixel and 8 bounces: the same picture but for pixels where rounding sends a path elsewhere.
#[test]
fn pictures_agree_pixel_by_pixel() {
    for gpu in devices() {
        for (name, allowed) in [("cornell", 1e-3), ("hard/mirror-box", 1e-3), ("whitted", 1e-2), ("everything", 1e-2)] {
            let pair = paths(&gpu, &named(name), (160, 100), 1, &settings(Estimator::LIGHT, 8));
            let (apart, rays) = (pair.apart(1e-3), pair.rays());
            println!("{name}, {}: {apart} of the pixels apart, {rays} times the rays", gpu.describe());
            assert!(apart <= allowed && (rays - 1.0).abs() < 1e-3, "{name}, {}: {apart} {rays}", gpu.describe());
        }
    }
}

/// What everything.toml lacks: rough metal, by each way to say what it reflects, beside glass, a mirror and tiles.
const METALS: &str = include_str!("scenes/metals.toml");

/// In the middle of a sphere the normal points at the camera: along the camera's own z, whatever the world's axes. Both
/// machines show the same everywhere.
#[test]
fn normals_are_colours_along_the_axes_of_world_or_camera() {
    let gpu = Gpu::headless().unwrap();
    let text = "[camera]\neye = [3, 0, 0]\ntarget = [0, 0, 0]\nfov_y = 45\n[material.grey]\ndiffuse = { albedo = [0.5, 0.5, 0.5] }\n\
                [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'grey'\n";
    let scene = scene::parse(text, "ball", Path::new("ball.toml")).unwrap();
    for (space, middle) in [(Space::World, Vec3::new(1.0, 0.5, 0.5)), (Space::Camera, Vec3::new(0.5, 0.5, 1.0))] {
        let integrator = NormalsSettings { space, ..NormalsSettings::default() }.into();
        let [mut on_gpu, mut on_cpu] = [(); 2].map(|()| Film::new(65, 65));
        let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
        let gpu_stats = tracer.render(&mut on_gpu, &scene.camera, &integrator, 4, &|| false).unwrap();
        let cpu_stats = Tracer::new(&scene).render(&mut on_cpu, &scene.camera, &integrator, 4, &|| false);
        let shown = on_cpu.radiances().nth(32 * 65 + 32).unwrap();
        // a pixel is 1/30 of the radius wide
        assert!((shown - middle).abs().max_element() < 0.02, "{space:?}: {shown}");
        assert_eq!(on_cpu.radiances().next(), Some(Vec3::ZERO), "nothing is seen in the corner");
        let pair = Pair { gpu: on_gpu, cpu: on_cpu, stats: [gpu_stats, cpu_stats] };
        assert!(pair.apart(1e-4) == 0.0 && pair.rays() == 1.0, "{space:?}");
    }
}

/// As [`every_setting_agrees_pixel_by_pixel`], where there is rough metal.
#[test]
fn rough_metal_agrees_pixel_by_pixel() {
    let gpu = Gpu::headless().unwrap();
    let scene = scene::parse(METALS, "metals", Path::new("metals.toml")).unwrap();
    for estimator in Estimator::on_devices() {
        let pair = paths(&gpu, &scene, (96, 64), 1, &settings(estimator, 3));
        let (apart, rays) = (pair.apart(1e-3), pair.rays());
        assert!(apart <= 5e-3 && (rays - 1.0).abs() < 2e-3, "{}: {apart} {rays}", estimator.name());
    }
}

/// glTF's material from plastic to metal, and a spot.
const COATS: &str = include_str!("scenes/coats.toml");

/// As [`every_setting_agrees_pixel_by_pixel`], where there is metallic-roughness; trees of rays as well.
#[test]
fn metallic_roughness_and_spots_agree_pixel_by_pixel() {
    let gpu = Gpu::headless().unwrap();
    let scene = scene::parse(COATS, "coats", Path::new("coats.toml")).unwrap();
    for estimator in Estimator::on_devices() {
        let pair = paths(&gpu, &scene, (96, 64), 1, &settings(estimator, 3));
        let (apart, rays) = (pair.apart(1e-3), pair.rays());
        assert!(apart <= 5e-3 && (rays - 1.0).abs() < 2e-3, "{}: {apart} {rays}", estimator.name());
    }
    let trees = paths(&gpu, &scene, (96, 64), 1, &WhittedSettings::default());
    let (apart, rays) = (trees.apart(1e-3), trees.rays());
    assert!(apart <= 5e-3 && (rays - 1.0).abs() < 2e-3, "trees: {apart} {rays}");
}

/// Every estimator, sampler, roulette and number of branches, cones and split glass, where all kinds of lights and materials are.
#[test]
fn every_setting_agrees_pixel_by_pixel() {
    let gpu = Gpu::headless().unwrap();
    let scene = named("everything");
    let mut all: Vec<_> = Estimator::on_devices().map(|estimator| settings(estimator, 3)).collect();
    // of the ways that are not compiled into pipelines of their own, one more with each estimator
    all[0].bounces = None;
    all[1].roulette = Roulette::constant(0.7);
    all[2].roulette = Roulette { probability: Some(0.8), throughput: true };
    all[3] = PathSettings { sampler: SamplerKind::Independent, seed: 9, ..all[3] };
    all[4] = PathSettings { branches: 2, ..all[4] };
    all[5] = PathSettings { branches: 3, roulette: Roulette::OFF, bounces: Some(2), ..all[5] };
    let cones = |estimator| PathSettings { cones: ConesAt::Everything, ..settings(estimator, 3) };
    all.extend([cones(Estimator::LIGHT), cones(Estimator::MIS)]);
    all.push(PathSettings { split_glass: false, ..settings(Estimator::LIGHT, 3) });
    for settings in all {
        let pair = paths(&gpu, &scene, (96, 64), 1, &settings);
        let (apart, rays) = (pair.apart(1e-3), pair.rays());
        assert!(apart <= 5e-3 && (rays - 1.0).abs() < 2e-3, "{settings:?}: {apart} {rays}");
    }
}

#[test]
fn whitted_trees_agree_pixel_by_pixel() {
    let devices = devices();
    let [best, last] = [&devices[0], &devices[devices.len() - 1]];
    let cases = [
        (best, "everything", GlassShadows::Opaque),
        (best, "everything", GlassShadows::Clear),
        (last, "whitted", GlassShadows::Opaque),
    ];
    for (gpu, name, glass_shadows) in cases {
        let scene = named(name);
        let settings = WhittedSettings { glass_shadows, shadow_rays: 2, ..WhittedSettings::default() };
        let [mut on_gpu, mut on_cpu] = [(); 2].map(|()| Film::new(120, 80));
        let mut tracer = GpuTracer::new(gpu, &scene).unwrap();
        let gpu_stats = tracer.render(&mut on_gpu, &scene.camera, &settings.into(), 1, &|| false).unwrap();
        let cpu_stats = Tracer::new(&scene).render(&mut on_cpu, &scene.camera, &settings.into(), 1, &|| false);
        let pair = Pair { gpu: on_gpu, cpu: on_cpu, stats: [gpu_stats, cpu_stats] };
        let (apart, rays) = (pair.apart(1e-3), pair.rays());
        assert!(apart <= 1e-2 && (rays - 1.0).abs() < 1e-3, "{name} {glass_shadows:?}: {apart} {rays}");
    }
}

/// Of different seeds, so that errors are independent: within four standard errors, which are 2 % at most.
#[test]
fn converged_means_agree_within_four_standard_errors() {
    for gpu in devices() {
        let scene = named("cornell");
        let on_cpu = PathSettings { sampler: SamplerKind::Independent, ..settings(Estimator::MIS, 8) };
        let on_gpu = PathSettings { seed: 77, ..on_cpu };
        let [mut gpu_film, mut cpu_film] = [(); 2].map(|()| Film::new(32, 32));
        GpuTracer::new(&gpu, &scene)
            .unwrap()
            .render(&mut gpu_film, &scene.camera, &on_gpu.into(), 128, &|| false)
            .unwrap();
        Tracer::new(&scene).render(&mut cpu_film, &scene.camera, &on_cpu.into(), 512, &|| false);
        for c in 0..3 {
            let error = gpu_film.standard_error()[c].hypot(cpu_film.standard_error()[c]);
            let (a, b) = (gpu_film.mean()[c], cpu_film.mean()[c]);
            println!("channel {c}, {}: {:.2} standard errors apart", gpu.describe(), (a - b).abs() / error);
            assert!((a - b).abs() <= 4.0 * error && error < 0.02 * b, "{c}: {a} {b} +- {error}");
        }
    }
}

/// A film goes on where it was, in parts or at once, stops between dispatches, and can be read while it grows.
#[test]
fn films_go_on_stop_and_are_read_without_waiting() {
    let gpu = Gpu::headless().unwrap();
    let scene = named("cornell");
    let settings = settings(Estimator::LIGHT, 2);
    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    let mut render =
        |film: &mut Film, spp| tracer.render(film, &scene.camera, &settings.into(), spp, &|| false).unwrap();
    let [mut at_once, mut in_parts] = [(); 2].map(|()| Film::new(48, 40));
    render(&mut at_once, 6);
    render(&mut in_parts, 1);
    render(&mut in_parts, 5);
    let off =
        at_once.radiances().zip(in_parts.radiances()).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f32::max);
    assert!(off < 1e-6, "{off}");

    let mut on_device = tracer.film(Film::new(48, 40)).unwrap();
    tracer.accumulate(&mut on_device, &scene.camera, &settings.into(), 6, &|| false).unwrap();
    on_device.begin_reading(&gpu).unwrap();
    let (film, stats) = loop {
        if let Some(read) = on_device.poll_reading(&gpu).unwrap() {
            break read;
        }
        std::thread::yield_now();
    };
    assert_eq!((film.samples_per_pixel(), stats.samples), (6, 6 * 48 * 40));
    assert!(film.radiances().eq(at_once.radiances()));

    let mut stopped = Film::new(640, 400);
    let asked = std::cell::Cell::new(0);
    let stop = || asked.replace(asked.get() + 1) >= 2;
    let stats = tracer.render(&mut stopped, &scene.camera, &settings.into(), 64, &stop).unwrap();
    let taken: u64 = stopped.pixels().iter().map(|pixel| u64::from(pixel.samples)).sum();
    assert!(stats.samples > 0 && stats.samples == taken && taken < 640 * 400);

    // a pass that was stopped goes on where it was, and ends with the picture that was never stopped
    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    tracer.set_budget(1e-3);
    let [mut whole, mut halting] = [(); 2].map(|()| tracer.film(Film::new(203, 120)).unwrap());
    tracer.accumulate(&mut whole, &scene.camera, &settings.into(), 3, &|| false).unwrap();
    let mut stops = 0;
    while halting.samples_per_pixel() < 3 {
        let asked = std::cell::Cell::new(0);
        let stop = || asked.replace(asked.get() + 1) >= 1;
        tracer.accumulate(&mut halting, &scene.camera, &settings.into(), 3, &stop).unwrap();
        stops += 1;
    }
    // one that is asked for less than it began is begun anew, for those who lack it
    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    tracer.set_budget(1e-3);
    let mut less = tracer.film(Film::new(203, 120)).unwrap();
    let once = std::cell::Cell::new(0);
    tracer.accumulate(&mut less, &scene.camera, &settings.into(), 3, &|| once.replace(once.get() + 1) >= 2).unwrap();
    tracer.accumulate(&mut less, &scene.camera, &settings.into(), 2, &|| false).unwrap();
    let (less, _) = less.read(&gpu).unwrap();
    assert!(less.samples_per_pixel() == 2 && less.pixels().iter().all(|pixel| pixel.samples <= 3));
    let [(whole, stats), (halted, halted_stats)] = [whole, halting].map(|mut film| film.read(&gpu).unwrap());
    assert!(stops > 3 && halted.pixels().iter().all(|pixel| pixel.samples == 3));
    assert!(whole.radiances().eq(halted.radiances()) && stats == halted_stats, "{stops} {stats:?} {halted_stats:?}");
}

/// A million samples of one pixel: plain f32 sums would be off by a percent.
#[test]
fn sums_of_many_samples_do_not_drift() {
    let gpu = Gpu::headless().unwrap();
    let mut scene = named("hard/camera-inside-glass");
    scene.shapes = [].into();
    scene.sky = Vec3::splat(0.1);
    let settings = settings(Estimator::COSINE, 0);
    for (size, spp) in [((8, 1), 200_000), ((1, 1), 1025)] {
        let mut film = Film::new(size.0, size.1);
        let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
        tracer.render(&mut film, &scene.camera, &settings.into(), spp, &|| false).unwrap();
        for pixel in film.pixels() {
            assert_eq!((pixel.samples, pixel.largest), (spp, 0.1));
            let expected = f64::from(0.1f32);
            assert!((pixel.mean()[0] / expected - 1.0).abs() < 1e-6, "{}", pixel.mean()[0]);
            assert!((pixel.sum_of_squares[1] / f64::from(spp) / expected.powi(2) - 1.0).abs() < 1e-6);
        }
    }
}

/// What no device can do is an error and not a panic.
#[test]
fn what_does_not_fit_is_refused() {
    let gpu = Gpu::headless().unwrap();
    let scene = named("cornell");
    let tracer = GpuTracer::new(&gpu, &scene).unwrap();
    assert!(tracer.film(Film::new(0, 4)).is_err());
    let side = gpu.device.limits().max_texture_dimension_2d + 1;
    let error = tracer.film(Film::new(side, 1)).unwrap_err().to_string();
    assert!(error.contains("too large"), "{error}");
    more_triangles_than_a_binding_holds_are_refused(&gpu, &scene, tracer);
    let lost = GpuTracer::new(&gpu, &scene).unwrap();
    gpu.device.destroy();
    let mut film = Film::new(8, 8);
    let camera: Camera = scene.camera;
    let mut lost = lost;
    assert!(lost.render(&mut film, &camera, &PathSettings::default().into(), 1, &|| false).is_err());
    assert!(lost.meet(&[Ray::new(Vec3::ZERO, Vec3::X)]).is_err());
    assert!(GpuTracer::new(&gpu, &scene).is_err());
}

fn more_triangles_than_a_binding_holds_are_refused(gpu: &Gpu, scene: &Scene, mut tracer: GpuTracer) {
    let limit = gpu.device.limits().max_storage_buffer_binding_size;
    // a device that takes gigabytes would have the test build them
    if limit > 1 << 28 {
        return;
    }
    // two triangles and a position a quad take 36 bytes before there is a tree
    let side = ((limit / 36) as f64).sqrt() as u32 + 8;
    let positions = (0..side * side).map(|i| Vec3::new((i % side) as f32, 0.0, (i / side) as f32)).collect();
    let quad = |i: u32| {
        let a = i / (side - 1) * side + i % (side - 1);
        [[a, a + side, a + side + 1], [a, a + side + 1, a + 1]]
    };
    let triangles = (0..(side - 1) * (side - 1)).flat_map(quad).collect();
    let mut large = scene.clone();
    large.shapes = [scene::Shape { geometry: scene::Geometry::mesh(positions, triangles), material: 0 }].into();
    let error = GpuTracer::new(gpu, &large).unwrap_err().to_string();
    assert!(error.contains("the large meshes and their trees need"), "{error}");
    // what was there before still is
    assert!(tracer.set_scene(&large).is_err());
    let mut film = Film::new(8, 8);
    assert!(tracer.render(&mut film, &scene.camera, &PathSettings::default().into(), 1, &|| false).is_ok());
}
