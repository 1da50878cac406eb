//! What windows suffer: storms of sizes, being hidden, camera and wheel, slow software drawing. And how fast they
//! answer.

use super::{alone, both_ready, both_whole, ready};
use std::time::Duration;
use visavis_tests::Screen;

#[test]
fn resize_storms_and_minimising_are_survived() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, _) = ready(&screen, &["cornell"]);
    let window = screen.focus("Visavis");
    let mut size = 12345u32;
    for _ in 0..60 {
        size = size.wrapping_mul(1664525).wrapping_add(1013904223);
        screen.resize(window, 1 + (size >> 8) % 1280, 1 + (size >> 20) % 720);
    }
    for _ in 0..3 {
        screen.show(window, false);
        screen.resize(window, 700, 500);
        std::thread::sleep(Duration::from_millis(200));
        screen.show(window, true);
    }
    screen.resize(window, 1100, 640);
    let frame = viewer.wait_for("both pictures at the last size", |f| {
        both_whole(f)
            && f.rect("controls")[2] <= 1100.0
            && f.rect("picture")[3] > 630.0
            && f.rect("picture")[3] <= 640.0
    });
    assert!(frame.state("a")["fault"].is_null() && frame.state("b")["fault"].is_null());
    screen.close(window);
    assert!(viewer.wait_for_end().success());
}

#[test]
fn the_camera_dollies_zooms_is_typed_kept_and_reset() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, first) = ready(&screen, &["cornell"]);
    let middle = first.point("picture", 0.3, 0.5);
    screen.wheel_up(middle);
    let nearer = viewer.wait_for("the dolly", |f| f.state("eye") != first.state("eye"));
    assert_eq!(nearer.state("fov"), first.state("fov"));
    screen.wheel_up_with_control(middle);
    viewer.wait_for("the zoom", |f| f.state("fov").as_f64() < first.state("fov").as_f64());

    screen.click(first.point("group Camera (both)", 0.2, 0.5));
    let open = viewer.wait_for_widget("add bookmark");
    screen.click(open.point("add bookmark", 0.5, 0.5));
    let marked = viewer.wait_for_widget("bookmark 1");
    let place = marked.state("eye").clone();
    screen.key('c', false);
    viewer.wait_for("the scene's camera", |f| f.state("eye") == first.state("eye"));
    screen.click(marked.point("bookmark 1", 0.5, 0.5));
    viewer.wait_for("the bookmark's", |f| f.state("eye") == &place);

    screen.double_click(marked.point("field of view", 0.5, 0.5));
    viewer.wait_for("the cursor in the number", |f| f.state("typing") == true);
    screen.key('a', true);
    screen.key('6', false);
    screen.key('0', false);
    screen.press(Screen::ENTER);
    viewer.wait_for("the typed field of view", |f| f.state("fov") == 60.0);
}

#[test]
fn either_pane_holds_any_technique() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, first) = ready(&screen, &["cornell"]);
    screen.click(first.point("A path", 0.5, 0.5));
    let two = viewer.wait_for_widget("A estimator cosine");
    screen.click(two.point("A estimator cosine", 0.5, 0.5));
    let both = viewer.wait_for("two truths, compared", |f| {
        f.state("a")["label"] == "truth (path, cosine)" && f.state("a")["rel_mse"].is_number() && both_whole(f)
    });
    assert_eq!(both.state("b")["label"], "truth (path, light)");
    screen.click(both.point("B raster", 0.5, 0.5));
    let swapped = viewer.wait_for("the fake in B", |f| f.state("b")["label"] == "fake (raster, fair)" && both_whole(f));
    assert!(swapped.shows("B fake as-taught") && !swapped.shows("B spp"));
}

/// From a slider's event to the first frame with a picture of it. A tenth of a second is the goal, of which two frames
/// of the window drawn in software take most; the bound only tells it from waiting for the picture in hand, which takes
/// seconds: a busy machine may take its time. The best of several is what the program can do, the rest is the machine.
#[test]
fn a_slider_brings_a_new_picture_at_once() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, first) = ready(&screen, &[]);
    let [left, top, _, bottom] = first.rect("refraction ratio");
    let mut times = Vec::new();
    for step in 0..8 {
        let before = viewer.wait_for("a whole truth", |f| both_ready(f) && f.state("b")["rough"] == false);
        let x = left + 20.0 + 15.0 * step as f32;
        screen.drag([x - 1.0, 0.5 * (top + bottom)], [x, 0.5 * (top + bottom)]);
        let changed = viewer.wait_for("the change and its first picture", |f| {
            f.value("refraction ratio") != before.value("refraction ratio") && !f.state("latency_ms").is_null()
        });
        times.push(changed.state("latency_ms").as_u64().expect("a measured latency"));
    }
    times.sort_unstable();
    println!("from a change of the slider to its first picture: {times:?} ms");
    assert!(times[0] < 300, "{times:?} ms from the change to the first picture");
}
