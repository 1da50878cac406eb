//! The command line: good input makes the file, bad input makes one line and nothing else.

#![expect(clippy::expect_used, reason = "a test stops at the first thing that is not as it must be")]

mod bench;
mod bugs;
mod changed_scenes;
mod check;
mod denoise;
mod denoising;
mod device;
mod device_report;
mod edits;
mod effects;
mod files;
mod films;
#[cfg(unix)]
mod interrupts;
mod ladder;
mod light;
mod merge;
mod pictures;
mod references;
mod report;
mod sweep;
mod trees;
mod window;

use serde_json::Value;
use std::process::{Command, Output};
use visavis_tests::TestFolder;

/// The program without a display, and without the user's references and trees.
fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_visavis"));
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    // without it a library behind some GPU drivers writes a line of its own to stderr
    command.env("XDG_RUNTIME_DIR", std::env::temp_dir());
    command.env("VISAVIS_CACHE", "/dev/null/no-store").env_remove("VISAVIS_CACHE_MIB").env("VISAVIS_TREES_MIB", "0");
    command
}

fn visavis(arguments: &[&str]) -> Output {
    program().args(arguments).output().expect("the program")
}

/// Runs and expects failure with `code` and one line on stderr that holds all of `words`, nothing on stdout.
fn assert_refused(arguments: &[&str], code: i32, words: &[&str]) {
    assert_failed(arguments, &visavis(arguments), code, words);
}

fn assert_failed(arguments: &[&str], output: &Output, code: i32, words: &[&str]) {
    let line = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {line}");
    assert_eq!(line.lines().count(), 1, "{arguments:?}: {line}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    for word in words {
        assert!(line.contains(word), "{arguments:?}: '{word}' is not in: {line}");
    }
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object")
}

/// Without a display: whoever comes to the window has passed.
#[test]
fn bad_values_are_wrong_usage_and_write_nothing() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let out = out.to_str().unwrap();
    let cases: [(&[&str], &str); 16] = [
        (&["--refraction-ratio", "0"], "a number from 0.001 to 1000"),
        (&["--refraction-ratio", "-1"], "a number from 0.001 to 1000"),
        (&["--refraction-ratio", "nan"], "a number from 0.001 to 1000"),
        (&["--refraction-ratio", "inf"], "a number from 0.001 to 1000"),
        (&["--spp", "0"], "whole number from 1"),
        (&["--roulette", "0"], "probability above 0 and at most 1"),
        (&["--roulette", "1.5"], "probability above 0 and at most 1"),
        (&["--roulette", "nan"], "probability above 0 and at most 1"),
        (&["--size", "0x100"], "both at least 1"),
        (&["--size", "big"], "WIDTHxHEIGHT"),
        (&["--size", "100000x100000"], "at most"),
        (&["--bounces", "-1"], "or inf"),
        (&["--estimator", "best"], "uniform, cosine, light"),
        (&["--technique", "phong"], "raster, whitted, path, photon, light-tracing, metropolis or normals"),
        (&["--eye", "1,2"], "three finite numbers"),
        (&["--sun-radius", "90"], "from 0 to below 90"),
    ];
    for (extra, word) in cases {
        let arguments = [&["render", "whitted", "-o", out], extra].concat();
        assert_refused(&arguments, 2, &[extra[0], extra[1], word]);
    }
    assert_refused(&["render", "whitted", "-o", "out.jpg"], 2, &[".png or .exr", "out.jpg"]);
    assert_refused(&["render", "whitted"], 2, &["-o"]);
    assert_refused(&["render", "whitted", "-o", out, "--denoise"], 2, &["--denoise"]);
    assert_refused(&["compare"], 2, &["two pictures", "with its reference"]);
    assert_refused(&["reference", "cornell"], 2, &["-o OUT.exr"]);
    assert_refused(&["reference", "cornell", "-o", out], 2, &["must end in .exr", "out.png"]);
    assert_refused(&["reference", "cornell", "-o", "o.exr", "--noise", "0"], 2, &["relMSE above 0"]);
    assert_refused(&["reference", "--size", "8x8"], 2, &["needs a scene"]);
    assert_refused(&["reference", "cornell", "--clear"], 2, &["--clear", "nothing else"]);
    assert_refused(&["reference", "cornell", "-o", "o.exr", "--spp", "4"], 2, &["--spp"]);
    assert_refused(&["render", "whitted", "-o", out, "--size", "1\n2"], 2, &["WIDTHxHEIGHT"]);
    assert_refused(&["render", "whitted", "-o", out, "--time", "1e30"], 2, &["at most 1e9"]);
    assert_refused(&["check", "--case", "99"], 2, &["--case 99", "from 1 to 31"]);
    assert_refused(&["check", "--device", "tpu"], 2, &["auto, cpu or gpu"]);
    assert_refused(&["check", "--device", "gpu", "--case", "22"], 1, &["no graphics device renders these cases"]);
    let branches = ["render", "cornell", "-o", out, "--branches", "16", "--bounces", "9"];
    assert_refused(&branches, 2, &["fewer directions or fewer bounces"]);
    let chains = ["render", "cornell", "-o", out, "--technique", "metropolis", "--estimator", "guided"];
    assert_refused(&chains, 2, &["--estimator guided: a guide is learned for paths, not for chains"]);
    assert_refused(&["render", "cornell", "-o", out, "--branches", "2"], 2, &["limit of bounces"]);
    assert_refused(&["render", "cornell", "-o", out, "--depth", "65"], 2, &["from 0 to 64"]);
    assert_refused(&["render", "cornell", "-o", out, "--segments", "2"], 2, &["from 3 to 512"]);
    assert_refused(&["render", "hard/none", "-o", out], 1, &["hard/? lists"]);
    assert_refused(&["render", "hard/?", "-o", out], 1, &["hard/slab"]);
    assert_refused(&["whitted", "--device", "tpu"], 2, &["--device tpu", "auto, cpu or gpu"]);
    assert_refused(&["render", "whitted", "-o", out, "--refraction-ratio", "0,6"], 2, &["a decimal point: write 0.6"]);
    assert_refused(&["render", "whitted", "-o", out, "--fov", "22,5"], 2, &["a decimal point: write 22.5"]);
    assert_refused(&["render", "whitted", "-o", out, "--eye", "1,5,2,3"], 2, &["decimal points, the commas between"]);
    assert_refused(&["render", "whitted", "-o", out, "--bouncs", "2"], 2, &["'--bouncs': did you mean --bounces?"]);
    assert_refused(&["compare", out, out, "--bouncs", "2"], 2, &["invalid option '--bouncs' (visavis --help"]);
    assert_refused(&["bench", "--quick"], 2, &["-o DIR"]);
    assert_refused(&["bench", "-o", out, "--time", "0"], 2, &["seconds from 1"]);
    assert_refused(&["bench", "-o", out, "--scene", "teapot"], 2, &["teapot", "cornell or whitted"]);
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn bad_scenes_fail_with_the_place_and_write_nothing() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let render = |scene: &str| vec!["render".to_owned(), scene.to_owned(), "-o".into(), out.to_str().unwrap().into()];
    let refused = |scene: &str, words: &[&str]| {
        let arguments = render(scene);
        assert_refused(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), 1, words);
    };
    refused("nonsense", &["unknown scene 'nonsense'", "whitted, cornell, phong"]);
    refused("missing.toml", &["missing.toml", "cannot read"]);
    let broken = folder.file("broken.toml");
    for (text, words) in [
        ("[camera\n", &["broken.toml:1:8", "expected"][..]),
        ("[camera]\neye = [0, nan, 0]\n", &["broken.toml:2:11", "finite number"][..]),
        ("[camera]\neye = [0, 0, 1]\ntarget = [inf, 0, 0]\n", &["broken.toml:3:11", "finite number"][..]),
    ] {
        std::fs::write(&broken, text).unwrap();
        refused(broken.to_str().unwrap(), words);
    }
    assert_eq!(folder.names(), ["broken.toml"]);
}

/// What is allowed but seldom meant is told beside the picture, which is made.
#[test]
fn a_scene_without_light_is_rendered_with_a_note() {
    let folder = TestFolder::new();
    let (scene, out) = (folder.file("dark.toml"), folder.file("out.png"));
    let lit = scene::builtin::text("cornell").unwrap();
    std::fs::write(&scene, lit.replace("radiance = [30, 30, 30]", "radiance = [0, 0, 0]")).unwrap();
    let [scene, out] = [&scene, &out].map(|path| path.to_str().unwrap());
    let made = visavis(&["render", scene, "-o", out, "--size", "4x4", "--spp", "1", "--device", "cpu"]);
    let said = String::from_utf8_lossy(&made.stderr);
    let notes: Vec<&str> = said.lines().filter(|line| line.starts_with("note: ")).collect();
    assert!(notes.len() == 1 && notes[0].contains("no light, so that all is black: add [sky]"), "{said}");
    assert!(made.status.success() && folder.names().contains(&"out.png".to_owned()));
}

#[test]
fn what_is_not_a_file_is_no_scene_and_no_picture() {
    assert_refused(&["render", "/dev/zero", "-o", "out.png"], 1, &["not a file", "/dev/zero"]);
    let folder = TestFolder::new();
    let socket = folder.file("socket.png");
    let _socket = std::os::unix::net::UnixListener::bind(&socket).expect("a socket");
    let out = socket.to_str().unwrap();
    assert_refused(&["render", "cornell", "--size", "8x8", "--spp", "1", "-o", out], 1, &["not a file", "socket.png"]);
}

#[test]
fn a_link_to_a_picture_stays_a_link() {
    let folder = TestFolder::new();
    let (real, link) = (folder.file("real.png"), folder.file("link.png"));
    std::os::unix::fs::symlink(&real, &link).expect("a link");
    for _ in 0..2 {
        let render = ["render", "cornell", "--size", "8x8", "--spp", "1", "-o", link.to_str().unwrap()];
        assert!(visavis(&render).status.success());
        assert!(link.is_symlink() && real.is_file());
    }
    assert_eq!(folder.names(), ["link.png", "real.png"]);
}

#[test]
fn output_that_cannot_be_written_fails_before_rendering() {
    let start = std::time::Instant::now();
    let spp = ["--spp", "1000000"];
    assert_refused(
        &[&["render", "cornell", "-o", "/nowhere/at/all/out.exr"][..], &spp].concat(),
        1,
        &["cannot write", "/nowhere"],
    );
    let folder = TestFolder::new();
    std::fs::create_dir(folder.file("taken.png")).unwrap();
    let taken = folder.file("taken.png");
    assert_refused(
        &[&["render", "cornell", "-o", taken.to_str().unwrap()][..], &spp].concat(),
        1,
        &["folder", "taken.png"],
    );
    assert!(start.elapsed().as_secs() < 10);
}

#[test]
fn a_camera_that_sees_nothing_is_refused() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    assert_refused(
        &["render", "cornell", "-o", out.to_str().unwrap(), "--eye", "278,278,0"],
        1,
        &["camera", "eye and target must differ"],
    );
}

#[test]
fn a_raster_beyond_the_device_limit_names_the_limit() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let output =
        visavis(&["render", "cornell", "--technique", "raster", "--size", "60000x8", "-o", out.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    // the driver may have complained before about its own surroundings
    let line = said.lines().last().unwrap_or_default();
    assert!(line.starts_with("visavis: ") && line.contains("60000") && line.contains("at most"), "{said}");
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn without_a_display_the_viewer_names_the_headless_command() {
    assert_refused(&[], 1, &["display", "visavis render whitted -o"]);
}

#[test]
fn with_no_adapter_the_raster_says_what_to_install_and_the_tracer_works() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let run = |technique: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_visavis"));
        // only an interface that this system does not have
        command.env("WGPU_BACKEND", "dx12").args(["render", "cornell", "--size", "8x8", "--spp", "1"]);
        command.args(["--technique", technique, "-o", out.to_str().unwrap()]).output().expect("the program")
    };
    let refused = run("raster");
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{said}");
    assert!(said.contains("mesa-vulkan-drivers"), "{said}");
    assert!(!out.exists());
    assert!(run("path").status.success());
    assert_eq!(folder.names(), ["out.png"]);
}

#[test]
fn render_reports_every_field_of_the_contract() {
    let folder = TestFolder::new();
    let out = folder.file("c.exr");
    let output = visavis(&[
        "render",
        "cornell",
        "--size",
        "32x24",
        "--spp",
        "4",
        "--seed",
        "7",
        "--json",
        "-o",
        out.to_str().unwrap(),
    ]);
    let report = json(&output);
    for field in ["scene", "technique", "device", "adapter", "seconds", "samples_per_second", "rays_per_second"] {
        assert!(!report[field].is_null(), "{field}");
    }
    assert_eq!((&report["width"], &report["height"], &report["spp"]), (&32.into(), &24.into(), &4.into()));
    assert_eq!((&report["nonfinite"], &report["seed"]), (&0.into(), &7.into()));
    assert_eq!(report["mean"].as_array().map(Vec::len), Some(3));
}

#[test]
fn one_seed_is_one_picture_and_exr_keeps_it_exactly() {
    let folder = TestFolder::new();
    let [a, b, c] = ["a.exr", "b.exr", "c.exr"].map(|name| folder.file(name).to_str().unwrap().to_owned());
    for (out, seed) in [(&a, "5"), (&b, "5"), (&c, "6")] {
        let size = ["--size", "24x24", "--spp", "8", "--seed", seed];
        assert!(visavis(&[&["render", "whitted", "-o", out][..], &size].concat()).status.success());
    }
    assert_eq!(json(&visavis(&["compare", &a, &b, "--json"]))["rmse"], 0.0);
    assert!(json(&visavis(&["compare", &a, &c, "--json"]))["rmse"].as_f64() > Some(0.0));
}

#[test]
fn both_fakes_render_and_a_png_is_near_its_exr() {
    let folder = TestFolder::new();
    let [png, exr] = ["a.png", "a.exr"].map(|name| folder.file(name).to_str().unwrap().to_owned());
    for out in [&png, &exr] {
        let size = ["--size", "64x36", "--technique", "raster", "--fake", "as-taught"];
        assert!(visavis(&[&["render", "whitted", "-o", out][..], &size].concat()).status.success());
    }
    // as taught, the film holds the light that its bytes emit: the PNG holds exactly those bytes
    assert!(json(&visavis(&["compare", &png, &exr, "--json"]))["rmse"].as_f64() < Some(1e-6));
}

#[test]
fn help_lists_every_option_and_exits_well() {
    let output = visavis(&["--help"]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success());
    let options = "technique device size seed spp bounces roulette estimator refraction-ratio sun-radius fake eye target fov \
                   exposure time json quick help version errors noise clear";
    for option in options.split_whitespace().map(|name| format!("--{name}")) {
        assert!(text.contains(&option), "{option}");
    }
    assert!(visavis(&["--version"]).status.success());
    assert!(visavis(&["info"]).status.success());
}

#[test]
fn a_preset_sets_a_slide_and_other_options_change_it() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let out = out.to_str().expect("a plain path");
    let common = ["render", "cornell", "-o", out, "--size", "8x8", "--json", "--preset", "2e-1-bounce"];
    let stated = json(&visavis(&common));
    assert_eq!((&stated["technique"], &stated["spp"]), (&"path".into(), &20.into()));
    let words = ["estimator", "bounces", "roulette", "sampler"].map(|name| stated[name].as_str());
    assert_eq!(words, [Some("light"), Some("1"), Some("off"), Some("independent")]);
    let changed = json(&visavis(&[&common, &["--spp", "2", "--bounces", "inf"][..]].concat()));
    assert_eq!((&changed["spp"], &changed["bounces"], &changed["roulette"]), (&2.into(), &"inf".into(), &"off".into()));
    let before = json(&visavis(&[&["render", "cornell", "--spp", "2"], &common[2..]].concat()));
    assert_eq!((&before["spp"], &before["bounces"]), (&2.into(), &"1".into()), "wherever it stands");
    let technique = ["render", "cornell", "-o", out, "--preset", "2e-1-bounce", "--technique", "whitted"];
    assert_refused(&technique, 2, &["--preset 2e-1-bounce is a setting of path"]);
    assert_refused(&["render", "--from", out, "-o", out, "--preset", "fair"], 2, &["--preset and --from"]);
    assert_refused(
        &["render", "cornell", "-o", out, "--preset", "3a"],
        2,
        &["--preset 3a", "2e-1-bounce, 2e-2-bounces"],
    );
}

#[test]
fn every_technique_and_option_renders() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let out = out.to_str().expect("a plain path");
    let options: [&[&str]; 13] = [
        &[
            "--technique",
            "whitted",
            "--depth",
            "3",
            "--glass-shadows",
            "clear",
            "--shadow-rays",
            "4",
            "--ambient",
            "0.1",
        ],
        &["--estimator", "mis", "--sampler", "independent"],
        &["--estimator", "uniform-light", "--roulette", "0.9+throughput"],
        &["--estimator", "uniform-mis", "--branches", "2", "--bounces", "2", "--roulette", "off"],
        &["--technique", "raster", "--shading", "phong", "--shininess", "5", "--ambient", "0.5", "--segments", "12"],
        &["--technique", "raster", "--shading", "blinn-phong", "--diffuse", "0.5", "--specular", "0.3"],
        &["--technique", "raster", "--shadow-filter", "hard", "--shadow-bias", "-0.001", "--shadow-map", "64"],
        &["--technique", "raster", "--show", "cube-faces", "--cube-map", "16", "--reflectivity", "0.5"],
        &["--technique", "raster", "--show", "shadow-map", "--fake", "as-taught"],
        &["--technique", "raster", "--show", "albedo", "--fake", "as-taught"],
        &["--show", "depth", "--spp", "4"],
        &["--technique", "photon", "--show", "normal", "--spp", "4"],
        &["--technique", "metropolis", "--show", "albedo", "--spp", "4"],
    ];
    for extra in options {
        let common = ["render", "whitted", "-o", out, "--size", "48x27", "--json"];
        let report = json(&visavis(&[&common, extra].concat()));
        assert_eq!(report["nonfinite"], 0, "{extra:?}");
        assert!(report["mean"][1].as_f64() > Some(0.01), "{extra:?}: {report}");
    }
}
