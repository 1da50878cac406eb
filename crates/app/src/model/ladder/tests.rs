//! What the workspace of the ladder asks for, and what it says of what has come.

use super::*;
use crate::model::Theme;
use compare::Errors;

fn model(scene: &str) -> Model {
    Model::new(scene::builtin::named(scene).unwrap(), scene.into(), Theme::Dark)
}

fn facts(rel_mse: f64) -> RungFacts {
    let errors = TileErrors { errors: Errors { rel_mse, ..Errors::default() }, flip: 0.0 };
    RungFacts { pane: repaired(Repairs::NONE), errors: Some(errors), frame_ms: 1.0, anew_ms: 2.0 }
}

#[test]
fn another_map_is_the_same_ladder_and_another_repair_order_or_camera_is_not() {
    let mut model = model("whitted");
    let first = model.wanted_ladder();
    assert_eq!((&first.repairs, first.shot.size, first.map), (&repairs_of(&first.shot.scene).0, (480, 270), None));
    model.session.ladder.shows = LadderShows::Errors;
    model.session.ladder.selected = Rung::Encoding;
    assert!(model.wanted_ladder().is_of_the_same_ladder(&first) && model.wanted_ladder().map.is_some());
    let changes: [fn(&mut Model); 4] = [
        |model| model.session.ladder.repairs = Repairs::ALL.without(Repair::Sky),
        |model| model.session.ladder.order = Order::BestFirst,
        |model| model.document.camera.eye.x += 0.1,
        |model| model.state.restarts += 1,
    ];
    for change in changes {
        let before = model.wanted_ladder();
        change(&mut model);
        assert!(!model.wanted_ladder().is_of_the_same_ladder(&before));
    }
}

#[test]
fn what_a_rung_takes_away_is_told_against_the_one_that_was_reached_before_it() {
    let mut view = LadderView { rungs: vec![None; Rung::COUNT], ..LadderView::default() };
    let sky = Rung::Repair(Repair::Sky);
    for (rung, error) in [(Rung::AsTaught, 1.0), (sky, 0.25), (Rung::Encoding, 0.5)] {
        view.rungs[rung.place()] = Some(facts(error));
        view.climbed.push(rung);
    }
    let taken = [Rung::AsTaught, sky, Rung::Encoding, Rung::Path].map(|rung| view.taken_by(rung));
    assert_eq!(taken, [None, Some(0.75), Some(-0.25), None]);
    assert_eq!(view.rows(Order::Light)[..2], [Rung::AsTaught, Rung::Fragments]);
    let best = view.rows(Order::BestFirst);
    assert_eq!((&best[..3], best.len(), best.last()), (&view.climbed[..], Rung::COUNT, Some(&Rung::Path)));
}

#[test]
fn the_keys_step_over_what_is_not_climbed() {
    let mut model = model("cornell");
    model.session.ladder.repairs = Repairs::NONE.with(Repair::SoftShadows).with(Repair::Mirrors);
    let rows: Vec<Rung> = Rung::all().collect();
    let mut seen = Vec::new();
    for _ in 0..5 {
        seen.push(model.session.ladder.selected);
        model.step_on_the_ladder(&rows, 1);
    }
    let soft = Rung::Repair(Repair::SoftShadows);
    assert_eq!(seen, [Rung::AsTaught, Rung::Encoding, soft, Rung::Whitted, Rung::Path]);
    model.step_on_the_ladder(&rows, -2);
    assert_eq!(model.session.ladder.selected, soft);
}

#[test]
fn a_rung_becomes_a_and_the_truth_b_and_undo_brings_both_back() {
    let mut model = model("cornell");
    model.session.workspace = crate::model::LADDER;
    let before = model.session.panes.clone();
    let rung = repaired(Repairs::NONE.with(Repair::SoftShadows));
    model.compare_rung(Rung::Repair(Repair::SoftShadows), rung);
    model.settle(false);
    let panes = &model.session.panes;
    assert!(model.session.is_in(COMPARE) && panes[PaneId::A].fake == rung.fake);
    assert_eq!(panes[PaneId::B].technique, TechniqueName::Path);
    model.undo();
    assert_eq!(model.session.panes, before);
}

#[test]
fn the_command_says_what_is_left_out_and_the_order() {
    let mut model = model("cornell");
    let command = model.ladder_command();
    assert!(command.starts_with("visavis ladder cornell -o ladder --size 480x270 --eye"), "{command}");
    assert!(command.ends_with(" --order light"), "{command}");
    model.session.ladder.order = Order::BestFirst;
    model.session.ladder.repairs = Repairs::NONE.with(Repair::Antialiasing);
    let command = model.ladder_command();
    assert!(command.ends_with(" --order best-first --repairs antialiasing"), "{command}");
}
