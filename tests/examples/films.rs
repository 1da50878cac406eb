//! Prints the table of films: each line is a film by its command line, a hash of its pixels and what was counted. Two
//! programs render the same pictures if `diff` finds nothing in their tables.
//!
//! cargo run --release -p visavis-tests --example films -- [--device cpu|gpu|all] PATH_TO_VISAVIS

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;
use visavis_tests::films::{FilmRenderer, Row};

const ESTIMATORS: [&str; 6] = ["uniform", "cosine", "light", "mis", "uniform-light", "uniform-mis"];
const SAMPLERS: [&str; 2] = ["sobol", "independent"];
/// Widest first. Those that this machine lacks are left out.
const LANES: [&str; 4] = ["avx512", "avx2", "array", "scalar"];

/// Films of paths, of every scene, beside each estimator with each sampler.
const PATH: [&str; 8] = [
    "--bounces 0",
    "--bounces 3",
    "--roulette 0.8",
    "--roulette 0.8+throughput",
    "--roulette off --bounces 6",
    "--roulette throughput --bounces 6 --estimator mis",
    "--bounces 3 --branches 2",
    "--bounces 2 --branches 3 --roulette off --estimator uniform-mis --sampler independent",
];

/// Films of Whitted's trees, of every scene.
const WHITTED: [&str; 9] = [
    "--sampler sobol",
    "--sampler independent",
    "--depth 0",
    "--depth 2",
    "--glass-shadows clear",
    "--shadow-rays 2",
    "--shadow-rays 3 --sampler independent --glass-shadows clear",
    "--ambient 0",
    "--ambient 0.4",
];

/// Films of Metropolis' chains, of every scene.
const METROPOLIS: [&str; 2] =
    ["--sampler sobol", "--chains 3 --large-step 0.1 --mutation 0.05 --bounces 3 --sampler independent"];

/// Films that all kinds of lanes render, of every scene. Each is among those above, in the widest lanes.
const IN_ALL_LANES: [&str; 6] = [
    "--technique path --device cpu --estimator light --sampler sobol",
    "--technique path --device cpu --estimator mis --sampler independent",
    "--technique path --device cpu --estimator uniform --sampler sobol",
    "--technique path --device cpu --bounces 3 --branches 2",
    "--technique whitted --device cpu --sampler sobol",
    "--technique whitted --device cpu --shadow-rays 3 --sampler independent --glass-shadows clear",
];

/// Scenes that are rendered in more ways than others.
const THOROUGH: [&str; 4] = ["whitted", "cornell", "everything.toml", "mesh.toml"];

/// Scene, camera and number of samples as they are changed, for either technique of rays.
const CHANGED: [&str; 13] = [
    "--refraction-ratio 0.8",
    "--refraction-ratio 1",
    "--refraction-ratio 1.6",
    "--sun-radius 0",
    "--sun-radius 2.5",
    "--sun-radius 20",
    "--fov 100",
    "--size 31x17",
    "--size 130x2 --seed 4294967295",
    "--size 1x1 --spp 40",
    "--spp 1",
    "--spp 17 --seed 0",
    "--spp 100 --size 17x11",
];

/// Each thorough scene from elsewhere.
const SEEN_FROM: [(&str, &str); 4] = [
    ("whitted", "--eye 6,3,-1 --target 3,2,-4 --fov 40"),
    ("cornell", "--eye 200,400,-300 --target 300,200,300 --fov 60"),
    ("everything.toml", "--eye 0.9,0.8,0.6 --target 0,1,-2"),
    ("mesh.toml", "--eye 2,0.7,9 --target 6,1,4 --fov 70"),
];

/// The fake's knobs, of the thorough scenes.
const FAKE: [&str; 20] = [
    "--shading three",
    "--shading phong",
    "--shading blinn-phong",
    "--shadow-filter hard",
    "--shadow-filter pcf",
    "--shadow-filter pcf-soft",
    "--shadow-bias -0.001",
    "--shadow-map 64",
    "--show cube-faces",
    "--show cube-faces --cube-map 16",
    "--show shadow-map",
    "--show shadow-map --shadow-map 32",
    "--cube-map 16",
    "--reflectivity 0.3",
    "--shininess 5",
    "--ambient 0.4",
    "--segments 12",
    "--refraction-ratio 0.8",
    "--fov 100",
    "--size 31x17",
];

/// Films of rays on the graphics device, of every scene.
const ON_GPU: [&str; 5] = [
    "--technique path --device gpu --estimator light --sampler sobol",
    "--technique path --device gpu --estimator mis --sampler independent",
    "--technique path --device gpu --estimator uniform-light --sampler sobol",
    "--technique whitted --device gpu --sampler sobol",
    "--technique whitted --device gpu --shadow-rays 3 --sampler independent --glass-shadows clear",
];

/// The same of the thorough scenes.
const MORE_ON_GPU: [&str; 12] = [
    "--technique path --device gpu --estimator uniform --sampler sobol",
    "--technique path --device gpu --estimator cosine --sampler sobol",
    "--technique path --device gpu --estimator uniform-mis --sampler sobol",
    "--technique path --device gpu --bounces 0",
    "--technique path --device gpu --bounces 3 --branches 2",
    "--technique path --device gpu --roulette 0.8+throughput",
    "--technique path --device gpu --roulette off --bounces 6",
    "--technique path --device gpu --size 31x17 --spp 17",
    "--technique path --device gpu --refraction-ratio 0.8 --sun-radius 0",
    "--technique whitted --device gpu --depth 2",
    "--technique whitted --device gpu --ambient 0.4",
    "--technique whitted --device gpu --refraction-ratio 0.8 --sun-radius 0",
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (device, program) = match &arguments[..] {
        [program] => ("all", program),
        [option, device, program] if option == "--device" => (device.as_str(), program),
        _ => ("", &String::new()),
    };
    let (cpu, gpu) = (["cpu", "all"].contains(&device), ["gpu", "all"].contains(&device));
    if !cpu && !gpu {
        eprintln!("films [--device cpu|gpu|all] PATH_TO_VISAVIS");
        return ExitCode::from(2);
    }
    let renderer = FilmRenderer::new(Path::new(program));
    let scenes = scenes(&renderer);
    println!("{}", Row::COLUMNS);
    let mut films = Vec::new();
    if cpu {
        films.extend(films_on_cpu(&scenes));
        films.extend(films_in_all_lanes(&scenes, &renderer));
    }
    if gpu {
        films.extend(films_on_gpu(&scenes));
    }
    let rows: Vec<Row> = films.iter().zip(renderer.render_all(&films)).map(|(film, row)| row_of(film, row)).collect();
    rows.iter().for_each(|row| println!("{row}"));
    let differing = rows_that_differ_by_lanes(&rows);
    differing.iter().for_each(|row| eprintln!("not as in other lanes: {row}"));
    if differing.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The built-in scenes, and those that are files.
fn scenes(renderer: &FilmRenderer) -> Vec<String> {
    let refused = renderer.render("hard/?").expect_err("a list of the scenes that there are");
    let words = refused.split([' ', ',', ';']);
    let hard: Vec<&str> = words.filter(|word| word.starts_with("hard/") && *word != "hard/?").collect();
    assert!(!hard.is_empty(), "no scenes are named here: {refused}");
    ["whitted", "cornell"].into_iter().chain(FilmRenderer::SCENE_FILES).chain(hard).map(str::to_owned).collect()
}

fn films_on_cpu(scenes: &[String]) -> Vec<String> {
    let mut films = Vec::new();
    for scene in scenes {
        let mut add = |technique: &str, options: &str| {
            films.push(format!("{scene} --technique {technique} --device cpu {options}"));
        };
        for estimator in ESTIMATORS {
            SAMPLERS.iter().for_each(|sampler| add("path", &format!("--estimator {estimator} --sampler {sampler}")));
        }
        PATH.iter().for_each(|options| add("path", options));
        WHITTED.iter().for_each(|options| add("whitted", options));
        METROPOLIS.iter().for_each(|options| add("metropolis", options));
        if !THOROUGH.contains(&scene.as_str()) {
            continue;
        }
        ESTIMATORS.iter().for_each(|estimator| add("path", &format!("--bounces 0 --estimator {estimator}")));
        let elsewhere = SEEN_FROM.iter().filter(|(of, _)| of == scene).map(|(_, camera)| camera);
        for options in CHANGED.iter().chain(elsewhere) {
            add("path", options);
            add("path", &format!("--estimator mis --sampler independent {options}"));
            add("whitted", options);
        }
    }
    films
}

fn films_in_all_lanes(scenes: &[String], renderer: &FilmRenderer) -> Vec<String> {
    let is_here = |lanes: &&str| match renderer.render(&format!("cornell --lanes {lanes}")) {
        Ok(_) => true,
        Err(said) => {
            println!("# Left out, {lanes}: {said}");
            false
        }
    };
    let here: Vec<&str> = LANES.into_iter().filter(is_here).collect();
    let of_scene = |scene: &String| {
        let in_lanes = |lanes: &&str| IN_ALL_LANES.map(|options| format!("{scene} {options} --lanes {lanes}"));
        here.iter().flat_map(in_lanes).collect::<Vec<_>>()
    };
    scenes.iter().flat_map(of_scene).collect()
}

fn films_on_gpu(scenes: &[String]) -> Vec<String> {
    let mut films = Vec::new();
    for scene in scenes {
        let is_thorough = THOROUGH.contains(&scene.as_str());
        films.extend(ON_GPU.map(|options| format!("{scene} {options}")));
        if is_thorough {
            films.extend(MORE_ON_GPU.map(|options| format!("{scene} {options}")));
        }
        for fake in ["fair", "as-taught"] {
            films.push(format!("{scene} --technique raster --fake {fake}"));
            if is_thorough {
                films.extend(FAKE.map(|options| format!("{scene} --technique raster --fake {fake} {options}")));
            }
        }
    }
    films
}

/// A film that the program refuses is a row too: another program must refuse it as well.
fn row_of(film: &str, rendered: Result<Row, String>) -> Row {
    rendered.unwrap_or_else(|said| {
        eprintln!("refused: {film}: {said}");
        Row { film: film.to_owned(), pixels: "refused".to_owned(), counts: String::new() }
    })
}

/// Rows that differ from the first of the same film in other lanes.
fn rows_that_differ_by_lanes(rows: &[Row]) -> Vec<&Row> {
    let mut first: BTreeMap<&str, &Row> = BTreeMap::new();
    let mut differing = Vec::new();
    for row in rows {
        let first = first.entry(row.film_of_any_lanes()).or_insert(row);
        if (&first.pixels, &first.counts) != (&row.pixels, &row.counts) {
            differing.push(row);
        }
    }
    differing
}
