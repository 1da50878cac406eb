//! Warps of uniform random numbers to directions and points, each with its density: [`crate::sampling::warp`] for one
//! lane.

pub mod discrete;
pub mod rng;
pub mod sampler;
pub mod sobol;
pub mod warp;

use crate::vectors::{glam_vector, lane_vector};
use scene::Vec3;
use std::f32::consts::FRAC_1_PI;

pub use warp::{cone_pdf, sin_cos_2pi, triangle};

/// Two unit vectors that make a right-handed frame with the unit vector `n`.
pub fn orthonormal_basis(n: Vec3) -> (Vec3, Vec3) {
    let (s, t) = warp::orthonormal_basis(lane_vector(n));
    (glam_vector(s), glam_vector(t))
}

/// A local direction, z along the unit vector `axis`, in world space.
pub fn to_world(local: Vec3, axis: Vec3) -> Vec3 {
    glam_vector(warp::to_world(lane_vector(local), lane_vector(axis)))
}

/// Uniform on the hemisphere around z; density [`UNIFORM_HEMISPHERE_PDF`] (Task 2 b).
pub fn uniform_hemisphere(u: [f32; 2]) -> Vec3 {
    glam_vector(warp::uniform_hemisphere(u))
}

/// `1 / (2 pi)`, "1 / surface area" (Task 2 b).
pub const UNIFORM_HEMISPHERE_PDF: f32 = 0.5 * FRAC_1_PI;

/// Proportional to the cosine on the hemisphere around z, after Malley; density `cos / pi`.
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    glam_vector(warp::cosine_hemisphere(u))
}

/// Uniform on the unit disk in the plane z = 0; density `1 / pi`.
pub fn disk(u: [f32; 2]) -> Vec3 {
    let [x, y] = warp::disk(u);
    Vec3::new(x, y, 0.0)
}

/// Uniform in the cone around z whose half angle has `1 - cos` = `one_minus_cos`; density [`cone_pdf`].
pub fn cone(one_minus_cos: f32, u: [f32; 2]) -> Vec3 {
    glam_vector(warp::cone(one_minus_cos, u))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::sampler::Sampler;

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
    fn angles_of_sines_are_right_to_single_precision() {
        for i in 0..=100_000 {
            let exact = f64::from(i) / 100_000.0 * std::f64::consts::FRAC_PI_2;
            let angle = f64::from(warp::angle_of_sine(exact.sin() as f32, exact.cos() as f32));
            assert!((angle - exact).abs() < 1.7e-7, "{exact}: {angle}");
            let small = 1e-3 * exact;
            let angle = f64::from(warp::angle_of_sine(small.sin() as f32, small.cos() as f32));
            assert!((angle - small).abs() <= 1.2e-7 * small, "{small}: {angle}");
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
