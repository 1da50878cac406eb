//! The workspace of sweeps.

use crate::Panels;
use compare::Errors;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use visavis::model::{
    Axis, Destination, Equal, ExportRequest, ExportSubject, Model, PaneId, SWEEP, SweepFile, SweepMeasure, Theme,
    TileErrors, TileFacts, ViewModel,
};
use visavis::ui::{UiCommand, Workspaces};

/// Three tiles that are done, of which the second has the least relMSE and the third the least RMSE.
fn shown() -> ViewModel {
    let mut shown = ViewModel::default();
    let tile = |(spp, rel_mse, rmse): (u32, f64, f64)| TileFacts {
        spp: Some(spp),
        seconds: 0.25,
        errors: Some(TileErrors { errors: Errors { rel_mse, rmse, ..Errors::default() }, flip: 0.5 }),
        done: true,
        edited: None,
        fault: None,
    };
    shown.sweep.tiles = [(1, 0.4, 0.3), (4, 0.1, 0.2), (16, 0.2, 0.1)].map(tile).into();
    shown
}

fn panels(shown: ViewModel) -> Panels {
    let scene = scene::builtin::named("cornell").expect("a built-in scene");
    let mut panels = Panels::with(Model::new(scene, "cornell".into(), Theme::Dark), Workspaces::default(), shown);
    press(&mut panels, Key::S, Modifiers::NONE);
    panels
}

fn press(panels: &mut Panels, key: Key, modifiers: Modifiers) {
    panels.harness.key_press_modifiers(modifiers, key);
    panels.harness.run_steps(3);
}

fn type_values(panels: &mut Panels, name: &str, values: &str) {
    panels.harness.get_by_label(name).focus();
    panels.harness.run_steps(1);
    panels.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    panels.harness.run_steps(1);
    panels.harness.get_by_label(name).type_text(values);
    panels.harness.run_steps(3);
}

#[test]
fn a_key_and_a_button_open_it_and_go_back_and_only_what_is_open_is_wanted() {
    let mut panels = panels(ViewModel::default());
    let wanted = panels.wanted();
    assert!(
        panels.model.borrow().session.is_in(SWEEP) && panels.shows("Ready sweeps") && !panels.shows("Side by side")
    );
    assert_eq!(wanted.panes.ids().count(), 0, "panes are not made meanwhile");
    let sweep = wanted.sweep.expect("tiles to make");
    assert_eq!(sweep.plan.tiles.len(), 3);
    let (width, height) = sweep.shot.size;
    assert!(width >= height && width > 250 && 16 * height >= 9 * width - 32, "{width} x {height}");
    panels.count_named();
    panels.click("Sweep", 0);
    assert!(panels.wanted().sweep.is_none() && panels.shows("Side by side"));
    panels.click("Sweep", 0);
    press(&mut panels, Key::Escape, Modifiers::NONE);
    assert_eq!(panels.wanted().panes.ids().collect::<Vec<_>>(), [PaneId::A, PaneId::B]);
}

#[test]
fn a_narrow_window_has_it_in_the_menu_of_slides() {
    let mut panels = panels(ViewModel::default());
    panels.harness.set_size([683.0, 512.0].into());
    press(&mut panels, Key::Escape, Modifiers::NONE);
    assert!(panels.harness.query_by_label("Sweep").is_none(), "the bar has room for one row");
    for (item, open) in [("Many pictures at once (S)", true), ("Back to the comparison (S)", false)] {
        panels.click("Slides", 0);
        panels.click(item, 0);
        assert_eq!(panels.model.borrow().session.is_in(SWEEP), open);
    }
}

#[test]
fn captions_tell_samples_seconds_and_the_chosen_error_of_which_the_least_is_marked() {
    let mut panels = panels(shown());
    assert!(panels.shows("1 spp: 1 spp, 0.25 s, relMSE 0.400"));
    assert!(panels.shows("4 spp: 4 spp, 0.25 s, relMSE 0.100, best"));
    panels.click("Error: RMSE", 0);
    assert_eq!(panels.model.borrow().session.sweep.measure, SweepMeasure::Rmse);
    assert!(panels.shows("16 spp: 16 spp, 0.25 s, RMSE 0.100, best") && !panels.shows("RMSE 0.200, best"));
}

#[test]
fn a_tile_becomes_a_or_b_by_mouse_and_keys_and_the_comparison_is_there_again() {
    let spp = |panels: &Panels, pane| panels.model.borrow().session.panes[pane].wished_spp();
    let mut panels = panels(shown());
    panels.harness.get_by_label_contains("4 spp: 4 spp").click();
    panels.harness.run_steps(3);
    assert_eq!((spp(&panels, PaneId::A), panels.model.borrow().session.is_in(SWEEP)), (Some(4), false));
    press(&mut panels, Key::S, Modifiers::NONE);
    panels.harness.get_by_label_contains("16 spp: 16 spp").focus();
    panels.harness.run_steps(2);
    press(&mut panels, Key::Enter, Modifiers::SHIFT);
    assert_eq!((spp(&panels, PaneId::A), spp(&panels, PaneId::B)), (Some(4), Some(16)));
    assert!(!panels.model.borrow().session.is_in(SWEEP));
}

#[test]
fn ready_sweeps_are_one_click_or_one_key() {
    let mut panels = panels(ViewModel::default());
    let plan = |panels: &Panels| panels.wanted().sweep.expect("tiles").plan;
    panels.click("2 e) 0 / 1 / 2 bounces", 0);
    let made = plan(&panels).tiles;
    let paths: Vec<_> = made.iter().map(|tile| (tile.pane.truth.path.bounces, tile.pane.wished_spp())).collect();
    assert_eq!(paths, [0, 1, 2].map(|bounces| (Some(bounces), Some(20))));
    press(&mut panels, Key::Num4, Modifiers::NONE);
    assert_eq!((plan(&panels).tiles.len(), plan(&panels).rows.map(|rows| rows.setting)), (8, Some("sampler")));
    press(&mut panels, Key::Num6, Modifiers::NONE);
    assert_eq!(panels.model.borrow().session.sweep.equal, Equal::Time);
    assert!(plan(&panels).seconds == Some(1.0) && panels.shows("Seconds a tile"));
    panels.count_named();
}

#[test]
fn values_are_typed_and_what_is_wrong_is_told_in_place_while_the_tiles_stay() {
    let mut panels = panels(ViewModel::default());
    let tiles = |panels: &Panels| panels.wanted().sweep.expect("tiles").plan.tiles.len();
    type_values(&mut panels, "Values of Columns", "1, 2, 4, 8");
    assert_eq!(tiles(&panels), 4);
    type_values(&mut panels, "Values of Columns", "1, many");
    assert!(panels.shows("spp=many: expected a whole number"));
    assert_eq!(tiles(&panels), 4, "those of before");
    panels.click("Columns: spp", 0);
    panels.click("estimator", 0);
    assert_eq!(panels.model.borrow().session.sweep.columns.setting, "estimator");
    assert!(tiles(&panels) > 4 && !panels.shows("expected a whole number"));
    panels.model.borrow_mut().session.sweep.rows = Axis::new("seed", "1, 2");
    panels.harness.run_steps(2);
    assert!(panels.shows("Rows: seed"));
}

#[test]
fn a_sweep_is_saved_as_one_picture_by_key_and_button_and_as_a_table() {
    let mut panels = panels(shown());
    let asked = |panels: &mut Panels| {
        let command = panels.requests.borrow_mut().pop().expect("a command");
        let UiCommand::Export(ExportRequest { subject, to: Destination::File(file) }) = command else {
            panic!("{command:?} is no export to a file")
        };
        (subject, file.display().to_string())
    };
    press(&mut panels, Key::S, Modifiers::COMMAND);
    let (subject, file) = asked(&mut panels);
    assert_eq!(subject, ExportSubject::Sweep(SweepFile::Picture));
    assert!(file.ends_with("visavis-cornell-sweep-spp.png"), "{file}");
    panels.click("Save the sweep as PNG", 0);
    assert_eq!(asked(&mut panels).0, ExportSubject::Sweep(SweepFile::Picture));
    panels.click("Save the sweep as CSV", 0);
    let (subject, file) = asked(&mut panels);
    assert!(subject == ExportSubject::Sweep(SweepFile::Table) && file.ends_with(".csv"), "{file}");
    panels.click("Export", 0);
    assert!(panels.shows("The sweep") && panels.shows("Its table") && !panels.shows("A alone"));
    let node = panels.harness.get_by_label("The sweep");
    assert_eq!(node.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True));
}
