//! The effects of light on a real error map.

use super::{User, both_whole};
use egui::Key;
use visavis::model::{Resolution, View};

#[test]
fn effects_are_named_on_the_map_with_their_share_of_its_error_and_follow_the_camera() {
    let mut user = User::of("whitted");
    user.change(|model| {
        model.session.resolution = Resolution::Quarter;
        model.session.view = View::ErrorMap;
    });
    let frame = user.wait_for("the map", |f| f.shows("label map") && both_whole(f));
    assert_eq!(frame.state("effects").as_array().map(Vec::len), Some(0));
    user.key(Key::E);
    let named = |f: &visavis_tests::Frame| {
        f.shows("label effect refraction") && f.state("effects").as_array().is_some_and(|shares| shares.len() > 4)
    };
    let frame = user.wait_for("names", named);
    let shares = frame.state("effects").as_array().cloned().expect("shares");
    let error: f64 = shares.iter().filter_map(|share| share[2].as_f64()).sum();
    assert!((error - 1.0).abs() < 1e-9, "{shares:?}");
    assert!(frame.value("label effect refraction").starts_with("Refraction "));
    user.change(|model| model.document.camera.fov_y += 5.0);
    user.frame();
    let frame = user.frame();
    assert_eq!(frame.state("effects").as_array().map(Vec::len), Some(0), "those of before are of another view");
    user.wait_for("names again", named);
    user.key(Key::E);
    user.frame();
    assert!(!user.frame().shows("label effect refraction"));
}
