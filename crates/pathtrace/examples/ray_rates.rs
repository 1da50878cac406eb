//! How fast single rays find their way through a large scene, on each kind of lanes that the machine has.
//!
//!     cargo run --release -p pathtrace --example ray_rates [MESH.obj]
//!
//! Without a mesh: a bumpy sphere over hills, about a million triangles. Three kinds of rays: primary ones from a
//! camera, one bounce of them in cosine-weighted directions, and shadow rays to points on a square above. One thread
//! traces; all build. Best of five, in millions of rays a second of wall-clock time: compare within a run, and on an
//! idle machine.

mod meshes;

use meshes::hills_and_sphere;
use pathtrace::intersect::{Accel, Ray};
use pathtrace::light::Lights;
use pathtrace::sampling::sampler::Sampler;
use pathtrace::sampling::{cosine_hemisphere, to_world};
use scene::{Geometry, Scene, Vec3};
use simd::Lanes;
use std::error::Error;
use std::time::Instant;

/// Pixels along each side of the camera's picture.
const SIDE: u32 = 512;
/// How often each rate is measured; the best counts.
const TIMES: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let geometry = match std::env::args().nth(1) {
        Some(path) => read_obj(&std::fs::read_to_string(path)?)?,
        None => hills_and_sphere(),
    };
    let (lower, upper) = geometry.bounds();
    let mut scene = scene::builtin::named("hard/light-tight-box")?;
    scene.shapes = vec![scene::Shape { geometry, material: 0 }].into();
    let lights = Lights::new(&scene);
    println!("{:8} {:>9} {:>9} {:>9} {:>9} {:>9}", "lanes", "triangles", "build s", "primary", "bounce", "shadow");
    for lanes in Lanes::available().filter(|&lanes| lanes != Lanes::Scalar) {
        lanes.prefer();
        let (accel, seconds) = built(&scene, &lights);
        let rays = Rays::new(&accel, lower, upper);
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

/// Millions of rays a second.
fn rate(rays: &[Ray], meets: impl Fn(&Ray) -> bool) -> f64 {
    let seconds = (0..TIMES).map(|_| {
        let start = Instant::now();
        std::hint::black_box(rays.iter().filter(|ray| meets(ray)).count());
        start.elapsed().as_secs_f64()
    });
    rays.len() as f64 / seconds.fold(f64::INFINITY, f64::min) / 1e6
}

struct Rays {
    primary: Vec<Ray>,
    bounce: Vec<Ray>,
    shadow: Vec<Ray>,
}

impl Rays {
    /// Seen from above one side of a box, lit from above its middle.
    fn new(accel: &Accel, lower: Vec3, upper: Vec3) -> Self {
        let (middle, size) = ((lower + upper) / 2.0, upper - lower);
        let eye = middle + size * Vec3::new(0.1, 0.4, 0.9);
        let forwards = (middle - eye).normalize();
        let right = forwards.cross(Vec3::Y).normalize();
        let up = right.cross(forwards);
        let mut rays = Rays { primary: Vec::new(), bounce: Vec::new(), shadow: Vec::new() };
        for pixel in 0..SIDE * SIDE {
            let [x, y] = [pixel % SIDE, pixel / SIDE].map(|i| 1.2 * ((i as f32 + 0.5) / SIDE as f32 - 0.5));
            let ray = Ray::new(eye, (forwards + right * x - up * y).normalize());
            rays.primary.push(ray);
            let Some(hit) = accel.first_met(&ray) else { continue };
            let [u, v, w, z] = Sampler::independent(pixel, 0, 1).unit4(0);
            let normal = if hit.point.normal.dot(ray.direction) > 0.0 { -hit.point.normal } else { hit.point.normal };
            let out = to_world(cosine_hemisphere([u, v]), normal);
            rays.bounce.push(Ray::new(hit.point.leaving_towards(out), out));
            let light = Vec3::new(middle.x, upper.y + 0.5 * size.y, middle.z);
            let light = light + 0.2 * size * Vec3::new(w - 0.5, 0.0, z - 0.5);
            let start = hit.point.leaving_towards(light - hit.point.position);
            rays.shadow.push(Ray::between(start, light));
        }
        rays
    }
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
