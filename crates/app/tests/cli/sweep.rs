//! Sweeps without a window: each tile is the picture that `render` makes of the same settings.

use super::{assert_refused, json, program, visavis};
use image::RgbaImage;
use serde_json::Value;
use std::path::Path;
use visavis_tests::{TestFolder, place_of};

fn pixels(file: &Path) -> RgbaImage {
    image::open(file).expect("a picture").to_rgba8()
}

/// Runs the command that a tile's record keeps, with another file to write.
fn rendered(command: &str, out: &Path) -> RgbaImage {
    let words: Vec<&str> = command.split(' ').collect();
    let place = words.iter().position(|word| *word == "-o").expect("an output");
    let mut words: Vec<String> = words[1..].iter().map(|word| (*word).to_owned()).collect();
    words[place] = out.display().to_string();
    let done = program().args(&words).output().expect("the program");
    assert!(done.status.success(), "{command}: {}", String::from_utf8_lossy(&done.stderr));
    pixels(out)
}

fn tiles(report: &Value) -> &Vec<Value> {
    report["tiles"].as_array().expect("tiles")
}

#[test]
fn each_tile_of_a_strip_and_of_a_matrix_is_the_picture_that_its_command_renders() {
    let folder = TestFolder::new();
    for (words, count) in [
        (&["bounces=0,1", "--spp", "3"][..], 2),
        (&["technique=path,whitted,photon", "spp=1,2", "--exposure", "1"], 6),
        (&["denoise=off,atrous", "--of", "path,spp=5,runs=2"], 2),
    ] {
        let (strip, one) = (folder.file("strip.png"), folder.file("one.png"));
        let out = strip.display().to_string();
        let words = [&["sweep", "cornell", "-o", &out, "--size", "48x36", "--json"], words].concat();
        let report = json(&visavis(&words));
        assert_eq!(tiles(&report).len(), count);
        let whole = pixels(&strip);
        let mut places = Vec::new();
        for (index, tile) in tiles(&report).iter().enumerate() {
            let records = image_file::records(&strip).expect("records");
            let command = tile["command"].as_str().expect("a command");
            let name = format!("tile {}", index + 1);
            assert!(records.iter().any(|(known, value)| *known == name && value == command), "{name}: {command}");
            let picture = rendered(command, &one);
            let place = place_of((picture.dimensions(), picture.as_raw()), (whole.dimensions(), whole.as_raw()))
                .unwrap_or_else(|| panic!("{command} is not on the sheet"));
            assert!(!places.contains(&place), "two tiles are one");
            places.push(place);
        }
        let mut in_order = places.clone();
        in_order.sort_by_key(|(left, top)| (*top, *left));
        assert_eq!(places, in_order, "row by row");
        assert!(whole.height() > 36 && whole.width() > 2 * 48, "there is room for captions");
    }
}

#[test]
fn at_equal_time_each_tile_has_the_time_and_says_what_it_took() {
    let folder = TestFolder::new();
    let out = folder.file("strip.png").display().to_string();
    let words =
        ["sweep", "cornell", "estimator=uniform,light", "--time", "0.3", "--size", "32x24", "-o", &out, "--json"];
    let report = json(&visavis(&words));
    for tile in tiles(&report) {
        let seconds = tile["seconds"].as_f64().expect("seconds");
        // passes are fitted to what is left: none is as long again
        assert!((0.3..0.6).contains(&seconds), "{tile}");
        assert!(tile["spp"].as_u64().expect("samples") > 1, "{tile}");
        assert!(tile["done"] == true && tile["errors"].is_null());
    }
    assert_eq!(report["time"], 0.3);
}

#[test]
fn errors_are_those_of_compare_and_the_best_is_marked() {
    let folder = TestFolder::new();
    let [strip, csv, one, reference] = ["s.png", "s.csv", "one.exr", "r.exr"].map(|name| folder.file(name));
    let cache = folder.file("cache");
    let run = |words: &[&str]| program().env("VISAVIS_CACHE", &cache).args(words).output().expect("the program");
    let [out, table, picture, judge] = [&strip, &csv, &one, &reference].map(|file| file.display().to_string());
    let words =
        ["sweep", "cornell", "spp=1,9", "--errors", "RMSE", "--size", "24x18", "-o", &out, "--csv", &table, "--json"];
    let report = json(&run(&words));
    assert!(run(&["reference", "cornell", "--size", "24x18", "-o", &judge]).status.success());
    for (tile, best) in tiles(&report).iter().zip([false, true]) {
        let spp = tile["spp"].to_string();
        assert!(run(&["render", "cornell", "--size", "24x18", "--spp", &spp, "-o", &picture]).status.success());
        let compared = json(&run(&["compare", &picture, &judge, "--json"]));
        let of = |report: &Value, name: &str| report[name].as_f64().expect("a number");
        for name in ["rmse", "relmse", "mae", "flip"] {
            let (told, expected) = (of(&tile["errors"], name), of(&compared, name));
            // the reference went through a file of f32
            assert!((told - expected).abs() < 1e-4 * expected, "{name}: {told}, compare {expected}");
        }
        assert_eq!(tile["best"], best);
    }
    let table = std::fs::read_to_string(&csv).expect("the table");
    assert_eq!(table.lines().count(), 3);
    assert!(table.starts_with("spp,made_spp,seconds,rel_mse,rmse,mae,flip,reference_noise\n1,1,"), "{table}");
}

#[test]
fn what_cannot_be_varied_is_wrong_usage_and_writes_nothing() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let out = out.to_str().expect("a name");
    let cases: [(&[&str], &str); 17] = [
        (&[], "sweep needs a scene"),
        (&["cornell"], "sweep needs what is varied"),
        (&["bounces=0,1"], "a scene before what is varied: visavis sweep SCENE bounces=0,1"),
        (&["cornell", "bounces"], "expected NAME=V1,V2"),
        (&["cornell", "bouncs=0,1"], "did you mean bounces?"),
        (&["cornell", "bounces=0"], "bounces has 1: expected 2 to 8 values"),
        (&["cornell", "bounces=0,many"], "bounces=many: expected a whole number"),
        (&["cornell", "depth=1,2"], "depth is no setting of path"),
        (&["cornell", "branches=1,2"], "need a limit of bounces"),
        (&["cornell", "spp=1,2", "--spp", "4"], "spp is what is varied"),
        (&["cornell", "spp=1,2", "--time", "4"], "at equal time nothing is left of spp"),
        (&["cornell", "bounces=0,1", "--spp", "4", "--time", "1"], "leave one out"),
        (&["cornell", "bounces=0,1", "--ready", "spp"], "both say what is varied"),
        (&["cornell", "--ready", "spqr"], "expected bounces, spp, estimators"),
        (&["cornell", "bounces=0,1", "--errors", "MSE"], "relMSE, RMSE or FLIP"),
        (&["cornell", "technique=path,metropolis", "--device", "gpu"], "--device gpu: Metropolis"),
        (&["cornell", "technique=path,raster", "--device", "cpu"], "by the gpu only"),
    ];
    for (words, said) in cases {
        assert_refused(&[&["sweep"], words, &["-o", out]].concat(), 2, &[said]);
    }
    assert_refused(&["sweep", "cornell", "bounces=0,1"], 2, &["-o OUT.png"]);
    assert_refused(&["sweep", "cornell", "bounces=0,1", "-o", "out.exr"], 2, &["must end in .png", "out.exr"]);
    assert_refused(&["sweep", "none", "bounces=0,1", "-o", out], 1, &["none"]);
    let normals = ["sweep", "cornell", "technique=path,normals", "--errors", "FLIP", "-o", out];
    assert_refused(&normals, 1, &["what shows no light has no errors"]);
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn a_list_of_jobs_has_the_line_of_each_tile_and_renders_nothing() {
    let folder = TestFolder::new();
    let out = folder.file("strip.png").display().to_string();
    let words = ["sweep", "cornell", "bounces=0,1,inf", "--spp", "2", "--size", "16x12", "-o", &out];
    let listed = visavis(&[&words[..], &["--jobs"]].concat());
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
    let listed = String::from_utf8(listed.stdout).expect("a text");
    let lines: Vec<&str> = listed.lines().collect();
    assert!(lines.len() == 3 && !Path::new(&out).exists(), "{listed}");
    let report = json(&visavis(&[&words[..], &["--json"]].concat()));
    for (index, (tile, line)) in tiles(&report).iter().zip(lines).enumerate() {
        let own = out.replace(".png", &format!(".{}.png", index + 1));
        assert_eq!(tile["command"].as_str().expect("a command").replace("tile.png", &own), line);
    }
    let jobs = |more: &[&'static str]| [&["sweep", "cornell", "bounces=0,1", "-o", "out.png", "--jobs"], more].concat();
    assert_refused(&jobs(&["--time", "1"]), 2, &["--jobs", "say --spp N"]);
    assert_refused(&jobs(&["--errors", "RMSE"]), 2, &["--jobs renders nothing", "--errors"]);
    let listed = visavis(&jobs(&["--allow-outside", "--up", "0.6,0.8,0"])).stdout;
    let listed = String::from_utf8(listed).expect("a text");
    let is_whole = |line: &str| line.contains(" --up 0.6,0.8,0 ") && line.ends_with(" --allow-outside");
    assert!(listed.lines().count() == 2 && listed.lines().all(is_whole), "{listed}");
}

#[test]
fn no_file_is_written_over_another_of_the_same_sweep() {
    let folder = TestFolder::new();
    let scene = folder.file("my.toml");
    let text = scene::builtin::text("cornell").expect("a built-in scene");
    std::fs::write(&scene, text).expect("a file");
    let own = scene.to_str().expect("a name");
    let [out, through] = ["new.png", "../new.png"].map(|name| match name.strip_prefix("../") {
        None => folder.file(name).display().to_string(),
        Some(name) => format!("{}/../{}/{name}", own.trim_end_matches("/my.toml"), name_of(&folder)),
    });
    let sweep = ["sweep", own, "bounces=0,1", "--spp", "1", "--size", "16x16", "-o", &out, "--csv"];
    assert_refused(&[&sweep[..], &[own]].concat(), 1, &["--csv would overwrite the scene", "my.toml"]);
    // the second is a longer way to the file of the first, and neither is there yet
    for csv in [&out, &through] {
        assert_refused(&[&sweep[..], &[csv]].concat(), 1, &["-o and --csv are one file", "new.png"]);
    }
    assert_eq!(folder.names(), ["my.toml"]);
    assert_eq!(std::fs::read_to_string(&scene).expect("the scene"), text);
}

/// The name of a folder in that above it.
fn name_of(folder: &TestFolder) -> String {
    let file = folder.file("a");
    file.parent().and_then(Path::file_name).expect("a folder").display().to_string()
}

/// Were a tile of it rendered, this took minutes.
#[test]
fn a_sheet_that_would_be_too_large_is_refused_before_a_tile_is_made() {
    let folder = TestFolder::new();
    let out = folder.file("big.png").display().to_string();
    let words = ["sweep", "cornell", "seed=1,2,3", "--spp", "1000", "--size", "8000x6000", "-o", &out];
    assert_refused(&words, 1, &["all tiles together are", "make them smaller, or fewer"]);
    assert_eq!(folder.names(), [""; 0]);
}
