//! What a lecturer does, from the first picture to the last.

use super::{alone, both_ready, viewer_on};
use std::path::Path;
use visavis_tests::{Frame, Screen};

#[test]
fn a_lecturer_toggles_slides_wipes_orbits_saves_and_closes() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let mut viewer = viewer_on(&screen, &[]);
    let first = viewer.wait_for("both pictures", both_ready);
    assert_eq!(first.state("view"), "Wipe");
    assert!(first.state("a")["fault"].is_null() && first.state("b")["fault"].is_null());
    let window = screen.focus("Visavis");

    screen.key('t', false);
    viewer.wait_for("A alone", |f| f.state("view") == "A");
    screen.key('t', false);
    viewer.wait_for("B alone", |f| f.state("view") == "B");
    screen.click(first.point("view Wipe", 0.5, 0.5));
    viewer.wait_for("the wipe again", |f| f.state("view") == "Wipe");

    assert_eq!(first.value("refraction ratio"), "0.7");
    let [left, top, right, bottom] = first.rect("refraction ratio");
    let y = 0.5 * (top + bottom);
    let at = |share: f32| left + share * (right - left);
    screen.drag([at(0.5), y], [at(0.05), y]);
    let slid = |f: &Frame| f.value("refraction ratio").parse::<f32>().is_ok_and(|r| r < 0.55);
    viewer.wait_for("the slider to stand at its new place", slid);

    let settled = |f: &Frame| f.state("b")["rough"] == false && f.state("b")["spp"].as_u64() >= Some(4);
    let mut from = at(0.05);
    for to in [0.36, 0.64, 0.85].map(at) {
        screen.drag([from, y], [to, y]);
        viewer.wait_for("the truth to refine, the slider at rest", settled);
        from = to;
    }

    assert_eq!(first.state("line"), "horizontal", "through both balls");
    let line = first.state("wipe").as_f64().expect("a number") as f32;
    screen.drag(first.point("picture", 0.5, line), first.point("picture", 0.6, 0.25));
    let wiped = viewer.wait_for("the line to move", |f| f.state("wipe").as_f64().is_some_and(|w| w < 0.4));
    assert_eq!(wiped.state("eye"), first.state("eye"), "dragging the line must not move the camera");

    screen.drag(first.point("picture", 0.7, 0.7), first.point("picture", 0.75, 0.65));
    let orbited = viewer.wait_for("the camera to orbit", |f| f.state("eye") != first.state("eye"));
    screen.wheel_up(first.point("picture", 0.7, 0.5));
    viewer.wait_for("the camera to dolly", |f| f.state("eye") != orbited.state("eye"));

    viewer.wait_for("both pictures of the new view", |f| both_ready(f) && f.state("b")["rough"] == false);
    screen.key('s', true);
    let saved =
        viewer.wait_for("the message", |f| f.state("message").as_str().is_some_and(|m| m.starts_with("Saved ")));
    let path = saved.state("message").as_str().unwrap()["Saved ".len()..].to_owned();
    assert!(Path::new(&path).starts_with(viewer.home()));
    let picture = image::open(&path).expect("a PNG").to_rgb8();
    let [left, top, right, bottom] = saved.rect("picture").map(|v| v as u32);
    assert_eq!(picture.dimensions(), (right - left, bottom - top));
    let line_at = (saved.state("wipe").as_f64().unwrap() * f64::from(bottom - top)) as u32;
    let white = (left..right).filter(|x| picture.get_pixel(x - left, line_at).0 == [255; 3]).count();
    assert!(white as u32 > (right - left) / 2, "the line is part of the saved picture");

    screen.close(window);
    assert!(viewer.wait_for_end().success());
}

#[test]
fn without_an_adapter_the_window_says_what_to_install() {
    let _alone = alone();
    let screen = Screen::start(640, 480);
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_visavis"));
    command.env("DISPLAY", &screen.display).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    // only an interface that this system does not have
    let output = command.env("WGPU_BACKEND", "dx12").output().expect("the program");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("mesa-vulkan-drivers"), "{said}");
}
