//! What a large mesh costs: seconds to make it ready for rays, bytes a triangle (of its tree, and of what is kept beside for
//! the processor), and millions of rays a second, against the hierarchy that holds small shapes.
//!
//!     cargo run --release -p pathtrace --example mesh_rates [LEVEL...]
//!
//! A bumpy ball of 8 x 4^level triangles, levels 7 and 9 unless others are given (11: 33,554,432 triangles). Three kinds
//! of rays: primary ones from a camera, one bounce of them in cosine-weighted directions, and shadow rays to points on a
//! square above. One thread traces; all build. Best of three, of wall-clock time: compare within a run, and on an idle
//! machine. Beyond level 9 the mesh's tree alone is measured: the other would not fit.

#[path = "meshes/rays.rs"]
mod rays;
#[path = "meshes/statue.rs"]
mod statue;

use pathtrace::intersect::{Accel, MeshTree};
use pathtrace::light::Lights;
use rays::{RaysAt, rate};
use scene::{Geometry, Mesh, Scene, Shape};
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

/// The last level that the hierarchy of small shapes is built for.
const MOST_IN_PIECES: u32 = 9;

fn main() -> Result<(), Box<dyn Error>> {
    let given = std::env::args().skip(1).map(|level| level.parse()).collect::<Result<Vec<u32>, _>>()?;
    let levels = if given.is_empty() { vec![7, 9] } else { given };
    println!("triangles  structure    build s  bytes each   primary    bounce    shadow");
    for level in levels {
        let (positions, triangles) = statue::statue(level);
        let mesh = Arc::new(Mesh::new(positions, triangles));
        let start = Instant::now();
        let Some(tree) = MeshTree::of(&mesh, &|_| true) else { continue };
        let packed = tree.bytes();
        let accel = accel_of([Geometry::Mesh(mesh.clone())])?;
        let seconds = start.elapsed().as_secs_f64();
        let each = |bytes: usize| bytes as f64 / mesh.triangles().len() as f64;
        let (own, beside) = (each(packed + size_of_val(mesh.positions())), each(tree.bytes() - packed));
        let rays = RaysAt::new(&accel, mesh.bounds());
        let bytes = format!("{own:.1}+{beside:.1}");
        row(&accel, &rays, "mesh tree", seconds, &bytes);
        if level <= MOST_IN_PIECES {
            let start = Instant::now();
            let pieces = accel_of(in_pieces(&mesh))?;
            row(&pieces, &rays, "small shapes", start.elapsed().as_secs_f64(), "-");
        }
    }
    if let Some(peak) = peak_memory() {
        println!("peak memory: {peak}");
    }
    Ok(())
}

fn row(accel: &Accel, rays: &RaysAt, name: &str, seconds: f64, bytes: &str) {
    let primary = rate(&rays.primary, |ray| accel.first_met(ray).is_some());
    let bounce = rate(&rays.bounce, |ray| accel.first_met(ray).is_some());
    let shadow = rate(&rays.shadow, |ray| accel.occluded(ray));
    let count = accel.len();
    println!("{count:9}  {name:12} {seconds:7.2} {bytes:>11} {primary:9.2} {bounce:9.2} {shadow:9.2}");
}

fn accel_of(geometries: impl IntoIterator<Item = Geometry>) -> Result<Accel, Box<dyn Error>> {
    let mut scene: Scene = scene::builtin::named("hard/light-tight-box")?;
    scene.shapes = geometries.into_iter().map(|geometry| Shape { geometry, material: 0 }).collect();
    Ok(Accel::new(&scene, Lights::new(&scene).light_of_shape()))
}

/// The same triangles in meshes too small for trees of their own.
fn in_pieces(mesh: &Mesh) -> Vec<Geometry> {
    let piece = |triangles: &[[u32; 3]]| {
        let corners = triangles.iter().flatten().map(|corner| mesh.positions()[*corner as usize]).collect();
        let triangles = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Geometry::mesh(corners, triangles)
    };
    mesh.triangles().chunks(Mesh::LARGE - 1).map(piece).collect()
}

/// The most memory that this program has had, where the system says it.
fn peak_memory() -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().to_owned())
}
