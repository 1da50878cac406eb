//! Rays at a large scene, and how fast they are.

use pathtrace::intersect::{Accel, Ray};
use pathtrace::sampling::sampler::Sampler;
use pathtrace::sampling::{cosine_hemisphere, to_world};
use scene::Vec3;
use std::time::Instant;

/// Pixels along each side of the camera's picture.
const SIDE: u32 = 512;
/// How often each rate is measured; the best counts.
const TIMES: usize = 3;

/// Millions of rays a second, the best of [`TIMES`].
pub fn rate(rays: &[Ray], meets: impl Fn(&Ray) -> bool) -> f64 {
    let seconds = (0..TIMES).map(|_| {
        let start = Instant::now();
        std::hint::black_box(rays.iter().filter(|ray| meets(ray)).count());
        start.elapsed().as_secs_f64()
    });
    rays.len() as f64 / seconds.fold(f64::INFINITY, f64::min) / 1e6
}

/// The rays of a picture and what follows from them.
pub struct RaysAt {
    /// Rays from a camera before the mesh.
    pub primary: Vec<Ray>,
    /// Cosine-weighted, from where those have met something.
    pub bounce: Vec<Ray>,
    /// From there to a square above.
    pub shadow: Vec<Ray>,
}

impl RaysAt {
    /// Seen from above one side of a box, lit from above its middle.
    pub fn new(accel: &Accel, (lower, upper): (Vec3, Vec3)) -> Self {
        let (middle, size) = ((lower + upper) / 2.0, upper - lower);
        let eye = middle + size * Vec3::new(0.1, 0.4, 0.9);
        let forwards = (middle - eye).normalize();
        let right = forwards.cross(Vec3::Y).normalize();
        let up = right.cross(forwards);
        let mut rays = RaysAt { primary: Vec::new(), bounce: Vec::new(), shadow: Vec::new() };
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
