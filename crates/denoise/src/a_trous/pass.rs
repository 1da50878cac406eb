//! One level of the filter, and the variance where nobody knows it: a lane is a pixel.
//! Twin: `shaders/denoise/a_trous/pass.wgsl`.

use super::Rows;
use super::picture::{ALBEDO, DEPTH, Guides, Light, MARGIN, MISS, NORMAL, RGB, SLOPES, VARIANCE};
use simd::{Float, Kernel, Vector, Word};

/// How fast a tap's weight falls with depth, luminance and (an exponent of 2) the normal: the paper's values, section 4.4.
const SIGMA_DEPTH: f32 = 1.0;
const SIGMA_LUMINANCE: f32 = 4.0;
const LOG2_SIGMA_NORMAL: u32 = 7;
/// And, beyond the paper, with albedo: a lamp and what it is set in have one normal and one depth, and light of another kind.
const SIGMA_ALBEDO: f32 = 0.15;

/// So that nothing is divided by 0: of a depth a share and an amount, of a luminance' deviation an amount.
const LEAST_DEPTH: f32 = 1e-4;
const LEAST_DIFFERENCE: f32 = 1e-30;
const LEAST_DEVIATION: f32 = 1e-6;

/// A cubic B-spline's values, half of the kernel.
const SPLINE_0: f32 = 3.0 / 8.0;
const SPLINE_1: f32 = 1.0 / 4.0;
const SPLINE_2: f32 = 1.0 / 16.0;
const SPLINE: [f32; 3] = [SPLINE_0, SPLINE_1, SPLINE_2];

/// Those of this file, for [`super::shared_constants`].
pub fn shared_constants() -> Vec<(&'static str, f64)> {
    gpu::named_values![
        LEAST_DEPTH,
        LEAST_DEVIATION,
        LEAST_DIFFERENCE,
        LOG2_SIGMA_NORMAL,
        SIGMA_ALBEDO,
        SIGMA_DEPTH,
        SIGMA_LUMINANCE,
        SPLINE_0,
        SPLINE_1,
        SPLINE_2,
    ]
}

/// Pixels of a row, as many as there are lanes.
struct Place<'a, F> {
    guides: &'a Guides,
    x: usize,
    y: usize,
    normal: Vector<F>,
    miss: F,
    depth: F,
    slopes: [F; 2],
    albedo: Vector<F>,
}

impl<'a, F: Float> Place<'a, F> {
    #[inline(always)]
    fn new(guides: &'a Guides, x: usize, y: usize) -> Self {
        let at = |kind: usize| F::load(&guides.row(y, kind)[MARGIN + x..]);
        let normal = Vector::new(at(NORMAL[0]), at(NORMAL[1]), at(NORMAL[2]));
        let albedo = Vector::new(at(ALBEDO[0]), at(ALBEDO[1]), at(ALBEDO[2]));
        let slopes = [at(SLOPES[0]), at(SLOPES[1])];
        Place { guides, x, y, normal, miss: at(MISS), depth: at(DEPTH), slopes, albedo }
    }

    /// Where a tap lies, if its row is in the picture.
    #[inline(always)]
    fn tap(&self, dx: isize, dy: isize) -> Option<(usize, usize)> {
        let row = self.y.checked_add_signed(dy).filter(|row| *row < self.guides.height)?;
        Some(((MARGIN + self.x).wrapping_add_signed(dx), row))
    }

    /// How alike the normals are (equation 4), and how unlike the depths (3) and the albedos, as a negative exponent.
    #[inline(always)]
    fn likeness(&self, (column, row): (usize, usize), dx: isize, dy: isize) -> (F, F) {
        let at = |kind: usize| F::load(&self.guides.row(row, kind)[column..]);
        let normal = Vector::new(at(NORMAL[0]), at(NORMAL[1]), at(NORMAL[2]));
        let mut alike = (self.normal.dot(normal) + self.miss * at(MISS)).max(F::splat(0.0));
        for _ in 0..LOG2_SIGMA_NORMAL {
            alike = alike * alike;
        }
        let expected = self.slopes[0] * (dx.unsigned_abs() as f32) + self.slopes[1] * (dy.unsigned_abs() as f32);
        let least = self.depth.abs() * LEAST_DEPTH + F::splat(LEAST_DIFFERENCE);
        let albedo = Vector::new(at(ALBEDO[0]), at(ALBEDO[1]), at(ALBEDO[2])) - self.albedo;
        let unlike = (at(DEPTH) - self.depth).abs() / (expected * SIGMA_DEPTH + least);
        (alike, -unlike - albedo.length_squared() * (SIGMA_ALBEDO * SIGMA_ALBEDO).recip())
    }
}

/// A level: each pixel becomes a mean of its taps.
pub struct Filter<'a> {
    pub guides: &'a Guides,
    pub light: &'a Light,
    pub step: isize,
    pub rows: Rows<'a>,
}

impl Kernel for Filter<'_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Float>(self) {
        for x in (0..self.light.width).step_by(F::LANES) {
            let (light, variance) = self.filtered(&Place::<F>::new(self.guides, x, self.rows.y));
            store(self.light, self.rows.row, x, light, variance);
        }
    }
}

impl Filter<'_> {
    /// Light and its variance, whose weights are squared (equations 1, 2).
    #[inline(always)]
    fn filtered<F: Float>(&self, place: &Place<F>) -> (Vector<F>, F) {
        let own = light::<F>(self.light, MARGIN + place.x, place.y);
        let deviation = self.blurred_variance(place).sqrt();
        let own_luminance = luminance(own);
        let scale = F::splat(-1.0) / (deviation * SIGMA_LUMINANCE + F::splat(LEAST_DEVIATION));
        let centre = SPLINE[0] * SPLINE[0];
        let (mut sum, mut weights) = (own * F::splat(centre), F::splat(centre));
        let mut variance = variance::<F>(self.light, MARGIN + place.x, place.y) * (centre * centre);
        for (i, j) in taps(2) {
            let (dx, dy) = (i * self.step, j * self.step);
            let Some(at) = place.tap(dx, dy) else { continue };
            let (alike, unlike) = place.likeness(at, dx, dy);
            let light = light::<F>(self.light, at.0, at.1);
            let unlike = unlike + (luminance(light) - own_luminance).abs() * scale;
            let weight = alike * exp(unlike) * (SPLINE[i.unsigned_abs()] * SPLINE[j.unsigned_abs()]);
            sum = sum + light * weight;
            weights = weights + weight;
            variance = variance + weight * weight * self::variance::<F>(self.light, at.0, at.1);
        }
        (sum.divided_by(weights), variance / (weights * weights))
    }

    /// A mean over 3 x 3 pixels, in equation 5: the variance is an estimate, and itself noisy.
    #[inline(always)]
    fn blurred_variance<F: Float>(&self, place: &Place<F>) -> F {
        let mut sum = F::splat(0.0);
        for (dy, down) in [(-1, 0.25), (0, 0.5), (1, 0.25)] {
            let row = place.y.saturating_add_signed(dy).min(self.light.height - 1);
            for (dx, across) in [(-1, 0.25), (0, 0.5), (1, 0.25)] {
                let column = (MARGIN + place.x).wrapping_add_signed(dx);
                sum = sum + variance::<F>(self.light, column, row) * (down * across);
            }
        }
        sum
    }
}

/// The variance of luminance among neighbours of the same surface, 7 x 7 pixels: what the paper takes where there is no
/// history (section 4.2).
pub struct Moments<'a> {
    pub guides: &'a Guides,
    pub light: &'a Light,
    pub rows: Rows<'a>,
}

impl Kernel for Moments<'_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Float>(self) {
        for x in (0..self.light.width).step_by(F::LANES) {
            let place = Place::<F>::new(self.guides, x, self.rows.y);
            let own = light::<F>(self.light, MARGIN + x, self.rows.y);
            store(self.light, self.rows.row, x, own, self.variance(&place, luminance(own)));
        }
    }
}

impl Moments<'_> {
    /// Around the pixel's own value, so that equal ones differ by nothing.
    #[inline(always)]
    fn variance<F: Float>(&self, place: &Place<F>, own: F) -> F {
        let (mut first, mut second, mut weights) = (F::splat(0.0), F::splat(0.0), F::splat(1.0));
        for (dx, dy) in taps(3) {
            let Some(at) = place.tap(dx, dy) else { continue };
            let (alike, unlike) = place.likeness(at, dx, dy);
            let weight = alike * exp(unlike);
            let off = luminance(light::<F>(self.light, at.0, at.1)) - own;
            first = first + weight * off;
            second = second + weight * off * off;
            weights = weights + weight;
        }
        let mean = first / weights;
        (second / weights - mean * mean).max(F::splat(0.0))
    }
}

/// All places of a square but its centre.
#[inline(always)]
fn taps(reach: isize) -> impl Iterator<Item = (isize, isize)> {
    (-reach..=reach).flat_map(move |j| (-reach..=reach).map(move |i| (i, j))).filter(|tap| *tap != (0, 0))
}

#[inline(always)]
fn light<F: Float>(light: &Light, column: usize, row: usize) -> Vector<F> {
    let at = |kind: usize| F::load(&light.row(row, kind)[column..]);
    Vector::new(at(RGB[0]), at(RGB[1]), at(RGB[2]))
}

#[inline(always)]
fn variance<F: Float>(light: &Light, column: usize, row: usize) -> F {
    F::load(&light.row(row, VARIANCE)[column..])
}

#[inline(always)]
fn luminance<F: Float>(rgb: Vector<F>) -> F {
    rgb.x * 0.2126 + rgb.y * 0.7152 + rgb.z * 0.0722
}

#[inline(always)]
fn store<F: Float>(light: &Light, row: &mut [f32], x: usize, rgb: Vector<F>, variance: F) {
    let values = [(RGB[0], rgb.x), (RGB[1], rgb.y), (RGB[2], rgb.z), (VARIANCE, variance)];
    for (kind, value) in values {
        value.store(&mut row[kind * light.stride() + MARGIN + x..]);
    }
}

/// e to the power of a number that is not above 0, to 1e-5 of it: 2 to a whole number, which is an exponent, times 2 to a
/// share of 1, a Taylor polynomial around the middle.
#[inline(always)]
fn exp<F: Float>(x: F) -> F {
    let exponent = (x * std::f32::consts::LOG2_E).max(F::splat(-126.0));
    let whole = exponent.floor();
    let rest = (exponent - whole - F::splat(0.5)) * std::f32::consts::LN_2;
    let mut power = F::splat(0.0);
    for over_factorial in [1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0] {
        power = power * rest + F::splat(over_factorial);
    }
    let two_to_whole = (whole + F::splat(127.0)).to_word().shl::<23>().float_from_bits();
    power * two_to_whole * std::f32::consts::SQRT_2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_near_enough_for_weights() {
        for i in 0..2000 {
            let x = -(i as f32) * 0.04;
            let expected = f64::from(x).exp();
            assert!((f64::from(exp(x)) - expected).abs() <= 1e-5 * expected, "{x}: {}", exp(x));
        }
        assert!(exp(-1e30_f32) < 1e-37);
    }
}
