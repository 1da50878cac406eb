//! Closed meshes and rays that must not get out.

use crate::hard::known;
use crate::measure::Trial;
use crate::meshes::{Mesh, any_direction};
use film::Film;
use pathtrace::intersect::Ray;
use pathtrace::sampling::sampler::Sampler;
use pathtrace::{Estimator, PathSettings, Tracer};
use rayon::prelude::*;
use scene::{Camera, Scene, Vec3};
use std::sync::atomic::{AtomicU64, Ordering};

/// Where a ray of the leak test is aimed.
#[derive(Debug, Clone, Copy)]
pub enum Aim {
    Anywhere,
    Corner,
    Edge,
    Axis,
}

/// All of them, their names, and how many times as many rays the thorough test has of each.
pub const AIMS: [(Aim, &str, u32); 4] = [
    (Aim::Anywhere, "anywhere", 10),
    (Aim::Corner, "at corners", 1),
    (Aim::Edge, "at edges", 1),
    (Aim::Axis, "along axes", 1),
];

/// Scales and shifts of the closed meshes.
pub const MESH_PLACES: [(f32, f32); 3] = [(1.0, 0.0), (1.0, 1e4), (1e4, 0.0)];

/// How many rays there are at a mesh in such a place, of an aim that has `times` as many in the thorough test.
pub fn rays_at(trial: &Trial, place: (f32, f32), times: u32) -> u32 {
    let share = if place == (1.0, 0.0) { 1 } else { 4 };
    trial.pick(30_000, 1_000_000) * trial.pick(1, times) / share
}

/// The closed meshes.
pub fn closed_meshes() -> [(&'static str, Mesh); 2] {
    [("bumpy sphere", Mesh::sphere(224, 224, 0.004)), ("cube", Mesh::cube(92))]
}

impl Aim {
    /// Origin and unit direction of ray number `i`, from the inner half of a mesh, or from its middle plane along an
    /// axis with both zeros of the others; `None` where that starts too close to the surface.
    pub fn ray(self, mesh: &Mesh, i: u32, (scale, shift): (f32, f32)) -> Option<(Vec3, Vec3)> {
        let corner = |i: u32| mesh.positions[(u64::from(i) % mesh.positions.len() as u64) as usize];
        let [u, v, w, x] = Sampler::independent(self as u32, i, 16).unit4(0);
        let origin = any_direction([u, v]) * (0.5 * scale * w.cbrt()) + Vec3::splat(shift);
        let pick = pathtrace::sampling::rng::pcg4d([i, 1, 2, 3]);
        let (origin, direction) = match self {
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
                p[axis] = shift;
                let off_axis = (p - Vec3::splat(shift)) / scale;
                if off_axis.length() > 0.97 {
                    return None;
                }
                let other = if pick[2] & 1 == 0 { 0.0 } else { -0.0 };
                let mut d = Vec3::splat(other);
                d[axis] = if pick[2] & 2 == 0 { 1.0 } else { -1.0 };
                (p, d)
            }
        };
        Some((origin, direction.normalize()))
    }
}

/// Rays from the inner half that find no surface, by closest hit or by any hit.
fn escaped(trial: &Trial, mesh: &Mesh, tracer: &Tracer, aim: Aim, rays: u32, place: (f32, f32)) -> u64 {
    let escaped = AtomicU64::new(0);
    (0..rays).into_par_iter().for_each(|i| {
        if i % 4096 == 0 && trial.stopped() {
            return;
        }
        let Some((origin, direction)) = aim.ray(mesh, i, place) else { return };
        let ray = Ray::new(origin, direction);
        let lost = u64::from(tracer.accel().closest(&ray).is_none()) + u64::from(!tracer.accel().occluded(&ray));
        escaped.fetch_add(lost, Ordering::Relaxed);
    });
    escaped.into_inner()
}

pub fn closed_mesh(trial: &mut Trial) {
    for (name, mesh) in closed_meshes() {
        for (scale, shift) in MESH_PLACES {
            let mesh = mesh.clone().placed(scale, shift);
            let tracer = mesh.clone().tracer();
            for (aim, aimed, times) in AIMS {
                let rays = rays_at(trial, (scale, shift), times);
                let lost = escaped(trial, &mesh, &tracer, aim, rays, (scale, shift)) as f64;
                let quantity = format!("rays lost {aimed}, {name}, scale {scale}, moved {shift}");
                trial.equal("bvh2", &quantity, 0.0, lost, 0.0);
            }
        }
    }
}

pub fn light_tight_box(trial: &mut Trial) {
    let rays = trial.pick(500_000, 10_000_000);
    let side = 64;
    let settings = PathSettings { estimator: Estimator::COSINE, ..PathSettings::independent() };
    for (name, scene, camera) in tight_boxes() {
        let film = trial.film((&Tracer::new(&scene), &camera), settings, side, rays / (side * side));
        trial.equal("path cosine", &format!("brightest pixel{name}"), 0.0, brightest(&film), 0.0);
    }
}

/// Closed boxes, and cameras inside of them.
pub fn tight_boxes() -> [(&'static str, Scene, Camera); 4] {
    let scene = known("light-tight-box");
    let camera = scene.camera;
    let centred = Camera { eye: Vec3::new(0.1, 0.2, -0.3), target: Vec3::new(0.3, -0.5, 1.0), fov_y: 150.0, ..camera };
    let turned = |mesh: Mesh| mesh.turned([17.0, 31.0, 47.0]).scene();
    [
        (" of the box", scene, camera),
        (", turned box", turned(Mesh::cube(1)), centred),
        (", 64 x 64 quads a wall", Mesh::cube(64).scene(), centred),
        (", 64 x 64 quads a wall, turned", turned(Mesh::cube(64)), centred),
    ]
}

/// The first channel of the brightest pixel.
pub fn brightest(film: &Film) -> f64 {
    film.pixels().iter().map(|pixel| pixel.mean()[0]).fold(0.0, f64::max)
}
