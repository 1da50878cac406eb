//! Scenes come and go, and are shown as they are.

use super::{User, both_whole, says};
use egui::Key;
use visavis_tests::Frame;

#[test]
fn scenes_change_and_controls_that_do_not_apply_go() {
    let mut user = User::of("cornell");
    let first = user.wait_for("both pictures", both_whole);
    assert!(!first.shows("refraction ratio") && !first.shows("sun radius"));
    let limited = user.set_slider("Bounces", 2.0);
    assert!(limited.shows("B bounces"));
    user.click("Scene: cornell");
    user.click("whitted");
    user.wait_for("the other scene", |f| f.state("scene") == "whitted" && f.shows("refraction ratio") && both_whole(f));

    // a file by its name, typed: letters must not act as shortcuts
    let typed = user.open("thc");
    assert_eq!(typed.state("view"), "Wipe");
    let refused = user.wait_for("the refusal", |f| says(f, "thc"));
    assert!(says(&refused, "whitted, cornell"));
    assert_eq!(refused.state("scene"), "whitted");

    let whole = user.wait_for("both pictures", both_whole).rect("picture");
    user.click("Side by side");
    let halved = user.wait_for("both pictures side by side", |f| {
        f.state("picture_size")[0].as_f64() < Some(0.5 * f64::from(whole[2] - whole[0]))
    });
    assert_eq!(halved.rect("picture"), whole, "the area stays, the pictures share it");
    user.wait_for("an error between them", |f| f.state("a")["rel_mse"].is_number() && f.state("b")["rough"] == false);
    user.click("Wipe");
    for (width, height) in [(900.0, 500.0), (500.0, 330.0), (1100.0, 700.0)] {
        user.resize(egui::vec2(width, height));
    }
    let resized = user.wait_for("pictures of the new size", |f| {
        both_whole(f) && f.rect("picture")[3] > 650.0 && f.rect("picture")[3] <= 700.0
    });
    assert!(resized.rect("controls")[2] <= 1100.0);
}

/// Numbers beyond a slider's range and between its steps stay as the file has them, and the truth comes to rest.
#[test]
fn showing_a_scene_does_not_change_it() {
    let folder = visavis_tests::TestFolder::new();
    let file = folder.file("odd.toml");
    let text = r#"
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
fov_y = 45
[sky]
radiance = [0.3, 0.5, 0.9]
[sun]
towards = [0, 1, 0]
angular_radius = 12.34
irradiance = [1, 1, 1]
[material.bubble]
dielectric = { ior = 0.75 }
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "bubble"
"#;
    std::fs::write(&file, text).expect("the scene file");
    let mut user = User::of(file.to_str().expect("a plain path"));
    let settled = |f: &Frame| f.state("b")["rough"] == false && f.state("b")["spp"].as_u64() >= Some(4);
    let frame = user.wait_for("the truth to refine", settled);
    assert_eq!(frame.value("sun radius"), "12.34");
    assert!(frame.value("refraction ratio").starts_with("1.333"), "{}", frame.value("refraction ratio"));
    assert_eq!(frame.value("A reflectivity"), "1");
}

/// A picture that is black for a reason says the reason, until a key or a click has seen it.
#[test]
fn opening_a_scene_says_what_is_probably_not_meant() {
    let folder = visavis_tests::TestFolder::new();
    let file = folder.file("dark.toml");
    let lit = scene::builtin::text("cornell").expect("a built-in scene");
    std::fs::write(&file, lit.replace("radiance = [30, 30, 30]", "radiance = [0, 0, 0]")).expect("the scene file");
    let mut user = User::of("whitted");
    user.wait_for("both pictures", both_whole);
    user.open(file.to_str().expect("a plain path"));
    let opened = user.wait_for("the note", |f| says(f, "the scene has no light, so that all is black"));
    assert_eq!(opened.state("scene"), "dark");
}

#[test]
fn a_presenters_remote_does_nothing_by_itself() {
    let mut user = User::of("cornell");
    let first = user.wait_for("both pictures", both_whole);
    for key in [Key::PageUp, Key::PageDown, Key::F5, Key::Period, Key::Escape] {
        user.key(key);
    }
    let after = user.key(Key::Num4);
    assert_eq!(after.state("view"), "Side by side", "the key that does something");
    for state in ["scene", "line", "wipe", "paused", "theme", "eye", "message"] {
        assert_eq!(after.state(state), first.state(state), "{state}");
    }
}
