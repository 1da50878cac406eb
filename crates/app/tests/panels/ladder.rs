//! The workspace of the ladder.

use crate::Panels;
use compare::Errors;
use egui::accesskit::Toggled;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use raster::{Repair, Repairs};
use visavis::model::{
    COMPARE, Destination, ExportRequest, ExportSubject, LADDER, LadderShows, LadderView, Model, Order, PaneId, Rung,
    RungFacts, Theme, TileErrors, ViewModel, repaired, repairs_of,
};
use visavis::ui::{UiCommand, Workspaces};

/// Three rungs, of which the last is worse than the one before it, and a fourth that is not measured yet.
fn shown() -> ViewModel {
    let mut ladder = LadderView { rungs: vec![None; Rung::COUNT], ..LadderView::default() };
    let sky = Rung::Repair(Repair::Sky);
    let antialiasing = Rung::Repair(Repair::Antialiasing);
    for (rung, rel_mse, anew_ms) in [
        (Rung::AsTaught, Some(0.5), 5.0),
        (Rung::Encoding, Some(0.25), 6.0),
        (antialiasing, Some(0.375), 42.0),
        (sky, None, 123.0),
    ] {
        let errors = rel_mse.map(|rel_mse| TileErrors { errors: Errors { rel_mse, ..Errors::default() }, flip: 0.125 });
        let pane = repaired(Repairs::NONE.with(Repair::Antialiasing));
        ladder.rungs[rung.place()] = Some(RungFacts { pane, errors, frame_ms: 2.5, anew_ms });
        ladder.climbed.push(rung);
    }
    ViewModel { ladder, ..ViewModel::default() }
}

fn panels(scene: &str, shown: ViewModel) -> Panels {
    let opened = scene::builtin::named(scene).expect("a built-in scene");
    let mut panels = Panels::with(Model::new(opened, scene.into(), Theme::Dark), Workspaces::default(), shown);
    press(&mut panels, Key::D, Modifiers::NONE);
    panels
}

fn press(panels: &mut Panels, key: Key, modifiers: Modifiers) {
    panels.harness.key_press_modifiers(modifiers, key);
    panels.harness.run_steps(3);
}

fn selected(panels: &Panels) -> Rung {
    panels.model.borrow().session.ladder.selected
}

#[test]
fn a_key_and_a_button_open_it_and_go_back_and_only_what_is_open_is_wanted() {
    let mut panels = panels("whitted", ViewModel::default());
    assert!(panels.model.borrow().session.is_in(LADDER) && panels.shows("What went wrong here?"));
    let wanted = panels.wanted();
    assert_eq!(wanted.panes.ids().count(), 0, "panes are not made meanwhile");
    let ladder = wanted.ladder.expect("rungs to climb");
    assert_eq!((&ladder.repairs, ladder.shot.size), (&repairs_of(&ladder.shot.scene).0, (480, 270)));
    panels.count_named();
    panels.click("Ladder", 0);
    assert!(panels.model.borrow().session.is_in(COMPARE) && panels.wanted().ladder.is_none());
    for (button, workspace) in [("Sweep", "sweep"), ("Ladder", "ladder"), ("Trees", "trees"), ("Compare", "compare")] {
        panels.click(button, 0);
        assert!(panels.model.borrow().session.is_in(workspace), "{button} is in the bar of every window");
    }
    press(&mut panels, Key::D, Modifiers::NONE);
    press(&mut panels, Key::Escape, Modifiers::NONE);
    assert_eq!(panels.wanted().panes.ids().collect::<Vec<_>>(), [PaneId::A, PaneId::B]);
}

#[test]
fn rows_say_the_error_that_is_left_what_is_taken_away_and_what_it_costs() {
    let panels = panels("whitted", shown());
    assert!(panels.shows("The fake as taught, relMSE 0.5000, 5.00 ms"));
    assert!(panels.shows("Light in place of bytes, relMSE 0.2500, taken away 0.2500, 6.00 ms"));
    assert!(panels.shows("Antialiasing, tessellation, relMSE 0.3750, taken away −0.1250, 42.0 ms"));
    assert!(panels.shows("A sky, not ambient light, no reference yet, 123 ms"));
    assert!(panels.shows("Soft shadows, waits ..."));
    let empty = self::panels("whitted", ViewModel::default());
    assert!(empty.shows("No reference yet, errors come with it"));
}

#[test]
fn what_a_scene_gives_nothing_to_repair_for_says_what_it_lacks_and_cannot_be_ticked() {
    let mut panels = panels("cornell", ViewModel::default());
    assert!(
        panels.shows("Mirrors that mirror, no mirror") && panels.shows("Bent at both interfaces, no sphere of glass")
    );
    let disabled = |panels: &Panels, label: &str| panels.harness.get_by_label(label).accesskit_node().is_disabled();
    assert!(disabled(&panels, "Climb Mirrors that mirror") && !disabled(&panels, "Climb Soft shadows"));
    let repairs = |panels: &Panels| panels.wanted().ladder.expect("rungs").repairs;
    let all = repairs(&panels);
    assert!(all.contains(&Repair::SoftShadows) && !all.contains(&Repair::Mirrors));
    panels.click("Climb Soft shadows", 0);
    assert!(repairs(&panels).len() == all.len() - 1 && !repairs(&panels).contains(&Repair::SoftShadows));
    assert!(panels.shows("Soft shadows, left out"));
    assert_eq!(panels.harness.get_by_label("Climb Soft shadows").accesskit_node().toggled(), Some(Toggled::False));
    press(&mut panels, Key::Z, Modifiers::COMMAND);
    assert_eq!(repairs(&panels), all, "undo ticks it again");
    panels.click("Repairs: none", 0);
    assert!(repairs(&panels).is_empty());
}

#[test]
fn a_rung_is_selected_by_mouse_and_keys_and_tells_its_paragraph_its_slide_and_its_cost() {
    let mut panels = panels("cornell", shown());
    panels.harness.get_by_label_contains("Light in place of bytes, relMSE").click();
    panels.harness.run_steps(3);
    assert_eq!(selected(&panels), Rung::Encoding);
    assert!(panels.shows("Its light is clamped") && panels.shows("Slide: Task 1 b: What went wrong here?"));
    let cost = "relMSE 0.2500, FLIP 0.1250 (0.2500 less than before); 6.00 ms a frame, 2.50 ms where maps stay.";
    assert!(panels.shows(cost));
    // with the keyboard on that row, and over those that the scene has nothing to repair for
    panels.model.borrow_mut().session.ladder.repairs =
        Repairs::NONE.with(Repair::Antialiasing).with(Repair::SoftShadows);
    press(&mut panels, Key::ArrowDown, Modifiers::NONE);
    assert_eq!(selected(&panels), Rung::Repair(Repair::Antialiasing));
    assert!(panels.shows("(0.1250 more than before)"));
    press(&mut panels, Key::ArrowDown, Modifiers::NONE);
    assert_eq!(selected(&panels), Rung::Repair(Repair::SoftShadows));
    press(&mut panels, Key::ArrowUp, Modifiers::NONE);
    assert_eq!(selected(&panels), Rung::Repair(Repair::Antialiasing));
}

#[test]
fn the_best_come_first_in_the_order_in_which_they_were_reached() {
    let mut view = shown();
    view.ladder.climbed.swap(2, 3);
    let mut panels = panels("whitted", view);
    panels.click("Order: best first", 0);
    assert_eq!(panels.wanted().ladder.expect("rungs").order, Order::BestFirst);
    let top = |label: &str| {
        let node = panels.harness.get_by_label_contains(label);
        node.accesskit_node().bounding_box().expect("a place").y0
    };
    assert!(top("A sky, not ambient light, ") < top("Antialiasing, tessellation, "));
}

#[test]
fn keys_and_the_bar_choose_what_a_rung_is_shown_beside_and_a_map_is_wanted_of_its_errors_alone() {
    let mut panels = panels("whitted", shown());
    assert!(panels.shows("Reference") && panels.wanted().ladder.expect("rungs").map.is_none());
    for (key, shows) in [Key::Num2, Key::Num3, Key::Num4, Key::Num1].into_iter().zip([
        LadderShows::Wipe,
        LadderShows::Step,
        LadderShows::Errors,
        LadderShows::Beside,
    ]) {
        press(&mut panels, key, Modifiers::NONE);
        assert_eq!(panels.model.borrow().session.ladder.shows, shows);
    }
    panels.click("Rung: errors", 0);
    let (rung, ..) = panels.wanted().ladder.expect("rungs").map.expect("a map");
    assert!(rung == Rung::AsTaught && panels.shows("the map of errors comes with the reference"));
    panels.count_named();
}

#[test]
fn a_rung_opens_as_a_with_the_truth_as_b() {
    let mut panels = panels("whitted", shown());
    // over the rung of fragments, whose picture is still to come, to that of light
    (0..2).for_each(|_| press(&mut panels, Key::ArrowDown, Modifiers::NONE));
    panels.click("Open in compare", 0);
    let model = panels.model.borrow();
    assert!(model.session.is_in(COMPARE));
    assert!(model.session.panes[PaneId::A].fake.repairs.has(Repair::Antialiasing));
}

#[test]
fn all_is_saved_as_a_folder_and_the_command_that_makes_it_is_copied() {
    let mut panels = panels("whitted", shown());
    panels.click("Save all rungs", 0);
    let command = panels.requests.borrow_mut().pop().expect("a command");
    let UiCommand::Export(ExportRequest { subject: ExportSubject::Ladder, to: Destination::File(folder) }) = command
    else {
        panic!("{command:?} is no export of a ladder")
    };
    assert!(folder.ends_with("visavis-whitted-ladder"), "{}", folder.display());
    panels.click("Copy the command that makes all rungs", 0);
    assert!(panels.shows("Copied the command that makes all rungs"));
    panels.click("Export", 0);
    assert!(panels.shows("The ladder") && !panels.shows("A alone"));
}
