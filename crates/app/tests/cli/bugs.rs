//! Bugs on purpose: a picture says which it was made with, or that one is hidden, and no reference has any.

use super::{assert_refused, visavis};
use pathtrace::Bugs;
use std::path::Path;
use visavis_tests::TestFolder;

fn render(out: &Path, words: &[&str]) {
    let out = out.display().to_string();
    let usual = ["render", "cornell", "-o", &out, "--technique", "path", "--size", "32x24", "--spp", "2"];
    let output = visavis(&[&usual, words].concat());
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
}

fn pixels(file: &Path) -> image::RgbaImage {
    image::open(file).expect("a picture").to_rgba8()
}

#[test]
fn a_picture_with_bugs_keeps_their_names_and_is_made_again() {
    let folder = TestFolder::new();
    let [truth, broken, again] = ["truth.png", "broken.png", "again.png"].map(|name| folder.file(name));
    render(&truth, &[]);
    render(&broken, &["--bugs", "width-twice,no-cosine"]);
    let records = image_file::records(&broken).expect("records");
    let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
    assert_eq!(value("bugs"), Some("no-cosine+width-twice"));
    assert!(value("command").is_some_and(|command| command.contains("--bugs no-cosine+width-twice")), "{records:?}");
    assert!(image_file::records(&truth).expect("records").iter().all(|(name, _)| name != "bugs" && name != "find-bug"));
    let [from, out] = [&broken, &again].map(|file| file.display().to_string());
    assert!(visavis(&["render", "--from", &from, "-o", &out]).status.success());
    assert!(pixels(&again) == pixels(&broken) && pixels(&broken) != pixels(&truth));
    let truth = truth.display().to_string();
    let told = |a: &str, b: &str| String::from_utf8_lossy(&visavis(&["compare", a, b]).stderr).into_owned();
    assert!(told(&from, &truth).contains("A has bugs on (no-cosine+width-twice)"), "{}", told(&from, &truth));
    assert!(told(&truth, &from).contains("the truth is broken"), "{}", told(&truth, &from));
}

#[test]
fn a_file_does_not_tell_which_bug_is_hidden_and_makes_the_picture_again() {
    let folder = TestFolder::new();
    let [hidden, again] = ["hidden.png", "again.png"].map(|name| folder.file(name));
    render(&hidden, &["--find-bug", "7"]);
    let records = image_file::records(&hidden).expect("records");
    assert!(records.contains(&("find-bug".into(), "7".into())), "{records:?}");
    for name in Bugs::names() {
        assert!(records.iter().all(|(_, value)| !value.contains(name)), "{name} is told: {records:?}");
    }
    let [from, out] = [&hidden, &again].map(|file| file.display().to_string());
    assert!(visavis(&["render", "--from", &from, "-o", &out]).status.success());
    assert!(pixels(&again) == pixels(&hidden));
}

#[test]
fn bugs_that_are_none_are_refused_and_references_have_none() {
    let folder = TestFolder::new();
    let out = folder.file("a.png").display().to_string();
    let render = ["render", "cornell", "-o", &out, "--technique", "path"];
    assert_refused(&[&render[..], &["--bugs", "glue"]].concat(), 2, &["--bugs", "no-cosine", "with + between"]);
    let guided = ["--bugs", "no-pdf", "--estimator", "guided"];
    assert_refused(&[&render[..], &guided].concat(), 2, &["plain path tracer", "guide"]);
    assert_refused(&["reference", "cornell", "--bugs", "no-pdf"], 2, &["--bugs"]);
    assert!((0..9).all(|seed| !reference::Maker::settings(seed).is_broken()));
}
