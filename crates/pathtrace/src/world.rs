//! What every walk of rays needs: the scene made ready, and what a ray meets in it.

use crate::geometry::{Accel, Ray, SurfacePoint};
use crate::light::{LightSample, Lights, ShadowEnd, SunDisc};
use scene::{Bsdf, Material, Vec3};

/// What a path walks through.
pub struct World<'a> {
    /// The shapes.
    pub accel: &'a Accel,
    /// What they are made of.
    pub materials: &'a [Material],
    /// What shines and is sampled.
    pub lights: &'a Lights,
    /// Radiance where nothing is hit.
    pub sky: Vec3,
    /// The sun that a ray can hit.
    pub sun_disc: Option<SunDisc>,
    /// Density per solid angle with which the sun's disc is sampled.
    pub sun_pdf: f32,
}

/// What a sample of a pixel brought home.
#[derive(Debug, Clone, Copy, Default)]
pub struct Outcome {
    /// Radiance along the camera ray.
    pub radiance: Vec3,
    /// Rays traced, shadow rays included.
    pub rays: u32,
    /// Whether rays were left out that no setting asked to leave out: beyond [`crate::PathSettings::HARD_CAP`], or
    /// beyond [`crate::whitted::MOST_BRANCHES`].
    pub cut: bool,
}

impl World<'_> {
    /// Whether something stands between a point and what shines on it.
    pub fn in_shadow(&self, at: &SurfacePoint, sample: &LightSample) -> bool {
        self.accel.occluded(&shadow_ray(at, sample))
    }

    /// As [`World::in_shadow`], but glass lets light pass straight on.
    pub fn in_shadow_of_opaque(&self, at: &SurfacePoint, sample: &LightSample) -> bool {
        let opaque = |material: u32| !matches!(self.materials[material as usize].bsdf, Bsdf::Dielectric { .. });
        self.accel.occluded_by(&shadow_ray(at, sample), opaque)
    }
}

/// From a point to what shines on it, both ends off their surfaces.
fn shadow_ray(at: &SurfacePoint, sample: &LightSample) -> Ray {
    let from = at.leaving_towards(sample.wi);
    match sample.end {
        ShadowEnd::Lamp(lamp) => Ray::between(from, lamp.leaving_towards(-sample.wi)),
        ShadowEnd::Point(end) => Ray::between(from, end),
        ShadowEnd::Infinity => Ray::new(from, sample.wi),
    }
}

/// The normal on the side of `wo`.
pub fn facing(normal: Vec3, wo: Vec3) -> Vec3 {
    if normal.dot(wo) < 0.0 { -normal } else { normal }
}

/// What a surface of `material` and outward `normal` sends out against a ray of this direction.
pub fn emitted(material: &Material, normal: Vec3, ray_direction: Vec3) -> Vec3 {
    match material.emission {
        Some(e) if e.two_sided || normal.dot(ray_direction) < 0.0 => e.radiance,
        _ => Vec3::ZERO,
    }
}
