//! How many paths and rays a second each graphics device traces, and the processor: in the Cornell box, among the
//! spheres, and over a mesh of a million triangles. A path is complete: light is sampled at every vertex, roulette goes
//! by the throughput, and there is no limit of bounces. And photon maps, of which each sample has one: their rays are
//! those of photons too.
//!
//!     cargo run --release -p pathtrace --example device_rates [WIDTH HEIGHT SPP]
//!
//! Seconds are the device's own where it has a clock that the wall's bears out, without reading the film back; a first pass, in which shaders are
//! compiled and the pace is learned, does not count. Also said: what it saves to meet few shapes one by one, and to
//! leave out what a scene does not need.

mod meshes;

use film::Film;
use gpu::{Gpu, wgpu};
use meshes::hills_and_sphere;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::{Integrator, PathSettings, PhotonSettings, Stats, Tracer};
use scene::{Scene, Shape};
use std::error::Error;
use std::path::Path;
use std::time::Instant;

/// Seconds that a dispatch may take: nobody else waits for the device.
const BUDGET: f64 = 0.1;

type MakeTracer = fn(&Gpu, &Scene) -> Result<GpuTracer, GpuTraceError>;

const WAYS: [(&str, MakeTracer); 3] = [
    ("", GpuTracer::new),
    (", through a tree", GpuTracer::through_a_tree),
    (", for any scene", GpuTracer::with_everything),
];

fn main() -> Result<(), Box<dyn Error>> {
    let numbers: Result<Vec<u32>, _> = std::env::args().skip(1).map(|word| word.parse()).collect();
    let [width, height, spp] = match numbers?[..] {
        [] => [512, 512, 8],
        [width, height, spp] if width.min(height).min(spp) > 0 => [width, height, spp],
        _ => Err("width, height and samples per pixel, or nothing")?,
    };
    let scenes = [scene::builtin::named("cornell")?, scene::builtin::named("whitted")?, mesh()?];
    println!("{width} x {height}, {spp} spp");
    println!("{:10} {:8} {:60} {:>9} {:>9}", "scene", "what", "traced by", "Mpaths/s", "Mrays/s");
    let film = || Film::try_new(width, height).ok_or("not enough memory");
    let integrators: [Integrator; 2] = [PathSettings::default().into(), PhotonSettings::default().into()];
    for (scene, integrator) in scenes.iter().flat_map(|scene| integrators.map(|integrator| (scene, integrator))) {
        for through in [wgpu::Backends::VULKAN, wgpu::Backends::METAL, wgpu::Backends::DX12, wgpu::Backends::GL] {
            let Ok(gpu) = Gpu::headless_through(through) else { continue };
            for (way, make) in WAYS {
                let mut tracer = make(&gpu, scene)?;
                tracer.set_budget(BUDGET);
                tracer.render(&mut film()?, &scene.camera, &integrator, spp.div_ceil(4), &|| false)?;
                tracer.take_seconds();
                let stats = tracer.render(&mut film()?, &scene.camera, &integrator, spp, &|| false)?;
                let clock = if tracer.has_a_clock() { "" } else { " (by the wall's clock)" };
                let by = format!("{}{way}{clock}", gpu.describe());
                tell((&scene.name, integrator.name()), &by, stats, tracer.take_seconds());
            }
        }
        let tracer = Tracer::new(scene);
        let mut film = film()?;
        let start = Instant::now();
        let stats = tracer.render(&mut film, &scene.camera, &integrator, spp, &|| false);
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        tell((&scene.name, integrator.name()), &format!("{threads} threads"), stats, start.elapsed().as_secs_f64());
    }
    Ok(())
}

fn tell((scene, what): (&str, &str), by: &str, stats: Stats, seconds: f64) {
    let rate = |count: u64| count as f64 / seconds / 1e6;
    println!("{scene:10} {what:8} {by:60} {:9.2} {:9.2}", rate(stats.samples), rate(stats.rays));
}

/// The mesh under a bright sky and an area light.
fn mesh() -> Result<Scene, scene::SceneError> {
    let text = r#"
[camera]
eye = [1, 2.5, 9]
target = [0, -0.3, 0]
fov_y = 45
[sky]
radiance = [0.5, 0.6, 0.8]
[material.ground]
diffuse = { albedo = [0.6, 0.5, 0.4] }
[material.lamp]
emissive = { radiance = [20, 18, 15] }
[[rectangle]]
corner = [-1, 4, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "lamp"
"#;
    let mut scene = scene::parse(text, "mesh", Path::new("mesh.toml"))?;
    let ground = scene.materials.iter().position(|material| material.emission.is_none()).unwrap_or(0);
    let shape = Shape { geometry: hills_and_sphere(), material: ground };
    scene.shapes = scene.shapes.iter().cloned().chain([shape]).collect();
    Ok(scene)
}
