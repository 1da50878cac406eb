//! How fast single rays find their way through a large scene, on each kind of lanes that the machine has.
//!
//!     cargo run --release -p pathtrace --example ray_rates [MESH.obj]
//!
//! Without a mesh: a bumpy sphere over hills, about a million triangles. Three kinds of rays: primary ones from a
//! camera, one bounce of them in cosine-weighted directions, and shadow rays to points on a square above. One thread
//! traces; all build. Best of five, in millions of rays a second of wall-clock time: compare within a run, and on an
//! idle machine.

mod meshes;
#[path = "meshes/rays.rs"]
mod rays;

use meshes::hills_and_sphere;
use pathtrace::intersect::Accel;
use pathtrace::light::Lights;
use rays::{RaysAt, rate};
use scene::{Geometry, Scene, Vec3};
use simd::Lanes;
use std::error::Error;
use std::time::Instant;

/// How often the structure is built; the fastest counts.
const TIMES: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let geometry = match std::env::args().nth(1) {
        Some(path) => read_obj(&std::fs::read_to_string(path)?)?,
        None => hills_and_sphere(),
    };
    let bounds = geometry.bounds();
    let mut scene = scene::builtin::named("hard/light-tight-box")?;
    scene.shapes = vec![scene::Shape { geometry, material: 0 }].into();
    let lights = Lights::new(&scene);
    println!("{:8} {:>9} {:>9} {:>9} {:>9} {:>9}", "lanes", "triangles", "build s", "primary", "bounce", "shadow");
    for lanes in Lanes::available().filter(|&lanes| lanes != Lanes::Scalar) {
        lanes.prefer();
        let (accel, seconds) = built(&scene, &lights);
        let rays = RaysAt::new(&accel, bounds);
        println!(
            "{:8} {:9} {seconds:9.3} {:9.2} {:9.2} {:9.2}",
            lanes.name(),
            accel.len(),
            rate(&rays.primary, |ray| accel.first_met(ray).is_some()),
            rate(&rays.bounce, |ray| accel.first_met(ray).is_some()),
            rate(&rays.shadow, |ray| accel.occluded(ray)),
        );
    }
    Ok(())
}

/// The structure, and the seconds that the fastest of a few builds took.
fn built(scene: &Scene, lights: &Lights) -> (Accel, f64) {
    let build = || {
        let start = Instant::now();
        (Accel::new(scene, lights.light_of_shape()), start.elapsed().as_secs_f64())
    };
    let (accel, first) = build();
    (accel, (1..TIMES).map(|_| build().1).fold(first, f64::min))
}

/// Corners and faces of a Wavefront file, faces as fans.
fn read_obj(text: &str) -> Result<Geometry, Box<dyn Error>> {
    let (mut positions, mut triangles) = (Vec::<Vec3>::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let p: Vec<f32> = words.take(3).map(str::parse).collect::<Result<_, _>>()?;
                positions.push(Vec3::from_slice(p.get(..3).ok_or("a corner needs three numbers")?));
            }
            Some("f") => {
                let index = |word: &str| -> Result<u32, Box<dyn Error>> {
                    let number: i64 = word.split('/').next().unwrap_or(word).parse()?;
                    let place = if number < 0 { positions.len() as i64 + number } else { number - 1 };
                    let place = u32::try_from(place)?;
                    if place as usize >= positions.len() {
                        Err("a face needs corners that were listed")?
                    }
                    Ok(place)
                };
                let face: Vec<u32> = words.map(index).collect::<Result<_, _>>()?;
                triangles.extend(face.windows(2).skip(1).map(|pair| [face[0], pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    Ok(Geometry::mesh(positions, triangles))
}
