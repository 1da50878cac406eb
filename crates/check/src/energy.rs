//! Closed scenes that keep all their light.

use crate::hard::{known, spot, with_geometry};
use crate::measure::{Trial, adding, farthest};
use pathtrace::{Estimator, PathSettings, Roulette, Tracer, WhittedSettings};
use scene::{Bsdf, Camera, Conductor, Geometry, MetallicRoughness, Scene, Shape, Texture, Vec3};
use std::f32::consts::PI;
use std::f64;
use std::f64::consts::LN_2;

/// Independent samples of paths.
pub fn with(estimator: Estimator, bounces: Option<u32>, roulette: Roulette) -> PathSettings {
    PathSettings { estimator, bounces, roulette, ..PathSettings::independent() }
}

/// Light that paths have lost at the middle of the floor when they stop after so many scatterings: a random walk in
/// f64, known to .001.
pub const LOST: [(u32, f64); 5] = [(1, 0.759), (2, 0.621), (4, 0.408), (8, 0.185), (16, 0.038)];

/// What sees nothing but the middle of the floor.
pub fn floor_centre() -> Camera {
    spot(Vec3::new(0.5, 0.5, 0.5), Vec3::new(0.5, 0.5, 0.0))
}

/// Of a sphere of rough white metal, alpha 1, under a sky of 1, what single scattering reflects straight back.
pub const ROUGH_METAL: f64 = 1.0 - LN_2;

/// That sphere, seen in its middle.
pub fn rough_metal() -> Scene {
    let mut scene = known("white-furnace");
    let conductor = Conductor::Constant(Vec3::ONE);
    scene.materials[0].bsdf = Bsdf::RoughConductor { conductor, roughness: 1.0 };
    scene.shapes = [Shape { geometry: Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 }, material: 0 }].into();
    scene.camera = spot(Vec3::new(0.0, 0.0, 3.0), Vec3::new(0.0, 0.0, 1.0));
    scene
}

/// Of a sphere of white matter under a glossy coat, of glTF's material, what is reflected straight back under a sky of 1: by
/// the angle of the light, in the middle of which the facet lies. [`coated`] has alpha 1/4.
pub fn of_coated() -> f64 {
    const STEPS: usize = 10_000;
    let (alpha2, width, pi) = (1.0 / 16.0, f64::consts::FRAC_PI_2 / STEPS as f64, f64::consts::PI);
    let schlick = |cosine: f64, most: f64| 0.04 + (most - 0.04) * (1.0 - cosine).powi(5);
    let ring = |step: usize| {
        let angle = (step as f64 + 0.5) * width;
        let ((sin, cos), half) = (angle.sin_cos(), (0.5 * angle).cos());
        let d = alpha2 / (pi * (half * half * (alpha2 - 1.0) + 1.0).powi(2));
        let v = 0.5 / (cos + (alpha2 + (1.0 - alpha2) * cos * cos).sqrt());
        // what the coat takes at least: 12 times the cube of the roughness in it
        let coat = schlick(half, 1.0).max(schlick(cos, 0.04 + 0.96 / (1.0 + 12.0 * 0.125)));
        2.0 * pi * sin * cos * (d * v * schlick(half, 1.0) + (1.0 - coat) / pi) * width
    };
    (0..STEPS).map(ring).sum()
}

/// That sphere, seen in its middle.
pub fn coated() -> Scene {
    let base_colour = Texture::Constant(Vec3::ONE);
    let model = MetallicRoughness { base_colour, metallic: 0.0, roughness: 0.5, metallic_roughness: None, ior: 1.5 };
    let mut scene = rough_metal();
    scene.materials[0].bsdf = Bsdf::MetallicRoughness(model);
    scene
}

pub fn white_furnace(trial: &mut Trial) {
    let coated = coated();
    for estimator in [Estimator::UNIFORM, Estimator::COSINE, Estimator::MIS] {
        let seen = (&Tracer::new(&coated), &coated.camera);
        trial.traced("metallic-roughness, alpha 1/4", of_coated(), seen, with(estimator, None, Roulette::OFF));
    }
    let metal = rough_metal();
    for estimator in [Estimator::UNIFORM, Estimator::COSINE, Estimator::MIS] {
        let seen = (&Tracer::new(&metal), &metal.camera);
        trial.traced("rough metal, alpha 1", ROUGH_METAL, seen, with(estimator, None, Roulette::OFF));
    }
    let scene = known("white-furnace");
    let seen = (&Tracer::new(&scene), &scene.camera);
    for estimator in [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS, Estimator::GUIDED] {
        let film = trial.film(seen, with(estimator, None, Roulette::THROUGHPUT), 32, 16);
        let subject = format!("path {}", estimator.name());
        trial.equal(&subject, "every pixel, no variance at all", 1.0, farthest(&film, 1.0), 1e-5);
    }
    trial.traced("mean, roulette .9", 1.0, seen, with(Estimator::COSINE, None, Roulette::constant(0.9)));
    let both = Roulette { probability: Some(0.9), throughput: true };
    trial.traced("mean, roulette .9 and throughput", 1.0, seen, with(Estimator::COSINE, None, both));
    let branching = PathSettings { branches: 3, ..with(Estimator::COSINE, Some(3), Roulette::OFF) };
    let one = with(Estimator::COSINE, Some(3), Roulette::OFF);
    let straight = trial.mean_of(1.0, 0.002, 10_000, adding(seen.0, seen.1, one));
    trial.traced("3 branches against 1, 3 bounces", straight.mean, seen, branching);
    for (scatterings, lost) in LOST {
        let settings = with(Estimator::COSINE, Some(scatterings - 1), Roulette::OFF);
        let power = trial.pick(0.001, 0.0003) / (1.0 - lost);
        let found = trial.mean_of(1.0 - lost, power, 20_000, adding(seen.0, &floor_centre(), settings));
        let quantity = format!("floor centre after {scatterings} scatterings");
        trial.equal("path cosine", &quantity, 1.0 - lost, found.mean, 0.001 + 4.0 * found.standard_error);
    }
}

/// Albedo (or reflectance) and emission of closed boxes of radiance 1.
pub const CLOSED: [(f32, f32); 3] = [(0.5, 0.5), (0.8, 0.2), (0.99, 0.01)];

/// Radiance in such a box when paths stop after so many scatterings.
pub fn after(scatterings: u32, (share, emission): (f32, f32)) -> f64 {
    let (rho, le) = (f64::from(share), f64::from(emission));
    le * (1.0 - rho.powi(scatterings as i32 + 1)) / (1.0 - rho)
}

/// The box with another albedo (or reflectance) and emission.
pub fn shining(mut scene: Scene, share: f32, emission: f32) -> Scene {
    for material in &mut scene.materials {
        material.bsdf = match material.bsdf {
            Bsdf::Mirror { .. } => Bsdf::Mirror { reflectance: Vec3::splat(share) },
            _ => Bsdf::Diffuse { albedo: Texture::Constant(Vec3::splat(share)) },
        };
        if let Some(emits) = &mut material.emission {
            emits.radiance = Vec3::splat(emission);
        }
    }
    scene
}

/// Those whose weights have a small variance between walls of this albedo: of uniform directions they have a finite one
/// only while albedo^2 4/3 < 1, and a small one well below.
pub fn estimators_of_walls(albedo: f32) -> impl Iterator<Item = Estimator> {
    let uniform = |estimator: &Estimator| estimator.directions == Estimator::UNIFORM.directions;
    Estimator::EVERY.into_iter().filter(move |estimator| albedo <= 0.5 || !uniform(estimator))
}

/// Largest relative standard error with power between walls of this albedo.
pub fn power_between_walls(trial: &Trial, albedo: f32) -> f64 {
    // a path of hundreds of vertices is dear
    if albedo > 0.9 { 0.005 } else { trial.power() }
}

pub fn closed_box(trial: &mut Trial) {
    for (share, emission) in CLOSED {
        let diffuse = shining(known("closed-box"), share, emission);
        let seen = (&Tracer::new(&diffuse), &diffuse.camera);
        for estimator in estimators_of_walls(share) {
            let roulettes = [(Roulette::THROUGHPUT, "throughput"), (Roulette::constant(0.9), "constant .9")];
            for (roulette, name) in roulettes.into_iter().take(if share > 0.5 { 1 } else { 2 }) {
                let quantity = format!("mean, albedo {share}, roulette {name}");
                let settings = with(estimator, None, roulette);
                let power = power_between_walls(trial, share);
                let subject = format!("path {}", estimator.name());
                trial.monte_carlo_to(power, &subject, &quantity, 1.0, adding(seen.0, seen.1, settings));
            }
        }
        let mirrors = shining(known("mirror-box"), share, emission);
        let reflected = (&Tracer::new(&mirrors), &mirrors.camera);
        let quantity = format!("mean, mirrors of {share}");
        trial.traced(&quantity, 1.0, reflected, with(Estimator::LIGHT, None, Roulette::THROUGHPUT));
        for scatterings in [1u32, 4, 8, 16, 64] {
            let expected = after(scatterings, (share, emission));
            let quantity = format!("every pixel, {share}, {scatterings} scatterings");
            let settings = with(Estimator::COSINE, Some(scatterings - 1), Roulette::OFF);
            let film = trial.film(seen, settings, 8, 4);
            trial.equal("path cosine", &quantity, expected, farthest(&film, expected), 1e-5);
            let settings = WhittedSettings { depth: scatterings, ambient: Some(0.0), ..WhittedSettings::default() };
            let film = trial.film(reflected, settings, 8, 4);
            trial.equal("whitted", &format!("{quantity}, mirrors"), expected, farthest(&film, expected), 1e-5);
        }
    }
}

/// Radius and albedo of spheres of radiance 1, and the intensity of the light in their middle.
pub const SPHERES: [(f32, f32, f32); 3] = [(1.0, 0.5, PI), (2.0, 0.5, 4.0 * PI), (1.0, 0.9, PI / 9.0)];

/// Such a sphere.
pub fn lit_sphere((radius, albedo, intensity): (f32, f32, f32)) -> Scene {
    let mut scene = with_geometry(known("point-light-in-sphere"), |_, geometry| {
        *geometry = Geometry::Sphere { center: Vec3::ZERO, radius };
    });
    scene.materials[0].bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::splat(albedo)) };
    scene.point_lights[0].intensity = Vec3::splat(intensity);
    scene
}

/// What of its radiance has come straight from the light.
pub fn direct_part((radius, albedo, intensity): (f32, f32, f32)) -> f64 {
    f64::from(albedo * intensity / (PI * radius * radius))
}

pub fn point_light(trial: &mut Trial) {
    for sphere in SPHERES {
        let (radius, albedo, _) = sphere;
        let scene = lit_sphere(sphere);
        let seen = (&Tracer::new(&scene), &scene.camera);
        for estimator in [Estimator::LIGHT, Estimator::MIS, Estimator::UNIFORM_LIGHT] {
            let uniform = estimator == Estimator::UNIFORM_LIGHT;
            if uniform && albedo > 0.5 {
                continue;
            }
            let quantity = format!("mean, radius {radius}, albedo {albedo}");
            trial.traced(&quantity, 1.0, seen, with(estimator, None, Roulette::THROUGHPUT));
        }
        let direct = direct_part(sphere);
        let settings = WhittedSettings { ambient: Some(0.0), ..WhittedSettings::default() };
        let film = trial.film(seen, settings, 16, 4);
        let quantity = format!("every pixel, direct, radius {radius}, albedo {albedo}");
        trial.equal("whitted", &quantity, direct, farthest(&film, direct), 1e-5);
    }
}
