//! Keys alone do everything, and what is paused stays as it is.

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

    tab_to(&screen, &mut viewer, "B bounces");
    for bounces in ["20", "19"] {
        screen.press(Screen::LEFT);
        viewer.wait_for("fewer bounces", |f| f.value("B bounces") == bounces);
    }

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
