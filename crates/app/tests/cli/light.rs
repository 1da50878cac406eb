//! Pictures of a part of the light.

use super::{assert_refused, program, visavis};
use film::{DisplayTransform, Image};
use image_file::{Kind, Records};
use std::path::Path;
use visavis_tests::TestFolder;

fn film(path: &str) -> Image {
    image_file::load(Path::new(path)).expect("an EXR")
}

#[test]
fn parts_add_up_say_what_they_are_and_are_made_again() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let [all, direct, indirect, again] = ["all.exr", "direct.exr", "indirect.exr", "again.exr"].map(file);
    for (light, out) in [("all", &all), ("direct", &direct), ("indirect", &indirect)] {
        let words =
            ["render", "whitted", "--size", "40x30", "--spp", "4", "--device", "cpu", "--light", light, "-o", out];
        assert!(visavis(&words).status.success());
    }
    let [whole, parts] = [film(&all), film(&direct)].map(|image| image.radiances().to_vec());
    for ((whole, direct), indirect) in whole.iter().zip(parts).zip(film(&indirect).radiances()) {
        let off = (*whole - direct - *indirect).abs().max_element();
        assert!(off < 2e-5 * whole.max_element().max(0.1), "{whole} is not {direct} and {indirect}");
    }
    let records = image_file::records(Path::new(&direct)).expect("records");
    assert!(records.iter().any(|(name, value)| name == "light" && value == "direct"), "{records:?}");
    assert!(visavis(&["render", "--from", &direct, "-o", &again]).status.success());
    assert!(film(&direct) == film(&again) && film(&direct) != film(&all));
    assert_refused(&["compare", &direct], 1, &["a part of the light (--light direct)"]);
}

#[test]
fn what_is_no_path_and_what_has_no_error_is_refused_and_what_does_not_act_is_told() {
    let folder = TestFolder::new();
    let out = folder.file("out.exr");
    let out = out.to_str().expect("a plain path");
    assert_refused(&["render", "cornell", "--light", "LDxE", "-o", out], 2, &["--light LDxE", "column 3"]);
    assert_refused(&["render", "cornell", "--light", "LDE", "--errors", "-o", out], 1, &["a part of the light"]);
    assert!(!Path::new(out).exists());
    let photons =
        ["render", "cornell", "--size", "8x8", "--spp", "1", "--technique", "photon", "--light", "LDE", "-o", out];
    let said = String::from_utf8_lossy(&visavis(&photons).stderr).into_owned();
    assert!(said.contains("note: --light has no effect with --technique photon"), "{said}");
}

#[test]
fn pictures_of_other_light_are_not_compared_and_those_of_the_same_are() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let [all, direct, whitted, indirect] = ["all.exr", "direct.exr", "whitted.exr", "indirect.exr"].map(file);
    let pictures = [
        (&all, "path", "all"),
        (&direct, "path", "direct"),
        (&whitted, "whitted", "direct"),
        (&indirect, "path", "indirect"),
    ];
    for (out, technique, light) in pictures {
        let size = ["render", "cornell", "--size", "16x12", "--spp", "2", "--device", "cpu"];
        let words = [&size[..], &["--technique", technique, "--light", light, "-o", out]].concat();
        assert!(visavis(&words).status.success());
    }
    let reference = file("reference.exr");
    let words = ["reference", "cornell", "--size", "16x12", "--noise", "1", "-o", &reference];
    let made = program().args(words).env("VISAVIS_CACHE", folder.file("store")).output().expect("the program");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let map = file("map.png");
    let refused = [(&direct, &indirect), (&direct, &all), (&all, &direct), (&direct, &reference)];
    for (a, b) in refused {
        let said = ["show other parts of the light (--light ", "compare pictures of the same part", a, b];
        assert_refused(&["compare", a, b, "--heatmap", &map], 1, &said);
    }
    assert!(!Path::new(&map).exists());
    // a picture without records is taken for what it is compared with
    let plain = file("plain.exr");
    let bytes = image_file::encode(Kind::Exr, &film(&direct), &DisplayTransform::default(), &Records::new());
    std::fs::write(&plain, bytes.expect("an EXR")).expect("a file");
    for (a, b) in [(&direct, &whitted), (&all, &reference), (&direct, &plain), (&plain, &reference)] {
        let compared = visavis(&["compare", a, b]);
        assert!(compared.status.success(), "{a} {b}: {}", String::from_utf8_lossy(&compared.stderr));
    }
}
