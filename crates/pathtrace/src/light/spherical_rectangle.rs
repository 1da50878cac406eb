//! A rectangle sampled uniformly in the solid angle that it fills: Ureña, Fajardo and King, "An Area-Preserving
//! Parametrization for Spherical Rectangles" (EGSR 2013).

use scene::Vec3;
use std::f32::consts::TAU;

/// A rectangle as seen from a point.
#[derive(Debug, Clone, Copy)]
pub struct SphericalRectangle {
    x0: f32,
    x1: f32,
    y0: f32,
    y1: f32,
    /// Distance of the plane, negative.
    z0: f32,
    /// z of the normals of the great circles below and above.
    b0: f32,
    b1: f32,
    /// `2 pi` less two of the inner angles.
    k: f32,
    solid_angle: f32,
}

impl SphericalRectangle {
    /// The rectangle with this corner and these edges at right angles, seen from `eye`.
    pub fn new(eye: Vec3, corner: Vec3, edge_u: Vec3, edge_v: Vec3) -> Self {
        let (width, height) = (edge_u.length(), edge_v.length());
        let (x, y) = (edge_u / width, edge_v / height);
        let d = corner - eye;
        let z0 = -d.dot(x.cross(y)).abs();
        let (x0, y0) = (d.dot(x), d.dot(y));
        let (x1, y1) = (x0 + width, y0 + height);
        let across = |y: f32| y / (z0 * z0 + y * y).sqrt();
        // inner angle at a corner: the arc cosine of `xy / sqrt((x^2 + z^2) (y^2 + z^2))`, as an arc tangent because close
        // to the plane that cosine is 1 but for its last bits
        let angle = |x: f32, y: f32, cos: f32| (-z0 * (x * x + y * y + z0 * z0).sqrt()).atan2(cos);
        let (g0, g1) = (angle(x1, y0, x1 * y0), angle(x1, y1, -x1 * y1));
        let (g2, g3) = (angle(x0, y1, x0 * y1), angle(x0, y0, -x0 * y0));
        let k = TAU - g2 - g3;
        // in its plane an eye sees nothing of it
        let solid_angle = if z0 == 0.0 { 0.0 } else { (g0 + g1 - k).max(0.0) };
        SphericalRectangle { x0, x1, y0, y1, z0, b0: -across(y0), b1: across(y1), k, solid_angle }
    }

    /// In [0, 2 pi]; off by about 1e-6.
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle
    }

    /// The place on the rectangle, in [0, 1]^2 along its edges, of a direction uniform in its solid angle.
    #[inline(never)]
    pub fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        if self.solid_angle == 0.0 {
            return u;
        }
        let (sin, cos) = (u[0] * self.solid_angle + self.k).sin_cos();
        let fu = (cos * self.b0 - self.b1) / sin;
        let cu = (1.0 / (fu * fu + self.b0 * self.b0).sqrt()).copysign(fu).clamp(-1.0, 1.0);
        let xu = (-(cu * self.z0) / (1.0 - cu * cu).max(f32::MIN_POSITIVE).sqrt()).clamp(self.x0, self.x1);
        let d = (xu * xu + self.z0 * self.z0).sqrt();
        let h = |y: f32| y / (d * d + y * y).sqrt();
        let (h0, h1) = (h(self.y0), h(self.y1));
        let hv = h0 + u[1] * (h1 - h0);
        let rest = ((1.0 - hv) * (1.0 + hv)).max(f32::MIN_POSITIVE);
        let yv = (hv * d / rest.sqrt()).clamp(self.y0, self.y1);
        let share = |value: f32, from: f32, to: f32| ((value - from) / (to - from)).clamp(0.0, 1.0);
        [share(xu, self.x0, self.x1), share(yv, self.y0, self.y1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::Sampler;

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

    /// The solid angle is what the sum of cos / d^2 over a fine grid says, and each of 10 x 20 cells of the rectangle gets
    /// its share of the samples: chi-square of 200,000 with cells below 5 merged, 99.99 % quantile by Wilson and Hilferty.
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
