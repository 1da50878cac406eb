//! The map of the errors, as it is on the screen.

use super::export::export;
use super::{alone, ready};
use visavis_tests::Screen;

fn close_to(pixel: [u8; 3], expected: [u8; 3]) -> bool {
    pixel.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 6)
}

#[test]
fn the_error_map_has_a_scale_that_can_be_held_and_is_exported_with_it() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, _) = ready(&screen, &["cornell"]);
    screen.key('5', false);
    let shown = viewer.wait_for("the map", |f| f.state("map") == "A - B" && f.shows("bar map"));
    screen.click(shown.point("map signed", 0.5, 0.5));
    let signed =
        viewer.wait_for("the signed map", |f| f.state("map") == "A - B" && f.value("bar map") == "blue-white-orange");
    screen.click(signed.point("picture", 0.5, 0.999));
    let [left, top, right, bottom] = signed.rect("bar map").map(|v| v.round() as u32);
    std::thread::sleep(std::time::Duration::from_millis(300));
    let bar = screen.pixels(left, top, right - left, bottom - top);
    let row = &bar[2 * (right - left) as usize..3 * (right - left) as usize];
    assert!(
        close_to(row[1], [0, 114, 178]) && close_to(row[row.len() - 2], [213, 94, 0]),
        "{:?}",
        (row[1], row[row.len() - 2])
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
