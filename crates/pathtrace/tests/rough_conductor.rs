//! The lobe of rough metal against its own density, against quadrature in f64 of the textbook's equations, and against
//! Fresnel's equations in complex numbers.

mod facets;

use facets::{at, facet, place};
use pathtrace::bsdf::RoughConductor;
use pathtrace::sampling::sampler::Sampler;
use scene::glam::DVec3;
use scene::{Conductor, Vec3};
use std::f64::consts::{FRAC_PI_2, LN_2, TAU};

const ALPHAS: [f32; 5] = [1e-4, 0.01, 0.1, 0.4, 1.0];
const DEGREES: [f64; 4] = [0.0, 30.0, 60.0, 85.0];

fn white(alpha: f32) -> RoughConductor {
    RoughConductor { alpha, conductor: Conductor::Constant(Vec3::ONE) }
}

/// Every lobe under every angle.
fn lobes() -> impl Iterator<Item = (RoughConductor, DVec3, String)> {
    let one = |alpha, degrees| (white(alpha), at(degrees), format!("alpha {alpha}, {degrees} degrees"));
    ALPHAS.into_iter().flat_map(move |alpha| DEGREES.into_iter().map(move |degrees| one(alpha, degrees)))
}

fn random(item: u32) -> [f32; 2] {
    let [u, v, ..] = Sampler::independent(5, item, 1).unit4(0);
    [u, v]
}

const ROWS: usize = 10;
const COLUMNS: usize = 20;

/// The integral of `density`, per solid angle of facets, over each of `ROWS * COLUMNS` cells of the coordinates.
fn integrals(alpha: f64, density: impl Fn(DVec3) -> f64) -> Vec<f64> {
    const STEPS: usize = 16;
    let mut cells = vec![0.0; ROWS * COLUMNS];
    let (rows, columns) = (ROWS * STEPS, COLUMNS * STEPS);
    for row in 0..rows {
        for column in 0..columns {
            let (v, turn) = ((row as f64 + 0.5) / rows as f64, (column as f64 + 0.5) / columns as f64);
            let (normal, area) = facet(alpha, v, turn);
            cells[row / STEPS * COLUMNS + column / STEPS] += density(normal) * area / (rows * columns) as f64;
        }
    }
    cells
}

/// What `pdf` says of a direction, per solid angle of the facet that reflects there; 0 of facets that `wo` does not see.
fn density_of_facet(lobe: &RoughConductor, wo: DVec3, normal: DVec3) -> f64 {
    let cosine = wo.dot(normal);
    if cosine <= 0.0 {
        return 0.0;
    }
    let wi = normal * (2.0 * cosine) - wo;
    f64::from(lobe.pdf(wo.as_vec3(), wi.as_vec3())) * 4.0 * cosine
}

/// With G1 for masking and nothing shadowed, no light is lost: the density integrates to 1 over all facets. It is no more
/// than that over the directions above the surface.
#[test]
fn the_density_is_that_of_the_weak_white_furnace() {
    for (lobe, wo, name) in lobes() {
        let alpha = f64::from(lobe.alpha);
        let all: f64 = integrals(alpha, |normal| density_of_facet(&lobe, wo, normal)).iter().sum();
        // f32's rounding of directions turns facets by up to 1e-7 / alpha of their spread
        assert!((all - 1.0).abs() < 2e-3, "{name}: {all}");
        let above = |normal: DVec3| if (normal * 2.0 * wo.dot(normal) - wo).z > 0.0 { 1.0 } else { 0.0 };
        let above = |normal| above(normal) * density_of_facet(&lobe, wo, normal);
        let part: f64 = integrals(alpha, above).iter().sum();
        assert!(part <= all + 1e-9 && part > 0.4, "{name}: {part}");
    }
}

/// Chi-square of 100 000 samples over 200 cells; 4 standard deviations are passed by chance once in 30 000 tests.
#[test]
fn directions_follow_their_density() {
    const SAMPLES: u32 = 100_000;
    for (lobe, wo, name) in lobes() {
        let alpha = f64::from(lobe.alpha);
        let expected = integrals(alpha, |normal| density_of_facet(&lobe, wo, normal));
        let mut counts = vec![0.0; expected.len()];
        for item in 0..SAMPLES {
            let (wi, _, pdf) = lobe.sample(wo.as_vec3(), random(item));
            let told = f64::from(lobe.pdf(wo.as_vec3(), wi));
            // what rounding turns the facet between both by, in widths of the distribution
            let turned = 3e-6 / (alpha * wo.z);
            assert!((f64::from(pdf) / told - 1.0).abs() < 1e-5 + turned, "{name}: {pdf} {told}");
            let [v, turn] = place(alpha, (wo + wi.as_dvec3()).normalize());
            let bin = |value: f64, bins: usize| ((value * bins as f64) as usize).min(bins - 1);
            counts[bin(v, ROWS) * COLUMNS + bin(turn, COLUMNS)] += 1.0;
        }
        let (mut chi2, mut bins, mut few) = (0.0, 0.0, (0.0, 0.0));
        for (count, probability) in counts.iter().zip(&expected) {
            let expected = probability * f64::from(SAMPLES);
            if expected < 5.0 {
                few = (few.0 + count, few.1 + expected);
            } else {
                chi2 += (count - expected).powi(2) / expected;
                bins += 1.0;
            }
        }
        let (k, spread) = (bins - 1.0, 2.0 / (9.0 * (bins - 1.0)));
        let deviation = ((chi2 / k).cbrt() - (1.0 - spread)) / spread.sqrt();
        assert!(deviation < 4.0, "{name}: {deviation} standard deviations");
        assert!((few.0 - few.1).abs() <= 5.0 * few.1.sqrt() + 1.0, "{name}: {few:?} in rare cells");
    }
}

#[test]
fn the_weight_of_a_sample_is_value_times_cosine_over_density_and_none_gains_light() {
    for (lobe, wo, name) in lobes() {
        for item in 0..2000 {
            let (wi, weight, pdf) = lobe.sample(wo.as_vec3(), random(item));
            assert!(weight.max_element() <= 1.0 + 1e-6 && weight.min_element() >= 0.0 && pdf > 0.0, "{name}");
            if wi.z > 1e-3 {
                // by the density of the same facet: that of the rounded direction cancels
                let expected = lobe.eval(wo.as_vec3(), wi).x * wi.z / lobe.pdf(wo.as_vec3(), wi);
                assert!((weight.x - expected).abs() <= 1e-4 * expected, "{name}: {} {expected}", weight.x);
            }
        }
    }
}

#[test]
fn light_takes_the_same_way_back() {
    for (lobe, wo, name) in lobes() {
        for item in 0..2000 {
            let (wi, ..) = lobe.sample(wo.as_vec3(), random(item));
            if wi.z > 0.0 {
                let (there, back) = (lobe.eval(wo.as_vec3(), wi).x, lobe.eval(wi, wo.as_vec3()).x);
                assert!((there - back).abs() <= 1e-5 * there, "{name}: {there} {back}");
            }
        }
    }
}

/// Single scattering of a white metal by the textbook's equations, around tan^2.
fn albedo(alpha: f64, wo: DVec3) -> f64 {
    let lambda = |w: DVec3| {
        let tan2 = (1.0 / w.z.min(1.0).powi(2) - 1.0).max(0.0);
        0.5 * ((1.0 + alpha * alpha * tan2).sqrt() - 1.0)
    };
    let density = |normal: DVec3| {
        let cosine = wo.dot(normal);
        let wi = normal * (2.0 * cosine) - wo;
        if cosine <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let tan2 = (normal.x * normal.x + normal.y * normal.y) / (normal.z * normal.z);
        let d = 1.0 / (0.5 * TAU * alpha.powi(2) * normal.z.powi(4) * (1.0 + tan2 / alpha.powi(2)).powi(2));
        let g2 = 1.0 / (1.0 + lambda(wo) + lambda(wi));
        // f cos, times the Jacobian 4 cos of the reflection
        d * g2 / (4.0 * wo.z * wi.z) * wi.z * 4.0 * cosine
    };
    integrals(alpha, density).iter().sum()
}

/// The mean weight of samples is the albedo. At alpha 1 and normal incidence it is 1 - ln 2, about .307.
#[test]
fn what_is_reflected_agrees_with_quadrature() {
    assert!((albedo(1.0, DVec3::Z) - (1.0 - LN_2)).abs() < 1e-4);
    for (lobe, wo, name) in lobes() {
        const SAMPLES: u32 = 100_000;
        let sum: f64 = (0..SAMPLES).map(|item| f64::from(lobe.sample(wo.as_vec3(), random(item)).1.x)).sum();
        let (found, expected) = (sum / f64::from(SAMPLES), albedo(f64::from(lobe.alpha), wo));
        // weights lie in [0, 1]: four standard errors are at most this
        let tolerance = 4.0 * (expected * (1.0 - expected) / f64::from(SAMPLES)).sqrt() + 5e-4;
        assert!((found - expected).abs() < tolerance, "{name}: {found} {expected}");
    }
}

/// Fresnel's equations for a complex index, root and quotients of complex numbers spelled out.
fn fresnel(cosine: f64, eta: f64, k: f64) -> f64 {
    let multiply = |(a, b): (f64, f64), (c, d): (f64, f64)| (a * c - b * d, a * d + b * c);
    let norm = |(a, b): (f64, f64)| a * a + b * b;
    let n = (eta, k);
    let n2 = multiply(n, n);
    // n^2 cos_t is n times the root of n^2 - sin^2
    let (re, im) = (n2.0 - (1.0 - cosine * cosine), n2.1);
    let size = re.hypot(im);
    let root = (((size + re) * 0.5).sqrt(), ((size - re) * 0.5).sqrt());
    let s = norm((cosine - root.0, -root.1)) / norm((cosine + root.0, root.1));
    let (inside, outside) = ((n2.0 * cosine, n2.1 * cosine), root);
    let p = norm((inside.0 - outside.0, inside.1 - outside.1)) / norm((inside.0 + outside.0, inside.1 + outside.1));
    0.5 * (s + p)
}

#[test]
fn metals_reflect_by_fresnels_equations() {
    let odd = Conductor::Fresnel { eta: Vec3::new(0.05, 1.5, 20.0), k: Vec3::new(10.0, 0.0, 50.0) };
    let metals = Conductor::names().map(|name| Conductor::named(name).expect("a metal")).chain([odd]);
    for conductor in metals {
        let Conductor::Fresnel { eta, k } = conductor else { panic!("{conductor:?}") };
        let metal = RoughConductor { alpha: 0.1, conductor };
        for step in 0..=1000 {
            let cosine = (f64::from(step) / 1000.0 * FRAC_PI_2).cos().max(0.0) as f32;
            let found = metal.fresnel(cosine);
            for channel in 0..3 {
                let expected = fresnel(f64::from(cosine), f64::from(eta[channel]), f64::from(k[channel]));
                let off = (f64::from(found[channel]) - expected).abs();
                assert!(off < 3e-6, "{conductor:?} at {cosine}, channel {channel}: {expected} {off}");
            }
        }
        let straight = metal.fresnel(1.0) - conductor.at_normal_incidence();
        assert!(straight.abs().max_element() < 1e-6, "{conductor:?}");
    }
}
