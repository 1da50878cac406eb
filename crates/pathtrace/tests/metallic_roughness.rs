//! glTF's metallic-roughness lobe against its own density, against quadrature in f64, and against appendix B of the
//! glTF 2.0 specification, written once more from its text.

mod facets;

use facets::{at, facet, place};
use pathtrace::bsdf::{MetallicRoughness, RoughConductor};
use pathtrace::sampling::sampler::Sampler;
use scene::glam::DVec3;
use scene::{Conductor, Vec3};
use std::f64::consts::{FRAC_1_PI, TAU};

const ROUGHNESSES: [f32; 6] = [0.0, 0.1, 0.3, 0.5, 0.75, 1.0];
const DEGREES: [f64; 4] = [0.0, 30.0, 60.0, 85.0];
const GOLD: Vec3 = Vec3::new(1.0, 0.77, 0.31);

fn surface(base_colour: Vec3, metallic: f32, roughness: f32) -> MetallicRoughness {
    MetallicRoughness { base_colour, metallic, roughness, ior: 1.5 }
}

/// Plastic, black and white, metal, and a mix, under every angle.
fn lobes() -> impl Iterator<Item = (MetallicRoughness, DVec3, String)> {
    let kinds = [(GOLD, 0.0), (Vec3::ZERO, 0.0), (Vec3::ONE, 0.0), (GOLD, 0.6), (GOLD, 1.0)];
    let one = |(base, metallic), roughness, degrees| {
        let name = format!("{base} {metallic}, roughness {roughness}, {degrees} degrees");
        (surface(base, metallic, roughness), at(degrees), name)
    };
    let under = move |kind, roughness| DEGREES.into_iter().map(move |degrees| one(kind, roughness, degrees));
    kinds.into_iter().flat_map(move |kind| ROUGHNESSES.into_iter().flat_map(move |roughness| under(kind, roughness)))
}

fn random(item: u32) -> [f32; 3] {
    let [u, v, w, _] = Sampler::independent(5, item, 1).unit4(0);
    [u, v, w]
}

fn alpha(lobe: &MetallicRoughness) -> f64 {
    f64::from(lobe.roughness).max(0.01).powi(2)
}

/// Cells by the square of the sine, by the turn, and one for all below the surface. No mirror direction of [`DEGREES`]
/// lies where rows meet.
const RINGS: usize = 7;
const TURNS: usize = 20;
const CELLS: usize = RINGS * TURNS + 1;

fn cell(wi: DVec3) -> usize {
    if wi.z <= 0.0 {
        return CELLS - 1;
    }
    let bin = |value: f64, bins: usize| ((value * bins as f64) as usize).min(bins - 1);
    let turn = (wi.y.atan2(wi.x) / TAU).rem_euclid(1.0);
    bin(wi.x * wi.x + wi.y * wi.y, RINGS) * TURNS + bin(turn, TURNS)
}

/// The integral of `f` over the directions of each cell. Half of the points follow facets, half the cosine, each weighted by
/// the density of both: whatever the roughness, one of them is smooth where the other is not.
fn integrals(alpha: f64, wo: DVec3, f: impl Fn(DVec3) -> f64) -> Vec<f64> {
    const STEPS: usize = 16;
    let (rows, columns) = (RINGS * STEPS, TURNS * STEPS);
    let mut cells = vec![0.0; CELLS];
    let mut add = |wi: DVec3| {
        let half = (wo + wi).normalize();
        let by_cosine = wi.z.max(0.0) * FRAC_1_PI;
        let by_facet = 1.0 / (facet(alpha, place(alpha, half)[0], 0.0).1 * 4.0 * wo.dot(half));
        cells[cell(wi)] += f(wi) / (by_cosine + by_facet) / (rows * columns) as f64;
    };
    for index in 0..rows * columns {
        let v = ((index / columns) as f64 + 0.5) / rows as f64;
        let turn = ((index % columns) as f64 + 0.5) / columns as f64;
        let (normal, _) = facet(alpha, v, turn);
        if wo.dot(normal) > 0.0 {
            add(normal * (2.0 * wo.dot(normal)) - wo);
        }
        let (sin, cos) = (TAU * turn).sin_cos();
        add(DVec3::new(v.sqrt() * cos, v.sqrt() * sin, (1.0 - v).sqrt()));
    }
    cells
}

fn pdf(lobe: &MetallicRoughness, wo: DVec3, wi: DVec3) -> f64 {
    f64::from(lobe.pdf(wo.as_vec3(), wi.as_vec3()))
}

/// The density of directions above the surface, and of those that facets send below it, which belong to no body.
fn density(lobe: &MetallicRoughness, wo: DVec3, wi: DVec3) -> f64 {
    if wi.z > 0.0 {
        return pdf(lobe, wo, wi);
    }
    // the cosine's share is negative there in what `pdf` says, which is asked above the surface alone
    let mirrored = DVec3::new(wi.x, wi.y, 0.0).normalize();
    let metal = RoughConductor { alpha: alpha(lobe) as f32, conductor: Conductor::Constant(Vec3::ONE) };
    let facets = |wi: DVec3| f64::from(metal.pdf(wo.as_vec3(), wi.as_vec3()));
    facets(wi) * pdf(lobe, wo, mirrored) / facets(mirrored)
}

/// Chi-square of 100 000 samples over 140 cells and one; 4 standard deviations are passed by chance once in 30 000 tests.
#[test]
fn directions_follow_their_density() {
    const SAMPLES: u32 = 100_000;
    for (lobe, wo, name) in lobes() {
        let expected = integrals(alpha(&lobe), wo, |wi| density(&lobe, wo, wi));
        let all: f64 = expected.iter().sum();
        assert!((all - 1.0).abs() < 3e-3, "{name}: the density's integral is {all}");
        let mut counts = vec![0.0; CELLS];
        for item in 0..SAMPLES {
            let (wi, _, pdf) = lobe.sample(wo.as_vec3(), random(item));
            // what rounding turns the facet between both by, in widths of the distribution
            let turned = 3e-6 / (alpha(&lobe) * wo.z);
            if wi.z > 0.0 {
                let told = f64::from(lobe.pdf(wo.as_vec3(), wi));
                assert!((f64::from(pdf) / told - 1.0).abs() < 1e-5 + turned, "{name}: {pdf} {told}");
            }
            counts[cell(wi.as_dvec3())] += 1.0;
        }
        let (mut chi2, mut bins, mut few) = (0.0, 0.0, (0.0, 0.0));
        for (count, probability) in counts.iter().zip(&expected) {
            let expected = probability * f64::from(SAMPLES);
            if expected < 20.0 {
                few = (few.0 + count, few.1 + expected);
            } else {
                chi2 += (count - expected).powi(2) / expected;
                bins += 1.0;
            }
        }
        let (k, spread) = (bins - 1.0, 2.0 / (9.0 * (bins - 1.0)));
        let deviation = ((chi2 / k).cbrt() - (1.0 - spread)) / spread.sqrt();
        assert!(deviation < 4.0, "{name}: {deviation} standard deviations over {bins} cells");
        assert!((few.0 - few.1).abs() <= 5.0 * few.1.sqrt() + 1.0, "{name}: {few:?} in rare cells");
    }
}

#[test]
fn the_weight_of_a_sample_is_value_times_cosine_over_density_and_at_most_eight() {
    let mut heaviest = 0f32;
    for (lobe, wo, name) in lobes() {
        for item in 0..2000 {
            let (wi, weight, pdf) = lobe.sample(wo.as_vec3(), random(item));
            heaviest = heaviest.max(weight.max_element());
            assert!(weight.max_element() <= 8.0 && weight.min_element() >= 0.0 && pdf > 0.0, "{name}: {weight}");
            assert!(wi.z > 0.0 || weight == Vec3::ZERO, "{name}: light from below");
            if wi.z > 1e-3 {
                let expected = lobe.eval(wo.as_vec3(), wi) * wi.z / lobe.pdf(wo.as_vec3(), wi);
                // the rounded direction's facet is in both, but in the sum with the body's part it does not cancel
                let tolerance = 1e-4 + 3e-6 / (alpha(&lobe) * wo.z) as f32 * f32::from(lobe.metallic < 1.0);
                let off = (weight - expected).abs().max_element();
                assert!(off <= tolerance * expected.max_element().max(0.1), "{name}: {weight} {expected}");
            }
        }
    }
    assert!(heaviest < 3.0, "what is seen here is far from the bound: {heaviest}");
}

#[test]
fn light_takes_the_same_way_back() {
    for (lobe, wo, name) in lobes() {
        for item in 0..2000 {
            let (wi, ..) = lobe.sample(wo.as_vec3(), random(item));
            if wi.z > 0.0 {
                let (there, back) = (lobe.eval(wo.as_vec3(), wi), lobe.eval(wi, wo.as_vec3()));
                assert!((there - back).abs().max_element() <= 2e-5 * there.max_element(), "{name}: {there} {back}");
            }
        }
    }
}

/// `mix(dielectric_brdf, metal_brdf, metallic)` of appendix B, term by term: D in B.3.2, V from G of height-correlated Smith
/// masking, F of Schlick. With `layered`, the body gets no more than the coat leaves.
fn specified(lobe: &MetallicRoughness, wo: DVec3, wi: DVec3, layered: bool) -> DVec3 {
    let (base, metallic, a) = (lobe.base_colour.as_dvec3(), f64::from(lobe.metallic), alpha(lobe));
    let half = (wo + wi).normalize();
    let tan2 = (half.x * half.x + half.y * half.y) / (half.z * half.z);
    let d = FRAC_1_PI / (a * a * half.z.powi(4) * (1.0 + tan2 / (a * a)).powi(2));
    let tan2 = |w: DVec3| (w.x * w.x + w.y * w.y) / (w.z * w.z);
    let lambda = |w: DVec3| 0.5 * ((1.0 + a * a * tan2(w)).sqrt() - 1.0);
    let specular = d / ((1.0 + lambda(wo) + lambda(wi)) * 4.0 * wo.z * wi.z);
    let schlick = |cosine: f64| (1.0 - cosine.abs()).powi(5);
    let f0 = ((1.0 - f64::from(lobe.ior)) / (1.0 + f64::from(lobe.ior))).powi(2);
    let rest = schlick(wo.dot(half));
    let metal = (base + (1.0 - base) * rest) * specular;
    let fresnel = f0 + (1.0 - f0) * rest;
    let at_grazing = f0 + (1.0 - f0) / (1.0 + 12.0 * a.powf(1.5)) * schlick(wo.z.min(wi.z));
    let kept = if layered { 1.0 - fresnel.max(f0 + (at_grazing - f0)) } else { 1.0 - fresnel };
    let dielectric = base * FRAC_1_PI * kept + fresnel * specular;
    dielectric * (1.0 - metallic) + metal * metallic
}

#[test]
fn the_value_is_the_specifications_but_where_the_coat_leaves_less() {
    for (lobe, wo, name) in lobes() {
        for item in 0..2000 {
            let (wi, ..) = lobe.sample(wo.as_vec3(), random(item));
            if wi.z < 1e-3 {
                continue;
            }
            let (found, wi) = (lobe.eval(wo.as_vec3(), wi).as_dvec3(), wi.as_dvec3());
            let (ours, theirs) = (specified(&lobe, wo, wi, true), specified(&lobe, wo, wi, false));
            // what f32 turns facets by, in widths of the distribution
            let tolerance = 1e-4 + 3e-6 / (alpha(&lobe) * wo.z);
            assert!((found - ours).abs().max_element() <= tolerance * ours.max_element(), "{name}: {found} {ours}");
            assert!(found.max_element() <= theirs.max_element() * (1.0 + tolerance), "{name}: {found} {theirs}");
            if wo.z.min(wi.z) > 0.8 {
                let near = 5e-4 + tolerance * theirs.max_element();
                assert!((found - theirs).abs().max_element() <= near, "{name}: {found} {theirs}");
            }
        }
    }
}

fn albedo(lobe: &MetallicRoughness, wo: DVec3, layered: bool) -> f64 {
    let reflected = |wi: DVec3| if wi.z > 0.0 { specified(lobe, wo, wi, layered).x * wi.z } else { 0.0 };
    integrals(alpha(lobe), wo, reflected).iter().sum()
}

/// The mean weight of samples is the albedo.
#[test]
fn what_is_reflected_agrees_with_quadrature() {
    for (lobe, wo, name) in lobes() {
        const SAMPLES: u32 = 50_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for item in 0..SAMPLES {
            let weight = f64::from(lobe.sample(wo.as_vec3(), random(item)).1.x);
            (sum, squares) = (sum + weight, squares + weight * weight);
        }
        let n = f64::from(SAMPLES);
        let (found, expected) = (sum / n, albedo(&lobe, wo, true));
        let error = ((squares / n - found * found).max(0.0) / n).sqrt();
        // of the quadrature over a narrow lobe
        assert!((found - expected).abs() < 4.0 * error + 2e-3, "{name}: {found} {expected}");
    }
}

/// White paint under its coat sends back no more light than falls on it, for which [`specified`] without layers sends back
/// up to 1.7 times as much: the coat's albedo is fitted, and may be half a hundredth too small.
#[test]
fn no_surface_gains_light() {
    let under = |cosine: f64| DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    for ior in [1.0, 1.5, 2.4] {
        for roughness in [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0] {
            for cosine in [0.02, 0.1, 0.2, 0.3, 0.4, 0.6, 1.0] {
                let lobe = MetallicRoughness { ior, ..surface(Vec3::ONE, 0.0, roughness) };
                let reflected = albedo(&lobe, under(cosine), true);
                assert!(reflected < 1.005, "index {ior}, roughness {roughness}, cosine {cosine}: {reflected}");
            }
        }
    }
    let of_specification = albedo(&surface(Vec3::ONE, 0.0, 0.1), under(0.02), false);
    assert!(of_specification > 1.6, "{of_specification}");
}

/// All metal is rough metal of that reflectance straight on, and reflects more at other angles, by Schlick's approximation.
#[test]
fn metal_is_a_rough_conductor_under_schlicks_fresnel() {
    for (lobe, wo, name) in lobes().filter(|(lobe, ..)| lobe.metallic == 1.0) {
        let metal = RoughConductor { alpha: alpha(&lobe) as f32, conductor: Conductor::Constant(Vec3::ONE) };
        for item in 0..500 {
            let u = random(item);
            let (wi, weight, pdf) = lobe.sample(wo.as_vec3(), u);
            let (of_metal, passes, same) = metal.sample(wo.as_vec3(), [u[0], u[1]]);
            assert!(wi == of_metal && (pdf - same).abs() <= 1e-6 * pdf, "{name}: {wi} {of_metal} {pdf} {same}");
            let rest = (1.0 - wo.as_vec3().dot((wo.as_vec3() + wi).normalize())).powi(5);
            let expected = (GOLD + (1.0 - GOLD) * rest) * passes;
            assert!((weight - expected).abs().max_element() < 1e-4, "{name}: {weight} {expected}");
        }
    }
}

#[test]
fn roughness_0_is_all_but_a_mirror_and_no_number_is_lost() {
    let wo = at(60.0).as_vec3();
    let (smooth, nearly) = (surface(GOLD, 0.5, 0.0), surface(GOLD, 0.5, 0.01));
    for item in 0..2000 {
        let (wi, weight, pdf) = smooth.sample(wo, random(item));
        assert!(weight.is_finite() && pdf.is_finite() && wi.is_finite(), "{wi} {weight} {pdf}");
        assert_eq!((wi, weight, pdf), nearly.sample(wo, random(item)));
        assert!(smooth.eval(wo, wi).is_finite() || wi.z <= 0.0);
    }
}
