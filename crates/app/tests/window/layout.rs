//! Nothing is clipped, nothing overlaps, the picture is large, and every text can be read.

use super::{alone, both_whole, scaled_viewer_on};
use visavis_tests::{Frame, Screen};

/// The screens that a lecture meets: width, height, scale, theme, the least contrast of text (WCAG AA and AAA).
const SCREENS: [(u32, u32, f32, &str, f64); 4] = [
    (1280, 720, 1.0, "dark", 4.5),
    (1280, 720, 1.0, "light", 4.5),
    (1280, 720, 1.0, "projector", 7.0),
    (1024, 768, 1.5, "dark", 4.5),
];

#[test]
fn everything_fits_and_can_be_read_on_a_laptop_and_on_a_projector() {
    let _alone = alone();
    for (width, height, scale, theme, contrast) in SCREENS {
        for scene in ["whitted", "cornell"] {
            let screen = Screen::start(width, height);
            let mut viewer = scaled_viewer_on(&screen, scale, &[scene, "--theme", theme]);
            let first = viewer.wait_for("both pictures", both_whole);
            screen.focus("Visavis");
            // away from everything, so that nothing is lit up by the mouse
            screen.move_to(0.5 * first.rect("picture")[2], 0.5 * height as f32);
            let here = format!("{scene} at {width} x {height}, scale {scale}, {theme}");
            for (key, view) in [('3', "Wipe"), ('4', "Side by side"), ('1', "A"), ('5', "Error map")] {
                screen.key(key, false);
                let mapped = |f: &Frame| view != "Error map" || f.shows("bar map");
                let frame = viewer.wait_for(view, |f| f.state("view") == view && both_whole(f) && mapped(f));
                let [left, top, right, bottom] = frame.rect("picture");
                let share = (right - left) * (bottom - top) / (width * height) as f32;
                assert!(share >= 0.65, "{here}: the picture has {share} of the window");
                if view == "Error map" {
                    // its controls stand above the others, which scroll where the window is low
                    let of_the_map = ["picture", "label ", "bar map", "view ", "group Error", "map ", "hold", "scale"];
                    let own = |name: &&str| of_the_map.iter().any(|start| name.starts_with(start));
                    assert_nothing_clipped(&frame, frame.names().into_iter().filter(own), &here);
                    assert_inside(frame.rect("bar map"), frame.rect("picture"), &here);
                    assert_inside(frame.rect("label map"), frame.rect("picture"), &here);
                    assert_no_overlap(&frame, &here);
                    assert_can_be_read(&screen, &frame, "label map", contrast, &here);
                    continue;
                }
                assert_nothing_clipped_or_overlapping(&frame, &here);
                assert!(frame.visible("A raster") == frame.rect("A raster"), "{here}: the head of A is cut");
                assert_texts_are_readable(&screen, &frame, contrast, &here);
            }
        }
    }
}

/// From the last row of seats a projected picture is as small as half of it on the lecturer's own screen.
#[test]
fn on_a_projector_labels_take_four_hundredths_of_the_height_and_half_the_size_can_still_be_read() {
    let _alone = alone();
    let screen = Screen::start(1920, 1080);
    let mut viewer = scaled_viewer_on(&screen, 1.0, &["cornell", "--theme", "projector"]);
    viewer.wait_for("both pictures", both_whole);
    screen.resize(screen.focus("Visavis"), 1920, 1080);
    let large = |f: &Frame| both_whole(f) && f.rect("picture")[3] > 1000.0 && f.shows("label B");
    let frame = viewer.wait_for("both pictures in the whole window", large);
    for label in ["label A", "label B"] {
        let [_, top, _, bottom] = frame.rect(label);
        let row = (bottom - top) / frame.value(label).lines().count() as f32;
        assert!(row >= 0.04 * 1080.0 - 1.0, "a row of {label} is {row} high");
    }
    for name in ["label A", "label B", "A raster", "B path", "group B", "text B spp", "view Wipe"] {
        let [left, top, right, bottom] = frame.rect(name).map(|v| v.round() as u32);
        let (width, height) = ((right - left) & !1, (bottom - top) & !1);
        let ratio = contrast(&halved(&screen.pixels(left, top, width, height), width as usize));
        assert!(ratio >= 4.5, "at half the size the contrast of '{name}' is {ratio:.2}");
    }
}

/// The mean of each two by two pixels, as bytes.
fn halved(pixels: &[[u8; 3]], width: usize) -> Vec<[u8; 3]> {
    let rows: Vec<_> = pixels.chunks_exact(width).collect();
    let mean = |pair: &[&[[u8; 3]]], x: usize| {
        [0, 1, 2].map(|channel| {
            let sum: u32 = pair.iter().flat_map(|row| &row[x..x + 2]).map(|pixel| u32::from(pixel[channel])).sum();
            (sum / 4) as u8
        })
    };
    rows.chunks_exact(2).flat_map(|pair| (0..width / 2).map(move |x| mean(pair, 2 * x))).collect()
}

/// Where the part of the panel ends that is never scrolled, in pixels.
const HEADS: f32 = 110.0;

/// How far egui's fade reaches up from the foot of what scrolls: 20 points, at a scale of 2.
const FADE: f32 = 40.0;

/// Widgets that are not the picture and not on it.
fn controls(frame: &Frame) -> Vec<&str> {
    let on_the_picture = ["picture", "label ", "bar map", "hint", "message"];
    frame.names().into_iter().filter(|name| !on_the_picture.iter().any(|start| name.starts_with(start))).collect()
}

fn assert_inside(inner: [f32; 4], outer: [f32; 4], here: &str) {
    let inside = inner[0] >= outer[0] && inner[1] >= outer[1] && inner[2] <= outer[2] && inner[3] <= outer[3];
    assert!(inside, "{here}: {inner:?} is not inside {outer:?}");
}

fn assert_nothing_clipped_or_overlapping(frame: &Frame, here: &str) {
    assert_nothing_clipped(frame, frame.names().into_iter(), here);
    assert_no_overlap(frame, here);
}

/// Controls may be scrolled out of sight, upwards or downwards but not sideways; all else is whole.
fn assert_nothing_clipped<'a>(frame: &Frame, names: impl Iterator<Item = &'a str>, here: &str) {
    let panel = frame.rect("picture")[2];
    for name in names {
        let (rect, visible) = (frame.rect(name), frame.visible(name));
        let sides: &[usize] = if rect[0] >= panel && rect[1] > HEADS { &[0, 2] } else { &[0, 1, 2, 3] };
        let clipped = sides.iter().any(|&side| (rect[side] - visible[side]).abs() > 1.0);
        assert!(!clipped, "{here}: '{name}' is {rect:?}, but only {visible:?} is seen");
    }
}

fn assert_no_overlap(frame: &Frame, here: &str) {
    let controls = controls(frame);
    for (index, a) in controls.iter().enumerate() {
        for b in &controls[index + 1..] {
            let ([al, at, ar, ab], [bl, bt, br, bb]) = (frame.visible(a), frame.visible(b));
            let overlap = ar.min(br) - al.max(bl) > 0.5 && ab.min(bb) - at.max(bt) > 0.5;
            assert!(!overlap, "{here}: '{a}' {:?} overlaps '{b}' {:?}", frame.rect(a), frame.rect(b));
        }
    }
}

/// Contrast between the most frequent colour in a text's rectangle and the one that differs most from it.
fn assert_texts_are_readable(screen: &Screen, frame: &Frame, least: f64, here: &str) {
    let whole = |name: &str| frame.rect(name).iter().zip(frame.visible(name)).all(|(a, b)| (a - b).abs() <= 1.0);
    // what scrolls fades at the foot of the panel, where there is more
    let [_, _, panel, foot] = frame.rect("picture");
    let faded = |name: &str| frame.rect(name)[0] >= panel && frame.rect(name)[3] > foot - FADE;
    let texts = frame.names().into_iter().filter(|name| whole(name) && !faded(name)).filter(|name| {
        let switched_off = ["undo", "redo"].contains(name) && frame.value(name) == "false";
        let is_text =
            ["text ", "label ", "hint", "message", "scene", "view ", "group ", "A ", "B ", "map", "export", "look"];
        !switched_off && is_text.iter().any(|start| name.starts_with(start))
    });
    let mut seen = 0;
    for name in texts {
        assert_can_be_read(screen, frame, name, least, here);
        seen += 1;
    }
    assert!(seen > 15, "{here}: only {seen} texts were looked at");
}

fn assert_can_be_read(screen: &Screen, frame: &Frame, name: &str, least: f64, here: &str) {
    let [left, top, right, bottom] = frame.visible(name).map(|v| v.round() as u32);
    let ratio = contrast(&screen.pixels(left, top, right - left, bottom - top));
    assert!(ratio >= least, "{here}: the contrast of '{name}' is {ratio:.2}");
}

fn contrast(pixels: &[[u8; 3]]) -> f64 {
    let mut counts = std::collections::HashMap::new();
    pixels.iter().for_each(|p| *counts.entry(*p).or_insert(0) += 1);
    let (ground, _) = counts.iter().max_by_key(|(_, count)| **count).expect("a pixel");
    let ratio = |a: [u8; 3], b: [u8; 3]| {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    };
    counts.keys().map(|&colour| ratio(colour, *ground)).fold(1.0, f64::max)
}

/// Relative luminance of an sRGB colour, as WCAG 2.2 defines it.
fn luminance(colour: [u8; 3]) -> f64 {
    let [r, g, b] = colour.map(|byte| {
        let v = f64::from(byte) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    });
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
