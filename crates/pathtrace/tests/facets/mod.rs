//! Directions and facets over which lobes are integrated.

use scene::glam::DVec3;
use std::f64::consts::TAU;

/// In the plane y = 0, so far from the normal.
pub fn at(degrees: f64) -> DVec3 {
    let angle = degrees.to_radians();
    DVec3::new(angle.sin(), 0.0, angle.cos())
}

/// Facets by coordinates in which GGX' distribution is smooth whatever its width: `1 - (1 - v)^2` is the share of facets
/// that are less steep. Returns the facet's normal, and the solid angle for each unit of (v, turn).
pub fn facet(alpha: f64, v: f64, turn: f64) -> (DVec3, f64) {
    let rest = 1.0 - v;
    let r2 = (1.0 - rest * rest) / (rest * rest);
    let (slope, (sin, cos)) = (alpha * r2.sqrt(), (TAU * turn).sin_cos());
    let normal = DVec3::new(slope * cos, slope * sin, 1.0).normalize();
    (normal, TAU * alpha.powi(2) * normal.z.powi(3) * rest / rest.powi(4))
}

/// The coordinates of a facet.
pub fn place(alpha: f64, facet: DVec3) -> [f64; 2] {
    let r2 = (facet.x * facet.x + facet.y * facet.y) / (alpha * facet.z).powi(2);
    [1.0 - 1.0 / (1.0 + r2).sqrt(), (facet.y.atan2(facet.x) / TAU).rem_euclid(1.0)]
}
