//! Break the truth: a bug is hidden, guessed, and told once the guess is right.

use super::Panels;
use egui_kittest::kittest::Queryable;
use pathtrace::{Bug, Bugs};
use technique::{Technique, TechniqueName};
use visavis::model::{Model, PaneId};

fn hidden_in(model: &Model) -> Option<Bug> {
    let Technique::Traced(traced) = model.session.panes[PaneId::A].in_use() else { return None };
    traced.hidden_bug(model.document.seen())
}

#[test]
fn a_hidden_bug_is_told_to_who_guesses_it_and_to_nobody_else() {
    let mut panels = Panels::of("cornell");
    panels.model.borrow_mut().session.panes[PaneId::A].technique = TechniqueName::Path;
    panels.harness.run_steps(3);
    panels.click("Break the truth", 0);
    panels.click(Bug::Clamped.row().title, 0);
    assert_eq!(panels.model.borrow().session.panes[PaneId::A].truth.path.bugs, Bugs::NONE.with(Bug::Clamped));
    panels.click("Find the bug", 0);
    let path = panels.model.borrow().session.panes[PaneId::A].truth.path;
    assert_eq!((path.bugs, path.find_bug), (Bugs::NONE, 1));
    let hidden = hidden_in(&panels.model.borrow()).expect("a bug");
    let suited = Bugs::suited_to(panels.model.borrow().document.seen());
    let other = suited.iter().find(|bug| *bug != hidden).expect("another bug");
    assert!(panels.harness.query_by_label_contains("Right. ").is_none());
    panels.click(other.row().title, 0);
    assert!(panels.harness.query_by_label_contains(&format!("No. {}", other.row().hint)).is_some());
    panels.click(hidden.row().title, 0);
    assert!(panels.harness.query_by_label_contains(&format!("Right. {}", hidden.row().text)).is_some());
    panels.click("Another bug", 0);
    assert_eq!(panels.model.borrow().session.panes[PaneId::A].truth.path.find_bug, 2);
    assert!(panels.harness.query_by_label_contains("Right. ").is_none(), "of another number nothing was guessed");
    panels.click("No bug", 0);
    assert!(!panels.model.borrow().session.panes[PaneId::A].truth.path.is_broken());
}
