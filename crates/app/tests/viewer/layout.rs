//! Nothing overlaps, and pictures have the pixels that were asked for.

use super::{User, both_whole};
use egui::{Key, Modifiers, TextureFilter};
use film::Feature;
use technique::DeviceChoice;
use visavis::model::PaneId;
use visavis::viewer::Place;
use visavis_tests::Frame;

/// The most controls that can be there at once, on the smallest screen: what does not fit is reached by scrolling, and
/// still nothing overlaps or sticks out at the side.
#[test]
fn all_controls_at_once_still_do_not_overlap() {
    let size = egui::vec2(1024.0, 768.0) / 1.5;
    let mut user = User::beside("whitted", size, 1.5, DeviceChoice::Auto);
    user.wait_for("both pictures", both_whole);
    user.click("Camera (both)");
    let frame = user.click_in("B", "Roulette: survive with P");
    assert!(frame.shows("field of view") && frame.shows("B roulette probability") && frame.shows("B bounces"));
    let controls = controls(&frame);
    for (index, a) in controls.iter().enumerate() {
        for b in &controls[index + 1..] {
            let ([al, at, ar, ab], [bl, bt, br, bb]) = (frame.visible(a), frame.visible(b));
            let overlap = ar.min(br) - al.max(bl) > 0.5 && ab.min(bb) - at.max(bt) > 0.5;
            assert!(!overlap, "'{a}' {:?} overlaps '{b}' {:?}", frame.rect(a), frame.rect(b));
        }
    }
    let [_, bar, edge, _] = frame.rect("picture");
    for name in controls {
        // what is scrolled away has no height
        let [left, top, right, bottom] = frame.visible(name);
        if bottom <= top {
            continue;
        }
        assert!(right <= 1024.0 && (top < bar || left >= edge), "{name} sticks out: {:?}", frame.rect(name));
    }
    user.scroll_to_number("Field of view");
    user.wait_for("the last control to come into view", |f| {
        let (whole, seen) = (f.rect("field of view"), f.visible("field of view"));
        whole == seen
    });
}

/// Squares that stand for many pixels would look like a defect of the technique.
#[test]
fn a_picture_is_smooth_while_it_is_rough_and_then_shown_pixel_by_pixel() {
    let mut user = User::of("cornell");
    let frame = user.wait_for("both pictures", both_whole);
    let size = [0, 1].map(|i| frame.state("picture_size")[i].as_u64().expect("a size") as u32);
    let uploads = user.uploads.borrow();
    let of_b: Vec<_> = uploads.iter().filter(|(place, ..)| *place == Place::Pane(PaneId::B)).collect();
    assert!(of_b.len() > 1, "a rough one first");
    for (_, (width, height), filter) in of_b {
        let rough = [*width, *height] != size;
        let expected = if rough { TextureFilter::Linear } else { TextureFilter::Nearest };
        assert_eq!(*filter, expected, "{width} x {height} of {size:?}");
    }
}

/// Nothing of a map lies where it does in the other pane: the wipe does not cut it.
#[test]
fn a_cube_map_is_whole_on_its_side_of_the_wipe_and_its_faces_are_named() {
    let mut user = User::of("whitted");
    user.wait_for("both pictures", both_whole);
    user.viewer.borrow_mut().model.session.panes[PaneId::A].fake.show = raster::Show::CubeFaces;
    let named = |f: &Frame| f.shows("label A face +x");
    let frame = user.wait_for("the names", |f| named(f) && both_whole(f));
    let [_, top, _, bottom] = frame.rect("picture");
    let line = top + frame.state("wipe").as_f64().expect("a number") as f32 * (bottom - top);
    assert_eq!(frame.state("line"), "horizontal");
    let faces = ["+x", "-x", "+y", "-y", "+z", "-z"].map(|face| frame.rect(&format!("label A face {face}")));
    assert!(faces.iter().all(|face| face[1] >= top && face[3] <= line), "{faces:?}");
    let [_, _, above, below, ..] = faces;
    // a face is a third of the part above the line
    assert!((below[1] - above[1] - 2.0 / 3.0 * (line - top)).abs() < 2.0, "{above:?} {below:?}");
    user.viewer.borrow_mut().model.session.panes[PaneId::A].fake.show = raster::Show::ShadowMap;
    user.wait_for("the sun's shadow map, which has no faces", |f| !f.shows("label A face +x"));
}

/// It is no picture of the scene's light, whichever technique it is of, and comes and goes like any.
#[test]
fn what_is_seen_without_light_has_its_own_name_and_no_errors() {
    let mut user = User::of("whitted");
    let has_errors = |f: &Frame| f.state("a")["rel_mse"].is_number();
    user.wait_for("errors", has_errors);
    let shown = |user: &User, feature| user.viewer.borrow_mut().model.session.panes[PaneId::B].feature = feature;
    shown(&user, Some(Feature::Albedo));
    let named = |f: &Frame| f.value("label B").contains("Albedo by rays");
    user.wait_for("the albedo, without errors", |f| named(f) && !has_errors(f));
    shown(&user, None);
    user.wait_for("the errors again", |f| !named(f) && has_errors(f));
}

/// Widgets that are not the picture and not on it.
fn controls(frame: &Frame) -> Vec<&str> {
    let on_the_picture = ["picture", "label ", "bar map", "hint", "message"];
    frame.names().into_iter().filter(|name| !on_the_picture.iter().any(|start| name.starts_with(start))).collect()
}

/// Both pictures have a pixel for two by two, and their labels say so; undo gives every pixel back.
#[test]
fn pictures_are_made_at_half_the_resolution_if_asked() {
    let mut user = User::of("cornell");
    let first = user.wait_for("both pictures", both_whole);
    let size = |f: &Frame, i: usize| f.state("picture_size")[i].as_u64().expect("a size");
    let said = |f: &Frame, pane: &str| f.value(&format!("label {pane}")).contains("at 1/2 of the resolution");
    assert!(!said(&first, "A") && !said(&first, "B"));
    user.click("Camera (both)");
    let half = user.click("Resolution: 1/2");
    assert_eq!([size(&half, 0), size(&half, 1)], [0, 1].map(|i| size(&first, i).div_ceil(2)));
    let half = user.wait_for("labels that say so", |f| both_whole(f) && said(f, "A") && said(f, "B"));
    assert!(half.state("a")["rel_mse"].is_number());
    user.key_with(Key::Z, Modifiers::COMMAND);
    user.wait_for("every pixel", |f| both_whole(f) && size(f, 0) == size(&first, 0) && !said(f, "B"));
}
