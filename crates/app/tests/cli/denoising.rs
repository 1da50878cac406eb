//! Pictures that a filter took the noise out of.

use super::{assert_refused, json, visavis};
use film::Image;
use visavis_tests::TestFolder;

fn film(path: &str) -> Image {
    image_file::load(std::path::Path::new(path)).expect("an EXR")
}

#[test]
fn a_denoised_picture_is_nearer_to_the_truth_says_by_what_and_is_made_again() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let [truth, noisy, first, again] = ["truth.exr", "noisy.exr", "first.exr", "again.exr"].map(file);
    let clean = ["render", "cornell", "--size", "64x64", "--spp", "256", "-o", &truth];
    assert!(visavis(&clean).status.success());
    let error = |path: &str| compare::errors(&film(path), &film(&truth)).expect("pictures of one size").rel_mse;
    let options = |out: &str, denoiser: &str| {
        let words = ["render", "cornell", "--size", "64x64", "--spp", "4", "--json", "-o", out, "--denoise", denoiser];
        json(&visavis(&words))
    };
    let raw = options(&noisy, "off");
    assert!(raw.get("denoised").is_none());
    for denoiser in ["unet", "unet-base"] {
        let report = options(&first, denoiser);
        assert_eq!(report["denoised"]["by"], denoiser);
        assert!(report["denoised"]["seconds"].as_f64().is_some_and(|seconds| seconds > 0.0), "{report}");
        // a quarter to a third is left: pixels are few, and the lamp's edge is most of it; the truth's own noise is a fiftieth
        assert!(error(&first) < 0.5 * error(&noisy), "{denoiser}: {} after {}", error(&first), error(&noisy));
        let records = image_file::records(std::path::Path::new(&first)).expect("records");
        let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
        assert_eq!(value("denoise"), Some(denoiser));
        assert!(value("denoise.adapter").is_some_and(|by| by.contains("thread")), "{records:?}");
        assert_eq!(report["denoised"]["adapter"].as_str(), value("denoise.adapter"));
        assert!(value("denoise.weights").is_some_and(|hash| hash.len() >= 32), "{records:?}");
        assert!(visavis(&["render", "--from", &first, "-o", &again]).status.success());
        assert!(film(&first) == film(&again), "{denoiser}");
    }
}

#[test]
fn what_shows_no_light_and_what_is_no_denoiser_is_not_denoised() {
    let folder = TestFolder::new();
    let out = folder.file("out.exr");
    let out = out.to_str().expect("a plain path");
    assert_refused(&["render", "cornell", "-o", out, "--denoise", "median"], 2, &["--denoise", "atrous", "unet"]);
    let normals = ["render", "cornell", "--size", "8x8", "--technique", "normals", "--denoise", "unet", "-o", out];
    let made = visavis(&normals);
    assert!(made.status.success());
    assert!(String::from_utf8_lossy(&made.stderr).contains("--denoise has no effect"));
}

/// A small picture of the Cornell box by the processor, and what the program said.
fn render(words: &[&str], out: &str) -> String {
    let small = ["render", "cornell", "--size", "40x30", "--device", "cpu", "-o", out];
    let output = visavis(&[&small, words].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    said
}

fn record(file: &str, name: &str) -> Option<String> {
    let records = image_file::records(std::path::Path::new(file)).expect("records");
    records.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
}

#[test]
fn a_mean_of_runs_says_of_how_many_and_is_made_again() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let [runs, again, one, two] = ["runs.exr", "again.exr", "one.exr", "two.exr"].map(file);
    let said = render(&["--spp", "2", "--runs", "2", "--seed", "7", "--denoise", "unet"], &runs);
    assert!(said.contains("the mean of 2 of 2 runs of 2 spp"), "{said}");
    assert_eq!(
        ["runs", "spp", "seed"].map(|name| record(&runs, name)),
        ["2", "2", "7"].map(|value| Some(value.into()))
    );
    assert!(visavis(&["render", "--from", &runs, "-o", &again]).status.success());
    assert!(film(&runs) == film(&again));
    render(&["--spp", "2", "--seed", "7", "--denoise", "unet"], &one);
    render(&["--spp", "2", "--seed", "8", "--denoise", "unet"], &two);
    let (one, two) = (film(&one), film(&two));
    let mean = one.radiances().iter().zip(two.radiances()).map(|(a, b)| 0.5 * (*a + *b));
    let rounding = 1e-6;
    assert!(film(&runs).radiances().iter().zip(mean).all(|(a, b)| (*a - b).length() <= rounding * (1.0 + b.length())));
    let small = ["render", "cornell", "--size", "8x8", "--runs", "3", "--spp", "2", "--json", "-o", &again];
    let report = json(&visavis(&small));
    assert_eq!((&report["runs"], &report["spp"], &report["samples"]), (&3.into(), &2.into(), &(8 * 8 * 6).into()));
}

/// The time is over before the first has begun: of that one there is what a pass has made.
#[test]
fn a_limit_of_time_ends_runs_and_the_records_say_how_many_there_were() {
    let folder = TestFolder::new();
    let out = folder.file("out.exr");
    let out = out.to_str().expect("a plain path");
    let said = render(&["--runs", "64", "--time", "0.000001", "--denoise", "unet"], out);
    assert!(said.contains("the mean of 1 of 64 runs of 1 spp"), "{said}");
    assert_eq!((record(out, "runs"), record(out, "spp").as_deref()), (None, Some("1")), "one is the default");
}

#[test]
fn halves_of_the_samples_are_layers_whose_records_say_how_many_they_have() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let [five, one, view] = ["five.exr", "one.exr", "view.png"].map(file);
    let layers = |path: &str| {
        let size = film(path).size();
        image_file::load_layers(std::path::Path::new(path), size).expect("layers")
    };
    render(&["--spp", "5", "--layers"], &five);
    assert_eq!(["half0", "half1"].map(|half| record(&five, &format!("{half}.samples")).expect("a count")), ["2", "3"]);
    let [half0, half1] = ["half0", "half1"].map(|half| layers(&five).triples(half).expect("a half"));
    assert!(half0 != half1);
    let whole = film(&five);
    let mean = half0.iter().zip(&half1).map(|(a, b)| 0.4 * *a + 0.6 * *b);
    assert!(whole.radiances().iter().zip(mean).all(|(a, b)| (*a - b).length() <= 1e-5 * (1.0 + b.length())));
    let said = render(&["--spp", "1", "--layers"], &one);
    assert!(layers(&one).triples("half0").is_none() && !said.contains("note"), "{said}");
    // and of a view of trust, which is of halves
    let said = render(&["--spp", "8", "--denoise", "unet", "--trust", "1", "--show", "trust"], &view);
    assert!(!said.contains("note"), "{said}");
    assert_eq!(record(&view, "show").as_deref(), Some("trust"));
    let errors = ["render", "cornell", "--denoise", "unet", "--trust", "1", "--show", "trust", "--errors", "-o", &view];
    assert_refused(&errors, 1, &["what shows no light has no errors"]);
    assert_refused(
        &["render", "cornell", "--technique", "raster", "--show", "trust", "-o", &view],
        2,
        &["--show trust"],
    );
}

#[test]
fn a_setting_that_others_undo_has_no_effect_and_it_is_said() {
    let folder = TestFolder::new();
    let out = folder.file("out.png");
    let out = out.to_str().expect("a plain path");
    let said = render(&["--spp", "1", "--denoise", "unet", "--runs", "2", "--show", "albedo"], out);
    for option in ["--denoise", "--runs"] {
        assert!(said.contains(&format!("note: {option} has no effect with --show albedo")), "{said}");
    }
    assert!(!said.contains("--spp has no effect") && !said.contains("--show has no effect"), "{said}");
    let said = render(&["--spp", "1", "--trust", "1"], out);
    assert!(said.contains("note: --trust has no effect beside the other settings"), "{said}");
    let said = render(&["--spp", "1", "--show", "trust"], out);
    assert!(said.contains("note: --show has no effect beside the other settings"), "{said}");
    // what the picture says of itself was not asked for just now
    let again = visavis(&["render", "--from", out, "--exposure", "1", "-o", out]);
    assert!(!String::from_utf8_lossy(&again.stderr).contains("has no effect"));
}

/// There are none outside the window: nothing of them is in picture or records.
#[test]
fn earlier_views_have_no_effect_on_a_picture_that_has_none() {
    let folder = TestFolder::new();
    let [plain, with] =
        ["plain.exr", "with.exr"].map(|name| folder.file(name).to_str().expect("a plain path").to_owned());
    let render = |out: &str, more: &[&str]| {
        let made = visavis(&[&["render", "cornell", "--size", "8x8", "--spp", "2", "-o", out], more].concat());
        assert!(made.status.success());
        String::from_utf8_lossy(&made.stderr).into_owned()
    };
    assert!(!render(&plain, &[]).contains("--history"));
    assert!(render(&with, &["--history", "8"]).contains("--history has no effect here"));
    assert!(film(&plain) == film(&with));
    let records = image_file::records(std::path::Path::new(&with)).expect("records");
    assert!(records.iter().all(|(name, value)| !name.starts_with("history") && !value.contains("--history")));
}

/// A hash in an EXR's header is replaced by another one of its length.
#[test]
fn a_picture_of_other_weights_is_made_by_todays_and_it_is_said() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let [made, again] = ["made.exr", "again.exr"].map(file);
    render(&["--spp", "1", "--denoise", "unet"], &made);
    let hash = record(&made, "denoise.weights").expect("a hash");
    let from = |more: &[&str]| {
        let said = visavis(&[&["render", "--from", &made, "-o", &again], more].concat());
        assert!(said.status.success());
        String::from_utf8_lossy(&said.stderr).into_owned()
    };
    assert!(!from(&[]).contains("weights"));
    let mut bytes = std::fs::read(&made).expect("bytes");
    let at = bytes.windows(hash.len()).position(|part| part == hash.as_bytes()).expect("the hash");
    bytes[at] = if bytes[at] == b'0' { b'1' } else { b'0' };
    std::fs::write(&made, bytes).expect("written");
    assert!(from(&[]).contains("unet has other weights than when"));
    assert!(!from(&["--denoise", "unet-base"]).contains("weights"), "another network was asked for");
}
