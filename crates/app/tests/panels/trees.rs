//! The workspace of trees.

use crate::Panels;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use pathtrace::intersect::counted::Structure;
use visavis::model::{Counted, Model, Theme, TreeFacts, TreePlot, TreePoint, ViewModel};
use visavis::ui::Workspaces;

/// A list in blocks, a binary tree that is done, and nothing yet of eight boxes a node.
fn shown() -> ViewModel {
    let facts = |structure, boxes_a_ray, triangles_a_ray| TreeFacts {
        structure,
        fault: None,
        build_seconds: 0.5,
        bytes_a_triangle: 48.0,
        depth: 21,
        rays: 1_000,
        seconds: 2.0,
        whole_seconds: if structure == Structure::List { 512.0 } else { 2.0 },
        boxes_a_ray,
        triangles_a_ray,
        boxes: (0, Vec::new()),
    };
    let mut shown = ViewModel::default();
    shown.trees.facts = [Some(facts(Structure::List, 0.0, 8192.0)), Some(facts(Structure::Two, 30.5, 3.25)), None];
    shown.trees.most = 8192.0;
    let point = |structure, triangles, seconds| TreePoint { structure, triangles, seconds, tests: 33.75 };
    shown.trees.points = vec![point(Structure::List, 8192, 512.0), point(Structure::Two, 8192, 1.5)];
    shown
}

fn panels(shown: ViewModel) -> Panels {
    let scene = scene::builtin::named("cornell").expect("a built-in scene");
    let mut panels = Panels::with(Model::new(scene, "cornell".into(), Theme::Dark), Workspaces::default(), shown);
    press(&mut panels, Key::X);
    panels
}

fn press(panels: &mut Panels, key: Key) {
    panels.harness.key_press_modifiers(Modifiers::NONE, key);
    panels.harness.run_steps(3);
}

#[test]
fn a_key_and_a_button_open_it_and_only_what_is_open_is_traced() {
    let mut panels = panels(ViewModel::default());
    let wanted = panels.wanted();
    assert_eq!(wanted.panes.ids().count(), 0, "panes are not made meanwhile");
    let trees = wanted.trees.expect("rays to trace");
    assert!(trees.level == 5 && trees.show == Counted::Boxes && trees.size.0 > 100, "{trees:?}");
    panels.count_named();
    // the sweep takes its place, and Esc leads back to the comparison from either
    press(&mut panels, Key::S);
    assert!(panels.wanted().trees.is_none() && panels.wanted().sweep.is_some());
    panels.click("Trees", 0);
    assert!(panels.wanted().trees.is_some() && panels.wanted().sweep.is_none());
    press(&mut panels, Key::Escape);
    assert!(panels.wanted().trees.is_none() && panels.wanted().panes.ids().count() == 2);
}

#[test]
fn captions_tell_what_a_ray_costs_and_what_is_extrapolated() {
    let panels = panels(shown());
    assert!(panels.shows("no tree, all 8,192 triangles a ray, ≈ 9 min for every pixel (extrapolated)"));
    let two = "two boxes a node, 30.5 boxes, 3.2 triangles a ray, 2.00 s for 1,000 rays, built in 0.50 s, 48 bytes of \
               boxes a triangle, 21 deep";
    assert!(panels.shows(two));
    let plot = "s per million rays: no tree at 8,192 triangles 512.000, two boxes a node at 8,192 triangles 1.500";
    assert!(panels.harness.query_by_label(plot).is_some());
}

#[test]
fn keys_and_choices_change_what_is_traced_and_drawn() {
    let mut panels = panels(shown());
    press(&mut panels, Key::CloseBracket);
    press(&mut panels, Key::CloseBracket);
    press(&mut panels, Key::OpenBracket);
    panels.click("Show: triangles", 0);
    panels.click("Draw them", 0);
    panels.click("Plot: tests", 0);
    let trees = panels.wanted().trees.expect("rays to trace");
    assert_eq!((trees.level, trees.show, trees.boxes), (6, Counted::Triangles, Some(2)));
    assert_eq!(panels.model.borrow().session.trees.plot, TreePlot::Tests);
    // what is undone is seen nowhere here
    panels.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    panels.harness.run_steps(3);
    assert_eq!(panels.wanted().trees.map(|trees| trees.level), Some(6));
    press(&mut panels, Key::R);
    assert_eq!(panels.wanted().trees.map(|trees| trees.restarts), Some(1));
    (0..9).for_each(|_| press(&mut panels, Key::CloseBracket));
    assert_eq!(panels.wanted().trees.map(|trees| trees.level), Some(11), "there is no finer one");
}
