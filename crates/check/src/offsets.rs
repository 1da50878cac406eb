//! Rays that leave a surface, and rays at spheres far away.

use crate::measure::Trial;
use crate::meshes::{Mesh, any_direction};
use pathtrace::intersect::Ray;
use pathtrace::intersect::sphere::Sphere;
use pathtrace::sampling;
use pathtrace::sampling::sampler::Sampler;
use scene::Vec3;

/// Translation, size and distance of the camera in sizes.
pub const PLACES: [(f32, f32, f32); 8] = [
    (0.0, 1.0, 4.0),
    (0.0, 1.0, 1000.0),
    (1e3, 1.0, 4.0),
    (1e4, 1.0, 4.0),
    (1e6, 1e3, 4.0),
    (0.0, 1e-3, 4.0),
    (0.0, 1e-4, 4.0),
    (0.0, 1e4, 4.0),
];

/// How far a ray's start has moved off the surface, over the largest coordinate.
pub fn moved(start: Vec3, position: Vec3) -> f64 {
    f64::from((start - position).length()) / f64::from(position.abs().max_element())
}

pub fn self_intersection(trial: &mut Trial) {
    for (shift, size, distance) in PLACES {
        let tracer = Mesh::sphere(48, 96, 0.0).placed(size, shift).tracer();
        let center = Vec3::splat(shift);
        let (mut hits, mut met_again, mut lost, mut own, mut farthest) = (0u32, 0u32, 0u32, 0u32, 0f64);
        for i in 0..trial.pick(20_000, 100_000) {
            if trial.stopped() {
                return;
            }
            let sampler = Sampler::independent(18, i, 1);
            let [u, v, w, x] = sampler.unit4(0);
            let from = any_direction([u, v]);
            let origin = center + from * (size * distance);
            let aim = center + sampling::to_world(sampling::disk([w, x]) * (0.95 * size), from);
            let Some(hit) = tracer.accel().first_met(&Ray::new(origin, (aim - origin).normalize())) else { continue };
            hits += 1;
            let [u, v, w, x] = sampler.unit4(1);
            // outwards: a convex shape is met by no such ray (its facets are flat: stay off the horizon)
            let normal = hit.point.normal;
            let out = sampling::to_world(sampling::cosine_hemisphere([u, v]), normal);
            let start = hit.point.leaving_towards(out);
            met_again += u32::from(tracer.accel().occluded(&Ray::new(start, out)));
            farthest = farthest.max(moved(start, hit.point.position));
            let inside = -sampling::to_world(sampling::cosine_hemisphere([w, x]), normal);
            let ray = Ray::new(hit.point.leaving_towards(inside), inside);
            match tracer.accel().first_met(&ray) {
                None => lost += 1,
                Some(far) => {
                    let same_plane = far.point.normal == normal;
                    own += u32::from(same_plane);
                }
            }
        }
        let place = format!("at {shift}, size {size}, from {distance}");
        trial.equal("offset", &format!("outgoing rays that hit, {place}"), 0.0, f64::from(met_again), 0.0);
        trial.at_most(
            "offset",
            &format!("share of inward rays lost, {place}"),
            1e-5,
            f64::from(lost) / f64::from(hits),
        );
        trial.equal("offset", &format!("inward rays that hit their triangle, {place}"), 0.0, f64::from(own), 0.0);
        trial.at_most("offset", &format!("start moved, of the coordinate, {place}"), 1e-6, farthest);
    }
}

/// A sphere around the origin, how far from its surface rays at it start, and how far off their meetings may be.
#[derive(Debug, Clone, Copy)]
pub struct FarSphere {
    pub distance: f32,
    pub radius: f32,
    tolerance: f64,
}

const fn far(distance: f32, radius: f32, tolerance: f64) -> FarSphere {
    FarSphere { distance, radius, tolerance }
}

pub const FAR_SPHERES: [FarSphere; 5] =
    [far(10.0, 1.0, 1e-5), far(1e3, 1.0, 1e-3), far(1e4, 1.0, 1e-2), far(100.0, 1e3, 3e-4), far(10.0, 1e5, 3e-2)];

impl FarSphere {
    /// Ray number `i`, past the middle by up to .99 radius.
    pub fn ray(&self, i: u32) -> Ray {
        let [u, v, w, x] = Sampler::independent(19, i, 1).unit4(0);
        let from = any_direction([u, v]);
        let origin = from * (self.radius + self.distance);
        let aim = sampling::to_world(sampling::disk([w, x]) * (0.99 * self.radius), from);
        Ray::new(origin, (aim - origin).normalize())
    }

    /// Where a ray meets it, in f64.
    fn exact(&self, ray: &Ray) -> f64 {
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (a, b, c) = (d.length_squared(), o.dot(d), o.length_squared() - f64::from(self.radius).powi(2));
        (-b - (b * b - a * c).sqrt()) / a
    }

    /// Compares what rays have met.
    pub fn compare(&self, trial: &mut Trial, subject: &str, met: impl Iterator<Item = (Ray, Option<f32>)>) {
        let (mut missed, mut off) = (0u32, 0f64);
        for (ray, t) in met {
            match t {
                Some(t) => off = off.max((f64::from(t) - self.exact(&ray)).abs()),
                None => missed += 1,
            }
        }
        let FarSphere { distance, radius, tolerance } = *self;
        let quantity = format!("rays that miss, distance {distance}, radius {radius}");
        trial.equal(subject, &quantity, 0.0, f64::from(missed), 0.0);
        trial.at_most(subject, &format!("largest error of t, distance {distance}, radius {radius}"), tolerance, off);
    }
}

/// A ray at the middle of a unit sphere from 10,000 units away; it goes 9999 of them.
pub fn central_ray() -> Ray {
    Ray::new(Vec3::new(0.0, 0.0, 1e4), -Vec3::Z)
}

pub fn far_spheres(trial: &mut Trial) {
    for far in FAR_SPHERES {
        let sphere = Sphere { center: Vec3::ZERO, radius: far.radius };
        let rays = (0..trial.pick(50_000, 200_000)).map(|i| far.ray(i));
        far.compare(trial, "sphere", rays.map(|ray| (ray, sphere.intersect(&ray, f32::INFINITY))));
    }
    let t = Sphere { center: Vec3::ZERO, radius: 1.0 }.intersect(&central_ray(), f32::INFINITY).unwrap_or(f32::NAN);
    trial.equal("sphere", "central ray from 10000", 9999.0, f64::from(t), 0.0);
}
