//! A ladder in the window: its rungs are reached one by one, measured, kept, and saved as a folder.

use super::User;
use super::export::export;
use raster::{Repair, Repairs};
use visavis::model::{LADDER, LadderShows, Order, Rung};
use visavis_tests::Frame;

fn climb(scene: &str, repairs: Repairs) -> User {
    let mut user = User::beside(scene, egui::vec2(1280.0, 720.0), 1.0, technique::DeviceChoice::Cpu);
    user.change(|model| {
        model.session.workspace = LADDER;
        model.session.ladder.repairs = repairs;
    });
    user
}

fn rungs(frame: &Frame) -> Vec<serde_json::Value> {
    frame.state("ladder")["rungs"].as_array().cloned().unwrap_or_default()
}

fn names(frame: &Frame) -> Vec<String> {
    rungs(frame).iter().filter_map(|rung| Some(rung["name"].as_str()?.to_owned())).collect()
}

/// Whether it goes up to the truth, and all of it is measured and shown.
fn is_whole(frame: &Frame) -> bool {
    let told = |rung: &serde_json::Value| rung["rel_mse"].is_number() && rung["picture"] == true;
    names(frame).last().is_some_and(|name| name == "path") && rungs(frame).iter().all(told)
}

#[test]
fn rungs_are_reached_and_measured_and_another_choice_of_repairs_starts_anew_with_what_is_known() {
    let mut user = climb("cornell", Repairs::ALL);
    let all = user.wait_for("all rungs with errors", is_whole);
    assert_eq!(names(&all)[..4], ["as-taught", "encoding", "antialiasing", "soft-shadows"]);
    assert_eq!(all.state("a")["ready"], false, "panes are not made meanwhile");
    let figure = |frame: &Frame, name: &str, of: &str| {
        let rung = rungs(frame).into_iter().find(|rung| rung["name"] == name).expect("the rung");
        rung[of].as_f64().expect("a figure")
    };
    let [taught, fair, path] = ["as-taught", "encoding", "path"].map(|name| figure(&all, name, "rel_mse"));
    assert!(taught > 3.0 * fair && fair > 5.0 * path, "{taught} {fair} {path}");
    assert!(figure(&all, "antialiasing", "anew_ms") > 0.0);
    // a map of the rung that is looked at
    user.change(|model| {
        model.session.ladder.shows = LadderShows::Errors;
        model.session.ladder.selected = Rung::Repair(Repair::SoftShadows);
    });
    user.wait_for("its map", |frame| frame.state("ladder")["map"] == "soft-shadows");
    // saved as the command line does
    let folder = user.file("ladder");
    export(&mut user, &["The ladder"], &folder);
    let table = std::fs::read_to_string(folder.join("ladder.csv")).expect("a table");
    assert_eq!(table.lines().count(), 1 + rungs(&all).len());
    for file in ["00-as-taught.png", "03-soft-shadows.png", "ladder.svg", "sheet.png"] {
        assert!(folder.join(file).is_file(), "{file}");
    }
    // what is known is there again with the times that were measured
    let before = figure(&all, "path", "anew_ms");
    user.change(|model| model.session.ladder.repairs = Repairs::ALL.without(Repair::Antialiasing));
    let fewer = user.wait_for("one rung less", |frame| is_whole(frame) && rungs(frame).len() + 1 == rungs(&all).len());
    assert!(!names(&fewer).iter().any(|name| name == "antialiasing"));
    assert_eq!(figure(&fewer, "path", "anew_ms"), before);
    // of the best first, a reference that is there already is enough
    user.change(|model| {
        model.session.ladder.repairs = Repairs::ALL;
        model.session.ladder.order = Order::BestFirst;
    });
    let best = user.wait_for("the best first", |frame| is_whole(frame) && rungs(frame).len() == rungs(&all).len());
    assert_eq!(names(&best)[0], "as-taught");
}

#[test]
fn what_is_left_is_not_climbed_on_and_the_comparison_is_there_again() {
    let mut user = climb("cornell", Repairs::NONE);
    user.wait_for("a rung", |frame| !rungs(frame).is_empty());
    user.key(egui::Key::D);
    let back = user.wait_for("the comparison", super::both_whole);
    assert_eq!((back.state("ladder")["open"].as_bool(), rungs(&back).len()), (Some(false), 0));
}
