//! Rays by themselves: closed meshes that let none out, surfaces that do not meet the rays that leave them, and spheres
//! far away.

use super::{Bench, Outcome};
use crate::energy::with;
use crate::hard::{known, with_geometry};
use crate::leaks::{AIMS, MESH_PLACES, brightest, closed_meshes, rays_at, tight_boxes};
use crate::meshes::{Mesh, any_direction};
use crate::offsets::{FAR_SPHERES, PLACES, central_ray, moved};
use pathtrace::gpu::GpuTracer;
use pathtrace::intersect::Ray;
use pathtrace::sampling::sampler::Sampler;
use pathtrace::{Estimator, Roulette, sampling};
use scene::{Geometry, Scene, Vec3};

/// Rays whose answers are kept at a time.
const AT_ONCE: usize = 1 << 20;

pub fn closed_mesh(bench: &mut Bench) -> Outcome {
    for (name, mesh) in closed_meshes() {
        for (scale, shift) in MESH_PLACES {
            let mesh = mesh.clone().placed(scale, shift);
            let tracer = bench.tracer(&mesh.clone().scene())?;
            for (aim, aimed, times) in AIMS {
                // as they are: a ray made otherwise has no -0.0
                let raw = |(origin, direction)| Ray { origin, direction, tmax: f32::INFINITY };
                let count = rays_at(bench.trial, (scale, shift), times);
                let mut lost = 0;
                for first in (0..count).step_by(AT_ONCE) {
                    let some = first..count.min(first + AT_ONCE as u32);
                    let rays: Vec<Ray> = some.filter_map(|i| aim.ray(&mesh, i, (scale, shift))).map(raw).collect();
                    if bench.trial.stopped() {
                        return Ok(());
                    }
                    let answers = tracer.meet(&rays)?;
                    lost += answers.iter().filter(|answer| answer.t == 0.0 || answer.occluded == 0).count();
                }
                let quantity = format!("rays lost {aimed}, {name}, scale {scale}, moved {shift}");
                bench.trial.equal("bvh2", &quantity, 0.0, lost as f64, 0.0);
            }
        }
    }
    Ok(())
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
            let one = |(i, point): (u32, &pathtrace::intersect::SurfacePoint)| {
                let [u, v, ..] = Sampler::independent(18, i, 1).unit4(1);
                let out = sign * sampling::to_world(sampling::cosine_hemisphere([u, v]), point.normal);
                Ray::new(point.leaving_towards(out), out)
            };
            (0..).zip(&points).map(one).collect::<Vec<Ray>>()
        };
        let outwards = leave(1.0);
        let starts = outwards.iter().zip(&points).map(|(ray, point)| moved(ray.origin, point.position));
        let farthest = starts.fold(0.0, f64::max);
        let met_again = tracer.meet(&outwards)?.iter().filter(|answer| answer.occluded == 1).count();
        let inwards = tracer.meet(&leave(-1.0))?;
        let own = inwards.iter().zip(&points).filter(|(a, p)| a.t > 0.0 && a.normal == p.normal).count();
        let lost = inwards.iter().filter(|answer| answer.t == 0.0).count();
        let place = format!("at {shift}, size {size}, from {distance}");
        let trial = &mut *bench.trial;
        trial.equal("offset", &format!("outgoing rays that hit, {place}"), 0.0, met_again as f64, 0.0);
        trial.equal("offset", &format!("inward rays that hit their triangle, {place}"), 0.0, own as f64, 0.0);
        let share = lost as f64 / points.len() as f64;
        trial.at_most("offset", &format!("share of inward rays lost, {place}"), 1e-5, share);
        trial.at_most("offset", &format!("start moved, of the coordinate, {place}"), 1e-6, farthest);
    }
    Ok(())
}

pub fn light_tight_box(bench: &mut Bench) -> Outcome {
    // of 4096 pixels each: 1e8 rays in all, a tenth of them as on the processor where that plays the device
    let thorough = if bench.gpu.is_software() { 2560 } else { 25_600 };
    let samples = bench.trial.pick(128, thorough);
    let settings = with(Estimator::COSINE, None, Roulette::THROUGHPUT);
    for (name, scene, camera) in tight_boxes() {
        let tracer = &mut bench.tracer(&scene)?;
        let film = bench.film((tracer, &camera), settings, 64, samples)?;
        bench.trial.equal("path cosine", &format!("brightest pixel{name}"), 0.0, brightest(&film), 0.0);
    }
    Ok(())
}

/// A black sphere around the origin.
fn sphere(radius: f32) -> Scene {
    with_geometry(known("light-tight-box"), |_, geometry| {
        *geometry = Geometry::Sphere { center: Vec3::ZERO, radius };
    })
}

pub fn far_spheres(bench: &mut Bench) -> Outcome {
    let alone = bench.tracer(&sphere(1.0))?;
    let in_a_tree = GpuTracer::through_a_tree(bench.gpu, &sphere(1.0))?;
    for (subject, mut tracer) in [("sphere", alone), ("in a tree", in_a_tree)] {
        for far in FAR_SPHERES {
            tracer.set_scene(&sphere(far.radius))?;
            let rays: Vec<Ray> = (0..bench.trial.pick(50_000, 200_000)).map(|i| far.ray(i)).collect();
            let met = tracer.meet(&rays)?.into_iter().map(|answer| answer.point().map(|_| answer.t));
            far.compare(bench.trial, subject, rays.into_iter().zip(met));
        }
        tracer.set_scene(&sphere(1.0))?;
        let t = tracer.meet(&[central_ray()])?[0].t;
        bench.trial.equal(subject, "central ray from 10000", 9999.0, f64::from(t), 0.0);
    }
    Ok(())
}
