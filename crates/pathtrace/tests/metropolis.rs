//! Metropolis' chains: the right mean however long they are, and the same picture whatever walks them.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use film::colour::luminance;
use pathtrace::{Estimator, Integrator, Lanes, MetropolisSettings, PathSettings, Roulette, SamplerKind, Stats, Tracer};
use scene::{Scene, builtin};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

/// Four by four blocks.
const SIZE: (u32, u32) = (32, 32);
const BLOCK: usize = 8;
const BLOCKS: usize = 16;

/// What the built-in scenes lack.
const EVERYTHING: &str = include_str!("../../../tests/tests/scenes/everything-more.toml");

/// A small lamp whose light reaches the floor through a ball of glass, for who meets it by chance.
const LAMP_OVER_GLASS: &str = "
[camera]
eye = [0, 3, 6]
target = [0, 0.4, 0]
fov_y = 35
[material.grey]
diffuse = { albedo = [0.6, 0.6, 0.6] }
[material.glass]
dielectric = { ior = 1.5 }
[material.lamp]
emissive = { radiance = [400, 400, 400] }
[[rectangle]]
corner = [-6, 0, -6]
edge_u = [0, 0, 12]
edge_v = [12, 0, 0]
material = 'grey'
[[sphere]]
center = [0, 1, 0]
radius = 0.8
material = 'glass'
[[sphere]]
center = [0.5, 5, -0.5]
radius = 0.15
material = 'lamp'
";

/// A ball that reflects everything under a sky of one colour: all paths bring the same.
const FURNACE: &str = "
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
fov_y = 40
[sky]
radiance = [0.5, 0.7, 0.9]
[material.white]
diffuse = { albedo = [1, 1, 1] }
[[sphere]]
center = [0, 0, 0]
radius = 1
material = 'white'
";

fn parsed(text: &str) -> Scene {
    scene::parse(text, "test", Path::new("test.toml")).expect("a scene")
}

fn named(name: &str) -> Scene {
    builtin::named(name).expect("built in")
}

fn picture(tracer: &Tracer, scene: &Scene, integrator: impl Into<Integrator>, samples: u32) -> (Film, Stats) {
    let mut film = Film::new(SIZE.0, SIZE.1);
    let stats = tracer.render(&mut film, &scene.camera, &integrator.into(), samples, &|| false);
    (film, stats)
}

fn metropolis(estimator: Estimator) -> MetropolisSettings {
    let path = PathSettings { estimator, ..PathSettings::default() };
    MetropolisSettings { path, chains: 16, ..MetropolisSettings::default() }
}

/// Luminance of each block.
fn blocks(film: &Film) -> [f64; BLOCKS] {
    let mut sums = [0.0; BLOCKS];
    for (index, radiance) in film.radiances().enumerate() {
        let (column, row) = (index % SIZE.0 as usize / BLOCK, index / SIZE.0 as usize / BLOCK);
        sums[row * 4 + column] += f64::from(luminance(radiance)) / (BLOCK * BLOCK) as f64;
    }
    sums
}

/// Mean of each block and the square of its standard error, from pictures of 24 seeds: they are independent, whatever
/// their pixels and samples are.
fn judged(tracer: &Tracer, scene: &Scene, integrator: Integrator, samples: u32) -> [(f64, f64); BLOCKS] {
    const SEEDS: u32 = 24;
    let n = f64::from(SEEDS);
    let pictures: Vec<_> =
        (0..SEEDS).map(|seed| blocks(&picture(tracer, scene, integrator.with_seed(100 + seed), samples).0)).collect();
    std::array::from_fn(|block| {
        let mean = pictures.iter().map(|picture| picture[block]).sum::<f64>() / n;
        let squares = pictures.iter().map(|picture| (picture[block] - mean).powi(2)).sum::<f64>();
        (mean, squares / (n - 1.0) / n)
    })
}

/// Asserts equal means: Student's t of some 23 degrees of freedom is beyond 4.5 in one of 6,000 blocks, and a test looks
/// at 16 or 32 of them.
fn assert_agrees(scene: &Scene, settings: MetropolisSettings, runs: u32) {
    let tracer = Tracer::new(scene);
    let path = judged(&tracer, scene, PathSettings { seed: 7, ..settings.path }.into(), 256);
    let chains = judged(&tracer, scene, settings.into(), runs);
    for (block, ((own, own_variance), (truth, variance))) in chains.into_iter().zip(path).enumerate() {
        let error = (own_variance + variance).sqrt();
        let t = (own - truth).abs() / error.max(1e-6 * truth);
        assert!(t < 4.5, "{}, block {block}: {own} for {truth}, {t} standard errors of {error}", scene.name);
    }
}

#[test]
fn blocks_of_the_picture_have_the_path_tracers_means() {
    assert_agrees(&named("cornell"), metropolis(Estimator::LIGHT), 32);
    // a wider sun: pictures of a caustic that is hardly ever met are nearly all too dark, and their spread too small
    let mut scene = named("whitted");
    scene.sun.as_mut().expect("a sun").angular_radius = 15.0;
    assert_agrees(&scene, metropolis(Estimator::MIS), 32);
}

#[test]
fn means_are_right_with_one_mutation_a_chain() {
    let settings = MetropolisSettings { chains: SIZE.0 * SIZE.1, ..metropolis(Estimator::COSINE) };
    assert_agrees(&named("cornell"), settings, 32);
}

#[test]
fn means_are_right_with_small_steps_alone_large_steps_alone_and_any_roulette() {
    let scene = named("cornell");
    for large_step in [0.0, 1.0] {
        assert_agrees(&scene, MetropolisSettings { large_step, mutation: 0.2, ..metropolis(Estimator::LIGHT) }, 32);
    }
    let (roulette, sampler) = (Roulette::constant(0.7), SamplerKind::Independent);
    let path = PathSettings { roulette, sampler, bounces: Some(4), ..PathSettings::default() };
    assert_agrees(&scene, MetropolisSettings { path, ..metropolis(Estimator::LIGHT) }, 32);
}

#[test]
fn every_mutation_is_taken_where_all_paths_bring_the_same() {
    let scene = parsed(FURNACE);
    let (film, stats) = picture(&Tracer::new(&scene), &scene, metropolis(Estimator::LIGHT), 4);
    let luminance = f64::from(luminance(scene::Vec3::new(0.5, 0.7, 0.9)));
    let (acceptance, scale) = (stats.chains.acceptance().expect("mutations"), stats.chains.scale().expect("runs"));
    // a path's light may differ by a rounding
    assert!(acceptance > 0.999_99, "{acceptance}");
    assert!((scale - luminance).abs() < 1e-6 && film.nonfinite == 0, "{scale} for {luminance}");
    assert_eq!((stats.chains.runs, stats.chains.mutations), (4, u64::from(4 * SIZE.0 * SIZE.1)));
}

/// Whatever chains do, their weights add up: each mutation leaves a luminance of 1, times the scale.
#[test]
fn the_pictures_luminance_is_the_start_up_scale() {
    for name in ["cornell", "whitted"] {
        let scene = named(name);
        let (film, stats) = picture(&Tracer::new(&scene), &scene, metropolis(Estimator::LIGHT), 3);
        let mean = film.mean();
        let luminance = 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2];
        let scale = stats.chains.scale().expect("runs");
        assert!((luminance / scale - 1.0).abs() < 1e-5, "{name}: {luminance} for {scale}");
    }
}

#[test]
fn a_scene_without_light_is_black() {
    let dark = LAMP_OVER_GLASS.replace("emissive = { radiance = [400, 400, 400] }", "diffuse = { albedo = [1, 1, 1] }");
    let scene = parsed(&dark);
    let (film, stats) = picture(&Tracer::new(&scene), &scene, metropolis(Estimator::LIGHT), 3);
    assert_eq!((film.mean(), film.nonfinite, film.samples_per_pixel()), ([0.0; 3], 0, 3));
    assert_eq!((stats.chains.scale(), stats.chains.acceptance()), (Some(0.0), None));
}

/// Luminance of each pixel in pictures of 12 seeds.
fn pictures(tracer: &Tracer, scene: &Scene, integrator: Integrator, size: (u32, u32), samples: u32) -> Vec<Vec<f64>> {
    let of_seed = |seed| {
        let mut film = Film::new(size.0, size.1);
        tracer.render(&mut film, &scene.camera, &integrator.with_seed(seed), samples, &|| false);
        film.radiances().map(|radiance| f64::from(luminance(radiance))).collect()
    };
    (0..12).map(of_seed).collect()
}

fn mean(pictures: &[Vec<f64>], pixel: usize) -> f64 {
    pictures.iter().map(|picture| picture[pixel]).sum::<f64>() / pictures.len() as f64
}

/// Mean relative variance of the pixels of pictures, around their own means.
fn relative_variance(pictures: &[Vec<f64>], truth: impl Fn(usize) -> f64) -> f64 {
    let pixels = pictures[0].len();
    let of_pixel = |pixel: usize| {
        let mean = mean(pictures, pixel);
        let squares = pictures.iter().map(|picture| (picture[pixel] - mean).powi(2)).sum::<f64>();
        squares / (pictures.len() - 1) as f64 / (truth(pixel).powi(2) + 0.01)
    };
    (0..pixels).map(of_pixel).sum::<f64>() / pixels as f64
}

/// At as many paths, candidates counted.
#[test]
fn light_that_only_chance_finds_through_glass_has_less_noise_than_by_independent_paths() {
    let scene = parsed(LAMP_OVER_GLASS);
    let tracer = Tracer::new(&scene);
    let settings = MetropolisSettings { chains: 4, ..metropolis(Estimator::COSINE) };
    let independent = pictures(&tracer, &scene, settings.path.into(), (128, 72), 72);
    let chains = pictures(&tracer, &scene, settings.into(), (128, 72), 64);
    let truth = |pixel| 0.5 * (mean(&independent, pixel) + mean(&chains, pixel));
    let [chains, independent] = [chains.as_slice(), &independent].map(|pictures| relative_variance(pictures, truth));
    assert!(chains < 0.3 * independent, "{chains} against {independent}");
}

fn settings() -> [MetropolisSettings; 4] {
    let base = MetropolisSettings { chains: 21, ..metropolis(Estimator::LIGHT) };
    [
        base,
        MetropolisSettings { large_step: 0.0, mutation: 0.25, ..metropolis(Estimator::MIS) },
        MetropolisSettings { path: PathSettings { bounces: Some(1), seed: 3, ..PathSettings::independent() }, ..base },
        MetropolisSettings { chains: 2000, ..metropolis(Estimator::UNIFORM_MIS) },
    ]
}

#[test]
fn all_lanes_walk_the_same_chains() {
    for scene in [named("cornell"), named("whitted"), parsed(EVERYTHING)] {
        for settings in settings() {
            let in_lanes = |lanes| picture(&Tracer::new(&scene).with_lanes(lanes), &scene, settings, 2);
            let one = in_lanes(Lanes::Scalar);
            for lanes in Lanes::available() {
                assert!(in_lanes(lanes) == one, "{}, {settings:?}: {} differs", scene.name, lanes.name());
            }
        }
    }
}

#[test]
fn pictures_do_not_depend_on_threads_or_on_how_runs_are_split() {
    let scene = parsed(EVERYTHING);
    let tracer = Tracer::new(&scene);
    for settings in settings() {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| picture(&tracer, &scene, settings, 5))
        };
        let whole = on(1);
        assert!(whole == on(2) && whole == on(7), "{settings:?}");
        let mut film = Film::new(SIZE.0, SIZE.1);
        for runs in [1, 3, 1] {
            tracer.render(&mut film, &scene.camera, &settings.into(), runs, &|| false);
        }
        assert!(film == whole.0, "{settings:?}, in three calls");
    }
}

/// A run that was stopped is left out whole.
#[test]
fn a_stopped_picture_holds_whole_runs_and_is_completed() {
    let scene = named("cornell");
    let tracer = Tracer::new(&scene);
    let (settings, mut film) = (metropolis(Estimator::LIGHT), Film::new(SIZE.0, SIZE.1));
    let asked = AtomicU32::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) > 3000;
    let stats = tracer.render(&mut film, &scene.camera, &settings.into(), 1000, &stop);
    let made = film.samples_per_pixel();
    assert!((1..1000).contains(&made) && film.pixels().iter().all(|pixel| pixel.samples == made), "{made}");
    assert_eq!(stats.chains.runs, u64::from(made));
    tracer.render(&mut film, &scene.camera, &settings.into(), 2, &|| false);
    assert!(film == picture(&tracer, &scene, settings, made + 2).0);
}
