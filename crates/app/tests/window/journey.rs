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
    // the slider's rail starts at the widget's left edge and is 130 points long
    let [left, top, _, bottom] = first.rect("refraction ratio");
    let y = 0.5 * (top + bottom);
    screen.drag([left + 65.0, y], [left + 20.0, y]);
    let slid = |f: &Frame| f.value("refraction ratio").parse::<f32>().is_ok_and(|r| r < 0.55);
    viewer.wait_for("the slider to stand at its new place", slid);

    let settled = |f: &Frame| f.state("b")["rough"] == false && f.state("b")["spp"].as_u64() >= Some(4);
    let mut from = left + 20.0;
    for to in [left + 47.0, left + 83.0, left + 111.0] {
        screen.drag([from, y], [to, y]);
        viewer.wait_for("the truth to refine, the slider at rest", settled);
        from = to;
    }

    let middle = first.point("picture", 0.5, 0.5);
    screen.drag(middle, first.point("picture", 0.25, 0.6));
    let wiped = viewer.wait_for("the line to move", |f| f.state("wipe").as_f64().is_some_and(|w| w < 0.3));
    assert_eq!(wiped.state("eye"), first.state("eye"), "dragging the line must not move the camera");

    screen.drag(first.point("picture", 0.7, 0.7), first.point("picture", 0.75, 0.65));
    viewer.wait_for("the camera to orbit", |f| f.state("eye") != first.state("eye"));

    viewer.wait_for("both pictures of the new view", |f| both_ready(f) && f.state("b")["rough"] == false);
    screen.key('s', true);
    let saved =
        viewer.wait_for("the message", |f| f.state("message").as_str().is_some_and(|m| m.starts_with("Saved ")));
    let path = saved.state("message").as_str().unwrap()["Saved ".len()..].to_owned();
    assert!(Path::new(&path).starts_with(viewer.home()));
    let picture = image::open(&path).expect("a PNG").to_rgb8();
    let [left, top, right, bottom] = saved.rect("picture").map(|v| v as u32);
    assert_eq!(picture.dimensions(), (right - left, bottom - top));
    let line_at = left + (saved.state("wipe").as_f64().unwrap() * f64::from(right - left)) as u32;
    let white = (top..bottom).filter(|y| picture.get_pixel(line_at - left, y - top).0 == [255; 3]).count();
    assert!(white as u32 > (bottom - top) / 2, "the line is part of the saved picture");

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

#[test]
fn scenes_change_controls_that_do_not_apply_go_and_the_window_may_be_resized() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let mut viewer = viewer_on(&screen, &["cornell"]);
    let first = viewer.wait_for("both pictures", both_ready);
    assert!(!first.shows("refraction ratio") && !first.shows("sun radius"));
    let window = screen.focus("Visavis");

    screen.click(first.point("B limit bounces", 0.05, 0.5));
    viewer.wait_for("the bounce slider", |f| f.shows("B bounces"));
    screen.click(first.point("scene", 0.5, 0.5));
    let menu = viewer.wait_for_widget("scene whitted");
    screen.click(menu.point("scene whitted", 0.5, 0.5));
    viewer
        .wait_for("the other scene", |f| f.state("scene") == "whitted" && f.shows("refraction ratio") && both_ready(f));

    // a file by its name, typed: letters must not act as shortcuts
    screen.click(first.point("scene", 0.5, 0.5));
    let menu = viewer.wait_for_widget("scene file");
    screen.click(menu.point("scene file", 0.5, 0.5));
    viewer.wait_for("the cursor in the field", |f| f.state("typing") == true);
    for letter in "thc".chars() {
        screen.key(letter, false);
    }
    let typed = viewer.wait_for("the typed name", |f| f.value("scene file") == "thc");
    assert_eq!(typed.state("view"), "Wipe");
    screen.press(Screen::ENTER);
    let refused = viewer.wait_for("the refusal", |f| f.state("message").as_str().is_some_and(|m| m.contains("thc")));
    assert!(refused.state("message").as_str().unwrap().contains("whitted, cornell"));
    assert_eq!(refused.state("scene"), "whitted");

    let whole = viewer.wait_for("both pictures", both_ready).rect("picture");
    screen.click(first.point("view Side by side", 0.5, 0.5));
    let halved = viewer.wait_for("both pictures side by side", |f| {
        f.state("view") == "Side by side"
            && f.state("picture_size")[0].as_f64() < Some(0.5 * f64::from(whole[2] - whole[0]))
    });
    assert_eq!(halved.rect("picture"), whole, "the area stays, the pictures share it");
    viewer.wait_for("an error between them", |f| f.state("a")["rel_mse"].is_number() && f.state("b")["rough"] == false);
    screen.click(first.point("view Wipe", 0.5, 0.5));

    for (width, height) in [(900, 500), (500, 330), (1100, 700)] {
        screen.resize(window, width, height);
    }
    let resized = viewer.wait_for("the new size", |f| f.rect("picture")[3] > 650.0 && f.rect("picture")[3] <= 700.0);
    assert!(resized.rect("controls")[2] <= 1100.0);
    screen.close(window);
    assert!(viewer.wait_for_end().success());
}

/// Numbers beyond a slider's range and between its steps stay as the file has them, and the truth comes to rest.
#[test]
fn showing_a_scene_does_not_change_it() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let folder = visavis_tests::TestFolder::new();
    let file = folder.file("odd.toml");
    let text = r#"
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
fov_y = 45
[sky]
radiance = [0.3, 0.5, 0.9]
[sun]
towards = [0, 1, 0]
angular_radius = 12.34
irradiance = [1, 1, 1]
[material.bubble]
dielectric = { ior = 0.75 }
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "bubble"
"#;
    std::fs::write(&file, text).expect("the scene file");
    let mut viewer = viewer_on(&screen, &[file.to_str().expect("a plain path")]);
    let settled = |f: &Frame| f.state("b")["rough"] == false && f.state("b")["spp"].as_u64() >= Some(4);
    let frame = viewer.wait_for("the truth to refine", settled);
    assert_eq!(frame.value("sun radius"), "12.34");
    assert!(frame.value("refraction ratio").starts_with("1.333"), "{}", frame.value("refraction ratio"));
    assert_eq!(frame.value("A reflectivity"), "1");
}

#[test]
fn a_change_drops_the_picture_in_hand_and_brings_a_rough_one_at_once() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let mut viewer = viewer_on(&screen, &["cornell"]);
    let first = viewer.wait_for("a full picture", |f| both_ready(f) && f.state("b")["rough"] == false);
    screen.focus("Visavis");
    screen.click(first.point("B estimator cosine", 0.5, 0.5));
    let changed = viewer.wait_for("the new estimator's first picture", |f| {
        f.value("B estimator cosine") == "true" && !f.state("latency_ms").is_null()
    });
    let latency = changed.state("latency_ms").as_u64().expect("a measured latency");
    println!("{latency} ms from the change to its first picture on the screen");
    // a tenth of a second is the goal and about what an idle machine prints here; a busy one may take its time, but not
    // so long as the picture in hand would go on, which is a minute and more
    assert!(latency < 3000, "{latency} ms from the change to the first picture");
}
