//! Looking closer: figures of a region, and pixels under the loupe.

use super::export::export;
use super::{User, both_whole};
use compare::{Histogram, errors_within};
use egui::{Key, Modifiers};
use film::{DisplayTransform, Image};
use visavis::model::{PaneId, Region};
use visavis::ui::Workspaces;
use visavis_tests::Frame;

/// Both pictures, and B has all its samples.
fn both_done(frame: &Frame) -> bool {
    both_whole(frame) && frame.state("b")["unfinished"] == false
}

fn user_of_few_samples() -> User {
    let mut user = User::of("cornell");
    user.change(|model| model.session.panes[PaneId::B].truth.spp = 2);
    user.wait_for("both pictures in full", both_done);
    user
}

/// The radiance of a pane, by its export.
fn film(user: &mut User, pane: &str, name: &str) -> (Image, Vec<(String, String)>) {
    let file = user.file(name);
    export(user, &[&format!("{pane} alone"), "EXR linear"], &file);
    (image_file::load(&file).expect("an EXR"), image_file::records(&file).expect("records"))
}

#[test]
fn all_figures_are_those_of_the_region_and_say_so() {
    let mut user = user_of_few_samples();
    let whole = user.frame();
    let (_, records) = film(&mut user, "A", "whole.exr");
    assert!(!records.iter().any(|(name, _)| name == "error.region"));
    let region = Region { start: [0.4, 0.5], end: [0.6, 0.9] };
    user.change(|model| model.session.comparison.region = Some(region));
    let marked =
        user.wait_for("figures of the region", |f| f.value("label A").contains("In the region: differs from B"));
    let told = marked.state("a")["rel_mse"].as_f64().expect("an error");
    assert!((told / whole.state("a")["rel_mse"].as_f64().expect("an error") - 1.0).abs() > 0.05, "{told}");
    let ((a, records), (b, _)) = (film(&mut user, "A", "a.exr"), film(&mut user, "B", "b.exr"));
    let errors = errors_within(&a, &b, &region.pixels(a.size())).expect("one size");
    assert!((errors.rel_mse / told - 1.0).abs() < 1e-9, "{} and {told}", errors.rel_mse);
    let record = records.iter().find(|(name, _)| name == "error.region").map(|(_, value)| &**value);
    assert_eq!(record, Some("0.4 0.5 0.6 0.9"));

    user.key(Key::Num5);
    let map = user.wait_for("the map", |f| f.value("label map").contains("mean in the region"));
    let mean = visavis::ruler::brief(errors.bias);
    assert!(map.value("label map").contains(&format!("mean in the region {mean}")), "{}", map.value("label map"));
    user.key(Key::M);
    user.wait_for("the whole", |f| !f.value("label map").contains("region") && f.value("label map").contains("mean"));
}

#[test]
fn a_picture_as_seen_says_its_region_and_how_it_was_magnified_and_opens_with_the_region() {
    let mut user = user_of_few_samples();
    let region = Region { start: [0.25, 0.5], end: [0.75, 0.875] };
    user.change(|model| {
        model.session.comparison.region = Some(region);
        model.state.magnification = model.state.magnification.by(4, [0.5; 2]);
    });
    user.wait_for("the region", |f| {
        f.value("label A").contains("In the region") && f.value("label magnification") == "4x"
    });
    let file = user.file("seen.png");
    user.export_as_seen(&file);
    let records = image_file::records(&file).expect("records");
    let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| &**value);
    assert_eq!((value("region"), value("magnified")), (Some("0.25 0.5 0.75 0.875"), Some("4x from 0.375 0.375")));
    user.key(Key::M);
    user.open(&file.display().to_string());
    user.wait_for("its region", |f| f.state("region") == &serde_json::json!([region.start, region.end]));
}

/// What is under the mouse, in numbers, is what the pictures' files have there.
#[test]
fn the_loupe_reads_the_pixel_under_the_mouse_magnified_or_not() {
    let mut user = user_of_few_samples();
    let (a, _) = film(&mut user, "A", "a.exr");
    user.key(Key::Num1);
    let shown = user.key(Key::I);
    let (width, height) = a.size();
    let at = [0.3 + 0.25 / width as f32, 0.6 + 0.25 / height as f32];
    let said = |image: &Image| {
        let pixel = image.at((at[0] * width as f32) as u32, (at[1] * height as f32) as u32).expect("a pixel");
        let byte = DisplayTransform::default().rgba8(pixel)[0];
        format!("A: R {} ({byte})", visavis::ruler::brief(f64::from(pixel.x)))
    };
    let point = shown.point("picture", at[0], at[1]);
    user.wheel(point, Modifiers::SHIFT);
    let frame = user.wheel(point, Modifiers::SHIFT);
    assert_eq!(frame.state("magnification"), 4);
    let loupe = user.wait_for("the loupe", |f| f.shows("loupe under the mouse"));
    let text = loupe.value("loupe under the mouse");
    assert!(text.starts_with(&said(&a)) && text.contains("\nA - B: "), "{text}: {}", said(&a));
    assert!(!user.key(Key::I).shows("loupe under the mouse"));
}

#[test]
fn histograms_are_counted_while_their_card_is_open_and_of_the_region() {
    let mut user = user_of_few_samples();
    let wanted = |user: &User| Workspaces::default().open().wanted(&user.viewer.borrow().model).histograms;
    assert!(!wanted(&user), "closed at first");
    user.scroll_to("Histogram");
    user.click("Histogram");
    let whole = user.wait_for("the histogram", |f| {
        f.value("histogram").contains("A: ") && f.value("histogram").contains("B: median")
    });
    let (b, _) = film(&mut user, "B", "b.exr");
    let said = |median: Option<f32>| format!("B: median {:+.1} stops", median.expect("a median"));
    let of_whole = said(Histogram::of(b.radiances().iter()).median());
    assert!(whole.value("histogram").contains(&of_whole), "{of_whole}: {}", whole.value("histogram"));
    // the lamp, which is bright
    let region = Region { start: [0.46, 0.155], end: [0.54, 0.175] };
    let within = region.pixels(b.size());
    let of_region = said(Histogram::of(within.of(b.radiances(), b.width())).median());
    assert_ne!(of_region, of_whole);
    user.change(|model| model.session.comparison.region = Some(region));
    user.wait_for(&of_region, |f| {
        f.value("histogram").contains("in the region") && f.value("histogram").contains(&of_region)
    });
    user.click("Histogram");
    assert!(!wanted(&user), "closed again");
}
