//! Warps of uniform random numbers to directions and points, in each lane. [`crate::sampling`] has them for one.
//!
//! Twins: `shaders/pathtrace/sampling/warp.wgsl` and `angles.wgsl`.

use crate::sampling::UNIFORM_HEMISPHERE_PDF;
use simd::{Float, Vector, Word};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Sine and cosine of `2 pi u` for `u` in [0, 1], by polynomials on an eighth of a turn (Cephes' coefficients): the
/// same arithmetic can run in a shader. Largest error 1.2e-7.
#[inline(always)]
pub fn sin_cos_2pi<F: Float>(u: F) -> (F, F) {
    let turned = u * 4.0;
    let quadrant = turned.round();
    let x = (turned - quadrant) * FRAC_PI_2;
    let x2 = x * x;
    let sin = x + x * x2 * (x2 * (x2 * -1.951_529_6e-4 + 8.332_161e-3) + -1.666_665_5e-1);
    let cos = F::splat(1.0) - x2 * 0.5 + x2 * x2 * (x2 * (x2 * 2.443_315_7e-5 + -1.388_731_6e-3) + 4.166_664_6e-2);
    let quadrant = quadrant.to_word();
    // a quarter of a turn swaps sine and cosine; half a turn changes both signs
    let odd = has_bit(quadrant, 1);
    let (sin, cos) = (F::select(odd, cos, sin), F::select(odd, sin, cos));
    let cos_negative = has_bit(quadrant.wrapping_add(F::U::splat(1)), 2);
    (F::select(has_bit(quadrant, 2), -sin, sin), F::select(cos_negative, -cos, cos))
}

#[inline(always)]
fn has_bit<U: Word>(value: U, bit: u32) -> U::M {
    !(value & U::splat(bit)).eq(U::splat(0))
}

/// The angle in [0, pi] of the point (x, y), y >= 0, by Cephes' polynomial; 0 for the origin. Largest error 3e-7.
#[inline(always)]
pub fn angle_of_upper<F: Float>(y: F, x: F) -> F {
    let (zero, one) = (F::splat(0.0), F::splat(1.0));
    let size = x.abs();
    let steep = y.gt(size);
    let (small, large) = (F::select(steep, size, y), F::select(steep, y, size));
    let tangent = F::select(large.eq(zero), zero, small / large);
    // above the tangent of an eighth of pi, the angle from the diagonal
    let beyond = tangent.gt(F::splat(0.414_213_56));
    let t = F::select(beyond, (tangent - one) / (tangent + one), tangent);
    let t2 = t * t;
    let series = (((t2 * 8.053_744_5e-2 + -1.387_768_6e-1) * t2 + 1.997_771_1e-1) * t2 + -3.333_295e-1) * t2 * t + t;
    let angle = series + F::select(beyond, F::splat(FRAC_PI_4), zero);
    let angle = F::select(steep, F::splat(FRAC_PI_2) - angle, angle);
    F::select(x.lt(zero), F::splat(PI) - angle, angle)
}

/// The angle in [0, pi / 2] with this sine and cosine: the arc sine of the smaller of the two, which is at most the
/// root of a half, by a minimax polynomial. Without the cancellation that an arc sine near 1 has. Largest error 1.7e-7,
/// of small angles relative.
#[inline(always)]
pub fn angle_of_sine<F: Float>(sin: F, cos: F) -> F {
    let steep = sin.gt(cos);
    let x = F::select(steep, cos, sin);
    let z = x * x;
    let series = (z * 1.136_366_3e-1 + -9.695_092e-2) * z + 8.020_588e-2;
    let series = ((series * z + 1.516_110_2e-2) * z + 4.675_157_4e-2) * z + 7.485_898e-2;
    let angle = x + x * z * (series * z + 1.666_702_1e-1);
    F::select(steep, F::splat(FRAC_PI_2) - angle, angle)
}

/// Two unit vectors that make a right-handed frame with the unit vector `n`: Duff et al., "Building an Orthonormal
/// Basis, Revisited" (JCGT 6(1), 2017), accurate also at n = (0, 0, -1).
#[inline(always)]
pub fn orthonormal_basis<F: Float>(n: Vector<F>) -> (Vector<F>, Vector<F>) {
    let one = F::splat(1.0);
    let sign = one.copysign(n.z);
    let a = F::splat(-1.0) / (sign + n.z);
    let b = n.x * n.y * a;
    (Vector::new(one + sign * n.x * n.x * a, sign * b, -sign * n.x), Vector::new(b, sign + n.y * n.y * a, -n.y))
}

/// A local direction, z along the unit vector `axis`, in world space.
#[inline(always)]
pub fn to_world<F: Float>(local: Vector<F>, axis: Vector<F>) -> Vector<F> {
    let (s, t) = orthonormal_basis(axis);
    s * local.x + t * local.y + axis * local.z
}

/// A direction around z whose z is given: `z` in [-1, 1] and `sin` = sqrt(1 - z^2), azimuth from `u`.
#[inline(always)]
fn around_z<F: Float>(z: F, sin: F, u: F) -> Vector<F> {
    let (sin_phi, cos_phi) = sin_cos_2pi(u);
    Vector::new(sin * cos_phi, sin * sin_phi, z)
}

/// Uniform on the hemisphere around z; density [`UNIFORM_HEMISPHERE_PDF`] (Task 2 b).
#[inline(always)]
pub fn uniform_hemisphere<F: Float>(u: [F; 2]) -> Vector<F> {
    let z = F::splat(1.0) - u[0];
    around_z(z, (u[0] * (F::splat(2.0) - u[0])).sqrt(), u[1])
}

/// Proportional to the cosine on the hemisphere around z, after Malley; density `cos / pi`.
#[inline(always)]
pub fn cosine_hemisphere<F: Float>(u: [F; 2]) -> Vector<F> {
    around_z((F::splat(1.0) - u[0]).sqrt(), u[0].sqrt(), u[1])
}

/// Uniform on the unit disk in the plane z = 0; density `1 / pi`.
#[inline(always)]
pub fn disk<F: Float>(u: [F; 2]) -> [F; 2] {
    let (sin_phi, cos_phi) = sin_cos_2pi(u[1]);
    let radius = u[0].sqrt();
    [radius * cos_phi, radius * sin_phi]
}

/// Uniform in the cone around z whose half angle has `1 - cos` = `one_minus_cos`; density [`cone_pdf`].
#[inline(always)]
pub fn cone<F: Float>(one_minus_cos: F, u: [F; 2]) -> Vector<F> {
    let height = u[0] * one_minus_cos;
    around_z(F::splat(1.0) - height, (height * (F::splat(2.0) - height)).sqrt(), u[1])
}

/// Density of [`cone`] per solid angle.
#[inline(always)]
pub fn cone_pdf<F: Float>(one_minus_cos: F) -> F {
    F::splat(UNIFORM_HEMISPHERE_PDF) / one_minus_cos
}

/// Barycentric coordinates uniform on a triangle: Heitz, "A Low-Distortion Map Between Triangle and Square" (2019).
#[inline(always)]
pub fn triangle<F: Float>(u: [F; 2]) -> [F; 3] {
    let (half_0, half_1) = (u[0] * 0.5, u[1] * 0.5);
    let below = u[0].lt(u[1]);
    let b0 = F::select(below, half_0, u[0] - half_1);
    let b1 = F::select(below, u[1] - half_0, half_1);
    [b0, b1, F::splat(1.0) - b0 - b1]
}
