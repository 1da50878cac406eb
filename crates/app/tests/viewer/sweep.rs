//! A sweep in the window: its tiles come, are measured, kept, and saved as one picture.

use super::export::{export, run};
use super::{User, both_whole, says};
use egui::Key;
use visavis::model::{Axis, COMPARE, SWEEP, SweepSettings};
use visavis_tests::{Frame, place_of};

/// Opens the sweep of a setting.
fn sweep(user: &mut User, columns: Axis) -> Frame {
    user.change(|model| {
        model.session.workspace = SWEEP;
        model.session.sweep = SweepSettings { columns, ..SweepSettings::default() };
        model.session.panes[visavis::model::PaneId::B].truth.spp = 4;
    });
    user.wait_for("all tiles", all_done)
}

fn tiles(frame: &Frame) -> Vec<serde_json::Value> {
    frame.state("sweep")["tiles"].as_array().cloned().unwrap_or_default()
}

fn all_done(frame: &Frame) -> bool {
    tiles(frame).len() == 3 && tiles(frame).iter().all(|tile| tile["done"] == true)
}

#[test]
fn all_tiles_are_saved_as_one_picture_of_what_their_commands_render() {
    let mut user = User::beside("cornell", egui::vec2(800.0, 500.0), 1.0, technique::DeviceChoice::Cpu);
    let done = sweep(&mut user, Axis::new("bounces", "0, 1, 2"));
    assert!(tiles(&done).iter().all(|tile| tile["spp"] == 4 && tile["fault"].is_null()), "{done:?}");
    assert_eq!(done.state("a")["ready"], false, "panes are not made meanwhile");
    let file = user.file("sweep.png");
    export(&mut user, &["The sweep"], &file);
    let whole = image::open(&file).expect("a picture").to_rgba8();
    let records = image_file::records(&file).expect("records");
    for index in 1..=3 {
        let name = format!("tile {index}");
        let (_, command) = records.iter().find(|(known, _)| *known == name).expect("a record");
        let out = user.file("one.png");
        run(command, &out);
        let one = image::open(&out).expect("a picture").to_rgba8();
        let place = place_of((one.dimensions(), one.as_raw()), (whole.dimensions(), whole.as_raw()));
        assert!(place.is_some(), "{command}");
    }
    user.change(|model| {
        model.session.workspace = COMPARE;
        model.session.sweep = SweepSettings::default();
    });
    user.drop_file(&file);
    let opened = user.wait_for("the sweep again", |frame| frame.state("sweep")["open"] == true && all_done(frame));
    assert!(opened.shows("tile 3") && opened.value("Values of Columns") == "0, 1, 2", "{opened:?}");
    let table = user.file("sweep.csv");
    export(&mut user, &["Its table"], &table);
    assert_eq!(std::fs::read_to_string(&table).expect("a table").lines().count(), 4);
}

#[test]
fn tiles_are_measured_by_the_reference_and_the_error_falls_with_samples() {
    let mut user = User::beside("cornell", egui::vec2(600.0, 420.0), 1.0, technique::DeviceChoice::Cpu);
    sweep(&mut user, Axis::new("spp", "1, 4, 16"));
    let measured = user.wait_for("errors", |frame| tiles(frame).iter().all(|tile| tile["rel_mse"].is_number()));
    let errors: Vec<f64> = tiles(&measured).iter().filter_map(|tile| tile["rel_mse"].as_f64()).collect();
    // by four at each step, with what two pictures' reference adds
    assert!(errors[0] > 2.0 * errors[1] && errors[1] > 2.0 * errors[2], "{errors:?}");
}

#[test]
fn tiles_that_are_known_are_there_again_at_once_and_only_new_ones_are_made() {
    let mut user = User::beside("cornell", egui::vec2(800.0, 500.0), 1.0, technique::DeviceChoice::Cpu);
    let first = sweep(&mut user, Axis::new("spp", "1, 2, 64"));
    let seconds = |frame: &Frame| tiles(frame).iter().map(|tile| tile["seconds"].as_f64()).collect::<Vec<_>>();
    user.key(Key::Escape);
    user.wait_for("the comparison", both_whole);
    user.key(Key::S);
    let again = user.wait_for("all tiles", all_done);
    assert_eq!(seconds(&again), seconds(&first), "they were not made anew");
    user.change(|model| model.session.sweep.columns = Axis::new("spp", "1, 3, 64"));
    let other = user.wait_for("the new tile", |frame| all_done(frame) && tiles(frame)[1]["spp"] == 3);
    let kept = |frame: &Frame| [0, 2].map(|place| seconds(frame)[place]);
    assert_eq!(kept(&other), kept(&first));
    user.key(Key::R);
    let anew = user.wait_for("all anew", |frame| all_done(frame) && seconds(frame) != seconds(&other));
    assert_ne!(seconds(&anew)[2], seconds(&first)[2]);
}

#[test]
fn a_sweep_that_is_left_or_changed_ends_at_once() {
    let mut user = User::beside("cornell", egui::vec2(800.0, 500.0), 1.0, technique::DeviceChoice::Cpu);
    user.change(|model| {
        model.session.workspace = SWEEP;
        model.session.sweep = SweepSettings::default();
        // hours of work
        model.session.sweep.columns = Axis::new("spp", "1000000, 2000000");
    });
    user.wait_for("first pictures", |frame| {
        tiles(frame).iter().filter(|tile| tile["spp"].as_u64() > Some(0)).count() == 2
    });
    user.change(|model| model.session.sweep.columns = Axis::new("spp", "1, 2, 3"));
    user.wait_for("the other sweep", all_done);
    user.key(Key::S);
    user.wait_for("the comparison", both_whole);
    user.key(Key::S);
    user.change(|model| model.session.sweep.columns = Axis::new("spp", "1000000, 2000000"));
    user.wait_for("first pictures", |frame| tiles(frame).len() == 2);
    user.click("Save the sweep as PNG");
    user.wait_for("a refusal", |frame| says(frame, "not all tiles are done yet"));
}

#[test]
fn a_picture_that_is_saved_in_the_middle_of_typing_opens_as_what_it_shows() {
    let mut user = User::beside("cornell", egui::vec2(800.0, 500.0), 1.0, technique::DeviceChoice::Cpu);
    sweep(&mut user, Axis::new("bounces", "0, 1, 2"));
    user.change(|model| model.session.sweep.columns = Axis::new("bounces", "0, 1, mny"));
    user.wait_for("the fault", |frame| frame.value("text sweep fault").contains("bounces=mny"));
    let file = user.file("sweep.png");
    export(&mut user, &["The sweep"], &file);
    user.change(|model| {
        model.session.workspace = COMPARE;
        model.session.sweep = SweepSettings::default();
    });
    user.drop_file(&file);
    let opened = user.wait_for("the sweep again", |frame| frame.state("sweep")["open"] == true && all_done(frame));
    assert_eq!(opened.value("Values of Columns"), "0, 1, 2");
}

#[test]
fn a_picture_of_the_command_line_opens_as_its_sweep() {
    let mut user = User::beside("whitted", egui::vec2(800.0, 500.0), 1.0, technique::DeviceChoice::Cpu);
    let file = user.file("sheet.png");
    run(
        "visavis sweep cornell technique=path,whitted,photon --of path,spp=3,seed=5 --size 32x24 --exposure 1 -o s.png --device cpu",
        &file,
    );
    user.drop_file(&file);
    let opened = user.wait_for("its sweep", |frame| frame.state("sweep")["open"] == true && all_done(frame));
    assert_eq!(opened.value("Values of Columns"), "path, whitted, photon");
    assert!(tiles(&opened).iter().all(|tile| tile["spp"] == 3), "{opened:?}");
    user.change(|model| {
        assert_eq!((model.document.source.as_str(), model.session.display.exposure), ("cornell", 1.0));
        assert_eq!(model.session.panes[visavis::model::PaneId::B].truth.path.seed, 5);
    });
}
