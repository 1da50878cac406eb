//! Light apart: pictures of classes of paths have no path in common and leave out none, bring what closed forms say, and
//! are the same however their light is found.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use pathtrace::{
    Estimator, Integrator, Lanes, LightPaths, MetropolisSettings, PathSettings, Roulette, Tracer, WhittedSettings,
};
use scene::{Scene, Vec3, builtin};
use std::path::Path;

const SIZE: (u32, u32) = (37, 29);

/// Sums of f32 in another order, some of them a thousand times as large as what is left of a pixel.
const ROUNDING: f32 = 2e-5;

const EVERYTHING: &str = include_str!("../../../tests/tests/scenes/everything-more.toml");
const METALS: &str = include_str!("../../../tests/tests/scenes/metals.toml");

/// Classes that part all paths: of each set every path is in one.
const PARTS: [&[&str]; 4] = [
    &["direct", "indirect"],
    &["emitted", "bounce-0", "bounce-1", "bounce-2", "from-3"],
    &["up-to-1", "from-2"],
    &["LE", "L S+ E", "L[DGS]*D[DGS]*E", "L[GS]*G[GS]*E"],
];

/// A floor below a ball of glass, one of chrome and one of rough metal, under a lamp.
const BALLS: &str = r#"
camera = { eye = [0.3, 1.6, 6], target = [0.2, 0.6, 0], fov_y = 40 }
material.floor.diffuse.albedo = [0.7, 0.5, 0.3]
material.glass.dielectric.ior = 1.5
material.chrome.mirror.reflectance = [0.9, 0.8, 0.7]
material.gold.rough_conductor = { metal = "gold", roughness = 0.6 }
material.lamp.emissive.radiance = [20, 20, 16]
[[rectangle]]
corner = [-8, 0, -8]
edge_u = [0, 0, 16]
edge_v = [16, 0, 0]
material = "floor"
[[rectangle]]
corner = [-3, 4, -3]
edge_u = [7, 0, 0]
edge_v = [0, 0, 7]
material = "lamp"
[[sphere]]
center = [-0.9, 1.2, 0]
radius = 0.8
material = "glass"
[[sphere]]
center = [1.2, 0.9, -0.4]
radius = 0.7
material = "chrome"
[[sphere]]
center = [0.3, 0.4, 1.2]
radius = 0.4
material = "gold"
"#;

/// In the middle of a ball that shines and reflects half, everywhere.
const FURNACE: &str = include_str!("../../../tests/tests/scenes/furnace.toml");

fn parsed(text: &str) -> Scene {
    scene::parse(text, "a scene", Path::new("scene.toml")).expect("a scene")
}

fn scenes() -> Vec<Scene> {
    let built_in = ["cornell", "whitted"].map(|name| builtin::named(name).expect("built in"));
    built_in.into_iter().chain([EVERYTHING, METALS].map(parsed)).collect()
}

fn paths(text: &str) -> LightPaths {
    LightPaths::parse(text).expect("light paths")
}

fn film(tracer: &Tracer, scene: &Scene, integrator: impl Into<Integrator>, spp: u32) -> Film {
    let mut film = Film::new(SIZE.0, SIZE.1);
    tracer.render(&mut film, &scene.camera, &integrator.into(), spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    film
}

/// Each pixel's parts are its whole, but for rounding.
fn check_parts(whole: &Film, parts: &[Film], about: &str) {
    let mut sums = vec![Vec3::ZERO; whole.pixels().len()];
    for part in parts {
        sums.iter_mut().zip(part.radiances()).for_each(|(sum, radiance)| *sum += radiance);
    }
    for (radiance, sum) in whole.radiances().zip(sums) {
        let off = (radiance - sum).abs().max_element();
        assert!(off <= ROUNDING * radiance.max_element().max(0.1), "{about}: {radiance} is not {sum}");
    }
}

#[test]
fn parts_of_the_light_of_paths_add_up_to_all_of_it() {
    let base = PathSettings { roulette: Roulette::THROUGHPUT, ..PathSettings::default() };
    let all = [
        base,
        PathSettings { estimator: Estimator::MIS, ..PathSettings::independent() },
        PathSettings { estimator: Estimator::COSINE, bounces: Some(4), ..base },
        PathSettings { branches: 2, bounces: Some(3), ..base },
    ];
    for scene in scenes() {
        let tracer = Tracer::new(&scene);
        for settings in all {
            let whole = film(&tracer, &scene, settings, 4);
            for classes in PARTS {
                let part = |class: &&str| film(&tracer, &scene, PathSettings { paths: paths(class), ..settings }, 4);
                let parts: Vec<_> = classes.iter().map(part).collect();
                let some = parts.iter().filter(|part| part.mean()[1] > 0.0).count();
                assert!(some > 1, "{} {classes:?}: one part has it all", scene.name);
                check_parts(&whole, &parts, &format!("{} {classes:?} {settings:?}", scene.name));
            }
        }
    }
}

#[test]
fn parts_of_the_light_of_trees_add_up_to_all_of_it_and_ambient_light_is_indirect() {
    for scene in scenes() {
        let tracer = Tracer::new(&scene);
        let settings = WhittedSettings { ambient: Some(0.1), ..WhittedSettings::default() };
        let whole = film(&tracer, &scene, settings, 2);
        let of = |class: &str| film(&tracer, &scene, WhittedSettings { paths: paths(class), ..settings }, 2);
        for classes in PARTS {
            let parts: Vec<_> = classes.iter().map(|class| of(class)).collect();
            check_parts(&whole, &parts, &format!("{} {classes:?}", scene.name));
        }
        if !scene.needs().rough_conductor {
            let dark = WhittedSettings { ambient: Some(0.0), ..settings };
            check_parts(&film(&tracer, &scene, dark, 2), &[of("direct")], &scene.name);
        }
    }
}

#[test]
fn each_bounce_in_a_furnace_brings_its_power_of_the_albedo() {
    let scene = parsed(FURNACE);
    let tracer = Tracer::new(&scene);
    let base = PathSettings { estimator: Estimator::COSINE, roulette: Roulette::OFF, ..PathSettings::default() };
    let mean = |class: &str| film(&tracer, &scene, PathSettings { paths: paths(class), ..base }, 1).mean()[0];
    assert_eq!(mean("emitted"), 1.0);
    for bounces in 0..=8 {
        let expected = 0.5f64.powi(bounces + 1);
        assert!((mean(&format!("bounce-{bounces}")) / expected - 1.0).abs() < 1e-6, "bounce {bounces}");
        let up_to = 2.0 - expected;
        assert!((mean(&format!("up-to-{bounces}")) / up_to - 1.0).abs() < 1e-6, "up to {bounces}");
    }
    assert!((mean("from-9") / 0.5f64.powi(9) - 1.0).abs() < 1e-6);
    assert!((mean("direct") - 1.5).abs() < 1e-6 && (mean("indirect") - 0.5).abs() < 1e-6);
    assert_eq!(mean("LSE"), 0.0);
}

/// Random numbers are the same, and so are the bits.
#[test]
fn light_up_to_a_bounce_is_what_that_limit_shows() {
    for scene in scenes() {
        let tracer = Tracer::new(&scene);
        for bounces in [0, 2] {
            let limited = PathSettings { bounces: Some(bounces), ..PathSettings::default() };
            let counted = PathSettings { paths: paths(&format!("up-to-{bounces}")), ..PathSettings::default() };
            let [limited, counted] = [limited, counted].map(|settings| film(&tracer, &scene, settings, 2));
            assert!(limited.radiances().eq(counted.radiances()), "{}: {bounces}", scene.name);
        }
    }
}

/// Connections by spheres, chains of paths and chance meet the same light in each class: four standard errors of their
/// difference, which are a few percent; seeds are fixed.
#[test]
fn each_class_has_the_same_light_however_it_is_found() {
    let scene = parsed(BALLS);
    let tracer = Tracer::new(&scene);
    let both = [Estimator::LIGHT, Estimator::MIS];
    // without weights what goes by several spheres is met by few paths, bright ones
    let cases = [("LDE", &both[..]), ("LSDE", &both), ("L.*GE", &both), ("LD+S+E", &both)];
    for (class, estimators) in cases.into_iter().chain([("LS+DE", &both[1..]), ("LSSDE", &both[1..])]) {
        let light = |estimator, seed| PathSettings {
            estimator,
            seed,
            paths: paths(class),
            split_glass: estimator != Estimator::COSINE,
            ..PathSettings::independent()
        };
        let chance = film(&tracer, &scene, light(Estimator::COSINE, 1), 2048);
        for &estimator in estimators {
            let sampled = film(&tracer, &scene, light(estimator, 2), 256);
            let error = chance.standard_error()[1].hypot(sampled.standard_error()[1]);
            let (a, b) = (chance.mean()[1], sampled.mean()[1]);
            assert!(b > 0.0 && (a - b).abs() <= 4.0 * error, "{class}, {}: {a} {b} +- {error}", estimator.name());
            assert!(error < 0.03 * b, "{class}: {error} of {b} would tell nothing");
        }
    }
}

/// Chains share the same target; their error is not told by their pixels, and 3 % is twice what seeds differ by.
#[test]
fn chains_keep_to_a_class_of_paths() {
    let scene = parsed(BALLS);
    let tracer = Tracer::new(&scene);
    for class in ["direct", "LDSE"] {
        let path = PathSettings { estimator: Estimator::MIS, paths: paths(class), ..PathSettings::independent() };
        let sampled = film(&tracer, &scene, path, 512).mean()[1];
        let chains = MetropolisSettings { path, ..MetropolisSettings::default() };
        let chains = film(&tracer, &scene, chains, 256).mean()[1];
        assert!((chains - sampled).abs() <= 0.03 * sampled, "{class}: {chains} {sampled}");
    }
}

#[test]
fn all_lanes_count_the_same_paths() {
    for scene in [parsed(EVERYTHING), parsed(METALS)] {
        let settings =
            |estimator| PathSettings { estimator, paths: paths("L.*S+DE|L.G.*E"), ..PathSettings::default() };
        let trees = WhittedSettings { paths: paths("LDS+E|LDDS?E"), ..WhittedSettings::default() };
        let all: [Integrator; 3] = [settings(Estimator::LIGHT).into(), settings(Estimator::MIS).into(), trees.into()];
        for integrator in all {
            let of = |lanes| film(&Tracer::new(&scene).with_lanes(lanes), &scene, integrator, 3);
            let films: Vec<_> = Lanes::available().map(of).collect();
            assert!(films.windows(2).all(|two| two[0] == two[1]), "{} {integrator:?}", scene.name);
        }
    }
}
