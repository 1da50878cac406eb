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

    user.click("Camera (both)");
    let marked = user.click("Bookmark");
    let place = marked.state("eye").clone();
    let reset = user.key(Key::C);
    assert_eq!(reset.state("eye"), first.state("eye"), "the scene's camera");
    let back = user.click("Place 1");
    assert_eq!(back.state("eye"), &place);

    user.click("Vertical field of view in degrees");
    user.type_into("Vertical field of view in degrees", "60");
    let typed = user.key(Key::Enter);
    assert_eq!(typed.state("fov"), 60.0);
}
