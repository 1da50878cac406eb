//! The ladder without a window: each rung is the picture that `render` makes of the same settings.

use super::{assert_refused, json, program, visavis};
use visavis_tests::TestFolder;

#[test]
fn each_rung_has_a_picture_that_its_command_makes_again_and_errors_fall_to_the_truth() {
    let folder = TestFolder::new();
    let out = folder.file("rungs").display().to_string();
    let report = json(&visavis(&["ladder", "cornell", "-o", &out, "--size", "48x36", "--spp", "64", "--json"]));
    let rungs = report["rungs"].as_array().expect("rungs");
    let names: Vec<_> = rungs.iter().map(|rung| rung["name"].as_str().expect("a name")).collect();
    let repaired = ["antialiasing", "soft-shadows", "area-lights", "reflective-shadow-map", "irradiance-probes"];
    assert_eq!(names, [&["as-taught", "encoding"][..], &repaired, &["whitted", "path"]].concat());
    let error = |index: usize| rungs[index]["relmse"].as_f64().expect("a figure");
    assert!(error(names.len() - 1) < 0.2 * error(1) && rungs.iter().all(|rung| rung["anew_ms"].as_f64() > Some(0.0)));
    let idle = report["idle"].as_array().expect("what there is no use for");
    assert!(idle.iter().any(|repair| repair["name"] == "mirrors" && repair["missing"] == "mirror"));
    let again = folder.file("again.png");
    for (index, rung) in rungs.iter().enumerate() {
        let mut words: Vec<&str> = rung["command"].as_str().expect("a command").split(' ').skip(1).collect();
        let place = words.iter().position(|word| *word == "-o").expect("an output");
        let again = again.display().to_string();
        words[place + 1] = &again;
        assert!(program().args(&words).status().expect("the program").success(), "{words:?}");
        let pixels = |file: &std::path::Path| image::open(file).expect("a picture").to_rgba8();
        let kept = folder.file("rungs").join(format!("{index:02}-{}.png", names[index]));
        assert!(pixels(&kept) == pixels(again.as_ref()), "{} is another picture", kept.display());
    }
    let csv = std::fs::read_to_string(folder.file("rungs").join("ladder.csv")).expect("a table");
    assert_eq!(csv.lines().count(), 1 + rungs.len());
    let svg = std::fs::read_to_string(folder.file("rungs").join("ladder.svg")).expect("a chart");
    assert!(svg.contains("Path tracing") && svg.ends_with("</svg>\n"));
    let sheet = image::open(folder.file("rungs").join("sheet.png")).expect("a sheet");
    assert!(sheet.width() > 4 * 48 && sheet.height() > 2 * 36);
}

/// A mirror above a floor, whose maps are small: each repair is drawn many times.
const BALL: &str = "camera = { eye = [0, 3, 9], target = [0, 1, 0], fov_y = 40 }
sun = { towards = [1, 3, 1], angular_radius = 2, irradiance = [3, 3, 3] }
sky = { radiance = [0.3, 0.5, 0.9] }
[fake]
cube_map = 16
shadow_map = 32
segments = 16
[material.white]
diffuse = { albedo = [0.8, 0.8, 0.8] }
[material.metal]
mirror = { reflectance = [0.9, 0.9, 0.9] }
[[rectangle]]
material = \"white\"
corner = [-6, 0, 6]
edge_u = [12, 0, 0]
edge_v = [0, 0, -12]
[[sphere]]
material = \"metal\"
center = [0, 1.2, 0]
radius = 1
";

#[test]
fn best_first_begins_with_what_is_worth_most_and_ends_where_the_other_order_does() {
    let folder = TestFolder::new();
    let scene = folder.file("ball.toml");
    std::fs::write(&scene, BALL).expect("a scene");
    let scene = scene.display().to_string();
    let climbed = |order: &str| {
        let out = folder.file(order).display().to_string();
        let words = ["ladder", &scene, "-o", &out, "--size", "32x18", "--spp", "1", "--order", order, "--json"];
        let report = json(&visavis(&words));
        let rungs = report["rungs"].as_array().expect("rungs").clone();
        let of = |name: &str| rungs.iter().position(|rung| rung["name"] == name).expect("a rung");
        let last = rungs.len() - 3;
        (of("mirrors"), of("proxy-sphere"), rungs[last]["relmse"].as_f64().expect("a figure"))
    };
    let (mirrors, parallax, end) = climbed("best-first");
    let (.., end_of_other) = climbed("light");
    // the mirror is much of the error, and without it there is nothing to look up
    assert!(mirrors < parallax && (end - end_of_other).abs() < 1e-6 * end, "{mirrors} {parallax} {end} {end_of_other}");
}

#[test]
fn only_the_repairs_that_are_asked_for_are_climbed() {
    let folder = TestFolder::new();
    let out = folder.file("rungs").display().to_string();
    let words =
        ["ladder", "cornell", "-o", &out, "--size", "24x18", "--spp", "1", "--repairs", "soft-shadows+sky", "--json"];
    let report = json(&visavis(&words));
    let names: Vec<_> = report["rungs"].as_array().expect("rungs").iter().map(|rung| rung["name"].clone()).collect();
    assert_eq!(names, ["as-taught", "encoding", "soft-shadows", "whitted", "path"], "there is no sky to repair");
}

#[test]
fn what_is_missing_or_wrong_is_said() {
    let refused = |words: &[&str], line: &str| assert_refused(words, 2, &[line]);
    refused(&["ladder"], "ladder needs a scene: visavis ladder SCENE -o DIR");
    refused(&["ladder", "whitted"], "ladder needs a folder for its pictures: -o DIR");
    refused(&["ladder", "whitted", "-o", "x", "--order", "worst"], "--order worst: expected light or best-first");
    refused(&["ladder", "whitted", "-o", "x", "--repairs", "sky+glue"], "--repairs glue: expected none, all or names");
    refused(&["ladder", "whitted", "-o", "x", "--spp", "0"], "--spp 0: expected a whole number from 1");
}
