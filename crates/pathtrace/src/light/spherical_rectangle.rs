//! A rectangle sampled uniformly in the solid angle that it fills: Ureña, Fajardo and King, "An Area-Preserving
//! Parametrization for Spherical Rectangles" (EGSR 2013).
//!
//! Twin: `shaders/pathtrace/light/spherical_rectangle.wgsl`.

use crate::sampling::warp::{angle_of_upper, sin_cos_2pi};
use crate::vectors::lane_vector;
use scene::Vec3;
use simd::{Float, Vector};
use std::f32::consts::TAU;

/// A rectangle as seen from a point, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct SphericalRectangles<F> {
    x0: F,
    x1: F,
    y0: F,
    y1: F,
    /// Distance of the plane, negative.
    z0: F,
    /// z of the normals of the great circles below and above.
    b0: F,
    b1: F,
    /// `2 pi` less two of the inner angles.
    k: F,
    solid_angle: F,
}

impl<F: Float> SphericalRectangles<F> {
    /// The rectangle with this corner and these edges at right angles, seen from `eye`.
    #[inline(always)]
    pub fn new(eye: Vector<F>, corner: Vector<F>, edge_u: Vector<F>, edge_v: Vector<F>) -> Self {
        let (width, height) = (edge_u.length_squared().sqrt(), edge_v.length_squared().sqrt());
        let (x, y) = (edge_u.divided_by(width), edge_v.divided_by(height));
        let d = corner - eye;
        let z0 = -d.dot(x.cross(y)).abs();
        let (x0, y0) = (d.dot(x), d.dot(y));
        let (x1, y1) = (x0 + width, y0 + height);
        let (g0, g1) = (inner_angle(x1, y0, z0, x1 * y0), inner_angle(x1, y1, z0, -x1 * y1));
        let (g2, g3) = (inner_angle(x0, y1, z0, x0 * y1), inner_angle(x0, y0, z0, -x0 * y0));
        let (zero, k) = (F::splat(0.0), F::splat(TAU) - g2 - g3);
        // in its plane an eye sees nothing of it
        let solid_angle = F::select(z0.eq(zero), zero, (g0 + g1 - k).max(zero));
        SphericalRectangles { x0, x1, y0, y1, z0, b0: -slope(y0, z0), b1: slope(y1, z0), k, solid_angle }
    }

    /// In [0, 2 pi]; off by about 1e-6.
    #[inline(always)]
    pub fn solid_angle(&self) -> F {
        self.solid_angle
    }

    /// The place on the rectangle, in [0, 1]^2 along its edges, of a direction uniform in its solid angle.
    #[inline(always)]
    pub fn sample(&self, u: [F; 2]) -> [F; 2] {
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        let (sin, cos) = sin_cos_2pi((u[0] * self.solid_angle + self.k) * (1.0 / TAU));
        let fu = (cos * self.b0 - self.b1) / sin;
        let cu = (one / (fu * fu + self.b0 * self.b0).sqrt()).copysign(fu).clamp(-one, one);
        let smallest = F::splat(f32::MIN_POSITIVE);
        let xu = (-(cu * self.z0) / (one - cu * cu).max(smallest).sqrt()).clamp(self.x0, self.x1);
        let d = (xu * xu + self.z0 * self.z0).sqrt();
        let (h0, h1) = (slope(self.y0, d), slope(self.y1, d));
        let hv = h0 + u[1] * (h1 - h0);
        let rest = ((one - hv) * (hv + one)).max(smallest);
        let yv = (hv * d / rest.sqrt()).clamp(self.y0, self.y1);
        let flat = self.solid_angle.eq(zero);
        let [s, t] = [share(xu, self.x0, self.x1), share(yv, self.y0, self.y1)];
        [F::select(flat, u[0], s), F::select(flat, u[1], t)]
    }
}

/// The sine of the angle under which `y` is seen from the distance `d`.
#[inline(always)]
fn slope<F: Float>(y: F, d: F) -> F {
    y / (d * d + y * y).sqrt()
}

/// Inner angle at the corner (x, y, z): the arc cosine of `xy / sqrt((x^2 + z^2) (y^2 + z^2))`, as an arc tangent
/// because close to the plane that cosine is 1 but for its last bits. `cos` is `xy`, its sign by the corner.
#[inline(always)]
fn inner_angle<F: Float>(x: F, y: F, z: F, cos: F) -> F {
    angle_of_upper(-z * (x * x + y * y + z * z).sqrt(), cos)
}

/// Where a value lies between two others, in [0, 1].
#[inline(always)]
fn share<F: Float>(value: F, from: F, to: F) -> F {
    ((value - from) / (to - from)).clamp(F::splat(0.0), F::splat(1.0))
}

/// A rectangle as seen from a point.
#[derive(Debug, Clone, Copy)]
pub struct SphericalRectangle(SphericalRectangles<f32>);

impl SphericalRectangle {
    /// The rectangle with this corner and these edges at right angles, seen from `eye`.
    pub fn new(eye: Vec3, corner: Vec3, edge_u: Vec3, edge_v: Vec3) -> Self {
        let [eye, corner, edge_u, edge_v] = [eye, corner, edge_u, edge_v].map(lane_vector);
        SphericalRectangle(SphericalRectangles::new(eye, corner, edge_u, edge_v))
    }

    /// In [0, 2 pi]; off by about 1e-6.
    pub fn solid_angle(&self) -> f32 {
        self.0.solid_angle()
    }

    /// The place on the rectangle, in [0, 1]^2 along its edges, of a direction uniform in its solid angle.
    pub fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        self.0.sample(u)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::sampler::Sampler;

    /// Eyes in front of, beside, close to and almost in the plane of a rectangle of 2 by 1.
    const EYES: [[f32; 3]; 10] = [
        [0.5, 0.0, 0.3],
        [0.5, 1.0, 0.3],
        [0.0, 0.0, 0.3],
        [2.0, 0.7, 0.3],
        [1.0, 0.5, 1.0],
        [1.0, 0.5, 1e-3],
        [0.3, 0.2, -0.05],
        [-0.5, 1.2, 0.4],
        [1e-3, 0.5, 0.5],
        [-1e-3, 0.5, 0.2],
    ];

    /// The solid angle is what the sum of cos / d^2 over a fine grid says, and each of 10 x 20 cells of the rectangle
    /// gets its share of the samples: chi-square of 200,000 with cells below 5 merged, 99.99 % quantile by Wilson and
    /// Hilferty.
    #[test]
    fn samples_are_uniform_in_solid_angle() {
        for eye in EYES.map(Vec3::from_array) {
            let whole = SphericalRectangle::new(eye, Vec3::ZERO, Vec3::X * 2.0, Vec3::Y);
            let n = 200_000;
            let mut counts = [[0u32; 20]; 10];
            for sample in 0..n {
                let u = Sampler::independent(0, sample, 1).unit4(0);
                let [s, t] = whole.sample([u[0], u[1]]);
                counts[((s * 10.0) as usize).min(9)][((t * 20.0) as usize).min(19)] += 1;
            }
            let (mut sum, mut chi2, mut bins) = (0.0, 0.0, 0);
            let (mut rest_expected, mut rest_count) = (0.0, 0.0);
            for (i, column) in counts.iter().enumerate() {
                for (j, &count) in column.iter().enumerate() {
                    let corner = Vec3::new(0.2 * i as f32, 0.05 * j as f32, 0.0);
                    let cell = exact_solid_angle(eye, corner, 0.2, 0.05);
                    sum += cell;
                    let expected = f64::from(n) * cell / f64::from(whole.solid_angle());
                    if expected < 5.0 {
                        rest_expected += expected;
                        rest_count += f64::from(count);
                    } else {
                        chi2 += (f64::from(count) - expected).powi(2) / expected;
                        bins += 1;
                    }
                }
            }
            assert!((sum / f64::from(whole.solid_angle()) - 1.0).abs() < 1e-4, "{eye}: {sum} {}", whole.solid_angle());
            if rest_expected > 0.0 {
                chi2 += (rest_count - rest_expected).powi(2) / rest_expected;
            }
            let k = f64::from(bins);
            let quantile = k * (1.0 - 2.0 / (9.0 * k) + 3.719 * (2.0 / (9.0 * k)).sqrt()).powi(3);
            assert!(chi2 < quantile, "{eye}: {chi2} over {bins} bins");
        }
    }

    /// Inclusion and exclusion of `atan(xy / (z sqrt(x^2 + y^2 + z^2)))` at the corners, in f64.
    fn exact_solid_angle(eye: Vec3, corner: Vec3, width: f32, height: f32) -> f64 {
        let (d, z) = ((corner - eye).as_dvec3(), f64::from(eye.z.abs()));
        let at = |x: f64, y: f64| (x * y / (z * (x * x + y * y + z * z).sqrt())).atan();
        let (x1, y1) = (d.x + f64::from(width), d.y + f64::from(height));
        at(x1, y1) - at(d.x, y1) - at(x1, d.y) + at(d.x, d.y)
    }

    #[test]
    fn an_eye_in_the_plane_sees_nothing_and_samples_stay_finite() {
        for eye in [[1.0, 0.5, 0.0], [0.0, 0.0, 0.0], [3.0, 0.5, 0.0], [0.0, 0.5, 1e-12]] {
            let seen = SphericalRectangle::new(Vec3::from_array(eye), Vec3::ZERO, Vec3::X * 2.0, Vec3::Y);
            assert!(if eye[2] == 0.0 { seen.solid_angle() == 0.0 } else { seen.solid_angle() <= 0.5001 * TAU });
            let last = 1.0 - f32::EPSILON / 2.0;
            for u in [[0.0, 0.0], [last, last], [0.5, 0.5], [0.0, last]] {
                assert!(seen.sample(u).iter().all(|s| (0.0..=1.0).contains(s)), "{eye:?} {u:?} {:?}", seen.sample(u));
            }
        }
    }
}
