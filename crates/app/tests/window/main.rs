//! The real window under Xvfb, with real mouse and keys.

#![expect(clippy::expect_used, reason = "a test stops at the first thing that is not as it must be")]

mod device;
mod environment;
mod export;
mod files;
mod journey;
mod keys;
mod layout;
mod ruler;
mod storms;

use std::path::Path;
use std::sync::{Mutex, MutexGuard};
use visavis_tests::{Frame, Screen, ViewerUnderTest};

/// One window at a time: each test has the machine to itself, as a user has.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn viewer_on(screen: &Screen, arguments: &[&str]) -> ViewerUnderTest {
    scaled_viewer_on(screen, 1.0, arguments)
}

fn scaled_viewer_on(screen: &Screen, scale: f32, arguments: &[&str]) -> ViewerUnderTest {
    ViewerUnderTest::start_scaled(Path::new(env!("CARGO_BIN_EXE_visavis")), screen, scale, arguments)
}

/// A viewer that has the keyboard and shows both pictures whole, and its frame.
fn ready(screen: &Screen, arguments: &[&str]) -> (ViewerUnderTest, Frame) {
    let mut viewer = viewer_on(screen, arguments);
    let first = viewer.wait_for("both pictures", both_whole);
    screen.focus("Visavis");
    (viewer, first)
}

fn both_ready(frame: &Frame) -> bool {
    frame.state("a")["ready"] == true && frame.state("b")["ready"] == true
}

/// Both pictures are there at full resolution.
fn both_whole(frame: &Frame) -> bool {
    both_ready(frame) && frame.state("a")["rough"] == false && frame.state("b")["rough"] == false
}

fn says(frame: &Frame, words: &str) -> bool {
    frame.state("message").as_str().is_some_and(|message| message.contains(words))
}
