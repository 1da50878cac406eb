//! What windows suffer: storms of sizes, being hidden, slow software drawing.

use super::{alone, both_whole, ready};
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
