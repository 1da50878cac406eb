//! The workspace of hard cases.

use crate::Panels;
use check::{CASES, Case, Effort, Relation, Row, Verdict};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use technique::{Adapter, Adapters, Device, DeviceChoice, Technique};
use visavis::model::{CaseCourse, CaseMachine, CaseResult, Model, PaneId, Theme, ViewModel};
use visavis::ui::Workspaces;

fn row(case: u32, measured: f64, verdict: Verdict) -> Row {
    Row {
        case,
        device: Device::Cpu,
        subject: "path mis".into(),
        quantity: "at (2, 1)".into(),
        expected: 0.165453848,
        measured,
        relation: Relation::Equal,
        tolerance: 0.002,
        power: None,
        verdict,
    }
}

/// Case 4 passes, case 9 has a row that fails, and case 2 is being measured.
fn shown() -> ViewModel {
    let mut shown = ViewModel::default();
    let mut know = |case: u32, course: CaseCourse, rows: Vec<Row>| {
        let (seconds, by, spoilt) = (2.1, "the processor".to_owned(), false);
        shown.cases.results.insert((CaseMachine::Processor, case), CaseResult { rows, course, seconds, by, spoilt });
    };
    know(4, CaseCourse::Done, vec![row(4, 0.165, Verdict::Pass), row(4, 0.1654, Verdict::Pass)]);
    know(9, CaseCourse::Done, vec![row(9, 0.165, Verdict::Pass), row(9, 0.1737, Verdict::Fail)]);
    know(2, CaseCourse::Running, vec![]);
    shown
}

fn panels(shown: ViewModel) -> Panels {
    let scene = scene::builtin::named("cornell").expect("a built-in scene");
    let adapters = Adapters(vec![Adapter { name: "an adapter".into(), software: true }]);
    let mut model = Model::new(scene, "cornell".into(), Theme::Dark).beside(adapters, DeviceChoice::Auto);
    model.session.workspace = "cases";
    let mut panels = Panels::with(model, Workspaces::default(), shown);
    panels.harness.run_steps(3);
    panels
}

fn press(panels: &mut Panels, key: Key) {
    panels.harness.key_press_modifiers(Modifiers::NONE, key);
    panels.harness.run_steps(3);
}

fn look_at(panels: &mut Panels, case: u32) {
    panels.model.borrow_mut().state.cases.looked_at = case;
    panels.harness.run_steps(3);
}

#[test]
fn every_case_is_listed_with_its_mark_in_words_and_failing_ones_alone_where_that_is_wished() {
    let mut panels = panels(shown());
    panels.count_named();
    let names = |panels: &Panels| {
        let label = |case: &Case| format!("Case {}: {}", case.number, case.title);
        CASES.iter().filter(|case| panels.shows(&label(case))).map(|case| case.number).collect::<Vec<_>>()
    };
    assert_eq!(names(&panels).len(), CASES.len());
    assert!(panels.shows("Case 4: Rectangle light, Lambert's polygon formula, passes"));
    assert!(panels.shows("Case 9: Estimators of one integral, fails"));
    assert!(
        panels.shows("Case 2: Closed emissive box, running")
            && panels.shows("Case 1: White furnace, open box, not run")
    );
    assert!(panels.shows("1 of 31 cases pass, 1 fail"));
    panels.click("List failing cases alone", 0);
    assert_eq!(names(&panels), [9]);
    panels.click("Measured by: an adapter", 0);
    assert!(names(&panels).is_empty(), "each machine has marks of its own");
    assert!(panels.shows("None of those that were measured here fails."));
    panels.click("List failing cases alone", 0);
    assert!(panels.shows("Case 22: Samplers, not on this machine"));
}

#[test]
fn a_row_that_fails_stands_first_and_on_the_picture_in_numbers() {
    let mut panels = panels(shown());
    look_at(&mut panels, 9);
    let failing = "Case 9 fails. Fails: path mis: at (2, 1): 0.1737, expected 0.165453848 ± 0.002, off by 4.1 of that";
    assert!(panels.shows(failing));
    let rows = ["fail", "pass"].map(|verdict| panels.harness.get_by_label(verdict).rect().top());
    assert!(rows[0] < rows[1], "{rows:?}");
    assert!(panels.shows("0.008246152 (412 %)"), "how far, and of what");
    assert!(panels.shows("2 rows in 2.1 s by the processor"));
    look_at(&mut panels, 4);
    assert!(panels.shows("Case 4 passes. Nearest to failing: path mis: at (2, 1): 0.165"));
    assert!(panels.shows("expected 0.7052169"), "beside a ring");
    assert!(panels.harness.query_by_label("fail").is_none());
}

#[test]
fn what_is_wished_is_measured_with_what_is_chosen_and_the_picture_is_made_there_too() {
    let mut panels = panels(ViewModel::default());
    let picture = |panels: &Panels| panels.wanted().panes.get(PaneId::CASE).expect("a picture").clone();
    assert!(panels.wanted().cases.is_none() && panels.wanted().panes.ids().count() == 1);
    assert_eq!(picture(&panels).shot.source, "hard/white-furnace");
    (0..3).for_each(|_| press(&mut panels, Key::CloseBracket));
    assert_eq!(picture(&panels).shot.source, "hard/rectangle-light");
    panels.click("Run this", 0);
    let first = panels.wanted().cases.expect("a wish");
    assert!(first.cases == [4] && first.machine == CaseMachine::Processor && first.effort == Effort::Quick);
    panels.click("Measured by: an adapter", 0);
    panels.click("Effort: full", 0);
    panels.click("See it fail", 0);
    assert_eq!(panels.wanted().cases.as_ref(), Some(&first), "what is being measured is not touched");
    press(&mut panels, Key::A);
    let all = panels.wanted().cases.expect("a wish");
    assert!(all.number > first.number && all.cases.len() == CASES.len() && all.spoilt);
    assert_eq!((all.machine, all.effort), (CaseMachine::Adapter(0), Effort::Full));
    let Technique::Traced(traced) = picture(&panels).technique else { panic!("rays") };
    assert_eq!((traced.device, traced.adapter), (DeviceChoice::Gpu, 0));
}

#[test]
fn a_case_is_opened_as_a_scene_for_the_comparison_and_undo_leads_back() {
    let mut panels = panels(ViewModel::default());
    look_at(&mut panels, 25);
    panels.click("Open as a scene", 0);
    assert_eq!(panels.model.borrow().document.source, "hard/far-lamp");
    let wanted = panels.wanted();
    assert!(wanted.panes.ids().eq([PaneId::A, PaneId::B]) && wanted.cases.is_none(), "the comparison of it");
    assert!(panels.shows("Scene: Case 25: "));
    panels.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    panels.harness.run_steps(3);
    assert_eq!(panels.model.borrow().document.source, "cornell");
}
