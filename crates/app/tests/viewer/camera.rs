//! Where one looks from.

use super::{User, both_whole};
use egui::{Key, Modifiers};

#[test]
fn the_camera_dollies_zooms_is_typed_kept_and_reset() {
    let mut user = User::of("cornell");
    let first = user.wait_for("both pictures", both_whole);
    let middle = first.point("picture", 0.3, 0.5);
    let nearer = user.wheel(middle, Modifiers::NONE);
    assert_ne!(nearer.state("eye"), first.state("eye"), "the wheel dollies");
    assert_eq!(nearer.state("fov"), first.state("fov"));
    let zoomed = user.wheel(middle, Modifiers::COMMAND);
    assert!(zoomed.state("fov").as_f64() < first.state("fov").as_f64(), "with Ctrl it zooms");

    assert!(zoomed.shows("field of view") && !first.shows("field of view"), "its card unfolds once it is used");
    let marked = user.click("Bookmark");
    let place = marked.state("eye").clone();
    let reset = user.key(Key::C);
    assert_eq!(reset.state("eye"), first.state("eye"), "the scene's camera");
    let back = user.click("Place 1");
    assert_eq!(back.state("eye"), &place);

    let typed = user.type_number("Field of view", "60");
    assert_eq!(typed.state("fov"), 60.0);
}

/// Planes follow the camera where they are fitted; stated ones are obeyed, and the label says what they cut.
#[test]
fn a_label_says_where_stated_planes_cut_the_fake_and_dollying_changes_it() {
    let folder = visavis_tests::TestFolder::new();
    let file = folder.file("near.toml");
    let text = scene::builtin::text("hard/ball-on-floor").expect("an embedded scene");
    std::fs::write(&file, text.replace("fov_y = 40", "fov_y = 40\nnear = 2.5")).expect("the scene file");
    let mut user = User::of(file.to_str().expect("a plain path"));
    let first = user.wait_for("both pictures", both_whole);
    assert_eq!(first.state("a")["cut"], serde_json::Value::Null);
    let middle = first.point("picture", 0.3, 0.5);
    for _ in 0..8 {
        user.wheel(middle, Modifiers::NONE);
    }
    let frame = user.wait_for("a cut", |f| f.state("a")["cut"].is_string());
    let line = frame.state("a")["cut"].as_str().expect("a line");
    assert_eq!(line, "the camera's near (2.5) cuts parts of the scene");
    assert!(frame.value("label A").contains(line), "{}", frame.value("label A"));
}
