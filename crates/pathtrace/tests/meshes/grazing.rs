//! What a normal map makes of a surface that is seen at grazing angles: of a matt one Lambert's integral over what lies above
//! both the shading normal and the surface, wherever it is seen from, and under a coat no other.

use super::subjects::{grey, parse, plain, render, sheet, with_mesh};
use pathtrace::bsdf::MetallicRoughness;
use pathtrace::{
    DirectLight, Estimator, Integrator, LightTracingSettings, MetropolisSettings, PathSettings, PhotonSettings,
    WhittedSettings,
};
use scene::glam::DVec3;
use scene::{NormalMap, Scene, Vec3};
use std::f64::consts::PI;

const ALBEDO: f64 = 0.8;
const MATT: &str = "diffuse = { albedo = [0.8, 0.8, 0.8] }";
const SUN: &str = "[sun]\ntowards = [-2, 1, 2]\nangular_radius = 0\nirradiance = [3.1415927, 3.1415927, 3.1415927]\n[fake]\nambient = 0";
const SKY: &str = "[sky]\nradiance = [1, 1, 1]";

/// Away from the eye, across, and towards it.
const LEANING: [Vec3; 4] =
    [Vec3::new(-0.6, 0.0, 0.8), Vec3::new(-0.48, 0.64, 0.6), Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.6, 0.8)];

/// Over a distance of 10.
const HEIGHTS: [f32; 3] = [0.8, 2.5, 8.0];

/// A square of side 2 in z = 0 that fills a small picture, shaded by one normal.
fn square(height: f32, normal: Vec3, light: &str, material: &str) -> Scene {
    let scene = parse(&format!(
        "[camera]\neye = [10, 0, {height}]\ntarget = [0, 0, 0]\nup = [0, 0, 1]\nfov_y = 0.4\n{light}\n\
         [material.square]\n{material}\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"square\"\n"
    ));
    let mut scene = with_mesh(scene, 0, sheet(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0, 1));
    let image = plain((0.5 + 0.5 * normal).extend(1.0));
    scene.materials[0].surface.normal_map = Some(NormalMap { image, scale: 1.0 });
    scene
}

/// The cosine that light from `wi` is shaded by: none below the surface, and less where its own terminator is near (Chiang, Li
/// and Burley 2019).
fn cosine(normal: DVec3, wi: DVec3) -> f64 {
    let cosine = normal.dot(wi);
    if cosine <= 0.0 || wi.z <= 0.0 {
        return 0.0;
    }
    let ratio = (wi.z / (cosine * normal.z)).min(1.0);
    cosine * (ratio + ratio.powi(2) - ratio.powi(3))
}

/// The integral over directions above the surface.
fn over_the_sky(of: impl Fn(DVec3) -> f64) -> f64 {
    let (rows, columns) = (400, 800);
    let mut sum = 0.0;
    for row in 0..rows {
        let z = (f64::from(row) + 0.5) / f64::from(rows);
        for column in 0..columns {
            let turn = (f64::from(column) + 0.5) / f64::from(columns) * 2.0 * PI;
            let sine = (1.0 - z * z).sqrt();
            sum += of(DVec3::new(sine * turn.cos(), sine * turn.sin(), z));
        }
    }
    sum * 2.0 * PI / f64::from(rows * columns)
}

fn sun_direction() -> DVec3 {
    DVec3::new(-2.0, 1.0, 2.0).normalize()
}

/// By every technique that lights matt surfaces of meshes.
fn under_the_sun() -> Vec<(&'static str, Integrator, f64)> {
    let photons = |direct| PhotonSettings { direct, photons: 1 << 16, radius: Some(0.1), ..PhotonSettings::default() };
    vec![
        ("path", PathSettings { estimator: Estimator::MIS, ..PathSettings::default() }.into(), 1e-3),
        ("whitted", WhittedSettings::default().into(), 1e-3),
        ("metropolis", MetropolisSettings::default().into(), 0.02),
        ("photon map", photons(DirectLight::Photons).into(), 0.03),
        ("light tracing", LightTracingSettings { photons: 1 << 17, ..LightTracingSettings::default() }.into(), 0.03),
    ]
}

#[test]
fn matt_squares_are_shaded_by_their_normal_map_from_wherever_they_are_seen() {
    for (height, normal) in HEIGHTS.into_iter().flat_map(|height| LEANING.map(|normal| (height, normal))) {
        let scene = square(height, normal, SUN, MATT);
        let expected = ALBEDO * cosine(normal.as_dvec3().normalize(), sun_direction());
        for (name, integrator, tolerance) in under_the_sun() {
            let found = grey(&render(&scene, (4, 4), 4, integrator));
            println!("{name} {height} {normal}: {found} {expected}, {:+.1} %", (found / expected - 1.0) * 100.0);
            assert!((found / expected - 1.0).abs() < tolerance, "{name} {height} {normal}: {found}, not {expected}");
        }
    }
}

#[test]
fn matt_squares_under_a_sky_send_back_lamberts_integral() {
    for (height, normal) in HEIGHTS.into_iter().flat_map(|height| LEANING.map(|normal| (height, normal))) {
        let scene = square(height, normal, SKY, MATT);
        let normal = normal.as_dvec3().normalize();
        let expected = ALBEDO / PI * over_the_sky(|wi| cosine(normal, wi));
        for estimator in [Estimator::COSINE, Estimator::UNIFORM, Estimator::MIS] {
            let settings = PathSettings { estimator, ..PathSettings::default() };
            let film = render(&scene, (16, 16), 64, settings);
            let (found, error) = (grey(&film), film.standard_error()[0]);
            println!("{estimator:?} {height} {normal}: {found} +- {error}, {expected}");
            assert!((found - expected).abs() < 2e-3 + 4.0 * error, "{height} {normal}: {found}, not {expected}");
        }
    }
}

/// The first normal on the way from `n` to the square's own, z, that mirrors `wo` to a hundredth above the square.
fn bent(n: DVec3, wo: DVec3) -> DVec3 {
    let sideways = DVec3::new(n.x, n.y, 0.0).normalize();
    let at = |angle: f64| sideways * angle.sin() + DVec3::Z * angle.cos();
    let valid = |angle: f64| (2.0 * at(angle).dot(wo) * at(angle) - wo).z >= 0.01;
    let (mut inside, mut outside) = (0.0, n.z.acos());
    if valid(outside) {
        return n;
    }
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        *(if valid(middle) { &mut inside } else { &mut outside }) = middle;
    }
    at(inside)
}

const COATED: &str = "metallic_roughness = { base_colour = [0.8, 0.8, 0.8], metallic = 0, roughness = 0.5 }";

/// BSDF times cosine of the coated square: a body shaded by `normal` under facets shaded by what it is bent to. The body's
/// part is what is left when that of a black one is taken away.
fn coated(normal: DVec3, wo: DVec3, wi: DVec3) -> f64 {
    let mirroring = bent(normal, wo);
    let (x, y) = mirroring.any_orthonormal_pair();
    let local = |w: DVec3| DVec3::new(x.dot(w), y.dot(w), mirroring.dot(w)).as_vec3();
    let of = |colour: f32| {
        let lobe = MetallicRoughness { base_colour: Vec3::splat(colour), metallic: 0.0, roughness: 0.5, ior: 1.5 };
        f64::from(lobe.eval(local(wo), local(wi)).x)
    };
    // the bent normal lies between both others: what is above those is above it
    if mirroring.dot(wi) <= 0.0 {
        return 0.0;
    }
    of(0.0) * cosine(mirroring, wi) + (of(0.8) - of(0.0)) * cosine(normal, wi)
}

/// Of a coated square's two parts each is shaded by its own normal, and values, samples and densities go together.
#[test]
fn under_a_coat_the_body_keeps_its_normal() {
    let wide = "[sun]\ntowards = [-2, 1, 2]\nangular_radius = 25\nirradiance = [3, 3, 3]\n[fake]\nambient = 0";
    for (height, normal) in HEIGHTS.into_iter().flat_map(|height| LEANING.map(|normal| (height, normal))) {
        let exact = normal.as_dvec3().normalize();
        let wo = DVec3::new(10.0, 0.0, f64::from(height)).normalize();
        let path = |light: &str, estimator| {
            let settings = PathSettings { estimator, ..PathSettings::default() };
            let film = render(&square(height, normal, light, COATED), (16, 16), 256, settings);
            (grey(&film), film.standard_error()[0])
        };
        let (found, _) = path(SUN, Estimator::LIGHT);
        let expected = PI * coated(exact, wo, sun_direction());
        println!("sun {height} {normal}: {found} {expected}");
        assert!((found / expected - 1.0).abs() < 5e-3, "{height} {normal}: {found}, not {expected}");
        let expected = over_the_sky(|wi| coated(exact, wo, wi));
        for estimator in [Estimator::COSINE, Estimator::UNIFORM] {
            let (found, error) = path(SKY, estimator);
            println!("{estimator:?} {height} {normal}: {found} +- {error}, {expected}");
            assert!((found - expected).abs() < 3e-3 + 4.0 * error, "{height} {normal}: {found}, not {expected}");
        }
        let (expected, by_light) = path(wide, Estimator::LIGHT);
        for estimator in [Estimator::MIS, Estimator::COSINE] {
            let (found, error) = path(wide, estimator);
            println!("wide sun, {estimator:?} {height} {normal}: {found} +- {error}, {expected}");
            let tolerance = 2e-3 + 4.0 * error.hypot(by_light);
            assert!((found - expected).abs() < tolerance, "{height} {normal}: {found}, not {expected}");
        }
    }
}

/// Nothing is bent here, neither as the eye sees it nor as the sun does.
#[test]
fn photons_leave_coated_squares_as_paths_find_them() {
    for height in HEIGHTS {
        let scene = square(height, Vec3::new(0.0, 0.6, 0.8), SUN, COATED);
        let expected = grey(&render(&scene, (4, 4), 16, PathSettings::default()));
        let settings = LightTracingSettings { photons: 1 << 17, ..LightTracingSettings::default() };
        let found = grey(&render(&scene, (4, 4), 16, settings));
        println!("{height}: {found} {expected}");
        assert!((found / expected - 1.0).abs() < 0.03, "{height}: {found}, not {expected}");
    }
}
