//! Closed meshes and rays that must not get out.

use crate::hard::known;
use crate::measure::{Trial, independent};
use crate::meshes::{Mesh, any_direction};
use pathtrace::geometry::Ray;
use pathtrace::sampler::Sampler;
use pathtrace::{Estimator, PathSettings, Tracer};
use rayon::prelude::*;
use scene::Vec3;
use std::sync::atomic::{AtomicU64, Ordering};

/// Where a ray of the leak test is aimed.
#[derive(Clone, Copy)]
enum Aim {
    Anywhere,
    Corner,
    Edge,
    Axis,
}

/// Rays from the inner half that find no surface, by closest hit or by any hit.
fn escaped(trial: &Trial, mesh: &Mesh, tracer: &Tracer, aim: Aim, rays: u32, (scale, shift): (f32, f32)) -> u64 {
    let escaped = AtomicU64::new(0);
    let corner = |i: u32| mesh.positions[(u64::from(i) % mesh.positions.len() as u64) as usize];
    (0..rays).into_par_iter().for_each(|i| {
        if i % 4096 == 0 && trial.stopped() {
            return;
        }
        let [u, v, w, x] = Sampler::independent(aim as u32, i, 16).unit4(0);
        let origin = any_direction([u, v]) * (0.5 * scale * w.cbrt()) + Vec3::splat(shift);
        let pick = pathtrace::rng::pcg4d([i, 1, 2, 3]);
        let (origin, direction) = match aim {
            Aim::Anywhere => (origin, any_direction([x, v])),
            Aim::Corner => (origin, corner(pick[0]) - origin),
            Aim::Edge => {
                let triangle = mesh.triangles[pick[0] as usize % mesh.triangles.len()];
                let side = pick[1] as usize % 3;
                let [a, b] = [side, (side + 1) % 3].map(|i| mesh.positions[triangle[i] as usize]);
                (origin, a + (b - a) * x - origin)
            }
            Aim::Axis => {
                let axis = pick[1] as usize % 3;
                let mut p = corner(pick[0]);
                // from the middle plane, inside; both zeros of the other axes
                p[axis] = shift;
                let off_axis = (p - Vec3::splat(shift)) / scale;
                if off_axis.length() > 0.97 {
                    return;
                }
                let other = if pick[2] & 1 == 0 { 0.0 } else { -0.0 };
                let mut d = Vec3::splat(other);
                d[axis] = if pick[2] & 2 == 0 { 1.0 } else { -1.0 };
                (p, d)
            }
        };
        let ray = Ray::new(origin, direction.normalize());
        let lost = u64::from(tracer.accel().closest(&ray).is_none()) + u64::from(!tracer.accel().occluded(&ray));
        escaped.fetch_add(lost, Ordering::Relaxed);
    });
    escaped.into_inner()
}

pub fn closed_mesh(trial: &mut Trial) {
    let aims = [
        (Aim::Anywhere, "anywhere", 10),
        (Aim::Corner, "at corners", 1),
        (Aim::Edge, "at edges", 1),
        (Aim::Axis, "along axes", 1),
    ];
    for (name, mesh) in [("bumpy sphere", Mesh::sphere(224, 224, 0.004)), ("cube", Mesh::cube(92))] {
        for (scale, shift) in [(1.0f32, 0.0f32), (1.0, 1e4), (1e4, 0.0)] {
            let mesh = mesh.clone().placed(scale, shift);
            let tracer = mesh.clone().tracer();
            let share = if scale == 1.0 && shift == 0.0 { 1 } else { 4 };
            for (aim, aimed, times) in aims {
                let rays = trial.pick(30_000, 1_000_000) * trial.pick(1, times) / share;
                let lost = escaped(trial, &mesh, &tracer, aim, rays, (scale, shift)) as f64;
                let quantity = format!("rays lost {aimed}, {name}, scale {scale}, moved {shift}");
                trial.equal("bvh2", &quantity, 0.0, lost, 0.0);
            }
        }
    }
}

pub fn light_tight_box(trial: &mut Trial) {
    let scene = known("light-tight-box");
    let rays = trial.pick(500_000, 10_000_000);
    let side = 64;
    let settings = PathSettings { estimator: Estimator::COSINE, ..independent() };
    let camera = scene.camera;
    let film = trial.path_film((&Tracer::new(&scene), &camera), &settings, side, rays / (side * side));
    trial.equal("path cosine", "brightest pixel of the box", 0.0, brightest(&film), 0.0);
    let centred =
        scene::Camera { eye: Vec3::new(0.1, 0.2, -0.3), target: Vec3::new(0.3, -0.5, 1.0), fov_y: 150.0, ..camera };
    for (name, mesh) in [
        ("turned box", Mesh::cube(1).turned([17.0, 31.0, 47.0])),
        ("64 x 64 quads a wall", Mesh::cube(64)),
        ("64 x 64 quads a wall, turned", Mesh::cube(64).turned([17.0, 31.0, 47.0])),
    ] {
        let film = trial.path_film((&mesh.tracer(), &centred), &settings, side, rays / (side * side));
        trial.equal("path cosine", &format!("brightest pixel, {name}"), 0.0, brightest(&film), 0.0);
    }
}

fn brightest(film: &scene::Film) -> f64 {
    film.pixels().iter().map(|pixel| pixel.mean()[0]).fold(0.0, f64::max)
}
