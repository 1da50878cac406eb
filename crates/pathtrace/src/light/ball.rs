//! A sphere as a lamp: uniform in the cone that it fills as seen from a point outside; from inside, where only a two-sided
//! lamp shines, uniform in all directions.

use super::{LightSample, ShadowEnd};
use crate::geometry::sphere::Sphere;
use crate::geometry::{SurfacePoint, gamma};
use crate::sampling;
use scene::Vec3;
use scene::material::Emission;

/// `1 - cos` of the cone of all directions.
const ALL_DIRECTIONS: f32 = 2.0;

/// `1 - cos` of the half angle of the cone that the sphere fills as seen from `x`; `None` from inside. Exact for a sphere
/// tiny or far away, and where the point almost touches it.
///
/// A point on the sphere itself counts as inside: which side it was rounded to says nothing, from inside it sees the whole
/// sphere, and outside nothing of it.
fn one_minus_cos(x: Vec3, Sphere { center, radius }: Sphere) -> Option<f32> {
    let distance = (center - x).length();
    let rounding = gamma(8) * (center.abs().max_element() + radius);
    if distance <= radius + rounding {
        return None;
    }
    let cos = ((distance - radius) * (distance + radius)).sqrt() / distance;
    let sin = radius / distance;
    Some(sin * sin / (1.0 + cos))
}

/// Density per solid angle of a direction from `x` that meets the sphere.
pub fn pdf(x: Vec3, sphere: Sphere) -> f32 {
    sampling::cone_pdf(one_minus_cos(x, sphere).unwrap_or(ALL_DIRECTIONS))
}

pub fn sample(x: Vec3, sphere: Sphere, emission: Emission, u: [f32; 2]) -> Option<LightSample> {
    let to_center = sphere.center - x;
    let outside = one_minus_cos(x, sphere);
    let (wi, pdf) = match outside {
        Some(cone) => {
            let axis = to_center / to_center.length();
            (sampling::to_world(sampling::cone(cone, u), axis), sampling::cone_pdf(cone))
        }
        None if emission.two_sided => (sampling::cone(ALL_DIRECTIONS, u), sampling::cone_pdf(ALL_DIRECTIONS)),
        None => return None,
    };
    // at the rim, rounding may find no meeting; then the point where the direction comes nearest stands for it
    let along = to_center.dot(wi);
    let off_axis = (to_center - wi * along).length_squared();
    let half_chord = (sphere.radius * sphere.radius - off_axis).max(0.0).sqrt();
    let met = wi * if outside.is_some() { along - half_chord } else { along + half_chord } - to_center;
    let point = SurfacePoint::on_sphere(sphere.center, sphere.radius, met);
    Some(LightSample { wi, radiance_over_pdf: emission.radiance / pdf, pdf, end: ShadowEnd::Lamp(point) })
}
