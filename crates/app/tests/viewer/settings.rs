//! A change of a setting: what it brings, what it keeps, and that it can be taken back.

use super::{User, both_whole};
use egui::{Key, Modifiers};
use visavis::model::PaneId;
use visavis_tests::Frame;

fn spp(frame: &Frame) -> Option<u64> {
    frame.state("b")["spp"].as_u64()
}

#[test]
fn either_pane_holds_any_technique() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    user.click_nth("Path", 0);
    user.click_in("A", "cosine");
    let both = user.wait_for("two path-traced pictures, compared", |f| {
        f.state("a")["label"] == "Path tracing, cosine" && f.state("a")["rel_mse"].is_number() && both_whole(f)
    });
    assert_eq!(both.state("b")["label"], "Path tracing, light");
    user.click_nth("Fake", 1);
    let swapped = user.wait_for("the fake in B", |f| f.state("b")["label"] == "Fake, fair" && both_whole(f));
    assert!(swapped.shows("B fake as-taught") && !swapped.shows("B spp"));
}

#[test]
fn a_change_of_a_setting_can_be_taken_back_and_done_again() {
    let mut user = User::of("whitted");
    user.wait_for("both pictures", both_whole);
    let slid = user.set_slider("Refraction ratio", 0.55);
    let moved = slid.value("refraction ratio").to_owned();
    assert_eq!(moved, "0.55");
    user.click_nth("Path", 0);
    user.wait_for("two path-traced pictures", |f| f.state("a")["label"] == "Path tracing, mis" && both_whole(f));
    user.key_with(Key::Z, Modifiers::COMMAND);
    let back = user.wait_for("the fake again", |f| f.state("a")["label"] == "Fake, fair");
    assert_eq!(back.value("undo"), "true");
    let undone = user.key_with(Key::Z, Modifiers::COMMAND);
    assert_eq!([undone.value("refraction ratio"), undone.value("undo")], ["0.7", "false"], "the ratio of before");
    let again = user.key_with(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT);
    assert_eq!(again.value("refraction ratio"), moved);
}

/// Nothing of the picture before is left, whose label would tell of other settings.
#[test]
fn settings_that_cannot_be_rendered_are_told_on_the_picture_until_they_can() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    let set = |user: &User, branches, bounces| {
        let path = &mut user.viewer.borrow_mut().model.session.panes[PaneId::B].truth.path;
        (path.branches, path.bounces) = (branches, bounces);
    };
    set(&user, 2, None);
    let told = user.wait_for("the refusal", |f| f.shows("label fault B"));
    let said = told.value("label fault B").to_owned();
    assert!(said.starts_with("B: 2 directions") && said.contains("bounces"), "{said}");
    assert!(told.state("b")["ready"] == false && !told.shows("label B"), "{:?}", told.state("b"));
    assert!(both_whole(&told) || told.state("a")["ready"] == true, "A stays");
    set(&user, 2, Some(2));
    user.wait_for("the picture", |f| both_whole(f) && !f.shows("label fault B"));
}

#[test]
fn asking_for_more_samples_keeps_those_that_are_there() {
    let mut user = User::of("cornell");
    let some = user.wait_for("some samples", |f| f.state("b")["rough"] == false && spp(f) >= Some(4));
    let more = user.set_slider("Samples per pixel (spp)", 10.0);
    assert_eq!(more.value("B spp"), "1024");
    for _ in 0..20 {
        let later = user.frame();
        assert!(spp(&later) >= spp(&some) && later.state("b")["rough"] == false, "the samples are gone");
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    // another view and back: the picture that was left is there again
    user.click("Pause");
    let held = user.wait_for("the pause", |f| f.value("label B").contains("paused"));
    user.click("Side by side");
    user.wait_for("another size", |f| f.state("view") == "Side by side" && both_whole(f));
    user.click("Wipe");
    user.wait_for("the samples of before", |f| f.state("view") == "Wipe" && spp(f) >= spp(&held) && both_whole(f));
}

/// How soon is measured by `--ui-dump` under a window; that it need not wait for the picture in hand is seen by what
/// comes: the next picture is of the new settings, and a rough one.
#[test]
fn a_change_drops_the_picture_in_hand_and_brings_a_rough_one_first() {
    let mut user = User::of("cornell");
    let before = user.wait_for("a full picture", |f| both_whole(f) && spp(f) >= Some(2));
    user.click_in("B", "cosine");
    let of_the_old = |f: &Frame| f.state("b")["label"] == "Path tracing, light";
    let mut old_pictures = vec![spp(&before)];
    let first = loop {
        let frame = user.frame();
        if !of_the_old(&frame) {
            break frame;
        }
        if old_pictures.last() != Some(&spp(&frame)) {
            old_pictures.push(spp(&frame));
        }
    };
    assert!(old_pictures.len() <= 2, "the old picture went on: {old_pictures:?} spp");
    assert_eq!(first.state("b")["label"], "Path tracing, cosine");
    assert!(first.state("b")["rough"] == true || spp(&first) == Some(1), "{:?}", first.state("b"));
}

#[test]
fn a_preset_is_one_choice_and_one_step_of_undo() {
    let mut user = User::of("whitted");
    user.wait_for("both pictures", both_whole);
    user.click("Presets of B");
    let set = user.click("2 e) 1 bounce, 20 spp");
    assert_eq!([set.value("B spp"), set.value("B bounces")], ["20", "1"]);
    assert_eq!([set.value("B roulette P"), set.value("B roulette throughput")], ["false", "false"]);
    let undone = user.key_with(Key::Z, Modifiers::COMMAND);
    assert_eq!([undone.value("B spp"), undone.value("B roulette throughput")], ["256", "true"]);
    assert_eq!(undone.value("B bounces"), "inf", "there is no limit again");
}

/// Another sun in one pane is no other view: the pictures are compared.
#[test]
fn a_pane_has_a_sun_of_its_own_beside_the_scenes() {
    let mut user = User::of("whitted");
    user.click("Presets of A");
    user.click("Whitted 1980");
    let of_1980 = user.wait_for("Whitted against the truth", |f| {
        f.state("a")["label"] == "Whitted, depth 8" && f.state("a")["rel_mse"].is_number() && both_whole(f)
    });
    assert_eq!([of_1980.value("A traced sun"), of_1980.value("sun radius")], ["0", "2.5"]);
    let under_the_point = of_1980.state("a")["rel_mse"].as_f64();
    user.set_slider("This picture's sun radius", 2.5);
    user.wait_for("the scene's sun", |f| f.state("a")["rel_mse"].as_f64() < under_the_point && both_whole(f));
}

#[test]
fn the_formula_of_the_highlight_stands_below_its_choice() {
    let mut user = User::of("phong");
    user.unfold_more("A");
    let [three, phong, blinn] = ["three", "phong", "blinn-phong"].map(|shading| {
        let shown = user.click_in("A", &format!("Highlight: {shading}"));
        shown.value("text A shading").to_owned()
    });
    assert!(three.contains("F (p + 2)/8 (N·H)^p"), "{three}");
    assert!(phong.ends_with("k_s I_s max(0, R·V)^p"), "{phong}");
    assert!(blinn.ends_with("k_s I_s max(0, N·H)^p"), "{blinn}");
}
