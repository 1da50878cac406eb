//! A flat lamp: the tutorial's `L cos' S / |x - x'|^2`, a point uniform on the lamp and its density `1 / S` turned into
//! solid angle. From nearby that weight has no bound; a rectangle is then sampled uniformly in solid angle instead.

use super::{LightSample, ShadowEnd, SphericalRectangle};
use crate::geometry::{SurfacePoint, gamma};
use crate::sampling;
use scene::Vec3;
use scene::material::Emission;
use std::f32::consts::PI;

/// What a flat lamp looks like.
#[derive(Debug, Clone, Copy)]
pub enum Outline {
    /// One corner and the edges that leave it.
    Parallelogram {
        /// One corner.
        corner: Vec3,
        /// To the next corner.
        edge_u: Vec3,
        /// To the other next corner.
        edge_v: Vec3,
        /// Whether the edges are at right angles.
        square: bool,
    },
    /// Three corners.
    Triangle([Vec3; 3]),
    /// A disk.
    Disk {
        /// Its centre.
        center: Vec3,
        /// Its radius, > 0.
        radius: f32,
    },
}

/// A flat lamp.
#[derive(Debug, Clone, Copy)]
pub struct Flat {
    outline: Outline,
    normal: Vec3,
    area: f32,
}

/// Solid angle from which on a rectangle may be sampled by it: below, single precision knows the angle too badly.
const SMALLEST_SOLID_ANGLE: f32 = 0.05;

impl Flat {
    /// A parallelogram; `None` without area. In f64, whose squares hold what f32's do not.
    pub fn parallelogram(corner: Vec3, edge_u: Vec3, edge_v: Vec3) -> Option<Self> {
        let (u, v) = (edge_u.as_dvec3(), edge_v.as_dvec3());
        let cross = u.cross(v);
        let square = u.dot(v).abs() <= 1e-6 * u.length() * v.length();
        let normal = cross.try_normalize()?.as_vec3();
        let outline = Outline::Parallelogram { corner, edge_u, edge_v, square };
        Some(Flat { outline, normal, area: cross.length() as f32 })
    }

    /// A triangle with its unit normal.
    pub fn triangle(corners: [Vec3; 3], normal: Vec3) -> Self {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let area = 0.5 * (b - a).cross(c - a).length();
        Flat { outline: Outline::Triangle(corners), normal, area: area as f32 }
    }

    /// A disk with its unit normal.
    pub fn disk(center: Vec3, normal: Vec3, radius: f32) -> Self {
        Flat { outline: Outline::Disk { center, radius }, normal, area: PI * radius * radius }
    }

    /// Of one side.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// A point uniform on the lamp.
    pub fn point(&self, u: [f32; 2]) -> SurfacePoint {
        match self.outline {
            Outline::Parallelogram { corner, edge_u, edge_v, .. } => {
                on_parallelogram(corner, edge_u * u[0], edge_v * u[1], self.normal)
            }
            Outline::Triangle(corners) => SurfacePoint::on_triangle(corners, sampling::triangle(u), self.normal),
            Outline::Disk { center, radius } => {
                let local = sampling::disk(u) * radius;
                SurfacePoint::on_disk(center, center + sampling::to_world(local, self.normal), self.normal)
            }
        }
    }

    /// Light from the lamp at `x`; `None` where it does not shine.
    pub fn sample(&self, x: Vec3, emission: Emission, u: [f32; 2]) -> Option<LightSample> {
        let near = self.as_seen_from_nearby(x);
        let point = match (&near, self.outline) {
            (Some(seen), Outline::Parallelogram { corner, edge_u, edge_v, .. }) => {
                let [s, t] = seen.sample(u);
                on_parallelogram(corner, edge_u * s, edge_v * t, self.normal)
            }
            _ => self.point(u),
        };
        let to_light = point.position - x;
        let distance_squared = to_light.length_squared();
        let wi = to_light / distance_squared.sqrt();
        let cos_light = self.cosine(wi, emission.two_sided);
        // also refuses x on the lamp itself, where wi is NaN
        if !(cos_light > 0.0) {
            return None;
        }
        let inverse_pdf = near.map_or(cos_light * self.area / distance_squared, |seen| seen.solid_angle());
        let radiance_over_pdf = emission.radiance * inverse_pdf;
        Some(LightSample { wi, radiance_over_pdf, pdf: 1.0 / inverse_pdf, end: ShadowEnd::Lamp(point) })
    }

    /// Density per solid angle of the direction from `x` to `hit` on the lamp; infinite for an edge that no sample sees.
    pub fn pdf(&self, x: Vec3, hit: &SurfacePoint, two_sided: bool) -> f32 {
        if let Some(seen) = self.as_seen_from_nearby(x) {
            return 1.0 / seen.solid_angle();
        }
        let to_light = hit.position - x;
        let distance_squared = to_light.length_squared();
        let cos_light = self.cosine(to_light / distance_squared.sqrt(), two_sided);
        if cos_light > 0.0 { distance_squared / (cos_light * self.area) } else { f32::INFINITY }
    }

    fn cosine(&self, wi: Vec3, two_sided: bool) -> f32 {
        let cosine = -self.normal.dot(wi);
        if two_sided { cosine.abs() } else { cosine }
    }

    /// A rectangle whose middle is nearer than the root of its area: there its solid angle is worth its price.
    fn as_seen_from_nearby(&self, x: Vec3) -> Option<SphericalRectangle> {
        match self.outline {
            Outline::Parallelogram { corner, edge_u, edge_v, square: true } => {
                let to_middle = corner + 0.5 * (edge_u + edge_v) - x;
                if to_middle.length_squared() > self.area { None } else { solid_angle_of(x, corner, edge_u, edge_v) }
            }
            _ => None,
        }
    }
}

/// Kept out of the way of lamps farther off.
#[inline(never)]
fn solid_angle_of(x: Vec3, corner: Vec3, edge_u: Vec3, edge_v: Vec3) -> Option<SphericalRectangle> {
    let seen = SphericalRectangle::new(x, corner, edge_u, edge_v);
    (seen.solid_angle() > SMALLEST_SOLID_ANGLE).then_some(seen)
}

fn on_parallelogram(corner: Vec3, along_u: Vec3, along_v: Vec3, normal: Vec3) -> SurfacePoint {
    let error = gamma(4) * (corner.abs() + along_u.abs() + along_v.abs());
    SurfacePoint { position: corner + along_u + along_v, error, normal }
}
