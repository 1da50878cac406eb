//! Which effect of light has how much of an error.

use super::{assert_refused, json, visavis};
use visavis_tests::TestFolder;

#[test]
fn the_error_is_shared_among_the_effects_of_the_scene_that_the_picture_shows_and_they_are_named_on_its_map() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let [dark, truth, plain, named, stripped] =
        ["dark.exr", "truth.exr", "plain.png", "named.png", "stripped.png"].map(file);
    let render = |out: &str, extra: &[&str]| {
        let words = ["render", "whitted", "--size", "160x90", "--device", "cpu", "--spp", "16", "-o", out];
        assert!(visavis(&[&words[..], extra].concat()).status.success());
    };
    render(&truth, &[]);
    // without connections and by light sampling alone, what glass focuses is missing
    render(&dark, &["--estimator", "light", "--connections", "off", "--traced-sun", "0"]);
    let report = json(&visavis(&["compare", &dark, &truth, "--effects", "--json", "--heatmap", &named]));
    let effects = report["effects"].as_array().expect("effects");
    let sum = |key: &str| effects.iter().filter_map(|effect| effect[key].as_f64()).sum::<f64>();
    assert!((sum("pixels") - 1.0).abs() < 1e-9 && (sum("error") - 1.0).abs() < 1e-9, "{report}");
    let of = |name: &str| effects.iter().find(|effect| effect["effect"] == name).expect("an effect of whitted");
    assert!(of("caustic")["error"].as_f64() > Some(0.2), "{report}");
    assert_eq!(of("sky")["title"], "Sky");
    let told = visavis(&["compare", &dark, &truth, "--effects", "--heatmap", &plain]);
    assert!(String::from_utf8_lossy(&told.stdout).contains("effect    Caustic: "), "{told:?}");
    // the same map, and once without what is written on it
    let bytes = |file: &str| image::open(file).expect("a PNG").to_rgb8();
    assert_eq!(bytes(&plain), bytes(&named));
    assert!(visavis(&["compare", &dark, &truth, "--heatmap", &plain]).status.success());
    let (without, with) = (bytes(&plain), bytes(&named));
    assert_eq!(without.dimensions(), with.dimensions());
    let written = without.pixels().zip(with.pixels()).filter(|(a, b)| a != b).count();
    assert!((200..8000).contains(&written), "{written} pixels");
    image::open(&plain).expect("a PNG").crop_imm(0, 0, 160, 90).save(&stripped).expect("a PNG");
    assert_refused(&["compare", &stripped, &truth, "--effects"], 1, &["--effects", "does not say how it was made"]);
}
