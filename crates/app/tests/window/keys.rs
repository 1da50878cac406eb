//! Keys alone do everything; what is paused stays as it is; what was changed can be taken back.

use super::{alone, both_whole, ready, says};
use visavis_tests::{Frame, Screen, ViewerUnderTest};

/// Presses Tab until a widget has the keyboard.
fn tab_to(screen: &Screen, viewer: &mut ViewerUnderTest, name: &str) {
    for _ in 0..80 {
        let frame = viewer.wait_for("a frame", |_| true);
        if frame.focus() == name {
            return;
        }
        screen.press(Screen::TAB);
        viewer.wait_for("the keyboard to move on", |f| f.state("focus_id") != frame.state("focus_id"));
    }
    panic!("Tab never reaches '{name}'");
}

#[test]
fn keys_alone_change_scene_bounces_view_export_and_quit() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, _) = ready(&screen, &[]);

    tab_to(&screen, &mut viewer, "scene");
    screen.press(Screen::ENTER);
    viewer.wait_for_widget("scene cornell");
    tab_to(&screen, &mut viewer, "scene cornell");
    screen.press(Screen::ENTER);
    viewer.wait_for("the other scene", |f| f.state("scene") == "cornell" && both_whole(f));

    tab_to(&screen, &mut viewer, "B limit bounces");
    screen.press(u32::from(' '));
    let limited = viewer.wait_for("the slider of bounces", |f| f.shows("B bounces"));
    tab_to(&screen, &mut viewer, "B bounces");
    screen.press(Screen::RIGHT);
    let more = (limited.value("B bounces").parse::<u32>().expect("a number") + 1).to_string();
    viewer.wait_for("one bounce more", |f| f.value("B bounces") == more);

    for (key, view) in [('4', "Side by side"), ('2', "B"), ('1', "A"), ('3', "Wipe")] {
        screen.key(key, false);
        viewer.wait_for(view, |f| f.state("view") == view);
    }
    screen.key('3', false);
    viewer.wait_for("the line to turn", |f| f.state("line") == "horizontal");
    tab_to(&screen, &mut viewer, "picture");
    screen.press(0xff54); // down
    viewer.wait_for("the line to move", |f| f.state("wipe").as_f64() > Some(0.51));

    screen.chord(&[Screen::SHIFT, u32::from('/')]);
    viewer.wait_for("the help", |f| f.shows("help"));
    screen.chord(&[Screen::SHIFT, u32::from('/')]);
    viewer.wait_for("the help to go", |f| !f.shows("help"));

    let before = viewer.wait_for("both pictures", both_whole).rect("scene");
    screen.chord(&[Screen::CONTROL, u32::from('=')]);
    viewer.wait_for("larger text", |f| f.rect("scene")[3] > before[3] + 0.5);
    screen.key('0', true);
    viewer.wait_for("usual text", |f| f.rect("scene") == before && both_whole(f));

    screen.key('s', true);
    viewer.wait_for("the message", |f| says(f, "Saved "));
    // both at once: what was asked for is saved before the window goes
    screen.key('s', true);
    screen.key('q', true);
    assert!(viewer.wait_for_end().success());
    let saved = std::fs::read_dir(viewer.home()).expect("the folder").filter_map(Result::ok);
    assert_eq!(saved.filter(|file| file.path().extension().is_some_and(|e| e == "png")).count(), 2);
}

#[test]
fn asking_for_more_samples_keeps_those_that_are_there() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, first) = ready(&screen, &["cornell"]);
    let spp = |f: &Frame| f.state("b")["spp"].as_u64();
    let some = viewer.wait_for("some samples", |f| f.state("b")["rough"] == false && spp(f) >= Some(4));
    let [left, top, right, bottom] = first.rect("B spp");
    let y = 0.5 * (top + bottom);
    screen.drag([left + 0.5 * (right - left), y], [left + 0.62 * (right - left), y]);
    let more = viewer.wait_for("the larger wish", |f| f.value("B spp") != "256");
    assert!(more.value("B spp").parse::<u64>().expect("a number") > 256);
    for _ in 0..20 {
        let later = viewer.wait_for("a frame", |_| true);
        assert!(spp(&later) >= spp(&some) && later.state("b")["rough"] == false, "the samples are gone");
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    // another view and back: the picture that was left is there again
    screen.key('p', false);
    let held = viewer.wait_for("the pause", |f| f.value("label B").contains("paused"));
    screen.key('4', false);
    viewer.wait_for("another size", |f| f.state("view") == "Side by side" && both_whole(f));
    screen.key('3', false);
    viewer.wait_for("the samples of before", |f| f.state("view") == "Wipe" && spp(f) >= spp(&held) && both_whole(f));
}

#[test]
fn a_presenters_remote_and_typed_letters_do_nothing_by_themselves() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, first) = ready(&screen, &["cornell"]);
    // page up, page down, F5, full stop, escape
    for key in [0xff55, 0xff56, 0xffc2, u32::from('.'), Screen::ESCAPE] {
        screen.press(key);
    }
    screen.key('4', false);
    let after = viewer.wait_for("the key that does something", |f| f.state("view") == "Side by side");
    for state in ["scene", "line", "wipe", "paused", "theme", "eye", "message"] {
        assert_eq!(after.state(state), first.state(state), "{state}");
    }
}

#[test]
fn paused_toggling_twice_is_identical_to_the_last_pixel() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, first) = ready(&screen, &["cornell"]);
    screen.move_to(1270.0, 700.0);
    screen.key('p', false);
    viewer.wait_for("the pause", |f| f.state("paused") == true);
    // what was under way is shown, then nothing more comes
    let held = |f: &Frame| f.value("label B").contains("paused");
    screen.key('t', false);
    screen.key('t', false);
    let mut frame = viewer.wait_for("B to be held", held);
    loop {
        std::thread::sleep(std::time::Duration::from_millis(1500));
        let later = viewer.wait_for("B to be held", held);
        if later.state("b")["spp"] == frame.state("b")["spp"] {
            break;
        }
        frame = later;
    }
    let [left, top, right, bottom] = first.rect("picture").map(|v| v as u32);
    let mut look = |view: &str| {
        viewer.wait_for(view, |f| f.state("view") == view);
        // the dump is written just after the frame is handed to the screen
        std::thread::sleep(std::time::Duration::from_millis(300));
        screen.pixels(left, top, right - left, bottom - top)
    };
    let b = look("B");
    screen.key('t', false);
    let a = look("A");
    screen.key('t', false);
    assert!(look("B") == b, "B differs after A was shown");
    screen.key('t', false);
    assert!(look("A") == a, "A differs after B was shown");
    assert!(a != b, "the fake and the truth look alike: nothing was compared");

    let spp = frame.state("b")["spp"].as_u64();
    screen.key('t', false);
    screen.key('p', false);
    viewer.wait_for("the truth to go on", |f| f.state("b")["spp"].as_u64() > spp);
}

#[test]
fn a_change_of_a_setting_can_be_taken_back_and_done_again() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, first) = ready(&screen, &[]);
    let [left, top, _, bottom] = first.rect("refraction ratio");
    let y = 0.5 * (top + bottom);
    screen.drag([left + 80.0, y], [left + 30.0, y]);
    let slid =
        viewer.wait_for("the slider to move", |f| f.value("refraction ratio") != "0.7" && f.state("pressing") == false);
    let moved = slid.value("refraction ratio").to_owned();
    screen.click(first.point("A path", 0.5, 0.5));
    viewer.wait_for("two truths", |f| f.state("a")["label"] == "truth (path, light)" && both_whole(f));
    screen.key('z', true);
    viewer.wait_for("the fake again", |f| f.state("a")["label"] == "fake (raster, fair)" && f.value("undo") == "true");
    screen.key('z', true);
    viewer.wait_for("the ratio of before", |f| f.value("refraction ratio") == "0.7" && f.value("undo") == "false");
    screen.chord(&[Screen::CONTROL, Screen::SHIFT, u32::from('z')]);
    viewer.wait_for("the moved ratio", |f| f.value("refraction ratio") == moved);
}
