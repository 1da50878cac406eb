//! Both machines count the same light paths, pixel by pixel.

mod pair;

use gpu::Gpu;
use pair::paths;
use pathtrace::{Estimator, Integrator, LightPaths, PathSettings, WhittedSettings};
use scene::{Scene, builtin};
use std::path::Path;

const EVERYTHING: &str = include_str!("scenes/everything-more.toml");
const METALS: &str = include_str!("scenes/metals.toml");

fn parsed(text: &str) -> Scene {
    scene::parse(text, "a scene", Path::new("scene.toml")).unwrap()
}

fn apart(gpu: &Gpu, scene: &Scene, integrator: Integrator) {
    let pair = paths(gpu, scene, (96, 64), 1, &integrator);
    let (apart, rays, mean) = (pair.apart(1e-3), pair.rays(), pair.cpu.mean()[1]);
    println!("{}: {apart} of the pixels apart, {rays} times the rays, mean {mean}", scene.name);
    // as for whole pictures: where rounding sends a path elsewhere
    assert!(apart <= 5e-3 && mean > 0.0, "{}, {integrator:?}: {apart}", scene.name);
    assert!((rays - 1.0).abs() < 2e-3, "{}, {integrator:?}: {rays} times the rays", scene.name);
}

#[test]
fn paths_are_counted_alike() {
    let gpu = Gpu::headless().unwrap();
    let scenes = [parsed(EVERYTHING), parsed(METALS), builtin::named("whitted").unwrap()];
    for scene in &scenes {
        for (class, estimator) in [
            ("direct", Estimator::LIGHT),
            ("indirect", Estimator::MIS),
            ("LS+DE", Estimator::LIGHT),
            ("bounce-1", Estimator::COSINE),
            ("L.*S.*E", Estimator::MIS),
        ] {
            let paths = LightPaths::parse(class).unwrap();
            apart(&gpu, scene, PathSettings { estimator, bounces: Some(3), paths, ..PathSettings::default() }.into());
        }
    }
    let paths = LightPaths::parse("L.*D[DG].?E").unwrap();
    let branching = PathSettings { branches: 2, bounces: Some(3), paths, ..PathSettings::default() };
    apart(&gpu, &scenes[0], branching.into());
}

#[test]
fn trees_are_counted_alike() {
    let gpu = Gpu::headless().unwrap();
    for scene in [parsed(EVERYTHING), builtin::named("whitted").unwrap()] {
        for class in ["direct", "indirect", "LS+E|LDS+E"] {
            let paths = LightPaths::parse(class).unwrap();
            apart(&gpu, &scene, WhittedSettings { paths, shadow_rays: 2, ..WhittedSettings::default() }.into());
        }
    }
}
