//! One kernel, many lanes: pictures are the same bit for bit, whatever traces them and however many threads do.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use pathtrace::{
    ConesAt, Estimator, GlassShadows, Lanes, PathSettings, Roulette, SamplerKind, Stats, Tracer, WhittedSettings,
};
use scene::glam::{Affine3A, Quat};
use scene::{Scene, builtin};
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

#[path = "../examples/meshes/statue.rs"]
mod statue;

/// Not a multiple of any number of lanes, and more than one chunk of pixels.
const SIZE: (u32, u32) = (37, 29);

/// What the built-in scenes lack.
const EVERYTHING: &str = include_str!("../../../tests/tests/scenes/everything-more.toml");

fn everything() -> Scene {
    scene::parse(EVERYTHING, "everything", Path::new("everything-more.toml")).expect("a scene")
}

/// As a mesh of many triangles: too many to be met one by one.
fn a_tree() -> Scene {
    let mut scene = everything();
    let rings = 24u32;
    let at = |i: u32, j: u32| {
        let (theta, phi) = (PI * f64::from(i) / f64::from(rings), TAU * f64::from(j) / f64::from(rings));
        let p = [theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()].map(|c| 0.4 * c as f32);
        scene::Vec3::from_array(p) + scene::Vec3::new(-1.2, 0.5, 1.0)
    };
    let positions = (0..=rings).flat_map(|i| (0..rings).map(move |j| at(i, j))).collect();
    let index = |i: u32, j: u32| i * rings + j % rings;
    let quads = (0..rings).flat_map(|i| (0..rings).map(move |j| (i, j)));
    let triangles = quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
            [[a, c, b], [a, d, c]]
        })
        .collect();
    let ball = scene::Shape { geometry: scene::Geometry::mesh(positions, triangles), material: 1 };
    scene.shapes = scene.shapes.iter().cloned().chain([ball]).collect();
    scene
}

/// With large meshes, one of them mirrored, which are met beside the other shapes.
fn with_statues(mut scene: Scene) -> Scene {
    let (positions, triangles) = statue::statue(5);
    let mesh = Arc::new(scene::Mesh::new(positions, triangles));
    let shape = |x: f32, material| {
        let to_world = Affine3A::from_scale_rotation_translation(
            scene::Vec3::new(-0.3 * x, 0.4, 0.4),
            Quat::from_rotation_y(x),
            scene::Vec3::new(x, 0.8, 0.5),
        );
        let geometry = scene::Geometry::Instance(scene::Instance { mesh: mesh.clone(), to_world });
        scene::Shape { geometry, material }
    };
    // whatever stands last and first in the list, opaque and clear
    let statues: Vec<_> = (0..scene.materials.len())
        .filter(|material| !scene.materials[*material].shines())
        .map(|material| shape(material as f32 - 1.5, material))
        .collect();
    scene.shapes = scene.shapes.iter().cloned().chain(statues).collect();
    scene
}

/// All scenes that this test knows.
fn scenes() -> Vec<Scene> {
    let built_in = builtin::names().chain(builtin::hard_names());
    built_in
        .map(|name| builtin::named(name).expect("built in"))
        .chain([everything(), a_tree(), with_statues(everything()), with_statues(a_tree())])
        .collect()
}

fn all_settings() -> Vec<PathSettings> {
    let estimators = Estimator::on_devices().map(|estimator| PathSettings { estimator, ..PathSettings::default() });
    let base = PathSettings { sampler: SamplerKind::Independent, seed: 5, ..PathSettings::default() };
    let others = [
        base,
        PathSettings { bounces: Some(0), ..base },
        PathSettings { bounces: Some(3), roulette: Roulette::OFF, estimator: Estimator::MIS, ..base },
        PathSettings { roulette: Roulette { probability: Some(0.7), throughput: true }, ..base },
        PathSettings { cones: ConesAt::Everything, estimator: Estimator::MIS, ..PathSettings::default() },
        PathSettings { cones: ConesAt::Nothing, split_glass: false, ..PathSettings::default() },
        PathSettings { branches: 3, bounces: Some(2), ..base },
        PathSettings { branches: 2, bounces: Some(3), estimator: Estimator::UNIFORM_MIS, ..PathSettings::default() },
    ];
    estimators.chain(others).collect()
}

fn path(tracer: &Tracer, scene: &Scene, settings: &PathSettings, samples: u32) -> (Film, Stats) {
    let mut film = Film::new(SIZE.0, SIZE.1);
    let stats = tracer.render(&mut film, &scene.camera, &(*settings).into(), samples, &|| false);
    (film, stats)
}

fn whitted(tracer: &Tracer, scene: &Scene, settings: &WhittedSettings) -> (Film, Stats) {
    let mut film = Film::new(SIZE.0, SIZE.1);
    let stats = tracer.render(&mut film, &scene.camera, &(*settings).into(), 2, &|| false);
    (film, stats)
}

fn tracers(scene: &Scene) -> Vec<(Lanes, Tracer)> {
    Lanes::available().map(|lanes| (lanes, Tracer::new(scene).with_lanes(lanes))).collect()
}

#[test]
fn all_lanes_trace_the_same_paths() {
    for scene in scenes() {
        let tracers = tracers(&scene);
        for settings in all_settings() {
            let of_lanes: Vec<_> = tracers.iter().map(|(_, tracer)| path(tracer, &scene, &settings, 3)).collect();
            let (film, stats) = &of_lanes[0];
            assert_eq!((film.nonfinite, stats.samples), (0, u64::from(SIZE.0 * SIZE.1 * 3)), "{}", scene.name);
            for ((lanes, _), other) in tracers.iter().zip(&of_lanes) {
                assert!(other == &of_lanes[0], "{}, {settings:?}: {} differs", scene.name, lanes.name());
            }
        }
    }
}

/// Guides are learned in these lanes too, which takes one lane a while: in one scene alone.
#[test]
fn all_lanes_learn_and_follow_the_same_guide() {
    let scene = everything();
    for estimator in [Estimator::GUIDED, Estimator::GUIDED_MIS] {
        let settings = PathSettings { estimator, bounces: Some(4), ..PathSettings::default() };
        let of_lanes = tracers(&scene).into_iter().map(|(lanes, tracer)| (lanes, path(&tracer, &scene, &settings, 2)));
        let of_lanes: Vec<_> = of_lanes.collect();
        for (lanes, film) in &of_lanes {
            assert!(film == &of_lanes[0].1, "{}: {} differs", estimator.name(), lanes.name());
        }
    }
}

#[test]
fn all_lanes_grow_the_same_trees() {
    let default = WhittedSettings::default();
    let settings = [
        default,
        WhittedSettings { depth: 0, sampler: SamplerKind::Independent, ..default },
        WhittedSettings { shadow_rays: 3, glass_shadows: GlassShadows::Clear, depth: 5, ..default },
    ];
    for scene in scenes() {
        let tracers = tracers(&scene);
        for settings in settings {
            let of_lanes: Vec<_> = tracers.iter().map(|(_, tracer)| whitted(tracer, &scene, &settings)).collect();
            for ((lanes, _), other) in tracers.iter().zip(&of_lanes) {
                assert!(other == &of_lanes[0], "{}, {settings:?}: {} differs", scene.name, lanes.name());
            }
        }
    }
}

#[test]
fn pictures_do_not_depend_on_threads_or_on_how_samples_are_split() {
    for scene in [everything(), a_tree()] {
        let tracer = Tracer::new(&scene);
        let ways = SamplerKind::ALL.map(|sampler| (sampler, Estimator::default()));
        for (sampler, estimator) in ways.into_iter().chain([(SamplerKind::Sobol, Estimator::GUIDED)]) {
            let settings = PathSettings { sampler, estimator, ..PathSettings::default() };
            let on = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                // a guide that is kept would not depend on anything
                pool.install(|| path(&Tracer::new(&scene), &scene, &settings, 4))
            };
            let whole = on(1);
            assert!(whole == on(2) && whole == on(7), "{sampler:?}");
            let mut film = Film::new(SIZE.0, SIZE.1);
            let mut add = |samples| tracer.render(&mut film, &scene.camera, &settings.into(), samples, &|| false);
            let stats = add(1).plus(add(2)).plus(add(1));
            assert!((film, stats) == whole, "{sampler:?}, in three calls");
        }
    }
}

/// A picture that was stopped holds whole samples, and is completed to the same picture.
#[test]
fn a_stopped_picture_is_completed() {
    let scene = everything();
    let tracer = Tracer::new(&scene);
    let (settings, mut film) = (PathSettings::default(), Film::new(SIZE.0, SIZE.1));
    let asked = AtomicU32::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) > 20;
    let stats = tracer.render(&mut film, &scene.camera, &settings.into(), 16, &stop);
    let taken: u64 = film.pixels().iter().map(|pixel| u64::from(pixel.samples)).sum();
    assert!(taken == stats.samples && taken > 0 && film.samples_per_pixel() == 0, "{taken}");
    tracer.render(&mut film, &scene.camera, &settings.into(), 16, &|| false);
    assert!(film == path(&tracer, &scene, &settings, 16).0);
}

/// A guide is learned before the first sample, or not at all; the next call learns it anew.
#[test]
fn a_guide_that_was_stopped_leaves_no_trace() {
    let scene = everything();
    let tracer = Tracer::new(&scene);
    let settings = PathSettings { estimator: Estimator::GUIDED, ..PathSettings::default() };
    let (asked, mut film) = (AtomicU32::new(0), Film::new(SIZE.0, SIZE.1));
    let stop = || asked.fetch_add(1, Ordering::Relaxed) > 1000;
    let stats = tracer.render(&mut film, &scene.camera, &settings.into(), 2, &stop);
    assert!(stats.samples == 0 && film == Film::new(SIZE.0, SIZE.1), "{stats:?}");
    tracer.render(&mut film, &scene.camera, &settings.into(), 2, &|| false);
    assert!(film == path(&Tracer::new(&scene), &scene, &settings, 2).0);
}

/// One tracer keeps the guide of the last picture; of another view, seed or limit it learns another.
#[test]
fn a_kept_guide_serves_its_own_picture_alone() {
    let scene = everything();
    let kept = Tracer::new(&scene);
    let guided = PathSettings { estimator: Estimator::GUIDED, ..PathSettings::default() };
    let others = [guided, PathSettings { seed: 2, ..guided }, PathSettings { bounces: Some(1), ..guided }, guided];
    for settings in others {
        assert!(path(&kept, &scene, &settings, 1) == path(&Tracer::new(&scene), &scene, &settings, 1), "{settings:?}");
    }
    let mut elsewhere = scene.clone();
    elsewhere.camera.eye.x += 0.1;
    assert!(path(&kept, &elsewhere, &guided, 1).0 == path(&Tracer::new(&scene), &elsewhere, &guided, 1).0);
}

/// Of ten tries the fastest counts: a machine that does other things may wake a thread late.
#[test]
fn a_stop_is_obeyed_within_five_milliseconds() {
    for scene in [everything(), a_tree()] {
        let tracer = Tracer::new(&scene);
        let settings = PathSettings { branches: 3, bounces: Some(2), ..PathSettings::default() };
        let late = (0..10).map(|_| {
            let (stopped, mut film) = (Mutex::new(None), Film::new(256, 256));
            let begun = Instant::now();
            let stop = || {
                let now = begun.elapsed() > Duration::from_millis(5);
                if now {
                    stopped.lock().expect("no panic").get_or_insert_with(Instant::now);
                }
                now
            };
            tracer.render(&mut film, &scene.camera, &settings.into(), u32::MAX, &stop);
            let first = stopped.lock().expect("no panic").take();
            first.expect("it was stopped").elapsed()
        });
        let least = late.min().expect("ten tries");
        assert!(least < Duration::from_millis(5), "{}: {least:?}", scene.name);
    }
}

/// A floor with an area light close below it, which shines upwards, and a ball above: nothing is lit.
fn an_area_light_behind_a_floor(side: f32, below: f32) -> Scene {
    let above = "[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\nfov_y = 30\n\
         [material.grey]\ndiffuse = { albedo = [0.5, 0.5, 0.5] }\n\
         [material.lamp]\nemissive = { radiance = [10, 8, 6] }\n\
         [[sphere]]\ncenter = [0, 1, 0]\nradius = 0.5\nmaterial = 'grey'\n";
    let level = |y: f32, material: &str| {
        let [corner, edge] = [-0.5 * side, side];
        format!(
            "[[rectangle]]\ncorner = [{corner:?}, {y:?}, {corner:?}]\nedge_u = [0, 0, {edge:?}]\n\
             edge_v = [{edge:?}, 0, 0]\nmaterial = '{material}'\n"
        )
    };
    let text = format!("{above}{}{}", level(0.0, "grey"), level(-below, "lamp"));
    scene::parse(&text, "behind", Path::new("behind.toml")).expect("a scene")
}

#[test]
fn an_area_light_just_behind_a_wall_is_in_its_shadow() {
    for (side, below) in [(2e4, 2e-3), (2e6, 0.2), (10.0, 1e-5), (10.0, 1e-3)] {
        let scene = an_area_light_behind_a_floor(side, below);
        let tracer = Tracer::new(&scene);
        for estimator in [Estimator::LIGHT, Estimator::MIS] {
            let (film, _) = path(&tracer, &scene, &PathSettings { estimator, ..PathSettings::default() }, 16);
            assert_eq!(film.mean(), [0.0; 3], "{} behind {side}, {}", below, estimator.name());
        }
    }
}
