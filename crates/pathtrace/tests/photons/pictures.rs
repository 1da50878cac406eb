//! Pictures by photons, and what is said of them.

use film::Film;
use pathtrace::{DirectLight, Integrator, LightTracingSettings, PhotonSettings, Stats, Tracer};
use scene::Scene;
use std::path::Path;

pub fn scene(text: &str) -> Scene {
    scene::parse(text, "test", Path::new("test.toml")).expect("a scene")
}

pub fn everything() -> Scene {
    scene(include_str!("../../../../tests/tests/scenes/everything-more.toml"))
}

pub fn traced(tracer: &Tracer, scene: &Scene, side: u32, spp: u32, integrator: &Integrator) -> (Film, Stats) {
    let mut film = Film::new(side, side);
    let stats = tracer.render(&mut film, &scene.camera, integrator, spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    (film, stats)
}

pub fn render(scene: &Scene, side: u32, spp: u32, integrator: impl Into<Integrator>) -> Film {
    traced(&Tracer::new(scene), scene, side, spp, &integrator.into()).0
}

/// Both ways to find direct light.
pub fn photon_maps(photons: u32, radius: f32) -> [Integrator; 2] {
    let settings = PhotonSettings { photons, radius: Some(radius), ..PhotonSettings::default() };
    DirectLight::ALL.map(|direct| PhotonSettings { direct, ..settings }.into())
}

pub fn light_tracing(photons: u32) -> Integrator {
    LightTracingSettings { photons, ..LightTracingSettings::default() }.into()
}

/// Mean and standard error over all pixels and channels of pictures of several seeds: pixels of one share photons.
pub fn mean_of_seeds(scene: &Scene, side: u32, spp: u32, integrator: &Integrator) -> (f64, f64) {
    let tracer = Tracer::new(scene);
    let of_seed = |seed| traced(&tracer, scene, side, spp, &integrator.with_seed(seed)).0.mean();
    mean_and_error(&(1..=8).map(|seed| of_seed(seed).iter().sum::<f64>() / 3.0).collect::<Vec<_>>())
}

pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n * (n - 1.0));
    (mean, variance.sqrt())
}

/// The mean is `expected` but for a known bias and five standard errors (of eight values; rarer than one in a thousand), and these are
/// small enough to notice `power` of it.
pub fn assert_mean((mean, error): (f64, f64), expected: f64, (bias, power): (f64, f64), what: &str) {
    assert!(error <= power * expected, "{what}: a standard error of {error} proves nothing");
    let most = 5.0 * error + bias * expected + 1e-6 * expected;
    assert!((mean - expected).abs() <= most, "{what}: {mean} +- {error}, expected {expected}");
}
