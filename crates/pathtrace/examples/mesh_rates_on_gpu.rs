//! What a large mesh costs a graphics device: as triangles in its tree of two children a node, and as an instance of
//! a tree of its own with eight.
//!
//!     cargo run --release -p pathtrace --example mesh_rates_on_gpu [LEVEL ...]
//!
//! Of each level, a ball of 8 x 4^LEVEL triangles over a floor, under a sky and an area light: how long it takes to make
//! it ready, bytes a triangle, and rays a second of complete paths and of what a camera sees. Level 11 has 33,554,432
//! triangles. Seconds are the device's own where it has a clock. A device that can't hold a mesh says so. The triangles
//! stand in the world as pieces that are small meshes: what makes them ready also holds these against each other.

#[path = "meshes/bumpy.rs"]
mod bumpy;

use film::Film;
use gpu::Gpu;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::intersect::mesh_tree::MeshTree;
use pathtrace::{Integrator, NormalsSettings, PathSettings};
use scene::glam::Affine3A;
use scene::{Geometry, Instance, Mesh, Scene, Shape};
use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

const SIZE: (u32, u32) = (512, 512);

/// From here on the tree of two children a node would take more than 2 GiB: it is left out.
const TOO_MANY_FOR_TWO: usize = 10_000_000;

fn main() -> Result<(), Box<dyn Error>> {
    let levels: Result<Vec<u32>, _> = std::env::args().skip(1).map(|word| word.parse()).collect();
    let levels = match levels?[..] {
        [] => vec![5, 7, 8, 9],
        ref levels if levels.iter().all(|level| (5..=11).contains(level)) => levels.to_vec(),
        _ => Err("levels from 5 to 11, or nothing")?,
    };
    let gpu = Gpu::headless()?;
    println!("{}, {} x {}", gpu.describe(), SIZE.0, SIZE.1);
    println!(
        "{:>10} {:26} {:>9} {:>8} {:>14} {:>15}",
        "triangles", "as", "bytes/tri", "ready s", "path Mrays/s", "camera Mrays/s"
    );
    for level in levels {
        let mesh = Arc::new(bumpy::bumpy(level));
        let triangles = mesh.triangles().len();
        let instance = Instance { mesh: mesh.clone(), to_world: Affine3A::IDENTITY };
        let bytes = bytes_of(&mesh);
        measure(&gpu, triangles, ("an instance, eight boxes", bytes), vec![Geometry::Instance(instance.clone())])?;
        if triangles < TOO_MANY_FOR_TWO {
            // two nodes of 32 bytes less a leaf's share, a triangle of 64, a surface of 32
            measure(&gpu, triangles, ("triangles, two boxes", 160.0), bumpy::in_pieces(&instance))?;
        }
    }
    Ok(())
}

/// Of nodes, indices and positions, for each triangle.
fn bytes_of(mesh: &Arc<Mesh>) -> f64 {
    let Some(tree) = MeshTree::of(mesh, &|_| true) else { return 0.0 };
    let triples = 12 * (mesh.triangles().len() + mesh.positions().len());
    (size_of_val(&tree.nodes[..]) + triples) as f64 / mesh.triangles().len() as f64
}

fn measure(
    gpu: &Gpu,
    triangles: usize,
    (kind, bytes): (&str, f64),
    geometries: Vec<Geometry>,
) -> Result<(), Box<dyn Error>> {
    let scene = over_a_floor(geometries)?;
    let start = Instant::now();
    let mut tracer = match GpuTracer::new(gpu, &scene) {
        Ok(tracer) => tracer,
        Err(refused @ (GpuTraceError::Meshes { .. } | GpuTraceError::Gpu(_))) => {
            println!("{triangles:10} {kind:26} {refused}");
            return Ok(());
        }
        Err(fault) => return Err(fault.into()),
    };
    let ready = start.elapsed().as_secs_f64();
    let path = rate(&mut tracer, &scene, &PathSettings::default().into())?;
    let camera = rate(&mut tracer, &scene, &NormalsSettings::default().into())?;
    println!("{triangles:10} {kind:26} {bytes:9.1} {ready:8.2} {path:14.2} {camera:15.2}");
    Ok(())
}

/// Million rays a second.
fn rate(tracer: &mut GpuTracer, scene: &Scene, integrator: &Integrator) -> Result<f64, Box<dyn Error>> {
    let mut film = Film::try_new(SIZE.0, SIZE.1).ok_or("not enough memory")?;
    // shaders are compiled, and the pace is learned
    tracer.render(&mut film, &scene.camera, integrator, 1, &|| false)?;
    tracer.take_seconds();
    let stats = tracer.render(&mut film, &scene.camera, integrator, 4, &|| false)?;
    Ok(stats.rays as f64 / tracer.take_seconds() / 1e6)
}

fn over_a_floor(geometries: Vec<Geometry>) -> Result<Scene, scene::SceneError> {
    let text = r#"
[camera]
eye = [0, 1, 5]
target = [0, 0, 0]
fov_y = 35
[sky]
radiance = [0.5, 0.6, 0.8]
[material.grey]
diffuse = { albedo = [0.6, 0.5, 0.4] }
[material.lamp]
emissive = { radiance = [20, 18, 15] }
[[rectangle]]
corner = [-6, -1.3, 6]
edge_u = [12, 0, 0]
edge_v = [0, 0, -12]
material = "grey"
[[rectangle]]
corner = [-1, 5, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "lamp"
"#;
    let mut scene = scene::parse(text, "a large mesh", Path::new("mesh.toml"))?;
    let material = scene.materials.iter().position(|material| material.emission.is_none()).unwrap_or(0);
    let shapes = geometries.into_iter().map(|geometry| Shape { geometry, material });
    scene.shapes = scene.shapes.iter().cloned().chain(shapes).collect();
    Ok(scene)
}
