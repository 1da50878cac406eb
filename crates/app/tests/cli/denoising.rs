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
