//! What stands in the environment, and in the resources of the X server.

use super::{alone, both_ready, says};
use std::path::Path;
use visavis_tests::{Screen, ViewerUnderTest};

/// Starts a viewer and returns what it says until its pictures are there, and its width in pixels.
fn said_at_the_start(screen: &Screen, variables: &[(&str, Option<&str>)]) -> (String, f32) {
    let binary = Path::new(env!("CARGO_BIN_EXE_visavis"));
    let mut viewer = ViewerUnderTest::start_in(binary, screen, variables, &["cornell"]);
    let frame = viewer.wait_for("both pictures", both_ready);
    (viewer.said(), frame.rect("picture")[2])
}

#[test]
fn a_scale_that_is_none_is_told_and_ignored() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (quiet, width) = said_at_the_start(&screen, &[("WINIT_X11_SCALE_FACTOR", Some("1"))]);
    assert!(!quiet.contains("scale"), "{quiet}");
    for value in ["abc", "0", "-1", "inf", "nan", "1e-320", "1e300", "100", "\u{fffd}"] {
        let (said, same) = said_at_the_start(&screen, &[("WINIT_X11_SCALE_FACTOR", Some(value))]);
        let note = format!("note: WINIT_X11_SCALE_FACTOR={value} is ignored, scale 1 is used");
        assert!(said.lines().count() == 1 && said.starts_with(&note), "{said}");
        assert_eq!(same, width);
    }
    for (dpi, scale) in [("0", "0.0"), ("-96", "-1.0"), ("nan", "NaN"), ("inf", "inf"), ("9600", "100.0")] {
        screen.set_resources(&format!("Xft.dpi:\t{dpi}\n"));
        let (said, same) = said_at_the_start(&screen, &[("WINIT_X11_SCALE_FACTOR", Some(""))]);
        let note = format!("note: the screen's scale {scale} (of Xft.dpi, 96 is scale 1) is ignored, scale 1 is used");
        assert!(said.lines().count() == 1 && said.starts_with(&note), "{said}");
        assert_eq!(same, width);
    }
    // no number is no scale to winit either
    screen.set_resources("Xft.dpi:\tabc\n");
    let (said, _) = said_at_the_start(&screen, &[("WINIT_X11_SCALE_FACTOR", Some(""))]);
    assert_eq!(said, "");
}

/// The session is not lost, and the window does not grow.
#[test]
fn a_scale_that_becomes_none_is_told_in_the_window() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let variables = [("WINIT_X11_SCALE_FACTOR", Some(""))];
    let mut viewer =
        ViewerUnderTest::start_in(Path::new(env!("CARGO_BIN_EXE_visavis")), &screen, &variables, &["cornell"]);
    let width = viewer.wait_for("both pictures", both_ready).rect("picture")[2];
    let window = screen.focus("Visavis");
    for (dpi, scale) in [("9600", "100.0"), ("0", "0.0"), ("nan", "NaN")] {
        screen.set_resources(&format!("Xft.dpi:\t{dpi}\n"));
        screen.tell_of_resources(window);
        let words = format!("the screen's scale {scale} (of Xft.dpi, 96 is scale 1) is ignored");
        let frame = viewer.wait_for(&words, |frame| says(frame, &words));
        assert_eq!(frame.rect("picture")[2], width);
    }
    assert_eq!(viewer.said(), "");
}

#[test]
fn without_a_runtime_folder_no_library_prints_an_error() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    for folder in [None, Some(""), Some("relative")] {
        let (said, _) = said_at_the_start(&screen, &[("XDG_RUNTIME_DIR", folder)]);
        assert!(!said.lines().any(|line| line.starts_with("error")), "{folder:?}: {said}");
    }
}
