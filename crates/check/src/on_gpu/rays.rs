//! Rays by themselves: closed meshes that let none out, and surfaces that do not meet the rays that leave them.

use super::{Bench, Outcome};
use crate::meshes::{Mesh, any_direction};
use crate::offsets::PLACES;
use pathtrace::geometry::Ray;
use pathtrace::sampler::Sampler;
use pathtrace::{rng, sampling};
use scene::Vec3;

pub fn closed_mesh(bench: &mut Bench) -> Outcome {
    for (name, mesh) in [("bumpy sphere", Mesh::sphere(224, 224, 0.004)), ("cube", Mesh::cube(92))] {
        for (scale, shift) in [(1.0f32, 0.0f32), (1.0, 1e4), (1e4, 0.0)] {
            let mesh = mesh.clone().placed(scale, shift);
            let tracer = bench.tracer(&mesh.clone().scene())?;
            let rays = bench.trial.pick(30_000, 1_000_000);
            let rays: Vec<Ray> = (0..rays).map(|i| aimed(&mesh, i, (scale, shift))).collect();
            let answers = tracer.meet(&rays)?;
            let lost = answers.iter().filter(|answer| answer.t == 0.0 || answer.occluded == 0).count();
            let quantity = format!("rays lost, {name}, scale {scale}, moved {shift}");
            bench.trial.equal("bvh2", &quantity, 0.0, lost as f64, 0.0);
        }
    }
    Ok(())
}

/// From the inner half of a mesh anywhere, at a corner, at an edge, or from its middle along an axis.
fn aimed(mesh: &Mesh, i: u32, (scale, shift): (f32, f32)) -> Ray {
    let [u, v, w, x] = Sampler::independent(0, i, 16).unit4(0);
    let [pick, side, axis, way] = rng::pcg4d([i, 1, 2, 3]);
    let origin = any_direction([u, v]) * (0.5 * scale * w.cbrt()) + Vec3::splat(shift);
    let triangle = mesh.triangles[pick as usize % mesh.triangles.len()].map(|i| mesh.positions[i as usize]);
    let (side, axis) = (side as usize % 3, axis as usize % 3);
    let (a, b) = (triangle[side], triangle[(side + 1) % 3]);
    let mut along = Vec3::ZERO;
    along[axis] = if way & 1 == 0 { 1.0 } else { -1.0 };
    let (origin, direction) = match i % 4 {
        0 => (origin, any_direction([x, v])),
        1 => (origin, a - origin),
        2 => (origin, a + (b - a) * x - origin),
        _ => (Vec3::splat(shift) + 0.3 * (a - Vec3::splat(shift)), along),
    };
    Ray::new(origin, direction.normalize())
}

pub fn self_intersection(bench: &mut Bench) -> Outcome {
    for (shift, size, distance) in PLACES {
        let tracer = bench.tracer(&Mesh::sphere(48, 96, 0.0).placed(size, shift).scene())?;
        let count = bench.trial.pick(20_000, 100_000);
        let first = (0..count).map(|i| {
            let [u, v, w, x] = Sampler::independent(18, i, 1).unit4(0);
            let from = any_direction([u, v]);
            let origin = Vec3::splat(shift) + from * (size * distance);
            let aim = Vec3::splat(shift) + sampling::to_world(sampling::disk([w, x]) * (0.95 * size), from);
            Ray::new(origin, (aim - origin).normalize())
        });
        let points: Vec<_> = tracer.meet(&first.collect::<Vec<_>>())?.iter().filter_map(|a| a.point()).collect();
        let leave = |sign: f32| {
            let one = |(i, point): (u32, &pathtrace::geometry::SurfacePoint)| {
                let [u, v, ..] = Sampler::independent(18, i, 1).unit4(1);
                let out = sign * sampling::to_world(sampling::cosine_hemisphere([u, v]), point.normal);
                Ray::new(point.leaving_towards(out), out)
            };
            (0..).zip(&points).map(one).collect::<Vec<Ray>>()
        };
        let met_again = tracer.meet(&leave(1.0))?.iter().filter(|answer| answer.occluded == 1).count();
        let inwards = tracer.meet(&leave(-1.0))?;
        let own = inwards.iter().zip(&points).filter(|(a, p)| a.t > 0.0 && a.normal == p.normal).count();
        let lost = inwards.iter().filter(|answer| answer.t == 0.0).count();
        let place = format!("at {shift}, size {size}, from {distance}");
        let trial = &mut *bench.trial;
        trial.equal("offset", &format!("outgoing rays that hit, {place}"), 0.0, met_again as f64, 0.0);
        trial.equal("offset", &format!("inward rays that hit their triangle, {place}"), 0.0, own as f64, 0.0);
        let share = lost as f64 / points.len() as f64;
        trial.at_most("offset", &format!("share of inward rays lost, {place}"), 1e-5, share);
    }
    Ok(())
}
