//! The ruler in the window: where the errors are, and how far both are from the reference.

use super::export::export;
use super::{alone, both_whole, ready, says};
use film::{Image, LayerValues, Vec3};
use reference::{Key, Reference, STANDARD_ERROR, Store};
use std::path::Path;
use std::time::Duration;
use visavis_tests::{Frame, Screen, TestFolder, ViewerUnderTest};

fn close_to(pixel: [u8; 3], expected: [u8; 3]) -> bool {
    pixel.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 6)
}

#[test]
fn the_error_map_has_a_scale_that_can_be_held_and_is_exported_with_it() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, _) = ready(&screen, &["cornell"]);
    screen.key('5', false);
    let shown = viewer.wait_for("the map", |f| f.state("map") == "|A - B|" && f.shows("bar map"));
    screen.click(shown.point("map signed", 0.5, 0.5));
    let signed =
        viewer.wait_for("the signed map", |f| f.state("map") == "A - B" && f.value("bar map") == "blue-white-orange");
    screen.click(signed.point("picture", 0.5, 0.999));
    let [left, top, right, bottom] = signed.rect("bar map").map(|v| v.round() as u32);
    std::thread::sleep(std::time::Duration::from_millis(300));
    let bar = screen.pixels(left, top, right - left, bottom - top);
    let row = &bar[2 * (right - left) as usize..3 * (right - left) as usize];
    assert!(
        close_to(row[3], [0, 114, 178]) && close_to(row[row.len() - 4], [213, 94, 0]),
        "{:?}",
        (row[3], row.last())
    );
    assert!(close_to(row[row.len() / 2], [255; 3]));

    screen.click(signed.point("hold scale", 0.05, 0.5));
    let held = viewer.wait_for("the held scale", |f| f.value("hold scale") == "true");
    let end = held.value("scale end").to_owned();
    let (png, exr) = (viewer.home().join("map.png"), viewer.home().join("map.exr"));
    export(&screen, &mut viewer, &["export The error map"], &png);
    export(&screen, &mut viewer, &["export The error map"], &exr);
    let records = image_file::records(&png).expect("records");
    let value =
        |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, v)| v.clone()).unwrap_or_default();
    assert_eq!([value("map"), value("colours")], ["A - B", "blue-white-orange"]);
    assert_eq!([value("low"), value("high")], [format!("-{end}"), end]);
    assert!(value("B").contains("visavis render cornell"));
    let layers = exr::prelude::read_all_data_from_file(&exr).expect("an EXR").layer_data;
    let names: Vec<_> =
        layers.iter().filter_map(|l| l.attributes.layer_name.as_ref()).map(ToString::to_string).collect();
    assert_eq!(names, ["A", "B", "signed", "absolute", "relative", "squared-relative", "flip"]);

    // FLIP has a scale of its own; another view has neither map nor its controls
    screen.click(signed.point("map FLIP", 0.5, 0.5));
    viewer.wait_for("FLIP", |f| f.state("map") == "FLIP" && !f.shows("hold scale"));
    screen.key('3', false);
    viewer.wait_for("the wipe", |f| f.state("map").is_null() && !f.shows("map FLIP"));
}

/// What the viewer would have made, but for one picture and its numbers.
fn almost_done(size: (u32, u32)) -> Reference {
    let pixels = (size.0 * size.1) as usize;
    let grey = |value: f32| vec![Vec3::splat(value); pixels];
    let image = Image::new(size.0, size.1, grey(0.5)).expect("pixels of that size");
    let image = image.with_layer(STANDARD_ERROR, LayerValues::Rgb(grey(0.05).into()));
    Reference { image, replicates: 15, seconds: 119.999, nonfinite: 0 }
}

/// Chooses the reference for two fakes, which are done at once, and makes the window small: its reference takes less
/// time.
fn choose_the_reference(screen: &Screen, viewer: &mut ViewerUnderTest) -> Frame {
    let first = viewer.wait_for("both pictures", both_whole);
    let window = screen.focus("Visavis");
    assert!(!first.shows("text reference") && !first.shows("reference file"));
    screen.click(first.point("B raster", 0.5, 0.5));
    let fakes = viewer.wait_for("two fakes", |f| f.state("b")["label"] == "fake (raster, fair)" && both_whole(f));
    screen.click(fakes.point("group Compare with", 0.2, 0.5));
    let open = viewer.wait_for_widget("compare with the reference");
    screen.click(open.point("compare with the reference", 0.5, 0.5));
    viewer.wait_for("the reference", |f| {
        f.shows("text reference") && f.shows("reference file") && !f.value("label A").contains("A - B")
    });
    screen.key('4', false);
    screen.resize(window, 480, 320);
    viewer.wait_for("the small window", |f| {
        f.state("view") == "Side by side" && f.state("picture_size")[1].as_u64() < Some(320) && both_whole(f)
    })
}

#[test]
fn a_reference_is_made_while_the_panes_rest_kept_and_there_at_once_the_second_time() {
    let _alone = alone();
    let folder = TestFolder::new();
    let store = Store::new(folder.file("store"), Store::MOST_BYTES);
    let binary = Path::new(env!("CARGO_BIN_EXE_visavis"));
    let start =
        |screen: &Screen| ViewerUnderTest::start_cached(binary, screen, store.folder(), &["hard/light-touching-wall"]);
    let screen = Screen::start(1280, 720);
    let mut viewer = start(&screen);
    let small = choose_the_reference(&screen, &mut viewer);
    let side = |i: usize| small.state("picture_size")[i].as_u64().expect("a size") as u32;
    let scene = scene::builtin::named("hard/light-touching-wall").expect("a scene");
    let size = (side(0), side(1));
    let key = Key::of(&technique::Shot::of(scene.clone(), size));
    store.put(key, &almost_done(size), Vec::new()).expect("a store");

    // another view and back: what is looked up now is there, and is gone on with once the panes are done
    screen.key('1', false);
    viewer.wait_for("another size", |f| f.state("view") == "A" && f.state("picture_size")[0] != size.0);
    screen.key('4', false);
    let judged = |f: &Frame| f.value("label A").contains("A - reference: relMSE");
    let found = viewer.wait_for("the reference from the store", |f| judged(f) && f.state("view") == "Side by side");
    assert!(found.state("reference")[0].as_u64() >= Some(15));
    viewer.wait_for("one picture more", |f| f.state("reference")[0] == 16 && f.state("reference")[1] == 1);
    // it is shown before it is on the disk
    let kept = (0..200).any(|_| {
        std::thread::sleep(Duration::from_millis(50));
        store.get(key).is_some_and(|kept| kept.replicates == 16)
    });
    assert!(kept, "the reference is not kept");
    screen.key('q', true);
    assert!(viewer.wait_for_end().success());

    let mut viewer = start(&screen);
    choose_the_reference(&screen, &mut viewer);
    viewer.wait_for("the reference at once", |f| judged(f) && f.state("reference")[0] == 16);
    screen.key('5', false);
    viewer.wait_for("a map that waits for its reference", |f| {
        f.value("label no map").contains("reference: 0 of 16 pictures")
    });
}

/// Types a file's name into the panel.
fn load(screen: &Screen, viewer: &mut ViewerUnderTest, file: &str) {
    let frame = viewer.wait_for_widget("reference file");
    screen.click(frame.point("reference file", 0.5, 0.5));
    viewer.wait_for("the cursor in the field", |f| f.state("typing") == true);
    screen.key('a', true);
    screen.type_text(file);
    viewer.wait_for("the typed name", |f| f.value("reference file") == file);
    screen.press(Screen::ENTER);
    viewer.wait_for("the field to be left", |f| f.state("typing") == false);
}

#[test]
fn a_reference_from_a_file_is_taken_if_it_fits() {
    let _alone = alone();
    let folder = TestFolder::new();
    let screen = Screen::start(1280, 720);
    let (mut viewer, first) = ready(&screen, &["hard/light-touching-wall"]);
    screen.click(first.point("group Compare with", 0.2, 0.5));
    let open = viewer.wait_for_widget("compare with the reference");
    screen.click(open.point("compare with the reference", 0.5, 0.5));
    let size = |f: &Frame, i: usize| f.state("picture_size")[i].as_u64().expect("a size") as u32;
    let fitting = Reference { replicates: 64, ..almost_done((size(&open, 0), size(&open, 1))) };
    let write = |name: &str, reference: &Reference| {
        std::fs::write(folder.file(name), reference.encode(Vec::new()).expect("an EXR")).expect("a file");
        folder.file(name).display().to_string()
    };
    let (good, small) = (write("good.exr", &fitting), write("small.exr", &almost_done((8, 8))));
    let none = folder.file("none.exr").display().to_string();
    load(&screen, &mut viewer, &none);
    viewer.wait_for("the refusal", |f| says(f, "cannot read the picture") && says(f, "none.exr"));
    load(&screen, &mut viewer, &small);
    viewer.wait_for("the other refusal", |f| says(f, "the reference has 8x8 pixels") && says(f, "small.exr"));
    load(&screen, &mut viewer, &good);
    viewer.wait_for("the loaded reference", |f| f.value("text reference").starts_with("reference: good.exr"));
    viewer.wait_for("both judged by it", |f| {
        f.value("label A").contains("A - reference") && f.value("label B").contains("B - reference")
    });
    // T goes from A's errors to B's
    screen.key('5', false);
    viewer.wait_for("the map of A", |f| f.state("map") == "|A - reference|");
    screen.key('t', false);
    viewer.wait_for("the map of B", |f| f.state("map") == "|B - reference|" && f.state("view") == "Error map");
}
