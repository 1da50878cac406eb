//! Warps of uniform random numbers to directions and points, each with its density.

use scene::Vec3;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};

/// Sine and cosine of `2 pi u` for `u` in [0, 1], by polynomials on an eighth of a turn (Cephes' coefficients): the same
/// arithmetic can run in a shader. Largest error 1.2e-7.
pub fn sin_cos_2pi(u: f32) -> (f32, f32) {
    let quadrant = (4.0 * u).round();
    let x = (4.0 * u - quadrant) * FRAC_PI_2;
    let x2 = x * x;
    let sin = x + x * x2 * (-1.666_665_5e-1 + x2 * (8.332_161e-3 + x2 * -1.951_529_6e-4));
    let cos = 1.0 - 0.5 * x2 + x2 * x2 * (4.166_664_6e-2 + x2 * (-1.388_731_6e-3 + x2 * 2.443_315_7e-5));
    match quadrant as u32 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Two unit vectors that make a right-handed frame with the unit vector `n`: Duff et al., "Building an Orthonormal Basis,
/// Revisited" (JCGT 6(1), 2017), accurate also at n = (0, 0, -1).
pub fn orthonormal_basis(n: Vec3) -> (Vec3, Vec3) {
    let sign = 1f32.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3::new(b, sign + n.y * n.y * a, -n.y))
}

/// A local direction, z along the unit vector `axis`, in world space.
pub fn to_world(local: Vec3, axis: Vec3) -> Vec3 {
    let (s, t) = orthonormal_basis(axis);
    s * local.x + t * local.y + axis * local.z
}

/// A direction around z whose z is given: `z` in [-1, 1] and `sin` = sqrt(1 - z^2), azimuth from `u`.
fn around_z(z: f32, sin: f32, u: f32) -> Vec3 {
    let (sin_phi, cos_phi) = sin_cos_2pi(u);
    Vec3::new(sin * cos_phi, sin * sin_phi, z)
}

/// Uniform on the hemisphere around z; density [`UNIFORM_HEMISPHERE_PDF`] (Task 2 b).
pub fn uniform_hemisphere(u: [f32; 2]) -> Vec3 {
    let z = 1.0 - u[0];
    around_z(z, (u[0] * (2.0 - u[0])).sqrt(), u[1])
}

/// `1 / (2 pi)`, "1 / surface area" (Task 2 b).
pub const UNIFORM_HEMISPHERE_PDF: f32 = 0.5 * FRAC_1_PI;

/// Proportional to the cosine on the hemisphere around z, after Malley; density `cos / pi`.
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    around_z((1.0 - u[0]).sqrt(), u[0].sqrt(), u[1])
}

/// Uniform on the unit disk in the plane z = 0; density `1 / pi`.
pub fn disk(u: [f32; 2]) -> Vec3 {
    let (sin_phi, cos_phi) = sin_cos_2pi(u[1]);
    let radius = u[0].sqrt();
    Vec3::new(radius * cos_phi, radius * sin_phi, 0.0)
}

/// Uniform in the cone around z whose half angle has `1 - cos` = `one_minus_cos`; density [`cone_pdf`].
pub fn cone(one_minus_cos: f32, u: [f32; 2]) -> Vec3 {
    let height = u[0] * one_minus_cos;
    around_z(1.0 - height, (height * (2.0 - height)).sqrt(), u[1])
}

/// Density of [`cone`] per solid angle.
pub fn cone_pdf(one_minus_cos: f32) -> f32 {
    UNIFORM_HEMISPHERE_PDF / one_minus_cos
}

/// Barycentric coordinates uniform on a triangle: Heitz, "A Low-Distortion Map Between Triangle and Square" (2019).
pub fn triangle(u: [f32; 2]) -> [f32; 3] {
    let (b0, b1) = if u[0] < u[1] { (0.5 * u[0], u[1] - 0.5 * u[0]) } else { (u[0] - 0.5 * u[1], 0.5 * u[1]) };
    [b0, b1, 1.0 - b0 - b1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::Sampler;

    #[test]
    fn sine_and_cosine_are_right_to_single_precision() {
        for i in 0..=100_000 {
            let u = i as f32 / 100_000.0;
            let (sin, cos) = sin_cos_2pi(u);
            let exact = f64::from(u) * std::f64::consts::TAU;
            assert!((f64::from(sin) - exact.sin()).abs() < 1.5e-7 && (f64::from(cos) - exact.cos()).abs() < 1.5e-7);
        }
    }

    #[test]
    fn basis_is_orthonormal_where_frisvad_fails() {
        for n in [
            [0.000_385_273_16, 0.000_384_600_16, -0.999_999_880_79],
            [-0.000_198_135_81, -0.000_089_468_39, -0.999_999_880_79],
            [0.0, 0.0, -1.0],
        ] {
            let n = Vec3::from_array(n);
            let (s, t) = orthonormal_basis(n);
            for error in [s.dot(t), s.dot(n), t.dot(n), s.length() - 1.0, t.length() - 1.0] {
                assert!(error.abs() < 3e-7, "{n}: {error}");
            }
        }
    }

    /// Chi-square of a warp against its density over 8 equal-probability rings x 16 azimuths, 400,000 samples: 127
    /// degrees of freedom, 99.99 % quantile 194.
    fn assert_distributed(warp: impl Fn([f32; 2]) -> Vec3, cumulative_of_z: impl Fn(f32) -> f32) {
        let mut bins = [0u32; 8 * 16];
        let n = 400_000;
        for i in 0..n {
            let u = Sampler::independent(0, i, 5).unit4(0);
            let w = warp([u[0], u[1]]);
            let ring = (cumulative_of_z(w.z) * 8.0).clamp(0.0, 7.0) as usize;
            let azimuth = (w.y.atan2(w.x) / std::f32::consts::TAU).rem_euclid(1.0) * 16.0;
            bins[ring * 16 + (azimuth as usize).min(15)] += 1;
        }
        let expected = f64::from(n) / bins.len() as f64;
        let chi2: f64 = bins.iter().map(|&b| (f64::from(b) - expected).powi(2) / expected).sum();
        assert!(chi2 < 194.0, "{chi2}");
    }

    #[test]
    fn directions_follow_their_densities() {
        assert_distributed(uniform_hemisphere, |z| 1.0 - z);
        assert_distributed(cosine_hemisphere, |z| 1.0 - z * z);
        assert_distributed(|u| cone(0.3, u), |z| (1.0 - z) / 0.3);
    }

    #[test]
    fn warps_are_finite_at_both_ends_of_the_random_numbers() {
        let last = 1.0 - f32::EPSILON / 2.0;
        for u in [[0.0, 0.0], [last, last], [0.0, last], [last, 0.0]] {
            for w in [uniform_hemisphere(u), cosine_hemisphere(u), cone(1e-6, u)] {
                assert!(w.is_finite() && (w.length() - 1.0).abs() < 1e-6);
            }
            assert!(triangle(u).iter().all(|b| (0.0..=1.0).contains(b)));
        }
    }
}
